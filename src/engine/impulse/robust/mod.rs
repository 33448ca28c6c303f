//! The top of the ladder: a scheme that survives every scene, and says where it had to give way.
//!
//! Between impacts bodies move in closed form under drag, dampers and gravity ([`flow`]); forces
//! between bodies are constant over a step and keep the energy exactly, whatever its length
//! ([`mean_force`]), and steps are as short as each effect asks for ([`limits`]). Impacts are
//! found on the way, and all of one instant are solved together ([`together`]). Surfaces that
//! stay in touch press on each other with forces that are solved together too. Spheres that
//! overlap at the start are moved apart once ([`overlap`]).

mod flow;
mod limits;
mod mean_force;
mod overlap;
mod stick;
mod together;
mod touch;

use super::handling::{Taken, pairs};
use super::meeting::{Along, contact, cushion, slowed};
use super::observer::Observer;
use super::path::Way;
use super::phases::Phases;
use super::scheme::Scheme;
use super::sweep::stop;
use super::{Particle, books};
use crate::physics::complementarity::pushes;
use crate::physics::{SpringDamper, Vector3};
use crate::recording::{Account, Concession, ConcessionKind, Entry, EventKind, Wall};
use crate::scene::Scene;
use flow::{Flight, Flow};
use limits::Limits;
use together::{Instant, coupling};
use touch::{Touch, touching};

/// Rounds in which forces between bodies find the end of a step that they lead to.
const ROUNDS_MAX: u32 = 60;
/// Rounds that find the pushes of surfaces in touch while other forces depend on places.
const PUSH_ROUNDS: u32 = 6;
/// Corrections of the time of an impact under forces that depend on places.
const REFINEMENTS: u32 = 4;
/// Surfaces that press and slide may turn by this angle in a step.
const TURN: f64 = 0.05;
/// Substeps of a step, after which they grow: the work of a step is bounded.
const SUBSTEPS: u64 = 20_000;
/// Impacts of a step, and a share more for few bodies, after which none bounces any more.
const IMPACTS: u64 = 20_000;
const IMPACTS_SHARED: u64 = 1_000_000;
/// Share of a step below which two instants are one.
const INSTANT: f64 = 1e-13;

/// The scheme `robust` on one scene.
#[derive(Debug, Clone)]
pub struct Robust {
    flow: Flow,
    limits: Limits,
    start: Vec<Particle>,
    before: Vec<Vector3>,
    ways: Vec<Flight>,
    travel: Vec<f64>,
    touches: Vec<Touch>,
    /// Forces between surfaces in touch. Shape: `[body]`.
    pushes: Vec<Vector3>,
    /// Those of walls, summed.
    wall_push: Vector3,
    /// For so long nothing can meet, s.
    clear: f64,
    /// Whether overlaps could not be resolved.
    jammed: bool,
    conceded: Conceded,
}

/// How often what was given up.
#[derive(Debug, Clone, Copy, Default)]
struct Conceded {
    long_steps: u64,
    turned_back: u64,
    cut_short: u64,
    jammed: u64,
}

/// What comes first in a step.
#[derive(Debug, Clone, Copy)]
struct Next {
    time: f64,
    kind: EventKind,
}

impl Scheme for Robust {
    fn of(scene: &Scene, particles: &[Particle], _step: f64) -> Self {
        let springs = SpringDamper::all(scene);
        let phases = Phases::of(scene, crate::engine::spec::DragRule::Exponential);
        Self {
            flow: Flow::of(scene, &springs),
            limits: Limits::of(&phases, particles),
            start: Vec::new(),
            before: Vec::new(),
            ways: Vec::new(),
            travel: Vec::new(),
            touches: Vec::new(),
            pushes: vec![Vector3::zeros(); particles.len()],
            wall_push: Vector3::zeros(),
            clear: 0.0,
            jammed: false,
            conceded: Conceded::default(),
        }
    }

