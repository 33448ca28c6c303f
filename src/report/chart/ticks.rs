//! Round numbers along an axis, and numbers as a reader would write them.

/// One labelled place on an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    /// Where it is, in the units of the data.
    pub(super) value: f64,
    /// What is written there.
    pub(super) label: String,
}

/// The ticks of a linear axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LinearTicks {
    /// Ticks from the lowest to the highest.
    pub(super) ticks: Vec<Tick>,
    /// The labels count in units of ten to this power.
    pub(super) exponent: i32,
    /// What a label "0" stands for, when it is not 0: the values differ too little from
    /// each other, compared with their size, for their digits to be written out.
    pub(super) offset: Option<String>,
}

/// At most `most` ticks at multiples of 1, 2 or 5 times a power of ten within
/// `low..=high`. Wants finite limits at least 1e-300 apart and `most >= 2`.
pub(super) fn linear(low: f64, high: f64, most: u32) -> LinearTicks {
    let span = high - low;
    let size = low.abs().max(high.abs());
    let shifted = span < 1e-5 * size;
    let offset = if shifted { roundest(low, high) } else { 0.0 };
    let (mantissa, exponent_of_step) = round_step(low - offset, high - offset, most.max(2));
    let step = f64::from(mantissa) * power_of_ten(exponent_of_step);
    let exponent = shared_exponent((low - offset).abs().max((high - offset).abs()));
    let decimals = usize::try_from(exponent - exponent_of_step).unwrap_or(0);
    let mut ticks: Vec<Tick> = Vec::new();
    let mut count = ((low - offset) / step - 1e-9).ceil();
    let last = ((high - offset) / step + 1e-9).floor();
    while count <= last {
        let value = offset + count * step;
        let shown = count * f64::from(mantissa) * power_of_ten(exponent_of_step - exponent);
        // An offset far above the step can leave two ticks at the same double.
        if ticks.last().is_none_or(|tick| tick.value < value) {
            let shown = if count == 0.0 { 0.0 } else { shown };
            let label = format!("{shown:.decimals$}").replace('-', "−");
            ticks.push(Tick { value, label });
        }
        count += 1.0;
    }
    LinearTicks {
        ticks,
        exponent,
        offset: shifted.then(|| offset_label(offset)),
    }
}

/// The powers of ten from `low` to `high` in steps that leave at most `most` of them.
pub(super) fn decades(low: i32, high: i32, most: u32) -> Vec<i32> {
    let most = i32::try_from(most.max(2)).unwrap_or(i32::MAX);
    let steps = [1, 2, 3, 5, 10, 20, 50, 100, 200, 500];
    let fits = |step: &i32| high.div_euclid(*step) - (low - 1).div_euclid(*step) <= most;
    let step = steps.into_iter().find(fits).unwrap_or(500);
    (low..=high).filter(|decade| decade % step == 0).collect()
}

/// A power of ten in words of an axis: 1, 10, 10², 10⁻¹².
pub(super) fn power_label(exponent: i32) -> String {
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        other => format!("10{}", superscript(other)),
    }
}

/// A number in running text, with two digits: 0.35, 1.2·10⁻¹⁶.
pub(super) fn rough(value: f64) -> String {
    let text = format!("{value:.1e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if value == 0.0 {
        "0".to_owned()
    } else if (-3..4).contains(&exponent) {
        let decimals = usize::try_from(1 - exponent).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        let mantissa = mantissa.strip_suffix(".0").unwrap_or(mantissa);
        format!("{mantissa}·10{}", superscript(exponent))
    }
}

/// `label` with a power of ten put in front of its unit: `z [mm]` becomes `z [10³ mm]`.
pub(super) fn with_exponent(label: &str, exponent: i32) -> String {
    if exponent == 0 {
        return label.to_owned();
    }
    let power = power_label(exponent);
    match label.rsplit_once('[') {
        Some((name, unit)) => format!("{name}[{power} {unit}"),
        None => format!("{label} [{power}]"),
    }
}

/// Digits and minus sign of an exponent, raised.
fn superscript(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    exponent
        .to_string()
        .chars()
        .filter_map(|c| match c {
            '-' => Some('⁻'),
            digit => digit
                .to_digit(10)
                .and_then(|d| DIGITS.get(d as usize).copied()),
        })
        .collect()
}

/// The smallest step of 1, 2 or 5 times a power of ten with at most `most` multiples
/// within `low..=high`.
fn round_step(low: f64, high: f64, most: u32) -> (u8, i32) {
    let smallest = floor_log10((high - low) / f64::from(most)) - 1;
    let steps = (smallest..).flat_map(|exponent| [1, 2, 5].map(|mantissa| (mantissa, exponent)));
    let fits = |&(mantissa, exponent): &(u8, i32)| {
        let step = f64::from(mantissa) * power_of_ten(exponent);
        (high / step + 1e-9).floor() - (low / step - 1e-9).ceil() < f64::from(most)
    };
    steps.take(9).find(fits).unwrap_or((1, smallest + 2))
}

