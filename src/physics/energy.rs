//! Energies. Units: kg times scene length unit squared per second squared.

use super::{Vector3, length};

/// Kinetic energy of a body that does not turn.
///
/// Equation: `m v² / 2`.
/// Units: kg times scene length unit squared per second squared; mass in kg, velocity in scene
/// length units per second.
/// Valid for: any velocity; components beyond about 1e154 overflow when squared.
/// Source: lecture, "운동 에너지의 보존" (conservation of kinetic energy), "선형 운동 에너지"
/// (linear kinetic energy).
#[must_use]
pub fn kinetic_energy(mass: f64, velocity: &Vector3) -> f64 {
    0.5 * mass * velocity.dot(velocity)
}

/// Potential energy of a pair that attracts, zero at infinite distance.
///
/// Equation: `-G m_a m_b / (d² + s²)^(1/2)`; minus its gradient is the force of
/// [`attraction`](super::attraction).
/// Units: kg times scene length unit squared per second squared; `constant` in length³/(kg s²),
/// masses in kg, `softening` and `distance` in scene length units.
/// Valid for: `d + s > 0`; at 0 it is taken as zero, as the force is.
/// Source: the integral of the force of the lecture's "충돌" (collisions),
/// `computeAttraction()`; the lecture itself has no potential energy.
#[must_use]
pub fn attraction_energy(constant: f64, softening: f64, masses: [f64; 2], distance: f64) -> f64 {
    let reach = (distance * distance + softening * softening).sqrt();
    if reach == 0.0 {
        return 0.0;
    }
    -constant * masses[0] * masses[1] / reach
}

/// Elastic energy of a spring between two positions.
///
/// Equation: `k (l - l0)² / 2`, l the distance of the ends; minus its gradient is the elastic part
/// of the force of [`spring_damper`](super::spring_damper).
/// Units: kg times scene length unit squared per second squared; `stiffness` in kg/s²,
/// `rest_length` and positions in scene length units.
/// Valid for: any ends, coincident ones included; the damper stores nothing.
/// Source: the integral of the force of the lecture's "스프링과 댐퍼" (springs and dampers),
/// "최종 모델" (final model); the lecture itself has no potential energy.
#[must_use]
pub fn spring_energy(stiffness: f64, rest_length: f64, ends: [&Vector3; 2]) -> f64 {
    let stretch = length(&(ends[1] - ends[0])) - rest_length;
    0.5 * stiffness * stretch * stretch
}

/// Potential energy in uniform gravity, zero at the origin.
///
/// Equation: `-m g . x`; minus its gradient is the weight `m g`.
/// Units: kg times scene length unit squared per second squared; mass in kg, `acceleration` in
/// scene length units per second squared, position in scene length units.
/// Valid for: any position.
/// Source: carom's own, as uniform gravity is: the slides' particle has a field for it and never
/// uses it.
#[must_use]
pub fn gravity_energy(mass: f64, acceleration: &Vector3, position: &Vector3) -> f64 {
    -mass * acceleration.dot(position)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::attraction;

    /// The force must be the negative gradient of the energy, softened or not.
    ///
    /// Central difference with h = 1e-5: error h² f''/6, about 1e-10 here, and rounding 1e-11.
    #[test]
    fn attraction_is_the_gradient_of_its_energy() {
        for softening in [0.0, 0.7] {
            let energy = |d: f64| attraction_energy(5.5, softening, [2.0, 3.0], d);
            let (d, h) = (1.3, 1e-5);
            let slope = (energy(d + h) - energy(d - h)) / (2.0 * h);
            let other = Vector3::new(d, 0.0, 0.0);
            let force = attraction(5.5, softening, [2.0, 3.0], &Vector3::zeros(), &other);
            assert!(
                (force.x - slope).abs() < 1e-8,
                "{} against {slope}",
                force.x
            );
        }
    }
}