    #[inline]
    fn step(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut impl Observer,
    ) -> Taken {
        if self.clear >= dt || self.becomes_clear(phases, particles, dt) {
            self.clear -= dt;
            return self.coast(phases, particles, dt, observer);
        }
        self.walk(phases, particles, dt, observer)
    }

    fn forget(&mut self) {
        self.clear = 0.0;
        self.jammed = false;
    }

    fn concessions(&self) -> Vec<Concession> {
        let Conceded {
            long_steps,
            turned_back,
            cut_short,
            jammed,
        } = self.conceded;
        let counts = [
            (ConcessionKind::LongStep, long_steps),
            (ConcessionKind::TurnedBack, turned_back),
            (ConcessionKind::CutShort, cut_short),
            (ConcessionKind::Jammed, jammed),
        ];
        let made = counts.into_iter().filter(|(_, count)| *count > 0);
        made.map(|(kind, count)| Concession { kind, count })
            .collect()
    }
}

/// Counters of one step.
#[derive(Debug, Clone, Copy, Default)]
struct Spent {
    taken: Taken,
    substeps: u64,
    impacts: u64,
}

impl Robust {
    /// Whether nothing can meet or stop for longer than a step, where speeds never grow.
    ///
    /// Sets `clear`: the least time in which any two surfaces could meet at their present speeds,
    /// or a body slow down to the rest speed.
    fn becomes_clear(&mut self, phases: &Phases, particles: &[Particle], dt: f64) -> bool {
        self.clear = 0.0;
        if phases.gravity.is_some() || !self.limits.are_absent {
            return false;
        }
        let mut clear = f64::INFINITY;
        if phases.contact.is_some() {
            for (place, a) in particles.iter().enumerate() {
                for b in &particles[place + 1..] {
                    let gap = (a.position - b.position).norm() - (a.radius + b.radius);
                    let speed = (a.velocity - b.velocity).norm();
                    // Under drag of several rates the relative speed may grow for a while.
                    let speed = if phases.decay.is_some() && a.mass != b.mass {
                        a.velocity.norm() + b.velocity.norm()
                    } else {
                        speed
                    };
                    clear = clear.min(gap / speed);
                    if !(gap > 0.0) {
                        return false;
                    }
                }
            }
        }
        if let Some(cushions) = &phases.cushions {
            let half = cushions.half_extents();
            for particle in particles {
                for axis in 0..3 {
                    let room = half[axis] - particle.radius - particle.position[axis].abs();
                    if !(room > 0.0) {
                        return false;
                    }
                    let twice = if particle.velocity[axis] * particle.position[axis] < 0.0 {
                        room + 2.0 * particle.position[axis].abs()
                    } else {
                        room
                    };
                    clear = clear.min(twice / particle.velocity[axis].abs());
                }
            }
        }
        if let Some(rest) = phases.rest {
            for (particle, rate) in particles.iter().zip(self.flow.rates()) {
                let speed = particle.velocity.norm();
                if speed > 0.0 {
                    if speed < rest.speed {
                        return false;
                    }
                    if *rate > 0.0 {
                        clear = clear.min((speed / rest.speed).ln() / rate);
                    }
                }
            }
        }
        // A hair less, for the rounding of all that; NaN is not clear.
        self.clear = clear * (1.0 - 1e-9) - dt * 1e-9;
        self.clear >= dt
    }

    /// A step in which nothing is met and no force acts.
    #[inline]
    fn coast<O: Observer>(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut O,
    ) -> Taken {
        let before = if O::BOOKS {
            particles.to_vec()
        } else {
            Vec::new()
        };
        self.flow.coast(particles, dt);
        books::motion(phases, &before, particles, dt, observer);
        Taken::default()
    }

