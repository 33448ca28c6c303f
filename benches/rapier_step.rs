//! What carom adds to Rapier: stepping a scene through the engine `rapier` against stepping
//! the same world built by hand, without carom. `cargo bench --bench rapier_step`
#![allow(
    missing_docs,
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss
)]

#[path = "support/paired.rs"]
mod paired;

use std::hint::black_box;

use carom::case::Library;
use carom::engine::{Simulation, StepGrid, engine, prepare};
use carom::scene::Scene;
use carom::scene::generate::Rack;
use rapier3d::prelude::*;

const DT: f64 = 0.01;

/// What A may cost over B: a share, or where a step is so short that the clock decides, a time.
const BAR: &str = "A/B up to 1.05, or 5 ns more";

fn main() {
    let shot = Library::Embedded.case("shot-2-61").expect("a case").scene;
    let mut free = shot.clone();
    free.effects.rest = None;
    let rack = Rack {
        rows: 12,
        gap: 5.0,
        ..Rack::default()
    };
    let rack = rack.scene().expect("a rack");
    for (name, scene) in [
        ("four balls", &shot),
        ("four balls, no rest", &free),
        ("rack of 78", &rack),
    ] {
        compare(name, scene);
    }
}

fn compare(name: &str, scene: &Scene) {
    let grid = StepGrid::new(scene, DT).expect("a step");
    let samples = scene.sample_count().min(32);
    let steps = samples as u64 * grid.steps_per_sample;
    let spec = engine("rapier").expect("an engine");
    let (mut last_a, mut last_b) = (Vector::ZERO, Vector::ZERO);
    let result = paired::paired(
        61,
        steps as f64,
        || {
            let mut simulation = prepare(scene, &spec, DT).expect("a simulation");
            black_box(simulation.advance_to(samples, None));
            last_a = first_position(simulation.as_ref(), scene);
        },
        || {
            let (mut world, handles) = by_hand(scene, grid.step as f32);
            for _ in 0..steps {
                world.step();
                stop_slow_balls(&mut world, &handles, scene);
            }
            last_b = world.bodies[handles[0]].translation();
        },
    );
    assert_eq!(last_a, last_b, "both must compute the same");
    println!("{name}, a step: A through carom, B by hand: {result}; bar: {BAR}");
}

fn first_position(simulation: &dyn Simulation, scene: &Scene) -> Vector {
    let mut states = carom::recording::initial_states(scene);
    simulation.state_into(&mut states);
    let x = states[0].position;
    Vector::new(x.x as f32, x.y as f32, x.z as f32)
}

/// What the lecture's table needs and Rapier has no feature for.
fn stop_slow_balls(world: &mut PhysicsWorld, handles: &[RigidBodyHandle], scene: &Scene) {
    let Some(rest) = scene.effects.rest else {
        return;
    };
    for handle in handles {
        let speed = f64::from(world.bodies[*handle].linvel().length());
        if speed > 0.0 && speed < rest.speed {
            world.bodies[*handle].set_linvel(Vector::ZERO, false);
        }
    }
}

/// The world as Rapier's manual would have it, for the lecture's table.
fn by_hand(scene: &Scene, dt: f32) -> (PhysicsWorld, Vec<RigidBodyHandle>) {
    let mut world = PhysicsWorld {
        gravity: Vector::ZERO,
        ..PhysicsWorld::default()
    };
    world.integration_parameters.dt = dt;
    world.integration_parameters.length_unit = scene.units.length.per_metre() as f32;
    let effects = &scene.effects;
    let (Some(contact), Some(cushions)) = (effects.contact, effects.cushions) else {
        panic!("the scene is a billiards table");
    };
    let vector = |v: [f64; 3]| Vector::new(v[0] as f32, v[1] as f32, v[2] as f32);
    let mut handles = Vec::new();
    for body in &scene.bodies {
        let damping = effects
            .drag
            .map_or(0.0, |drag| drag.coefficient / body.mass);
        let mass = MassProperties::new(Vector::ZERO, body.mass as f32, Vector::ZERO);
        let handle = world.insert_body(
            RigidBodyBuilder::dynamic()
                .translation(vector(body.position))
                .linvel(vector(body.velocity))
                .linear_damping(damping as f32)
                .additional_mass_properties(mass)
                .lock_rotations()
                .can_sleep(false),
        );
        let ball = ColliderBuilder::ball(body.radius as f32)
            .mass_properties(MassProperties::default())
            .friction(0.0)
            .restitution(contact.restitution as f32)
            .restitution_combine_rule(CoefficientCombineRule::Min);
        world.insert_collider(ball, Some(handle));
        handles.push(handle);
    }
    let walls = [
        ([1.0, 0.0, 0.0], cushions.half_width),
        ([-1.0, 0.0, 0.0], cushions.half_width),
        ([0.0, 0.0, 1.0], cushions.half_length),
        ([0.0, 0.0, -1.0], cushions.half_length),
    ];
    for (inward, distance) in walls {
        let normal = rapier3d::na::Unit::new_unchecked(vector(inward));
        let wall = ColliderBuilder::halfspace(normal)
            .translation(vector(inward.map(|n| -n * distance)))
            .friction(0.0)
            .restitution(cushions.restitution as f32)
            .restitution_combine_rule(CoefficientCombineRule::Max);
        world.insert_collider(wall, None);
    }
    (world, handles)
}
