//! How a sphere flies between two events, in closed form.

use nalgebra::Vector3;

use crate::physics::real::{Real, vector};
use crate::scene::Scene;

/// What stays the same of a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fixed<R> {
    /// Mass, kg.
    pub mass: R,
    /// Radius, scene length unit.
    pub radius: R,
    /// Drag rate c = k/m, 1/s.
    pub rate: R,
}

/// Position and velocity at one instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct State<R: Real> {
    /// Position of the centre.
    pub position: Vector3<R>,
    /// Velocity of the centre.
    pub velocity: Vector3<R>,
}

/// The equation of flight of all bodies of a scene, `dv/dt = g - c v`.
///
/// Equation: with `u(t) = (1 - exp(-c t))/c` and `w(t) = (t - u(t))/c`,
/// `x = x0 + v0 u + g w` and `v = v0 exp(-c t) + g u`; without drag u = t and w = t²/2.
/// The masses, and so the rates c, may differ from body to body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Law<R: Real> {
    /// No force: straight lines in t.
    Straight,
    /// Drag at one rate for all: straight lines in the clock u.
    Drag {
        /// c of every body, 1/s.
        rate: R,
    },
    /// Uniform gravity: parabolas, and straight lines as seen from another body.
    Gravity {
        /// g, scene length unit per second squared.
        acceleration: Vector3<R>,
    },
    /// Drag at a rate of its own for each body, or gravity and drag together: no common clock.
    Mixed {
        /// g, scene length unit per second squared.
        acceleration: Vector3<R>,
    },
}

impl<R: Real> Law<R> {
    /// The simplest law that holds for a scene.
    pub fn of(scene: &Scene, fixed: &[Fixed<R>]) -> Self {
        let acceleration = scene
            .effects
            .gravity
            .map_or([0.0; 3], |gravity| gravity.acceleration);
        let falls = acceleration.iter().any(|a| a.abs() > 0.0);
        let rate = fixed.first().map_or(R::zero(), |body| body.rate);
        let shared = fixed.iter().all(|body| body.rate == rate);
        match (shared, rate > R::zero(), falls) {
            (true, false, false) => Self::Straight,
            (true, true, false) => Self::Drag { rate },
            (true, false, true) => Self::Gravity {
                acceleration: vector(acceleration),
            },
            (true, true, true) | (false, _, _) => Self::Mixed {
                acceleration: vector(acceleration),
            },
        }
    }

    /// The same flight without the knowledge of a shortcut: every event is then searched for.
    pub fn without_shortcut(self) -> Self {
        match self {
            Self::Straight | Self::Drag { .. } => Self::Mixed {
                acceleration: Vector3::zeros(),
            },
            Self::Gravity { acceleration } | Self::Mixed { acceleration } => {
                Self::Mixed { acceleration }
            }
        }
    }

    /// The law in doubles.
    pub fn roughly(&self) -> Law<f64> {
        match self {
            Self::Straight => Law::Straight,
            Self::Drag { rate } => Law::Drag {
                rate: rate.to_f64(),
            },
            Self::Gravity { acceleration } => Law::Gravity {
                acceleration: acceleration.map(Real::to_f64),
            },
            Self::Mixed { acceleration } => Law::Mixed {
                acceleration: acceleration.map(Real::to_f64),
            },
        }
    }

    /// Whether impacts of pairs are searched for, having no closed form.
    pub fn is_searched(&self) -> bool {
        matches!(self, Self::Mixed { .. })
    }

    /// The state so much time later; earlier where it is negative.
    #[inline]
    pub fn after(&self, state: &State<R>, rate: R, time: R) -> State<R> {
        let State { position, velocity } = state;
        match self {
            Self::Straight => State {
                position: position + velocity * time,
                velocity: *velocity,
            },
            Self::Drag { rate } => {
                if velocity.x.is_zero() && velocity.y.is_zero() && velocity.z.is_zero() {
                    return *state;
                }
                after_drag(state, *rate, time)
            }
            Self::Gravity { acceleration } => State {
                position: position + (velocity + acceleration * time.half()) * time,
                velocity: velocity + acceleration * time,
            },
            Self::Mixed { acceleration } => after_mixed(state, acceleration, rate, time),
        }
    }

