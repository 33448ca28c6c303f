//! Who takes part: each engine as it is, and one setting of a Rapier world changed at a time.

use crate::engine::{EngineKind, EngineSpec, RapierSettings};
use crate::scene::{LengthUnit, Scene};

/// The name of the settings that an engine comes with.
pub const STOCK: &str = "stock";

/// An engine with its settings, on the scene as it is put to it.
#[derive(Debug, Clone)]
pub struct Contender {
    /// The settings in a word: `stock`, or what is changed.
    pub setting: String,
    /// The engine with these settings.
    pub spec: EngineSpec,
    /// The scene; other than the one of the study only in its label of length.
    pub scene: Scene,
}

impl Contender {
    /// Whether the engine runs as it comes.
    #[must_use]
    pub fn is_stock(&self) -> bool {
        self.setting == STOCK
    }
}

/// An engine as it is, then with each setting changed by itself; only settings that the scene
/// can feel.
#[must_use]
pub fn contenders(scene: &Scene, preset: &EngineSpec) -> Vec<Contender> {
    let stock = Contender {
        setting: STOCK.to_owned(),
        spec: preset.clone(),
        scene: scene.clone(),
    };
    let mut all = vec![stock.clone()];
    if let EngineKind::Rapier(settings) = &preset.kind {
        for (setting, settings) in variants(scene, settings) {
            all.push(Contender {
                setting,
                spec: EngineSpec {
                    kind: EngineKind::Rapier(settings),
                    ..preset.clone()
                },
                scene: scene.clone(),
            });
        }
        if has_colliders(scene) && scene.units.length.per_metre() != 1.0 {
            // Rapier is told its length unit by the label of the scene; the numbers stay.
            let mut relabelled = stock;
            "length_unit=1".clone_into(&mut relabelled.setting);
            relabelled.scene.units.length = LengthUnit::None;
            all.push(relabelled);
        }
    }
    all
}

fn has_colliders(scene: &Scene) -> bool {
    scene.effects.contact.is_some() || scene.effects.cushions.is_some()
}

/// One setting changed at a time, each to what the preset does not have already.
fn variants(scene: &Scene, preset: &RapierSettings) -> Vec<(String, RapierSettings)> {
    let mut all = Vec::new();
    let mut vary = |name: String, change: &dyn Fn(&mut RapierSettings)| {
        let mut settings = preset.clone();
        change(&mut settings);
        if settings != *preset {
            all.push((name, settings));
        }
    };
    for count in [1, 2, 8, 16] {
        vary(format!("num_solver_iterations={count}"), &|settings| {
            settings.solver_iterations = Some(count);
        });
    }
    if has_colliders(scene) {
        vary("contact_recycling=false".to_owned(), &|settings| {
            settings.contact_recycling = Some(false);
        });
        for distance in [1e-9, 1e-4, 0.05] {
            vary(format!("prediction_distance={distance:e}"), &|settings| {
                settings.prediction_distance = Some(distance);
            });
        }
        for count in [0, 4] {
            vary(format!("max_ccd_substeps={count}"), &|settings| {
                settings.max_ccd_substeps = Some(count);
            });
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::engine;

    fn scene(effects: &str) -> Scene {
        let text = format!(
            "name='x'\nduration=1\nsample_every=1\n[units]\nlength='mm'\n\
             [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n{effects}"
        );
        crate::scene::parse(&text, "x").unwrap()
    }

    fn names(scene: &Scene, preset: &str) -> Vec<String> {
        let all = contenders(scene, &engine(preset).unwrap());
        all.into_iter().map(|contender| contender.setting).collect()
    }

    #[test]
    fn a_hand_written_engine_has_no_settings() {
        assert_eq!(names(&scene(""), "lecture"), [STOCK]);
    }

    #[test]
    fn settings_of_contacts_are_left_alone_where_nothing_collides() {
        let alone = names(&scene(""), "rapier");
        assert!(
            alone
                .iter()
                .skip(1)
                .all(|name| name.starts_with("num_solver"))
        );
        assert_eq!(alone.len(), 5);
        let box_of_balls = scene("[effects.contact]\nrestitution=1\n");
        let all = names(&box_of_balls, "rapier");
        assert_eq!(all.len(), 12, "{all:?}");
        // `rapier-matched` has one iteration, no recycling, no CCD, prediction 1e-9 already.
        assert_eq!(names(&box_of_balls, "rapier-matched").len(), all.len() - 4);
    }
}
