//! How a simulation ended.

use std::fmt;

use serde::Serialize;

use crate::error::{code, number};
use crate::physics::BodyState;
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
    /// The work that a run may take was spent; everything before is kept.
    BudgetSpent {
        /// Time up to which it was computed, s.
        time: f64,
    },
    /// Bodies came together so that there was no going on.
    Collapsed {
        /// Time, s.
        time: f64,
        /// The first of the bodies.
        a: usize,
        /// The second; none if it was a wall.
        b: Option<usize>,
        /// Why there was no going on.
        reason: CollapseReason,
    },
}

/// Why bodies that came together could not go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CollapseReason {
    /// Impacts followed each other without end.
    EndlessImpacts,
    /// They fell into one point, where the force has no bound or no direction.
    Singularity,
}

impl fmt::Display for CollapseReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::EndlessImpacts => "impacts ran away",
            Self::Singularity => "bodies fell into one point",
        })
    }
}

impl Outcome {
    /// The end of a recording at a sample with states that are no longer finite, if any is.
    #[must_use]
    pub fn blown_up(states: &[BodyState], time: f64) -> Option<Self> {
        let lost = states.iter().position(|state| !state.is_finite());
        lost.map(|body| Self::NonFinite { time, body })
    }

    /// Whether the whole duration was simulated.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        *self == Self::Finished
    }

    /// When it ended before its time, s.
    #[must_use]
    pub fn time(&self) -> Option<f64> {
        match self {
            Self::Finished => None,
            Self::NonFinite { time, .. }
            | Self::Disabled { time, .. }
            | Self::BudgetSpent { time }
            | Self::Collapsed { time, .. } => Some(*time),
        }
    }

    /// One bare word, for tables.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Finished => "Finished",
            Self::NonFinite { .. } => "NonFinite",
            Self::Disabled { .. } => "Disabled",
            Self::BudgetSpent { .. } => "BudgetSpent",
            Self::Collapsed { .. } => "Collapsed",
        }
    }

    /// The outcome with time and body.
    #[must_use]
    pub fn describe(&self, scene: &Scene) -> impl fmt::Display {
        match self {
            Self::Finished => "finished".to_owned(),
            Self::NonFinite { time, body } => format!(
                "not finite by t = {} s ({}); the recording ends at the last finite sample",
                number(*time),
                code(&scene.bodies[*body].name)
            ),
            Self::Disabled { time, body } => format!(
                "{} was disabled by the engine at t = {} s; the recording ends before it",
                code(&scene.bodies[*body].name),
                number(*time)
            ),
            Self::BudgetSpent { time } => {
                format!(
                    "the work allowed was spent at t = {} s; the recording ends there",
                    number(*time)
                )
            }
            Self::Collapsed {
                time,
                a,
                b: None,
                reason: CollapseReason::Singularity,
            } => format!(
                "the forces on `{}` leave no step at t = {time} s; the recording ends before it",
                scene.bodies[*a].name
            ),
            Self::Collapsed { time, a, b, reason } => format!(
                "{reason} at t = {} s ({} and {}); the recording ends before it",
                number(*time),
                code(&scene.bodies[*a].name),
                b.map_or("a wall".to_owned(), |b| code(&scene.bodies[b].name))
            ),
        }
    }
}
