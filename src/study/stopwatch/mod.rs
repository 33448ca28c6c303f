//! Prices: wall time of `advance_to` alone, everybody in turn and in random order.
//!
//! Whatever slows the machine slows neighbours in time alike, so costs are compared within a
//! round; each round has an order of its own, so that nobody always follows the same
//! neighbour's heat.

mod dice;
mod ratio;

pub(super) use dice::Dice;
pub use ratio::{PAIRS_MIN, Ratio, paired_ratio};
pub(super) use ratio::{interval, paired};

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::median::median;
use crate::engine::{EngineSpec, Simulation, prepare};
use crate::error::Result;
use crate::recording::Work;
use crate::scene::Scene;

/// A measurement lasts at least about so long; shorter runs are repeated within it.
const LEAST: Duration = Duration::from_millis(2);
/// But not more often than this.
const BATCH_MAX: u32 = 256;
/// The rounds end early once they have taken so long for each job …
const PATIENCE: Duration = Duration::from_millis(2500);
/// … but not before so many, with which a ratio has an interval.
pub const ROUNDS_MIN: usize = PAIRS_MIN;

/// A run to be timed from one sample of a scene to a later one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Job<'a> {
    pub(super) scene: &'a Scene,
    pub(super) spec: &'a EngineSpec,
    pub(super) dt: f64,
    /// What comes before is run, and not timed.
    pub(super) from: usize,
    pub(super) to: usize,
}

/// How often, and in which order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Timing {
    /// Seed of the order of runs and of the intervals.
    pub seed: u64,
    /// Rounds of timing, the warm-up not counted.
    pub repetitions: usize,
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
    /// Work that the engine counted in the run that was timed.
    pub work: Work,
}

impl Price {
    /// From the costs of the rounds, ms per simulated second, and the work of one run.
    #[must_use]
    pub fn new(rounds: Vec<f64>, work: Work) -> Self {
        Self {
            median: median(&rounds),
            min: rounds.iter().copied().fold(f64::INFINITY, f64::min),
            rounds,
            work,
        }
    }
}

/// Prices every job: a warm-up, then a round for each repetition, fewer where they take long. In
/// each round everybody runs once, freshly prepared, in an order drawn anew from the seed.
///
/// `watch` is told how many runs are done, and of how many.
///
/// # Errors
/// As [`prepare`].
pub(super) fn prices(
    jobs: &[Job],
    timing: Timing,
    watch: &dyn Fn(usize, usize),
) -> Result<Vec<Price>> {
    let mut dice = Dice::new(timing.seed);
    let mut batches = vec![1; jobs.len()];
    let mut rounds = vec![Vec::new(); jobs.len()];
    let mut works = vec![Work::default(); jobs.len()];
    let total = jobs.len() * (timing.repetitions + 1);
    let mut done = 0;
    let begin = Instant::now();
    for round in 0..=timing.repetitions {
        if round > ROUNDS_MIN && begin.elapsed().as_secs_f64() > patience(jobs.len()) {
            break;
        }
        let mut order: Vec<usize> = (0..jobs.len()).collect();
        dice.shuffle(&mut order);
        for place in order {
            let job = &jobs[place];
            let (spent, work) = time(job, batches[place])?;
            if round == 0 {
                batches[place] = batch(spent);
                works[place] = work;
            } else {
                let seconds = job.scene.sample_time(job.to) - job.scene.sample_time(job.from);
                rounds[place].push(1e3 * spent / seconds);
            }
            done += 1;
            watch(done, total);
        }
    }
    let prices = rounds.into_iter().zip(works);
    Ok(prices
        .map(|(rounds, work)| Price::new(rounds, work))
        .collect())
}

/// Time after which so many jobs are timed no more, s.
#[allow(clippy::cast_precision_loss, reason = "some thousand jobs")]
fn patience(jobs: usize) -> f64 {
    PATIENCE.as_secs_f64() * jobs as f64
}

/// How many runs make a measurement, where one takes so many seconds.
fn batch(one: f64) -> u32 {
    let least = LEAST.as_secs_f64();
    let mut runs = 1;
    while runs < BATCH_MAX && f64::from(runs) * one < least {
        runs += 1;
    }
    runs
}

/// Time of one run, the mean of a batch, s, and the work of one.
fn time(job: &Job, batch: u32) -> Result<(f64, Work)> {
    let fresh = || -> Result<Box<dyn Simulation + Send>> {
        let mut simulation = prepare(job.scene, job.spec, job.dt)?;
        simulation.advance_to(job.from, None);
        Ok(simulation)
    };
    let mut simulations: Vec<_> = (0..batch).map(|_| fresh()).collect::<Result<_>>()?;
    let before = simulations.first().map(|first| first.work());
    let start = Instant::now();
    for simulation in &mut simulations {
        // How it ends is known from elsewhere.
        std::hint::black_box(simulation.advance_to(job.to, None));
    }
    let spent = start.elapsed().as_secs_f64();
    let after = simulations.first().map(|first| first.work());
    let work = after.unwrap_or_default() - before.unwrap_or_default();
    Ok((spent / f64::from(batch), work))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::engine;

    #[test]
    fn short_runs_are_repeated_and_long_ones_are_not() {
        assert_eq!(batch(2e-4), 10);
        assert_eq!(batch(1e-9), BATCH_MAX);
        assert_eq!(batch(0.0), BATCH_MAX);
        assert_eq!(batch(1.0), 1);
    }

    /// Two balls, four samples of 1 s, a step of 0.5 s: the work of the two samples that are timed
    /// is four steps, a pair each.
    #[test]
    fn the_lead_in_is_neither_timed_nor_counted() {
        let text = "name='x'\nduration=4\nsample_every=1\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
            [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[9,0,0]\nvelocity=[0,0,0]\n\
            [effects.contact]\nrestitution=1\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let spec = engine("lecture").unwrap();
        let job = Job {
            scene: &scene,
            spec: &spec,
            dt: 0.5,
            from: 2,
            to: 4,
        };
        let timing = Timing {
            seed: 1,
            repetitions: 2,
        };
        let [price] = &prices(&[job], timing, &|_, _| {}).unwrap()[..] else {
            panic!("one job, one price")
        };
        assert_eq!((price.work.steps, price.work.pair_tests), (4, 4));
        assert_eq!(price.rounds.len(), 2);
        assert!(0.0 < price.min && price.min <= price.median);
    }
}
