//! The exact engine: from event to event, without a time step.
//!
//! Scenes without attraction and springs fly in closed form (`flight`); the others are
//! integrated by Taylor series (`forces`).

mod audit;
mod claim;
mod effort;
pub mod flight;
pub mod forces;
mod instant;
mod nudge;
mod order;
mod parting;
mod settling;
mod ties;
mod wide;

pub use crate::physics::real::Real;
pub use order::TieOrder;
pub use wide::Wide;

use std::borrow::Cow;

use super::{ExactSettings, Phase, Simulation};
use crate::error::Result;
use crate::physics::BodyState;
use crate::recording::{Digits, Outcome, Recording, Undetermined};
use crate::scene::{Attraction, Scene};

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

/// The scene without an attraction that attracts nothing, of one body or of no strength: its
/// flights have closed forms, which no stiff drag makes slow.
fn without_idle_attraction(scene: &Scene) -> Cow<'_, Scene> {
    let is_idle = |attraction: Attraction| attraction.constant == 0.0 || scene.bodies.len() == 1;
    let mut scene = Cow::Borrowed(scene);
    if scene.effects.attraction.is_some_and(is_idle) {
        scene.to_mut().effects.attraction = None;
    }
    scene
}

/// Whether bodies can come to lie on something, for which flights have no closed form either.
fn can_come_to_lie(scene: &Scene) -> bool {
    let effects = &scene.effects;
    let falls = effects.gravity.is_some_and(|g| g.acceleration != [0.0; 3]);
    falls && (effects.contact.is_some() || effects.cushions.is_some())
}

/// Puts a scene at its start, in doubles and uncertified.
///
/// # Errors
/// [`Error::EngineCannot`](crate::error::Error::EngineCannot) for what has no exact meaning.
pub fn simulation(scene: &Scene, settings: ExactSettings) -> Result<Box<dyn Simulation + Send>> {
    let scene = &*without_idle_attraction(scene);
    let forces = || -> Result<_> {
        let simulation = forces::ForcesSimulation::<f64>::new(scene, forces::Accuracy::FAST)?;
        Ok(simulation.limited(settings.operations))
    };
    if has_forces(scene) {
        return Ok(Box::new(forces()?));
    }
    let flight = flight::FlightSimulation::<f64>::new(scene, TieOrder::Rule)?;
    let flight = flight.limited(settings.operations);
    if can_come_to_lie(scene) {
        let settling = settling::SettlingSimulation::new(flight, forces()?);
        return Ok(Box::new(settling));
    }
    Ok(Box::new(flight))
}

/// Computes a scene and vouches for digits.
///
/// # Errors
/// As [`simulation`].
pub fn record(scene: &Scene, voice: &str, settings: ExactSettings) -> Result<Recording> {
    let mut certified = certified(scene, settings.operations)?;
    let mut recording = certified.recording;
    let lost = |(sample, states): (usize, &[BodyState])| {
        Outcome::blown_up(states, scene.sample_time(sample)).map(|outcome| (sample, outcome))
    };
    let found = recording.samples().enumerate().find_map(lost);
    if let Some((sample, outcome)) = found {
        recording = match sample {
            0 => Recording::at_start(voice, scene),
            _ => recording.up_to(sample, scene),
        };
        recording.outcome = outcome;
        certified.digits.truncate(recording.sample_count());
    }
    voice.clone_into(&mut recording.voice);
    recording.digits = Some(certified.digits);
    recording.undetermined = certified.undetermined;
    audit::audited(scene, &mut recording);
    Ok(recording)
}

fn certified(scene: &Scene, operations: u64) -> Result<Certified> {
    let scene = &*without_idle_attraction(scene);
    if has_forces(scene) {
        return forces::certified(scene, operations);
    }
    let certified = flight::certified(scene, operations)?;
    let piles_up = matches!(certified.recording.outcome, Outcome::Collapsed { .. });
    // Only the other half knows contacts that last, or come to without an end of impacts.
    if piles_up && scene.effects.rest.is_none() {
        return forces::certified(scene, operations);
    }
    Ok(certified)
}

/// How digits are certified, in words.
fn certification(scene: &Scene) -> &'static str {
    if has_forces(scene) {
        "a second computation of another order, tolerance and least bounce from inputs moved by \
         2^-90; the digits in which they agree, less one; near ties in other orders"
    } else {
        "two more computations from inputs moved by 2^-90, which show how errors grow; the digits \
         that 64 roundings an event leave, less one; near ties in other orders"
    }
}

/// What the engine does on a scene; nothing else runs.
///
/// # Errors
/// As [`simulation`].
pub fn phases(scene: &Scene, settings: ExactSettings) -> Result<Vec<Phase>> {
    simulation(scene, settings)?;
    let scene = &*without_idle_attraction(scene);
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
        event(settings.certify, "certify", certification(scene)),
    ];
    Ok(phases.into_iter().flatten().collect())
}
