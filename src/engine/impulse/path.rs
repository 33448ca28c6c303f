//! The path of a body through a step, for finding what it meets on the way.

use super::Particle;
use crate::physics::Vector3;

/// Where a body is within a step, and bounds on how it bends.
pub(super) trait Way {
    /// Place at the start.
    fn start(&self) -> &Vector3;

    /// Place and velocity at a time since the start.
    fn at(&self, t: f64) -> (Vector3, Vector3);

    /// How much the velocity between two ways can change in a unit of time.
    fn bend_against(&self, other: &Self) -> f64;

    /// The same along one axis.
    fn bend_along(&self, axis: usize) -> f64;

    /// A bound on how far it goes in that time.
    fn travel(&self, time: f64) -> f64;
}

/// A cubic through the places and velocities at both ends of a step.
///
/// Equation: `x(t) = x0 + v0 t + a t²/2 + j t³/6` with `j = (6 dv h - 12 dx)/h³`,
/// `a = (6 dx - 2 dv h)/h²`, dx and dv being what the ends differ by from a straight line.
/// Its error is of order 4 in the step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Path {
    position: Vector3,
    velocity: Vector3,
    bend: Vector3,
    jerk: Vector3,
    length: f64,
}

impl Path {
    /// Between two states, `length` apart in time.
    pub(super) fn between(start: &Particle, end: &Particle, length: f64) -> Self {
        let dv = end.velocity - start.velocity;
        let dx = end.position - start.position - start.velocity * length;
        Self {
            position: start.position,
            velocity: start.velocity,
            bend: (dx * 6.0 - dv * (2.0 * length)) / (length * length),
            jerk: (dv * (6.0 * length) - dx * 12.0) / (length * length * length),
            length,
        }
    }

    /// A straight line.
    pub(super) fn straight(start: &Particle, length: f64) -> Self {
        Self {
            position: start.position,
            velocity: start.velocity,
            bend: Vector3::zeros(),
            jerk: Vector3::zeros(),
            length,
        }
    }

    /// Acceleration, linear in time, at both ends.
    fn accelerations(&self) -> [Vector3; 2] {
        [self.bend, self.bend + self.jerk * self.length]
    }
}

impl Way for Path {
    fn start(&self) -> &Vector3 {
        &self.position
    }

    fn at(&self, t: f64) -> (Vector3, Vector3) {
        let bent = self.bend + self.jerk * (t / 3.0);
        let position = self.position + (self.velocity + bent * (0.5 * t)) * t;
        let velocity = self.velocity + (self.bend + self.jerk * (0.5 * t)) * t;
        (position, velocity)
    }

    fn bend_against(&self, other: &Self) -> f64 {
        let (own, others) = (self.accelerations(), other.accelerations());
        (own[0] - others[0]).norm().max((own[1] - others[1]).norm())
    }

    fn bend_along(&self, axis: usize) -> f64 {
        let [start, end] = self.accelerations();
        start[axis].abs().max(end[axis].abs())
    }

    fn travel(&self, time: f64) -> f64 {
        let [start, end] = self.accelerations();
        let bend = start.norm().max(end.norm());
        (self.velocity.norm() + 0.5 * bend * time) * time
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn particle(position: f64, velocity: f64) -> Particle {
        Particle {
            position: Vector3::new(position, 0.0, 0.0),
            velocity: Vector3::new(velocity, 0.0, 0.0),
            force: Vector3::zeros(),
            mass: 1.0,
            radius: 1.0,
        }
    }

    /// x = 1 + 2 t - 3 t²/2 + 4 t³/6 over h = 2.
    #[test]
    fn a_cubic_is_met_exactly() {
        let x = |t: f64| 1.0 + 2.0 * t - 1.5 * t * t + 4.0 * t * t * t / 6.0;
        let v = |t: f64| 2.0 - 3.0 * t + 2.0 * t * t;
        let path = Path::between(&particle(x(0.0), v(0.0)), &particle(x(2.0), v(2.0)), 2.0);
        for t in [0.0, 0.5, 1.3, 2.0] {
            let (position, velocity) = path.at(t);
            assert!((position.x - x(t)).abs() < 1e-14 && (velocity.x - v(t)).abs() < 1e-14);
        }
        assert!((path.bend_along(0) - 5.0).abs() < 1e-13, "from -3 to 5");
        assert!(path.travel(2.0) >= 4.0);
    }
}
