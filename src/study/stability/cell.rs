//! One cell of the matrix: a case on an engine with a step, judged by the bounds of the case.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::case::Expected;
use crate::compare::{Metrics, metrics};
use crate::engine::{EngineKind, EngineSpec, prepare, record, record_within};
use crate::error::{Error, Result};
use crate::physics::BodyState;
use crate::recording::{Account, Outcome, Recording, initial_states};
use crate::scene::Scene;
use crate::study::breaches::{Breach, breaches, energy_rises, momentum_changes};

/// What stands for an engine that cannot do the case.
const REFUSED: &str = "Refused";

/// A case on an engine with a step, as a row of `stability.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// The case.
    pub case: String,
    /// The engine.
    pub engine: String,
    /// The largest step asked for, s; none for engines without steps.
    pub dt: Option<f64>,
    /// `Finished` where every bound held, else the one that was broken first.
    pub outcome: String,
    /// The largest rise of the energy above its start as a share of the scale of the case, or
    /// where the case bounds its fall too, the largest change.
    pub energy_error: Option<f64>,
    /// The largest change of the momentum as a share of its scale, where the case bounds it.
    pub momentum_error: Option<f64>,
    /// The deepest overlap at a sample, scene length unit.
    pub max_penetration: Option<f64>,
    /// Impacts that there should have been and were not, negative where there were too many; none
    /// where the case counts none.
    pub missed_events: Option<i64>,
    /// When the first bound was broken, s, to the next sample; none where all held.
    pub at_time: Option<f64>,
    /// Steps that the engine took.
    pub steps: Option<u64>,
    /// What the run cost, ms: one run, recorded.
    pub cost_ms: Option<f64>,
}

impl Cell {
    /// Whether every bound held.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.outcome == "Finished"
    }

    /// Whether the engine was run at all.
    #[must_use]
    pub fn was_run(&self) -> bool {
        self.steps.is_some()
    }
}

/// A cell with what was broken in it first, in words, and by which phase.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// The cell.
    pub cell: Cell,
    /// What was broken first; none where all bounds held.
    pub broken: Option<String>,
    /// The phase of the hand-written solver that gave the energy, took it or moved the momentum;
    /// none where no books tell.
    pub phase: Option<String>,
    /// Impacts found, of spheres and on walls; none where the engine was not run.
    pub impacts: Option<u64>,
}

/// Runs a case on an engine with a step and judges it.
///
/// `budget` bounds the work that a run may count: steps, looks at pairs, evaluations of forces.
///
/// # Errors
/// As [`record_within`]; an engine that cannot do the case is a result.
pub fn judge(
    scene: &Scene,
    expected: &Expected,
    spec: &EngineSpec,
    dt: f64,
    budget: u64,
) -> Result<Judged> {
    let cell = |outcome: &str| Cell {
        case: scene.name.clone(),
        engine: spec.name.clone(),
        dt: spec.takes_steps().then_some(dt),
        outcome: outcome.to_owned(),
        energy_error: None,
        momentum_error: None,
        max_penetration: None,
        missed_events: None,
        at_time: None,
        steps: None,
        cost_ms: None,
    };
    let begin = Instant::now();
    let recording = match record_within(scene, spec, dt, budget) {
        Ok(recording) => recording,
        Err(refusal @ Error::EngineCannot { .. }) => {
            return Ok(Judged {
                cell: cell(REFUSED),
                broken: Some(refusal.to_string()),
                phase: None,
                impacts: None,
            });
        }
        Err(error) => return Err(error),
    };
    let cost_ms = 1e3 * begin.elapsed().as_secs_f64();
    let metrics = metrics(scene, &recording);
    let first = breaches(scene, expected, &recording, &metrics)
        .into_iter()
        .min_by(|a, b| a.time(scene).total_cmp(&b.time(scene)));
    let fine = match (&first, recording.step) {
        (Some(Breach::Ended { outcome }), Some(step)) => step_by_step(scene, *outcome, step),
        _ => None,
    };
    let crossing = match &fine {
        Some(fine) => energy_crossing(fine, expected, spec)?,
        None => None,
    };
    let first = crossing.or(first);
    let phase = match &first {
        Some(first) => guilty(fine.as_ref().unwrap_or(scene), spec, (dt, budget), first)?,
        None => None,
    };
    let outcome = first.as_ref().map_or("Finished", Breach::word);
    let counts = recording.events.counts();
    Ok(Judged {
        cell: Cell {
            energy_error: energy_error(expected, &metrics),
            momentum_error: momentum_error(expected, &metrics),
            max_penetration: largest(metrics.iter().map(|at| at.max_penetration)),
            missed_events: missed(expected, &recording),
            at_time: first.as_ref().map(|first| first.time(scene)),
            steps: Some(recording.work.steps),
            cost_ms: Some(cost_ms),
            ..cell(outcome)
        },
        broken: first.map(|first| first.to_string()),
        phase: phase.map(|account| account.name().to_owned()),
        impacts: Some(counts.contacts + counts.cushions),
    })
}

