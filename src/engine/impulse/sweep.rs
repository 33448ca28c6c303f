//! Impacts, cushions and rests at the time at which they happen within a step.

use super::contacts::hit;
use super::handling::{Handling, Taken, pairs};
use super::meeting::{Along, contact, cushion, slowed};
use super::motion::Motion;
use super::observer::Observer;
use super::path::{Path, Way};
use super::phases::Phases;
use super::{Particle, books, cushions};
use crate::physics::{Vector3, length};
use crate::recording::{Account, EventKind, Wall};

/// Impacts in one step, a body, after which what is left of it is dealt with by overlap: bounces
/// that pile up, as on a floor, have no end.
const IMPACTS_A_BODY: usize = 10;

/// Looks at pairs in one step after which the same holds: every impact looks at all pairs anew, so
/// that the impacts of a crowd in one step would cost its number cubed. Ninety bodies are not
/// bound by this; a thousand have eight impacts in a step.
const LOOKS_A_STEP: usize = 4_000_000;

/// Share of a step below which two instants are one.
const INSTANT: f64 = 1e-13;

/// Each step goes to the first event on its path, and on from there.
///
/// The paths are cubics through both ends of the step; at the event the integrator takes a step
/// of just that length, so that its order holds through impacts up to 4.
#[derive(Debug, Clone, Default)]
pub struct Sweep {
    start: Vec<Particle>,
    paths: Vec<Path>,
    travel: Vec<f64>,
}

/// What comes first.
#[derive(Debug, Clone, Copy)]
struct Next {
    time: f64,
    kind: EventKind,
}

impl Handling for Sweep {
    fn step<O: Observer>(
        &mut self,
        motion: &mut impl Motion,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        observer: &mut O,
    ) -> Taken {
        let mut taken = Taken::default();
        let mut left = dt;
        let mut impacts = most_impacts(particles.len());
        while left > 0.0 {
            let length = motion.length(left);
            self.start.clear();
            self.start.extend_from_slice(particles);
            taken.passes += motion.advance(phases, particles, length);
            if motion.is_rejected() {
                particles.clone_from_slice(&self.start);
                motion.forget();
                continue;
            }
            self.follow(phases, particles, length);
            if phases.contact.is_some() {
                taken.pairs += pairs(particles.len() as u64);
            }
            let Some(next) = self.first(phases, length, INSTANT * dt) else {
                books::motion(phases, &self.start, particles, length, observer);
                left -= length;
                continue;
            };
            if impacts == 0 {
                books::motion(phases, &self.start, particles, length, observer);
                phases.settle::<true, O>(particles, observer);
                motion.forget();
                left -= length;
                continue;
            }
            impacts -= 1;
            particles.clone_from_slice(&self.start);
            motion.forget();
            if next.time > 0.0 {
                taken.passes += motion.advance(phases, particles, next.time);
                books::motion(phases, &self.start, particles, next.time, observer);
                left -= next.time;
            }
            happen(next.kind, phases, particles, left, observer);
        }
        taken
    }
}

/// How many impacts of these bodies a step follows to their time.
fn most_impacts(bodies: usize) -> usize {
    let pairs = (bodies * bodies.saturating_sub(1) / 2).max(1);
    (IMPACTS_A_BODY * bodies).min((LOOKS_A_STEP / pairs).max(1))
}

impl Sweep {
    /// The paths from the start of the step to where the particles are now.
    fn follow(&mut self, phases: &Phases, particles: &[Particle], length: f64) {
        let ends = self.start.iter().zip(particles);
        self.paths.clear();
        self.paths.extend(ends.map(|(start, end)| {
            if phases.bends {
                Path::between(start, end, length)
            } else {
                Path::straight(start, length)
            }
        }));
        self.travel.clear();
        self.travel
            .extend(self.paths.iter().map(|path| path.travel(length)));
    }

