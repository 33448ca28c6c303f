//! The simulation: one scheme on one scene, step by step.

use super::handling::{Handling, Overlap};
use super::motion::{Euler, Motion};
use super::observer::{Nobody, Observer, Scribe};
use super::phases::Phases;
use super::{Particle, particles};
use crate::engine::spec::DragRule;
use crate::engine::{Simulation, StepGrid};
use crate::physics::BodyState;
use crate::recording::{EventLog, Outcome, Work};
use crate::scene::Scene;

/// The hand-written impulse solver on one scene; without parameters, the lecture's.
///
/// Symplectic Euler for motion, impulses at the first overlap, push-out. Order 1 in the step.
/// Another integrator `M` or another way `H` to deal with impacts makes another rung of the
/// ladder; the phases are the same.
/// Source: lecture, `doSimulation()` of "충돌" (collisions) and of "당구게임" (billiards game).
#[derive(Debug, Clone)]
pub struct ImpulseSimulation<M = Euler<false>, H = Overlap<true>> {
    particles: Vec<Particle>,
    phases: Phases,
    motion: M,
    handling: H,
    grid: StepGrid,
    sample: usize,
    work: Work,
}

impl ImpulseSimulation {
    /// Puts a checked scene at its start.
    #[must_use]
    pub fn new(scene: &Scene, grid: StepGrid) -> Self {
        Self::with(scene, grid, DragRule::Force)
    }
}

#[allow(private_bounds, reason = "the rungs are made here alone")]
impl<M: Motion + Default, H: Handling + Default> ImpulseSimulation<M, H> {
    pub(super) fn with(scene: &Scene, grid: StepGrid, drag: DragRule) -> Self {
        let particles = particles(scene);
        let mut motion = M::default();
        motion.prepare(size(&particles), scene.duration, grid.step);
        Self {
            particles,
            phases: Phases::of(scene, drag),
            motion,
            handling: H::default(),
            grid,
            sample: 0,
            work: Work::default(),
        }
    }

    /// Takes that many steps unobserved, for a stopwatch that looks at the step alone.
    pub fn take_steps(&mut self, count: u64) {
        for _ in 0..count {
            self.step(&mut Nobody);
        }
    }

    #[inline]
    fn step(&mut self, observer: &mut impl Observer) {
        let (phases, particles) = (&self.phases, &mut self.particles);
        let dt = self.grid.step;
        let taken = self
            .handling
            .step(&mut self.motion, phases, particles, dt, observer);
        self.work.steps += 1;
        self.work.pair_tests += taken.pairs;
        self.work.force_evaluations += taken.passes * phases.forces_a_pass(particles.len() as u64);
    }
}

#[allow(private_bounds, reason = "the rungs are made here alone")]
impl<M: Motion + Default, H: Handling + Default> Simulation for ImpulseSimulation<M, H> {
    fn advance_to(&mut self, sample: usize, log: Option<&mut EventLog>) -> Option<Outcome> {
        let Some(log) = log else {
            let intervals = sample.saturating_sub(self.sample) as u64;
            self.take_steps(intervals * self.grid.steps_per_sample);
            self.sample = self.sample.max(sample);
            return None;
        };
        while self.sample < sample {
            self.sample += 1;
            for step in 1..=self.grid.steps_per_sample {
                let mut scribe = Scribe {
                    log,
                    time: self.grid.time(self.sample, step),
                };
                self.step(&mut scribe);
            }
        }
        None
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
        self.motion.forget();
    }

    fn work(&self) -> Work {
        self.work
    }
}

/// A length of the size of the scene: that of the largest body, or of the box of all of them.
fn size(particles: &[Particle]) -> f64 {
    let largest = particles.iter().fold(0.0_f64, |most, p| most.max(p.radius));
    let first = particles.first().map(|p| (p.position, p.position));
    let boxed = particles.iter().fold(first, |corners, p| {
        corners.map(|(low, high)| (low.inf(&p.position), high.sup(&p.position)))
    });
    largest.max(boxed.map_or(0.0, |(low, high)| (high - low).norm()))
}
