//! How a step deals with what its bodies meet.

use super::motion::Motion;
use super::observer::Observer;
use super::phases::Phases;
use super::{Particle, books};

/// What a step took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Taken {
    /// How often the forces were summed.
    pub(super) passes: u64,
    /// Pairs looked at for a contact.
    pub(super) pairs: u64,
    /// All else, in units of a look at a pair; where it is counted.
    pub(super) solving: u64,
}

/// A way to deal with rests, cushions and contacts.
pub(super) trait Handling {
    /// One step of length `dt`.
    fn step<O: Observer>(
        &mut self,
        motion: &mut impl Motion,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut O,
    ) -> Taken;
}

/// The lecture's: what overlaps at the end of a step is hit, and with `PUSH_OUT` pushed apart.
#[derive(Debug, Clone, Default)]
pub struct Overlap<const PUSH_OUT: bool>;

impl<const PUSH_OUT: bool> Handling for Overlap<PUSH_OUT> {
    #[inline]
    fn step<O: Observer>(
        &mut self,
        motion: &mut impl Motion,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut O,
    ) -> Taken {
        let before = books::kept::<O>(particles);
        let passes = motion.advance(phases, particles, dt);
        books::motion(phases, &before, particles, dt, observer);
        phases.settle::<PUSH_OUT, O>(particles, observer);
        if phases.contact.is_some() || phases.cushions.is_some() {
            motion.forget();
        }
        Taken {
            passes,
            pairs: u64::from(phases.contact.is_some()) * pairs(particles.len() as u64),
            solving: 0,
        }
    }
}

/// Pairs of so many bodies.
#[inline]
pub(super) fn pairs(bodies: u64) -> u64 {
    bodies * bodies.saturating_sub(1) / 2
}
