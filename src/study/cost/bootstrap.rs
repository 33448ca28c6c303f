//! How sure a ratio of two prices is.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

use crate::study::median::median;

/// Resamples of one interval.
const RESAMPLES: usize = 2000;
/// With fewer pairs there is no interval.
const PAIRS_MIN: usize = 3;

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

/// Seeded random numbers, the same on every platform.
pub(super) struct Dice(Pcg64);

impl Dice {
    pub(super) fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// Below `count`, which is small: the bias is below 1e-15.
    pub(super) fn below(&mut self, count: usize) -> usize {
        let found = self.0.next_u64() % (count.max(1) as u64);
        usize::try_from(found).unwrap_or(0)
    }

    /// Puts the items into random order (Fisher and Yates).
    pub(super) fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

/// The median of the ratios `a[i] / b[i]`, measured in the same round each, with a percentile
/// bootstrap interval; none with fewer than three rounds.
#[must_use]
pub fn paired_ratio(a: &[f64], b: &[f64], seed: u64) -> Option<Ratio> {
    let ratios: Vec<f64> = a.iter().zip(b).map(|(a, b)| a / b).collect();
    if ratios.len() < PAIRS_MIN || ratios.iter().any(|ratio| !ratio.is_finite()) {
        return None;
    }
    let [low, high] = interval(ratios.len(), seed, |drawn| {
        let drawn: Vec<f64> = drawn.iter().map(|at| ratios[*at]).collect();
        median(&drawn)
    });
    Some(Ratio {
        median: median(&ratios),
        low,
        high,
    })
}

/// The 95 % percentile interval of a statistic under resampling; it is given the places that
/// were drawn, as many as there are.
pub(super) fn interval(
    count: usize,
    seed: u64,
    mut statistic: impl FnMut(&[usize]) -> f64,
) -> [f64; 2] {
    let mut dice = Dice::new(seed);
    let mut drawn = vec![0; count];
    let mut resample = || {
        drawn.fill_with(|| dice.below(count));
        statistic(&drawn)
    };
    let mut found: Vec<f64> = (0..RESAMPLES).map(|_| resample()).collect();
    found.sort_by(f64::total_cmp);
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
        assert_eq!(paired_ratio(&a[..2], &b, 1), None);
    }

    #[test]
    fn shuffling_keeps_every_item() {
        let mut items: Vec<usize> = (0..50).collect();
        Dice::new(3).shuffle(&mut items);
        assert_ne!(items, (0..50).collect::<Vec<_>>());
        items.sort_unstable();
        assert_eq!(items, (0..50).collect::<Vec<_>>());
    }
}
