//! Inputs moved by a hair, to see what becomes of it.
//!
//! How a scene is moved depends on the names of its bodies and on directions that the scene itself
//! gives, not on the order of the bodies or on the axes: the same scene with its bodies in another
//! order, or turned, is moved alike, so that what is concluded from it is the same.

use nalgebra::Vector3;

use super::law::{Law, State};
use super::model::Model;
use crate::engine::exact::order::mixed;
use crate::physics::real::{Real, length};

/// A direction is taken where so much of its length is across those before it.
const ACROSS: f64 = 1e-6;

/// Draws signs, the same ones for the same names.
struct Lot(u64);

impl Lot {
    fn of(name: &str, seed: u64) -> Self {
        let letters = name.bytes().map(u64::from);
        Self(letters.fold(mixed(seed), |sum, letter| mixed(sum ^ letter)))
    }

    /// 1 or -1.
    fn sign(&mut self) -> f64 {
        self.0 = mixed(self.0);
        if self.0 >> 63 == 0 { 1.0 } else { -1.0 }
    }

    /// The share, up or down.
    fn nudge<R: Real>(&mut self, share: R) -> R {
        share.times(self.sign())
    }
}

/// Moves every number of a scene by the relative `share`, up or down by lot.
///
/// Coordinates move by a share of the largest distance from the origin, components of a velocity
/// by a share of the speed: a coordinate that happens to be 0 is as unsure as any other. What
/// rests stays at rest.
pub(super) fn perturb<R: Real>(
    model: &mut Model<R>,
    bodies: &mut [State<R>],
    names: &[&str],
    (share, seed): (f64, u64),
) {
    let axes = frame(model, bodies, names, seed).map(|axis| axis.map(R::from_f64));
    let share = R::from_f64(share);
    let extent = bodies
        .iter()
        .map(|body| length(&body.position))
        .fold(R::zero(), R::larger);
    model.forget_diameter();
    let moving = bodies.iter_mut().zip(&mut model.fixed).zip(names);
    for ((State { position, velocity }, fixed), name) in moving {
        let mut lot = Lot::of(name, seed);
        let speed = length(velocity);
        for axis in &axes {
            *position += axis * lot.nudge(share * extent);
            *velocity += axis * lot.nudge(share * speed);
        }
        fixed.mass += lot.nudge(share * fixed.mass);
        fixed.radius += lot.nudge(share * fixed.radius);
    }
    for plane in &mut model.planes {
        // Both walls of a pair stand where one number puts them, whatever the axis is called.
        let half = plane.half.to_f64().to_bits();
        plane.half += Lot(mixed(half ^ mixed(seed))).nudge(share * plane.half);
    }
    let mut lot = Lot::of("effects", seed);
    let restitutions = [model.contact.as_mut(), Some(&mut model.cushion)];
    for e in restitutions.into_iter().flatten() {
        *e += lot.nudge(share * *e);
    }
    if let Some(rest) = &mut model.rest {
        *rest += lot.nudge(share * *rest);
    }
    let drag = R::one() + lot.nudge(share);
    for body in &mut model.fixed {
        body.rate *= drag;
    }
    match &mut model.law {
        Law::Straight => {}
        Law::Drag { rate } => *rate *= drag,
        Law::Gravity { acceleration } | Law::Mixed { acceleration } => {
            let size = length(acceleration);
            for axis in &axes {
                *acceleration += axis * lot.nudge(share * size);
            }
        }
    }
}

/// Three directions at right angles that turn with the scene.
fn frame<R: Real>(
    model: &Model<R>,
    bodies: &[State<R>],
    names: &[&str],
    seed: u64,
) -> [Vector3<f64>; 3] {
    let doubles = |vector: &Vector3<R>| vector.map(Real::to_f64);
    let places: Vec<_> = bodies.iter().map(|body| doubles(&body.position)).collect();
    #[allow(clippy::cast_precision_loss, reason = "a direction")]
    let middle = places.iter().sum::<Vector3<f64>>() / places.len() as f64;
    let mut sums = [Vector3::zeros(); 3];
    for ((body, place), name) in bodies.iter().zip(&places).zip(names) {
        // Unlike weights, so that the sum over a symmetrical scene is not zero.
        let hashed = mixed(Lot::of(name, seed).0);
        #[allow(clippy::cast_precision_loss, reason = "a weight")]
        let weight = 0.5 + (hashed >> 11) as f64 / (1_u64 << 53) as f64;
        sums[0] += (place - middle) * weight;
        sums[1] += doubles(&body.velocity) * weight;
        sums[2] += place * weight;
    }
    let falls = match &model.law {
        Law::Straight | Law::Drag { .. } => Vector3::zeros(),
        Law::Gravity { acceleration } | Law::Mixed { acceleration } => doubles(acceleration),
    };
    let own = [sums[0], sums[1], falls, sums[2]];
    let given = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut axes = Vec::with_capacity(3);
    for direction in own.into_iter().chain(given) {
        let mut rest: Vector3<f64> = direction;
        for axis in &axes {
            rest -= axis * direction.dot(axis);
        }
        if axes.len() < 3 && rest.norm() > ACROSS * direction.norm() {
            axes.push(rest.normalize());
        }
    }
    [0, 1, 2].map(|place| axes.get(place).copied().unwrap_or_default())
}
