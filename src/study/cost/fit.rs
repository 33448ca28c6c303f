//! Orders of convergence, and what becomes of an error as the step goes to 0.

use serde::Serialize;

/// Fewer points say nothing about a slope.
const POINTS_MIN: usize = 4;
/// The finest points of a ladder that a fit uses: farther up, the step is not small.
const POINTS_MAX: usize = 8;
/// A slope flatter than this is a plateau.
const FLAT: f64 = 0.25;
/// Points from which a limit is read.
const LIMIT_POINTS: usize = 4;
/// A slope with a wider half-interval than this means nothing.
const VAGUE: f64 = 0.5;

/// Two-sided 95 % quantiles of Student's t for 2, 3, ... degrees of freedom.
const STUDENT: [f64; 6] = [4.303, 3.182, 2.776, 2.571, 2.447, 2.365];

/// A fitted order of convergence with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// The slope of log(error) over log(dt).
    pub order: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// What a fit of the order found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrderFit {
    /// The order; none where a slope means nothing.
    pub order: Option<Order>,
    /// How many points were fitted.
    pub points: usize,
}

/// The range of errors in which a slope can be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Below, it is rounding.
    pub floor: f64,
    /// Above, the step is not small.
    pub ceiling: f64,
}

impl Window {
    fn holds(&self, error: f64) -> bool {
        error > self.floor && error < self.ceiling
    }
}

/// Fits the order by least squares on log-log over the finest points within the window.
///
/// `points` are (dt, error) in any order. Blank with fewer than four points, on a plateau, and
/// where the interval is wider than ±0.5 or holds 0.
#[must_use]
pub fn fit_order(points: &[[f64; 2]], window: Window) -> OrderFit {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let usable: Vec<[f64; 2]> = sorted
        .into_iter()
        .filter(|[dt, error]| *dt > 0.0 && window.holds(*error))
        .take(POINTS_MAX)
        .map(|point| point.map(f64::ln))
        .collect();
    let count = usable.len();
    if count < POINTS_MIN {
        return OrderFit {
            order: None,
            points: count,
        };
    }
    let (slope, error) = slope(&usable);
    let half = STUDENT[count - POINTS_MIN] * error;
    let meant = slope > FLAT && slope > half && half <= VAGUE;
    OrderFit {
        order: meant.then_some(Order {
            order: slope,
            low: slope - half,
            high: slope + half,
        }),
        points: count,
    }
}

/// Least squares: the slope and its standard error.
fn slope(points: &[[f64; 2]]) -> (f64, f64) {
    let mut count = 0.0;
    let mut mean = [0.0; 2];
    for point in points {
        count += 1.0;
        mean = [mean[0] + point[0], mean[1] + point[1]];
    }
    let mean = mean.map(|sum| sum / count);
    let (mut xx, mut xy) = (0.0, 0.0);
    for [x, y] in points {
        xx += (x - mean[0]) * (x - mean[0]);
        xy += (x - mean[0]) * (y - mean[1]);
    }
    let slope = xy / xx;
    let residual = |[x, y]: &[f64; 2]| (y - mean[1] - slope * (x - mean[0])).powi(2);
    let squares: f64 = points.iter().map(residual).sum();
    (slope, (squares / (count - 2.0) / xx).sqrt())
}

/// What is left of an error as the step goes to 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Remainder {
    /// It stays: the engine computes another model.
    Model,
    /// It shrinks with the step.
    Discretisation,
    /// It is at the floor of the arithmetic.
    Rounding,
    /// Neither, within this budget: it jumps or grows.
    Unsettled,
}

impl Remainder {
    /// The word of the verdict.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Model => "model",
            Self::Discretisation => "discretisation",
            Self::Rounding => "rounding",
            Self::Unsettled => "unsettled",
        }
    }
}

/// The limit of an error for dt -> 0, estimated from the finest steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// What kind of error is left.
    pub kind: Remainder,
    /// The slope over the finest steps; none at the floor.
    pub slope: Option<f64>,
    /// Error at the finest step.
    pub finest: f64,
    /// Whether each of the finest steps errs less than the one before.
    pub falls: bool,
}

