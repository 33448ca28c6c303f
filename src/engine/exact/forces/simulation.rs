//! The simulation: steps, the events that end them early, samples in between.

use super::accuracy::{Accuracy, UNDETERMINED_BOUNCE_HEIGHT};
use super::impacts::{Aftermath, Instant, closed_below};
use super::law::Law;
use super::nudge::nudge;
use super::refuse::check;
use super::scalar::{Real, Triple, size};
use super::search::{Cause, Fresh, Upcoming, first_event};
use super::series::{Series, as_real};
use super::span::span;
use super::touch::{Surfaces, Touch, arms};
use super::watchdog::Watchdog;
use crate::engine::Simulation;
use crate::engine::exact::effort::Effort;
use crate::engine::exact::order::TieOrder;
use crate::engine::exact::ties::Noted;
use crate::error::Result;
use crate::physics::BodyState;
use crate::physics::cholesky::Cholesky;
use crate::recording::{CollapseReason, Event, EventLog, Outcome, Work, initial_states};
use crate::scene::Scene;

/// Steps between these multiples of the scale of time keep every coefficient a number.
const SCALES: std::ops::Range<f64> = 1e-6..1e6;

/// Operations to see that a pair cannot meet within a step.
const OPERATIONS_A_LOOK: f64 = 10.0;

/// Scales of time that are tried.
const TRIES_MAX: u32 = 16;

/// Event-driven motion of a scene with attraction or springs.
///
/// Valid for: attraction, springs, drag, uniform gravity, contact and cushions in any
/// combination; rest only without forces.
#[derive(Debug, Clone)]
pub struct ForcesSimulation<T: Real> {
    pub(super) law: Law<T>,
    pub(super) surfaces: Surfaces<T>,
    accuracy: Accuracy,
    order: TieOrder,
    duration: f64,
    sample_every: f64,
    sample: usize,
    shown: Vec<BodyState>,
    /// Where the present step starts.
    time: Exact<T>,
    position: Vec<Exact<Triple<T>>>,
    velocity: Vec<Exact<Triple<T>>>,
    /// Contacts that press.
    pub(super) held: Vec<Touch>,
    /// Contacts that those keep closed.
    pub(super) idle: Vec<Touch>,
    fresh: Vec<Fresh>,
    step: Option<Step<T>>,
    tau: f64,
    /// Whether the last step ended with an event.
    after_event: bool,
    watchdog: Watchdog,
    outcome: Option<Outcome>,
    undetermined: Option<Undetermined>,
    /// Time from the last sample to the nearest event, over what is known of an event's time.
    nearest_event: f64,
    is_unsettled: bool,
    is_patient: bool,
    work: Work,
    pub(super) effort: Effort,
    /// What nearly falls on one instant, where that is asked for.
    pub(super) watch: Option<Box<Noted<T>>>,
    together: Option<Together>,
}

/// Events that are taken as one instant, in an order of their own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Together {
    /// Events between these two times, s.
    pub(super) between: [f64; 2],
    /// With those that follow within this time, s.
    pub(super) within: f64,
    pub(super) order: TieOrder,
}

/// An instant at which another order of simultaneous impacts would have given another answer:
/// from there on the model itself has no single one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Undetermined {
    /// Time, s.
    pub time: f64,
    /// The bodies of the impact that set it off, the same one twice at a wall.
    pub bodies: [usize; 2],
}

/// A sum with what rounding took from it.
#[derive(Debug, Clone, Copy)]
struct Exact<V> {
    sum: V,
    carry: V,
}

/// A step whose series is known.
#[derive(Debug, Clone)]
struct Step<T> {
    series: Series<T>,
    /// Where it ends, in units of the series' tau.
    end: T,
    event: Option<(Touch, Cause)>,
}

impl<T: Real> Step<T> {
    /// A step that ends where that happens.
    fn until(series: Series<T>, Upcoming { at, touch, cause }: Upcoming<T>) -> Self {
        let event = match cause {
            Cause::Approach | Cause::Press | Cause::Release => Some((touch, cause)),
            Cause::Nearer => None,
        };
        Self {
            series,
            end: at,
            event,
        }
    }
}

