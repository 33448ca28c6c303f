//! Forces between two bodies.

use super::{Vector3, length};

/// Attraction on body a towards body b; body b feels the opposite.
///
/// Equation: `G m_a m_b d / |d|³`, d from a to b; with a softening s,
/// `G m_a m_b d / (d² + s²)^(3/2)`.
/// Units: kg times scene length unit per second squared.
/// Valid for: any separation. Source: lecture, `computeAttraction()`: the magnitude
/// `G m_a m_b / (dist dist)` times the unit vector, in that order.
///
/// DEVIATES: where the centres coincide the slides divide 0 by 0; here the force is zero, the
/// mean over all directions.
#[must_use]
#[inline]
pub fn attraction(
    constant: f64,
    softening: f64,
    masses: [f64; 2],
    position_a: &Vector3,
    position_b: &Vector3,
) -> Vector3 {
    let toward_b = position_b - position_a;
    let distance = length(&toward_b);
    if distance == 0.0 {
        return Vector3::zeros();
    }
    if softening == 0.0 {
        let unit = toward_b / distance;
        return unit * (constant * masses[0] * masses[1] / (distance * distance));
    }
    let softened = (distance * distance + softening * softening).sqrt();
    toward_b * (constant * masses[0] * masses[1] / (softened * softened * softened))
}

/// Force of a spring-damper on body a; body b feels the opposite.
///
/// Equation: `k (l - l0) (x_b - x_a)/l + kd (v_b - v_a)`, the full relative velocity.
/// Units: kg times scene length unit per second squared.
/// Source: lecture, "스프링과 댐퍼" (springs and dampers), "최종 모델" (final model).
///
/// DEVIATES: a spring of no length (coincident ends) has no direction and the slides divide
/// 0 by 0; here its elastic part is zero and only the damper acts.
#[must_use]
#[inline]
pub fn spring_damper(
    stiffness: f64,
    rest_length: f64,
    damping: f64,
    position: [&Vector3; 2],
    velocity: [&Vector3; 2],
) -> Vector3 {
    let toward_b = position[1] - position[0];
    let l = length(&toward_b);
    let damper = (velocity[1] - velocity[0]) * damping;
    if l == 0.0 {
        return damper;
    }
    toward_b / l * (stiffness * (l - rest_length)) + damper
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attraction_is_inverse_square_and_points_to_the_other() {
        let [origin, far] = [Vector3::zeros(), Vector3::new(0.0, 4.0, 0.0)];
        let force = attraction(5.5, 0.0, [2.0, 3.0], &origin, &far);
        assert_eq!(force, Vector3::new(0.0, 5.5 * 6.0 / 16.0, 0.0));
    }

    #[test]
    fn softening_is_pythagorean() {
        let [origin, near] = [Vector3::zeros(), Vector3::new(3.0, 0.0, 0.0)];
        let force = attraction(1.0, 4.0, [1.0, 1.0], &origin, &near);
        assert_eq!(force, Vector3::new(3.0 / 125.0, 0.0, 0.0));
    }

    #[test]
    fn coincident_centres_pull_nowhere() {
        let here = Vector3::new(1.0, 2.0, 3.0);
        assert_eq!(
            attraction(5.5, 0.0, [2.0, 3.0], &here, &here),
            Vector3::zeros()
        );
        let still = Vector3::zeros();
        assert_eq!(
            spring_damper(9.0, 1.0, 0.5, [&here, &here], [&still, &still]),
            still
        );
    }

    #[test]
    fn the_damper_takes_the_full_relative_velocity() {
        let ends = [&Vector3::zeros(), &Vector3::new(2.0, 0.0, 0.0)];
        let sideways = [&Vector3::zeros(), &Vector3::new(0.0, 7.0, 0.0)];
        let force = spring_damper(10.0, 1.5, 0.5, ends, sideways);
        assert_eq!(force, Vector3::new(5.0, 3.5, 0.0));
    }
}
