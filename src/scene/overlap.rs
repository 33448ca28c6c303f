//! Which spheres overlap, without looking at every pair.

use nalgebra::Vector3;

/// Two overlapping spheres, `a < b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Index of the first sphere.
    pub a: usize,
    /// Index of the second sphere.
    pub b: usize,
    /// `r_a + r_b - |x_a - x_b|`, above 0.
    pub depth: f64,
}

/// Calls `visit` for every overlapping pair, in no particular order.
///
/// Sort and sweep along the axis on which the spheres spread widest: spheres whose intervals
/// on it are disjoint cannot overlap. Pairs with a non-finite centre are passed over.
pub fn for_each_overlap(spheres: &[(Vector3<f64>, f64)], mut visit: impl FnMut(Overlap)) {
    let axis = widest_axis(spheres);
    let mut order: Vec<usize> = (0..spheres.len()).collect();
    let low = |i: usize| spheres[i].0[axis] - spheres[i].1;
    order.sort_by(|&i, &j| low(i).total_cmp(&low(j)));
    for (place, &i) in order.iter().enumerate() {
        let high = spheres[i].0[axis] + spheres[i].1;
        for &j in order[place + 1..].iter().take_while(|&&j| low(j) < high) {
            let depth = spheres[i].1 + spheres[j].1 - (spheres[i].0 - spheres[j].0).norm();
            if depth > 0.0 {
                visit(Overlap {
                    a: i.min(j),
                    b: i.max(j),
                    depth,
                });
            }
        }
    }
}

/// Every overlapping pair.
#[must_use]
pub fn overlaps(spheres: &[(Vector3<f64>, f64)]) -> Vec<Overlap> {
    let mut found = Vec::new();
    for_each_overlap(spheres, |overlap| found.push(overlap));
    found
}

fn widest_axis(spheres: &[(Vector3<f64>, f64)]) -> usize {
    let spread = |axis: usize| {
        let (low, high) = spheres
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| {
                (low.min(s.0[axis]), high.max(s.0[axis]))
            });
        high - low
    };
    (0..3)
        .max_by(|&a, &b| spread(a).total_cmp(&spread(b)))
        .unwrap_or(0)
}
