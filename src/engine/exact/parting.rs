//! How far computations of one scene part.

use crate::physics::{BodyState, Vector3};

/// The true error may be larger than what computations that err show by how far they part; by
/// how much a claim allows for.
pub(super) const SAFETY: f64 = 10.0;

/// The largest distance of two computations so far, over all bodies.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Parting {
    /// Of positions, scene length unit.
    pub position: f64,
    /// Of velocities, scene length unit per second.
    pub velocity: f64,
}

impl Parting {
    /// Nothing is known any more.
    pub fn unknown() -> Self {
        Self {
            position: f64::INFINITY,
            velocity: f64::INFINITY,
        }
    }

    /// With further differences, each of a body's position and velocity.
    pub fn with(mut self, differences: impl Iterator<Item = [Vector3; 2]>) -> Self {
        for [position, velocity] in differences {
            self.position = larger(self.position, position.norm());
            self.velocity = larger(self.velocity, velocity.norm());
        }
        self
    }

    /// With the next sample of both. Shape: `[body]`.
    pub fn with_states(self, states: &[BodyState], others: &[BodyState]) -> Self {
        let difference =
            |(a, b): (&BodyState, &BodyState)| [a.position - b.position, a.velocity - b.velocity];
        self.with(states.iter().zip(others).map(difference))
    }

    /// What both allow for together.
    pub fn plus(self, other: Self) -> Self {
        Self {
            position: self.position + other.position,
            velocity: self.velocity + other.velocity,
        }
    }

    /// So many times as far apart.
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            position: self.position * factor,
            velocity: self.velocity * factor,
        }
    }
}

/// The larger; infinite where one is not a number.
fn larger(one: f64, other: f64) -> f64 {
    if other.is_nan() {
        return f64::INFINITY;
    }
    one.max(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_is_not_near() {
        let apart = |x: f64| [Vector3::new(x, 0.0, 0.0), Vector3::new(0.0, 2.0 * x, 0.0)];
        let near = Parting::default().with([apart(3.0), apart(-1.0)].into_iter());
        assert_eq!([near.position, near.velocity], [3.0, 6.0]);
        let lost = near.with([apart(f64::NAN), apart(1.0)].into_iter());
        assert_eq!([lost.position, lost.velocity], [f64::INFINITY; 2]);
    }
}
