//! Inputs moved by a hair, to see what becomes of it.

use super::law::State;
use super::model::Model;
use crate::engine::exact::real::{Real, length};

/// Moves every number of a scene by the relative `size`, up or down by lot.
///
/// Coordinates move by a share of the largest one, components of a velocity by a share of the
/// speed: a coordinate that happens to be 0 is as unsure as any other. What rests stays at rest.
pub(super) fn perturb<R: Real>(
    model: &mut Model<R>,
    states: &mut [State<R>],
    size: f64,
    seed: u64,
) {
    let mut lot = seed;
    let mut nudge = |size: R| {
        // The upper bits of a linear congruence: Knuth, MMIX.
        lot = lot
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        if lot >> 63 == 0 { size } else { -size }
    };
    let size = R::from_f64(size);
    let extent = states
        .iter()
        .flat_map(|state| state.position.iter())
        .fold(R::zero(), |most, x| most.larger(x.abs()));
    for state in states {
        let speed = length(&state.velocity);
        for axis in 0..3 {
            state.position[axis] += nudge(size * extent);
            state.velocity[axis] += nudge(size * speed);
        }
    }
    model.forget_diameter();
    for body in &mut model.fixed {
        body.mass += nudge(size * body.mass);
        body.radius += nudge(size * body.radius);
    }
    for plane in &mut model.planes {
        plane.half += nudge(size * plane.half);
    }
    let restitutions = [model.contact.as_mut(), Some(&mut model.cushion)];
    for e in restitutions.into_iter().flatten() {
        *e += nudge(size * *e);
    }
}
