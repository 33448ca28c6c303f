//! What the plan costs: a step of the `lecture` engine against the same arithmetic as one
//! plain fused loop. `cargo bench --bench lecture_step`
#![allow(missing_docs, clippy::cast_precision_loss)]

#[path = "support/paired.rs"]
mod paired;
#[path = "support/plain_loop.rs"]
mod plain_loop;

use std::hint::black_box;

use carom::case::Library;
use carom::engine::{ImpulseSimulation, StepGrid};
use carom::scene::Scene;
use plain_loop::{Ball, Table};

const STEPS: u64 = 500;

/// What A may cost over B: a share, or where a step is so short that the clock decides, a time.
const BAR: &str = "A/B up to 1.05, or 5 ns more";

fn main() {
    for name in ["shot-2-61", "shot-minus-0-94"] {
        let scene = Library::Embedded.case(name).expect("a case").scene;
        let grid = StepGrid::new(&scene, 0.01).expect("a step");
        let engine = ImpulseSimulation::new(&scene, grid);
        let (balls, table) = plain(&scene);
        let result = paired::paired(
            401,
            STEPS as f64 * 20.0,
            || {
                for _ in 0..20 {
                    let mut run = black_box(&engine).clone();
                    run.take_steps(STEPS);
                    black_box(&run);
                }
            },
            || {
                for _ in 0..20 {
                    let mut run = black_box(&balls).clone();
                    for _ in 0..STEPS {
                        plain_loop::step(&mut run, &table, grid.step);
                    }
                    black_box(&run);
                }
            },
        );
        println!("{name}, a step: A lecture through the plan, B plain loop: {result}; bar: {BAR}");
    }
}

fn plain(scene: &Scene) -> (Vec<Ball>, Table) {
    let effects = &scene.effects;
    let (Some(cushions), Some(contact)) = (effects.cushions, effects.contact) else {
        panic!("the four-ball scene has cushions and contacts");
    };
    let balls = scene.bodies.iter().map(|body| Ball {
        position: body.position,
        velocity: body.velocity,
        mass: body.mass,
        radius: body.radius,
    });
    let table = Table {
        half_width: cushions.half_width,
        half_length: cushions.half_length,
        cushion_restitution: cushions.restitution,
        contact_restitution: contact.restitution,
        drag: effects.drag.map_or(0.0, |drag| drag.coefficient),
        rest_speed: effects.rest.map_or(0.0, |rest| rest.speed),
    };
    (balls.collect(), table)
}
