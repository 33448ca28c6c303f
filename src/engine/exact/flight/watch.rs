//! Impacts that nearly fall on one instant: seen when one of them happens.

use nalgebra::Vector3;

use super::law::{Law, State};
use super::world::World;
use crate::engine::exact::ties::{Foreseen, Noted};
use crate::physics::real::{Real, length};
use crate::recording::EventKind;

/// Speeds of approach below this many roundings of the speeds are none.
const NOISE_ROUNDINGS: f64 = 64.0;

/// Notes the near coincidences of a run.
#[derive(Debug, Clone)]
pub(super) struct Watch<R: Real> {
    /// The law in doubles, to pass over what is far.
    law: Law<f64>,
    /// What has been noted, in order of time.
    pub noted: Noted<R>,
}

impl<R: Real> Watch<R> {
    pub fn new(world: &World<R>) -> Self {
        Self {
            law: world.model.law.roughly(),
            noted: Noted::new(world.model.duration.to_f64()),
        }
    }

    /// What the bodies of an event are about to do, if they go on as they fly now.
    pub fn foresee(&self, world: &World<R>, kind: EventKind) -> Vec<Foreseen<R>> {
        let (first, second) = kind.bodies();
        let mut foreseen = Vec::new();
        for body in std::iter::once(first).chain(second) {
            self.foresee_body(world, body, &mut foreseen);
        }
        foreseen
    }

    fn foresee_body(&self, world: &World<R>, body: usize, foreseen: &mut Vec<Foreseen<R>>) {
        let me = world.state_now(body);
        world.for_each_partner(body, None, |other| {
            if self.may_meet(world, &me, (body, other))
                && let Some(lag) = lag_to_contact(world, &me, (body, other))
                && lag.to_f64() <= self.noted.within()
            {
                let (a, b) = (body.min(other), body.max(other));
                foreseen.push((EventKind::Contact { a, b }, lag));
            }
        });
        for plane in &world.model.planes {
            let reach = plane.half - world.model.fixed[body].radius;
            let gap = reach - plane.side * me.position[plane.axis];
            let speed = plane.side * me.velocity[plane.axis];
            if speed > R::zero() && gap.to_f64() <= self.noted.within() * speed.to_f64() {
                let wall = plane.wall;
                foreseen.push((EventKind::Cushion { body, wall }, gap / speed));
            }
        }
        let Some(rest) = world.model.rest else { return };
        let (speed, rate) = (length(&me.velocity), world.model.fixed[body].rate);
        if speed > R::zero()
            && (speed - rest).to_f64() <= self.noted.within() * (rate * speed).to_f64()
        {
            let left = (speed - rest).larger(R::zero());
            let lag = if left.is_zero() {
                left
            } else {
                left / (rate * speed)
            };
            foreseen.push((EventKind::Rest { body }, lag));
        }
    }

    /// Whether two bodies are near enough, in doubles and with room for their rounding.
    fn may_meet(&self, world: &World<R>, me: &State<R>, (body, other): (usize, usize)) -> bool {
        let ball = &world.balls[other];
        let rate = world.model.fixed[other].rate.to_f64();
        let since = (world.now - ball.epoch).to_f64();
        let them = self.law.after(&ball.state.roughly(), rate, since);
        let me = me.roughly();
        let (d, w) = (me.position - them.position, me.velocity - them.velocity);
        let sum = world.model.reach(body, other).to_f64();
        let room = 1e-12 * (me.position.norm() + them.position.norm() + sum);
        let apart = d.norm();
        let approach = -d.dot(&w) / apart;
        apart - sum <= self.noted.within() * approach.max(0.0) + room
    }
}

/// Gap over speed of approach; none without approach.
fn lag_to_contact<R: Real>(
    world: &World<R>,
    me: &State<R>,
    (body, other): (usize, usize),
) -> Option<R> {
    let them = world.state_now(other);
    let (d, w) = (me.position - them.position, me.velocity - them.velocity);
    let apart = length(&d);
    let approach = -d.dot(&w) / apart;
    let noise = NOISE_ROUNDINGS * R::EPSILON;
    let none = (length(&me.velocity) + length(&them.velocity)).times(noise);
    let gap = apart - world.model.reach(body, other);
    (approach > none).then(|| gap / approach)
}

impl<R: Real> State<R> {
    /// In doubles.
    fn roughly(&self) -> State<f64> {
        let doubles = |vector: &Vector3<R>| vector.map(Real::to_f64);
        State {
            position: doubles(&self.position),
            velocity: doubles(&self.velocity),
        }
    }
}
