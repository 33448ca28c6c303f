//! A scene as this engine needs it: bodies, law of flight, walls, rules; what it must refuse.

use super::law::{Fixed, Law, State};
use crate::error::{Error, Result, code};
use crate::physics::real::{Real, vector};
use crate::recording::Wall;
use crate::scene::LOOKS_MAX;
use crate::scene::Scene;
use crate::scene::overlap::survey;

/// Events nearer than this many units of rounding of the duration are simultaneous.
const TIE_ROUNDINGS: f64 = 64.0;

/// Times nearer than this share of the duration are compared with care: 64 roundings of a double.
const NEAR: f64 = 64.0 * f64::EPSILON;

/// Room for positions that were meant to touch, in roundings of the largest coordinate.
const TOUCH_ROUNDINGS: f64 = 16.0;

/// A wall across an axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane<R> {
    /// Which of the six.
    pub wall: Wall,
    /// The axis that it is normal to.
    pub axis: usize,
    /// Side of the box: +1 or -1.
    pub side: R,
    /// Distance from the middle of the box.
    pub half: R,
}

/// Everything about a scene that does not change while it runs.
#[derive(Debug, Clone)]
pub(super) struct Model<R: Real> {
    /// The equation of flight.
    pub law: Law<R>,
    /// The bodies. Shape: `[body]`.
    pub fixed: Vec<Fixed<R>>,
    /// Diameter of every body, where all have the same: then no pair has to look it up.
    diameter: Option<R>,
    /// Restitution of contacts, where spheres collide at all.
    pub contact: Option<R>,
    /// The walls, in the model's order.
    pub planes: Vec<Plane<R>>,
    /// Restitution of the walls.
    pub cushion: R,
    /// Speed below which a ball stops, if it ever does.
    pub rest: Option<R>,
    /// Time between two samples, s.
    pub sample_every: f64,
    /// Length of the simulation, its last sample included, s.
    pub duration: R,
    /// Events no farther apart are simultaneous, s.
    pub tie: R,
    /// Times nearer than this are compared as times, not by the clock of the law, s.
    pub near: R,
}

impl<R: Real> Model<R> {
    /// Takes a checked scene over.
    pub fn of(scene: &Scene) -> Self {
        let effects = &scene.effects;
        let drag = effects.drag.map_or(0.0, |drag| drag.coefficient);
        let fixed: Vec<_> = scene
            .bodies
            .iter()
            .map(|body| Fixed {
                mass: R::from_f64(body.mass),
                radius: R::from_f64(body.radius),
                rate: R::from_f64(drag) / R::from_f64(body.mass),
            })
            .collect();
        let last = scene.sample_time(scene.sample_count());
        let duration = R::from_f64(scene.duration.max(last));
        let shared = fixed.iter().all(|body| body.radius == fixed[0].radius);
        Self {
            diameter: shared.then(|| fixed[0].radius.twice()),
            law: Law::of(scene, &fixed),
            fixed,
            contact: effects
                .contact
                .map(|contact| R::from_f64(contact.restitution)),
            planes: planes(scene),
            cushion: effects
                .cushions
                .map_or(R::one(), |cushions| R::from_f64(cushions.restitution)),
            rest: effects
                .rest
                .filter(|rest| rest.speed > 0.0)
                .map(|rest| R::from_f64(rest.speed)),
            sample_every: scene.sample_every,
            duration,
            tie: duration * R::from_f64(TIE_ROUNDINGS * R::EPSILON),
            near: duration * R::from_f64(NEAR),
        }
    }
}

impl<R: Real> Model<R> {
    /// Distance at which two bodies touch.
    #[inline]
    pub fn reach(&self, a: usize, b: usize) -> R {
        match self.diameter {
            Some(diameter) => diameter,
            None => self.fixed[a].radius + self.fixed[b].radius,
        }
    }

    /// Tells that radii have been changed.
    pub fn forget_diameter(&mut self) {
        self.diameter = None;
    }
}

