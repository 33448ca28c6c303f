//! Impacts that nearly fall on one instant: seen when one of them happens.

use nalgebra::Vector3;

use super::law::{Law, State};
use super::world::World;
use crate::physics::real::{Real, length};
use crate::recording::EventKind;

/// Share of the duration within which two impacts of a body are noted. Where half an ulp of an
/// input leaves more open than that, positions have lost the digits to be compared.
const NOTED: f64 = 1e-6;

/// At most so many are noted, from the first on: bounces that pile up come ever closer.
const KEPT: usize = 4096;

/// Speeds of approach below this many roundings of the speeds are none.
const NOISE_ROUNDINGS: f64 = 64.0;

/// Two events that share a body and nearly an instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near<R> {
    /// When, s.
    pub time: R,
    /// Both, the lower one first.
    pub kinds: [EventKind; 2],
    /// Time from the first to the second, s; negative where the second comes first.
    pub lag: R,
}

/// What is foreseen: an event, and the time until then.
type Foreseen<R> = (EventKind, R);

/// Notes the near coincidences of a run.
#[derive(Debug, Clone)]
pub(super) struct Watch<R: Real> {
    within: f64,
    /// The law in doubles, to pass over what is far.
    law: Law<f64>,
    noted: Vec<Near<R>>,
}

impl<R: Real> Watch<R> {
    pub fn new(world: &World<R>) -> Self {
        Self {
            within: NOTED * world.model.duration.to_f64(),
            law: world.model.law.roughly(),
            noted: Vec::new(),
        }
    }

    /// What has been noted, in order of time.
    pub fn noted(&self) -> &[Near<R>] {
        &self.noted
    }

    /// The longest time between two events that are noted, s.
    pub fn within(&self) -> f64 {
        self.within
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

    /// Notes the pairs of foreseen events that share a body.
    pub fn note(&mut self, now: R, foreseen: &[Foreseen<R>]) {
        for (place, one) in foreseen.iter().enumerate() {
            for other in &foreseen[..place] {
                let later = one.0 > other.0;
                let [first, second] = if later { [other, one] } else { [one, other] };
                let kinds = [first.0, second.0];
                if shared(kinds).is_none() || kinds[0] == kinds[1] || self.knows(now, kinds) {
                    continue;
                }
                if self.noted.len() < KEPT {
                    let lag = second.1 - first.1;
                    self.noted.push(Near {
                        time: now,
                        kinds,
                        lag,
                    });
                }
            }
        }
    }

    /// Whether the two have been noted just now.
    fn knows(&self, now: R, kinds: [EventKind; 2]) -> bool {
        let recent = |near: &&Near<R>| (now - near.time).to_f64() <= self.within;
        let mut latest = self.noted.iter().rev().take_while(recent);
        latest.any(|near| near.kinds == kinds)
    }

    fn foresee_body(&self, world: &World<R>, body: usize, foreseen: &mut Vec<Foreseen<R>>) {
        let me = world.state_now(body);
        world.for_each_partner(body, None, |other| {
            if self.may_meet(world, &me, (body, other))
                && let Some(lag) = lag_to_contact(world, &me, (body, other))
                && lag.to_f64() <= self.within
            {
                let (a, b) = (body.min(other), body.max(other));
                foreseen.push((EventKind::Contact { a, b }, lag));
            }
        });
        for plane in &world.model.planes {
            let reach = plane.half - world.model.fixed[body].radius;
            let gap = reach - plane.side * me.position[plane.axis];
            let speed = plane.side * me.velocity[plane.axis];
            if speed > R::zero() && gap.to_f64() <= self.within * speed.to_f64() {
                let wall = plane.wall;
                foreseen.push((EventKind::Cushion { body, wall }, gap / speed));
            }
        }
        let Some(rest) = world.model.rest else { return };
        let (speed, rate) = (length(&me.velocity), world.model.fixed[body].rate);
        if speed > R::zero() && (speed - rest).to_f64() <= self.within * (rate * speed).to_f64() {
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
        apart - sum <= self.within * approach.max(0.0) + room
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

/// A body that takes part in both.
pub(super) fn shared(kinds: [EventKind; 2]) -> Option<usize> {
    let [(a, b), (c, d)] = kinds.map(EventKind::bodies);
    if a == c || Some(a) == d {
        return Some(a);
    }
    b.filter(|b| *b == c || Some(*b) == d)
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
