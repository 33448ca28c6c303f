//! What happens to a body next, if nothing else happens to it before.

use nalgebra::Vector3;

use super::encounter::clock_to_contact;
use super::grid::Face;
use super::law::{Law, State};
use super::plane::{Approach, clock_to_plane};
use super::world::World;
use crate::engine::exact::order::{INTERNAL, TieOrder};
use crate::physics::closing::{Opening, Search, first_closing};
use crate::physics::real::{Real, length};
use crate::recording::EventKind;

/// Speeds of approach below this many roundings of the speeds are none, right after an impact.
const NOISE_ROUNDINGS: f64 = 64.0;

/// Bodies that are fetched from memory together.
const BATCH: usize = 32;

/// What is planned for a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Deed {
    /// Nothing, ever.
    Nothing,
    /// An event of the model.
    Event(EventKind),
    /// A search rested here: plan again.
    PlanAgain,
}

/// A body's next event.
#[derive(Debug, Clone, Copy)]
pub(super) struct Planned<R> {
    /// When, s.
    pub time: R,
    /// What.
    pub deed: Deed,
    /// Place among simultaneous events.
    pub rank: u64,
    /// Count of the partner's changes when this was planned; another count voids the plan.
    pub partner_count: u32,
}

impl<R: Real> Planned<R> {
    /// Nothing, ever.
    pub fn nothing() -> Self {
        Self {
            time: R::from_f64(f64::INFINITY),
            deed: Deed::Nothing,
            rank: INTERNAL,
            partner_count: 0,
        }
    }
}

/// The earliest of several candidates in the clock of the law, simultaneous ones by rank.
pub(super) struct Earliest<'a, R: Real> {
    law: &'a Law<R>,
    order: TieOrder,
    tie: R,
    near: R,
    clock: R,
    best: Planned<R>,
}

impl<'a, R: Real> Earliest<'a, R> {
    pub fn new(world: &'a World<R>) -> Self {
        Self {
            law: &world.model.law,
            order: world.order,
            tie: world.tie,
            near: world.model.near,
            clock: R::from_f64(f64::INFINITY),
            best: Planned::nothing(),
        }
    }

    /// Weighs a candidate against the best so far.
    fn offer(&mut self, clock: R, deed: Deed, partner_count: u32) {
        if clock > self.clock + self.near {
            return;
        }
        let rank = match deed {
            Deed::Event(kind) => self.order.rank(kind),
            Deed::PlanAgain | Deed::Nothing => INTERNAL,
        };
        if self.clock.is_finite() && clock >= self.clock - self.near {
            // Near in the clock, which late under drag hardly moves: compare the times.
            let [old, new] = [self.clock, clock].map(|u| self.law.time_of_clock(u));
            let (Some(old), Some(new)) = (old, new) else {
                return;
            };
            let earlier = if (new - old).abs() <= self.tie {
                rank < self.best.rank
            } else {
                new < old
            };
            if !earlier {
                return;
            }
        }
        self.clock = clock;
        self.best = Planned {
            time: self.best.time,
            deed,
            rank,
            partner_count,
        };
    }

    /// The best as a plan; `now` is the zero of the clock.
    fn plan(self, now: R) -> Planned<R> {
        if self.clock.is_finite()
            && let Some(time) = self.law.time_of_clock(self.clock)
            && time.is_finite()
        {
            return Planned {
                time: now + time,
                ..self.best
            };
        }
        Planned::nothing()
    }
}

impl<R: Real> World<R> {
    /// The next event of a body from now on. Counts the pairs it looks at.
    pub(super) fn plan(&mut self, body: usize) -> Planned<R> {
        let me = self.state_now(body);
        let mut earliest = Earliest::new(self);
        self.offer_walls(body, &me, &mut earliest);
        self.offer_rest(body, &me, &mut earliest);
        let looked = self.offer_contacts(body, &me, None, &mut earliest);
        let planned = earliest.plan(self.now);
        self.pair_tests += looked;
        planned
    }

    /// The earlier of a plan that still holds and a contact with a body that came into reach
    /// through a face.
    pub(super) fn plan_entering(
        &mut self,
        body: usize,
        kept: &Planned<R>,
        face: Face,
    ) -> Planned<R> {
        let me = self.state_now(body);
        let mut earliest = Earliest::new(self);
        let looked = self.offer_contacts(body, &me, Some(face), &mut earliest);
        let planned = earliest.plan(self.now);
        self.pair_tests += looked;
        if planned.time < kept.time {
            planned
        } else {
            *kept
        }
    }