fn planes<R: Real>(scene: &Scene) -> Vec<Plane<R>> {
    let Some(cushions) = scene.effects.cushions else {
        return Vec::new();
    };
    let half = [
        Some(cushions.half_width),
        cushions.half_height,
        Some(cushions.half_length),
    ];
    let plane = |wall: Wall| {
        let (axis, side) = wall.axis_and_side();
        half[axis].map(|half| Plane {
            wall,
            axis,
            side: R::from_f64(side),
            half: R::from_f64(half),
        })
    };
    Wall::ALL.into_iter().filter_map(plane).collect()
}

/// The states with which a scene starts. Shape: `[body]`.
pub(super) fn start<R: Real>(scene: &Scene) -> Vec<State<R>> {
    let state = |body: &crate::scene::Body| State {
        position: vector(body.position.map(|x| x + 0.0)),
        velocity: vector(body.velocity.map(|v| v + 0.0)),
    };
    scene.bodies.iter().map(state).collect()
}

/// Whether this engine's model has an answer for the scene.
///
/// # Errors
/// [`Error::EngineCannot`]: attraction or springs (another half of the engine has them), rest
/// together with gravity, spheres that overlap or stand beyond a wall at the start.
pub(super) fn accept(scene: &Scene) -> Result<()> {
    scene.checked()?;
    let refuse = |what: String, remedy: &str| {
        Err(Error::EngineCannot {
            engine: "exact",
            what,
            remedy: remedy.to_owned(),
        })
    };
    let effects = &scene.effects;
    if effects.attraction.is_some() || !effects.springs.is_empty() {
        return refuse(
            "closed-form flight knows neither attraction nor springs".into(),
            "leave these effects out",
        );
    }
    let falls = effects
        .gravity
        .is_some_and(|gravity| gravity.acceleration.iter().any(|a| a.abs() > 0.0));
    if falls && effects.rest.is_some_and(|rest| rest.speed > 0.0) {
        return refuse(
            "rest together with gravity has no exact meaning: a ball at the top of its flight would stop there".into(),
            "leave out one of effects.rest and effects.gravity",
        );
    }
    if let Some(what) = beyond_wall(scene).or_else(|| overlapping(scene)) {
        return refuse(what, "move them apart: the model has no push-out");
    }
    Ok(())
}

fn rounding(scene: &Scene) -> f64 {
    let largest = scene
        .bodies
        .iter()
        .flat_map(|body| body.position.map(f64::abs).into_iter().chain([body.radius]))
        .fold(0.0, f64::max);
    TOUCH_ROUNDINGS * f64::EPSILON * largest
}

fn beyond_wall(scene: &Scene) -> Option<String> {
    let room = rounding(scene);
    for plane in planes::<f64>(scene) {
        for body in &scene.bodies {
            let depth = plane.side * body.position[plane.axis] + body.radius - plane.half;
            if depth > room {
                return Some(format!(
                    "{} starts beyond the wall {} by {depth:.3e}",
                    code(&body.name),
                    plane.wall
                ));
            }
        }
    }
    None
}

fn overlapping(scene: &Scene) -> Option<String> {
    scene.effects.contact?;
    let spheres: Vec<_> = scene
        .bodies
        .iter()
        .map(|body| (body.position.into(), body.radius))
        .collect();
    // The first of many overlaps are enough to refuse the scene.
    let some = survey(&spheres, LOOKS_MAX);
    let found = if some.all
        || some
            .deepest
            .is_some_and(|deepest| deepest.depth > rounding(scene))
    {
        some
    } else {
        survey(&spheres, u64::MAX)
    };
    let deepest = found.deepest?;
    (deepest.depth > rounding(scene)).then(|| {
        format!(
            "{} and {} overlap at the start by {:.3e}",
            code(&scene.bodies[deepest.a].name),
            code(&scene.bodies[deepest.b].name),
            deepest.depth
        )
    })
}
