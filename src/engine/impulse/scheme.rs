//! How a step is made: what the rungs of the ladder differ in.

use super::Particle;
use super::handling::{Handling, Overlap, Taken};
use super::motion::{Euler, Motion};
use super::observer::Observer;
use super::phases::Phases;
use crate::recording::Concession;
use crate::scene::Scene;

/// A way to make a step of a scene's phases.
pub(super) trait Scheme {
    /// For these particles of a scene at its start, with its phases and steps of that length.
    fn of(scene: &Scene, phases: &Phases, particles: &[Particle], step: f64) -> Self;

    /// One step of length `dt`.
    fn step(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut impl Observer,
    ) -> Taken;

    /// States were changed from outside.
    fn forget(&mut self);

    /// Bounds the counted work, where a step can take much: a step that goes past it ends early.
    fn limit(&mut self, _budget: u64) {}

    /// What was given up so far to go on.
    fn concessions(&self) -> Vec<Concession> {
        Vec::new()
    }
}

/// An integrator `M`, and a way `H` to deal with what it meets.
#[derive(Debug, Clone, Default)]
pub struct Stepped<M, H> {
    motion: M,
    handling: H,
}

/// The lecture's: kick, drift, push out.
pub type Lecture = Stepped<Euler<false>, Overlap<true>>;

impl<M: Motion + Default, H: Handling + Default> Scheme for Stepped<M, H> {
    fn of(scene: &Scene, _phases: &Phases, particles: &[Particle], step: f64) -> Self {
        let mut this = Self::default();
        this.motion.prepare(size(particles), scene.duration, step);
        this
    }

    #[inline]
    fn step(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut impl Observer,
    ) -> Taken {
        self.handling
            .step(&mut self.motion, phases, particles, dt, observer)
    }

    fn forget(&mut self) {
        self.motion.forget();
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
