//! What a simulated second costs: candidates timed in turn, so that a drifting machine slows
//! all alike.

use std::time::{Duration, Instant};

use serde::Serialize;

use super::median::median;
use crate::engine::{EngineSpec, prepare};
use crate::error::Result;
use crate::scene::Scene;

/// A measurement lasts at least this long: shorter runs are repeated within it.
const MEASUREMENT: Duration = Duration::from_millis(2);

/// Runs within one measurement at most.
const RUNS_MAX: u32 = 10_000;

/// Repetitions end early once an engine has taken this long …
const SPENT_MAX: Duration = Duration::from_secs(20);

/// … but not before so many.
const REPETITIONS_MIN: usize = 3;

/// The cost of a simulated second, and how it stands to that of the unchanged scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Price {
    /// Median over the repetitions, ms.
    pub median_ms_per_sim_s: f64,
    /// Least of the repetitions, ms.
    pub min_ms_per_sim_s: f64,
    /// Median over the repetitions of this cost over that of the unchanged scene beside it.
    pub ratio: f64,
    /// Lower end of the 95 % interval of that median.
    pub ratio_low: f64,
    /// Upper end of it.
    pub ratio_high: f64,
    /// Repetitions that were timed.
    pub repetitions: usize,
}

/// A scene to be timed up to a sample; not at all up to sample 0.
pub(super) struct Candidate<'a> {
    pub scene: &'a Scene,
    pub samples: usize,
}

impl Candidate<'_> {
    /// Time for so many runs without recording, preparation not counted.
    fn time(&self, spec: &EngineSpec, dt: f64, runs: u32) -> Result<Duration> {
        let mut spent = Duration::ZERO;
        for _ in 0..runs {
            let mut simulation = prepare(self.scene, spec, dt)?;
            let start = Instant::now();
            // How it ends is known from the recording.
            std::hint::black_box(simulation.advance_to(self.samples, None));
            spent += start.elapsed();
        }
        Ok(spent)
    }

    /// How many runs make a measurement, from a first run that is the warm-up too.
    fn runs(&self, spec: &EngineSpec, dt: f64) -> Result<u32> {
        let once = self.time(spec, dt, 1)?.max(Duration::from_nanos(1));
        let runs = MEASUREMENT.as_nanos().div_ceil(once.as_nanos());
        Ok(u32::try_from(runs).unwrap_or(RUNS_MAX).min(RUNS_MAX))
    }
}

/// The price of each candidate; the first is what the others are held against.
pub(super) fn prices(
    candidates: &[Candidate<'_>],
    spec: &EngineSpec,
    dt: f64,
    repetitions: usize,
) -> Result<Vec<Option<Price>>> {
    let begin = Instant::now();
    let timed = |candidate: &Candidate<'_>| candidate.samples > 0;
    let mut runs = Vec::with_capacity(candidates.len());
    for candidate in candidates {
        let count = timed(candidate).then(|| candidate.runs(spec, dt));
        runs.push(count.transpose()?.unwrap_or(0));
    }
    // Shape: [candidate][repetition], ms per simulated second.
    let mut costs = vec![Vec::new(); candidates.len()];
    for repetition in 0..repetitions {
        if repetition >= REPETITIONS_MIN && begin.elapsed() > SPENT_MAX {
            break;
        }
        // Another one begins each time, so that none always follows the same neighbour's heat.
        for turn in 0..candidates.len() {
            let place = (turn + repetition) % candidates.len();
            let candidate = &candidates[place];
            if timed(candidate) {
                let spent = candidate.time(spec, dt, runs[place])?;
                let simulated = candidate.scene.sample_time(candidate.samples);
                costs[place].push(spent.as_secs_f64() * 1e3 / (f64::from(runs[place]) * simulated));
            }
        }
    }
    Ok(costs.iter().map(|own| price(own, &costs[0])).collect())
}

/// From the costs of a candidate and, beside them, those of the first. Shape: `[repetition]`.
fn price(own: &[f64], first: &[f64]) -> Option<Price> {
    let ratios = sorted(own.iter().zip(first).map(|(own, first)| own / first));
    let own = sorted(own.iter().copied());
    let (ratio_low, ratio_high) = interval(&ratios)?;
    Some(Price {
        median_ms_per_sim_s: median(&own),
        min_ms_per_sim_s: *own.first()?,
        ratio: median(&ratios),
        ratio_low,
        ratio_high,
        repetitions: own.len(),
    })
}

fn sorted(numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut numbers: Vec<_> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    numbers
}

/// The interval that holds the median in at least about 95 % of cases, whatever the
/// distribution: the numbers of rank `(n - 1.96 sqrt n) / 2`, rounded down, from either end.
/// Below eight numbers it is from the least to the largest.
///
/// Source: the sign test; Conover, Practical Nonparametric Statistics, 3.2.
fn interval(sorted: &[f64]) -> Option<(f64, f64)> {
    let last = sorted.len().checked_sub(1)?;
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of repetitions, far below 2^53"
    )]
    let rank = {
        let n = sorted.len() as f64;
        ((n - 1.96 * n.sqrt()) / 2.0).floor().max(1.0) as usize
    };
    Some((sorted[rank - 1], sorted[last + 1 - rank]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ranks from the binomial tables: for 11 numbers the second from either end (98.8 %), for
    /// 31 the tenth (97 %).
    #[test]
    fn the_interval_has_the_ranks_of_the_sign_test() {
        let numbers = |n: u32| (1..=n).map(f64::from).collect::<Vec<_>>();
        assert_eq!(interval(&[]), None);
        assert_eq!(interval(&numbers(1)), Some((1.0, 1.0)));
        assert_eq!(interval(&numbers(5)), Some((1.0, 5.0)));
        assert_eq!(interval(&numbers(11)), Some((2.0, 10.0)));
        assert_eq!(interval(&numbers(31)), Some((10.0, 22.0)));
    }

    #[test]
    fn ratios_are_of_costs_side_by_side() {
        let price = price(&[2.0, 30.0, 8.0], &[1.0, 10.0, 2.0]).unwrap();
        assert_eq!(
            (
                price.ratio,
                price.median_ms_per_sim_s,
                price.min_ms_per_sim_s
            ),
            (3.0, 8.0, 2.0)
        );
        assert_eq!((price.ratio_low, price.ratio_high), (2.0, 4.0));
    }
}
