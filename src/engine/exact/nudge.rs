//! Inputs moved by a hair, to see what becomes of it.
//!
//! How a scene is moved depends on the names of its bodies and on directions that the scene itself
//! gives, not on the order of the bodies or on the axes: the same scene with its bodies in another
//! order, or turned, is moved alike, so that what is concluded from it is the same.

use super::order::mixed;
use crate::physics::Vector3;
use crate::scene::Scene;

/// A direction is taken where so much of its length is across those before it.
const ACROSS: f64 = 1e-6;

/// Draws signs, the same ones for the same names.
struct Lot(u64);

impl Lot {
    fn of(name: &str, seed: u64) -> Self {
        let letters = name.bytes().map(u64::from);
        Self(letters.fold(mixed(seed), |sum, letter| mixed(sum ^ letter)))
    }

    /// The value, or its negative.
    fn signed(&mut self, value: f64) -> f64 {
        self.0 = mixed(self.0);
        if self.0 >> 63 == 0 { value } else { -value }
    }

    /// A vector whose components along three axes have that size.
    fn along(&mut self, axes: &[Vector3; 3], size: f64) -> [f64; 3] {
        let sum: Vector3 = axes.iter().map(|axis| axis * self.signed(size)).sum();
        sum.into()
    }
}

/// By how much every number of a scene moves per unit of a relative share, in a scene's shape.
///
/// Coordinates move by a share of the largest distance from the origin, components of a velocity
/// by a share of the speed: a coordinate that happens to be 0 is as unsure as any other. What
/// rests stays at rest; a restitution of 1 falls.
pub(super) fn directions(scene: &Scene, seed: u64) -> Scene {
    let axes = frame(scene, seed);
    let size = |vector: [f64; 3]| Vector3::from(vector).norm();
    let far = scene.bodies.iter().map(|body| size(body.position));
    let extent = far.fold(0.0, f64::max);
    let mut moved = scene.clone();
    for body in &mut moved.bodies {
        let mut lot = Lot::of(&body.name, seed);
        body.position = lot.along(&axes, extent);
        body.velocity = lot.along(&axes, size(body.velocity));
        body.mass = lot.signed(body.mass);
        body.radius = lot.signed(body.radius);
    }
    let effects = &mut moved.effects;
    let mut lot = Lot::of("effects", seed);
    let mut restitution = |e: &mut f64| *e = if *e < 1.0 { lot.signed(*e) } else { -*e };
    if let Some(contact) = &mut effects.contact {
        restitution(&mut contact.restitution);
    }
    if let Some(cushions) = &mut effects.cushions {
        restitution(&mut cushions.restitution);
        // Both walls of a pair stand where one number puts them, whatever the axis is called.
        let wall = |half: &mut f64| *half = Lot(mixed(half.to_bits() ^ mixed(seed))).signed(*half);
        wall(&mut cushions.half_width);
        wall(&mut cushions.half_length);
        cushions.half_height.iter_mut().for_each(wall);
    }
    if let Some(drag) = &mut effects.drag {
        drag.coefficient = lot.signed(drag.coefficient);
    }
    if let Some(rest) = &mut effects.rest {
        rest.speed = lot.signed(rest.speed);
    }
    if let Some(attraction) = &mut effects.attraction {
        attraction.constant = lot.signed(attraction.constant);
        attraction.softening = lot.signed(attraction.softening);
    }
    if let Some(gravity) = &mut effects.gravity {
        gravity.acceleration = lot.along(&axes, size(gravity.acceleration));
    }
    for spring in &mut effects.springs {
        let mut lot = Lot::of(&format!("{}{}", spring.between[0], spring.between[1]), seed);
        spring.stiffness = lot.signed(spring.stiffness);
        spring.rest_length = lot.signed(spring.rest_length);
        spring.damping = lot.signed(spring.damping);
    }
    moved
}

/// Three directions at right angles that turn with the scene.
fn frame(scene: &Scene, seed: u64) -> [Vector3; 3] {
    let places = scene.bodies.iter().map(|body| Vector3::from(body.position));
    #[allow(clippy::cast_precision_loss, reason = "a direction")]
    let middle = places.sum::<Vector3>() / scene.bodies.len().max(1) as f64;
    let mut sums = [Vector3::zeros(); 3];
    for body in &scene.bodies {
        // Unlike weights, so that the sum over a symmetrical scene is not zero.
        let hashed = mixed(Lot::of(&body.name, seed).0);
        #[allow(clippy::cast_precision_loss, reason = "a weight")]
        let weight = 0.5 + (hashed >> 11) as f64 / (1_u64 << 53) as f64;
        let place = Vector3::from(body.position);
        sums[0] += (place - middle) * weight;
        sums[1] += Vector3::from(body.velocity) * weight;
        sums[2] += place * weight;
    }
    let gravity = scene.effects.gravity.map_or([0.0; 3], |g| g.acceleration);
    let own = [sums[0], sums[1], gravity.into(), sums[2]];
    let given = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut axes: Vec<Vector3> = Vec::with_capacity(3);
    for direction in own.into_iter().chain(given) {
        let across = |rest: Vector3, axis: &Vector3| rest - axis * direction.dot(axis);
        let rest = axes.iter().fold(direction, across);
        if axes.len() < 3 && rest.norm() > ACROSS * direction.norm() {
            axes.push(rest.normalize());
        }
    }
    [0, 1, 2].map(|place| axes.get(place).copied().unwrap_or_default())
}
