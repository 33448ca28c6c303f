//! The benchmark's opponent must do the same work, or the ratio means nothing.

#[path = "../../benches/support/plain_loop.rs"]
#[allow(dead_code)]
mod plain;

use carom::case::Library;
use carom::engine::StepGrid;

use crate::scenes::lecture;

#[test]
fn the_benchmarks_plain_loop_gives_the_engines_bits() {
    for name in ["shot-2-61", "shot-minus-0-94", "shot-0-75"] {
        let scene = Library::Embedded.case(name).unwrap().scene;
        let recording = lecture(&scene, 0.01);
        let grid = StepGrid::new(&scene, 0.01).unwrap();
        let effects = &scene.effects;
        let cushions = effects.cushions.unwrap();
        let table = plain::Table {
            half_width: cushions.half_width,
            half_length: cushions.half_length,
            cushion_restitution: cushions.restitution,
            contact_restitution: effects.contact.unwrap().restitution,
            drag: effects.drag.unwrap().coefficient,
            rest_speed: effects.rest.unwrap().speed,
        };
        let mut balls: Vec<_> = scene
            .bodies
            .iter()
            .map(|b| plain::Ball {
                position: b.position,
                velocity: b.velocity,
                mass: b.mass,
                radius: b.radius,
            })
            .collect();
        for states in recording.samples().skip(1) {
            for _ in 0..grid.steps_per_sample {
                plain::step(&mut balls, &table, grid.step);
            }
            for (ball, state) in balls.iter().zip(states) {
                assert_eq!(ball.position, <[f64; 3]>::from(state.position), "{name}");
                assert_eq!(ball.velocity, <[f64; 3]>::from(state.velocity), "{name}");
            }
        }
        assert!(
            recording.events.counts().contacts >= 1,
            "{name} without impacts shows little"
        );
    }
}