impl<T: Real> ForcesSimulation<T> {
    /// Puts a scene at its start.
    ///
    /// # Errors
    /// [`Error::EngineCannot`](crate::error::Error::EngineCannot) for rest together with
    /// forces, and for bodies that overlap at the start; what is wrong with the scene.
    pub fn new(scene: &Scene, accuracy: Accuracy) -> Result<Self> {
        check(scene)?;
        let mut simulation = Self {
            law: Law::of(scene),
            surfaces: Surfaces::of(scene),
            accuracy,
            order: TieOrder::Rule,
            duration: scene.duration,
            sample_every: scene.sample_every,
            sample: 0,
            shown: Vec::new(),
            time: Exact {
                sum: T::zero(),
                carry: T::zero(),
            },
            position: Vec::new(),
            velocity: Vec::new(),
            held: Vec::new(),
            idle: Vec::new(),
            fresh: Vec::new(),
            step: None,
            tau: power_of_two(scene.sample_every),
            after_event: false,
            watchdog: Watchdog::new(scene.duration),
            outcome: None,
            undetermined: None,
            nearest_event: f64::INFINITY,
            is_unsettled: false,
            is_patient: false,
            work: Work::default(),
            effort: Effort::limited(u64::MAX),
            watch: None,
            together: None,
        };
        simulation.set_state(0, &initial_states(scene));
        Ok(simulation)
    }

    /// The same with an eye on impacts that nearly fall on one instant.
    pub(super) fn watched(mut self) -> Self {
        self.watch = Some(Box::new(Noted::new(self.duration)));
        self
    }

    /// The same with events that are taken together.
    pub(super) fn with_together(mut self, together: Together) -> Self {
        self.together = Some(together);
        self
    }

    /// Goes on to a time between samples; false if it ends before.
    pub(super) fn reaches(&mut self, time: f64) -> bool {
        self.reach(time, None);
        self.outcome.is_none()
    }

    /// The same with simultaneous impacts in that order.
    #[must_use]
    pub fn with_order(mut self, order: TieOrder) -> Self {
        self.order = order;
        self
    }

    /// The same with a bound on the work: past so many elementary operations it ends.
    #[must_use]
    pub fn limited(mut self, operations: u64) -> Self {
        self.effort = Effort::limited(operations);
        self
    }

    /// Elementary operations done.
    pub(super) fn operations(&self) -> f64 {
        self.effort.done()
    }

    /// Where the model ceased to have a single answer, if it did.
    #[must_use]
    pub fn undetermined(&self) -> Option<Undetermined> {
        self.undetermined
    }

    /// The same without ending bounces sooner where a cluster has no single answer, until
    /// told to.
    #[must_use]
    pub fn patient(mut self) -> Self {
        self.is_patient = true;
        self
    }

    /// Whether an impact on a cluster of pressing contacts had no single answer.
    pub(super) fn is_unsettled(&self) -> bool {
        self.is_unsettled
    }

    /// Ends bounces sooner from here on, as the answer is not the only one any more.
    pub(super) fn settle_sooner(&mut self) {
        self.is_patient = false;
        self.is_unsettled = true;
    }

    fn bounce_height(&self) -> f64 {
        let least = self.accuracy.bounce_height;
        if self.is_unsettled && !self.is_patient {
            return least.max(UNDETERMINED_BOUNCE_HEIGHT);
        }
        least
    }

    pub(super) fn positions(&self) -> Vec<Triple<T>> {
        self.position.iter().map(|exact| exact.sum).collect()
    }

    pub(super) fn velocities(&self) -> Vec<Triple<T>> {
        self.velocity.iter().map(|exact| exact.sum).collect()
    }

    pub(super) fn set_positions(&mut self, positions: &[Triple<T>]) {
        for (own, position) in self.position.iter_mut().zip(positions) {
            if own.sum != *position {
                *own = exactly(*position);
            }
        }
    }

