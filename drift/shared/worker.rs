//! A Rapier world as an external solver of carom: `BODIES EFFECTS OUT LENGTH_UNIT`.
//!
//! The world is that of carom's engine `rapier` (`src/engine/rapier/`), with the parameters that
//! this version of Rapier has by itself. Keep the two in step: the worker of carom's own version
//! must write the stored recordings of `rapier` bit for bit, and `carom drift` sees to that.

use std::path::Path;
use std::process::ExitCode;

use rapier3d::prelude::*;

use crate::scene::{Body, Scene};
use crate::version::{World, groups, point_mass, state, vector};

/// Does what the arguments say; what went wrong is one line on standard error.
pub fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match &arguments[..] {
        [bodies, effects, out, length_unit] => match length_unit.parse() {
            Ok(unit) => run(Path::new(bodies), Path::new(effects), Path::new(out), unit),
            Err(_) => Err(format!("LENGTH_UNIT is no number: {length_unit}")),
        },
        _ => Err("arguments: BODIES EFFECTS OUT LENGTH_UNIT (units a metre)".to_owned()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

fn run(bodies: &Path, effects: &Path, out: &Path, length_unit: f64) -> Result<(), String> {
    let scene = Scene::read(bodies, effects)?;
    let unwritten = |wrong: csv::Error| format!("{}: {wrong}", out.display());
    let mut table = csv::Writer::from_path(out).map_err(unwritten)?;
    table
        .write_record(["time", "body", "x", "y", "z", "vx", "vy", "vz"])
        .map_err(unwritten)?;
    for body in &scene.bodies {
        let start = (body.position, body.velocity);
        table
            .serialize((0.0, &body.name, start))
            .map_err(unwritten)?;
    }
    let mut world = World::new(scene.gravity, scene.step, length_unit);
    let handles: Vec<_> = scene
        .bodies
        .iter()
        .map(|it| insert(&mut world, &scene, it))
        .collect();
    insert_walls(&mut world, &scene);
    for sample in 1..=scene.samples as u64 {
        for _ in 0..scene.steps_per_sample as u64 {
            world.step();
            settle(&mut world, &handles, scene.rest);
        }
        let time = sample as f64 * scene.sample_every;
        for (body, handle) in scene.bodies.iter().zip(&handles) {
            let now = &world.bodies()[*handle];
            if !now.is_enabled() {
                return Err(format!("Rapier disabled `{}` before {time} s", body.name));
            }
            table
                .serialize((time, &body.name, state(now)))
                .map_err(unwritten)?;
        }
    }
    table
        .flush()
        .map_err(|wrong| format!("{}: {wrong}", out.display()))
}

/// Stops every body slower than the rest speed.
fn settle(world: &mut World, handles: &[RigidBodyHandle], rest: f64) {
    for handle in handles {
        let body = &mut world.bodies_mut()[*handle];
        let (_, [x, y, z]) = state(body);
        let speed = ((x * x + y * y) + z * z).sqrt();
        if speed > 0.0 && speed < rest {
            body.set_linvel(vector([0.0; 3]), false);
        }
    }
}

/// A collider without mass, friction and skin: the body has the scene's own mass.
fn collider(shape: ColliderBuilder, restitution: f64) -> ColliderBuilder {
    shape
        .friction(0.0)
        .friction_combine_rule(CoefficientCombineRule::Min)
        .mass_properties(MassProperties::default())
        .restitution(restitution as Real)
        .restitution_combine_rule(CoefficientCombineRule::Min)
}

/// The restitution of balls; where they do not collide with each other, that of the walls.
fn ball_restitution(scene: &Scene) -> f64 {
    scene.contact.or(scene.cushions).unwrap_or(0.0)
}

fn insert(world: &mut World, scene: &Scene, body: &Body) -> RigidBodyHandle {
    let built = RigidBodyBuilder::dynamic()
        .translation(vector(body.position))
        .linvel(vector(body.velocity))
        .linear_damping((scene.drag / body.mass) as Real)
        .additional_mass_properties(point_mass(body.mass))
        .lock_rotations()
        .can_sleep(false);
    // Balls in group 1, walls in group 2; without a contact effect balls meet walls alone, and
    // without walls as well there are no colliders at all.
    let meets = match (scene.contact, scene.cushions) {
        (None, None) => return world.insert(built, None),
        (None, Some(_)) => Group::GROUP_2,
        (Some(_), _) => Group::ALL,
    };
    let ball = collider(
        ColliderBuilder::ball(body.radius as Real),
        ball_restitution(scene),
    )
    .collision_groups(groups(Group::GROUP_1, meets));
    world.insert(built, Some(ball))
}

/// Half-spaces at x, z and y, the negative side first.
fn insert_walls(world: &mut World, scene: &Scene) {
    let Some(restitution) = scene.cushions else {
        return;
    };
    // `Max` outranks the `Min` of the balls, so that a wall that is bouncier keeps its own.
    let rule = if restitution > ball_restitution(scene) {
        CoefficientCombineRule::Max
    } else {
        CoefficientCombineRule::Min
    };
    for axis in [0, 2, 1] {
        let Some(distance) = scene.half[axis] else {
            continue;
        };
        for side in [-1.0, 1.0] {
            let along = |length: f64| {
                let mut arrow = [0.0; 3];
                arrow[axis] = length;
                vector(arrow)
            };
            let inward = rapier3d::na::Unit::new_unchecked(along(-side));
            let wall = collider(ColliderBuilder::halfspace(inward), restitution)
                .translation(along(side * distance))
                .restitution_combine_rule(rule)
                .collision_groups(groups(Group::GROUP_2, Group::GROUP_1));
            world.insert_wall(wall);
        }
    }
}
