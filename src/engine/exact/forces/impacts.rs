//! What happens at one instant: impacts in the model's order, what sticks, what presses.

use super::held::OPERATIONS_AN_ENTRY;
use super::law::Law;
use super::scalar::{Real, Triple, dot, minus, size};
use super::search::{Cause, Fresh};
use super::series::{as_real, contact_matrix};
use super::touch::{Arms, Surfaces, Touch, arms};
use crate::engine::exact::instant::is_endless;
use crate::engine::exact::order::TieOrder;
use crate::engine::exact::ties::Foreseen;
use crate::physics::Meter;
use crate::physics::cholesky::Cholesky;
use crate::physics::complementarity::{Role, pressing};

/// Impacts at one instant past which the rest is taken as one inelastic impact of all.
const IMPACTS_MAX: usize = 20_000;

/// Rounds of sticking and pressing at one instant; each takes energy out, few are needed.
const ROUNDS_MAX: u32 = 50;

/// Operations to ask whether a touching pair approaches, in both orders of the impacts.
const OPERATIONS_A_MEETING: f64 = 20.0;

/// Operations to ask whether a pair touches, twice the two forces between it included.
const OPERATIONS_A_PAIR: f64 = 40.0;

/// Velocities that two orders of the same impacts may differ by before the model is called
/// undetermined, relative to the largest speed.
const SAME_ANSWER: f64 = 1e-9;

/// A bounce that is none lasts at most so many roots of the least height of the time between
/// samples: 1e-9 of it in double-double, 3e-4 in doubles. A ball of a metre under 10 m/s² bounces
/// a thousand times shorter at the least height.
const SHORT_BOUNCE: f64 = 1e3;

/// An impulse that was transferred.
#[derive(Debug, Clone, Copy)]
pub(super) struct Impact {
    pub(super) touch: Touch,
    pub(super) impulse: f64,
    /// Speed of approach before it.
    approach: f64,
}

/// What an instant leaves behind.
#[derive(Debug, Default)]
pub(super) struct Aftermath {
    pub(super) impacts: Vec<Impact>,
    /// Whether they are the beginning of a series without end.
    pub(super) endless: bool,
    /// Contacts that press from here on.
    pub(super) held: Vec<Touch>,
    /// Contacts that those keep closed.
    pub(super) idle: Vec<Touch>,
    /// Closed gaps that open.
    pub(super) fresh: Vec<Fresh>,
    /// Whether another order of the impacts would have given another answer.
    pub(super) undetermined: bool,
    /// Whether one of them was between surfaces that pressed on each other.
    pub(super) in_cluster: bool,
    /// Elementary operations that it took, about.
    pub(super) operations: f64,
}

/// The rules and the place of an instant.
pub(super) struct Instant<'a, T> {
    pub(super) law: &'a Law<T>,
    pub(super) surfaces: &'a Surfaces<T>,
    /// A bounce that would rise less than this share of the pair's reach is none.
    pub(super) bounce_height: f64,
    /// Time between samples, s.
    pub(super) sample_every: f64,
    pub(super) order: TieOrder,
    pub(super) position: &'a [Triple<T>],
    /// The contacts that pressed until now.
    pub(super) held: &'a [Touch],
    pub(super) trigger: Option<(Touch, Cause)>,
    /// Gaps that close within this time, at most, count as closed, s.
    pub(super) within: f64,
}

/// Touching surfaces with what impacts between them need.
struct Meeting<T> {
    touch: Touch,
    arms: Arms<T>,
    reach: T,
    restitution: T,
    /// A length of the size of the bodies.
    length: f64,
    /// A bounce that leaves slower than this is none.
    least_bounce: f64,
}

impl<T: Real> Meeting<T> {
    /// Below this speed of approach the pair sticks.
    ///
    /// A pair without restitution leaves with no speed whatever it came with: its impacts take
    /// their turn among the others like any.
    fn stick_speed(&self) -> f64 {
        if self.least_bounce == 0.0 || self.restitution <= T::zero() {
            return 0.0;
        }
        self.least_bounce / self.restitution.to_f64()
    }
}

