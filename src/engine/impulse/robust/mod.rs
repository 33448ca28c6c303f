//! The top of the ladder: a scheme that survives every scene, and says where it had to give way.
//!
//! Between impacts bodies move in closed form under drag, dampers and gravity ([`flow`]); forces
//! between bodies are constant over a step and keep the energy exactly, whatever its length
//! ([`mean_force`]), and steps are as short as each effect asks for ([`limits`]). Impacts are
//! found on the way, and all of one instant are solved together ([`together`]). Surfaces that
//! stay in touch press on each other with forces that are solved together too ([`press`]), and
//! bounces that lose and would lift less than 1e-6 of a radius end. Spheres that overlap at the
//! start are moved apart once ([`overlap`]). Its work is counted, and bounded ([`work`]): what
//! cannot be paid is given up, and said to be.

mod clear;
mod flow;
mod limits;
mod mean_force;
mod neighbours;
mod overlap;
pub(super) mod plan;
mod press;
mod search;
mod stick;
mod together;
mod touch;
mod work;

use super::handling::Taken;
use super::observer::Observer;
use super::phases::Phases;
use super::scheme::Scheme;
use super::sweep::stop;
use super::{Particle, books};
use crate::physics::Vector3;
use crate::recording::{Account, Concession, ConcessionKind, Entry, EventKind};
use crate::scene::Scene;
use flow::Flow;
use limits::Limits;
use neighbours::Neighbours;
use search::{Counted, Next};
use together::Instant;
use touch::{Touch, touching};
use work::Work;

/// Operations to move a body freely.
const OPERATIONS_A_MOTION: u64 = 10;
/// Operations for a body between two events, beside its motions and searches.
const OPERATIONS_AN_EVENT: u64 = 40;
/// Operations to see how fast a pair passes.
const OPERATIONS_A_LIMIT: u64 = 30;
/// Share of a step below which two instants are one.
const INSTANT: f64 = 1e-13;

/// The scheme `robust` on one scene.
#[derive(Debug, Clone)]
pub struct Robust {
    flow: Flow,
    limits: Limits,
    start: Vec<Particle>,
    before: Vec<Vector3>,
    ways: Vec<Counted>,
    travel: Vec<f64>,
    touches: Vec<Touch>,
    neighbours: Neighbours,
    /// Forces between surfaces in touch. Shape: `[body]`.
    pushes: Vec<Vector3>,
    /// Those of walls, summed.
    wall_push: Vector3,
    /// For so long nothing can meet, s.
    clear: f64,
    /// Whether overlaps could not be resolved.
    jammed: bool,
    work: Work,
    conceded: Conceded,
}

/// How often what was given up.
#[derive(Debug, Clone, Copy, Default)]
struct Conceded {
    long_steps: u64,
    turned_back: u64,
    cut_short: u64,
    jammed: u64,
    loose: u64,
}

impl Scheme for Robust {
    fn of(scene: &Scene, phases: &Phases, particles: &[Particle], step: f64) -> Self {
        let limits = Limits::of(phases, particles);
        let steps = scene.duration / step;
        Self {
            flow: Flow::of(scene, &phases.springs),
            limits,
            start: Vec::new(),
            before: Vec::new(),
            ways: Vec::new(),
            travel: Vec::new(),
            touches: Vec::new(),
            neighbours: Neighbours::default(),
            pushes: vec![Vector3::zeros(); particles.len()],
            wall_push: Vector3::zeros(),
            clear: 0.0,
            jammed: false,
            work: Work::of(
                particles.len(),
                steps,
                phases.forces_a_pass(particles.len() as u64),
                !limits.are_absent,
            ),
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
        self.work.begin();
        if self.clear >= dt || self.becomes_clear(phases, particles, dt) {
            self.clear -= dt;
            return self.coast(phases, particles, dt, observer);
        }
        self.walk(phases, particles, dt, observer)
    }

    fn limit(&mut self, budget: u64) {
        self.work.limit(budget);
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
            loose,
        } = self.conceded;
        let counts = [
            (ConcessionKind::LongStep, long_steps),
            (ConcessionKind::TurnedBack, turned_back),
            (ConcessionKind::CutShort, cut_short),
            (ConcessionKind::Jammed, jammed),
            (ConcessionKind::Loose, loose),
        ];
        let made = counts.into_iter().filter(|(_, count)| *count > 0);
        made.map(|(kind, count)| Concession { kind, count })
            .collect()
    }
}

impl Robust {
    /// A step in which nothing is met and no force acts.
    #[inline]
    fn coast<O: Observer>(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut O,
    ) -> Taken {
        let before = books::kept::<O>(particles);
        self.flow.coast(particles, dt);
        books::motion(phases, &before, particles, dt, observer);
        self.work.count_bodies(OPERATIONS_A_MOTION);
        self.work.taken()
    }

