//! The shots of a search: scenes with what their errors are measured against.

use rayon::prelude::*;

use super::Candidate;
use super::objective::{effective, typical};
use crate::engine::{EngineSpec, drive_to, prepare};
use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::study::cost::{Ending, Reference, sensitivity};

/// A scene, and the exact recording up to its horizon.
#[derive(Debug, Clone)]
pub struct Shot {
    /// The scene.
    pub scene: Scene,
    reference: Reference,
}

/// What one run on a shot gave.
#[derive(Debug, Clone, PartialEq)]
pub struct ShotError {
    /// Name of the scene.
    pub scene: String,
    /// Largest position error before the horizon, scene length unit; none for a failed run.
    pub position_max: Option<f64>,
    /// How it ended.
    pub ending: Ending,
    /// The error as it counts in the objective.
    pub effective: f64,
}

impl Shot {
    /// A scene with its reference, or why it has none.
    ///
    /// # Errors
    /// A scene that is not one.
    pub fn of(scene: &Scene) -> Result<std::result::Result<Self, String>> {
        Ok(Reference::exact(scene)?.map(|mut reference| {
            // Cuts the reference at its horizon, as the study of cost does.
            let _ = sensitivity(scene, &mut reference);
            Self {
                scene: scene.clone(),
                reference,
            }
        }))
    }

    /// A scene to tune on, which must have a reference.
    pub(super) fn to_tune_on(scene: &Scene) -> Result<Self> {
        Self::of(scene)?.map_err(|why| Error::Argument {
            argument: "tune-on",
            found: scene.name.clone(),
            remedy: format!("it has nothing to measure errors against ({why}); tune on another"),
        })
    }

    /// Runs an engine up to the horizon: what comes later is not compared.
    fn run(&self, spec: &EngineSpec, dt: f64) -> Result<ShotError> {
        let last = self.reference.comparable - 1;
        let (position_max, ending) = match prepare(&self.scene, spec, dt) {
            Ok(mut simulation) => {
                let run = drive_to(&self.scene, &spec.name, simulation.as_mut(), last);
                let distance = self.reference.distance(&run);
                let error = distance.filter(|_| run.outcome.is_finished());
                (error, Ending::Ran(run.outcome))
            }
            Err(refusal @ Error::EngineCannot { .. }) => {
                (None, Ending::Refused(refusal.to_string()))
            }
            Err(error) => return Err(error),
        };
        Ok(ShotError {
            scene: self.scene.name.clone(),
            effective: effective(position_max, self.reference.sizes.length),
            position_max,
            ending,
        })
    }
}

/// Runs every candidate on every shot: the errors of each, and their geometric mean.
///
/// # Errors
/// As [`prepare`], but for a refusal, which counts as a failed run.
pub fn measure(shots: &[Shot], candidates: &[Candidate]) -> Result<Vec<(Vec<ShotError>, f64)>> {
    let all: Vec<(&Candidate, &Shot)> = candidates
        .iter()
        .flat_map(|candidate| shots.iter().map(move |shot| (candidate, shot)))
        .collect();
    let run = |(candidate, shot): &(&Candidate, &Shot)| {
        let spec = EngineSpec {
            name: "candidate".to_owned(),
            summary: "",
            kind: candidate.kind.clone(),
        };
        shot.run(&spec, candidate.dt)
    };
    let errors: Vec<ShotError> = all.par_iter().map(run).collect::<Result<_>>()?;
    let of_candidate = errors.chunks(shots.len().max(1));
    Ok(of_candidate
        .map(|errors| {
            let mean = typical(errors.iter().map(|error| error.effective));
            (errors.to_vec(), mean.unwrap_or(0.0))
        })
        .collect())
}

/// Refuses a scene that is both tuned and scored on, by its name or by what happens in it.
pub(super) fn check_apart(tuned_on: &[Scene], scored_on: &[Scene]) -> Result<()> {
    let refuse = |scene: &Scene, remedy: String| {
        Err(Error::Argument {
            argument: "tune-on",
            found: scene.name.clone(),
            remedy,
        })
    };
    for scene in tuned_on {
        let same = |other: &&Scene| {
            other.name == scene.name
                || (&other.bodies, &other.effects) == (&scene.bodies, &scene.effects)
        };
        if let Some(other) = scored_on.iter().find(same) {
            return refuse(
                scene,
                format!(
                    "`{}` is scored as well; settings tuned on a scene say nothing there, score \
                     them on others",
                    other.name
                ),
            );
        }
        let first = tuned_on[0].units;
        if scene.units != first {
            return refuse(
                scene,
                format!(
                    "its unit of length is not that of `{}`; tune on scenes of one unit",
                    tuned_on[0].name
                ),
            );
        }
    }
    Ok(())
}
