//! Inputs moved by a hair, to see what becomes of it.

use super::scalar::{Real, Triple, size};

/// Moves every coordinate by up to that share of the largest one, every component of a velocity by
/// up to that share of the body's speed: by half of it at least, up or down by lot.
///
/// A coordinate that happens to be 0 is as unsure as any other. What rests stays at rest.
pub(super) fn nudge<T: Real>(
    position: &mut [Triple<T>],
    velocity: &mut [Triple<T>],
    share: f64,
    seed: u64,
) {
    let mut lot = seed;
    // The upper bits of a linear congruence: Knuth, MMIX.
    let mut by = |most: f64| {
        lot = lot
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let sign = if lot >> 63 == 0 { 1.0 } else { -1.0 };
        let upper = u32::try_from((lot >> 32) & 0x7fff_ffff).unwrap_or(0);
        let part = 0.5 + 0.5 * f64::from(upper) / f64::from(1_u32 << 31);
        T::from_f64(sign * part * share * most)
    };
    let coordinates = position.iter().flatten();
    let extent = coordinates.fold(0.0_f64, |most, x| most.max(x.to_f64().abs()));
    for (position, velocity) in position.iter_mut().zip(velocity) {
        let speed = size(velocity);
        for axis in 0..3 {
            position[axis] += by(extent);
            velocity[axis] += by(speed);
        }
    }
}
