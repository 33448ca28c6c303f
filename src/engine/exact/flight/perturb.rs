//! Inputs moved by a hair, to see what becomes of it.

use super::law::State;
use super::model::Model;
use crate::engine::exact::real::Real;

/// Moves every number of a scene by the relative `size`, up or down by lot.
pub(super) fn perturb<R: Real>(
    model: &mut Model<R>,
    states: &mut [State<R>],
    size: f64,
    seed: u64,
) {
    let mut lot = seed;
    let mut moved = |number: &mut R| {
        // The upper bits of a linear congruence: Knuth, MMIX.
        lot = lot
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let sign = if lot >> 63 == 0 { size } else { -size };
        *number += *number * R::from_f64(sign);
    };
    for state in states {
        state.position.iter_mut().for_each(&mut moved);
        state.velocity.iter_mut().for_each(&mut moved);
    }
    for body in &mut model.fixed {
        moved(&mut body.mass);
        moved(&mut body.radius);
    }
    model.contact.as_mut().map(&mut moved);
}