    pub(super) fn set_velocities(&mut self, velocities: &[Triple<T>]) {
        for (own, velocity) in self.velocity.iter_mut().zip(velocities) {
            if own.sum != *velocity {
                *own = exactly(*velocity);
            }
        }
    }

    /// Puts the bodies into these states at a time, after the last sample reached.
    pub(in crate::engine::exact) fn go_on_from(&mut self, time: f64, states: &[BodyState]) {
        let wide = |vector: &crate::physics::Vector3| {
            exactly([vector.x, vector.y, vector.z].map(T::from_f64))
        };
        self.shown = states.to_vec();
        self.time = Exact {
            sum: T::from_f64(time),
            carry: T::zero(),
        };
        self.position = states.iter().map(|state| wide(&state.position)).collect();
        self.velocity = states.iter().map(|state| wide(&state.velocity)).collect();
        self.held.clear();
        self.idle.clear();
        self.fresh.clear();
        self.step = None;
        self.outcome = None;
        self.undetermined = None;
        self.is_unsettled = false;
        self.watchdog.restart(time);
    }

    /// The impacts of this instant, and which contacts press from here on.
    fn resolve(&mut self, trigger: Option<(Touch, Cause)>, log: Option<&mut EventLog>) {
        let position = self.positions();
        let mut velocity = self.velocities();
        let now = self.time.sum.to_f64();
        let at_once = |it: &Together| it.between[0] <= now && now <= it.between[1];
        let together = self.together.filter(at_once);
        let instant = Instant {
            law: &self.law,
            surfaces: &self.surfaces,
            bounce_height: self.bounce_height(),
            sample_every: self.sample_every,
            order: together.map_or(self.order, |it| it.order),
            position: &position,
            held: &self.held,
            trigger,
            within: together.map_or(0.0, |it| it.within),
        };
        let watched = self.watch.as_ref().zip(trigger);
        let watched = watched.map(|(watch, (touch, _))| (touch, watch.within()));
        let foresee = |velocity: &[Triple<T>]| {
            watched.map(|(touch, within)| instant.foresee(touch, velocity, within))
        };
        let before = foresee(&velocity);
        let Aftermath {
            impacts,
            endless,
            held,
            idle,
            fresh,
            undetermined,
            in_cluster,
            operations,
        } = instant.resolve(&mut velocity);
        if !impacts.is_empty()
            && let (Some(before), Some(after)) = (before, foresee(&velocity))
            && let Some(watch) = &mut self.watch
        {
            watch.note(self.time.sum, &before);
            watch.note(self.time.sum, &after);
        }
        self.set_velocities(&velocity);
        self.effort.add::<T>(operations);
        let time = self.time.sum.to_f64();
        if undetermined {
            let touch = trigger.map(|(touch, _)| touch);
            let touch = touch.or(impacts.first().map(|impact| impact.touch));
            let bodies = touch.map_or([0, 0], Touch::bodies);
            let here = Undetermined { time, bodies };
            self.undetermined.get_or_insert(here);
            self.is_unsettled |= in_cluster;
        }
        if let Some(log) = log {
            let first = log.events().len();
            for impact in impacts {
                log.push(Event {
                    time,
                    kind: impact.touch.event(),
                    impulse: impact.impulse,
                });
            }
            if endless {
                log.sum_from(first);
            }
        }
        self.held = held;
        self.idle = idle;
        self.fresh = fresh;
    }

    pub(super) fn collapse(&mut self, [body_a, body_b]: [usize; 2], reason: CollapseReason) {
        self.outcome = Some(Outcome::Collapsed {
            time: self.time.sum.to_f64(),
            a: body_a,
            b: (body_b != body_a).then_some(body_b),
            reason,
        });
    }

