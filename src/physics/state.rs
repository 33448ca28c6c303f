//! The state of one body.

use super::Vector3;

/// Position and velocity of a body at one instant.
///
/// Units: scene length unit, and scene length unit per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    /// Position of the centre.
    pub position: Vector3,
    /// Velocity of the centre.
    pub velocity: Vector3,
}

impl BodyState {
    /// Whether every component is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        is_finite(&self.position) && is_finite(&self.velocity)
    }
}

/// Whether every component is a finite number.
#[must_use]
pub fn is_finite(vector: &Vector3) -> bool {
    vector.iter().all(|component| component.is_finite())
}