    /// Time in which the clock of the law goes on by `u`; none if it never does.
    ///
    /// Equation: `t = -ln(1 - c u)/c` under drag, else t = u.
    #[inline]
    pub fn time_of_clock(&self, u: R) -> Option<R> {
        match self {
            Self::Straight | Self::Gravity { .. } | Self::Mixed { .. } => Some(u),
            Self::Drag { rate } => {
                let spent = *rate * u;
                (spent < R::one()).then(|| -(-spent).ln_1p() / *rate)
            }
        }
    }
}

/// The state so much time later under drag alone.
fn after_drag<R: Real>(state: &State<R>, rate: R, time: R) -> State<R> {
    let (u, decay) = drag_clock(rate, time);
    State {
        position: state.position + state.velocity * u,
        velocity: state.velocity * decay,
    }
}

/// The state so much time later under both forces.
fn after_mixed<R: Real>(state: &State<R>, acceleration: &Vector3<R>, rate: R, time: R) -> State<R> {
    let (u, decay) = if rate.is_zero() {
        (time, R::one())
    } else {
        drag_clock(rate, time)
    };
    let w = drag_fall(rate, time);
    State {
        position: state.position + state.velocity * u + acceleration * w,
        velocity: state.velocity * decay + acceleration * u,
    }
}

/// `u = (1 - exp(-c t))/c` and `exp(-c t)`, both to full relative accuracy, with one call.
///
/// Valid for: c above 0.
#[inline]
fn drag_clock<R: Real>(rate: R, time: R) -> (R, R) {
    let z = rate * time;
    if z < R::from_f64(0.5) {
        let lost = (-z).exp_m1();
        (-lost / rate, R::one() + lost)
    } else {
        let decay = (-z).exp();
        ((R::one() - decay) / rate, decay)
    }
}

/// `w = (t - u)/c = t² (z - 1 + exp(-z))/z²` with z = c t: how far unit gravity pulls.
///
/// By its series for small z, where the difference would lose digits; t²/2 without drag.
fn drag_fall<R: Real>(rate: R, time: R) -> R {
    let z = rate * time;
    if z.abs() > R::one() {
        let (u, _) = drag_clock(rate, time);
        return (time - u) / rate;
    }
    // 1/2 - z/6 + z²/24 - ..., the next term always smaller by a third at least.
    let (mut term, mut sum, mut place) = (R::one().half(), R::zero(), 2.0);
    while term.abs() > R::from_f64(R::EPSILON * 1e-3) {
        sum += term;
        place += 1.0;
        term *= -z / R::from_f64(place);
    }
    time * time * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::exact::wide::Wide;

    /// The wide numbers are the witness; where the branches meet is where an error would show.
    #[test]
    fn doubles_and_wide_numbers_agree_on_every_branch() {
        for rate in [0.0, 1e-9, 0.3, 0.499, 0.501, 0.99, 1.01, 7.0, 40.0] {
            for time in [1e-6, 0.5, 1.0] {
                let law = |g: [f64; 3]| Law::Mixed {
                    acceleration: vector::<f64>(g),
                };
                let state = State {
                    position: vector([0.3, 0.2, 0.1]),
                    velocity: vector([1.0, -2.0, 3.0]),
                };
                let after = law([0.0, -9.81, 0.5]).after(&state, rate, time);
                let wide = Law::Mixed {
                    acceleration: vector::<Wide>([0.0, -9.81, 0.5]),
                }
                .after(
                    &State {
                        position: vector([0.3, 0.2, 0.1]),
                        velocity: vector([1.0, -2.0, 3.0]),
                    },
                    Wide::from_f64(rate),
                    Wide::from_f64(time),
                );
                let off = (after.position - wide.position.map(Real::to_f64)).norm();
                assert!(off < 4e-15, "c {rate} t {time}: {off:e}");
                let off = (after.velocity - wide.velocity.map(Real::to_f64)).norm();
                assert!(off < 4e-15, "c {rate} t {time}: {off:e}");
            }
        }
    }

    #[test]
    fn the_clock_runs_back_to_the_time() {
        for z in [1e-12, 0.4, 0.6, 20.0] {
            let law = Law::Drag { rate: 0.25 };
            let (u, _) = drag_clock(0.25, z / 0.25);
            let time = law.time_of_clock(u).unwrap();
            // Late on the clock hardly moves: an ulp of u is exp(z) ulps of t.
            let tolerance = 4.0 * f64::EPSILON * f64::exp(z) / 0.25;
            assert!((time - z / 0.25).abs() <= tolerance, "{z}: {time}");
        }
        assert_eq!(Law::Drag { rate: 0.25 }.time_of_clock(4.0), None);
    }
}
