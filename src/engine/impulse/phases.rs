//! What a scene calls for: forces, and what happens at the end of a step. An absent effect is a
//! phase that is not there.

use super::observer::Observer;
use super::{Particle, books, contacts, cushions, forces};
use crate::engine::spec::DragRule;
use crate::physics::{SpringDamper, Vector3};
use crate::scene::{Attraction, Contact, Cushions, Drag, Rest, Scene};

/// The phases that the scene calls for.
#[derive(Debug, Clone)]
pub(super) struct Phases {
    pub(super) attraction: Option<Attraction>,
    /// Drag as a force.
    pub(super) drag: Option<Drag>,
    /// Drag as an exact decay of the velocity, in the drift.
    pub(super) decay: Option<Drag>,
    pub(super) springs: Vec<SpringDamper>,
    pub(super) gravity: Option<Vector3>,
    pub(super) rest: Option<Rest>,
    pub(super) cushions: Option<Cushions>,
    pub(super) contact: Option<Contact>,
    /// Whether any of the forces acts: without one there is nothing to clear or to kick.
    pub(super) forces: bool,
    /// Whether a force depends on velocities.
    pub(super) damped: bool,
    /// Whether paths are other than straight: an effect is there and is not neutral.
    pub(super) bends: bool,
}

impl Phases {
    pub(super) fn of(scene: &Scene, rule: DragRule) -> Self {
        let effects = &scene.effects;
        let springs = SpringDamper::all(scene);
        let (drag, decay) = match rule {
            DragRule::Force => (effects.drag, None),
            DragRule::Exponential => (None, effects.drag),
        };
        let damped_spring = effects.springs.iter().any(|spring| spring.damping != 0.0);
        Self {
            forces: effects.attraction.is_some()
                || drag.is_some()
                || !springs.is_empty()
                || effects.gravity.is_some(),
            damped: drag.is_some() || damped_spring,
            bends: effects.attraction.is_some_and(|it| it.constant != 0.0)
                || effects.drag.is_some_and(|it| it.coefficient != 0.0)
                || effects
                    .gravity
                    .is_some_and(|it| it.acceleration != [0.0; 3])
                || effects
                    .springs
                    .iter()
                    .any(|it| it.stiffness != 0.0 || it.damping != 0.0),
            attraction: effects.attraction,
            drag,
            decay,
            springs,
            gravity: effects.gravity.map(|gravity| gravity.acceleration.into()),
            rest: effects.rest,
            cushions: effects.cushions,
            contact: effects.contact,
        }
    }

    /// Sums the forces on every particle.
    #[inline]
    pub(super) fn sum_forces(&self, particles: &mut [Particle]) {
        particles.iter_mut().for_each(forces::clear);
        if let Some(attraction) = self.attraction {
            forces::attract(particles, attraction);
        }
        if let Some(drag) = self.drag {
            for particle in &mut *particles {
                forces::drag(particle, drag);
            }
        }
        forces::springs(particles, &self.springs);
        if let Some(acceleration) = &self.gravity {
            for particle in particles {
                forces::gravity(particle, acceleration);
            }
        }
    }

    /// Whether forces act and none joins bodies: each depends on its own body alone.
    #[inline]
    pub(super) fn act_alone(&self) -> bool {
        self.forces && self.attraction.is_none() && self.springs.is_empty()
    }

    /// Sums the forces on one particle where every force acts on its body alone: the bits of
    /// [`sum_forces`](Self::sum_forces), for an integrator that takes body after body through
    /// its phases, in one pass over memory.
    #[inline]
    pub(super) fn sum_forces_alone(&self, particle: &mut Particle) {
        forces::clear(particle);
        if let Some(drag) = self.drag {
            forces::drag(particle, drag);
        }
        if let Some(acceleration) = &self.gravity {
            forces::gravity(particle, acceleration);
        }
    }

    /// Rests, cushions and contacts as they are found at the end of a step.
    #[inline]
    pub(super) fn settle<const PUSH_OUT: bool, O: Observer>(
        &self,
        particles: &mut [Particle],
        observer: &mut O,
    ) {
        if let Some(rest) = self.rest {
            forces::rest(particles, rest, observer);
        }
        books::pushing_out(self, particles, observer, |particles, observer| {
            if let Some(cushions) = &self.cushions {
                cushions::bounce::<PUSH_OUT, O>(particles, cushions, observer);
            }
            if let Some(contact) = self.contact {
                contacts::collide::<PUSH_OUT, O>(particles, contact, observer);
            }
        });
    }

    /// Forces of one pass: pairs, bodies and springs.
    pub(super) fn forces_a_pass(&self, bodies: u64) -> u64 {
        let pairs = bodies * bodies.saturating_sub(1) / 2;
        let per_body = u64::from(self.drag.is_some()) + u64::from(self.gravity.is_some());
        u64::from(self.attraction.is_some()) * pairs + per_body * bodies + self.springs.len() as u64
    }
}
