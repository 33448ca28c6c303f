//! The questions that need many runs.

pub mod bodies;
mod bounds;
mod breaches;
pub mod check;
pub mod cost;
#[cfg(feature = "drift")]
pub mod drift;
mod effects;
mod machine;
mod made;
mod median;
mod overhead;
mod side_by_side;
pub mod stability;
mod stopwatch;
mod summary;
mod tracks;

pub use bounds::{BUDGET_MAX, PHASES_MAX, REPETITIONS_MAX, RUNS_MAX};
pub use breaches::{Breach, Excess, breaches};
pub use effects::{
    Change, Difference, Effect, EffectPrice, EffectRow, EffectStudy, NeverFelt, effects,
};
pub use machine::Machine;
pub use made::Made;
pub use median::median;
pub use overhead::Overhead;
pub use side_by_side::{Refusal, SideBySide, Voice, fits, side_by_side};
pub use stopwatch::{PAIRS_MIN, Price, ROUNDS_MIN, Ratio, Timing, paired_ratio};
pub use summary::{DisagreementSummary, PairSummary, Summary, VoiceSummary};
pub use tracks::{Track, track};
