//! Two computations of one scene, and how many digits they vouch for.

use super::accuracy::Accuracy;
use super::scalar::Wide;
use super::simulation::{ForcesSimulation, Undetermined};
use crate::engine::Simulation;
use crate::engine::exact::Certified;
use crate::error::Result;
use crate::physics::{BodyState, Vector3};
use crate::recording::{Digits, EventLog, Outcome, Recording, Work, initial_states};
use crate::scene::Scene;

/// The name of the voice in recordings.
const VOICE: &str = "exact";

/// Work in double-double after which a scene goes on in doubles, in forces times order: some
/// ten seconds. Larger clusters get there; the digits then say what doubles can vouch for.
const WIDE_WORK_MAX: f64 = 5e8;

/// Work after which a certified run ends, in forces times bodies squared: some ten seconds. A
/// clump of many bodies in which impacts never cease gets there.
const WORK_MAX: f64 = 5e8;

/// The true error may be larger than the difference of two computations that err; by how much
/// a claim allows for.
const SAFETY: f64 = 10.0;

/// Computes a scene with forces and certifies its digits.
///
/// Two computations by different orders, tolerances and thresholds of contact, in
/// double-double while their work, bounded, lasts and in doubles after it, are compared
/// sample by sample. Equation: digits = `-log10(10 (difference + rounding)/scale)`, the
/// difference being the largest so far, so that a chance agreement claims nothing.
///
/// # Errors
/// As [`ForcesSimulation::new`].
pub fn certified(scene: &Scene) -> Result<Certified> {
    let mut published = Voice::new(scene, Accuracy::WIDE, Accuracy::FAST)?;
    let mut witness = Voice::new(scene, Accuracy::WIDE_AGAIN, Accuracy::FAST_AGAIN)?;
    let mut recording = Recording::at_start(VOICE, scene);
    let mut states = initial_states(scene);
    let mut others = states.clone();
    let mut claims = Claims::default();
    let mut digits = vec![claims.digits(&states, &states)];
    let mut undetermined = None;
    for sample in 1..=scene.sample_count() {
        let halt = published.advance_to(sample, Some(&mut recording.events));
        let again = witness.advance_to(sample, None);
        undetermined = published.undetermined();
        let stopped =
            published
                .unsettled()
                .map(|Undetermined { time, bodies }| Outcome::Collapsed {
                    time,
                    a: bodies[0],
                    b: (bodies[1] != bodies[0]).then_some(bodies[1]),
                });
        if let Some(outcome) = halt.or(stopped) {
            recording.outcome = outcome;
            recording
                .events
                .truncate_after(scene.sample_time(sample - 1));
            break;
        }
        published.state_into(&mut states);
        witness.state_into(&mut others);
        if again.is_some() || witness.unsettled().is_some() {
            claims.withdraw();
        }
        recording.push(&states);
        recording.events.end_interval();
        digits.push(claims.digits(&states, &others));
        if effort(published.work(), scene.bodies.len()) > WORK_MAX {
            recording.outcome = Outcome::BudgetSpent {
                time: scene.sample_time(sample),
            };
            break;
        }
        if published.is_spent() || witness.is_spent() {
            published.go_on_in_doubles(scene, sample)?;
            witness.go_on_in_doubles(scene, sample)?;
        }
    }
    recording.work = published.work();
    Ok(Certified {
        recording,
        digits,
        undetermined: undetermined.map(|from| crate::recording::Undetermined {
            time: from.time,
            bodies: from.bodies.to_vec(),
            spread: None,
        }),
    })
}

/// Work done, in forces times bodies squared: each step also solves for the contacts.
#[allow(clippy::cast_precision_loss, reason = "an estimate")]
fn effort(work: Work, bodies: usize) -> f64 {
    work.force_evaluations as f64 * (bodies * bodies) as f64
}

/// One of the two computations: wide at first, in doubles once the work is spent.
struct Voice {
    wide: Option<ForcesSimulation<Wide>>,
    double: ForcesSimulation<f64>,
    wide_order: usize,
    /// Work done before the change.
    before: Work,
}

