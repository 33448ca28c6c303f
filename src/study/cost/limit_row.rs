//! A limit as a row of `limits.csv`.

use serde::Serialize;

use super::EngineLimit;
use crate::compare::Remainder;

/// A row of `limits.csv`; the names of the fields are the header. Lengths are in the scene's unit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitRow {
    /// Name of the scene.
    pub scene: String,
    /// The engine.
    pub engine: String,
    /// What is left; blank with too few steps or phases, and then all that follows is.
    pub kind: Option<Remainder>,
    /// The position error that stays.
    pub limit: Option<f64>,
    /// Lower end of its 95 % interval.
    pub limit_low: Option<f64>,
    /// Upper end.
    pub limit_high: Option<f64>,
    /// The slope at the finest steps.
    pub slope: Option<f64>,
    /// The error at the finest step.
    pub finest: Option<f64>,
    /// Below this, an error is rounding.
    pub floor: Option<f64>,
}

impl LimitRow {
    /// The row of an engine on a scene.
    #[must_use]
    pub fn new(scene: &str, row: &EngineLimit) -> Self {
        let limit = row.limit;
        let stays = limit.and_then(|limit| limit.stays);
        Self {
            scene: scene.to_owned(),
            engine: row.engine.clone(),
            kind: limit.map(|limit| limit.kind),
            limit: stays.map(|stays| stays.value),
            limit_low: stays.map(|stays| stays.low),
            limit_high: stays.map(|stays| stays.high),
            slope: limit.and_then(|limit| limit.slope),
            finest: limit.map(|limit| limit.finest),
            floor: limit.map(|limit| limit.floor),
        }
    }
}
