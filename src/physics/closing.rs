//! When a gap closes that has no closed form: a search from one side that cannot skip a root.

use crate::physics::real::Real;

/// A gap at one instant, and how it may change from there on.
#[derive(Debug, Clone, Copy)]
pub struct Opening<R> {
    /// Distance still to go; touching at 0.
    pub width: R,
    /// Rate at which it changes; negative on approach.
    pub rate: R,
    /// Bound on how fast that rate can fall from here on: `gap'' >= -bend`.
    pub bend: R,
}

/// What a search came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Search<R> {
    /// The gap closes after this time.
    Closes(R),
    /// It stays open at least for this time; ask again then.
    OpenUntil(R),
    /// It stays open for the whole time asked for.
    Open,
}

/// Steps after which a search rests; each is safe, so nothing is lost by asking again later.
const STEPS_MAX: u32 = 200;

/// The first time at which a gap closes while it shrinks, no later than `until`.
///
/// Method: from a time at which the gap is open, `gap(t + h) >= gap + rate h - bend h²/2`, so
/// that no root lies before `h = 2 gap/((rate² + 2 bend gap)^(1/2) - rate)`: a Newton step
/// that stays on the near side. Newton's own step then settles the last digits.
/// Valid for: a bound that holds from each instant on. Source: conservative advancement,
/// Mirtich 1996, with the second derivative in place of the first.
/// `shortest` is a time too short to matter, above 0.
pub fn first_closing<R: Real>(until: R, shortest: R, at: impl Fn(R) -> Opening<R>) -> Search<R> {
    let mut time = R::zero();
    for _ in 0..STEPS_MAX {
        let now = at(time);
        let gap = now.width.larger(R::zero());
        let safe = (now.rate * now.rate + (now.bend * gap).twice()).sqrt() - now.rate;
        if safe <= R::zero() && now.bend.is_zero() {
            return Search::Open;
        }
        // Where it opens, the plain form would divide a small gap by a small difference.
        let step = if now.rate > R::zero() && now.bend > R::zero() {
            ((now.rate * now.rate + (now.bend * gap).twice()).sqrt() + now.rate) / now.bend
        } else {
            gap.twice() / safe
        };
        let arrived = step <= R::from_f64(4.0 * R::EPSILON) * time;
        if now.rate < R::zero() && (gap.is_zero() || arrived) {
            return Search::Closes(polished(time, until, &at));
        }
        // Touching without approach, but bent: look again after the shortest time there is.
        time += if step > R::zero() { step } else { shortest };
        if time > until {
            return Search::Open;
        }
    }
    Search::OpenUntil(time)
}

/// Newton's steps to the last digit, while they get smaller.
fn polished<R: Real>(start: R, until: R, at: &impl Fn(R) -> Opening<R>) -> R {
    let (mut time, mut last) = (start, until);
    for _ in 0..4 {
        let now = at(time);
        if now.rate >= R::zero() {
            break;
        }
        let step = -now.width / now.rate;
        if step.abs() >= last {
            break;
        }
        last = step.abs();
        time = (time + step).larger(R::zero());
    }
    time
}

#[cfg(test)]
mod tests {
    use super::*;

    fn throw(until: f64, speed: f64, pull: f64, bend: f64) -> Search<f64> {
        first_closing(until, 1e-14, |t: f64| Opening {
            width: 2.0 - speed * t - pull * t * t / 2.0,
            rate: -speed - pull * t,
            bend,
        })
    }

    #[test]
    fn a_parabola_is_found_with_a_bound_that_is_too_large() {
        let Search::Closes(time) = throw(10.0, 3.0, -2.0, 40.0) else {
            panic!("not found");
        };
        assert!((time - 1.0).abs() < 1e-15, "{time}");
        // Turns round a hair before the plane: 2.828² < 8.
        assert_eq!(throw(10.0, 2.828, -2.0, 40.0), Search::Open);
    }

    #[test]
    fn what_never_closes_is_open() {
        assert_eq!(throw(10.0, -1.0, 0.0, 0.0), Search::Open);
        assert_eq!(throw(10.0, 0.1, 0.0, 0.0), Search::Open);
    }

    /// Two surfaces that touch and part do not close, also where they have no speed yet.
    #[test]
    fn what_touches_and_bends_away_stays_open() {
        let at = |t: f64| Opening {
            width: t * t,
            rate: 2.0 * t,
            bend: 1.0,
        };
        assert_eq!(first_closing(1.0, 1e-14, at), Search::Open);
    }

    /// A search that would take more steps than it has says how far it came.
    #[test]
    fn a_search_that_rests_says_how_far_the_gap_is_open() {
        let slow = |_: f64| Opening {
            width: 1.0,
            rate: -1.0,
            bend: 1e8,
        };
        // 2/(sqrt(1 + 2e8) + 1), two hundred times.
        let step = 2.0 / ((1.0 + 2e8_f64).sqrt() + 1.0);
        let Search::OpenUntil(time) = first_closing(1.0, 1e-14, slow) else {
            panic!("not at rest");
        };
        // Two hundred roundings of sums up to 200 steps: 1e-11.
        assert!((time / step - 200.0).abs() < 1e-11, "{time}");
    }

    /// From a thousandth away four steps of Newton's arrive at the last digit; where the gap
    /// opens, or a step would not be shorter than the one before, none is made.
    #[test]
    fn newtons_steps_settle_the_last_digits() {
        let at = |t: f64| Opening {
            width: 2.0 - 3.0 * t + t * t,
            rate: 2.0 * t - 3.0,
            bend: 2.0,
        };
        for start in [0.999, 1.001] {
            let time = polished(start, 10.0, &at);
            assert!((time - 1.0).abs() <= f64::EPSILON, "{time}");
        }
        assert_eq!(polished(1.6, 10.0, &at), 1.6);
        assert_eq!(polished(0.5, 0.1, &at), 0.5);
    }
}
