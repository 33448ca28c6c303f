//! The simulation: one scheme on one scene, step by step.

use super::observer::{Bookkeeper, Nobody, Observer, Scribe};
use super::phases::Phases;
use super::scheme::{Lecture, Scheme};
use super::{Particle, particles};
use crate::engine::spec::DragRule;
use crate::engine::{Simulation, StepGrid};
use crate::physics::BodyState;
use crate::recording::{Concession, EventLog, Ledger, Outcome, Work};
use crate::scene::Scene;

/// The hand-written impulse solver on one scene; without parameters, the lecture's.
///
/// Symplectic Euler for motion, impulses at the first overlap, push-out. Order 1 in the step.
/// Another scheme `S` makes another rung of the ladder; the phases are the same.
/// Source: lecture, `doSimulation()` of "충돌" (collisions) and of "당구게임" (billiards game).
#[derive(Debug, Clone)]
pub struct ImpulseSimulation<S = Lecture> {
    particles: Vec<Particle>,
    phases: Phases,
    scheme: S,
    grid: StepGrid,
    sample: usize,
    work: Work,
    /// Past so much work it ends.
    budget: u64,
    ledger: Option<Ledger>,
}

impl ImpulseSimulation {
    /// Puts a checked scene at its start.
    #[must_use]
    pub fn new(scene: &Scene, grid: StepGrid) -> Self {
        Self::with(scene, grid, DragRule::Force)
    }
}

#[allow(private_bounds, reason = "the rungs are made here alone")]
impl<S: Scheme> ImpulseSimulation<S> {
    pub(super) fn with(scene: &Scene, grid: StepGrid, drag: DragRule) -> Self {
        let particles = particles(scene);
        let phases = Phases::of(scene, drag);
        Self {
            scheme: S::of(scene, &phases, &particles, grid.step),
            particles,
            phases,
            grid,
            sample: 0,
            work: Work::default(),
            budget: u64::MAX,
            ledger: None,
        }
    }

    /// Takes that many steps unobserved, for a stopwatch that looks at the step alone.
    pub fn take_steps(&mut self, count: u64) {
        for _ in 0..count {
            self.step(&mut Nobody);
        }
    }

    /// Takes steps up to a sample, each told the time at its end; gives the outcome if the work
    /// allowed is spent before.
    fn go_on(&mut self, sample: usize, mut step: impl FnMut(&mut Self, f64)) -> Option<Outcome> {
        while self.sample < sample {
            self.sample += 1;
            for count in 1..=self.grid.steps_per_sample {
                let time = self.grid.time(self.sample, count);
                step(self, time);
                if self.work.total() > self.budget {
                    return Some(Outcome::BudgetSpent { time });
                }
            }
        }
        None
    }

    #[inline]
    fn step(&mut self, observer: &mut impl Observer) {
        let (phases, particles) = (&self.phases, &mut self.particles);
        let taken = self
            .scheme
            .step(phases, particles, self.grid.step, observer);
        self.work.steps += 1;
        self.work.pair_tests += taken.pairs;
        self.work.solving += taken.solving;
        self.work.force_evaluations += taken.passes * phases.forces_a_pass(particles.len() as u64);
    }
}

#[allow(private_bounds, reason = "the rungs are made here alone")]
impl<S: Scheme> Simulation for ImpulseSimulation<S> {
    fn advance_to(&mut self, sample: usize, mut log: Option<&mut EventLog>) -> Option<Outcome> {
        if let Some(mut ledger) = self.ledger.take() {
            let spent = self.go_on(sample, |this, time| {
                let scribe = log.as_deref_mut().map(|log| Scribe { log, time });
                let ledger = &mut ledger;
                this.step(&mut Bookkeeper { ledger, scribe });
            });
            self.ledger = Some(ledger);
            return spent;
        }
        let Some(log) = log else {
            let intervals = sample.saturating_sub(self.sample) as u64;
            self.take_steps(intervals * self.grid.steps_per_sample);
            self.sample = self.sample.max(sample);
            return None;
        };
        self.go_on(sample, |this, time| this.step(&mut Scribe { log, time }))
    }

    fn state_into(&self, into: &mut [BodyState]) {
        for (state, particle) in into.iter_mut().zip(&self.particles) {
            *state = BodyState {
                position: particle.position,
                velocity: particle.velocity,
            };
        }
    }

    fn set_state(&mut self, sample: usize, states: &[BodyState]) {
        self.sample = sample;
        for (particle, state) in self.particles.iter_mut().zip(states) {
            particle.position = state.position;
            particle.velocity = state.velocity;
        }
        self.scheme.forget();
    }

    fn work(&self) -> Work {
        self.work
    }

    fn limit(&mut self, budget: u64) {
        self.budget = budget;
        self.scheme.limit(budget);
    }

    fn keep_ledger(&mut self) -> bool {
        self.ledger = Some(Ledger::default());
        true
    }

    fn ledger(&self) -> Option<&Ledger> {
        self.ledger.as_ref()
    }

    fn concessions(&self) -> Vec<Concession> {
        self.scheme.concessions()
    }
}