impl<T: Real> Instant<'_, T> {
    /// What the bodies of a touch are about to meet, and when, if they go on at these velocities.
    pub(super) fn foresee(
        &self,
        of: Touch,
        velocity: &[Triple<T>],
        within: f64,
    ) -> Vec<Foreseen<T>> {
        let fastest = velocity.iter().map(size).fold(0.0, f64::max);
        let noise = 64.0 * T::ROUNDING * fastest;
        let shares = |touch: &Touch| touch.bodies().iter().any(|body| of.bodies().contains(body));
        let foreseen = self.surfaces.all().filter(shares).filter_map(|touch| {
            let reach = T::from_f64(self.surfaces.reach(touch));
            let approach = -arms(touch, self.position).rate(velocity) / reach;
            let gap = self.surfaces.gap(touch, self.position);
            let near = approach.to_f64() > noise && gap.to_f64() <= within * approach.to_f64();
            near.then(|| (touch.event(), gap / approach))
        });
        foreseen.collect()
    }

    /// Changes the velocities by every impact of this instant.
    pub(super) fn resolve(&self, velocity: &mut [Triple<T>]) -> Aftermath {
        let meetings = self.meetings(velocity);
        let fastest = velocity.iter().map(size).fold(0.0, f64::max);
        let noise = 64.0 * T::ROUNDING * fastest;
        let before = velocity.to_vec();
        let in_order: Vec<usize> = (0..meetings.len()).collect();
        let impacts = self.sweeps(&meetings, &in_order, noise, velocity);
        let mut aftermath = Aftermath {
            endless: is_endless(impacts.iter().map(|impact| impact.approach)),
            impacts,
            ..Aftermath::default()
        };
        let mut touches = aftermath.impacts.iter().map(|impact| impact.touch);
        aftermath.in_cluster = touches.any(|touch| self.held.contains(&touch));
        if aftermath.impacts.len() > 1 {
            let mut other = before;
            let reversed: Vec<usize> = in_order.into_iter().rev().collect();
            self.sweeps(&meetings, &reversed, noise, &mut other);
            aftermath.undetermined = velocity
                .iter()
                .zip(&other)
                .any(|(one, other)| size(&minus(one, other)) > SAME_ANSWER * fastest);
        }
        let (count, bodies) = (as_real(meetings.len()), as_real(self.position.len()));
        aftermath.operations = OPERATIONS_A_MEETING * count * as_real(aftermath.impacts.len() + 1)
            + OPERATIONS_A_PAIR * bodies * bodies;
        for _ in 0..ROUNDS_MAX {
            aftermath.operations += count * count * (count + 4.0 * OPERATIONS_AN_ENTRY);
            self.stick(&meetings, noise, velocity, &mut aftermath);
            self.press(&meetings, noise, velocity, &mut aftermath);
            let moved = self.stop(&meetings, noise, velocity, &aftermath.held);
            let approaches = |meeting: &Meeting<T>| {
                meeting.arms.rate(velocity).to_f64() < -noise * meeting.reach.to_f64()
            };
            if !moved || !meetings.iter().any(approaches) {
                break;
            }
        }
        aftermath
    }

    /// Takes the speed of bounces that are none out of the pressing contacts, all together;
    /// whether there was any.
    fn stop(
        &self,
        meetings: &[Meeting<T>],
        noise: f64,
        velocity: &mut [Triple<T>],
        held: &[Touch],
    ) -> bool {
        let held: Vec<&Meeting<T>> = meetings
            .iter()
            .filter(|meeting| held.contains(&meeting.touch))
            .collect();
        let pushes: Vec<T> = held.iter().map(|m| -m.arms.rate(velocity)).collect();
        let mut speeds = held.iter().zip(&pushes);
        if speeds.all(|(m, push)| push.to_f64().abs() <= noise * m.reach.to_f64()) {
            return false;
        }
        let entry = |i: usize, j: usize| {
            contact_matrix(&self.law.inverse_mass, &held[i].arms, &held[j].arms)
        };
        let (factor, kept) = Cholesky::of(held.len(), entry);
        let mut pushes: Vec<T> = kept.iter().map(|index| pushes[*index]).collect();
        factor.solve(&mut pushes);
        for (index, push) in kept.into_iter().zip(pushes) {
            held[index]
                .arms
                .push(push, &self.law.inverse_mass, velocity);
        }
        true
    }

    /// Everything that touches, in the order asked for.
    fn meetings(&self, velocity: &[Triple<T>]) -> Vec<Meeting<T>> {
        let applied = self.law.acceleration(self.position, velocity);
        let mut in_cluster = vec![false; self.position.len()];
        for body in self.held.iter().flat_map(|touch| touch.bodies()) {
            in_cluster[body] = true;
        }
        let touches = self.surfaces.all().filter(|touch| {
            self.trigger.is_some_and(|(trigger, _)| trigger == *touch)
                || self.held.contains(touch)
                || self.closed(*touch)
                || self.falls_together(*touch, velocity)
        });
        let meeting = |touch: Touch| {
            let arms = arms(touch, self.position);
            let reach = self.surfaces.reach(touch);
            let restitution = self.surfaces.restitution(touch);
            let bodies = touch.bodies();
            let press = if bodies.iter().any(|body| in_cluster[*body]) {
                size(&applied[bodies[0]]).max(size(&applied[bodies[1]]))
            } else {
                -closing(&arms, touch, &applied, velocity).to_f64() / reach
            };
            let length = match touch {
                Touch::Pair { .. } => reach,
                Touch::Wall { body, .. } => self.surfaces.radii[body],
            };
            Meeting {
                touch,
                arms,
                reach: T::from_f64(reach),
                restitution,
                length,
                least_bounce: self.least_bounce(length, press.max(0.0), restitution.to_f64()),
            }
        };
        let mut meetings: Vec<_> = touches.map(meeting).collect();
        meetings.sort_by_key(|meeting| self.order.rank(meeting.touch.event()));
        meetings
    }

    /// The speed of a bounce that is none.
    ///
    /// Bounces without loss never end, and each is one. With loss, one that would rise less than
    /// the least height is none, if it is also short between two samples: a scene as slow or as
    /// small as its bounces shows them.
    fn least_bounce(&self, length: f64, press: f64, restitution: f64) -> f64 {
        if restitution >= 1.0 {
            return 0.0;
        }
        let low = (2.0 * self.bounce_height * length * press).sqrt();
        let time = SHORT_BOUNCE * self.bounce_height.sqrt() * self.sample_every;
        low.min(0.5 * press * time)
    }

    /// Whether the gap is zero up to the rounding of the positions, or to the least bounce.
    fn closed(&self, touch: Touch) -> bool {
        let bodies = touch.bodies();
        let far = bodies.map(|body| size(&self.position[body]) + self.surfaces.radii[body]);
        let gap = self.surfaces.gap(touch, self.position).to_f64();
        let least_bounce = if self.surfaces.restitution(touch) >= T::one() {
            0.0
        } else {
            self.bounce_height * self.surfaces.reach(touch)
        };
        gap <= closed_below::<T>(far[0].max(far[1])).max(least_bounce)
    }

    /// Whether the gap may close within the time that counts as this instant.
    fn falls_together(&self, touch: Touch, velocity: &[Triple<T>]) -> bool {
        let speed: f64 = touch
            .bodies()
            .iter()
            .map(|body| size(&velocity[*body]))
            .sum();
        let gap = self.surfaces.gap(touch, self.position).to_f64();
        self.within > 0.0 && gap <= self.within * speed
    }

    /// Impacts one after the other, sweep by sweep, until nothing approaches that does not stick.
    fn sweeps(
        &self,
        meetings: &[Meeting<T>],
        order: &[usize],
        noise: f64,
        velocity: &mut [Triple<T>],
    ) -> Vec<Impact> {
        let mut impacts = Vec::new();
        loop {
            let before = impacts.len();
            for meeting in order.iter().map(|index| &meetings[*index]) {
                let rate = meeting.arms.rate(velocity);
                let approach = -rate.to_f64() / meeting.reach.to_f64();
                let alone =
                    impacts.is_empty() && self.trigger == Some((meeting.touch, Cause::Approach));
                let least = if alone { 0.0 } else { noise };
                if approach <= least.max(meeting.stick_speed()) {
                    continue;
                }
                let own = contact_matrix(&self.law.inverse_mass, &meeting.arms, &meeting.arms);
                let push = -(rate * (T::from_f64(1.0) + meeting.restitution) / own);
                meeting.arms.push(push, &self.law.inverse_mass, velocity);
                impacts.push(Impact {
                    touch: meeting.touch,
                    impulse: (push * meeting.reach).to_f64(),
                    approach,
                });
                if impacts.len() == IMPACTS_MAX {
                    return impacts;
                }
            }
            if impacts.len() == before {
                return impacts;
            }
        }
    }

    /// What still approaches sticks: one inelastic impact of all of it together.
    fn stick(
        &self,
        meetings: &[Meeting<T>],
        noise: f64,
        velocity: &mut [Triple<T>],
        aftermath: &mut Aftermath,
    ) {
        let rates: Vec<T> = meetings.iter().map(|m| m.arms.rate(velocity)).collect();
        let resting =
            |index: &usize| rates[*index].to_f64() <= noise * meetings[*index].reach.to_f64();
        let close: Vec<&Meeting<T>> = (0..meetings.len())
            .filter(resting)
            .map(|index| &meetings[index])
            .collect();
        let rates: Vec<T> = (0..meetings.len())
            .filter(resting)
            .map(|index| rates[index])
            .collect();
        let pressing = self.complementary(&close, &rates);
        aftermath.operations += pressing.operations;
        for (meeting, push) in pressing.pressed.iter().zip(pressing.pushes) {
            let own = contact_matrix(&self.law.inverse_mass, &meeting.arms, &meeting.arms);
            meeting.arms.push(push, &self.law.inverse_mass, velocity);
            let speed = (push * own).to_f64() / meeting.reach.to_f64();
            if speed > noise {
                aftermath.impacts.push(Impact {
                    touch: meeting.touch,
                    impulse: (push * meeting.reach).to_f64(),
                    approach: speed,
                });
            }
        }
    }

    /// Which of the closed gaps press from here on.
    ///
    /// One that opens slowly is taken for closed if the force that would press it lets the
    /// bounce rise less than the least height; the others are let go, and asked again without
    /// them.
    fn press(
        &self,
        meetings: &[Meeting<T>],
        noise: f64,
        velocity: &[Triple<T>],
        aftermath: &mut Aftermath,
    ) {
        let applied = self.law.acceleration(self.position, velocity);
        let speed =
            |meeting: &Meeting<T>| meeting.arms.rate(velocity).to_f64() / meeting.reach.to_f64();
        aftermath.held.clear();
        aftermath.idle.clear();
        aftermath.fresh.clear();
        let mut close = Vec::new();
        for meeting in meetings {
            let touch = meeting.touch;
            if speed(meeting) > noise.max(meeting.least_bounce) {
                aftermath.fresh.push(Fresh { touch, skip: 1 });
            } else if self.trigger == Some((touch, Cause::Release)) {
                aftermath.fresh.push(Fresh { touch, skip: 3 });
            } else {
                close.push(meeting);
            }
        }
        loop {
            let closing =
                |meeting: &&Meeting<T>| closing(&meeting.arms, meeting.touch, &applied, velocity);
            let rates: Vec<T> = close.iter().map(closing).collect();
            let Pressing {
                pressed,
                pushes,
                redundant,
                operations,
            } = self.complementary(&close, &rates);
            aftermath.operations += operations;
            let force = |touch: Touch| {
                let mut pairs = pressed.iter().zip(&pushes);
                pairs
                    .find(|(pressed, _)| pressed.touch == touch)
                    .map(|(_, push)| push.to_f64())
            };
            let stays = |meeting: &Meeting<T>| {
                let own = contact_matrix(&self.law.inverse_mass, &meeting.arms, &meeting.arms);
                let press = force(meeting.touch).unwrap_or(0.0) * own.to_f64();
                let height = self.bounce_height * meeting.length;
                let least = 2.0 * height * press / meeting.reach.to_f64();
                let speed = speed(meeting);
                speed <= noise || speed * speed <= least
            };
            let before = close.len();
            let (stay, open): (Vec<_>, Vec<_>) = close.into_iter().partition(|m| stays(m));
            close = stay;
            for meeting in open {
                let touch = meeting.touch;
                aftermath.fresh.push(Fresh { touch, skip: 1 });
            }
            if close.len() < before {
                continue;
            }
            for meeting in &close {
                let touch = meeting.touch;
                if force(touch).is_some() {
                    aftermath.held.push(touch);
                } else if redundant.contains(&touch) {
                    aftermath.idle.push(touch);
                } else {
                    aftermath.fresh.push(Fresh { touch, skip: 2 });
                }
            }
            return;
        }
    }

    /// The meetings that push, and by how much, so that no rate stays negative.
    fn complementary<'m>(&self, close: &[&'m Meeting<T>], rates: &[T]) -> Pressing<'m, T> {
        if rates.iter().all(|rate| *rate > T::zero()) {
            return Pressing::default();
        }
        let entry = |i: usize, j: usize| {
            contact_matrix(&self.law.inverse_mass, &close[i].arms, &close[j].arms)
        };
        let count = close.len();
        let matrix: Vec<f64> = (0..count * count)
            .map(|at| entry(at / count, at % count).to_f64())
            .collect();
        let doubles: Vec<f64> = rates.iter().map(|rate| rate.to_f64()).collect();
        let warm: Vec<bool> = close.iter().map(|m| self.held.contains(&m.touch)).collect();
        let mut meter = Meter::default();
        let roles = pressing(&|i, j| matrix[i * count + j], &doubles, &warm, &mut meter);
        let solving = usize::try_from(meter.done()).unwrap_or(usize::MAX);
        let answer: Vec<usize> = (0..count)
            .filter(|index| roles[*index] == Role::Pressed)
            .collect();
        let (factor, kept) = Cholesky::of(answer.len(), |i, j| entry(answer[i], answer[j]));
        let pressed: Vec<usize> = kept.into_iter().map(|place| answer[place]).collect();
        let mut pushes: Vec<T> = pressed.iter().map(|index| -rates[*index]).collect();
        factor.solve(&mut pushes);
        let is_redundant = |index: &usize| roles[*index] != Role::Free && !pressed.contains(index);
        let redundant = (0..count).filter(is_redundant);
        Pressing {
            redundant: redundant.map(|index| close[index].touch).collect(),
            pressed: pressed.iter().map(|index| close[*index]).collect(),
            pushes,
            operations: OPERATIONS_AN_ENTRY * as_real(count).powi(2) + as_real(solving) / T::COST,
        }
    }
}

