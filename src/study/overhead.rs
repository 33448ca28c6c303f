//! What a step costs before the first body, for each body and for each pair.

use nalgebra::{Matrix3, Vector3};

/// With fewer sizes there is nothing to tell apart.
const SIZES_MIN: usize = 3;
/// With fewer sizes pairs are not told apart from bodies.
const SIZES_FOR_PAIRS: usize = 4;

/// What a step costs, by the model `fixed + per_body n + per_pair n (n - 1)/2`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overhead {
    /// Of every step, µs.
    pub fixed_us: f64,
    /// For each body, µs.
    pub per_body_us: f64,
    /// For each pair, µs; none with too few sizes to tell.
    pub per_pair_us: Option<f64>,
    /// Root mean square of what the fit leaves, as a share of each cost.
    pub left_rms: f64,
    /// The largest share that it leaves.
    pub left_max: f64,
}

impl Overhead {
    /// Fits the costs of a step, µs, over the number of bodies; none with fewer than three sizes.
    ///
    /// Least squares on relative errors, so that 4 bodies count as much as 10,000; no term is
    /// negative.
    #[must_use]
    pub fn of(points: &[(usize, f64)]) -> Option<Self> {
        let usable = points
            .iter()
            .filter(|(_, cost)| cost.is_finite() && *cost > 0.0);
        let rows: Vec<Vector3<f64>> = usable
            .map(|(bodies, cost)| terms(*bodies) / *cost)
            .collect();
        if rows.len() < SIZES_MIN {
            return None;
        }
        let has_pairs = rows.len() >= SIZES_FOR_PAIRS;
        let subsets = (1..8_u32).filter(|subset| has_pairs || subset & 4 == 0);
        let fits = subsets.filter_map(|subset| fit(&rows, subset));
        let (best, squares) = fits.min_by(|a, b| a.1.total_cmp(&b.1))?;
        #[allow(clippy::cast_precision_loss, reason = "a handful of sizes")]
        let count = rows.len() as f64;
        let left = rows.iter().map(|row| (row.dot(&best) - 1.0).abs());
        Some(Self {
            fixed_us: best.x,
            per_body_us: best.y,
            per_pair_us: has_pairs.then_some(best.z),
            left_rms: (squares / count).sqrt(),
            left_max: left.fold(0.0, f64::max),
        })
    }
}

/// What the three costs are multiplied by.
#[allow(clippy::cast_precision_loss, reason = "far below 2^53 pairs")]
fn terms(bodies: usize) -> Vector3<f64> {
    let count = bodies as f64;
    Vector3::new(1.0, count, 0.5 * count * (count - 1.0))
}

/// Least squares of `rows x = 1` with the terms of a subset (a bit each) alone, and the sum of
/// squares that it leaves; none if a term were negative or the sizes do not tell them apart.
fn fit(rows: &[Vector3<f64>], subset: u32) -> Option<(Vector3<f64>, f64)> {
    // Scaled to columns of length 1, for the sake of the digits.
    let lengths = rows
        .iter()
        .fold(Vector3::zeros(), |sum, row| sum + row.component_mul(row));
    let scale = Vector3::from_fn(|term, _| {
        let wanted = subset & (1 << term) != 0 && lengths[term] > 0.0;
        if wanted {
            1.0 / lengths[term].sqrt()
        } else {
            0.0
        }
    });
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    for row in rows {
        let row = row.component_mul(&scale);
        normal += row * row.transpose();
        right += row;
    }
    for term in 0..3 {
        if scale[term] == 0.0 {
            normal[(term, term)] = 1.0;
        }
    }
    let found = normal.cholesky()?.solve(&right).component_mul(&scale);
    let squares = rows.iter().map(|row| (row.dot(&found) - 1.0).powi(2)).sum();
    found
        .iter()
        .all(|term| *term >= 0.0)
        .then_some((found, squares))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: [usize; 8] = [4, 10, 30, 100, 300, 1000, 3000, 10_000];

    fn costs(terms_us: [f64; 3], noise: f64) -> Vec<(usize, f64)> {
        let cost = |(place, bodies): (usize, &usize)| {
            let sign = if place % 2 == 0 { 1.0 } else { -1.0 };
            let clean = terms(*bodies).dot(&Vector3::from(terms_us));
            (*bodies, clean * (1.0 + sign * noise))
        };
        SIZES.iter().enumerate().map(cost).collect()
    }

    /// Costs made from known terms give them back, to rounding: the columns' condition is below
    /// 1e4, so 1e-10 leaves room.
    #[test]
    fn known_terms_are_found_over_eight_sizes() {
        for terms in [[5.0, 0.3, 0.0], [0.02, 0.004, 0.001], [0.0, 0.0, 2e-3]] {
            let found = Overhead::of(&costs(terms, 0.0)).unwrap();
            let back = [
                found.fixed_us,
                found.per_body_us,
                found.per_pair_us.unwrap(),
            ];
            for (back, term) in back.iter().zip(terms) {
                assert!((back - term).abs() <= 1e-10 * term.max(1e-3), "{found:?}");
            }
            assert!(found.left_max < 1e-10);
        }
    }

    /// Noise of 10 % to and fro: each term that rules at some sizes is found to within it, and
    /// the fit says what it leaves.
    #[test]
    fn noise_is_left_and_told() {
        let found = Overhead::of(&costs([5.0, 0.3, 0.0], 0.1)).unwrap();
        assert!((found.fixed_us / 5.0 - 1.0).abs() < 0.2, "{found:?}");
        assert!((found.per_body_us / 0.3 - 1.0).abs() < 0.2, "{found:?}");
        assert!((0.05..0.15).contains(&found.left_rms), "{found:?}");
        assert!(found.left_max >= found.left_rms);
    }

    #[test]
    fn few_sizes_tell_less() {
        let all = costs([5.0, 0.3, 0.0], 0.0);
        assert_eq!(Overhead::of(&all[..2]), None);
        let three = Overhead::of(&all[..3]).unwrap();
        assert_eq!(three.per_pair_us, None);
        assert!((three.fixed_us - 5.0).abs() < 1e-9);
        assert_eq!(
            Overhead::of(&[(4, f64::NAN), (5, 0.0), (6, 1.0), (7, 1.0)]),
            None
        );
    }
}
