//! What a search makes small.

/// An error as it counts: no smaller than a rounding of the scene's size, so that its logarithm
/// is a number, and no larger than the size, which a run without an error has.
#[must_use]
pub fn effective(error: Option<f64>, size: f64) -> f64 {
    // Where nothing moves there is no size.
    let size = size.max(f64::MIN_POSITIVE);
    error.map_or(size, |error| error.clamp(f64::EPSILON * size, size))
}

/// The geometric mean of errors; none of none.
#[must_use]
pub fn typical(errors: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut logarithms, mut count) = (0.0, 0.0);
    for error in errors {
        logarithms += error.ln();
        count += 1.0;
    }
    (count > 0.0).then(|| (logarithms / count).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_geometric_and_a_failure_counts_as_the_size() {
        let mean = typical([1.0, 100.0].into_iter()).unwrap();
        assert!((mean - 10.0).abs() < 1e-12, "{mean}");
        assert_eq!(typical(std::iter::empty()), None);
        assert_eq!(effective(None, 50.0), 50.0);
        assert_eq!(effective(Some(900.0), 50.0), 50.0);
        assert_eq!(effective(Some(3.0), 50.0), 3.0);
        assert_eq!(effective(Some(0.0), 50.0), f64::EPSILON * 50.0);
    }
}