impl Voice {
    fn new(scene: &Scene, wide: Accuracy, double: Accuracy) -> Result<Self> {
        Ok(Self {
            wide: Some(ForcesSimulation::new(scene, wide)?),
            double: ForcesSimulation::new(scene, double)?,
            wide_order: wide.order,
            before: Work::default(),
        })
    }

    fn simulation(&mut self) -> &mut dyn Simulation {
        match &mut self.wide {
            Some(wide) => wide,
            None => &mut self.double,
        }
    }

    fn advance_to(&mut self, sample: usize, log: Option<&mut EventLog>) -> Option<Outcome> {
        self.simulation().advance_to(sample, log)
    }

    fn state_into(&mut self, into: &mut [BodyState]) {
        self.simulation().state_into(into);
    }

    fn undetermined(&self) -> Option<Undetermined> {
        match &self.wide {
            Some(wide) => wide.undetermined(),
            None => self.double.undetermined(),
        }
    }

    fn unsettled(&self) -> Option<Undetermined> {
        match &self.wide {
            Some(wide) => wide.unsettled(),
            None => self.double.unsettled(),
        }
    }

    /// Whether the wide computation has done its share.
    fn is_spent(&self) -> bool {
        #[allow(clippy::cast_precision_loss, reason = "an estimate")]
        self.wide.as_ref().is_some_and(|wide| {
            wide.work().force_evaluations as f64 * self.wide_order as f64 > WIDE_WORK_MAX
        })
    }

    fn go_on_in_doubles(&mut self, scene: &Scene, sample: usize) -> Result<()> {
        scene.checked()?;
        if let Some(wide) = self.wide.take() {
            let mut states = initial_states(scene);
            wide.state_into(&mut states);
            self.double.set_state(sample, &states);
            self.before = wide.work();
        }
        Ok(())
    }

    fn work(&mut self) -> Work {
        let before = self.before;
        let now = self.simulation().work();
        Work {
            steps: before.steps + now.steps,
            pair_tests: before.pair_tests + now.pair_tests,
            force_evaluations: before.force_evaluations + now.force_evaluations,
        }
    }
}

/// What has been seen of two computations so far.
#[derive(Debug, Default)]
struct Claims {
    /// Corners of the box of all positions.
    corners: Option<(Vector3, Vector3)>,
    fastest: f64,
    position: f64,
    velocity: f64,
}

impl Claims {
    /// Claims nothing from here on.
    fn withdraw(&mut self) {
        self.position = f64::INFINITY;
        self.velocity = f64::INFINITY;
    }

    /// Takes the next sample of both; gives the digits of the first.
    fn digits(&mut self, states: &[BodyState], others: &[BodyState]) -> Digits {
        let mut farthest = 0.0_f64;
        for (state, other) in states.iter().zip(others) {
            let (x, v) = (&state.position, &state.velocity);
            let (low, high) = self.corners.unwrap_or((*x, *x));
            self.corners = Some((low.inf(x), high.sup(x)));
            farthest = farthest.max(x.norm());
            self.fastest = self.fastest.max(v.norm());
            self.position = larger(self.position, (x - other.position).norm());
            self.velocity = larger(self.velocity, (v - other.velocity).norm());
        }
        let size = self.corners.map_or(0.0, |(low, high)| (high - low).norm());
        let rounding = f64::EPSILON / 2.0;
        Digits {
            position: digits_of(self.position + rounding * farthest, size),
            velocity: digits_of(self.velocity + rounding * self.fastest, self.fastest),
        }
    }
}

/// The larger; infinite where one is not a number.
fn larger(one: f64, other: f64) -> f64 {
    if other.is_nan() {
        return f64::INFINITY;
    }
    one.max(other)
}

/// Digits that an error leaves of a scale; 0 where nothing moves, as nothing is known then.
fn digits_of(error: f64, scale: f64) -> u8 {
    let digits = -(SAFETY * error / scale).log10();
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to 0..17"
    )]
    if digits.is_finite() {
        digits.clamp(0.0, 15.0) as u8
    } else {
        0
    }
}
