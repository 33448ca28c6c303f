//! Scenes that have no exact meaning, or do not belong here: refused by name.

use super::impacts::closed_below;
use super::touch::{Surfaces, Touch};
use crate::error::{Error, Result, code};
use crate::scene::Scene;

/// Overlaps up to this share of the largest coordinate or radius are rounding of a scene file.
const ROUNDING: f64 = 1e-13;

/// Checks that the scene can be computed with forces.
pub(super) fn check(scene: &Scene) -> Result<()> {
    scene.checked()?;
    let refuse = |what: String, remedy: &'static str| {
        Err(Error::EngineCannot {
            engine: "exact",
            what,
            remedy: remedy.to_owned(),
        })
    };
    let effects = &scene.effects;
    if effects.rest.is_some() {
        let mut with = Vec::new();
        with.extend(effects.attraction.map(|_| "attraction"));
        with.extend(effects.gravity.map(|_| "gravity"));
        with.extend((!effects.springs.is_empty()).then_some("springs"));
        if !with.is_empty() {
            let with = with.join(" and ");
            return refuse(
                format!(
                    "rest together with {with}: what a force does to a stopped ball is undefined"
                ),
                "take [effects.rest] out of the scene, or the force",
            );
        }
    }
    let surfaces = Surfaces::<f64>::of(scene);
    let position: Vec<[f64; 3]> = scene.bodies.iter().map(|body| body.position).collect();
    let far = scene.bodies.iter().fold(0.0_f64, |far, body| {
        let coordinates = body.position.map(f64::abs);
        coordinates.into_iter().fold(far.max(body.radius), f64::max)
    });
    let rounding = closed_below::<f64>(far).max(ROUNDING * far);
    for touch in surfaces.all() {
        let depth = -surfaces.gap(touch, &position);
        if depth > rounding {
            let name = |body: usize| code(&scene.bodies[body].name);
            let what = match touch {
                Touch::Pair { a, b } => format!(
                    "spheres that overlap at the start: {} and {}, {depth:e} deep",
                    name(a),
                    name(b)
                ),
                Touch::Wall { body, wall } => format!(
                    "a sphere in a wall at the start: {} in {wall}, {depth:e} deep",
                    name(body)
                ),
            };
            return refuse(what, "move the bodies apart");
        }
    }
    Ok(())
}
