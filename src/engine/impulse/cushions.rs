//! Cushions: overlap, mirror, push back.

use super::observer::Observer;
use super::{Particle, books};
use crate::physics::Vector3;
use crate::physics::cushion_impulse;
use crate::recording::{Account, EventKind, Wall};
use crate::scene::Cushions;

/// The walls in the slides' order, +x -x +z -z, then +y -y which the slides do not have.
const ORDER: [Wall; 6] = [
    Wall::PlusX,
    Wall::MinusX,
    Wall::PlusZ,
    Wall::MinusZ,
    Wall::PlusY,
    Wall::MinusY,
];

/// Slides' `cushion()`: an else-if chain, so one wall a ball and step.
///
/// A ball that overlaps a wall and moves into it is mirrored; whether it does or not, it is
/// pushed back by (1 + e) times the overlap.
///
/// DEVIATES: the slides' cushions are elastic; here `2.0` stands as `1.0 + e`, the same bits at
/// e = 1. With `half_height` the chain goes on to the walls +y and -y.
#[inline]
pub(super) fn bounce<const PUSH_OUT: bool, O: Observer>(
    particles: &mut [Particle],
    effect: &Cushions,
    observer: &mut O,
) {
    let walls = if effect.half_height.is_some() { 6 } else { 4 };
    let half = effect.half_extents();
    for (body, particle) in particles.iter_mut().enumerate() {
        // A ball overlaps one of the two walls across an axis only if its farther side does.
        let is_free = |axis: usize| particle.position[axis].abs() + particle.radius <= half[axis];
        if is_free(0) && is_free(1) && is_free(2) {
            continue;
        }
        if let Some((wall, impulse)) =
            go_through::<PUSH_OUT>(particle, &ORDER[..walls], &half, effect.restitution)
        {
            observer.note(EventKind::Cushion { body, wall }, impulse);
            if O::BOOKS {
                let inward = inward(wall);
                let entry = books::cushion(effect.restitution, particle.mass, impulse, &inward);
                observer.book(Account::Cushions, entry);
            }
        }
    }
}

/// The normal of a wall, into the box.
pub(super) fn inward(wall: Wall) -> Vector3 {
    let (axis, side) = wall.axis_and_side();
    let mut inward = Vector3::zeros();
    inward[axis] = -side;
    inward
}

/// The chain; the wall that the ball runs into, with the impulse.
///
/// Kept out of the loop: overlapping is rare, and the loop over balls stays small.
#[inline(never)]
fn go_through<const PUSH_OUT: bool>(
    particle: &mut Particle,
    walls: &[Wall],
    half: &[f64; 3],
    restitution: f64,
) -> Option<(Wall, f64)> {
    for wall in walls {
        let (axis, side) = wall.axis_and_side();
        if let Some(penetration) = overlap(particle, axis, side, half[axis]) {
            let impulse = mirror(particle, axis, side, restitution);
            if PUSH_OUT {
                particle.position[axis] += (1.0 + restitution) * penetration * -side;
            }
            return impulse.map(|impulse| (*wall, impulse));
        }
    }
    None
}

/// A touching ball's velocity mirrored at a wall; the impulse, none if it moves away.
#[inline]
pub(super) fn mirror(
    particle: &mut Particle,
    axis: usize,
    side: f64,
    restitution: f64,
) -> Option<f64> {
    let normal = -side;
    let normal_velocity = particle.velocity[axis] * normal;
    if normal_velocity < 0.0 {
        let impulse = cushion_impulse(restitution, particle.mass, normal_velocity);
        particle.velocity[axis] -= (1.0 + restitution) * normal_velocity * normal;
        Some(impulse)
    } else {
        None
    }
}

/// One link of the chain: how far the ball overlaps this wall, if it does.
fn overlap(particle: &Particle, axis: usize, side: f64, half: f64) -> Option<f64> {
    let (coordinate, r) = (particle.position[axis], particle.radius);
    if side > 0.0 {
        (coordinate + r > half).then_some(coordinate + r - half)
    } else {
        (coordinate - r < -half).then_some(-half - coordinate + r)
    }
}
