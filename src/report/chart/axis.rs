//! From values to places along one side of a plot, with the labels there.

use super::ChartError;
use super::text::width;
use super::theme::SMALL_PX;
use super::ticks::{LinearTicks, decades, linear, power_label, rough};

/// How values are laid out along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences, equal distances.
    Linear,
    /// Equal ratios, equal distances. Values of exactly 0 are drawn on a line of their own,
    /// labelled "0", below the lowest decade; negative values leave a gap.
    Log,
}

/// Larger values are drawn here; beyond it, differences overflow.
const LARGEST: f64 = 1e300;
/// Values are told apart down to this difference.
const SMALLEST_SPAN: f64 = 1e-300;
/// Where on a log axis the zeros lie, if there are any.
const ZERO_LINE: f64 = 0.035;
/// Room at the upper end of a log axis and, without zeros, at the lower end.
const LOG_PAD: f64 = 0.03;

/// A labelled place, as a share (0 to 1) of the axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Label {
    /// Where.
    pub(super) share: f64,
    /// What is written there.
    pub(super) text: String,
}

/// One side of a plot.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    map: Map,
    /// Labelled places.
    pub(super) labels: Vec<Label>,
    /// Lines of the grid without a label.
    pub(super) minor: Vec<f64>,
    /// The labels count in units of ten to this power.
    pub(super) exponent: i32,
    /// What a reader must know beyond the labels.
    pub(super) note: Option<String>,
}

/// The rule from values to shares of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Map {
    Linear {
        low: f64,
        high: f64,
    },
    /// `low` and `high` are powers of ten; the decades start at the share `from`.
    Log {
        low: f64,
        high: f64,
        from: f64,
        has_zero: bool,
    },
}

/// When a curve counts as constant and is drawn flat instead of as magnified rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Steadiness {
    /// The size that changes are compared with, if it is larger than the values drawn.
    pub(super) size: f64,
    /// A smaller range than this share of the size is drawn as a flat line.
    pub(super) least_span: f64,
}

impl Axis {
    /// A linear axis from `low` to `high` with at most `most` labels.
    pub(super) fn between(low: f64, high: f64, most: u32) -> Self {
        let LinearTicks {
            ticks,
            exponent,
            offset,
        } = linear(low, high, most);
        let map = Map::Linear { low, high };
        let labels = ticks
            .into_iter()
            .filter_map(|tick| {
                let share = map.share(tick.value)?;
                let text = tick.label;
                Some(Label { share, text })
            })
            .collect();
        Self {
            map,
            labels,
            minor: Vec::new(),
            exponent,
            note: offset.map(|offset| format!("0 stands for {offset}")),
        }
    }

    /// A linear axis that holds all finite values, with a little room around them.
    pub(super) fn holding(values: &[f64], steady: Steadiness, most: u32) -> Self {
        let Some([low, high]) = extent(values) else {
            return Self {
                note: Some("no data".to_owned()),
                ..Self::between(0.0, 1.0, most)
            };
        };
        let span = high - low;
        let size = low.abs().max(high.abs()).max(steady.size);
        if span > SMALLEST_SPAN && span > steady.least_span * size {
            let pad = 0.06 * span;
            return Self::between(low - pad, high + pad, most);
        }
        let reach = if size > 1e9 * SMALLEST_SPAN {
            0.1 * size
        } else {
            1.0
        };
        let center = low + span / 2.0;
        let note = if span == 0.0 {
            "constant".to_owned()
        } else {
            format!("constant to within {}", rough(span))
        };
        Self {
            note: Some(note),
            ..Self::between(center - reach, center + reach, most)
        }
    }

    /// A linear axis whose ends are the smallest and the largest finite value; for a
    /// single value an axis that starts (or, below 0, ends) at 0.
    pub(super) fn tight(values: &[f64], most: u32) -> Self {
        let [low, high] = extent(values).unwrap_or([0.0, 1.0]);
        if high - low > SMALLEST_SPAN && high - low > 1e-12 * low.abs().max(high.abs()) {
            return Self::between(low, high, most);
        }
        if high.abs() <= 1e-9 {
            return Self::between(0.0, 1.0, most);
        }
        Self::between((2.0 * low).min(0.0), (2.0 * high).max(0.0), most)
    }

