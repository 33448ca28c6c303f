//! What an engine produced: states on the scene's time grid, events, work, and how it ended.

mod bounds;
mod concession;
mod digest;
mod digits;
mod event;
mod events_csv;
mod ledger;
mod misplaced;
mod number;
mod outcome;
mod start;
mod table;
mod trajectory_csv;

pub(crate) use bounds::EVENTS_BYTES_MAX;
pub use bounds::{trajectory_bytes, trajectory_bytes_max, trajectory_room};
pub use concession::{Concession, ConcessionKind};
pub use digits::{COMPARABLE_DIGITS, Digits, Undetermined};
pub use event::{Event, EventCounts, EventKind, EventLog, Wall};
pub use events_csv::{read_events, write_events};
pub use ledger::{Account, Entry, Ledger};
pub use number::finite_or_blank;
pub use outcome::{CollapseReason, Outcome};
pub use start::{check_start, initial_states};
pub use trajectory_csv::{read_trajectory, read_trajectory_start, write_trajectory};

use serde::Serialize;

use crate::physics::BodyState;
use crate::scene::Scene;

/// Counted work of a simulation, independent of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Work {
    /// Steps taken.
    pub steps: u64,
    /// Pairs of bodies looked at for a contact, where the engine counts them.
    pub pair_tests: u64,
    /// Pair and body forces evaluated, where the engine counts them.
    pub force_evaluations: u64,
    /// All else that takes time, such as impacts that are solved together, in units of about a
    /// look at a pair; where the engine counts it.
    pub solving: u64,
}

impl Work {
    /// All of it as one number: steps, looks, evaluations and what stands for them.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.steps
            .saturating_add(self.pair_tests)
            .saturating_add(self.force_evaluations)
            .saturating_add(self.solving)
    }
}

impl std::ops::Sub for Work {
    type Output = Self;

    /// The work since an earlier count of the same simulation.
    fn sub(self, earlier: Self) -> Self {
        Self {
            steps: self.steps - earlier.steps,
            pair_tests: self.pair_tests - earlier.pair_tests,
            force_evaluations: self.force_evaluations - earlier.force_evaluations,
            solving: self.solving - earlier.solving,
        }
    }
}

/// One run of one engine on one scene, or independent evidence of the same shape.
///
/// Sample n stands at `scene.sample_time(n)`; the recording ends with the last finite sample.
#[derive(Debug, Clone)]
pub struct Recording {
    /// The voice: an engine's name, or `truth`.
    pub voice: String,
    /// The step taken, s; none for evidence without steps.
    pub step: Option<f64>,
    /// States, shape `[sample][body]` laid flat.
    states: Vec<BodyState>,
    body_count: usize,
    /// Impacts and stops in order of time.
    pub events: EventLog,
    /// Counted work.
    pub work: Work,
    /// How it ended.
    pub outcome: Outcome,
    /// Digits that each sample vouches for; none where nobody certified them.
    pub digits: Option<Vec<Digits>>,
    /// From when on the model has no single answer.
    pub undetermined: Option<Undetermined>,
    /// What the engine gave up to go on.
    pub concessions: Vec<Concession>,
}

impl Recording {
    /// A recording that holds only the scene's start.
    #[must_use]
    pub fn at_start(voice: &str, scene: &Scene) -> Self {
        let mut recording = Self::empty(voice, scene.bodies.len());
        recording.states = initial_states(scene);
        recording
    }

    fn empty(voice: &str, body_count: usize) -> Self {
        Self {
            voice: voice.to_owned(),
            step: None,
            states: Vec::new(),
            body_count,
            events: EventLog::default(),
            work: Work::default(),
            outcome: Outcome::Finished,
            digits: None,
            undetermined: None,
            concessions: Vec::new(),
        }
    }

    /// Appends the states of the next sample. Shape of `states`: `[body]`.
    pub fn push(&mut self, states: &[BodyState]) {
        debug_assert_eq!(states.len(), self.body_count);
        self.states.extend_from_slice(states);
    }

    /// Puts other states in the place of the start: those after what happens at time 0. Shape of
    /// `states`: `[body]`.
    pub fn restart(&mut self, states: &[BodyState]) {
        for (own, state) in self.states.iter_mut().zip(states) {
            *own = *state;
        }
    }

    /// How many samples there are, the start included.
    #[must_use]
    pub fn sample_count(&self) -> usize {
        self.states.len() / self.body_count
    }

    /// Keeps the next sample with the events before it; or, where the simulation has halted or a
    /// number is no longer finite, ends at the sample before. Whether it goes on.
    pub fn keep(&mut self, scene: &Scene, halt: Option<Outcome>, states: &[BodyState]) -> bool {
        let sample = self.sample_count();
        let blown_up = Outcome::blown_up(states, scene.sample_time(sample));
        if let Some(outcome) = halt.or(blown_up) {
            self.outcome = outcome;
            self.events.truncate_after(scene.sample_time(sample - 1));
            return false;
        }
        self.push(states);
        self.events.end_interval();
        true
    }

    /// How many samples at the start can be compared position by position: those with enough
    /// certified digits, before anything undetermined. All of them where nothing is certified.
    #[must_use]
    pub fn comparable_samples(&self, scene: &Scene) -> usize {
        let count = self.sample_count();
        let certain = self.digits.as_ref().map_or(count, |digits| {
            let weak = |digits: &Digits| digits.position < COMPARABLE_DIGITS;
            digits.iter().position(weak).unwrap_or(count)
        });
        let determined = self.undetermined.as_ref().map_or(count, |from| {
            (0..count)
                .find(|sample| scene.sample_time(*sample) >= from.time)
                .unwrap_or(count)
        });
        certain.min(determined)
    }

    /// The fewest digits of any comparable sample; none where nothing is certified.
    #[must_use]
    pub fn fewest_digits(&self, scene: &Scene) -> Option<Digits> {
        let comparable = self.comparable_samples(scene);
        let digits = self.digits.as_ref()?.iter().take(comparable).copied();
        digits.reduce(|fewest, digits| Digits {
            position: fewest.position.min(digits.position),
            velocity: fewest.velocity.min(digits.velocity),
        })
    }

    /// Every n-th sample, the start first. Valid for n above 0.
    #[must_use]
    pub fn every(&self, n: usize) -> Self {
        let samples = self.samples().step_by(n);
        Self {
            states: samples.flatten().copied().collect(),
            digits: None,
            ..self.clone()
        }
    }

    /// The first samples, and the events up to the last of them; at least the start.
    #[must_use]
    pub fn up_to(&self, samples: usize, scene: &Scene) -> Self {
        let samples = samples.clamp(1, self.sample_count());
        let mut start = self.clone();
        start.states.truncate(samples * self.body_count);
        start.events.truncate_after(scene.sample_time(samples - 1));
        start
    }

    /// The states at a sample. Shape: `[body]`.
    ///
    /// # Panics
    /// If the sample lies past [`sample_count`](Self::sample_count).
    #[must_use]
    pub fn sample(&self, sample: usize) -> &[BodyState] {
        &self.states[sample * self.body_count..][..self.body_count]
    }

    /// All samples in order. Shape of each item: `[body]`.
    #[must_use]
    pub fn samples(&self) -> impl ExactSizeIterator<Item = &[BodyState]> {
        self.states.chunks_exact(self.body_count)
    }
}
