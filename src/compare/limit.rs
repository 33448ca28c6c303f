//! What kind of error an engine makes: what is left of it as the step goes to 0.

use serde::{Deserialize, Serialize};

/// What is left of an error as the step goes to 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Remainder {
    /// It stays: the engine computes another model.
    Model,
    /// It shrinks with the step.
    Discretisation,
    /// It is at the floor of the arithmetic.
    Rounding,
    /// None of these within the budget: it jumps, grows, or is still part slope, part plateau.
    Unsettled,
}

impl Remainder {
    /// Every kind, in the order in which pages count them.
    pub const ALL: [Self; 4] = [
        Self::Model,
        Self::Discretisation,
        Self::Rounding,
        Self::Unsettled,
    ];

    /// The word of the verdict.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Model => "model",
            Self::Discretisation => "discretisation",
            Self::Rounding => "rounding",
            Self::Unsettled => "unsettled",
        }
    }
}

/// An estimate with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower end, 2.5 %.
    pub low: f64,
    /// Upper end, 97.5 %.
    pub high: f64,
}

/// The limit of an engine's position error for dt -> 0.
///
/// Units: scene length unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// What kind of error is left.
    pub kind: Remainder,
    /// The error that stays; none where the floor hides it.
    pub stays: Option<Estimate>,
    /// The slope of log(error) over log(dt) at the finest steps; none at the floor.
    pub slope: Option<f64>,
    /// The error at the finest step.
    pub finest: f64,
    /// Below this, an error is rounding.
    pub floor: f64,
}
