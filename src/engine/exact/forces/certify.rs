//! Two computations of one scene, and how many digits they vouch for.

use super::accuracy::Accuracy;
use super::scalar::Wide;
use super::simulation::{ForcesSimulation, Undetermined};
use super::ties::Judge;
use crate::engine::Simulation;
use crate::engine::exact::Certified;
use crate::engine::exact::claim::{Scale, claims};
use crate::engine::exact::order::TieOrder;
use crate::engine::exact::parting::{Parting, SAFETY};
use crate::engine::exact::ties::{Noted, SAME};
use crate::error::Result;
use crate::physics::BodyState;
use crate::physics::real::Real;
use crate::recording::{
    self, COMPARABLE_DIGITS, Digits, EventLog, Outcome, Recording, Work, initial_states,
};
use crate::scene::Scene;

/// The name of the voice in recordings.
const VOICE: &str = "exact";

/// Operations in double-double after which a scene goes on in doubles: a second or two. Larger
/// clusters get there; the digits then say what doubles can vouch for.
const WIDE_OPERATIONS: u64 = 1_000_000_000;

/// Operations in doubles after which an undetermined cluster is no longer certified.
const SETTLING_OPERATIONS: f64 = 1e9;

/// Inputs of the second computation are moved by this share, to see how errors grow: some eight
/// thousand roundings of a double-double.
const NUDGE: f64 = 8.077_935_669_463_161e-28; // 2^-90

/// The same for doubles: eight roundings, as those of steps add up by lot.
const NUDGE_DOUBLE: f64 = 8.881_784_197_001_252e-16; // 2^-50

/// A step or event may add so many roundings to the error of a run.
const ROUNDINGS_A_STEP: f64 = 64.0;

/// Second computations that are tried where one ends before the first does.
const WITNESSES_MAX: u64 = 3;

/// Computes a scene with forces and certifies its digits.
///
/// Two computations by different orders, steps, tolerances and thresholds of contact, the second
/// from inputs moved by a hair, in double-double while their work, bounded, lasts and in doubles
/// after it, are compared sample by sample. Equation: digits = `-log10((10 difference +
/// rounding)/scale)`, the difference being the largest so far, so that a chance agreement claims
/// nothing. The moved inputs show how errors grow where both would round alike, as on straight
/// lines and parabolas.
///
/// What is certified is the answer by the model's rule. Where another order of simultaneous
/// impacts would have answered otherwise that order is computed too, for the spread. A cluster
/// in which that happened and whose two computations have parted goes on alone, in doubles and
/// with shorter bounces, as nothing of it is claimed.
/// Units: `operations` bounds each computation, in elementary operations.
///
/// # Errors
/// As [`ForcesSimulation::new`].
pub fn certified(scene: &Scene, operations: u64) -> Result<Certified> {
    let mut published =
        Voice::new(scene, [Accuracy::WIDE, Accuracy::FAST], operations)?.watched(scene);
    let mut seed = 1;
    let mut witness = Some(Voice::witness(scene, operations, seed)?);
    let mut recording = Recording::at_start(VOICE, scene);
    let mut states = initial_states(scene);
    published.begin(Some(&mut recording.events));
    published.state_into(&mut states);
    recording.restart(&states);
    recording.events.end_interval();
    let mut next = states.clone();
    let mut others = states.clone();
    let mut errors = vec![Parting::default()];
    let mut sample = 1;
    while sample <= scene.sample_count() {
        let events = published.is_wide().then(|| recording.events.clone());
        let halt = published.advance_to(sample, Some(&mut recording.events));
        let mut halted = witness.as_mut().map(|it| it.advance_to(sample, None));
        while halt.is_none()
            && published.is_wide()
            && matches!(halted, Some(Some(Outcome::Collapsed { .. })))
            && seed < WITNESSES_MAX
        {
            seed += 1;
            let mut other = Voice::witness(scene, operations, seed)?;
            halted = Some(other.advance_to(sample, None));
            witness = Some(other);
        }
        let spent = |halt: Option<Outcome>| matches!(halt, Some(Outcome::BudgetSpent { .. }));
        if let Some(events) = events
            && (spent(halt) || spent(halted.flatten()))
        {
            recording.events = events;
            published.narrow(scene, sample - 1, &states);
            if let Some(witness) = &mut witness {
                witness.narrow(scene, sample - 1, &others);
            }
            continue;
        }
        published.state_into(&mut next);
        if !recording.keep(scene, halt, &next) {
            break;
        }
        states.clone_from(&next);
        let mut parting = match &witness {
            Some(witness) if halted.flatten().is_none() => {
                witness.state_into(&mut others);
                Parting::default().with_states(&states, &others)
            }
            Some(_) | None => Parting::unknown(),
        };
        if published.is_rounded_to_an_event() {
            parting.velocity = f64::INFINITY;
        }
        errors.push(parting.scaled(SAFETY * published.growth_of_roundings()));
        if witness.is_some()
            && published.is_unsettled()
            && (is_lost(&errors, &recording) || published.is_costly())
        {
            published.narrow(scene, sample, &states);
            published.double.settle_sooner();
            witness = None;
        }
        sample += 1;
    }
    recording.work = published.work();
    let (digits, undetermined) = judged(scene, &recording, errors, (&published, operations))?;
    Ok(Certified {
        recording,
        digits,
        undetermined,
    })
}

