//! Orders of convergence.

/// Fewer points say nothing about a slope.
pub(super) const POINTS_MIN: usize = 4;
/// The finest points of a ladder that a fit uses: farther up, the step is not small.
pub(super) const POINTS_MAX: usize = 6;
/// A slope flatter than this is a plateau.
pub(super) const FLAT: f64 = 0.25;
/// A slope with a wider half-interval than this means nothing.
const VAGUE: f64 = 0.5;

/// Two-sided 95 % quantiles of Student's t for 2, 3, ... degrees of freedom.
const STUDENT: [f64; 3] = [4.303, 3.182, 2.776];

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
    OrderFit {
        order: falling(&usable),
        points: count,
    }
}

/// The slope of 4 to 6 logarithms (dt, error), if it is one: not a plateau, and known to ±0.5.
pub(super) fn falling(logs: &[[f64; 2]]) -> Option<Order> {
    let (slope, error) = slope(logs);
    let half = STUDENT.get(logs.len().checked_sub(POINTS_MIN)?)? * error;
    let meant = slope > FLAT && slope > half && half <= VAGUE;
    meant.then_some(Order {
        order: slope,
        low: slope - half,
        high: slope + half,
    })
}

/// Least squares: the slope and its standard error.
pub(in crate::study) fn slope(points: &[[f64; 2]]) -> (f64, f64) {
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
            assert!(found.high - found.low < 1e-6 && fit.points == 6);
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
        // The finest six of dt = 1/2 ... 1/128, which are above 2e-5 and below 0.3.
        assert_eq!(fit.points, 6);
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
}
