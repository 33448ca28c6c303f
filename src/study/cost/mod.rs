//! What accuracy costs in time: every engine over a ladder of steps, priced and judged.

mod contender;
mod cuts;
mod fit;
mod front;
mod ladder;
mod limit;
mod limit_row;
mod orders;
mod own_search;
mod phases;
mod price_tag;
mod push_out;
mod reference;
mod sensitivity;
mod series;
mod summary;
mod survey;
#[cfg(test)]
pub(crate) mod testing;
mod tune;

pub use contender::{Contender, STOCK, is_searched, setting};
pub use cuts::StepCost;
pub(in crate::study) use fit::slope;
pub use fit::{Order, OrderFit, Window, fit_order};
pub use front::pareto_front;
pub use ladder::{Rung, ladder};
pub use limit::{PHASES_MIN, limit};
pub use limit_row::LimitRow;
pub use orders::{EngineLimit, OrderRow};
pub use phases::Phase;
pub use price_tag::{Comparison, MAIN_TARGET, PriceTag, Target, targets};
pub use push_out::{Left, PushOut, PushOutRung};
pub use reference::{Errors, Reference};
pub use sensitivity::{Sensitivity, sensitivity};
pub use series::Series;
pub use summary::{Bid, CostSummary, EngineFamily, Offer, SceneCostSummary, TagSummary};
pub use survey::scene_cost;
pub use tune::{
    Candidate, Family, FamilyTuning, Score, Search, Shot, ShotError, Trial, Tuning, TuningWatcher,
    coordinates, effective, measure, search, tune, typical,
};

use serde::{Deserialize, Serialize};

use super::{Price, Refusal, Timing};
use crate::engine::EngineSpec;
use crate::recording::Outcome;
use crate::scene::Scene;

/// How a study of cost is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct CostOptions {
    /// How prices are taken.
    pub timing: Timing,
    /// Work that one run may take, in steps x (bodies + pairs).
    pub budget: u64,
    /// Later starts from which every engine runs again, unpriced: phases of the step.
    pub phases: usize,
    /// Runs that each search of settings may take: of an engine on the very scene, of a family
    /// on the shots tuned on.
    pub runs: usize,
}

/// What a study is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The exact engine computes what errors are measured against.
    Reference,
    /// Every run is recorded and compared.
    Errors,
    /// Every engine runs again from later starts.
    Phases,
    /// Every run is timed.
    Pricing,
    /// Runs with and without push-out are compared and timed.
    PushOut,
}

/// Is told the stage, how much of it is done, and of how much.
pub type Watcher<'a> = &'a (dyn Fn(Stage, usize, usize) + Sync);

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Ending {
    /// As the engine says.
    Ran(Outcome),
    /// It was not begun: it would have taken more work than a run may.
    OverBudget,
    /// The engine cannot do the scene with this step or setting, and why.
    Refused(String),
}

impl Ending {
    /// One bare word, for tables.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Ran(outcome) => outcome.word(),
            Self::OverBudget => Outcome::BudgetSpent { time: 0.0 }.word(),
            Self::Refused(_) => "Refused",
        }
    }
}

/// One run: an engine with one setting and one step.
#[derive(Debug, Clone, PartialEq)]
pub struct CostPoint {
    /// The engine.
    pub engine: String,
    /// The setting, `stock` for the engine as it comes.
    pub setting: String,
    /// The step taken, s; none for engines without steps.
    pub dt: Option<f64>,
    /// How far it is from the reference.
    pub errors: Errors,
    /// What it costs; none for a run that did not finish.
    pub price: Option<Price>,
    /// How it ended.
    pub ending: Ending,
}

impl CostPoint {
    /// The error that prices are set against: the largest distance of a body.
    #[must_use]
    pub fn error(&self) -> Option<f64> {
        self.errors.position_max
    }

    /// Milliseconds per simulated second, the median.
    #[must_use]
    pub fn cost(&self) -> Option<f64> {
        self.price.as_ref().map(|price| price.median)
    }

    /// Whether it was not run for its work.
    #[must_use]
    pub fn is_over_budget(&self) -> bool {
        self.ending == Ending::OverBudget
    }

    /// Whether the engine ran as it comes.
    #[must_use]
    pub fn is_stock(&self) -> bool {
        self.setting == STOCK
    }
}

/// An engine of the study, and what was spent on it.
#[derive(Debug, Clone)]
pub struct EngineCost {
    /// The engine as it comes.
    pub spec: EngineSpec,
    /// How many settings were tried, the engine's own included.
    pub settings: usize,
    /// How many runs were made, each with its repetitions.
    pub runs: usize,
    /// The settings that err least on this very scene over the ladder of steps; none for an
    /// engine whose settings are not searched.
    pub found: Option<String>,
}

/// The cost of accuracy on one scene.
#[derive(Debug, Clone)]
pub struct SceneCost {
    /// The scene.
    pub scene: Scene,
    /// Diagonal of the box of all positions, scene length unit.
    pub size: f64,
    /// Until when positions are compared, s; none without a common reference.
    pub compared_until: Option<f64>,
    /// Until when runs are priced, s: while something moves.
    pub priced_until: f64,
    /// What a ball placed a little off does; none where that cannot be computed.
    pub sensitivity: Option<Sensitivity>,
    /// The engines, in the order asked for.
    pub engines: Vec<EngineCost>,
    /// Every run, by engine, setting and step from coarse to fine.
    pub points: Vec<CostPoint>,
    /// What a step of the engines that take steps costs with more and more of the bodies.
    pub step_costs: Vec<StepCost>,
    /// The engines that take steps, from later starts; empty without a common reference.
    pub phases: Vec<Phase>,
    /// What push-out does and costs, for each engine that has it.
    pub push_out: Vec<PushOut>,
    /// Engines that cannot do the scene.
    pub refusals: Vec<Refusal>,
    /// What the reader must know.
    pub notes: Vec<String>,
}

impl SceneCost {
    /// The runs of an engine as it comes, from coarse to fine.
    pub fn stock(&self, engine: &str) -> impl Iterator<Item = &CostPoint> {
        let of_engine = move |point: &&CostPoint| point.engine == engine && point.is_stock();
        self.points.iter().filter(of_engine)
    }

    /// What a run that was priced counted in a simulated second: steps, forces, pairs.
    #[must_use]
    pub fn work_per_sim_s(&self, point: &CostPoint) -> Option<[f64; 3]> {
        let work = point.price.as_ref()?.work;
        let counts = [work.steps, work.force_evaluations, work.pair_tests];
        #[allow(clippy::cast_precision_loss, reason = "counts far below 2^53")]
        let rates = counts.map(|count| count as f64 / self.priced_until);
        Some(rates)
    }
}