    /// Expands the motion from here and finds where the step ends.
    fn plan(&mut self) {
        let factor = self.close_held();
        let order = self.accuracy.order;
        for attempt in 0..TRIES_MAX {
            let mut series = self.series();
            if attempt == 0 && self.after_event {
                self.extend(&mut series, &factor, self.accuracy.short_order);
                if let Some(upcoming) = self.soon(&series) {
                    self.work.steps += 1;
                    self.step = Some(Step::until(series, upcoming));
                    return;
                }
            }
            self.extend(&mut series, &factor, order);
            let end = self.span(&series);
            if !series.is_finite() || end.is_nan() || end == 0.0 {
                // Too long a scale overflows, in the coefficients or in their squares, which
                // leaves no step; too short a one never does.
                self.tau *= 2.0_f64.powi(-40);
            } else if end.is_finite() && end > 0.0 && !SCALES.contains(&end) {
                self.tau = power_of_two(self.tau * end);
            } else {
                // Where nothing changes, or all in a parabola, one step is good for ever.
                let remaining = self.duration - self.time.sum.to_f64() + self.sample_every;
                return self.settle(series, end.min(remaining / self.tau));
            }
        }
        let bodies = self.closest();
        self.collapse(bodies, CollapseReason::Singularity);
    }

    /// The next event if it comes within what a series of few orders reaches, as bounces do that
    /// follow each other closely.
    fn soon(&mut self, series: &Series<T>) -> Option<Upcoming<T>> {
        let end = self.span(series);
        if !series.is_finite() || !end.is_finite() {
            return None;
        }
        self.look(series, end)
    }

    /// How far a series may be followed.
    fn span(&self, series: &Series<T>) -> f64 {
        self.accuracy.step * span(series, &self.law, self.accuracy.tolerance)
    }

    /// The first event within so much of a series.
    #[allow(clippy::cast_precision_loss, reason = "an estimate")]
    fn look(&mut self, series: &Series<T>, end: f64) -> Option<Upcoming<T>> {
        let mut looked_at = 0;
        let closed = (&*self.fresh, &*self.idle);
        let rules = (&self.law, &self.surfaces);
        let event = first_event(series, rules, end, closed, &mut looked_at);
        self.work.pair_tests += looked_at;
        self.effort.add::<f64>(OPERATIONS_A_LOOK * looked_at as f64);
        event
    }

    fn series(&self) -> Series<T> {
        let start = (self.positions(), self.velocities());
        let scale = (self.accuracy.order, self.tau);
        Series::at(&self.law, start, &self.held, scale)
    }

    /// Extends a series and counts the forces evaluated.
    fn extend(&mut self, series: &mut Series<T>, factor: &Cholesky<T>, order: usize) {
        let law = &self.law;
        let gravity = law.gravity.iter().any(|g| g.to_f64() != 0.0);
        let per_body = usize::from(law.drag.is_some()) + usize::from(gravity);
        let forces = law.links.len() + per_body * law.inverse_mass.len();
        self.work.force_evaluations += (forces * (order - series.order())) as u64;
        // Each order of a link or a held contact multiplies all orders before it.
        let orders = as_real(order) * as_real(order) - as_real(series.order()).powi(2);
        let chains = as_real(law.links.len() + self.held.len());
        let solutions = as_real(self.held.len()).powi(2) * as_real(order);
        self.effort
            .add::<T>(4.0 * chains * orders + 2.0 * solutions);
        series.extend(law, factor, order);
    }

    /// Takes a series whose step may last until `end`, or until the first event.
    fn settle(&mut self, series: Series<T>, end: f64) {
        let time = self.time.sum.to_f64();
        if self.watchdog.is_vanishing::<T>(time, end * series.tau) {
            let bodies = self.closest();
            return self.collapse(bodies, CollapseReason::Singularity);
        }
        self.tau = power_of_two(end * series.tau);
        self.work.steps += 1;
        self.step = Some(match self.look(&series, end) {
            Some(upcoming) => Step::until(series, upcoming),
            None => Step {
                series,
                end: T::from_f64(end),
                event: None,
            },
        });
    }

