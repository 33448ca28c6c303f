//! How far a series may be followed.

use super::law::{Law, Link};
use super::scalar::{Real, minus, size};
use super::series::{Series, as_real};

/// Share of the truncation that is measured against the distance of a pair itself, and not
/// against how much it changes in the step: keeps the step finite where nothing changes.
const STILL: f64 = 1e-4;

/// The last terms that a step is taken from.
///
/// Any of them may vanish: every second one of a motion that is even or odd in time, three of four
/// where a force is cubic (a body between two relaxed springs that it crosses). What stands there
/// is rounding, which would allow a far longer step.
const LAST: usize = 4;

/// The largest u such that the last terms of every link's distance and of every body's path stay
/// below the tolerance times their change over the step.
///
/// Equation: `|c_k| u^k <= tolerance^min(1, k/(n-1)) max(|c_1| u, |c_2| u², STILL |c_0|)`, n being
/// the order and k the last four up to it: a term before the last two is asked for what it leaves
/// of them in a series that falls evenly. Measuring on links makes it blind to a common
/// motion, which is no reason for small steps; for the bodies' own paths `c_0` is the longest
/// link. Where a softened link is shorter than its softening, `c_0` is that. Where rounding leaves all of these terms of a link at exactly zero, as it does by chance on
/// a stiff spring that swings far, its last term above the parabola that is not zero stands in.
/// Source: Jorba and Zou 2005, section 3.2, with their absolute norm made relative.
pub(super) fn span<T: Real>(series: &Series<T>, law: &Law<T>, tolerance: f64) -> f64 {
    let order = series.order();
    let x = &series.position;
    let still = |link: &Link<T>| {
        let [a, b] = link.ends;
        size(&minus(&x[0][b], &x[0][a])).max(link.softening())
    };
    let typical = law.links.iter().map(still).fold(0.0, f64::max);
    let first = (order + 1).saturating_sub(LAST).max(3);
    let mut span = f64::INFINITY;
    for k in (first..=order).rev() {
        let tolerance = tolerance.powf((as_real(k) / as_real(order - 1)).min(1.0));
        let mut power = span.powf(as_real(k));
        let mut tighten = |last: f64, scale: [f64; 3]| {
            let [still, first, second] = scale;
            // What does not change at first nor second order has nothing to be measured against.
            let is_unmeasured = still == 0.0 && first == 0.0 && second == 0.0;
            let within = tolerance * (first * span).max(second * span * span).max(still);
            if last == 0.0 || is_unmeasured || (span.is_finite() && last * power <= within) {
                return;
            }
            span = reach(tolerance, k, last, scale);
            power = span.powf(as_real(k));
        };
        for link in &law.links {
            let [a, b] = link.ends;
            let length = |k: usize| size(&minus(&x[k][b], &x[k][a]));
            tighten(length(k), [STILL * still(link), length(1), length(2)]);
        }
        let bodies = 0..x[0].len();
        for body in bodies {
            let length = |k: usize| size(&x[k][body]);
            tighten(length(k), [STILL * typical, length(1), length(2)]);
        }
    }
    for link in &law.links {
        let [a, b] = link.ends;
        let length = |k: usize| size(&minus(&x[k][b], &x[k][a]));
        if (first..=order).all(|k| length(k) == 0.0)
            && let Some(k) = (3..first).rev().find(|k| length(*k) != 0.0)
        {
            let scale = [STILL * still(link), length(1), length(2)];
            span = span.min(reach(tolerance, k, length(k), scale));
        }
    }
    span
}

/// The largest u such that `last u^k <= tolerance max(still, first u, second u²)`.
fn reach(tolerance: f64, k: usize, last: f64, [still, first, second]: [f64; 3]) -> f64 {
    let reach =
        |scale: f64, missing: usize| (tolerance * scale / last).powf(1.0 / as_real(k - missing));
    reach(still, 0).max(reach(first, 1)).max(reach(second, 2))
}
