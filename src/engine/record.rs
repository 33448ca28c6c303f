//! The recorder: drives a simulation from sample to sample and keeps what it sees.

use super::{EngineKind, EngineSpec, Simulation, StepGrid, exact, prepare};
use crate::error::Result;
use crate::recording::{Outcome, Recording, initial_states};
use crate::scene::Scene;

/// Runs an engine on a scene and records every sample and event.
///
/// The recording ends at the last sample in which everything is finite.
///
/// # Errors
/// As [`prepare`]. A blow-up is no error but the recording's outcome.
pub fn record(scene: &Scene, spec: &EngineSpec, dt: f64) -> Result<Recording> {
    record_within(scene, spec, dt, u64::MAX)
}

/// The same with a bound on the counted work: past it the recording ends as
/// [`Outcome::BudgetSpent`], of the hand-written engines within the step, of the others at the next
/// sample. The engine `exact` has a bound of its own.
///
/// # Errors
/// As [`record`].
pub fn record_within(scene: &Scene, spec: &EngineSpec, dt: f64, budget: u64) -> Result<Recording> {
    if let EngineKind::Exact(settings) = spec.kind
        && settings.certify
    {
        return exact::record(scene, &spec.name, settings);
    }
    let mut simulation = prepare(scene, spec, dt)?;
    let last = scene.sample_count();
    let mut recording = drive_within(scene, &spec.name, simulation.as_mut(), last, budget);
    let step = StepGrid::new(scene, dt)?.step;
    recording.step = spec.takes_steps().then_some(step);
    Ok(recording)
}

/// Drives a simulation that stands at the start of a scene to its end, and records it.
///
/// The recording ends at the last sample in which everything is finite.
#[must_use]
pub fn drive(scene: &Scene, voice: &str, simulation: &mut dyn Simulation) -> Recording {
    drive_to(scene, voice, simulation, scene.sample_count())
}

/// The same up to a sample.
#[must_use]
pub fn drive_to(
    scene: &Scene,
    voice: &str,
    simulation: &mut dyn Simulation,
    last: usize,
) -> Recording {
    drive_within(scene, voice, simulation, last, u64::MAX)
}

fn drive_within(
    scene: &Scene,
    voice: &str,
    simulation: &mut dyn Simulation,
    last: usize,
    budget: u64,
) -> Recording {
    let mut recording = Recording::at_start(voice, scene);
    let mut states = initial_states(scene);
    simulation.limit(budget);
    for sample in 1..=last {
        let halt = simulation.advance_to(sample, Some(&mut recording.events));
        simulation.state_into(&mut states);
        if !recording.keep(scene, halt, &states) {
            break;
        }
        if sample < last && simulation.work().total() > budget {
            let time = scene.sample_time(sample);
            recording.outcome = Outcome::BudgetSpent { time };
            break;
        }
    }
    recording.work = simulation.work();
    recording.concessions = simulation.concessions();
    recording
}