/// The largest of the values; none where it is beyond all numbers, which no table holds.
fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.reduce(f64::max).filter(|most| most.is_finite())
}

fn energy_error(expected: &Expected, metrics: &[Metrics]) -> Option<f64> {
    let bound = expected.energy.as_ref()?;
    let falls_count = bound.loss_max.is_some();
    let rises = energy_rises(bound, metrics);
    largest(rises.map(|(_, rise)| if falls_count { rise.abs() } else { rise }))
}

fn momentum_error(expected: &Expected, metrics: &[Metrics]) -> Option<f64> {
    let bound = expected.momentum.as_ref()?;
    largest(momentum_changes(bound, metrics).map(|(_, change)| change))
}

/// Impacts due less those found, of the kinds that the case counts.
fn missed(expected: &Expected, recording: &Recording) -> Option<i64> {
    let due = expected.impacts.as_ref()?;
    let found = recording.events.counts();
    let less = |due: u64, found: u64| due.cast_signed() - found.cast_signed();
    let exact = due.contacts.map(|due| less(due, found.contacts));
    let least = due.contacts_min.map(|due| less(due, found.contacts).max(0));
    let walls = due.cushions.map(|due| less(due, found.cushions));
    let counted = [exact, least, walls].into_iter().flatten();
    counted.reduce(|sum, missed| sum + missed)
}

/// The scene up to where numbers ran out, with a sample after every step: between two samples a
/// blow-up passes all bounds on its way to no number at all.
fn step_by_step(scene: &Scene, outcome: Outcome, step: f64) -> Option<Scene> {
    let Outcome::NonFinite { time, .. } = outcome else {
        return None;
    };
    Some(Scene {
        duration: (time / step).round() * step,
        sample_every: step,
        ..scene.clone()
    })
}

/// When the energy first passed its bound on the way, if it did.
fn energy_crossing(fine: &Scene, expected: &Expected, spec: &EngineSpec) -> Result<Option<Breach>> {
    let recording = record(fine, spec, fine.sample_every)?;
    let metrics = metrics(fine, &recording);
    let broken = breaches(fine, expected, &recording, &metrics).into_iter();
    let mut grew = broken.filter(|breach| matches!(breach, Breach::EnergyGrew(_)));
    Ok(grew.next())
}

/// The phase that did most of what a breach complains of, up to its time, by the books of the
/// engine; none where nobody keeps books or they do not tell.
fn guilty(
    scene: &Scene,
    spec: &EngineSpec,
    (dt, budget): (f64, u64),
    breach: &Breach,
) -> Result<Option<Account>> {
    if !matches!(spec.kind, EngineKind::Impulse(_)) {
        return Ok(None);
    }
    let mut simulation = prepare(scene, spec, dt)?;
    simulation.keep_ledger();
    simulation.limit(budget);
    let mut states = initial_states(scene);
    let mut books = None;
    for sample in 1..=scene.sample_count() {
        let halt = simulation.advance_to(sample, None);
        simulation.state_into(&mut states);
        let is_finite = states.iter().all(BodyState::is_finite);
        // Books of a blow-up hold no numbers: those of the sample before it tell.
        if halt.is_some() || !is_finite {
            break;
        }
        books = simulation.ledger().copied();
        if scene.sample_time(sample) >= breach.time(scene) {
            break;
        }
    }
    let Some(books) = books else {
        return Ok(None);
    };
    let energy = |account: Account| books.of(account).energy;
    let most = |of: &dyn Fn(Account) -> f64| {
        let all = Account::ALL.into_iter();
        let guilty = all.filter(|account| of(*account) > 0.0);
        guilty.max_by(|a, b| of(*a).total_cmp(&of(*b)))
    };
    Ok(match breach {
        Breach::EnergyGrew(_) => books.largest_giver(),
        Breach::EnergyLost(_) => most(&|account| -energy(account)),
        Breach::MomentumOff(_) => most(&|account| books.of(account).momentum.norm()),
        _ => None,
    })
}
