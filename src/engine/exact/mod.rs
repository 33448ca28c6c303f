//! The exact engine: from event to event, without a time step.
//!
//! Scenes without attraction and springs fly in closed form (`flight`); the others are
//! integrated by Taylor series (`forces`).

pub mod flight;
pub mod forces;
mod real;
mod wide;

pub use real::Real;
pub use wide::Wide;

use super::{ExactSettings, Phase, Simulation};
use crate::error::Result;
use crate::recording::{Digits, Recording, Undetermined};
use crate::scene::Scene;

/// A recording with what it vouches for.
#[derive(Debug, Clone)]
pub struct Certified {
    /// The recording.
    pub recording: Recording,
    /// Digits of each sample. Shape: `[sample]`.
    pub digits: Vec<Digits>,
    /// Where the model has no single answer, if anywhere.
    pub undetermined: Option<Undetermined>,
}

/// Whether a scene needs an integrator: its flights have no closed form.
fn has_forces(scene: &Scene) -> bool {
    scene.effects.attraction.is_some() || !scene.effects.springs.is_empty()
}

/// Puts a scene at its start, in doubles and uncertified.
///
/// # Errors
/// [`Error::EngineCannot`](crate::error::Error::EngineCannot) for what has no exact meaning.
pub fn simulation(scene: &Scene) -> Result<Box<dyn Simulation + Send>> {
    if has_forces(scene) {
        let simulation = forces::ForcesSimulation::<f64>::new(scene, forces::Accuracy::FAST)?;
        return Ok(Box::new(simulation));
    }
    let simulation = flight::FlightSimulation::<f64>::new(scene, flight::TieOrder::Rule)?;
    Ok(Box::new(simulation))
}

/// Computes a scene and vouches for digits.
///
/// # Errors
/// As [`simulation`].
pub fn record(scene: &Scene, voice: &str) -> Result<Recording> {
    let certified = if has_forces(scene) {
        forces::certified(scene)?
    } else {
        flight::certified(scene)?
    };
    let mut recording = certified.recording;
    voice.clone_into(&mut recording.voice);
    recording.digits = Some(certified.digits);
    recording.undetermined = certified.undetermined;
    Ok(recording)
}

/// What the engine does on a scene; nothing else runs.
///
/// # Errors
/// As [`simulation`].
pub fn phases(scene: &Scene, settings: ExactSettings) -> Result<Vec<Phase>> {
    simulation(scene)?;
    let effects = &scene.effects;
    let flight = match (effects.drag.is_some(), effects.gravity.is_some()) {
        _ if has_forces(scene) => "Taylor series of all forces, steps by their own convergence",
        (false, false) => "straight lines",
        (true, false) => "closed form with drag",
        (false, true) => "parabolas",
        (true, true) => "closed form with drag and gravity",
    };
    let event = |present: bool, name, method: &str| present.then(|| Phase::new(name, method));
    let phases = [
        event(true, "flight", flight),
        event(
            effects.contact.is_some(),
            "contacts",
            "time of impact of each pair, impulse",
        ),
        event(
            effects.cushions.is_some(),
            "cushions",
            "time of impact at each wall, impulse",
        ),
        event(
            effects.rest.is_some(),
            "rest",
            "time at which the speed has fallen, stop",
        ),
        event(
            settings.certify,
            "certify",
            "again in other arithmetic and from moved inputs",
        ),
    ];
    Ok(phases.into_iter().flatten().collect())
}
