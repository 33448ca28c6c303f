//! The limit of an error for dt -> 0, estimated from the finest steps over all phases.

use super::Window;
use super::fit::{FLAT, POINTS_MAX, POINTS_MIN, falling, slope};
use super::series::Series;
use crate::compare::{Estimate, Limit, Remainder};
use crate::study::median::median;
use crate::study::stopwatch::interval;

/// Fewer phases say nothing about the scatter between them.
pub const PHASES_MIN: usize = 3;
/// A limit explains the error at the finest step if it is within this factor of it.
const EXPLAINS: f64 = 2.0;
/// A limit is compatible with 0 if its interval reaches below this share of the finest error:
/// half as much came of an order 4 whose slope was still changing, from 5 to 4.1 (kepler-e06).
const SLIGHT: f64 = 0.2;
/// Errors that a limit explains lie within this share of the fitted curve (rms).
const FITS: f64 = 0.2;
/// And at the finest three steps those of one phase lie within this share of each other: noise of
/// chaos has a steady mean over the phases, and jumps within each.
const SETTLES: f64 = 0.25;
/// Errors above the window count as shrinking only if they fall at least about so steeply.
const STEEP: f64 = 0.7;
/// Rounding of this many operations adds up before an error counts as more than rounding.
pub(super) const ROUNDINGS: f64 = 64.0;
/// Exponents that are tried: a graze has 1/2, the highest order of the ladder is 5.
const EXPONENTS: [f64; 2] = [0.5, 5.0];

/// Estimates what is left of an error as the step goes to 0; none with fewer than four steps or
/// three phases.
///
/// Equation: `error = e0 + c dt^p`, `e0 >= 0`, c of either sign, p between 1/2 and 5; least
/// squares of the relative residuals over the finest six steps, the error being the root mean
/// square over the phases. A residual weighs by 1/dt, for what the equation leaves out, the next
/// order, is by that much larger at a coarser step. The interval of e0 is a percentile bootstrap
/// over the phases.
/// *rounding*: the finest error is below the floor; or it is no more than what one rounding a step
/// adds up to over the `duration` (s), and grows as the step shrinks, or is none of the following
/// and that sum is small. *model*: e0 is above the floor, the curve
/// fits, the error settles at each phase, and both ends of the interval are within a factor of 2
/// of the finest error.
/// *discretisation*: the interval reaches below a fifth of the finest error, and the slope is
/// positive with an interval no wider than ±0.5.
#[must_use]
pub fn limit(series: &Series, window: Window, duration: f64, seed: u64) -> Option<Limit> {
    let all = series.rms();
    let [finest_dt, finest_error] = *all.first()?;
    let points = finest(all);
    let at_floor = finest_error <= window.floor;
    if series.phases() < PHASES_MIN || (points.len() < POINTS_MIN && !at_floor) {
        return None;
    }
    let limit = Limit {
        kind: Remainder::Rounding,
        stays: None,
        slope: None,
        finest: finest_error,
        floor: window.floor,
    };
    if at_floor {
        return Some(limit);
    }
    let curve = Curve::through(&points);
    let of_drawn = |drawn: &[usize]| Curve::through(&finest(series.drawn(drawn))).stays;
    let [low, high] = interval(series.phases(), seed, of_drawn);
    let stays = Estimate {
        value: curve.stays,
        low,
        high,
    };
    let slope = Slope::of(&points);
    let added_up = window.floor / ROUNDINGS * (duration / finest_dt);
    let explains = low * EXPLAINS >= finest_error && high <= EXPLAINS * finest_error;
    let settled = curve.misfit <= FITS && settles(series);
    let is_small = finest_error <= window.ceiling;
    let kind = if slope.grows && finest_error <= added_up {
        Remainder::Rounding
    } else if explains && settled && low > window.floor {
        Remainder::Model
    } else if low <= SLIGHT * finest_error && slope.shrinks(is_small) {
        Remainder::Discretisation
    } else if finest_error <= added_up && added_up <= window.ceiling {
        Remainder::Rounding
    } else {
        Remainder::Unsettled
    };
    Some(Limit {
        kind,
        stays: Some(stays),
        slope: Some(slope.finest),
        ..limit
    })
}

/// How the error changes from step to step.
struct Slope {
    /// Over the finest steps.
    finest: f64,
    /// Whether a straight line through all of them means something.
    is_line: bool,
    /// Whether each of the finest steps errs more than the next coarser one.
    grows: bool,
    /// Whether each step errs less than the next coarser one.
    falls: bool,
}

