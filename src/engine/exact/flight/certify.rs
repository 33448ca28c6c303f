//! How many digits a run vouches for, and where the model itself has no single answer.

use super::law::State;
use super::simulation::{FlightSimulation, Simultaneous};
use crate::engine::Simulation;
use crate::engine::exact::Certified;
use crate::engine::exact::claim::Scale;
use crate::engine::exact::order::TieOrder;
use crate::engine::exact::parting::{Parting, SAFETY};
use crate::engine::exact::wide::Wide;
use crate::error::Result;
use crate::physics::Vector3;
use crate::physics::real::Real;
use crate::recording::{Digits, Recording, Undetermined, initial_states};
use crate::scene::Scene;

/// Inputs are moved by this share to see how errors grow: thousands of roundings.
const NUDGE: f64 = 8.077_935_669_463_161e-28; // 2^-90

/// An event may add this many roundings to a run's error.
const ROUNDINGS_AN_EVENT: f64 = 64.0;

/// Answers that differ by less than this share of the scene's size are the same.
const SAME: f64 = 1e-9;

/// Runs a scene and vouches for digits.
///
/// Method: the run is made in double-doubles; three more go along with it, sample by sample:
/// one in doubles and two in double-doubles from inputs moved by 2^-90. How far these part is how
/// errors grow; the claim leaves room for 64 roundings an event and a factor of 10. Where
/// events coincide, runs with other orders of them are compared.
/// Units: `operations` bounds each run, in elementary operations.
///
/// # Errors
/// As [`FlightSimulation::new`].
pub fn certified(scene: &Scene, operations: u64) -> Result<Certified> {
    let mut run = FlightSimulation::<Wide>::new(scene, TieOrder::Rule)?.limited(operations);
    let mut moved = [1, 2].map(|seed| -> Result<_> {
        let moved = FlightSimulation::<Wide>::perturbed(scene, NUDGE, seed)?;
        Ok(moved.limited(operations))
    });
    let mut double = FlightSimulation::<f64>::new(scene, TieOrder::Rule)?.limited(operations);
    let mut recording = Recording::at_start("exact", scene);
    let mut states = initial_states(scene);
    let mut growth = vec![Growth::default()];
    for sample in 1..=scene.sample_count() {
        let halt = run.advance_to(sample, Some(&mut recording.events));
        run.state_into(&mut states);
        if !recording.keep(scene, halt, &states) {
            break;
        }
        let mut parting = Parting::default();
        for other in &mut moved {
            let Ok(other) = other else { continue };
            // A moved run that has ended vouches for nothing any more.
            if other.advance_to(sample, None).is_some() {
                parting = Parting::unknown();
            }
            parting = parting.with(differences(&run, other.states()));
        }
        let events = ROUNDINGS_AN_EVENT * Wide::EPSILON * float(run.event_count());
        let doubles = if double.advance_to(sample, None).is_some() {
            Parting::unknown()
        } else {
            let states = double.states().map(|state| widened(&state));
            Parting::default().with(differences(&run, states))
        };
        growth.push(Growth {
            errors: parting.scaled(SAFETY * (events / NUDGE).max(1.0)),
            doubles,
        });
    }
    recording.work = run.work();
    let scale = Scale::of(&recording);
    let undetermined = if run.simultaneous().is_empty() {
        None
    } else {
        undetermined(scene, &recording, &growth, &scale, &run, operations)?
    };
    Ok(Certified {
        digits: digits(&growth, &scale),
        recording,
        undetermined,
    })
}

/// What errors have grown to at a sample.
#[derive(Debug, Clone, Copy, Default)]
struct Growth {
    /// Those that the run may have.
    errors: Parting,
    /// Those of the run in doubles.
    doubles: Parting,
}

/// How far a run is from another, body by body: positions and velocities.
fn differences(
    run: &FlightSimulation<Wide>,
    other: impl Iterator<Item = State<Wide>>,
) -> impl Iterator<Item = [Vector3; 2]> {
    run.states().zip(other).map(|(a, b)| {
        let differences = [a.position - b.position, a.velocity - b.velocity];
        differences.map(|difference| difference.map(Real::to_f64))
    })
}

/// Digits from errors; once a digit of a position is lost it does not come back.
///
/// A velocity may differ at one sample alone, when an impact falls on it: the sample claims
/// nothing then, but its neighbours do.
fn digits(growth: &[Growth], scale: &Scale) -> Vec<Digits> {
    let (mut position, mut velocity) = (0.0_f64, 0.0_f64);
    let mut digits = Vec::with_capacity(growth.len());
    for (sample, Growth { errors, .. }) in growth.iter().enumerate() {
        position = position.max(errors.position);
        let around = &growth[sample.saturating_sub(1)..growth.len().min(sample + 2)];
        let lasting = around
            .iter()
            .fold(f64::INFINITY, |least, near| least.min(near.errors.velocity));
        velocity = velocity.max(lasting);
        let of_velocity = velocity.max(errors.velocity);
        digits.push(scale.digits(position, of_velocity));
    }
    digits
}

/// Runs other orders of simultaneous events, and tells where they first part.
fn undetermined(
    scene: &Scene,
    recording: &Recording,
    growth: &[Growth],
    scale: &Scale,
    run: &FlightSimulation<Wide>,
    operations: u64,
) -> Result<Option<Undetermined>> {
    let mut first = usize::MAX;
    let mut spread = 0.0_f64;
    for order in [
        TieOrder::Backwards,
        TieOrder::Drawn(1),
        TieOrder::Drawn(2),
        TieOrder::Drawn(3),
    ] {
        let mut other = FlightSimulation::<Wide>::new(scene, order)?.limited(operations);
        let mut states = initial_states(scene);
        for (sample, Growth { doubles, .. }) in growth.iter().enumerate().skip(1) {
            if other.advance_to(sample, None).is_some() {
                break;
            }
            other.state_into(&mut states);
            let apart = Parting::default()
                .with_states(&states, recording.sample(sample))
                .position;
            // Other orders also move events by the width of an instant, some hundred roundings
            // of a double, which grow as those of the run in doubles do.
            let same = (SAME * scale.diagonal).max(1e4 * doubles.position);
            if apart > same {
                first = first.min(sample);
                spread = spread.max(apart);
            }
        }
    }
    if first == usize::MAX {
        return Ok(None);
    }
    let before = |noted: &&Simultaneous| noted.time <= scene.sample_time(first);
    let simultaneous = run.simultaneous();
    let Some(culprit) = simultaneous.iter().rfind(before) else {
        return Ok(None);
    };
    let near = 1e-9 * scene.duration;
    let mut bodies: Vec<_> = simultaneous
        .iter()
        .filter(|noted| (noted.time - culprit.time).abs() <= near)
        .map(|noted| noted.body)
        .collect();
    bodies.sort_unstable();
    bodies.dedup();
    Ok(Some(Undetermined {
        time: culprit.time,
        bodies,
        spread: Some(spread),
    }))
}

fn widened(state: &State<f64>) -> State<Wide> {
    State {
        position: state.position.map(Wide::from_f64),
        velocity: state.velocity.map(Wide::from_f64),
    }
}

#[allow(clippy::cast_precision_loss, reason = "an estimate")]
fn float(count: u64) -> f64 {
    count as f64
}
