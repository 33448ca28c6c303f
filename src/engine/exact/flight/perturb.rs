//! A scene of flights with inputs moved by less than a double can tell.

use nalgebra::Vector3;

use super::law::{Law, State};
use super::model::Model;
use crate::engine::exact::nudge::directions;
use crate::physics::real::{Real, vector};
use crate::scene::Scene;

/// Moves every number of a scene by the relative `share`, up or down by lot.
pub(super) fn perturb<R: Real>(
    model: &mut Model<R>,
    bodies: &mut [State<R>],
    scene: &Scene,
    (share, seed): (f64, u64),
) {
    let directions = directions(scene, seed);
    let by = |direction: f64| R::from_f64(direction).times(share);
    let by_three =
        |direction: [f64; 3]| -> Vector3<R> { vector(direction).map(|x: R| x.times(share)) };
    model.forget_diameter();
    let moving = bodies.iter_mut().zip(&mut model.fixed);
    for ((state, fixed), direction) in moving.zip(&directions.bodies) {
        state.position += by_three(direction.position);
        state.velocity += by_three(direction.velocity);
        let mass = fixed.mass;
        fixed.mass += by(direction.mass);
        fixed.radius += by(direction.radius);
        // The other laws have one rate for all, or none.
        if model.law.is_searched() {
            fixed.rate *= mass / fixed.mass;
        }
    }
    let effects = &directions.effects;
    if let Some(cushions) = &effects.cushions {
        let half = cushions.half_extents();
        for plane in &mut model.planes {
            plane.half += by(half[plane.axis]);
        }
        model.cushion += by(cushions.restitution);
    }
    if let (Some(e), Some(contact)) = (&mut model.contact, &effects.contact) {
        *e += by(contact.restitution);
    }
    if let (Some(rest), Some(direction)) = (&mut model.rest, &effects.rest) {
        *rest += by(direction.speed);
    }
    let coefficient = scene.effects.drag.map_or(0.0, |drag| drag.coefficient);
    if coefficient > 0.0
        && let Some(drag) = &effects.drag
    {
        let factor = R::one() + by(drag.coefficient / coefficient);
        for body in &mut model.fixed {
            body.rate *= factor;
        }
        if let Law::Drag { rate } = &mut model.law {
            *rate *= factor;
        }
    }
    if let (Law::Gravity { acceleration } | Law::Mixed { acceleration }, Some(gravity)) =
        (&mut model.law, &effects.gravity)
    {
        *acceleration += by_three(gravity.acceleration);
    }
}
