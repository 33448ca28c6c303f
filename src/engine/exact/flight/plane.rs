//! When a sphere reaches a plane across an axis: a wall, or the face of a cell.

use crate::physics::real::Real;

/// The motion along one axis towards a plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Approach<R> {
    /// Distance still to go; below 0 beyond the plane.
    pub gap: R,
    /// Speed towards the plane.
    pub speed: R,
    /// Constant acceleration towards the plane.
    pub pull: R,
}

/// Clock time until the plane is reached while moving towards it; none if never.
///
/// Equation: the first root of `gap - speed u - pull u²/2 = 0` at which the speed is still
/// towards the plane, by the form without a difference of near-equal numbers.
/// Valid for: any motion; one at or beyond the plane that moves on towards it is there at once.
#[inline]
pub(super) fn clock_to_plane<R: Real>(motion: &Approach<R>) -> Option<R> {
    let Approach { speed, pull, .. } = *motion;
    let gap = motion.gap.larger(R::zero());
    if pull.is_zero() {
        return (speed > R::zero()).then(|| gap / speed);
    }
    let square = speed * speed + (pull * gap).twice();
    if pull > R::zero() {
        return Some(if speed > R::zero() {
            gap.twice() / (speed + square.sqrt())
        } else {
            (square.sqrt() - speed) / pull
        });
    }
    let reaches = speed > R::zero() && square >= R::zero();
    reaches.then(|| gap.twice() / (speed + square.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(gap: f64, speed: f64, pull: f64) -> Option<f64> {
        clock_to_plane(&Approach { gap, speed, pull })
    }

    #[test]
    fn a_throw_against_gravity_comes_back() {
        assert_eq!(time(0.0, -3.0, 2.0), Some(3.0));
        let down = time(6.0, 2.0, 2.0).unwrap() - (7.0_f64.sqrt() - 1.0);
        assert!(down.abs() < 4e-16, "{down:e}");
        assert_eq!(time(6.0, 2.0, 0.0), Some(3.0));
    }

    #[test]
    fn a_throw_upwards_reaches_a_low_ceiling_and_misses_a_high_one() {
        assert_eq!(time(2.0, 3.0, -2.0), Some(1.0));
        assert_eq!(time(2.26, 3.0, -2.0), None);
        assert_eq!(time(2.0, -3.0, -2.0), None);
    }
}