impl Slope {
    fn of(points: &[[f64; 2]]) -> Self {
        let logs: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::ln)).collect();
        let nearest = &logs[..POINTS_MIN];
        Self {
            finest: slope(nearest).0,
            is_line: falling(&logs).is_some(),
            grows: nearest.windows(2).all(|pair| pair[0][1] > pair[1][1]),
            falls: logs.windows(2).all(|pair| pair[0][1] < pair[1][1]),
        }
    }

    /// Errors that are not small tell nothing unless they fall from step to step: the engine does
    /// not yet tell the same story as the reference.
    fn shrinks(&self, is_small: bool) -> bool {
        let steady = self.falls && self.finest > STEEP;
        self.is_line && self.finest > FLAT && (is_small || steady)
    }
}

/// The finest points, from fine to coarse; an error of 0 has no logarithm.
fn finest(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.retain(|[dt, error]| *dt > 0.0 && *error > 0.0);
    points.truncate(POINTS_MAX);
    points
}

/// Whether the error at the median phase is the same at the finest three steps.
fn settles(series: &Series) -> bool {
    let spread = |phase: usize| {
        let own = finest(series.drawn(&[phase]));
        let errors = || own.iter().take(3).map(|point| point[1]);
        let least = errors().fold(f64::INFINITY, f64::min);
        errors().fold(0.0, f64::max) / least - 1.0
    };
    let spreads: Vec<f64> = (0..series.phases()).map(spread).collect();
    median(&spreads) <= SETTLES
}

/// `error = stays + c dt^p` through some points.
#[derive(Debug, Clone, Copy)]
struct Curve {
    stays: f64,
    /// Weighted root mean square of the relative residuals.
    misfit: f64,
}

impl Curve {
    /// The best curve: its exponent by a search, the rest by linear least squares.
    fn through(points: &[[f64; 2]]) -> Self {
        const COARSE: u32 = 18;
        const REFINEMENTS: u32 = 12;
        let [least, most] = EXPONENTS;
        let apart = (most - least) / f64::from(COARSE);
        let misfit = |exponent: f64| Self::with_exponent(points, exponent).misfit;
        let tried = (0..=COARSE).map(|place| least + apart * f64::from(place));
        let mut best = tried
            .min_by(|a, b| misfit(*a).total_cmp(&misfit(*b)))
            .unwrap_or(least);
        let mut around = apart;
        for _ in 0..REFINEMENTS {
            around *= 0.5;
            let sides = [best - around, best, best + around];
            let within = sides.into_iter().filter(|p| (least..=most).contains(p));
            best = within
                .min_by(|a, b| misfit(*a).total_cmp(&misfit(*b)))
                .unwrap_or(best);
        }
        Self::with_exponent(points, best)
    }

