//! How far a series may be followed.

use super::law::Law;
use super::scalar::{Real, minus, size};
use super::series::{Series, as_real};

/// Share of the truncation that is measured against the distance of a pair itself, and not
/// against how much it changes in the step: keeps the step finite where nothing changes.
const STILL: f64 = 1e-4;

/// The largest u such that the last two terms of every link's distance and of every body's
/// path stay below `tolerance` times their change over the step.
///
/// Equation: `|c_k| u^k <= tolerance max(|c_1| u, |c_2| u², STILL |c_0|)`, k the order and one
/// less (one of the two may vanish by symmetry). Measuring on links makes it blind to a common
/// motion, which is no reason for small steps; for the bodies' own paths `c_0` is the longest
/// link.
/// Source: Jorba and Zou 2005, section 3.2, with their absolute norm made relative.
pub(super) fn span<T: Real>(series: &Series<T>, law: &Law<T>, tolerance: f64) -> f64 {
    let order = series.order();
    let x = &series.position;
    let distance = |[a, b]: [usize; 2]| size(&minus(&x[0][b], &x[0][a]));
    let lengths = law.links.iter().map(|link| distance(link.ends));
    let typical = lengths.fold(0.0, f64::max);
    let mut span = f64::INFINITY;
    for k in [order - 1, order] {
        let mut power = f64::INFINITY;
        let mut tighten = |last: f64, scale: [f64; 3]| {
            let [still, first, second] = scale;
            let within = tolerance * (first * span).max(second * span * span).max(still);
            if last == 0.0 || (span.is_finite() && last * power <= within) {
                return;
            }
            let reach = |scale: f64, missing: usize| {
                (tolerance * scale / last).powf(1.0 / as_real(k - missing))
            };
            span = reach(still, 0).max(reach(first, 1)).max(reach(second, 2));
            power = span.powf(as_real(k));
        };
        for link in &law.links {
            let [a, b] = link.ends;
            let length = |k: usize| size(&minus(&x[k][b], &x[k][a]));
            tighten(length(k), [STILL * length(0), length(1), length(2)]);
        }
        let bodies = 0..x[0].len();
        for body in bodies {
            let length = |k: usize| size(&x[k][body]);
            tighten(length(k), [STILL * typical, length(1), length(2)]);
        }
    }
    span
}
