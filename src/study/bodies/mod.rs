//! What a step costs as the number of bodies grows: where one engine overtakes another.

mod crossover;
mod join;
mod measure;
mod stretch;
#[cfg(test)]
pub(crate) mod testing;

pub use crossover::{Crossover, Standing};
pub use join::joined;
pub use measure::bodies_cost;

use serde::{Deserialize, Serialize};

use super::Machine;
use super::{Overhead, Refusal, Timing};
use crate::recording::Outcome;

/// The engine that the others of the same build are held against, where it takes part.
pub const BASE: &str = "lecture";

/// Whether there are walls while the clock runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Walls {
    /// The box stays closed. A wall is a half-space to Rapier, whose pair with every ball is held.
    Closed,
    /// The walls are gone when the clock starts, and the gas is free to spread.
    Open,
}

/// How the study is made.
#[derive(Debug, Clone, PartialEq)]
pub struct BodiesOptions {
    /// Numbers of bodies, ascending.
    pub sizes: Vec<usize>,
    /// The step of the engines that take steps, s.
    pub dt: f64,
    /// Share of the box that the spheres fill, the same at every size.
    pub filling: f64,
    /// Whether the box has walls.
    pub walls: Walls,
    /// How prices are taken; the seed is that of the velocities too.
    pub timing: Timing,
    /// Work that one run may take, in steps x bodies + pairs + forces.
    pub budget: u64,
}

/// An engine with a number of bodies; a row of `bodies.csv`, whose header are these names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodiesPoint {
    /// The build that it was measured with, as [`build`](crate::engine::build) names it.
    pub build: String,
    /// The engine.
    pub engine: String,
    /// Number of bodies.
    pub bodies: usize,
    /// The step taken, s; none for engines without steps.
    pub dt: Option<f64>,
    /// Share of the box that the spheres fill.
    pub filling: f64,
    /// Whether the box has walls.
    pub walls: Walls,
    /// Seed of the velocities and of the order of runs.
    pub seed: u64,
    /// A step, the median over the rounds, µs.
    pub step_us: Option<f64>,
    /// A step, the least of the rounds, µs.
    pub step_min_us: Option<f64>,
    /// A simulated second, the median over the rounds, ms.
    pub cost_ms_per_sim_s: Option<f64>,
    /// Steps that were timed in a round; impacts, for engines without steps.
    pub steps: Option<u64>,
    /// Forces evaluated in them, where the engine counts them.
    pub force_evaluations: Option<u64>,
    /// Pairs looked at in them, where the engine counts them.
    pub pair_tests: Option<u64>,
    /// Cost over that of the lecture's solver, the median of the ratios within each round; blank
    /// where that did not run.
    pub ratio: Option<f64>,
    /// Lower end of its 95 % interval; blank with too few rounds.
    pub ratio_low: Option<f64>,
    /// Upper end of it.
    pub ratio_high: Option<f64>,
    /// How the run ended; `BudgetSpent` for one that was not begun.
    pub outcome: String,
    /// Where it was measured.
    pub machine: String,
}

impl BodiesPoint {
    /// Whether it was not begun for its work.
    #[must_use]
    pub fn is_over_budget(&self) -> bool {
        self.outcome == Outcome::BudgetSpent { time: 0.0 }.word()
    }

    /// A step, µs; for engines without steps the share of a simulated second that a step of `dt`
    /// is.
    #[must_use]
    pub fn per_step_us(&self, dt: f64) -> Option<f64> {
        self.step_us
            .or_else(|| Some(1e3 * dt * self.cost_ms_per_sim_s?))
    }
}

/// An engine of one build, over all numbers of bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Series<'a> {
    /// The build.
    pub build: &'a str,
    /// The engine.
    pub engine: &'a str,
}

/// Cost against the number of bodies.
#[derive(Debug, Clone)]
pub struct BodiesStudy {
    /// How it was made.
    pub options: BodiesOptions,
    /// Where it was made, and what ran beside it.
    pub machine: Machine,
    /// The build that measured.
    pub build: String,
    /// Every point, by size and then engine; points of other builds follow.
    pub points: Vec<BodiesPoint>,
    /// Engines that cannot do the scene.
    pub refusals: Vec<Refusal>,
}

impl BodiesStudy {
    /// Every engine of every build, in the order of the points.
    #[must_use]
    pub fn series(&self) -> Vec<Series<'_>> {
        let mut all: Vec<Series> = Vec::new();
        for point in &self.points {
            let series = Series {
                build: &point.build,
                engine: &point.engine,
            };
            if !all.contains(&series) {
                all.push(series);
            }
        }
        all
    }

    /// The points of a series, by size.
    #[must_use]
    pub fn of(&self, series: Series) -> Vec<&BodiesPoint> {
        let own =
            |point: &&BodiesPoint| point.build == series.build && point.engine == series.engine;
        let mut points: Vec<_> = self.points.iter().filter(own).collect();
        points.sort_by_key(|point| point.bodies);
        points
    }

    /// The point of a series at a number of bodies.
    #[must_use]
    pub fn at(&self, series: Series, bodies: usize) -> Option<&BodiesPoint> {
        let mut points = self.of(series).into_iter();
        points.find(|point| point.bodies == bodies)
    }

    /// The numbers of bodies, ascending, those of other builds included.
    #[must_use]
    pub fn sizes(&self) -> Vec<usize> {
        let mut sizes: Vec<_> = self.points.iter().map(|point| point.bodies).collect();
        sizes.sort_unstable();
        sizes.dedup();
        sizes
    }

    /// The series of an engine in the build that measured.
    #[must_use]
    pub fn own<'a>(&'a self, engine: &'a str) -> Series<'a> {
        Series {
            build: &self.build,
            engine,
        }
    }

    /// What a step of a series costs before the first body, for each body and for each pair; none
    /// for engines without steps.
    #[must_use]
    pub fn overhead(&self, series: Series) -> Option<Overhead> {
        let points = self.of(series).into_iter();
        let costs = points.filter_map(|point| Some((point.bodies, point.step_us?)));
        Overhead::of(&costs.collect::<Vec<_>>())
    }
}
