//! What a search may change: the settings of each kind of engine.

use super::search::Coordinate;
use crate::engine::{
    CcdBody, DragRule, EngineKind, Impacts, ImpulseSettings, Integrator, LengthScale, Precision,
    RapierSettings,
};
use crate::scene::Scene;

/// The settings of an engine that some of the scenes can feel; none for the exact engine.
///
/// Precision is not among them: it is what tells the presets of Rapier apart.
#[must_use]
pub fn coordinates(kind: &EngineKind, scenes: &[Scene]) -> Vec<Coordinate<EngineKind>> {
    let touches =
        |scene: &Scene| scene.effects.contact.is_some() || scene.effects.cushions.is_some();
    let touch = scenes.iter().any(touches);
    match kind {
        EngineKind::Impulse(_) => impulse(touch, scenes.iter().any(|s| s.effects.drag.is_some())),
        EngineKind::Rapier(_) => rapier(touch),
        EngineKind::Exact(_) => Vec::new(),
    }
}

/// An engine with one setting along some values.
fn along<V: Copy + 'static>(
    name: &'static str,
    all: &'static [V],
    set: fn(&mut EngineKind, V),
) -> Coordinate<EngineKind> {
    let values = move |kind: &EngineKind| {
        let at = |value: &V| {
            let mut kind = kind.clone();
            set(&mut kind, *value);
            kind
        };
        all.iter().map(at).collect()
    };
    Coordinate {
        name,
        values: Box::new(values),
    }
}

fn on_impulse(kind: &mut EngineKind, change: impl FnOnce(&mut ImpulseSettings)) {
    if let EngineKind::Impulse(settings) = kind {
        change(settings);
        *settings = settings.sound();
    }
}

fn on_rapier(kind: &mut EngineKind, change: impl FnOnce(&mut RapierSettings)) {
    if let EngineKind::Rapier(settings) = kind {
        change(settings);
    }
}

fn impulse(touch: bool, drag: bool) -> Vec<Coordinate<EngineKind>> {
    let mut all = vec![along("integrator", &Integrator::ALL, |kind, value| {
        on_impulse(kind, |s| s.integrator = value);
    })];
    if drag {
        all.push(along("drag", &DragRule::ALL, |kind, value| {
            on_impulse(kind, |s| s.drag = value);
        }));
    }
    if touch {
        all.push(along("impacts", &Impacts::ALL, |kind, value| {
            on_impulse(kind, |s| s.impacts = value);
        }));
    }
    all
}

/// Both precisions of Rapier.
#[must_use]
pub fn precision() -> Coordinate<EngineKind> {
    let both = &[Precision::Single, Precision::Double];
    along("precision", both, |kind, value| {
        on_rapier(kind, |s| s.precision = value);
    })
}

/// Lengths for Rapier's `length_unit`: units a metre, and the balls' own scale.
const LENGTH_SCALES: [LengthScale; 5] = [
    LengthScale::Metre,
    LengthScale::SmallestRadius(4.0),
    LengthScale::SmallestRadius(1.0),
    LengthScale::SmallestRadius(0.25),
    LengthScale::SmallestRadius(0.0625),
];

