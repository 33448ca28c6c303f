//! How bodies move through a step in which nothing is hit: the integrators of the ladder.

use super::phases::Phases;
use super::{Particle, forces};
use crate::physics::Vector3;

/// An integrator of the motion between impacts.
pub(super) trait Motion {
    /// Moves the particles on; returns how often the forces were summed.
    fn advance(&mut self, phases: &Phases, particles: &mut [Particle], dt: f64) -> u64;

    /// States were changed from outside.
    fn forget(&mut self) {}

    /// The scene's size and duration, and the step asked for.
    fn prepare(&mut self, _size: f64, _duration: f64, _longest: f64) {}

    /// How much of the time left the next step should take.
    fn length(&self, left: f64) -> f64 {
        left
    }

    /// Whether the step just taken was too long for its error and must be taken again.
    fn is_rejected(&self) -> bool {
        false
    }
}

/// Symplectic Euler, the lecture's: kick by all forces, then drift. Order 1.
///
/// With `DECAY` drag is no force but an exact decay in the drift.
#[derive(Debug, Clone, Default)]
pub struct Euler<const DECAY: bool> {
    decay: Decay,
}

impl<const DECAY: bool> Motion for Euler<DECAY> {
    #[inline]
    fn advance(&mut self, phases: &Phases, particles: &mut [Particle], dt: f64) -> u64 {
        if !DECAY && phases.act_alone() {
            for particle in particles {
                phases.sum_forces_alone(particle);
                forces::kick(particle, dt);
                forces::drift(particle, dt);
            }
            return 1;
        }
        if phases.forces {
            phases.sum_forces(particles);
            kick(particles, dt);
        }
        if DECAY {
            self.decay.drift(phases, particles, dt);
        } else {
            drift(particles, dt);
        }
        u64::from(phases.forces)
    }
}

/// The kick of every body.
#[inline]
fn kick(particles: &mut [Particle], dt: f64) {
    for particle in particles {
        forces::kick(particle, dt);
    }
}

/// The drift of every body.
#[inline]
fn drift(particles: &mut [Particle], dt: f64) {
    for particle in particles {
        forces::drift(particle, dt);
    }
}

/// Velocity Verlet: half a kick, drift with exact decay, half a kick. Order 2.
///
/// Each half kick with dampers is a midpoint step in the velocities, so that the order holds.
/// Forces of places alone are kept for the next step.
/// Source: Swope et al. 1982; Strang 1968 for the splitting.
#[derive(Debug, Clone, Default)]
pub struct Verlet {
    decay: Decay,
    before: Vec<Vector3>,
    /// Whether the particles' forces are those of their places.
    is_fresh: bool,
}

impl Verlet {
    fn kick(&mut self, phases: &Phases, particles: &mut [Particle], dt: f64) -> u64 {
        if !phases.damped {
            let stale = !self.is_fresh;
            if stale {
                phases.sum_forces(particles);
                self.is_fresh = true;
            }
            kick(particles, dt);
            return u64::from(stale);
        }
        self.before.clear();
        self.before.extend(particles.iter().map(|p| p.velocity));
        phases.sum_forces(particles);
        kick(particles, 0.5 * dt);
        phases.sum_forces(particles);
        for (particle, before) in particles.iter_mut().zip(&self.before) {
            particle.velocity = *before;
        }
        kick(particles, dt);
        2
    }
}

impl Motion for Verlet {
    #[inline]
    fn advance(&mut self, phases: &Phases, particles: &mut [Particle], dt: f64) -> u64 {
        let mut passes = 0;
        if phases.forces {
            passes += self.kick(phases, particles, 0.5 * dt);
        }
        self.decay.drift(phases, particles, dt);
        self.is_fresh = false;
        if phases.forces {
            passes += self.kick(phases, particles, 0.5 * dt);
        }
        passes
    }

    fn forget(&mut self) {
        self.is_fresh = false;
    }
}

/// The drift, with the exact flight under drag where it decays.
///
/// Equation: `x += v (1 - exp(-c dt))/c`, `v *= exp(-c dt)`, c = k/m. The exponentials are those
/// of the last step's length, computed anew only when that changes.
#[derive(Debug, Clone, Default)]
struct Decay {
    dt: f64,
    /// `exp(-c dt)` and `(1 - exp(-c dt))/c`. Shape: `[particle]`.
    factors: Vec<[f64; 2]>,
}

impl Decay {
    #[inline]
    fn drift(&mut self, phases: &Phases, particles: &mut [Particle], dt: f64) {
        let Some(drag) = phases.decay else {
            return drift(particles, dt);
        };
        if dt.to_bits() != self.dt.to_bits() || self.factors.len() != particles.len() {
            self.dt = dt;
            self.factors.clear();
            let factors = |particle: &Particle| {
                let rate = drag.coefficient / particle.mass;
                let lost = -(-rate * dt).exp_m1();
                let path = if rate > 0.0 { lost / rate } else { dt };
                [1.0 - lost, path]
            };
            self.factors.extend(particles.iter().map(factors));
        }
        for (particle, [left, path]) in particles.iter_mut().zip(&self.factors) {
            particle.position += particle.velocity * *path;
            particle.velocity *= *left;
        }
    }
}