    /// A step from event to event.
    fn walk<O: Observer>(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut O,
    ) -> Taken {
        let mut spent = Spent::default();
        let mut left = dt;
        self.make_room(phases, particles, observer);
        while left > 0.0 {
            let wanted = self.wanted(phases, particles, dt, &spent);
            let mut length = if wanted < left { wanted } else { left };
            touching(phases, particles, &mut self.touches);
            self.end_low_bounces(particles, dt, observer);
            self.start.clear();
            self.start.extend_from_slice(particles);
            length = self.press_on(phases, particles, dt, length, &mut spent);
            spent.substeps += 1;
            let Some(next) = self.first(phases, particles, length, dt, &mut spent) else {
                self.book_motion(phases, particles, length, observer);
                left = if length >= left { 0.0 } else { left - length };
                self.stop_slow(phases, particles, left, observer);
                continue;
            };
            let went = self.go_to(phases, particles, dt, next, &mut spent);
            self.book_motion(phases, particles, went, observer);
            left = (left - went).max(0.0);
            self.meet(phases, particles, dt, next, left, &mut spent, observer);
        }
        spent.taken
    }

    /// Books a motion from the start of the step, pushes of walls included.
    fn book_motion<O: Observer>(
        &self,
        phases: &Phases,
        particles: &[Particle],
        length: f64,
        observer: &mut O,
    ) {
        if O::BOOKS && length > 0.0 {
            books::motion(phases, &self.start, particles, length, observer);
            let momentum = self.wall_push * length;
            let pushed = |sign: f64| Entry {
                energy: 0.0,
                momentum: momentum * sign,
            };
            // The motion was measured with the pushes in it.
            observer.book(Account::Integrator, pushed(-1.0));
            observer.book(Account::Cushions, pushed(1.0));
        }
    }

    /// Ends bounces that would not rise above what counts as touching.
    fn end_low_bounces(&self, particles: &mut [Particle], dt: f64, observer: &mut impl Observer) {
        let rate = |touch: &Touch| touch.rate(particles).abs();
        let is_low = |touch: &&Touch| rate(touch) <= touch.slowest_bounce(particles);
        let low = || self.touches.iter().filter(is_low);
        if low().any(|touch| rate(touch) > touch.still(particles, dt)) {
            let low: Vec<Touch> = low().copied().collect();
            stick::bring_to_rest(particles, &low, |account, entry| {
                observer.book(account, entry)
            });
        }
    }

