//! The Pareto front: the points that nothing beats in error and price at once.

/// The places of the points (error, price) on the front, from the smallest error to the
/// largest.
///
/// A point is on it if no other is as good in both and better in one; of equal points the
/// first. Points with something that is not finite are not.
#[must_use]
pub fn pareto_front(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len())
        .filter(|place| points[*place].iter().all(|value| value.is_finite()))
        .collect();
    let by_error_then_price = |a: &usize, b: &usize| {
        let (a, b) = (points[*a], points[*b]);
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    };
    order.sort_by(by_error_then_price);
    let mut cheapest = f64::INFINITY;
    order.retain(|place| {
        let is_cheaper = points[*place][1] < cheapest;
        cheapest = cheapest.min(points[*place][1]);
        is_cheaper
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nothing_beats_is_on_the_front() {
        let points = [
            [1.0, 4.0],
            [2.0, 2.0],
            [2.0, 3.0],
            [4.0, 1.0],
            [3.0, 2.0],
            [f64::NAN, 0.1],
            [2.0, 2.0],
        ];
        assert_eq!(pareto_front(&points), [0, 1, 3]);
        assert_eq!(pareto_front(&[]), [0; 0]);
    }
}