    fn with_exponent(points: &[[f64; 2]], exponent: f64) -> Self {
        let finest = points.first().map_or(1.0, |point| point[0]);
        // Rows of the least squares: stays / error + c dt^p / error = 1, each times its weight.
        let rows = points.iter().map(|[dt, error]| {
            let weight = finest / dt;
            [
                weight / error,
                weight * (dt / finest).powf(exponent) / error,
                weight,
            ]
        });
        let (mut aa, mut ab, mut bb, mut a, mut b, mut all) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for [one, power, weight] in rows.clone() {
            aa += one * one;
            ab += one * power;
            bb += power * power;
            a += one * weight;
            b += power * weight;
            all += weight * weight;
        }
        let stays = (a * bb - b * ab) / (aa * bb - ab * ab);
        // What cannot stay below 0, or cannot be told, is taken as nothing.
        let stays = if stays > 0.0 { stays } else { 0.0 };
        let slope = (b - stays * ab) / bb;
        let squares =
            rows.map(|[one, power, weight]| (weight - stays * one - slope * power).powi(2));
        Self {
            stays,
            misfit: (squares.sum::<f64>() / all).sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::stopwatch::Dice;

    const WINDOW: Window = Window {
        floor: 1e-12,
        ceiling: 20.0,
    };

    /// Steps 1, 1/2, ..., 1/256; the error of each phase from the step and a number in 0..1 drawn
    /// anew each time.
    fn series(error: impl Fn(f64, f64) -> f64) -> Series {
        let mut dice = Dice::new(5);
        let mut phase = || {
            let at = |power: i32| {
                #[allow(clippy::cast_precision_loss, reason = "below 1000")]
                let drawn = (dice.below(1000) as f64 + 0.5) / 1000.0;
                let dt = 0.5_f64.powi(power);
                (dt, Some(error(dt, drawn)))
            };
            (0..9).map(at).collect()
        };
        let phases: Vec<_> = (0..7).map(|_| phase()).collect();
        Series::new(&phases)
    }

    fn found(error: impl Fn(f64, f64) -> f64) -> Limit {
        limit(&series(error), WINDOW, 1.0, 1).unwrap()
    }

    #[test]
    fn a_plateau_is_found_with_its_height() {
        for (height, slope) in [(0.5, 1.0), (0.5, -0.3), (3.0, 0.0), (1e-6, 2e-6)] {
            let found = found(|dt, late| height + slope * late * dt);
            assert_eq!(found.kind, Remainder::Model, "{found:?}");
            let stays = found.stays.unwrap();
            // What the phases add at the finest step of 1/256, and half of it again.
            assert!((stays.value - height).abs() <= 1.5 * slope.abs() / 256.0 + 1e-9 * height);
            assert!(
                stays.low <= stays.value && stays.value <= stays.high,
                "{stays:?}"
            );
        }
    }

    /// A plateau from 50 on, far above the window: the engine tells another story, but always
    /// the same one.
    #[test]
    fn a_large_plateau_is_a_model_too() {
        assert_eq!(found(|dt, late| 50.0 + late * dt).kind, Remainder::Model);
    }

    #[test]
    fn slopes_of_all_orders_are_discretisation() {
        for order in [1, 2, 4] {
            let exact = found(|dt, _| dt.powi(order));
            assert_eq!(exact.kind, Remainder::Discretisation, "{exact:?}");
            assert!((exact.slope.unwrap() - f64::from(order)).abs() < 1e-9);
            assert!(exact.stays.unwrap().high < 1e-3 * exact.finest, "{exact:?}");
            let late = found(|dt, late| late * dt.powi(order));
            assert_eq!(late.kind, Remainder::Discretisation, "{late:?}");
            assert_eq!(late.stays.unwrap().low, 0.0);
            // A slope that is still changing.
            let bent = found(|dt, late| late * (dt.powi(order) + dt.powi(order + 1)));
            assert_eq!(bent.kind, Remainder::Discretisation, "{bent:?}");
        }
    }

    #[test]
    fn a_slope_that_has_met_its_plateau_is_neither() {
        // At the finest step a third stays, the rest still shrinks.
        let found = found(|dt, _| dt + 1.0 / 512.0);
        assert_eq!(found.kind, Remainder::Unsettled, "{found:?}");
        let stays = found.stays.unwrap();
        assert!((stays.value * 512.0 - 1.0).abs() < 1e-3, "{stays:?}");
    }

    #[test]
    fn the_floor_comes_first_and_has_no_slope() {
        for error in [
            |dt: f64| 1e-3 * dt.powi(5) + 1e-13,
            |dt| if dt < 0.1 { 0.0 } else { dt },
        ] {
            let found = found(|dt, _| error(dt));
            assert_eq!(found.kind, Remainder::Rounding, "{found:?}");
            assert_eq!((found.stays, found.slope), (None, None));
        }
    }

    /// One rounding a step, 1e-12/64, adds up to 1e-12 where 64 steps are taken, and to 4e-12 at
    /// the finest; ten times as much is something else.
    #[test]
    fn rounding_that_adds_up_step_by_step_is_rounding() {
        let growing = |factor: f64| found(|dt, _| factor * (0.8e-12 / 64.0) / dt).kind;
        assert_eq!(growing(1.0), Remainder::Rounding);
        assert_eq!(growing(10.0), Remainder::Unsettled);
        let jumping = |factor: f64| found(|_, drawn| factor * 1e-12 * (1.0 + drawn)).kind;
        assert_eq!(jumping(1.0), Remainder::Rounding);
        assert_eq!(jumping(10.0), Remainder::Unsettled);
    }

    /// Errors that jump by a factor of a hundred from run to run, and errors that grow.
    #[test]
    fn noise_of_chaos_is_unsettled() {
        let chaos = found(|_, drawn| 10.0_f64.powf(2.0 * drawn));
        assert_eq!(chaos.kind, Remainder::Unsettled, "{chaos:?}");
        let growing = found(|dt, _| 1.0 / dt);
        assert_eq!(growing.kind, Remainder::Unsettled, "{growing:?}");
        let large = found(|dt, drawn| 100.0 * (0.5 + drawn) * dt.powf(0.2));
        assert_eq!(large.kind, Remainder::Unsettled, "{large:?}");
    }

    #[test]
    fn too_few_steps_or_phases_have_no_limit() {
        let phase = |count: i32| (0..count).map(|k| (0.5_f64.powi(k), Some(1.0))).collect();
        let few_steps: Vec<_> = (0..7).map(|_| phase(3)).collect();
        assert_eq!(limit(&Series::new(&few_steps), WINDOW, 1.0, 1), None);
        let few_phases: Vec<_> = (0..2).map(|_| phase(9)).collect();
        assert_eq!(limit(&Series::new(&few_phases), WINDOW, 1.0, 1), None);
        assert_eq!(limit(&Series::new(&[]), WINDOW, 1.0, 1), None);
    }
}