/// The answer of a complementarity problem.
struct Pressing<'m, T> {
    pressed: Vec<&'m Meeting<T>>,
    /// Shape: as `pressed`.
    pushes: Vec<T>,
    redundant: Vec<Touch>,
    /// What it took, in the arithmetic of the velocities.
    operations: f64,
}

impl<T> Default for Pressing<'_, T> {
    fn default() -> Self {
        Self {
            pressed: Vec::new(),
            pushes: Vec::new(),
            redundant: Vec::new(),
            operations: 0.0,
        }
    }
}

/// Below this a gap is closed up to rounding, `far` being the largest coordinate that enters.
pub(super) fn closed_below<T: Real>(far: f64) -> f64 {
    64.0 * T::ROUNDING * far
}

/// Second derivative of a gap that is closed, times the length of its direction.
///
/// Equation, pairs: `d . (a_b - a_a) + |v_b - v_a|²`; walls: `n . a`.
fn closing<T: Real>(
    arms: &Arms<T>,
    touch: Touch,
    acceleration: &[Triple<T>],
    velocity: &[Triple<T>],
) -> T {
    let own = arms.rate(acceleration);
    match touch {
        Touch::Pair { a, b } => {
            let w = minus(&velocity[b], &velocity[a]);
            own + dot(&w, &w)
        }
        Touch::Wall { .. } => own,
    }
}