    /// The pair of linked bodies with the least distance.
    fn closest(&self) -> [usize; 2] {
        let distance = |ends: [usize; 2]| {
            let [a, b] = ends.map(|end| self.position[end].sum);
            size(&super::scalar::minus(&a, &b))
        };
        let ends = self.law.links.iter().map(|link| link.ends);
        let closest = ends.min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        closest.unwrap_or([0, 0])
    }

    /// Goes to the end of the step, and through the event there.
    fn cross(&mut self, step: &Step<T>, log: Option<&mut EventLog>) {
        let before = self.time.sum;
        let elapsed = step.end.times(step.series.tau);
        T::accumulate(&mut self.time.sum, &mut self.time.carry, elapsed);
        for (position, velocity) in self.position.iter_mut().zip(&self.velocity) {
            // The series starts from the velocity's sum alone.
            for (axis, carry) in velocity.carry.into_iter().enumerate() {
                position.carry[axis] += carry * elapsed;
            }
        }
        let moved = [
            (&mut self.position, &step.series.position),
            (&mut self.velocity, &step.series.velocity),
        ];
        for (own, series) in moved {
            for (own, change) in own.iter_mut().zip(Series::change(series, step.end)) {
                for (axis, change) in change.into_iter().enumerate() {
                    T::accumulate(&mut own.sum[axis], &mut own.carry[axis], change);
                }
            }
        }
        self.after_event = step.event.is_some();
        let progress = (self.time.sum - before).to_f64();
        match step.event {
            Some((touch, Cause::Press)) => self.hold(touch),
            Some(event) => self.resolve(Some(event), log),
            None => self.forget_open(),
        }
        let bodies = step
            .event
            .map_or_else(|| self.closest(), |(touch, _)| touch.bodies());
        if self.outcome.is_none() && self.watchdog.runs_away(self.time.sum.to_f64(), progress) {
            self.collapse(bodies, CollapseReason::EndlessImpacts);
        }
    }

    /// Keeps a contact closed that begins to press without an impact; if it does not press after
    /// all, the series of its force lets it go.
    fn hold(&mut self, touch: Touch) {
        self.fresh.retain(|fresh| fresh.touch != touch);
        self.held.push(touch);
    }

    /// A gap that has opened needs no care any more; of one that has opened by less than rounding
    /// nothing but that it is closed is known.
    fn forget_open(&mut self) {
        if self.fresh.is_empty() {
            return;
        }
        let position = self.positions();
        let surfaces = &self.surfaces;
        self.fresh.retain_mut(|fresh| {
            fresh.skip = 1;
            let far = fresh.touch.bodies().map(|body| size(&position[body]));
            let gap = surfaces.gap(fresh.touch, &position).to_f64();
            gap <= closed_below::<T>(far[0].max(far[1]) + surfaces.reach(fresh.touch))
        });
    }

    fn show(&mut self, step: Option<(&Step<T>, T)>) {
        let mut shown = [self.positions(), self.velocities()];
        if let Some((step, u)) = step {
            let changes = [&step.series.position, &step.series.velocity];
            for (shown, series) in shown.iter_mut().zip(changes) {
                for (own, change) in shown.iter_mut().zip(Series::change(series, u)) {
                    for axis in 0..3 {
                        own[axis] += change[axis];
                    }
                }
            }
        }
        let [position, velocity] = shown;
        let vector = |triple: Triple<T>| triple.map(T::to_f64).into();
        let states = position.into_iter().zip(velocity);
        self.shown = states
            .map(|(x, v)| BodyState {
                position: vector(x),
                velocity: vector(v),
            })
            .collect();
    }

    /// What is known of the time of an event there: its rounding, and the truncation of the steps
    /// up to it, about a hundred of them long. An event so near to a sample belongs to it.
    fn instant(&self, time: f64) -> f64 {
        (16.0 * T::ROUNDING + 100.0 * self.accuracy.tolerance) * time.abs()
    }

    /// Whether an event stands so near to the last sample that rounding decides which of the two
    /// comes first.
    pub(super) fn is_near_event(&self) -> bool {
        self.nearest_event <= 1.0
    }

