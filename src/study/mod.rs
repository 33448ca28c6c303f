//! The questions that need many runs.

mod breaches;
pub mod cost;
mod effects;
mod median;
mod price;
mod side_by_side;
mod summary;
mod tracks;

pub use breaches::{Breach, Excess, breaches};
pub use effects::{Change, Difference, Effect, EffectRow, EffectStudy, NeverFelt, effects};
pub use median::median;
pub use price::Price;
pub use side_by_side::{Refusal, SideBySide, Voice, side_by_side};
pub use summary::{DisagreementSummary, PairSummary, Summary, VoiceSummary};
pub use tracks::{Track, track};
