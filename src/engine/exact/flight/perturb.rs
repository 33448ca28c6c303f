//! Inputs moved by a hair, to see what becomes of it.

use super::law::State;
use super::model::Model;
use crate::physics::real::{Real, length};

/// Moves every number of a scene by the relative `share`, up or down by lot.
///
/// Coordinates move by a share of the largest one, components of a velocity by a share of the
/// speed: a coordinate that happens to be 0 is as unsure as any other. What rests stays at rest.
pub(super) fn perturb<R: Real>(
    model: &mut Model<R>,
    bodies: &mut [State<R>],
    share: f64,
    seed: u64,
) {
    let mut lot = seed;
    let mut nudge = |by: R| {
        // The upper bits of a linear congruence: Knuth, MMIX.
        lot = lot
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        if lot >> 63 == 0 { by } else { -by }
    };
    let share = R::from_f64(share);
    let extent = bodies
        .iter()
        .flat_map(|body| body.position.iter())
        .fold(R::zero(), |most, x| most.larger(x.abs()));
    for State { position, velocity } in bodies {
        let speed = length(velocity);
        for axis in 0..3 {
            position[axis] += nudge(share * extent);
            velocity[axis] += nudge(share * speed);
        }
    }
    model.forget_diameter();
    for body in &mut model.fixed {
        body.mass += nudge(share * body.mass);
        body.radius += nudge(share * body.radius);
    }
    for plane in &mut model.planes {
        plane.half += nudge(share * plane.half);
    }
    let restitutions = [model.contact.as_mut(), Some(&mut model.cushion)];
    for e in restitutions.into_iter().flatten() {
        *e += nudge(share * *e);
    }
}
