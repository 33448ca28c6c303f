//! What an engine is: a name for plain data, a preset of settings, printed in every report.

mod exact;
mod handling;
mod impulse;
mod rapier;
mod support;
mod table;

pub use exact::ExactSettings;
pub use handling::{Handling, RAPIER_HANDLING};
pub use impulse::{DragRule, Impacts, ImpulseSettings, Integrator};
pub use rapier::{CcdBody, Forces, LengthScale, Precision, RapierSettings};
pub use support::Support;
pub use table::{engine, engines};

use serde::Serialize;

/// One way to compute a scene: a name for a kind of engine and its settings.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EngineSpec {
    /// The name on the command line and in files.
    pub name: String,
    /// One line for people.
    pub summary: &'static str,
    /// What computes, and with which settings.
    pub kind: EngineKind,
}

/// The kinds of engines.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum EngineKind {
    /// The hand-written impulse solver, or a rung of its ladder.
    Impulse(ImpulseSettings),
    /// The event-driven exact engine.
    Exact(ExactSettings),
    /// A Rapier world.
    Rapier(RapierSettings),
}

impl EngineKind {
    /// The settings that differ from those of another, `name=value`; empty if none does.
    #[must_use]
    pub fn changed_from(&self, other: &Self) -> String {
        let of = |kind: &Self| match kind {
            Self::Impulse(settings) => settings.parameters(),
            Self::Exact(_) => Vec::new(),
            Self::Rapier(settings) => settings.parameters(),
        };
        let known = of(other);
        let changed = of(self).into_iter().filter(|own| !known.contains(own));
        let changed: Vec<_> = changed
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        changed.join(" ")
    }
}

impl EngineSpec {
    /// Whether it computes step by step, with an error that depends on the step.
    #[must_use]
    pub fn takes_steps(&self) -> bool {
        match self.kind {
            EngineKind::Impulse(_) | EngineKind::Rapier(_) => true,
            EngineKind::Exact(_) => false,
        }
    }

    /// Whether the step asked for is only the longest: the effects decide how short its own are, so
    /// that a ladder of steps says little.
    #[must_use]
    pub fn chooses_its_steps(&self) -> bool {
        match self.kind {
            EngineKind::Impulse(settings) => settings.integrator == Integrator::EnergyMomentum,
            EngineKind::Exact(_) | EngineKind::Rapier(_) => false,
        }
    }

    /// The order in the step that the engine states for errors of position, with impacts on the
    /// way or without; none where it states none.
    #[must_use]
    pub fn stated_order(&self, through_impacts: bool) -> Option<u8> {
        match self.kind {
            EngineKind::Impulse(settings) if through_impacts => {
                Some(settings.order_through_impacts())
            }
            EngineKind::Impulse(settings) => Some(settings.order()),
            EngineKind::Exact(_) | EngineKind::Rapier(_) => None,
        }
    }

    /// Whether this build has the engine.
    #[must_use]
    pub fn is_built(&self) -> bool {
        match self.kind {
            EngineKind::Impulse(_) | EngineKind::Exact(_) => true,
            EngineKind::Rapier(_) => cfg!(feature = "rapier"),
        }
    }

    /// The settings in a sentence.
    #[must_use]
    pub fn describe(&self) -> String {
        match &self.kind {
            EngineKind::Impulse(settings) => settings.describe(),
            EngineKind::Exact(settings) => settings.describe().to_owned(),
            EngineKind::Rapier(settings) => settings.describe(),
        }
    }
}