/// Reads the limit from the four finest steps; none with fewer points.
///
/// Equation: error = c dt^p. p above 1/4 is a slope, below -1/4 no limit, between a plateau;
/// the floor comes first, where the finest error is below it.
#[must_use]
pub fn limit(points: &[[f64; 2]], floor: f64) -> Option<Limit> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let finest = sorted.first()?[1];
    if finest <= floor {
        return Some(Limit {
            kind: Remainder::Rounding,
            slope: None,
            finest,
            falls: false,
        });
    }
    if sorted.len() < LIMIT_POINTS {
        return None;
    }
    let above = sorted.iter().take(LIMIT_POINTS);
    let logs: Vec<[f64; 2]> = above
        .filter(|point| point[1] > 0.0)
        .map(|point| point.map(f64::ln))
        .collect();
    if logs.len() < LIMIT_POINTS {
        return None;
    }
    let (slope, _) = slope(&logs);
    // Four errors on one level: a plateau whatever the slope of their small changes.
    let spread = logs.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max)
        - logs.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    let kind = if slope.abs() <= FLAT && spread <= 1.0 {
        Remainder::Model
    } else if slope > FLAT {
        Remainder::Discretisation
    } else {
        Remainder::Unsettled
    };
    Some(Limit {
        kind,
        slope: Some(slope),
        finest,
        falls: logs.windows(2).all(|pair| pair[0][1] < pair[1][1]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: Window = Window {
        floor: 0.0,
        ceiling: f64::INFINITY,
    };

    fn series(count: i32, error: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let dt = |power: i32| 0.5_f64.powi(power);
        (0..count)
            .map(|power| [dt(power), error(dt(power))])
            .collect()
    }

    #[test]
    fn a_power_law_gives_its_exponent() {
        for order in [1.0, 2.0, 4.0] {
            let fit = fit_order(&series(10, |dt| 3.0 * dt.powf(order)), ALL);
            let found = fit.order.unwrap();
            assert!((found.order - order).abs() < 1e-9, "{found:?}");
            assert!(found.high - found.low < 1e-6 && fit.points == 8);
        }
    }

    /// Errors that alternate by a factor of 1.1 about dt: the interval must hold the truth and
    /// have a width.
    #[test]
    fn a_noisy_power_law_has_an_interval_that_holds_the_truth() {
        let mut points = series(8, |dt| dt);
        for (place, point) in points.iter_mut().enumerate() {
            point[1] *= if place % 2 == 0 { 1.1 } else { 1.0 / 1.1 };
        }
        let found = fit_order(&points, ALL).order.unwrap();
        assert!(found.low < 1.0 && 1.0 < found.high, "{found:?}");
        assert!((0.02..0.3).contains(&(found.high - found.low)), "{found:?}");
    }

    #[test]
    fn points_at_the_floor_and_far_out_are_left_out() {
        let points = series(12, |dt| (dt * dt).max(1e-5));
        let window = Window {
            floor: 2e-5,
            ceiling: 0.3,
        };
        let fit = fit_order(&points, window);
        assert!((fit.order.unwrap().order - 2.0).abs() < 1e-9);
        // dt = 1/2 ... 1/128: above 2e-5 and below 0.3.
        assert_eq!(fit.points, 7);
        assert_ne!(
            fit_order(&points, ALL).order.map(|o| o.order),
            fit.order.map(|o| o.order)
        );
    }

    #[test]
    fn a_slope_that_means_nothing_is_blank() {
        assert_eq!(fit_order(&series(3, |dt| dt), ALL).order, None);
        assert_eq!(fit_order(&series(9, |_| 0.4), ALL).order, None);
        let jumps = series(9, |dt| {
            if dt.log2() % 2.0 == 0.0 {
                100.0 * dt
            } else {
                dt
            }
        });
        assert_eq!(fit_order(&jumps, ALL).order, None);
    }

    #[test]
    fn plateau_slope_and_floor_have_their_words() {
        let kind = |error: &dyn Fn(f64) -> f64| limit(&series(9, error), 1e-12).unwrap().kind;
        assert_eq!(kind(&|dt| 0.5 + dt), Remainder::Model);
        assert_eq!(kind(&|dt| dt), Remainder::Discretisation);
        assert_eq!(kind(&|dt| 1e-3 * dt.powi(4) + 1e-13), Remainder::Rounding);
        assert_eq!(kind(&|dt| 1.0 / dt), Remainder::Unsettled);
        assert_eq!(limit(&series(3, |dt| dt), 0.0), None);
        let falls = |error: &dyn Fn(f64) -> f64| limit(&series(9, error), 0.0).unwrap().falls;
        assert!(falls(&|dt| dt) && !falls(&|_| 1.0));
    }
}
