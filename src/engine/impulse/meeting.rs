//! When bodies that move along known ways meet.

use super::contacts::approach;
use super::path::Way;
use crate::physics::closing::{Opening, Search, first_closing};
use crate::physics::length;
use crate::recording::Wall;

/// A body on its way through a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Along<'a, W> {
    pub(super) path: &'a W,
    pub(super) radius: f64,
    /// A bound on how far it goes within the step.
    pub(super) travel: f64,
}

/// When two spheres first touch while they approach, up to a time; `instant` is a time too short
/// to matter.
pub(super) fn contact<W: Way>(pair: &[Along<W>; 2], until: f64, instant: f64) -> Option<f64> {
    let [one, other] = pair;
    let reach = one.radius + other.radius;
    let apart = other.path.start() - one.path.start();
    let room = reach + one.travel + other.travel;
    if apart.norm_squared() > room * room {
        return None;
    }
    let bend = one.path.bend_against(other.path);
    closing(until, instant, |t| {
        let ((xa, va), (xb, vb)) = (one.path.at(t), other.path.at(t));
        let distance = (xb - xa).norm();
        Opening {
            width: distance - reach,
            rate: approach(&(xa - xb), distance, &va, &vb),
            bend,
        }
    })
}

/// When a sphere first touches a wall while it moves into it.
pub(super) fn cushion<W: Way>(
    one: &Along<W>,
    wall: Wall,
    half: [f64; 3],
    until: f64,
    instant: f64,
) -> Option<f64> {
    let (axis, side) = wall.axis_and_side();
    let room = half[axis] - one.radius;
    if room - one.path.start()[axis] * side > one.travel {
        return None;
    }
    let bend = one.path.bend_along(axis);
    closing(until, instant, |t| {
        let (x, v) = one.path.at(t);
        Opening {
            width: room - x[axis] * side,
            rate: -v[axis] * side,
            bend,
        }
    })
}

/// The first time at which a gap closes, none if it does not up to the end.
fn closing(length: f64, instant: f64, at: impl Fn(f64) -> Opening<f64>) -> Option<f64> {
    let mut from = 0.0;
    // A search rests after two hundred steps, each of them safe; a second round is for grazes.
    for _ in 0..2 {
        match first_closing(length - from, instant, |t| at(from + t)) {
            Search::Closes(time) if from + time <= length => return Some(from + time),
            Search::OpenUntil(time) => {
                from += time;
                let now = at(from);
                // Places that are large beside the gap do not move in so short a time: the search
                // stands still where the gap is less than their rounding.
                if now.rate < 0.0 && now.width <= -now.rate * instant {
                    return Some(from);
                }
            }
            Search::Closes(_) | Search::Open => return None,
        }
    }
    None
}

/// When a moving body has become slower than that.
pub(super) fn slowed(path: &impl Way, speed: f64, until: f64) -> Option<f64> {
    let at = |t: f64| length(&path.at(t).1);
    if at(0.0) == 0.0 || at(until) >= speed {
        return None;
    }
    if at(0.0) < speed {
        return Some(0.0);
    }
    let (mut fast, mut slow) = (0.0, until);
    for _ in 0..60 {
        let middle = 0.5 * (fast + slow);
        if at(middle) < speed {
            slow = middle;
        } else {
            fast = middle;
        }
    }
    Some(slow)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bound on the bend so large that the search makes no way worth speaking of.
    fn standing(width: f64, rate: f64) -> Option<f64> {
        closing(1.0, 1e-14, |_| Opening {
            width,
            rate,
            bend: 1e40,
        })
    }

    /// Where a search stands still, what is left of the gap decides: less than the bodies go in a
    /// time too short to matter is none, unless they part or rest.
    #[test]
    fn a_search_that_stands_still_ends_at_gaps_of_no_size() {
        assert!(standing(1e-17, -1.0).is_some_and(|time| time < 1e-20));
        assert_eq!(standing(1e-3, -1.0), None);
        assert_eq!(standing(1e-17, 1.0), None);
        let at_rest = |_: f64| Opening {
            width: 0.0,
            rate: 0.0,
            bend: 1.0,
        };
        assert_eq!(closing(1.0, 1e-14, at_rest), None);
    }

    /// A second search goes on where the first rested: its time counts from there.
    #[test]
    fn a_search_that_rests_is_taken_up_once() {
        // Steps of (2 gap/bend)^(1/2): sqrt(2 bend), or 283, from 1 to 0.
        let at = |t: f64| Opening {
            width: 1.0 - t,
            rate: -1.0,
            bend: 4e4,
        };
        assert!(matches!(
            first_closing(2.0, 1e-14, at),
            Search::OpenUntil(_)
        ));
        let time = closing(2.0, 1e-14, at).unwrap();
        assert!((time - 1.0).abs() < 1e-15, "{time}");
        assert_eq!(closing(0.9, 1e-14, at), None);
    }
}