    /// When and through which face a body leaves its cell.
    pub(super) fn plan_crossing(&self, body: usize) -> (R, Face) {
        let mut face = Face {
            axis: 0,
            upper: true,
        };
        let mut first = R::from_f64(f64::INFINITY);
        let Some(grid) = &self.grid else {
            return (first, face);
        };
        let me = self.state_now(body);
        for axis in (0..3).filter(|axis| grid.is_divided(*axis)) {
            for upper in [false, true] {
                let candidate = Face { axis, upper };
                let side = if upper { R::one() } else { -R::one() };
                let gap = side * (grid.coordinate(body, candidate) - me.position[axis]);
                if let Some((clock, _)) = self.clock_to_plane(body, &me, axis, side, gap)
                    && clock < first
                {
                    (first, face) = (clock, candidate);
                }
            }
        }
        let time = first
            .is_finite()
            .then(|| self.model.law.time_of_clock(first))
            .flatten();
        match time {
            Some(time) if time.is_finite() => (self.now + time, face),
            Some(_) | None => (R::from_f64(f64::INFINITY), face),
        }
    }

    fn offer_walls(&self, body: usize, me: &State<R>, earliest: &mut Earliest<'_, R>) {
        for plane in &self.model.planes {
            let reach = plane.half - self.model.fixed[body].radius;
            let gap = reach - plane.side * me.position[plane.axis];
            let Some((clock, closes)) = self.clock_to_plane(body, me, plane.axis, plane.side, gap)
            else {
                continue;
            };
            let deed = if closes {
                let wall = plane.wall;
                Deed::Event(EventKind::Cushion { body, wall })
            } else {
                Deed::PlanAgain
            };
            earliest.offer(clock, deed, 0);
        }
    }

    /// Clock time to a plane; `false` beside it where a search has only come so far.
    #[inline]
    fn clock_to_plane(
        &self,
        body: usize,
        me: &State<R>,
        axis: usize,
        side: R,
        gap: R,
    ) -> Option<(R, bool)> {
        let (law, speed) = (&self.model.law, side * me.velocity[axis]);
        let closed = |pull: R| clock_to_plane(&Approach { gap, speed, pull }).map(|u| (u, true));
        match law {
            Law::Straight | Law::Drag { .. } => {
                if speed > R::zero() {
                    closed(R::zero())
                } else {
                    None
                }
            }
            Law::Gravity { acceleration } => closed(side * acceleration[axis]),
            Law::Mixed { acceleration } => {
                let rate = self.model.fixed[body].rate;
                let found = first_closing(self.time_left(), self.model.tie, |time| {
                    let State { position, velocity } = law.after(me, rate, time);
                    Opening {
                        width: gap - side * (position[axis] - me.position[axis]),
                        rate: -side * velocity[axis],
                        bend: (acceleration[axis] - rate * velocity[axis]).abs(),
                    }
                });
                found.clock()
            }
        }
    }

    /// Equation: under drag the speed falls to the rest speed at `u = (1 - speed/|v|)/c`.
    fn offer_rest(&self, body: usize, me: &State<R>, earliest: &mut Earliest<'_, R>) {
        let Some(rest) = self.model.rest else { return };
        let speed = length(&me.velocity);
        if speed.is_zero() {
            return;
        }
        let deed = Deed::Event(EventKind::Rest { body });
        if speed <= rest {
            earliest.offer(R::zero(), deed, 0);
            return;
        }
        let rate = self.model.fixed[body].rate;
        if rate.is_zero() {
            return;
        }
        let clock = match self.model.law {
            Law::Straight | Law::Gravity { .. } | Law::Mixed { .. } => (speed / rest).ln() / rate,
            Law::Drag { rate } => (R::one() - rest / speed) / rate,
        };
        earliest.offer(clock, deed, 0);
    }

    /// Weighs the contacts with all bodies in reach. Gives their number.
    ///
    /// In two passes a batch: the first does no more than to touch each body, so that all of
    /// them come from memory at once; with 1e5 spheres that takes a third off the time.
    fn offer_contacts(
        &self,
        body: usize,
        me: &State<R>,
        entered: Option<Face>,
        earliest: &mut Earliest<'_, R>,
    ) -> u64 {
        let mut batch = [(0, R::zero()); BATCH];
        let (mut filled, mut looked) = (0, 0);
        self.for_each_partner(body, entered, |other| {
            batch[filled] = (other, self.balls[other].epoch);
            filled += 1;
            if filled == BATCH {
                for (other, epoch) in batch {
                    self.offer_contact((body, me), (other, epoch), earliest);
                }
                looked += filled as u64;
                filled = 0;
            }
        });
        for (other, epoch) in &batch[..filled] {
            self.offer_contact((body, me), (*other, *epoch), earliest);
        }
        looked + filled as u64
    }