    /// Lets what happens at time 0 happen, so that the state there shows it.
    pub(super) fn begin(&mut self, log: Option<&mut EventLog>) {
        if self.step.is_none() && self.outcome.is_none() {
            self.resolve(None, log);
            self.show(None);
        }
    }

    /// Moves every coordinate and component of a velocity by that share of the
    /// largest, by lot; contacts that are closed and neither open nor close stay so.
    pub(super) fn move_inputs(&mut self, share: f64, seed: u64) {
        let (mut position, mut velocity) = (self.positions(), self.velocities());
        let fastest = velocity.iter().map(size).fold(0.0, f64::max);
        let together = self.surfaces.all().filter(|touch| {
            let far = touch.bodies().map(|body| size(&position[body]));
            let far = far[0].max(far[1]) + self.surfaces.reach(*touch);
            let gap = self.surfaces.gap(*touch, &position).to_f64();
            let rate = arms(*touch, &position).rate(&velocity).to_f64();
            let still = 64.0 * T::ROUNDING * fastest * self.surfaces.reach(*touch);
            gap.abs() <= closed_below::<T>(far) && rate.abs() <= still
        });
        self.held = together.collect();
        nudge(&mut position, &mut velocity, share, seed);
        self.set_positions(&position);
        self.set_velocities(&velocity);
        self.close_held();
        self.held.clear();
        self.idle.clear();
    }

    /// Steps on until the step that holds that time, all events up to it behind it.
    fn reach(&mut self, target: f64, mut log: Option<&mut EventLog>) {
        if self.step.is_none() && self.outcome.is_none() {
            self.resolve(None, log.as_deref_mut());
        }
        while self.outcome.is_none() {
            if self.effort.is_spent() {
                self.outcome = Some(Outcome::BudgetSpent {
                    time: self.time.sum.to_f64(),
                });
                return;
            }
            let Some(step) = self.step.take() else {
                self.plan();
                continue;
            };
            let left = T::from_f64(target) - self.time.sum - self.time.carry;
            let beyond = (step.end.times(step.series.tau) - left).to_f64();
            let at_once = self.instant(target);
            let passes = if step.event.is_some() {
                beyond <= at_once
            } else {
                beyond < 0.0
            };
            if passes {
                self.cross(&step, log.as_deref_mut());
            } else {
                let since = (left + self.time.carry).to_f64().abs();
                let ago = if self.after_event {
                    since
                } else {
                    f64::INFINITY
                };
                let ahead = if step.event.is_some() {
                    beyond
                } else {
                    f64::INFINITY
                };
                self.nearest_event = ago.min(ahead / 16.0) / at_once;
                self.show(Some((&step, left.times(1.0 / step.series.tau))));
                self.step = Some(step);
                return;
            }
        }
    }
}

impl<T: Real> Simulation for ForcesSimulation<T> {
    #[allow(clippy::cast_precision_loss, reason = "samples stay far below 2^53")]
    fn advance_to(&mut self, sample: usize, mut log: Option<&mut EventLog>) -> Option<Outcome> {
        if sample > self.sample && self.outcome.is_none() {
            self.sample = sample;
            self.reach(sample as f64 * self.sample_every, log.take());
        }
        self.outcome
    }

    fn state_into(&self, into: &mut [BodyState]) {
        for (into, shown) in into.iter_mut().zip(&self.shown) {
            *into = *shown;
        }
    }

    #[allow(clippy::cast_precision_loss, reason = "samples stay far below 2^53")]
    fn set_state(&mut self, sample: usize, states: &[BodyState]) {
        self.sample = sample;
        self.go_on_from(sample as f64 * self.sample_every, states);
    }

    fn work(&self) -> Work {
        self.work
    }
}

fn exactly<T: Real>(sum: Triple<T>) -> Exact<Triple<T>> {
    Exact {
        sum,
        carry: [T::zero(); 3],
    }
}

/// The power of two nearest in size, so that scaling by it is exact.
fn power_of_two(value: f64) -> f64 {
    let exponent = value.log2().round();
    exponent.clamp(-1000.0, 1000.0).exp2()
}
