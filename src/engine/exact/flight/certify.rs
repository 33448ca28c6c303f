//! How many digits a run vouches for, and where the model itself has no single answer.

use super::judge::Judge;
use super::law::State;
use super::simulation::FlightSimulation;
use crate::engine::Simulation;
use crate::engine::exact::Certified;
use crate::engine::exact::claim::Scale;
use crate::engine::exact::order::TieOrder;
use crate::engine::exact::parting::{Parting, SAFETY};
use crate::engine::exact::ties::{COPIES, Measure, Tie, ties};
use crate::engine::exact::wide::Wide;
use crate::error::Result;
use crate::physics::Vector3;
use crate::physics::real::Real;
use crate::recording::{Digits, Recording, initial_states};
use crate::scene::Scene;

/// Inputs are moved by this share to see how errors grow: thousands of roundings.
const NUDGE: f64 = 8.077_935_669_463_161e-28; // 2^-90

/// An event may add this many roundings to a run's error.
const ROUNDINGS_AN_EVENT: f64 = 64.0;

/// So many samples in a row may each fall on an impact.
const MOMENT: usize = 8;

/// So many copies go along with a run; ties are measured on more of them, where there may be any.
const ALONG: usize = 2;

/// Two copies may show less of what is open than six by this factor, but for one in a thousand.
const DOUBT: f64 = 1e3;

/// Runs a scene and vouches for digits.
///
/// Method: the run is made in double-doubles; two more go along with it, sample by sample, from
/// inputs moved by 2^-90. How far these part is how errors grow; the claim leaves room for 64
/// roundings an event and a factor of 10. Where events nearly coincide, their other orders are
/// compared (`ties`).
/// Units: `operations` bounds each run, in elementary operations.
///
/// # Errors
/// As [`FlightSimulation::new`].
pub fn certified(scene: &Scene, operations: u64) -> Result<Certified> {
    let start = || FlightSimulation::<Wide>::new(scene, TieOrder::Rule);
    let mut run = start()?.limited(operations).watched();
    let copy = |seed: u64| -> Result<_> {
        let copy = FlightSimulation::<Wide>::perturbed(scene, NUDGE, seed)?;
        Ok(copy.limited(operations).watched())
    };
    let mut copies = COPIES.take(ALONG).map(copy).collect::<Result<Vec<_>>>()?;
    let mut recording = Recording::at_start("exact", scene);
    let mut states = initial_states(scene);
    let mut growth = vec![Parting::default()];
    for sample in 1..=scene.sample_count() {
        let halt = run.advance_to(sample, Some(&mut recording.events));
        run.state_into(&mut states);
        if !recording.keep(scene, halt, &states) {
            break;
        }
        let mut parting = Parting::default();
        for other in &mut copies {
            // A moved run that has ended vouches for nothing any more.
            if other.advance_to(sample, None).is_some() {
                parting = Parting::unknown();
            }
            parting = parting.with(differences(&run, other.states()));
        }
        let events = ROUNDINGS_AN_EVENT * Wide::EPSILON * float(run.event_count());
        growth.push(parting.scaled(SAFETY * (events / NUDGE).max(1.0)));
    }
    recording.work = run.work();
    let scale = Scale::of(&recording);
    let ties = measured_ties(&run, copies, copy)?;
    let mut undetermined = None;
    if !ties.is_empty() {
        let judge = Judge {
            scene,
            recording: &recording,
            scale: &scale,
        };
        let judgement = judge.judge(&ties, start()?.limited(operations));
        for (errors, parting) in growth.iter_mut().zip(&judgement.partings) {
            *errors = errors.plus(*parting);
        }
        undetermined = judgement.undetermined;
    }
    Ok(Certified {
        digits: digits(&growth, &scale),
        recording,
        undetermined,
    })
}

/// The ties of a run, measured on more copies where two of them leave room for any.
fn measured_ties(
    run: &FlightSimulation<Wide>,
    mut copies: Vec<FlightSimulation<Wide>>,
    copy: impl Fn(u64) -> Result<FlightSimulation<Wide>>,
) -> Result<Vec<Tie<Wide>>> {
    let Some(watch) = run.watch.as_deref() else {
        return Ok(Vec::new());
    };
    let measured = |copies: &[FlightSimulation<Wide>], doubt: f64| {
        let watches = copies.iter().filter_map(|copy| copy.watch.as_deref());
        let noted: Vec<_> = watches.map(|watch| &watch.noted).collect();
        let (share, roundings) = (NUDGE, 1.0);
        let measure = Measure {
            share,
            roundings,
            doubt,
        };
        ties(&watch.noted, &noted, measure)
    };
    let doubtful = measured(&copies, DOUBT);
    let Some(last) = doubtful.iter().map(|tie| tie.to).reduce(Real::larger) else {
        return Ok(Vec::new());
    };
    let within = Wide::from_f64(watch.noted.within());
    for seed in COPIES.skip(ALONG) {
        let mut copy = copy(seed)?;
        // One that ends sooner has noted what it could.
        copy.run_to(last + within, &mut None);
        copies.push(copy);
    }
    Ok(measured(&copies, 1.0))
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

/// Digits from errors; once a digit is lost it does not come back.
///
/// A velocity may differ for a moment alone, when an impact falls on a sample: that sample claims
/// nothing then, but those after it do.
fn digits(growth: &[Parting], scale: &Scale) -> Vec<Digits> {
    let (mut position, mut velocity) = (0.0_f64, 0.0_f64);
    let mut digits = Vec::with_capacity(growth.len());
    for (sample, errors) in growth.iter().enumerate() {
        position = position.max(errors.position);
        let around = &growth[sample.saturating_sub(1)..growth.len().min(sample + MOMENT)];
        let lasting = around
            .iter()
            .fold(f64::INFINITY, |least, near| least.min(near.velocity));
        velocity = velocity.max(lasting);
        let of_velocity = velocity.max(errors.velocity);
        digits.push(scale.digits(position, of_velocity));
    }
    digits
}

#[allow(clippy::cast_precision_loss, reason = "an estimate")]
fn float(count: u64) -> f64 {
    count as f64
}