    #[inline]
    fn offer_contact(
        &self,
        (body, me): (usize, &State<R>),
        (other, epoch): (usize, R),
        earliest: &mut Earliest<'_, R>,
    ) {
        // One more line of memory a neighbour, where the law has no use for it.
        let rate = match self.model.law {
            Law::Straight | Law::Drag { .. } | Law::Gravity { .. } => R::zero(),
            Law::Mixed { .. } => self.model.fixed[other].rate,
        };
        let state = &self.balls[other].state;
        let them = self.model.law.after(state, rate, self.now - epoch);
        let sum = self.model.reach(body, other);
        match &self.model.law {
            Law::Straight | Law::Drag { .. } | Law::Gravity { .. } => {
                let d = me.position - them.position;
                let w = me.velocity - them.velocity;
                let before = earliest.clock + self.model.near;
                // Seen from each other they fly straight: what has just parted cannot meet.
                if let Some(clock) = clock_to_contact(&d, &w, sum, before)
                    && !self.have_just_met(body, other)
                    && (clock > self.tie || Self::approaches([me, &them]))
                {
                    let kind = contact(body, other);
                    earliest.offer(clock, Deed::Event(kind), self.balls[other].count);
                }
            }
            Law::Mixed { acceleration } => {
                let flights = [(me, body), (&them, other)];
                let found = self.search_contact(&flights, acceleration, sum);
                if let Some((clock, closes)) = found.clock() {
                    let deed = if closes {
                        Deed::Event(contact(body, other))
                    } else {
                        Deed::PlanAgain
                    };
                    earliest.offer(clock, deed, self.balls[other].count);
                }
            }
        }
    }

    /// Whether touching bodies approach by more than rounding: those that came to move together
    /// at one instant do not.
    #[cold]
    fn approaches([a, b]: [&State<R>; 2]) -> bool {
        let (d, w) = (a.position - b.position, a.velocity - b.velocity);
        let none = R::from_f64(NOISE_ROUNDINGS * R::EPSILON);
        let speeds = length(&a.velocity) + length(&b.velocity);
        -d.dot(&w) > none * speeds * length(&d)
    }

    /// Right after their own impact, two bodies have no speed of approach but for rounding.
    #[cold]
    fn search_contact(
        &self,
        flights: &[(&State<R>, usize); 2],
        acceleration: &Vector3<R>,
        sum: R,
    ) -> Search<R> {
        let law = &self.model.law;
        let [rate_a, rate_b] = flights.map(|(_, body)| self.model.fixed[body].rate);
        let noise = if self.have_just_met(flights[0].1, flights[1].1) {
            R::from_f64(NOISE_ROUNDINGS * R::EPSILON)
        } else {
            R::zero()
        };
        first_closing(self.time_left(), self.model.tie, |time| {
            let a = law.after(flights[0].0, rate_a, time);
            let b = law.after(flights[1].0, rate_b, time);
            let (d, w) = (a.position - b.position, a.velocity - b.velocity);
            let apart = length(&d);
            let [pull_a, pull_b] =
                [(a, rate_a), (b, rate_b)].map(|(s, rate)| acceleration - s.velocity * rate);
            // At one rate for both the difference of the pulls decays; else each of them does.
            let bend = if rate_a == rate_b {
                length(&(pull_a - pull_b))
            } else {
                length(&pull_a) + length(&pull_b)
            };
            let rate = if apart.is_zero() {
                -length(&w)
            } else {
                d.dot(&w) / apart
            };
            let unsure = noise * (length(&a.velocity) + length(&b.velocity));
            let rate = if rate.abs() < unsure { R::zero() } else { rate };
            Opening {
                width: apart - sum,
                rate,
                bend,
            }
        })
    }
}

fn contact(body: usize, other: usize) -> EventKind {
    let (a, b) = (body.min(other), body.max(other));
    EventKind::Contact { a, b }
}

impl<R: Real> Search<R> {
    /// The time that was reached, and whether the gap closes there.
    fn clock(self) -> Option<(R, bool)> {
        match self {
            Self::Closes(time) => Some((time, true)),
            Self::OpenUntil(time) => Some((time, false)),
            Self::Open => None,
        }
    }
}
