//! The step: phases in the slides' order, each there only if the scene calls for it.

use super::observer::{Nobody, Observer, Scribe};
use super::{Particle, contacts, cushions, forces, particles};
use crate::engine::{Phase, Simulation, StepGrid};
use crate::physics::{BodyState, SpringDamper, Vector3};
use crate::recording::{EventLog, Outcome, Work};
use crate::scene::{Attraction, Contact, Cushions, Drag, Rest, Scene};

/// The hand-written impulse solver on one scene.
///
/// Symplectic Euler for motion, impulses at the first overlap, push-out. Order 1 in the step.
/// Source: lecture, `doSimulation()` of "충돌" (collisions) and of "당구게임" (billiards game).
#[derive(Debug, Clone)]
pub struct ImpulseSimulation {
    particles: Vec<Particle>,
    phases: Phases,
    grid: StepGrid,
    sample: usize,
    steps: u64,
}

/// The phases that the scene calls for.
#[derive(Debug, Clone)]
struct Phases {
    attraction: Option<Attraction>,
    drag: Option<Drag>,
    springs: Vec<SpringDamper>,
    gravity: Option<Vector3>,
    rest: Option<Rest>,
    cushions: Option<Cushions>,
    contact: Option<Contact>,
    /// Whether any of the forces above acts: without one there is nothing to clear or to kick.
    forces: bool,
}

impl Phases {
    fn of(scene: &Scene) -> Self {
        let effects = &scene.effects;
        let springs = SpringDamper::all(scene);
        Self {
            forces: effects.attraction.is_some()
                || effects.drag.is_some()
                || !springs.is_empty()
                || effects.gravity.is_some(),
            attraction: effects.attraction,
            drag: effects.drag,
            springs,
            gravity: effects.gravity.map(|gravity| gravity.acceleration.into()),
            rest: effects.rest,
            cushions: effects.cushions,
            contact: effects.contact,
        }
    }

    /// One step.
    #[inline]
    fn step(&self, particles: &mut [Particle], dt: f64, observer: &mut impl Observer) {
        if self.forces {
            forces::clear(particles);
            if let Some(attraction) = self.attraction {
                forces::attract(particles, attraction);
            }
            if let Some(drag) = self.drag {
                forces::drag(particles, drag);
            }
            forces::springs(particles, &self.springs);
            if let Some(acceleration) = &self.gravity {
                forces::gravity(particles, acceleration);
            }
            forces::kick(particles, dt);
        }
        forces::drift(particles, dt);
        if let Some(rest) = self.rest {
            forces::rest(particles, rest, observer);
        }
        if let Some(cushions) = &self.cushions {
            cushions::bounce(particles, cushions, observer);
        }
        if let Some(contact) = self.contact {
            contacts::collide(particles, contact, observer);
        }
    }
}

impl ImpulseSimulation {
    /// Puts a checked scene at its start.
    #[must_use]
    pub fn new(scene: &Scene, grid: StepGrid) -> Self {
        let phases = Phases::of(scene);
        Self {
            particles: particles(scene),
            phases,
            grid,
            sample: 0,
            steps: 0,
        }
    }

    /// Takes that many steps unobserved, for a stopwatch that looks at the step alone.
    pub fn take_steps(&mut self, count: u64) {
        for _ in 0..count {
            self.phases
                .step(&mut self.particles, self.grid.step, &mut Nobody);
        }
        self.steps += count;
    }

    /// The phases of a step, in order.
    #[must_use]
    pub fn phases(&self) -> Vec<Phase> {
        let Phases {
            attraction,
            drag,
            springs,
            gravity,
            rest,
            cushions,
            contact,
            forces,
        } = &self.phases;
        let clear = forces.then(|| Phase::new("clear", "forces to zero"));
        let kick = forces.then(|| Phase::new("kick", "v += dt F/m"));
        let attraction = attraction.map(|_| Phase::new("attraction", "every pair i < j"));
        let drag = drag.map(|_| Phase::new("drag", "force -k v, explicit"));
        let springs = (!springs.is_empty()).then(|| {
            Phase::new(
                "springs",
                format!("{} spring-dampers, explicit", springs.len()),
            )
        });
        let gravity = gravity.map(|_| Phase::new("gravity", "force m g"));
        let drift = Some(Phase::new("drift", "x += dt v (symplectic Euler)"));
        let rest = rest.map(|_| Phase::new("rest", "slower than the rest speed: stop"));
        let cushions = cushions.map(|cushions| {
            let walls = if cushions.half_height.is_some() { 6 } else { 4 };
            let method =
                format!("{walls} walls, one a ball and step: mirror, push (1+e) x overlap");
            Phase::new("cushions", method)
        });
        let contacts = contact.map(|_| {
            Phase::new(
                "contacts",
                "every pair i < j: impulse if approaching, push (1+e)/2 x overlap each",
            )
        });
        [
            clear, attraction, drag, springs, gravity, kick, drift, rest, cushions, contacts,
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

impl Simulation for ImpulseSimulation {
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
                self.phases
                    .step(&mut self.particles, self.grid.step, &mut scribe);
            }
            self.steps += self.grid.steps_per_sample;
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
    }

    fn work(&self) -> Work {
        let bodies = self.particles.len() as u64;
        let pairs = bodies * bodies.saturating_sub(1) / 2;
        let phases = &self.phases;
        let per_body = u64::from(phases.drag.is_some()) + u64::from(phases.gravity.is_some());
        let forces = u64::from(phases.attraction.is_some()) * pairs
            + per_body * bodies
            + phases.springs.len() as u64;
        Work {
            steps: self.steps,
            pair_tests: self.steps * u64::from(phases.contact.is_some()) * pairs,
            force_evaluations: self.steps * forces,
        }
    }
}