/// The digits that are left by these errors, and where the model has no single answer, if
/// anywhere: where another order of simultaneous or nearly simultaneous impacts decides.
fn judged(
    scene: &Scene,
    recording: &Recording,
    mut errors: Vec<Parting>,
    (published, operations): (&Voice, u64),
) -> Result<(Vec<Digits>, Option<recording::Undetermined>)> {
    let scale = Scale::of(recording);
    let mut undetermined = match published.undetermined() {
        Some(from) => Some(recording::Undetermined {
            time: from.time,
            bodies: from.bodies.to_vec(),
            spread: Some(spread(scene, recording, from.time, operations)?),
        }),
        None => None,
    };
    if let Some(from) = &undetermined
        && let Some(spread) = from.spread.filter(|it| *it <= SAME * scale.diagonal)
    {
        // One answer, with as many digits as the orders share.
        for (sample, error) in errors.iter_mut().enumerate() {
            if scene.sample_time(sample) >= from.time {
                error.position += SAFETY * spread;
            }
        }
        undetermined = None;
    }
    let digits = claims(&errors, &scale);
    let certain = |sample: &usize| {
        digits[*sample].position >= COMPARABLE_DIGITS
            && !undetermined
                .as_ref()
                .is_some_and(|from| scene.sample_time(*sample) >= from.time)
    };
    let judge = Judge {
        scene,
        recording,
        scale: &scale,
        noted: published.noted(),
        known: (0..digits.len()).take_while(certain).count(),
        operations,
    };
    if let Some(found) = judge.judge()? {
        undetermined = Some(found);
    }
    Ok((digits, undetermined))
}

/// How far the impacts in the opposite order lead away, from a time on, over all bodies.
fn spread(scene: &Scene, recording: &Recording, from: f64, operations: u64) -> Result<f64> {
    let samples = recording.sample_count();
    let before = (1..samples).find(|sample| scene.sample_time(*sample) >= from);
    let start = before.map_or(samples, |sample| sample) - 1;
    let mut states = recording.sample(start).to_vec();
    let mut other = ForcesSimulation::<f64>::new(scene, Accuracy::FAST)?
        .with_order(TieOrder::Backwards)
        .limited(operations);
    other.set_state(start, &states);
    let mut parting = Parting::default();
    for sample in start + 1..samples {
        if other.advance_to(sample, None).is_some() {
            break;
        }
        other.state_into(&mut states);
        parting = parting.with_states(recording.sample(sample), &states);
    }
    Ok(parting.position)
}

/// One of the two computations: wide at first, in doubles once that work is spent.
struct Voice {
    wide: Option<ForcesSimulation<Wide>>,
    double: ForcesSimulation<f64>,
    /// What the wide one did, once it is gone.
    before: Work,
    undetermined: Option<Undetermined>,
    unsettled: bool,
    /// What nearly fell on one instant while it was wide.
    noted: Option<Noted<Wide>>,
    /// The lot by which its inputs are moved, if they are.
    moved_by: Option<u64>,
}

impl Voice {
    /// A second computation, which differs in all that it can.
    fn witness(scene: &Scene, operations: u64, seed: u64) -> Result<Self> {
        let again = [Accuracy::WIDE_AGAIN, Accuracy::FAST_AGAIN];
        let mut witness = Self::new(scene, again, operations)?;
        witness.moved_by = Some(seed);
        if let Some(wide) = &mut witness.wide {
            wide.move_inputs(NUDGE, seed);
        }
        witness.begin(None);
        Ok(witness)
    }