    /// A step from event to event.
    fn walk<O: Observer>(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut O,
    ) -> Taken {
        self.work.begin_step();
        let mut left = dt;
        self.make_room(phases, particles, observer);
        while left > 0.0 && !self.work.is_spent() {
            self.work.count_bodies(OPERATIONS_AN_EVENT);
            let wanted = self.wanted(phases, particles, dt);
            let mut length = if wanted < left { wanted } else { left };
            self.find_touching(phases, particles);
            self.end_low_bounces(particles, dt, observer);
            self.start.clear();
            self.start.extend_from_slice(particles);
            let turned_back = self.conceded.turned_back;
            length = self.press_on(phases, particles, dt, length);
            // Bodies that turned back did not move, and meet nothing.
            let next = if self.conceded.turned_back == turned_back {
                self.first(phases, particles, length, dt)
            } else {
                None
            };
            self.unload(particles);
            let Some(next) = next else {
                self.book_motion(phases, particles, length, observer);
                left = if length >= left { 0.0 } else { left - length };
                Self::stop_slow(phases, particles, left, observer);
                continue;
            };
            let went = self.go_to(phases, particles, dt, next);
            self.unload(particles);
            self.book_motion(phases, particles, went, observer);
            left = (left - went).max(0.0);
            self.work.charge_event(went, left);
            self.meet(phases, particles, dt, next, left, observer);
        }
        self.work.taken()
    }

    /// Finds what touches, wherever it goes.
    fn find_touching(&mut self, phases: &Phases, particles: &[Particle]) {
        let (neighbours, touches) = (&mut self.neighbours, &mut self.touches);
        touching(phases, particles, neighbours, touches, &mut self.work.meter);
    }

    /// Takes the pushes out of the forces: what is left says how hard bodies are pulled together.
    fn unload(&self, particles: &mut [Particle]) {
        for (particle, push) in particles.iter_mut().zip(&self.pushes) {
            particle.force -= push;
        }
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
    fn end_low_bounces(
        &mut self,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut impl Observer,
    ) {
        let rate = |touch: &Touch| touch.rate(particles).abs();
        let is_low = |touch: &&Touch| rate(touch) <= touch.slowest_bounce(particles);
        let low = || self.touches.iter().filter(is_low);
        if low().any(|touch| rate(touch) > touch.still(particles, dt)) {
            let low: Vec<Touch> = low().copied().collect();
            let meter = &mut self.work.meter;
            stick::bring_to_rest(particles, &low, meter, |account, entry| {
                observer.book(account, entry);
            });
        }
    }

    /// The longest step that the effects allow, or that the work allowed does.
    fn wanted(&mut self, phases: &Phases, particles: &[Particle], dt: f64) -> f64 {
        if self.limits.are_absent {
            return f64::INFINITY;
        }
        let wanted = self.limits.length(phases, particles);
        if phases.attraction.is_some() {
            self.work.count_pairs(OPERATIONS_A_LIMIT);
        }
        let shortest = self.shortest(dt);
        if wanted >= shortest {
            return wanted;
        }
        self.conceded.long_steps += 1;
        self.work.charge_long_step();
        shortest
    }

    /// The shortest substep that the work allowed pays.
    fn shortest(&self, dt: f64) -> f64 {
        // Springs ask for the same all along: where it cannot be paid, nothing is won by less.
        if self.work.cannot_pay(self.limits.springs, dt) {
            dt
        } else {
            self.work.shortest(dt)
        }
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
        self.find_touching(phases, particles);
        if self
            .touches
            .iter()
            .any(|touch| touch.gap < -4.0 * touch.near)
        {
            books::pushing_out(phases, particles, observer, |particles, _| {
                self.jammed = !overlap::separate(phases, particles, &mut self.work.meter);
            });
            self.conceded.jammed += u64::from(self.jammed);
        }
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
        observer: &mut impl Observer,
    ) {
        self.find_touching(phases, particles);
        if self.touches.iter().all(|touch| touch.kind != next.kind) {
            self.touches.extend(Touch::of(next.kind, phases, particles));
        }
        if let EventKind::Rest { body } = next.kind {
            stop(&mut particles[body], body, left, observer);
        }
        if self.work.bounces_no_more() {
            self.conceded.cut_short += 1;
            for touch in &mut self.touches {
                touch.restitution = 0.0;
            }
        }
        let before = self.work.meter.done();
        let mut instant = Instant {
            particles,
            touches: &self.touches,
            rest: phases.rest,
            dt,
            meter: &mut self.work.meter,
        };
        let settled = instant.settle(&mut |note| note.tell(left, observer));
        self.work.charge_rounds(settled.rounds, before);
        self.conceded.cut_short += u64::from(settled.cut_short);
    }

    /// Stops what became slower than the rest speed by forces that the search does not follow.
    fn stop_slow(
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