/// Rapier's own value comes first. The model stays what the scene means: forces, restitution and
/// friction are not touched, and a smaller length unit does not bring the cap of speeds down to
/// the balls.
fn rapier(touch: bool) -> Vec<Coordinate<EngineKind>> {
    let iterations = &[None, Some(1), Some(2), Some(8), Some(16)];
    let mut all = vec![along("num_solver_iterations", iterations, |kind, value| {
        on_rapier(kind, |s| s.solver_iterations = value);
    })];
    if touch {
        let distances = &[None, Some(1e-9), Some(1e-4), Some(1e-3), Some(0.05)];
        let name = "normalized_prediction_distance";
        all.push(along(name, distances, |kind, value| {
            on_rapier(kind, |s| s.prediction_distance = value);
        }));
        all.push(along(
            "contact_recycling",
            &[None, Some(false)],
            |kind, value| {
                on_rapier(kind, |s| s.contact_recycling = value);
            },
        ));
        let passes = &[None, Some(0), Some(4)];
        all.push(along("max_ccd_substeps", passes, |kind, value| {
            on_rapier(kind, |s| s.max_ccd_substeps = value);
        }));
        all.push(along("length_unit", &LENGTH_SCALES, |kind, value| {
            on_rapier(kind, |s| {
                s.length_scale = value;
                s.speed_cap = value == LengthScale::Metre;
            });
        }));
        let bodies = &[CcdBody::None, CcdBody::Fastest];
        all.push(along("ccd_enabled", bodies, |kind, value| {
            on_rapier(kind, |s| s.ccd_body = value);
        }));
    }
    all.push(along("sleeping", &[false, true], |kind, value| {
        on_rapier(kind, |s| s.sleeping = value);
    }));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::engine;

    fn scene(effects: &str) -> Scene {
        let text = format!(
            "name='x'\nduration=1\nsample_every=1\n\
             [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n{effects}"
        );
        crate::scene::parse(&text, "x").unwrap()
    }

    fn names(preset: &str, scenes: &[Scene]) -> Vec<&'static str> {
        let all = coordinates(&engine(preset).unwrap().kind, scenes);
        all.iter().map(|coordinate| coordinate.name).collect()
    }

    #[test]
    fn what_no_scene_can_feel_is_left_alone() {
        let alone = scene("");
        let both = [
            alone.clone(),
            scene("[effects.contact]\nrestitution=1\n[effects.drag]\ncoefficient=1\n"),
        ];
        let alone = std::slice::from_ref(&alone);
        assert_eq!(names("lecture", alone), ["integrator"]);
        assert_eq!(
            names("rapier", alone),
            ["num_solver_iterations", "sleeping"]
        );
        assert_eq!(names("exact", alone), [""; 0]);
        assert_eq!(names("lecture", &both), ["integrator", "drag", "impacts"]);
        assert_eq!(names("rapier", &both).len(), 7);
    }

    /// One thing at a time, the start among the values; only the cap of speeds goes with the
    /// length unit that sets it.
    #[test]
    fn a_coordinate_changes_what_it_is_called() {
        let scenes = [scene(
            "[effects.contact]\nrestitution=1\n[effects.drag]\ncoefficient=1\n",
        )];
        for preset in ["lecture", "rapier"] {
            let start = engine(preset).unwrap().kind;
            let mut all = coordinates(&start, &scenes);
            if preset == "rapier" {
                all.push(precision());
            }
            for coordinate in all {
                let values = (coordinate.values)(&start);
                assert!(values.contains(&start), "{}", coordinate.name);
                for value in values.iter().filter(|value| **value != start) {
                    let changed = value.changed_from(&start);
                    let own = changed.split(' ').all(|change| {
                        let name = change.split('=').next().unwrap();
                        name == coordinate.name
                            || (coordinate.name, name) == ("length_unit", "speed_cap")
                            || (coordinate.name, change) == ("integrator", "impacts=swept")
                    });
                    assert!(own, "{}: {changed}", coordinate.name);
                }
            }
        }
    }

    /// Runge-Kutta methods know no exact decay: with it they would leave drag out.
    #[test]
    fn a_runge_kutta_method_keeps_drag_as_a_force() {
        let scenes = [scene("[effects.drag]\ncoefficient=1\n")];
        let decaying = engine("verlet").unwrap().kind;
        let all = coordinates(&decaying, &scenes);
        let kinds = (all[0].values)(&decaying);
        for kind in kinds {
            let EngineKind::Impulse(settings) = kind else {
                panic!("a hand-written one");
            };
            let takes_forces = matches!(
                settings.integrator,
                Integrator::RungeKutta4 | Integrator::DormandPrince
            );
            assert_eq!(settings.drag == DragRule::Force, takes_forces);
        }
    }
}