    /// Lets what happens at time 0 happen.
    fn begin(&mut self, log: Option<&mut EventLog>) {
        match &mut self.wide {
            Some(wide) => wide.begin(log),
            None => self.double.begin(log),
        }
    }

    /// How many times more its roundings may amount to than the moved inputs show.
    #[allow(clippy::cast_precision_loss, reason = "an estimate")]
    fn growth_of_roundings(&self) -> f64 {
        match &self.wide {
            Some(wide) => {
                let steps = wide.work().steps as f64;
                (ROUNDINGS_A_STEP * Wide::EPSILON * steps / NUDGE).max(1.0)
            }
            None => 1.0,
        }
    }

    /// Whether the last sample stands at an event that doubles cannot tell from it.
    fn is_rounded_to_an_event(&self) -> bool {
        self.wide.is_none() && self.double.is_near_event()
    }

    fn new(scene: &Scene, [wide, double]: [Accuracy; 2], operations: u64) -> Result<Self> {
        let limit = WIDE_OPERATIONS.min(operations);
        Ok(Self {
            wide: Some(ForcesSimulation::new(scene, wide)?.limited(limit).patient()),
            double: ForcesSimulation::new(scene, double)?
                .limited(operations)
                .patient(),
            before: Work::default(),
            undetermined: None,
            unsettled: false,
            noted: None,
            moved_by: None,
        })
    }

    /// The same with an eye on impacts that nearly fall on one instant.
    fn watched(mut self, scene: &Scene) -> Self {
        self.noted = Some(Noted::new(scene.duration));
        self.wide = self.wide.map(ForcesSimulation::watched);
        self
    }

    fn noted(&self) -> Noted<Wide> {
        let now = self.wide.as_ref().and_then(|wide| wide.watch.as_deref());
        let none = || Noted::new(0.0);
        now.or(self.noted.as_ref()).cloned().unwrap_or_else(none)
    }

    fn is_wide(&self) -> bool {
        self.wide.is_some()
    }

    fn simulation(&self) -> &dyn Simulation {
        match &self.wide {
            Some(wide) => wide,
            None => &self.double,
        }
    }

    fn advance_to(&mut self, sample: usize, log: Option<&mut EventLog>) -> Option<Outcome> {
        match &mut self.wide {
            Some(wide) => wide.advance_to(sample, log),
            None => self.double.advance_to(sample, log),
        }
    }

    fn state_into(&self, into: &mut [BodyState]) {
        self.simulation().state_into(into);
    }

    /// Where the model first ceased to have a single answer.
    fn undetermined(&self) -> Option<Undetermined> {
        let now = match &self.wide {
            Some(wide) => wide.undetermined(),
            None => self.double.undetermined(),
        };
        self.undetermined.or(now)
    }

    /// Whether a cluster had no single answer.
    fn is_unsettled(&self) -> bool {
        match &self.wide {
            Some(wide) => wide.is_unsettled(),
            None => self.unsettled || self.double.is_unsettled(),
        }
    }

    /// Whether it has taken the work that certainty about an undetermined cluster is worth.
    fn is_costly(&self) -> bool {
        self.wide.is_none() && self.double.operations() > SETTLING_OPERATIONS
    }

    /// Goes on in doubles from these states, if it has not yet.
    fn narrow(&mut self, scene: &Scene, sample: usize, states: &[BodyState]) {
        if let Some(wide) = self.wide.take() {
            let kept = |from: &Undetermined| from.time <= scene.sample_time(sample);
            self.undetermined = wide.undetermined().filter(kept);
            self.unsettled = wide.is_unsettled();
            self.before = wide.work();
            if let Some(watch) = &wide.watch {
                self.noted = Some(watch.up_to(scene.sample_time(sample)));
            }
            self.double.set_state(sample, states);
            if let Some(seed) = self.moved_by {
                self.double.move_inputs(NUDGE_DOUBLE, seed);
            }
        }
    }

    fn work(&self) -> Work {
        let (before, now) = (self.before, self.simulation().work());
        Work {
            steps: before.steps + now.steps,
            pair_tests: before.pair_tests + now.pair_tests,
            force_evaluations: before.force_evaluations + now.force_evaluations,
            solving: before.solving + now.solving,
        }
    }
}

/// Whether too few digits are left to compare positions.
fn is_lost(errors: &[Parting], recording: &Recording) -> bool {
    let largest = errors
        .iter()
        .fold(0.0, |most: f64, own| most.max(own.position));
    let digits = Scale::of(recording).digits(largest, 0.0);
    digits.position < COMPARABLE_DIGITS
}