    /// A logarithmic axis over whole decades that holds all positive finite values, and
    /// a line for zeros where there are any.
    pub(super) fn decades(values: &[f64], most: u32) -> Self {
        let positive: Vec<f64> = values.iter().copied().filter(|v| *v > 0.0).collect();
        let has_zero = values.contains(&0.0);
        let (low, high, note) = match extent(&positive) {
            Some([low, high]) => {
                let (low, high) = (low.log10().floor(), high.log10().ceil());
                let note = has_zero.then(|| "grey: exactly 0".to_owned());
                if low < high {
                    (low, high, note)
                } else {
                    (low - 1.0, high + 1.0, note)
                }
            }
            None if has_zero => (-3.0, 0.0, Some("0 throughout".to_owned())),
            None => (-3.0, 0.0, Some("no data".to_owned())),
        };
        let (from, most) = if has_zero {
            // One label's room between the zeros and the lowest decade.
            (ZERO_LINE + 0.9 / f64::from(most), most - 1)
        } else {
            (LOG_PAD, most)
        };
        let map = Map::Log {
            low,
            high,
            from,
            has_zero,
        };
        let share = |exponent: f64| decade_share(exponent, low, high, from);
        #[expect(clippy::cast_possible_truncation, reason = "decades of doubles")]
        let (first, last) = (low as i32, high as i32);
        let mut labels: Vec<Label> = decades(first, last, most)
            .into_iter()
            .map(|exponent| Label {
                share: share(f64::from(exponent)),
                text: power_label(exponent),
            })
            .collect();
        if has_zero {
            let text = "0".to_owned();
            let share = ZERO_LINE;
            labels.insert(0, Label { share, text });
        }
        let minor = if last - first <= 4 {
            (first..last)
                .flat_map(|decade| (2..10).map(move |digit| (decade, digit)))
                .map(|(decade, digit)| share(f64::from(decade) + f64::from(digit).log10()))
                .collect()
        } else {
            Vec::new()
        };
        Self {
            map,
            labels,
            minor,
            exponent: 0,
            note,
        }
    }

    /// Where a value lies, as a share of the axis; `None` for what cannot be drawn.
    pub(super) fn share(&self, value: f64) -> Option<f64> {
        self.map.share(value)
    }

    /// Up to which share the line for zeros and its surroundings reach; 0 without one.
    pub(super) fn zero_band(&self) -> f64 {
        match self.map {
            Map::Log { from, has_zero, .. } if has_zero => from,
            Map::Linear { .. } | Map::Log { .. } => 0.0,
        }
    }
}

impl Map {
    fn share(&self, value: f64) -> Option<f64> {
        if !value.is_finite() {
            return None;
        }
        match *self {
            Self::Linear { low, high } => {
                Some((value.clamp(-LARGEST, LARGEST) - low) / (high - low))
            }
            Self::Log { has_zero, .. } if value == 0.0 => has_zero.then_some(ZERO_LINE),
            Self::Log {
                low, high, from, ..
            } => (value > 0.0).then(|| decade_share(value.min(LARGEST).log10(), low, high, from)),
        }
    }
}

/// Where a power of ten lies on a log axis that starts at the share `from`.
fn decade_share(exponent: f64, low: f64, high: f64, from: f64) -> f64 {
    from + (exponent - low) / (high - low) * (1.0 - LOG_PAD - from)
}

/// The axis with the most labels, up to 12, that fit side by side in the room.
pub(super) fn fitting(room: f64, make: impl Fn(u32) -> Axis) -> Result<Axis, ChartError> {
    let mut most = 12;
    loop {
        let axis = make(most);
        let mut wide: f64 = 0.0;
        for label in &axis.labels {
            wide = wide.max(width(&label.text, SMALL_PX)?);
        }
        let mut shares: Vec<f64> = axis.labels.iter().map(|label| label.share).collect();
        shares.sort_by(f64::total_cmp);
        let near = |pair: &[f64]| (pair[1] - pair[0]) * room < wide + SMALL_PX;
        if most <= 2 || !shares.windows(2).any(near) {
            return Ok(axis);
        }
        most -= 1;
    }
}

