//! Two balls head-on: which restitution do they really have?

use rayon::prelude::*;
use serde::Serialize;

use super::Found;
use super::worker::Worker;
use crate::engine::DEFAULT_DT;
use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::scene::{Body, Contact, Effects, LengthUnit, Scene, Units};
use crate::study::check::Subject;

/// Radius of the balls, m.
const RADIUS: f64 = 0.1;
/// When they meet, s, before the phase is added.
const MEET: f64 = 0.3;
/// Length of the scene, s: they part, or stay together, for longer than they approached.
const DURATION: f64 = 1.0;
const SAMPLE_EVERY: f64 = 0.125;
/// Phases of the impact within a step.
const PHASES: u32 = 8;

/// Roundings that a speed of approach may carry through the steps of an impact. Rapier solves and
/// relaxes a contact in each of four substeps, takes the warm start off and on again, and adds the
/// restitution: some ten of two roundings each, on both balls, and half as much again where the
/// contact is touched in a second step.
pub const ROUNDINGS: f64 = 64.0;

/// Effective restitutions over the phases of a step, and what they may be.
///
/// Bound: |e' - e| <= 64 ulps of 1 in single precision, 7.6e-6. The impulse -(1 + e) u / (1/m + 1/m)
/// is computed from rounded numbers and added to velocities no larger than u, so each of
/// [`ROUNDINGS`] costs at most an ulp of u, and e' = -u'/u as much of 1. Nothing else enters: a
/// contact that is made a step early or late changes when the balls part, not how fast.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Restitution {
    /// The restitution of the scene, e.
    pub restitution: f64,
    /// The effective ones. Shape: `[phase]`.
    pub effective: Vec<f64>,
    /// How far each may be from the scene's.
    pub bound: f64,
}

impl Restitution {
    /// From the effective restitution at each phase, at least one.
    #[must_use]
    pub fn of(restitution: f64, effective: Vec<f64>) -> Self {
        Self {
            restitution,
            effective,
            bound: ROUNDINGS * f64::from(f32::EPSILON),
        }
    }

    /// The smallest and the largest; not a number where any is none.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        // `f64::min` and `f64::max` drop what is no number.
        if self.effective.iter().any(|value| value.is_nan()) {
            return [f64::NAN; 2];
        }
        let values = || self.effective.iter().copied();
        [
            values().fold(f64::INFINITY, f64::min),
            values().fold(f64::NEG_INFINITY, f64::max),
        ]
    }

    /// At how many phases the bound holds.
    #[must_use]
    pub fn held(&self) -> usize {
        let is_near = |value: &&f64| (*value - self.restitution).abs() <= self.bound;
        self.effective.iter().filter(is_near).count()
    }

    /// Whether it holds at all of them.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.held() == self.effective.len()
    }
}

/// Two balls of 1 kg and 0.1 m radius; the first flies at the second, which rests, with `speed`
/// m/s, and meets it `late` s after 0.3 s.
#[must_use]
pub fn two_balls(restitution: f64, speed: f64, late: f64) -> Scene {
    let ball = |name: &str, x: f64, speed: f64| Body {
        name: name.to_owned(),
        mass: 1.0,
        radius: RADIUS,
        position: [x, 0.0, 0.0],
        velocity: [speed, 0.0, 0.0],
    };
    Scene {
        name: "two-balls".to_owned(),
        title: None,
        source: None,
        watch: None,
        duration: DURATION,
        sample_every: SAMPLE_EVERY,
        units: Units {
            length: LengthUnit::Metre,
        },
        bodies: vec![
            ball("a", -RADIUS - speed * (MEET + late), speed),
            ball("b", RADIUS, 0.0),
        ],
        effects: Effects {
            contact: Some(Contact { restitution }),
            ..Effects::default()
        },
    }
}

/// The delays at which the impact falls on the phases of a step, s.
pub fn phases() -> impl Iterator<Item = f64> {
    (0..PHASES).map(|phase| DEFAULT_DT * f64::from(phase) / f64::from(PHASES))
}

/// How fast two bodies part, as a share of how fast they approached.
///
/// Equation: e' = -u'/u, u = (v1 - v2) · N, N the unit vector from the second body to the first at
/// the start.
/// Valid for: two bodies that meet once, head-on; -1 for bodies that pass through each other.
/// Not a number where they do not approach.
#[must_use]
pub fn effective_restitution(recording: &Recording) -> f64 {
    let start = recording.sample(0);
    let normal = (start[0].position - start[1].position).normalize();
    let closing = |sample: usize| {
        let at = recording.sample(sample);
        (at[0].velocity - at[1].velocity).dot(&normal)
    };
    let before = closing(0);
    if before >= 0.0 {
        return f64::NAN;
    }
    -closing(recording.sample_count() - 1) / before
}

/// The effective restitution of a subject at each phase.
///
/// # Errors
/// As [`Subject::record`]; [`Error::Solver`] for a recording that does not come to its end.
pub fn restitution(subject: &dyn Subject, restitution: f64, speed: f64) -> Result<Restitution> {
    let phases: Vec<f64> = phases().collect();
    let effective = phases
        .into_par_iter()
        .map(|late| {
            let scene = two_balls(restitution, speed, late);
            let run = subject.record(&scene, DEFAULT_DT)?;
            if !run.outcome.is_finished() || run.sample_count() <= scene.sample_count() {
                let message = run.outcome.describe(&scene).to_string();
                return Err(Error::Solver {
                    scene: scene.name,
                    message,
                });
            }
            Ok(effective_restitution(&run))
        })
        .collect::<Result<Vec<_>>>()?;
    Ok(Restitution::of(restitution, effective))
}

/// The same, where a worker that fails is a result.
pub(super) fn found(worker: &Worker, e: f64, speed: f64) -> Result<Found> {
    match restitution(worker, e, speed) {
        Ok(restitution) => Ok(Found::Restitution(restitution)),
        Err(Error::Solver { message, .. }) => Ok(Found::Nothing(message)),
        Err(other) => Err(other),
    }
}
