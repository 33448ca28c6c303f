//! A spring-damper with its ends as body indices.

use super::{Vector3, spring_damper, spring_energy};
use crate::scene::Scene;

/// A spring-damper of a checked scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringDamper {
    /// Indices of bodies a and b.
    pub ends: [usize; 2],
    /// k, kg/s².
    pub stiffness: f64,
    /// l0, scene length unit.
    pub rest_length: f64,
    /// kd, kg/s.
    pub damping: f64,
}

impl SpringDamper {
    /// Every spring of a checked scene, in the scene's order.
    #[must_use]
    pub fn all(scene: &Scene) -> Vec<Self> {
        let springs = scene.effects.springs.iter().zip(scene.spring_ends());
        let placed = springs.map(|(spring, ends)| Self {
            ends,
            stiffness: spring.stiffness,
            rest_length: spring.rest_length,
            damping: spring.damping,
        });
        placed.collect()
    }

    /// Force on body a, see [`spring_damper`]; body b feels the opposite.
    #[must_use]
    #[inline]
    pub fn force(&self, position: [&Vector3; 2], velocity: [&Vector3; 2]) -> Vector3 {
        spring_damper(
            self.stiffness,
            self.rest_length,
            self.damping,
            position,
            velocity,
        )
    }

    /// Elastic energy, see [`spring_energy`].
    #[must_use]
    pub fn energy(&self, position: [&Vector3; 2]) -> f64 {
        spring_energy(self.stiffness, self.rest_length, position)
    }
}