/// The smallest and the largest finite value.
pub(super) fn extent(values: &[f64]) -> Option<[f64; 2]> {
    let mut found: Option<[f64; 2]> = None;
    for value in values.iter().filter(|value| value.is_finite()) {
        let value = value.clamp(-LARGEST, LARGEST);
        let [low, high] = found.unwrap_or([value; 2]);
        found = Some([low.min(value), high.max(value)]);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::text::register;
    use super::*;

    const STRICT: Steadiness = Steadiness {
        size: 0.0,
        least_span: 1e-9,
    };

    fn texts(axis: &Axis) -> Vec<&str> {
        axis.labels
            .iter()
            .map(|label| label.text.as_str())
            .collect()
    }

    #[test]
    fn rounding_noise_is_drawn_flat_and_says_so() {
        let noisy = [2.0e6, 2.0e6 + 4e-9, 2.0e6 - 1e-9];
        let axis = Axis::holding(&noisy, STRICT, 6);
        let share = |v| axis.share(v).unwrap();
        assert!((share(noisy[0]) - share(noisy[1])).abs() < 1e-6);
        assert!(
            axis.note
                .as_deref()
                .unwrap()
                .starts_with("constant to within")
        );
        let all = Steadiness {
            least_span: 0.0,
            ..STRICT
        };
        let magnified = Axis::holding(&noisy, all, 6);
        assert!((magnified.share(noisy[1]).unwrap() - 0.94).abs() < 0.05);
        assert!(magnified.note.unwrap().starts_with("0 stands for 2000000"));
    }

    #[test]
    fn noise_around_zero_is_judged_by_the_size_given() {
        let noise = [1e-13, -2e-13, 0.0];
        let given = Steadiness {
            size: 800.0,
            ..STRICT
        };
        assert!(Axis::holding(&noise, given, 5).note.is_some());
        assert!(Axis::holding(&noise, STRICT, 5).note.is_none());
    }

    #[test]
    fn constants_and_nothing_have_an_axis() {
        assert_eq!(texts(&Axis::holding(&[0.0, 0.0], STRICT, 5)).len(), 5);
        let five = Axis::holding(&[5.0], STRICT, 5);
        assert_eq!(five.note.as_deref(), Some("constant"));
        assert!((five.share(5.0).unwrap() - 0.5).abs() < 1e-9);
        assert_eq!(
            Axis::holding(&[f64::NAN], STRICT, 5).note.unwrap(),
            "no data"
        );
        assert_eq!(Axis::tight(&[3.0], 5).share(3.0), Some(0.5));
    }

    #[test]
    fn a_single_time_has_an_axis_that_starts_at_zero() {
        assert_eq!(Axis::tight(&[0.0], 5).share(0.0), Some(0.0));
        assert_eq!(Axis::tight(&[0.0], 5).share(1.0), Some(1.0));
        assert_eq!(texts(&Axis::tight(&[0.2], 5))[0], "0.0");
        assert_eq!(Axis::tight(&[0.2], 5).share(0.2), Some(0.5));
        assert_eq!(Axis::tight(&[-2.0], 5).share(0.0), Some(1.0));
        let late = Axis::tight(&[1e9, 1e9 + 1e-6], 5);
        assert_eq!(late.share(0.0), Some(0.0));
    }

    #[test]
    fn values_that_cannot_be_drawn_have_no_place() {
        let axis = Axis::holding(&[0.0, 1.0], STRICT, 5);
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(axis.share(value), None);
        }
        let log = Axis::decades(&[1e-3, 1e3], 12);
        assert_eq!(log.share(-1.0), None);
        assert_eq!(log.share(0.0), None);
        assert_eq!(log.share(1.0), Some(0.5));
    }

    #[test]
    fn zeros_have_their_own_line_on_a_log_axis() {
        let axis = Axis::decades(&[0.0, 1e-16, 1e3], 12);
        assert_eq!(texts(&axis)[0], "0");
        assert!(axis.share(0.0) < axis.share(1e-16));
        assert_eq!(axis.note.as_deref(), Some("grey: exactly 0"));
        assert_eq!(Axis::decades(&[1e-16, 1e3], 12).note, None);
        let zeros = Axis::decades(&[0.0, 0.0], 12);
        assert_eq!(zeros.note.as_deref(), Some("0 throughout"));
        assert!(zeros.share(0.0).is_some());
    }

    #[test]
    fn extreme_ranges_stay_finite() {
        for values in [[-1e308, 1e308], [1e-300, 2e-300], [5e-324, 1e-323]] {
            for axis in [Axis::holding(&values, STRICT, 6), Axis::decades(&values, 6)] {
                for value in values.into_iter().filter_map(|v| axis.share(v)) {
                    assert!((-0.01..=1.01).contains(&value), "{values:?}: {value}");
                }
                assert!(axis.labels.iter().all(|l| l.share.is_finite()));
            }
        }
    }

    #[test]
    fn labels_of_the_time_axis_keep_their_distance() {
        register().unwrap();
        let axis = fitting(400.0, |most| Axis::tight(&[0.0, 12_345.0], most)).unwrap();
        let wide = width("10000", SMALL_PX).unwrap();
        for pair in axis.labels.windows(2) {
            assert!((pair[1].share - pair[0].share) * 400.0 > wide);
        }
        assert!(axis.labels.len() >= 2);
    }
}
