//! The exact engine: from event to event, without a time step.
//!
//! Scenes without attraction and springs fly in closed form ([`flight`]).

mod flight;
mod real;
mod wide;

pub use flight::{Certified, FlightSimulation, Simultaneous, TieOrder, certified};
pub use real::Real;
pub use wide::Wide;

use super::{ExactSettings, Phase, Simulation};
use crate::error::Result;
use crate::recording::{Digits, Recording, Undetermined};
use crate::scene::Scene;

/// Puts a scene at its start, in doubles and uncertified.
///
/// # Errors
/// [`Error::EngineCannot`](crate::error::Error::EngineCannot) for what has no exact meaning.
pub fn simulation(scene: &Scene) -> Result<Box<dyn Simulation + Send>> {
    Ok(Box::new(FlightSimulation::<f64>::new(
        scene,
        TieOrder::Rule,
    )?))
}

/// Computes a scene and vouches for digits.
///
/// # Errors
/// As [`simulation`].
pub fn record(scene: &Scene, voice: &str) -> Result<Recording> {
    let certified = certified(scene)?;
    let mut recording = certified.recording;
    voice.clone_into(&mut recording.voice);
    recording.digits = Some(
        certified
            .digits
            .iter()
            .map(|digits| Digits {
                positions: f64::from(digits.position),
                velocities: f64::from(digits.velocity),
            })
            .collect(),
    );
    recording.undetermined = certified.undetermined.map(|from| Undetermined {
        time_s: from.time,
        bodies: from.bodies,
        spread: from.spread,
    });
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
