//! Momentum, angular momentum and the centre of mass of many bodies. Shape: `[body]`.

use super::{BodyState, Vector3};

/// Equation: `p = sum m v`. Units: kg times scene length unit per second.
/// Source: lecture, "운동량 보존" (conservation of momentum).
#[must_use]
pub fn momentum(masses: &[f64], states: &[BodyState]) -> Vector3 {
    masses
        .iter()
        .zip(states)
        .map(|(m, s)| s.velocity * *m)
        .sum()
}

/// About the origin. Equation: `L = sum m x × v`. Units: kg times scene length unit squared per
/// second.
#[must_use]
pub fn angular_momentum(masses: &[f64], states: &[BodyState]) -> Vector3 {
    masses
        .iter()
        .zip(states)
        .map(|(m, s)| s.position.cross(&s.velocity) * *m)
        .sum()
}

/// Equation: `sum m x / sum m`. Units: scene length unit. Valid for at least one body.
#[must_use]
pub fn centre_of_mass(masses: &[f64], states: &[BodyState]) -> Vector3 {
    let total: f64 = masses.iter().sum();
    masses
        .iter()
        .zip(states)
        .map(|(m, s)| s.position * (*m / total))
        .sum()
}
