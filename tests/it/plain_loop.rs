//! The benchmark's opponents must do the same work, or the ratios mean nothing.

#[path = "../../benches/support/plain_loop.rs"]
#[allow(dead_code)]
mod plain;

use carom::case::Library;
use carom::engine::StepGrid;
use carom::scene::Scene;

use crate::scenes::{apart, lecture};
use plain::{COMBINATIONS, Combination, Plain};

/// The combination with all that the billiards table has.
const TABLE: &str = "contact, cushions, drag, rest";

fn assert_same_bits(combination: &Combination, scene: &Scene) {
    let what = format!("{} on {}", combination.name, scene.name);
    let recording = lecture(scene, 0.01);
    let grid = StepGrid::new(scene, 0.01).unwrap();
    let mut plain = Plain::of(scene);
    assert_eq!(
        recording.sample_count(),
        scene.sample_count() + 1,
        "{what}: nothing blows up"
    );
    for states in recording.samples().skip(1) {
        (combination.run)(&mut plain, grid.step, grid.steps_per_sample);
        for (ball, state) in plain.balls.iter().zip(states) {
            for axis in 0..3 {
                let pairs = [
                    (ball.position[axis], state.position[axis]),
                    (ball.velocity[axis], state.velocity[axis]),
                ];
                for (plain, engine) in pairs {
                    assert_eq!(plain.to_bits(), engine.to_bits(), "{what}");
                }
            }
        }
    }
}

#[test]
fn the_benchmarks_plain_loops_give_the_engines_bits() {
    for combination in &COMBINATIONS {
        assert_same_bits(combination, &(combination.scene)());
    }
}

#[test]
fn the_table_gives_the_engines_bits_on_other_shots_too() {
    let mut tables = COMBINATIONS.iter().filter(|one| one.name == TABLE);
    let table = tables.next().unwrap();
    for name in ["shot-2-61", "shot-minus-0-94", "shot-0-75"] {
        let scene = Library::Embedded.case(name).unwrap().scene;
        assert_same_bits(table, &scene);
        assert!(
            lecture(&scene, 0.01).events.counts().contacts >= 1,
            "{name} without impacts shows little"
        );
    }
}

/// Every effect of a combination is at work in its scene: without it the run is another, so a
/// loop that forgot one could not have the engine's bits.
#[test]
fn a_loop_that_forgets_an_effect_is_found_out() {
    use carom::scene::Effect;
    use carom::study::Change;
    for combination in &COMBINATIONS {
        let scene = (combination.scene)();
        let whole = lecture(&scene, 0.01);
        let mut declared = 0;
        for effect in Effect::ALL {
            let Some((Change::Off, without)) = effect.switched(&scene) else {
                continue;
            };
            declared += 1;
            let moved = apart(&whole, &lecture(&without, 0.01));
            let what = format!("{}: {}", combination.name, effect.name());
            assert!(moved > 0.0, "{what} is never felt");
        }
        assert_eq!(declared, combination.effects, "{}", combination.name);
    }
}