/// The number within `low..=high` that needs the fewest digits.
fn roundest(low: f64, high: f64) -> f64 {
    let size = low.abs().max(high.abs());
    (0..17)
        .map(|digits| power_of_ten(floor_log10(size) - digits))
        .map(|unit| (low / unit).ceil() * unit)
        .find(|candidate| *candidate <= high)
        .unwrap_or(low)
}

/// The power of ten in which labels up to `size` stay short; 0 while plain digits are.
fn shared_exponent(size: f64) -> i32 {
    let decade = floor_log10(size);
    if (-3..5).contains(&decade) {
        0
    } else {
        decade.div_euclid(3) * 3
    }
}

/// An offset, written with the digits that it has.
fn offset_label(offset: f64) -> String {
    let text = format!("{offset:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let label = if (-4..8).contains(&exponent) {
        offset.to_string()
    } else {
        format!("{mantissa}·10{}", superscript(exponent))
    };
    label.replace('-', "−")
}

/// Ten to a power.
fn power_of_ten(exponent: i32) -> f64 {
    // Not `powi`: correctly rounded, so a multiple of 1e-3 is the double nearest to it.
    format!("1e{exponent}").parse().unwrap_or(f64::MAX)
}

/// The decade of a number: 0 for 1 to 10, -1 for 0.1 to 1; -300 below 1e-300.
pub(super) fn floor_log10(value: f64) -> i32 {
    let text = format!("{:e}", value.clamp(1e-300, f64::MAX));
    let exponent = text.split_once('e').map_or("0", |(_, exponent)| exponent);
    exponent.parse().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &LinearTicks) -> Vec<&str> {
        ticks.ticks.iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn steps_are_round_and_labels_plain() {
        assert_eq!(
            labels(&linear(0.0, 1.0, 6)),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(labels(&linear(-710.0, 710.0, 4)), ["−500", "0", "500"]);
        assert_eq!(labels(&linear(0.05, 0.34, 4)), ["0.1", "0.2", "0.3"]);
        assert_eq!(labels(&linear(0.0, 90_000.0, 3)), ["0", "50000"]);
    }

    #[test]
    fn large_and_small_numbers_share_an_exponent() {
        let large = linear(0.0, 6.1e7, 4);
        assert_eq!(large.exponent, 6);
        assert_eq!(labels(&large), ["0", "20", "40", "60"]);
        let small = linear(-2.0e-16, 2.0e-16, 5);
        assert_eq!(small.exponent, -18);
        assert_eq!(labels(&small), ["−200", "−100", "0", "100", "200"]);
    }

    #[test]
    fn nearly_constant_values_get_different_labels() {
        for span in [1e-3, 1e-6, 1e-9, 1e-11] {
            let ticks = linear(12_345.678_9, 12_345.678_9 + span, 6);
            let mut seen = labels(&ticks);
            let count = seen.len();
            assert!(count >= 3, "span {span}: {seen:?}");
            seen.sort_unstable();
            seen.dedup();
            assert_eq!(seen.len(), count, "span {span}");
        }
        let ticks = linear(1e6 - 0.25, 1e6 + 0.25, 5);
        assert_eq!(ticks.offset.as_deref(), Some("1000000"));
        assert_eq!(labels(&ticks), ["−0.2", "−0.1", "0.0", "0.1", "0.2"]);
    }

    #[test]
    fn never_more_ticks_than_asked_for_and_all_within() {
        let limits = [(0.0, 1.0), (-3.3, 7.9), (1e-300, 2e-300), (-1e300, 1e300)];
        for (low, high) in limits {
            for most in 2..12 {
                let ticks = linear(low, high, most).ticks;
                assert!(!ticks.is_empty(), "{low}..{high} by {most}");
                assert!(ticks.len() <= most as usize + 1, "{low}..{high} by {most}");
                let slack = (high - low) * 1e-9;
                assert!(ticks.iter().all(|t| t.value >= low - slack));
                assert!(ticks.iter().all(|t| t.value <= high + slack));
            }
        }
    }

    #[test]
    fn decades_are_never_too_many() {
        assert_eq!(decades(-3, 2, 12), [-3, -2, -1, 0, 1, 2]);
        assert_eq!(
            decades(-16, 3, 12),
            [-16, -14, -12, -10, -8, -6, -4, -2, 0, 2]
        );
        for (low, high) in [(-300, 300), (-17, 4), (0, 1), (5, 6)] {
            for most in 2..=12 {
                let found = decades(low, high, most).len();
                assert!(
                    (1..=most as usize).contains(&found),
                    "{low}..{high} by {most}"
                );
            }
        }
    }

    #[test]
    fn powers_and_units_read_well() {
        assert_eq!(power_label(-16), "10⁻¹⁶");
        assert_eq!(power_label(0), "1");
        assert_eq!(with_exponent("z [mm]", 3), "z [10³ mm]");
        assert_eq!(with_exponent("drift", -6), "drift [10⁻⁶]");
        assert_eq!(with_exponent("drift", 0), "drift");
        assert_eq!(rough(3.14e-16), "3.1·10⁻¹⁶");
        assert_eq!(rough(2e-16), "2·10⁻¹⁶");
        assert_eq!(rough(0.35), "0.35");
        assert_eq!(rough(0.0), "0");
    }
}
