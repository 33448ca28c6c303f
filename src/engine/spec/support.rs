//! Who computes each effect of a scene, on each engine, and where that is another model.

use super::{EngineKind, EngineSpec, Forces};
use crate::physics::Vector3;
use crate::scene::{Effect, Scene};

/// How an engine comes to an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// By a feature of its own.
    Own,
    /// Carom supplies it from outside.
    Supplied,
    /// By a feature of its own that computes another model.
    OtherModel,
    /// Not everywhere: some scenes with it are refused.
    PartlyAbsent,
}

impl Support {
    /// The words of the table.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Own => "own feature",
            Self::Supplied => "supplied by carom",
            Self::OtherModel => "another model",
            Self::PartlyAbsent => "own feature, absent in part",
        }
    }
}

/// What is said of a Rapier world whose spring joints damp only along the spring.
const ALONG_THE_SPRING: &str = "its spring joint damps the relative velocity along the spring \
     alone, the scene's damper the full relative velocity";

impl EngineSpec {
    /// How the engine comes to an effect, and what must be known about it.
    #[must_use]
    pub fn support(&self, effect: Effect) -> (Support, &'static str) {
        match &self.kind {
            EngineKind::Impulse(_) => (Support::Own, ""),
            EngineKind::Exact(_) => of_exact(effect),
            EngineKind::Rapier(settings) => of_rapier(effect, settings.forces),
        }
    }

    /// In which way the engine computes another model than this scene declares, on purpose; a
    /// difference that comes from it is no error.
    #[must_use]
    pub fn another_model(&self, scene: &Scene) -> Option<&'static str> {
        let (support, _) = self.support(Effect::Springs);
        let mut springs = scene.effects.springs.iter();
        let damped = springs.any(|spring| spring.damping > 0.0);
        let differs = support == Support::OtherModel && damped && !moves_along_one_line(scene);
        differs.then_some(ALONG_THE_SPRING)
    }
}

fn of_exact(effect: Effect) -> (Support, &'static str) {
    match effect {
        Effect::Contact
        | Effect::Cushions
        | Effect::Drag
        | Effect::Attraction
        | Effect::Gravity
        | Effect::Springs => (Support::Own, ""),
        Effect::Rest => (
            Support::PartlyAbsent,
            "refused together with attraction, gravity or springs, where it has no exact meaning",
        ),
    }
}

fn of_rapier(effect: Effect, forces: Forces) -> (Support, &'static str) {
    let by_lecture = "the lecture's formula as a force, once a step";
    match (effect, forces) {
        (Effect::Contact, _) => (Support::Own, "ball colliders and soft contacts"),
        (Effect::Cushions, _) => (Support::Own, "half-spaces as walls, set up by carom"),
        (Effect::Rest, _) => (
            Support::Supplied,
            "velocity 0 below the rest speed, after each step",
        ),
        (Effect::Attraction, _) => (Support::Supplied, "a force on each pair, once a step"),
        (Effect::Drag, Forces::Native) => (Support::Own, "linear damping, implicit"),
        (Effect::Gravity, Forces::Native) => (Support::Own, "in every substep"),
        (Effect::Springs, Forces::Native) => (
            Support::OtherModel,
            "spring joints, implicit; the damper acts along the spring alone",
        ),
        (Effect::Drag | Effect::Gravity | Effect::Springs, Forces::Lecture) => {
            (Support::Supplied, by_lecture)
        }
    }
}

/// Whether all bodies stay on one line, as far as the start tells: they lie on it and move along it,
/// and no wall turns them. Without walls the line may move: a velocity that all bodies share, and
/// gravity, change nothing between them.
fn moves_along_one_line(scene: &Scene) -> bool {
    let [first, others @ ..] = &scene.bodies[..] else {
        return true;
    };
    let origin = Vector3::from(first.position);
    let places = others
        .iter()
        .map(|body| Vector3::from(body.position) - origin);
    let has_walls = scene.effects.cushions.is_some();
    let shared = if has_walls {
        Vector3::zeros()
    } else {
        first.velocity.into()
    };
    let velocities = scene.bodies.iter();
    let velocities = velocities.map(|body| Vector3::from(body.velocity) - shared);
    let gravity = scene.effects.gravity.filter(|_| has_walls);
    let falls = gravity.map(|gravity| gravity.acceleration.into());
    let vectors: Vec<Vector3> = places.chain(velocities).chain(falls).collect();
    let long = |vector: &&Vector3| vector.norm() > 0.0;
    let Some(line) = vectors.iter().find(long) else {
        return true;
    };
    let axes = line.iter().filter(|part| **part != 0.0).count();
    let parallel = |vector: &Vector3| line.cross(vector).norm() == 0.0;
    vectors.iter().all(parallel) && (!has_walls || axes == 1)
}

#[cfg(test)]
mod tests {
    use super::super::engines;
    use super::*;

    #[test]
    fn what_is_not_plainly_own_says_what_it_is() {
        for spec in engines() {
            for effect in Effect::ALL {
                let (support, note) = spec.support(effect);
                assert!(support == Support::Own || !note.is_empty(), "{effect:?}");
            }
        }
    }
}
