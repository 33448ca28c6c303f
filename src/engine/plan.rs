//! The plan: which phases a step has. An effect that a scene does not declare has no phase.

use serde::Serialize;

/// One phase of a step.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Phase {
    /// Short name, the same on every engine: `attraction`, `kick`, `contacts` …
    pub name: &'static str,
    /// How this engine does it.
    pub method: String,
}

impl Phase {
    /// A phase and its method.
    #[must_use]
    pub fn new(name: &'static str, method: impl Into<String>) -> Self {
        Self {
            name,
            method: method.into(),
        }
    }
}

/// What an engine does in one step of a scene, in order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    /// Name of the engine.
    pub engine: String,
    /// The step taken, s; none for an engine that goes from event to event.
    #[serde(rename = "step_s")]
    pub step: Option<f64>,
    /// The phases in order.
    pub phases: Vec<Phase>,
}
