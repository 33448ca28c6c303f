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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_component_that_is_no_number_is_enough() {
        let with = |position: f64, velocity: f64| BodyState {
            position: Vector3::new(0.0, position, 0.0),
            velocity: Vector3::new(0.0, 0.0, velocity),
        };
        assert!(with(1.0, 1.0).is_finite());
        assert!(!with(f64::NAN, 1.0).is_finite());
        assert!(!with(1.0, f64::INFINITY).is_finite());
    }
}