    fn along(&self, body: usize) -> Along<'_, Path> {
        Along {
            path: &self.paths[body],
            radius: self.start[body].radius,
            travel: self.travel[body],
        }
    }

    /// The first event on the paths; of simultaneous ones contacts, then cushions, then rests.
    fn first(&self, phases: &Phases, length: f64, instant: f64) -> Option<Next> {
        if !self.travel.iter().all(|travel| travel.is_finite()) {
            // Numbers beyond those of doubles meet nothing.
            return None;
        }
        let mut first: Option<Next> = None;
        let mut offer = |time: Option<f64>, kind: EventKind| {
            if let Some(time) = time
                && first.is_none_or(|first| time < first.time - instant)
            {
                first = Some(Next { time, kind });
            }
        };
        if phases.contact.is_some() {
            for a in 0..self.paths.len() {
                for b in a + 1..self.paths.len() {
                    let pair = [a, b].map(|body| self.along(body));
                    let time = contact(&pair, length, instant);
                    offer(time, EventKind::Contact { a, b });
                }
            }
        }
        if let Some(cushions) = &phases.cushions {
            let half = cushions.half_extents();
            for body in 0..self.paths.len() {
                for wall in Wall::ALL {
                    let time = cushion(&self.along(body), wall, half, length, instant);
                    offer(time, EventKind::Cushion { body, wall });
                }
            }
        }
        if let Some(rest) = phases.rest {
            for (body, path) in self.paths.iter().enumerate() {
                offer(slowed(path, rest.speed, length), EventKind::Rest { body });
            }
        }
        first
    }
}

/// Lets an event happen to the particles, `left` before the end of the step.
fn happen<O: Observer>(
    kind: EventKind,
    phases: &Phases,
    particles: &mut [Particle],
    left: f64,
    observer: &mut O,
) {
    match kind {
        EventKind::Contact { a, b } => {
            let Some(contact) = phases.contact else {
                return;
            };
            let (head, tail) = particles.split_at_mut(b);
            let (one, other) = (&mut head[a], &mut tail[0]);
            if let Some(impulse) = hit(one, other, contact.restitution) {
                observer.note_before_end(kind, impulse, left);
                let masses = [one.mass, other.mass];
                let entry = books::contact(contact.restitution, masses, impulse);
                observer.book(Account::Contacts, entry);
            }
        }
        EventKind::Cushion { body, wall } => {
            let Some(cushions) = phases.cushions else {
                return;
            };
            let (axis, side) = wall.axis_and_side();
            let (particle, e) = (&mut particles[body], cushions.restitution);
            if let Some(impulse) = cushions::mirror(particle, axis, side, e) {
                observer.note_before_end(kind, impulse, left);
                let entry = books::cushion(e, particle.mass, impulse, &cushions::inward(wall));
                observer.book(Account::Cushions, entry);
            }
        }
        EventKind::Rest { body } => stop(&mut particles[body], body, left, observer),
    }
    let Some(rest) = phases.rest else { return };
    let (first, second) = kind.bodies();
    for body in std::iter::once(first).chain(second) {
        let speed = length(&particles[body].velocity);
        if speed > 0.0 && speed < rest.speed {
            stop(&mut particles[body], body, left, observer);
        }
    }
}

/// Stops a body, `left` before the end of the step.
pub(super) fn stop(particle: &mut Particle, body: usize, left: f64, observer: &mut impl Observer) {
    let impulse = particle.mass * length(&particle.velocity);
    observer.note_before_end(EventKind::Rest { body }, impulse, left);
    observer.book(
        Account::Rest,
        books::rest(particle.mass, &particle.velocity),
    );
    particle.velocity = Vector3::zeros();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten impacts a body, fewer where their pairs are too many to look at.
    #[test]
    fn impacts_are_followed_as_far_as_pairs_can_be_looked_at() {
        for (bodies, most) in [
            (1, 10),
            (2, 20),
            (90, 900),
            (200, 201),
            (1000, 8),
            (10_000, 1),
        ] {
            assert_eq!(most_impacts(bodies), most, "{bodies}");
        }
    }
}
