//! How sure a ratio of two prices is.

use super::dice::Dice;
use crate::study::median::median;

/// Resamples of one interval.
const RESAMPLES: usize = 2000;
/// With fewer pairs there is no interval: not even the least and the largest of five hold the
/// median in 95 % of cases (`1 - 2^-4`, the sign test).
pub const PAIRS_MIN: usize = 6;

/// A ratio with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// Median of the paired ratios.
    pub median: f64,
    /// Lower end, 2.5 %.
    pub low: f64,
    /// Upper end, 97.5 %.
    pub high: f64,
}

impl Ratio {
    /// Whether it can be told which of the two is larger.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.low > 1.0 || self.high < 1.0
    }
}

/// The ratios `a[i] / b[i]`, measured in the same round each.
pub(in crate::study) fn paired(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a / b).collect()
}

/// The median of the ratios `a[i] / b[i]`, measured in the same round each, with a percentile
/// bootstrap interval; none with fewer than six rounds.
///
/// The bootstrap knows the median of few numbers only as one of few values. Its ends are
/// therefore rounded outwards, to the next value that it drew: the plain percentiles of seven
/// rounds would hold the median in 87.5 % of cases instead of 95 %.
#[must_use]
pub fn paired_ratio(a: &[f64], b: &[f64], seed: u64) -> Option<Ratio> {
    let ratios = paired(a, b);
    if ratios.len() < PAIRS_MIN || ratios.iter().any(|ratio| !ratio.is_finite()) {
        return None;
    }
    let found = resampled(ratios.len(), seed, |drawn| {
        let drawn: Vec<f64> = drawn.iter().map(|at| ratios[*at]).collect();
        median(&drawn)
    });
    let [low, high] = percentiles(&found);
    let lower = found.partition_point(|median| *median < low);
    let higher = found.partition_point(|median| *median <= high);
    Some(Ratio {
        median: median(&ratios),
        low: lower.checked_sub(1).map_or(low, |place| found[place]),
        high: found.get(higher).copied().unwrap_or(high),
    })
}

/// The 95 % percentile interval of a statistic under resampling; it is given the places that
/// were drawn, as many as there are.
pub(in crate::study) fn interval(
    count: usize,
    seed: u64,
    statistic: impl FnMut(&[usize]) -> f64,
) -> [f64; 2] {
    percentiles(&resampled(count, seed, statistic))
}

/// A statistic of every resample, in order of size.
fn resampled(count: usize, seed: u64, mut statistic: impl FnMut(&[usize]) -> f64) -> Vec<f64> {
    let mut dice = Dice::new(seed);
    let mut drawn = vec![0; count];
    let mut resample = || {
        drawn.fill_with(|| dice.below(count));
        statistic(&drawn)
    };
    let mut found: Vec<f64> = (0..RESAMPLES).map(|_| resample()).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// Of sorted resamples, those at 2.5 % and 97.5 %.
fn percentiles(found: &[f64]) -> [f64; 2] {
    [found[RESAMPLES / 40], found[RESAMPLES - 1 - RESAMPLES / 40]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_ratio_is_found_and_decided() {
        let b: Vec<f64> = (1..=9).map(f64::from).collect();
        let noise = [0.98, 1.0, 1.01, 1.02, 0.99, 1.0, 1.03, 0.97, 1.0];
        let a: Vec<f64> = b.iter().zip(noise).map(|(b, n)| 2.0 * b * n).collect();
        let ratio = paired_ratio(&a, &b, 7).unwrap();
        assert!((ratio.median - 2.0).abs() < 1e-12, "{ratio:?}");
        assert!(ratio.low >= 1.94 && ratio.low <= 2.0 && ratio.high >= 2.0 && ratio.high <= 2.06);
        assert!(ratio.is_decided());
        assert_eq!(paired_ratio(&a, &b, 7), Some(ratio), "the seed decides");
    }

    #[test]
    fn equals_are_not_ranked() {
        let b = vec![1.0; 8];
        let a = [0.8, 1.2, 0.9, 1.1, 0.7, 1.3, 0.95, 1.05];
        assert!(!paired_ratio(&a, &b, 1).unwrap().is_decided());
        assert_eq!(paired_ratio(&a[..5], &b, 1), None);
    }

    /// Skewed noise, as of clocks: uniform numbers squared, whose median is 1/4. Of 200
    /// intervals at 95 %, 190 hold it, with a deviation of 3.1; 181 is three of them below.
    #[test]
    fn the_interval_holds_the_median_as_often_as_it_says() {
        let mut dice = Dice::new(11);
        for rounds in [6, 7, 8, 11] {
            let mut holds = 0;
            for seed in 0..200 {
                let mut draw = || dice.below(1_000_000);
                #[allow(clippy::cast_precision_loss, reason = "up to a million")]
                let noise: Vec<f64> = (0..rounds)
                    .map(|_| ((draw() as f64 + 0.5) / 1e6).powi(2))
                    .collect();
                let ratio = paired_ratio(&noise, &vec![1.0; rounds], seed).unwrap();
                holds += i32::from(ratio.low <= 0.25 && 0.25 <= ratio.high);
            }
            assert!(holds >= 181, "{rounds} rounds: {holds} of 200");
        }
    }
}
