//! Prices: wall time of `advance_to` alone, everybody in turn and in random order.

use std::time::{Duration, Instant};

use super::bootstrap::Dice;
use super::contender::Contender;
use super::{CostOptions, Stage, Watcher};
use crate::engine::{Simulation, prepare};
use crate::error::Result;
use crate::study::median::median;

/// A measurement lasts at least about so long; shorter runs are repeated within it.
const LEAST: Duration = Duration::from_millis(1);
/// But not more often than this.
const BATCH_MAX: usize = 64;

/// One run to be priced.
pub(super) struct Job<'a> {
    pub(super) contender: &'a Contender,
    pub(super) dt: f64,
}

/// The part of a scene that is priced.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    /// Its last sample.
    pub(super) sample: usize,
    /// Time of that sample, s.
    pub(super) seconds: f64,
}

/// What a run costs.
#[derive(Debug, Clone, PartialEq)]
pub struct Price {
    /// Milliseconds per simulated second, round by round.
    pub rounds: Vec<f64>,
    /// Their median.
    pub median: f64,
    /// The smallest of them.
    pub min: f64,
    /// Steps counted by the engine.
    pub steps: u64,
}

/// Prices every job up to a sample: a warm-up, then a round for each repetition. In each round
/// everybody runs once, freshly prepared, in an order drawn anew from the seed.
///
/// # Errors
/// As [`prepare`].
pub(super) fn prices(
    jobs: &[Job],
    stretch: Stretch,
    options: &CostOptions,
    watch: Watcher,
) -> Result<Vec<Price>> {
    let mut dice = Dice::new(options.seed);
    let mut batches = vec![1; jobs.len()];
    let mut rounds = vec![Vec::new(); jobs.len()];
    let mut steps = vec![0; jobs.len()];
    let total = jobs.len() * (options.repetitions + 1);
    let mut done = 0;
    for round in 0..=options.repetitions {
        let mut order: Vec<usize> = (0..jobs.len()).collect();
        dice.shuffle(&mut order);
        for place in order {
            let job = &jobs[place];
            let (spent, counted) = time(job, stretch.sample, batches[place])?;
            if round == 0 {
                batches[place] = batch(spent);
                steps[place] = counted;
            } else {
                rounds[place].push(1e3 * spent.as_secs_f64() / stretch.seconds);
            }
            done += 1;
            watch(Stage::Pricing, done, total);
        }
    }
    let price = |(rounds, steps): (Vec<f64>, u64)| Price {
        median: median(&rounds),
        min: rounds.iter().copied().fold(f64::INFINITY, f64::min),
        rounds,
        steps,
    };
    Ok(rounds.into_iter().zip(steps).map(price).collect())
}

/// How many runs make a measurement.
fn batch(one: Duration) -> usize {
    let wanted = LEAST.as_nanos() / one.as_nanos().max(1);
    usize::try_from(wanted)
        .unwrap_or(BATCH_MAX)
        .clamp(1, BATCH_MAX)
}

/// Time of one run, the mean of a batch, and the steps of one.
fn time(job: &Job, sample: usize, batch: usize) -> Result<(Duration, u64)> {
    let fresh = || prepare(&job.contender.scene, &job.contender.spec, job.dt);
    let mut simulations: Vec<Box<dyn Simulation + Send>> =
        (0..batch).map(|_| fresh()).collect::<Result<_>>()?;
    let start = Instant::now();
    for simulation in &mut simulations {
        std::hint::black_box(simulation.advance_to(sample, None));
    }
    let spent = start.elapsed();
    let steps = simulations.first().map_or(0, |one| one.work().steps);
    let share = u32::try_from(batch).unwrap_or(1);
    Ok((spent / share, steps))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_runs_are_repeated_and_long_ones_are_not() {
        assert_eq!(batch(Duration::from_micros(100)), 10);
        assert_eq!(batch(Duration::from_nanos(1)), BATCH_MAX);
        assert_eq!(batch(Duration::ZERO), BATCH_MAX);
        assert_eq!(batch(Duration::from_secs(1)), 1);
    }
}
