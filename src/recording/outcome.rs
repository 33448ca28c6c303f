//! How a simulation ended.

use std::fmt;

use serde::Serialize;

use crate::scene::Scene;

/// How a simulation ended. A blow-up is a result, not an error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "kind")]
pub enum Outcome {
    /// The whole duration was simulated.
    Finished,
    /// A number was no longer finite.
    NonFinite {
        /// Time of the first sample that could not be kept, s.
        time: f64,
        /// The first body with a non-finite component.
        body: usize,
    },
    /// The engine took a body out of the simulation.
    Disabled {
        /// Time of the step after which the body was found disabled, s.
        time: f64,
        /// The body.
        body: usize,
    },
    /// Events or steps pile up without end, or the model has no unique answer any more.
    Collapsed {
        /// Time up to which it was computed, s.
        time: f64,
        /// The first of the two bodies that it happened to.
        body_a: usize,
        /// The second; at a wall the same one.
        body_b: usize,
    },
}

impl Outcome {
    /// Whether the whole duration was simulated.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        *self == Self::Finished
    }

    /// One bare word, for tables.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Finished => "Finished",
            Self::NonFinite { .. } => "NonFinite",
            Self::Disabled { .. } => "Disabled",
            Self::Collapsed { .. } => "Collapsed",
        }
    }

    /// The outcome with time and body.
    #[must_use]
    pub fn describe(&self, scene: &Scene) -> impl fmt::Display {
        match self {
            Self::Finished => "finished".to_owned(),
            Self::NonFinite { time, body } => format!(
                "not finite by t = {time} s (`{}`); the recording ends at the last finite sample",
                scene.bodies[*body].name
            ),
            Self::Disabled { time, body } => format!(
                "`{}` was disabled by the engine at t = {time} s; the recording ends before it",
                scene.bodies[*body].name
            ),
            Self::Collapsed {
                time,
                body_a,
                body_b,
            } => format!(
                "events of `{}` and `{}` pile up without end at t = {time} s; the recording ends before it",
                scene.bodies[*body_a].name, scene.bodies[*body_b].name
            ),
        }
    }
}