    /// The longest step that the effects allow, longer when very many were taken already.
    fn wanted(&mut self, phases: &Phases, particles: &[Particle], dt: f64, spent: &Spent) -> f64 {
        if self.limits.are_absent {
            return f64::INFINITY;
        }
        let wanted = self.limits.length(phases, particles).max(dt * INSTANT);
        let grown = spent.substeps / SUBSTEPS;
        if grown == 0 {
            return wanted;
        }
        self.conceded.long_steps += 1;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_possible_wrap,
            reason = "small"
        )]
        let factor = 2.0_f64.powi(grown.min(1000) as i32);
        wanted * factor
    }

    /// Moves overlapping surfaces apart, unless there is no room for that.
    fn make_room<O: Observer>(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        observer: &mut O,
    ) {
        if self.jammed || (phases.contact.is_none() && phases.cushions.is_none()) {
            return;
        }
        touching(phases, particles, &mut self.touches);
        if self
            .touches
            .iter()
            .any(|touch| touch.gap < -4.0 * touch.near)
        {
            let potential = |particles: &[Particle]| {
                if O::BOOKS {
                    books::potential_energy(phases, particles)
                } else {
                    0.0
                }
            };
            let before = potential(particles);
            self.jammed = !overlap::separate(phases, particles);
            books::push_out(observer, before, potential(particles));
            self.conceded.jammed += u64::from(self.jammed);
        }
    }

    /// Takes the particles over a step of that length, or a shorter one, with the pushes of what
    /// stays in touch; gives the length taken.
    fn press_on(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        length: f64,
        spent: &mut Spent,
    ) -> f64 {
        let mut length = length;
        self.release();
        let resting = self.resting(particles, dt);
        loop {
            length = self.travel(phases, particles, length, spent);
            if resting.is_empty() || !self.press(phases, particles, &resting, length, spent) {
                return length;
            }
            let turn = resting
                .iter()
                .filter(|touch| self.is_pressed(touch))
                .map(|touch| {
                    let Some(b) = touch.b else { return 0.0 };
                    let reach = self.start[touch.a].radius + self.start[b].radius;
                    (self.start[touch.a].velocity - self.start[b].velocity).norm() / reach
                });
            let longest = TURN / turn.fold(0.0, f64::max);
            if length <= longest * 1.001 {
                return length;
            }
            length = longest;
            self.release();
            particles.clone_from_slice(&self.start);
        }
    }

    /// Takes all pushes away.
    fn release(&mut self) {
        self.pushes.fill(Vector3::zeros());
        self.wall_push = Vector3::zeros();
    }

    fn is_pressed(&self, touch: &Touch) -> bool {
        touch
            .arms()
            .any(|(body, _)| self.pushes[body] != Vector3::zeros())
    }

    /// The touches that neither approach nor part.
    fn resting(&self, particles: &[Particle], dt: f64) -> Vec<Touch> {
        let rests = |touch: &&Touch| touch.rate(particles).abs() <= touch.still(particles, dt);
        self.touches.iter().filter(rests).copied().collect()
    }

    /// Finds the pushes that keep the gaps of resting surfaces from shrinking over the step, and
    /// takes the step with them; whether any are needed.
    ///
    /// Equation: `l >= 0`, change of the gaps `g1 - g0 + B l >= 0`, one of the two zero for each.
    /// The push of a pair acts along its mean separation, as forces between bodies do, and so
    /// works `l (g1 - g0)`: nothing, also where surfaces slide and turn.
    fn press(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        resting: &[Touch],
        length: f64,
        spent: &mut Spent,
    ) -> bool {
        let mut sizes = vec![0.0; resting.len()];
        for round in 0..PUSH_ROUNDS {
            let ends: Vec<Touch> = resting
                .iter()
                .map(|touch| touch.mean(phases, &self.start, particles))
                .collect();
            let changes: Vec<f64> = resting
                .iter()
                .zip(&ends)
                .map(|(t, end)| end.gap - t.gap)
                .collect();
            let off = |((touch, change), size): ((&Touch, &f64), &f64)| {
                let rounding = touch.rounding();
                *change < -rounding || (*size > 0.0 && *change > rounding)
            };
            if !resting.iter().zip(&changes).zip(&sizes).any(off) {
                return round > 0;
            }
            let (flow, start) = (&self.flow, &self.start);
            let entry = |i: usize, j: usize| pressing(&ends[i], &ends[j], flow, start);
            let row = |i: usize| {
                (0..sizes.len())
                    .map(|j| entry(i, j) * sizes[j])
                    .sum::<f64>()
            };
            let free: Vec<f64> = changes
                .iter()
                .enumerate()
                .map(|(i, g)| g - row(i))
                .collect();
            sizes = pushes(&entry, &free, &vec![true; free.len()]);
            self.release();
            for (touch, size) in ends.iter().zip(&sizes) {
                if touch.b.is_none() {
                    self.wall_push += touch.normal * *size;
                }
                for (body, arm) in touch.arms() {
                    self.pushes[body] += arm * *size;
                }
            }
            particles.clone_from_slice(&self.start);
            self.try_travel(phases, particles, length, spent);
        }
        true
    }

    /// Takes the particles over a step, a shorter one if the forces find no end; gives its length.
    fn travel(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        length: f64,
        spent: &mut Spent,
    ) -> f64 {
        let mut length = length;
        for _ in 0..40 {
            if self.try_travel(phases, particles, length, spent) {
                return length;
            }
            particles.clone_from_slice(&self.start);
            length *= 0.5;
        }
        // Nothing that keeps the energy was found: the bodies go back the way they came, which
        // keeps it. Their centre of mass goes on.
        self.conceded.turned_back += 1;
        turn_back(particles);
        length
    }

    /// One attempt; whether the forces found the end of the step.
    fn try_travel(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        h: f64,
        spent: &mut Spent,
    ) -> bool {
        mean_force::set(phases, &self.start, particles, &self.pushes);
        self.flow.advance(particles, h);
        spent.taken.passes += u64::from(phases.forces);
        if self.limits.are_absent {
            return true;
        }
        let mut last = f64::INFINITY;
        for _ in 0..ROUNDS_MAX {
            self.before.clear();
            self.before.extend(particles.iter().map(|p| p.position));
            mean_force::set(phases, &self.start, particles, &self.pushes);
            for (particle, start) in particles.iter_mut().zip(&self.start) {
                (particle.position, particle.velocity) = (start.position, start.velocity);
            }
            self.flow.advance(particles, h);
            spent.taken.passes += 1;
            let (mut change, mut travel) = (0.0_f64, 0.0_f64);
            for ((particle, before), start) in particles.iter().zip(&self.before).zip(&self.start) {
                change = larger(change, (particle.position - before).norm());
                travel = larger(travel, (particle.position - start.position).norm());
            }
            if !change.is_finite() {
                return false;
            }
            // Down to rounding, where changes stop getting smaller.
            if change == 0.0
                || (change <= 1e-13 * travel && change >= 0.5 * last)
                || change <= 1e-16 * travel
            {
                return true;
            }
            if change > 1e-3 * travel && change >= last {
                return false;
            }
            last = change;
        }
        false
    }

    /// The first event on the way from the start of the step to where the particles are.
    fn first(
        &mut self,
        phases: &Phases,
        particles: &[Particle],
        length: f64,
        dt: f64,
        spent: &mut Spent,
    ) -> Option<Next> {
        if phases.contact.is_none() && phases.cushions.is_none() && phases.rest.is_none() {
            return None;
        }
        self.ways.clear();
        for (body, (start, end)) in self.start.iter().zip(particles).enumerate() {
            self.ways.push(self.flow.way(body, start, end, length));
        }
        self.travel.clear();
        self.travel
            .extend(self.ways.iter().map(|way| way.travel(length)));
        if !self.travel.iter().all(|travel| travel.is_finite()) {
            // Numbers beyond those of doubles meet nothing.
            return None;
        }
        let instant = INSTANT * dt;
        let still = |touch: &Touch| touch.rate(&self.start).abs() <= touch.still(&self.start, dt);
        let resting: Vec<EventKind> = self
            .touches
            .iter()
            .filter(|touch| still(touch))
            .map(|touch| touch.kind)
            .collect();
        let mut first: Option<Next> = None;
        let mut offer = |time: Option<f64>, kind: EventKind| {
            if let Some(time) = time
                && first.is_none_or(|first| time < first.time)
            {
                first = Some(Next { time, kind });
            }
        };
        if phases.contact.is_some() {
            spent.taken.pairs += pairs(self.ways.len() as u64);
            for a in 0..self.ways.len() {
                for b in a + 1..self.ways.len() {
                    let kind = EventKind::Contact { a, b };
                    if resting.is_empty() || !resting.contains(&kind) {
                        let pair = [a, b].map(|body| self.along(body));
                        offer(contact(&pair, length, instant), kind);
                    }
                }
            }
        }
        if let Some(cushions) = &phases.cushions {
            let half = cushions.half_extents();
            for body in 0..self.ways.len() {
                for wall in Wall::ALL {
                    let kind = EventKind::Cushion { body, wall };
                    if resting.is_empty() || !resting.contains(&kind) {
                        offer(
                            cushion(&self.along(body), wall, half, length, instant),
                            kind,
                        );
                    }
                }
            }
        }
        if let Some(rest) = phases.rest {
            for (body, way) in self.ways.iter().enumerate() {
                offer(slowed(way, rest.speed, length), EventKind::Rest { body });
            }
        }
        first
    }

    fn along(&self, body: usize) -> Along<'_, Flight> {
        Along {
            path: &self.ways[body],
            radius: self.start[body].radius,
            travel: self.travel[body],
        }
    }

    /// Takes the particles from the start of the step to an event; gives the time that takes.
    fn go_to(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        next: Next,
        spent: &mut Spent,
    ) -> f64 {
        let mut time = next.time;
        let refinements = if self.limits.are_absent {
            0
        } else {
            REFINEMENTS
        };
        for round in 0..=refinements {
            particles.clone_from_slice(&self.start);
            if time > 0.0 {
                time = self.press_on(phases, particles, dt, time, spent);
            }
            let touch = Touch::of(next.kind, phases, particles);
            let Some(touch) = touch.filter(|touch| touch.gap.abs() > 0.1 * touch.near) else {
                break;
            };
            let rate = touch.rate(particles);
            let better = time - touch.gap / rate;
            if round == refinements || rate >= 0.0 || !(better > 0.0 && better <= 2.0 * next.time) {
                break;
            }
            time = better;
        }
        time
    }

    /// Lets the event happen, and all others of the same instant with it.
    #[allow(clippy::too_many_arguments, reason = "one call, of one step")]
    fn meet(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        next: Next,
        left: f64,
        spent: &mut Spent,
        observer: &mut impl Observer,
    ) {
        spent.impacts += 1;
        touching(phases, particles, &mut self.touches);
        if self.touches.iter().all(|touch| touch.kind != next.kind) {
            self.touches.extend(Touch::of(next.kind, phases, particles));
        }
        if let EventKind::Rest { body } = next.kind {
            stop(&mut particles[body], body, left, observer);
        }
        let most = IMPACTS + IMPACTS_SHARED / (particles.len() as u64).max(1);
        if spent.impacts > most {
            self.conceded.cut_short += 1;
            for touch in &mut self.touches {
                touch.restitution = 0.0;
            }
        }
        let mut instant = Instant {
            particles,
            touches: &self.touches,
            rest: phases.rest,
            dt,
        };
        let settled = instant.settle(&mut |note| note.tell(left, observer));
        self.conceded.cut_short += u64::from(settled.cut_short);
    }

    /// Stops what became slower than the rest speed by forces that the search does not follow.
    fn stop_slow(
        &self,
        phases: &Phases,
        particles: &mut [Particle],
        left: f64,
        observer: &mut impl Observer,
    ) {
        let Some(rest) = phases.rest else { return };
        for (body, particle) in particles.iter_mut().enumerate() {
            let speed = particle.velocity.norm();
            if speed > 0.0 && speed < rest.speed {
                stop(particle, body, left, observer);
            }
        }
    }
}

/// `max` that does not pass over what is not a number.
fn larger(most: f64, value: f64) -> f64 {
    if value > most || value.is_nan() {
        value
    } else {
        most
    }
}

/// Turns velocities back, relative to that of the centre of mass.
fn turn_back(particles: &mut [Particle]) {
    let mass: f64 = particles.iter().map(|p| p.mass).sum();
    let momentum: Vector3 = particles.iter().map(|p| p.velocity * p.mass).sum();
    for particle in particles {
        particle.velocity = momentum * (2.0 / mass) - particle.velocity;
    }
}

/// What a unit push at one touch over the step does to the gap of another at its end.
fn pressing(one: &Touch, other: &Touch, flow: &Flow, particles: &[Particle]) -> f64 {
    if flow.is_coupled() {
        let all = one.arms().flat_map(|(body, arm)| {
            other
                .arms()
                .map(move |(theirs, push)| (body, arm, theirs, push))
        });
        return all
            .map(|(body, arm, theirs, push)| {
                arm.dot(&push) * flow.mobility(body, theirs, particles)
            })
            .sum();
    }
    coupling(one, other, &|body| flow.mobility(body, body, particles))
}
