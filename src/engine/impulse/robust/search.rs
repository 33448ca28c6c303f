//! What a step meets first, and the way there.

use std::cell::Cell;

use super::flow::Flight;
use super::touch::Touch;
use super::{INSTANT, Robust};
use crate::engine::impulse::Particle;
use crate::engine::impulse::meeting::{Along, contact, cushion, slowed};
use crate::engine::impulse::path::Way;
use crate::engine::impulse::phases::Phases;
use crate::physics::Vector3;
use crate::recording::{EventKind, Wall};

/// Corrections of the time of an impact under forces that depend on places.
const REFINEMENTS: u32 = 4;

/// Operations to lay the way of a body and to see that it meets no wall.
const OPERATIONS_A_WAY: u64 = 100;

/// What comes first in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Next {
    pub(super) time: f64,
    pub(super) kind: EventKind,
}

/// A way that counts how often it is looked at: what a search costs.
#[derive(Debug, Clone)]
pub(super) struct Counted {
    flight: Flight,
    looks: Cell<u64>,
}

impl Way for Counted {
    #[inline]
    fn start(&self) -> &Vector3 {
        self.flight.start()
    }

    #[inline]
    fn at(&self, t: f64) -> (Vector3, Vector3) {
        self.looks.set(self.looks.get() + 1);
        self.flight.at(t)
    }

    fn bend_against(&self, other: &Self) -> f64 {
        self.flight.bend_against(&other.flight)
    }

    fn bend_along(&self, axis: usize) -> f64 {
        self.flight.bend_along(axis)
    }

    fn travel(&self, time: f64) -> f64 {
        self.flight.travel(time)
    }
}

impl Robust {
    /// The first event on the way from the start of the step to where the particles are.
    pub(super) fn first(
        &mut self,
        phases: &Phases,
        particles: &[Particle],
        length: f64,
        dt: f64,
    ) -> Option<Next> {
        let nothing =
            phases.contact.is_none() && phases.cushions.is_none() && phases.rest.is_none();
        if nothing || self.work.meets_no_more() {
            return None;
        }
        if self.work.stands_still() {
            self.conceded.cut_short += 1;
            return None;
        }
        if !self.find_ways(particles, length) {
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
        // Later ones than the first so far are of no interest.
        let mut until = length;
        let mut offer = |time: Option<f64>, kind: EventKind| {
            if let Some(time) = time
                && first.is_none_or(|first| time < first.time)
            {
                first = Some(Next { time, kind });
                return time;
            }
            first.map_or(length, |first| first.time)
        };
        if phases.contact.is_some() {
            let travel = self.travel.iter().copied().fold(0.0, f64::max);
            let mut neighbours = std::mem::take(&mut self.neighbours);
            let near = neighbours.within(&self.start, 2.0 * travel, &mut self.work.meter);
            self.work.charge_pairs(near.len() as u64);
            for [a, b] in near {
                let kind = EventKind::Contact { a: *a, b: *b };
                if resting.is_empty() || !resting.contains(&kind) {
                    let pair = [*a, *b].map(|body| self.along(body));
                    until = offer(contact(&pair, until, instant), kind);
                }
            }
            self.neighbours = neighbours;
        }
        if let Some(cushions) = &phases.cushions {
            let half = cushions.half_extents();
            for body in 0..self.ways.len() {
                for wall in Wall::ALL {
                    let kind = EventKind::Cushion { body, wall };
                    if resting.is_empty() || !resting.contains(&kind) {
                        let met = cushion(&self.along(body), wall, half, until, instant);
                        until = offer(met, kind);
                    }
                }
            }
        }
        if let Some(rest) = phases.rest {
            for (body, way) in self.ways.iter().enumerate() {
                until = offer(slowed(way, rest.speed, until), EventKind::Rest { body });
            }
        }
        self.work.count_bodies(OPERATIONS_A_WAY);
        let looks = self.ways.iter().map(|way| way.looks.get()).sum();
        self.work.charge_looks(looks);
        first
    }

    /// The ways of all bodies from the start of the step to where the particles are; whether they
    /// are finite. Numbers beyond those of doubles meet nothing.
    fn find_ways(&mut self, particles: &[Particle], length: f64) -> bool {
        self.ways.clear();
        for (body, (start, end)) in self.start.iter().zip(particles).enumerate() {
            self.ways.push(Counted {
                flight: self.flow.way(body, start, end, length),
                looks: Cell::new(0),
            });
        }
        self.travel.clear();
        self.travel
            .extend(self.ways.iter().map(|way| way.travel(length)));
        self.travel.iter().all(|travel| travel.is_finite())
    }

    fn along(&self, body: usize) -> Along<'_, Counted> {
        Along {
            path: &self.ways[body],
            radius: self.start[body].radius,
            travel: self.travel[body],
        }
    }

    /// Takes the particles from the start of the step to an event; gives the time that takes.
    pub(super) fn go_to(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        next: Next,
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
                time = self.press_on(phases, particles, dt, time);
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
}
