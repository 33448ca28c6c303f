//! Who takes part: an engine with its settings.

use crate::engine::{EngineKind, EngineSpec, RapierSettings};
use crate::scene::Scene;

/// The name of the settings that an engine comes with.
pub const STOCK: &str = "stock";

/// An engine with its settings, on the scene that is put to it.
#[derive(Debug, Clone)]
pub struct Contender {
    /// The settings in a word: `stock`, or what is changed.
    pub setting: String,
    /// The engine with these settings.
    pub spec: EngineSpec,
    /// The scene.
    pub scene: Scene,
}

impl Contender {
    /// An engine as it comes.
    #[must_use]
    pub fn stock(scene: &Scene, preset: &EngineSpec) -> Self {
        Self::with(scene, preset, &preset.kind)
    }

    /// An engine with other settings than its own.
    #[must_use]
    pub fn with(scene: &Scene, preset: &EngineSpec, kind: &EngineKind) -> Self {
        Self {
            setting: setting(kind, &preset.kind),
            spec: EngineSpec {
                kind: kind.clone(),
                ..preset.clone()
            },
            scene: scene.clone(),
        }
    }
}

/// Settings in a word: `stock`, or what they change.
#[must_use]
pub fn setting(kind: &EngineKind, preset: &EngineKind) -> String {
    let changed = kind.changed_from(preset);
    if changed.is_empty() {
        STOCK.to_owned()
    } else {
        changed
    }
}

/// Whether an engine is one whose settings are searched on the very scene: a Rapier world with
/// Rapier's own parameters. The others are somebody's choice already, the hand-written ones rungs
/// of a ladder that all take part.
#[must_use]
pub fn is_searched(preset: &EngineSpec) -> bool {
    match &preset.kind {
        EngineKind::Rapier(settings) => *settings == RapierSettings::stock(settings.precision),
        EngineKind::Impulse(_) | EngineKind::Exact(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::engine;

    #[test]
    fn settings_are_called_by_what_they_change() {
        let preset = engine("rapier-f64").unwrap();
        let EngineKind::Rapier(mut settings) = preset.kind.clone() else {
            panic!("a Rapier world");
        };
        assert_eq!(setting(&preset.kind, &preset.kind), STOCK);
        settings.solver_iterations = Some(8);
        settings.contact_recycling = Some(false);
        let kind = EngineKind::Rapier(settings);
        let called = setting(&kind, &preset.kind);
        assert_eq!(called, "num_solver_iterations=8 contact_recycling=false");
    }

    #[test]
    fn only_stock_worlds_are_searched() {
        let searched = |name: &str| is_searched(&engine(name).unwrap());
        assert!(searched("rapier") && searched("rapier-f64"));
        assert!(!searched("rapier-matched") && !searched("rapier-tuned") && !searched("lecture"));
    }
}
