//! Impacts at one instant, solved together: no order among them decides.

use super::super::observer::Observer;
use super::super::{Particle, books};
use super::touch::Touch;
use crate::physics::complementarity::pushes;
use crate::physics::{Meter, Vector3};
use crate::recording::{Account, Entry, EventKind};
use crate::scene::Rest;

/// Reflections after which what still approaches is brought to rest. Without loss they end by
/// themselves, in fewer than this.
const REFLECTIONS_MAX: u32 = 2000;
/// Approach slower than this share of the first is brought to rest, where restitution loses …
const SPENT: f64 = 1e-9;
/// … and any after so many reflections: in a dense heap they would go on long, and lose the rest.
const LOSING_MAX: u32 = 100;
/// Stops after which a body counts as standing for the rest of the instant.
const STOPS_MAX: u32 = 20;

/// Operations of a round for a touch and for a body.
const OPERATIONS_A_TOUCH: u64 = 40;
/// Operations for an entry of the matrix of touches.
pub(super) const OPERATIONS_AN_ENTRY: u64 = 10;

/// The bodies and touches of an instant.
pub(super) struct Instant<'a> {
    pub(super) particles: &'a mut [Particle],
    pub(super) touches: &'a [Touch],
    pub(super) rest: Option<Rest>,
    /// The step of the scene, s.
    pub(super) dt: f64,
    /// Counts the work; once it is spent, nothing is solved any more.
    pub(super) meter: &'a mut Meter,
}

/// An impact or a stop that happened.
pub(super) struct Note {
    kind: EventKind,
    impulse: f64,
    entry: Entry,
}

impl Note {
    /// Tells an observer, so much time before the end of the step.
    pub(super) fn tell(&self, left: f64, observer: &mut impl Observer) {
        observer.note_before_end(self.kind, self.impulse, left);
        observer.book(account(self.kind), self.entry);
    }
}

/// Whom an event is booked with.
pub(super) fn account(kind: EventKind) -> Account {
    match kind {
        EventKind::Contact { .. } => Account::Contacts,
        EventKind::Cushion { .. } => Account::Cushions,
        EventKind::Rest { .. } => Account::Rest,
    }
}

/// What an impulse at a touch takes and gives, `before` being the rate that it met.
///
/// Equation: the work of an impulse is its size times the mean of the rates before and after, and
/// that adds up over simultaneous impulses.
pub(super) fn work(touch: &Touch, impulse: f64, before: f64, particles: &[Particle]) -> Entry {
    let momentum = if touch.b.is_none() {
        touch.normal * impulse
    } else {
        Vector3::zeros()
    };
    Entry {
        energy: 0.5 * impulse * (before + touch.rate(particles)),
        momentum,
    }
}

/// What was not done by the law of impact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Settled {
    /// Whether endless impacts were cut short.
    pub(super) cut_short: bool,
    /// Rounds of reflections.
    pub(super) rounds: u64,
}

impl Instant<'_> {
    /// Lets everything that approaches bounce, until nothing does.
    ///
    /// Each round takes the touches that approach, finds the impulses `l >= 0` that would just
    /// bring them to rest (rates `A l + u >= 0`, one of the two zero for each), and gives
    /// `(1 + e) l`: the reflection of the velocities at the wall of the cone that they violate.
    /// With one e, `dE = -(1 - e²)/2 l.A l`, never above zero. Momentum is exact in pairs, and
    /// nothing depends on the order of the bodies.
    /// Source: Smith, Kaufman, Vouga, Tamstorf, Grinspun 2012, "Reflections on Simultaneous
    /// Impact", section 6.
    pub(super) fn settle(&mut self, note: &mut dyn FnMut(&Note)) -> Settled {
        let mut settled = Settled::default();
        let mut stops = vec![0; self.stopped_len()];
        let mut first = 0.0_f64;
        for round in 0.. {
            let touched = (self.touches.len() + self.particles.len()) as u64;
            self.meter.add(OPERATIONS_A_TOUCH * touched);
            if self.meter.is_spent() {
                break;
            }
            let inverse = self.inverse_masses(&stops);
            let violated: Vec<(Touch, f64)> = self
                .touches
                .iter()
                .map(|touch| (*touch, touch.rate(self.particles)))
                .filter(|(touch, rate)| *rate < -touch.still(self.particles, self.dt))
                .collect();
            if violated.is_empty() {
                if self.stop_slow(&mut stops, note) {
                    continue;
                }
                break;
            }
            settled.rounds += 1;
            let worst = violated
                .iter()
                .fold(0.0_f64, |most, (_, rate)| most.max(-rate));
            first = first.max(worst);
            let es = violated
                .iter()
                .map(|(touch, _)| restitution(touch, self.particles));
            let (least, most) = es.fold((1.0_f64, 0.0_f64), |(least, most), e| {
                (least.min(e), most.max(e))
            });
            // Where nothing bounces, one solution for all touches is the end of it.
            let loses = least < 1.0 && (worst <= SPENT * first || round >= LOSING_MAX);
            let spent = most == 0.0 || loses;
            if round >= REFLECTIONS_MAX || spent {
                settled.cut_short |= most > 0.0 && worst > SPENT * first;
                let all: Vec<(Touch, f64)> = self
                    .touches
                    .iter()
                    .map(|touch| (*touch, touch.rate(self.particles)))
                    .collect();
                self.bounce(&all, &inverse, |_, _| 0.0, note);
                if !self.stop_slow(&mut stops, note) {
                    break;
                }
                continue;
            }
            self.bounce(&violated, &inverse, restitution, note);
            if self.rest.is_some() {
                self.stop_slow(&mut stops, note);
            }
        }
        settled
    }

    fn stopped_len(&self) -> usize {
        if self.rest.is_some() {
            self.particles.len()
        } else {
            0
        }
    }

    /// 1/m, nothing for a body that stands. Shape: `[body]`, none without stops.
    fn inverse_masses(&self, stops: &[u32]) -> Vec<f64> {
        let places = stops.iter().zip(self.particles.iter());
        places
            .map(|(stops, particle)| {
                if *stops < STOPS_MAX {
                    1.0 / particle.mass
                } else {
                    0.0
                }
            })
            .collect()
    }

    /// One reflection of these touches, with their rates.
    fn bounce(
        &mut self,
        violated: &[(Touch, f64)],
        inverse: &[f64],
        restitution: impl Fn(&Touch, &[Particle]) -> f64,
        note: &mut dyn FnMut(&Note),
    ) {
        let particles = &*self.particles;
        let inverse = |body: usize| {
            inverse
                .get(body)
                .copied()
                .unwrap_or(1.0 / particles[body].mass)
        };
        let count = violated.len() as u64;
        // A matrix, and up to three times the energy by it.
        self.meter.add((OPERATIONS_AN_ENTRY + 6) * count * count);
        let matrix = square(violated, |one, other| coupling(&one.0, &other.0, &inverse));
        let entry = |i: usize, j: usize| matrix[i * violated.len() + j];
        let rates: Vec<f64> = violated.iter().map(|(_, rate)| *rate).collect();
        let stopping = match rates.as_slice() {
            [rate] => vec![(-rate / entry(0, 0)).max(0.0)],
            _ => pushes(&entry, &rates, &vec![true; rates.len()], self.meter),
        };
        let es: Vec<f64> = violated
            .iter()
            .map(|(touch, _)| restitution(touch, particles))
            .collect();
        let impulses = reflected(&stopping, &es, &rates, &entry);
        let struck: Vec<(&Touch, f64, f64)> = violated
            .iter()
            .zip(impulses)
            .filter(|(_, impulse)| *impulse > 0.0 && impulse.is_finite())
            .map(|((touch, rate), impulse)| (touch, *rate, impulse))
            .collect();
        let changes: Vec<(usize, Vector3)> = struck
            .iter()
            .flat_map(|(touch, _, impulse)| {
                touch.arms().map(move |(body, arm)| (body, arm * *impulse))
            })
            .map(|(body, push)| (body, push * inverse(body)))
            .collect();
        let stands = |body: usize| inverse(body) == 0.0;
        let stands: Vec<Vec<bool>> = struck
            .iter()
            .map(|(touch, ..)| touch.arms().map(|(body, _)| stands(body)).collect())
            .collect();
        for (body, change) in changes {
            self.particles[body].velocity += change;
        }
        for ((touch, rate, impulse), stands) in struck.into_iter().zip(stands) {
            let mut entry = work(touch, impulse, rate, self.particles);
            // Nothing for a pair, unless one of them stands.
            let moved = touch.arms().zip(stands);
            entry.momentum = moved
                .filter(|(_, stands)| !stands)
                .map(|((_, arm), _)| arm * impulse)
                .sum();
            note(&Note {
                kind: touch.kind,
                impulse,
                entry,
            });
        }
    }

    /// Stops every touching body that is slower than the rest speed; whether any was.
    fn stop_slow(&mut self, stops: &mut [u32], note: &mut dyn FnMut(&Note)) -> bool {
        let Some(rest) = self.rest else { return false };
        let mut any = false;
        for touch in self.touches {
            for (body, _) in touch.arms() {
                let particle = &mut self.particles[body];
                let speed = particle.velocity.norm();
                if speed > 0.0 && speed < rest.speed {
                    note(&Note {
                        kind: EventKind::Rest { body },
                        impulse: particle.mass * speed,
                        entry: books::rest(particle.mass, &particle.velocity),
                    });
                    particle.velocity = Vector3::zeros();
                    stops[body] += 1;
                    any = true;
                }
            }
        }
        any
    }
}

/// The restitution of a touch that approaches: nothing where the bounce would not show.
fn restitution(touch: &Touch, particles: &[Particle]) -> f64 {
    if touch.restitution < 1.0 && -touch.rate(particles) < touch.slowest_bounce(particles) {
        0.0
    } else {
        touch.restitution
    }
}

/// Entry of A: what a unit impulse at one touch does to the rate of the other.
pub(super) fn coupling(one: &Touch, other: &Touch, inverse: &impl Fn(usize) -> f64) -> f64 {
    if !one.shares_a_body(other) {
        return 0.0;
    }
    let shared = one.arms().flat_map(|(body, arm)| {
        let same = other.arms().filter(move |(theirs, _)| *theirs == body);
        same.map(move |(_, theirs)| arm.dot(&theirs) * inverse(body))
    });
    shared.sum()
}

/// A symmetric matrix over touches, row after row.
pub(super) fn square<T>(touches: &[T], entry: impl Fn(&T, &T) -> f64) -> Vec<f64> {
    let count = touches.len();
    let mut matrix = vec![0.0; count * count];
    for i in 0..count {
        for j in i..count {
            let value = entry(&touches[i], &touches[j]);
            (matrix[i * count + j], matrix[j * count + i]) = (value, value);
        }
    }
    matrix
}

/// `(1 + e) l`, made to lose exactly `(1 - e²)/2 l.A l` whatever the rounding of l.
///
/// Where the touches have several e, theirs are used only if that gains no energy; else the
/// smallest for all.
fn reflected(
    stopping: &[f64],
    es: &[f64],
    rates: &[f64],
    entry: &impl Fn(usize, usize) -> f64,
) -> Vec<f64> {
    let quadratic = |l: &[f64]| -> f64 {
        let row = |i: usize| (0..l.len()).map(|j| entry(i, j) * l[j]).sum::<f64>();
        (0..l.len())
            .filter(|i| l[*i] != 0.0)
            .map(|i| l[i] * row(i))
            .sum()
    };
    let linear = |l: &[f64]| -> f64 { l.iter().zip(rates).map(|(l, u)| l * u).sum() };
    let size = quadratic(stopping);
    let scale = if size > 0.0 {
        -linear(stopping) / size
    } else {
        0.0
    };
    let least = es.iter().copied().fold(f64::INFINITY, f64::min);
    let with = |e: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let indexed = stopping.iter().enumerate();
        indexed.map(|(i, l)| (1.0 + e(i)) * scale * l).collect()
    };
    let own = with(&|i| es[i]);
    if es.iter().all(|e| *e == least) || linear(&own) + 0.5 * quadratic(&own) <= 0.0 {
        own
    } else {
        with(&|_| least)
    }
}

#[cfg(test)]
mod tests {
    use super::super::touch::tests::{Sphere, start};
    use super::*;

    /// Settles the touches of the start; gives the spheres and what that came to.
    fn settled(spheres: &[Sphere], effects: &str, pull: f64) -> (Vec<Particle>, Settled, usize) {
        let (phases, mut particles, touches) = start(spheres, effects);
        for particle in &mut particles {
            particle.force = Vector3::y() * (-pull * particle.mass);
        }
        let mut instant = Instant {
            particles: &mut particles,
            touches: &touches,
            rest: phases.rest,
            dt: 1.0,
            meter: &mut Meter::default(),
        };
        let mut notes = 0;
        let settled = instant.settle(&mut |_| notes += 1);
        (particles, settled, notes)
    }

    /// A ball that fills the gap between two walls keeps `e^n` of its speed after n rounds. With
    /// e = 1/2 that is spent after 30, `2^-30 < 1e-9`; with 0.9 it goes on for as many rounds as
    /// impacts that lose may, without loss for as many as any may, and both are cut short.
    #[test]
    fn a_ball_between_two_walls_at_once_ends_in_rounds_that_can_be_counted() {
        for (e, rounds, cut_short) in [
            (0.0, 1, false),
            (0.5, 31, false),
            (0.9, LOSING_MAX + 1, true),
            (1.0, REFLECTIONS_MAX + 1, true),
        ] {
            let walls =
                format!("[effects.cushions]\nhalf_width=1.0\nhalf_length=9.0\nrestitution={e:?}\n");
            let (particles, found, _) = settled(&[(1.0, [0.0; 3], [1.0, 0.0, 0.0])], &walls, 0.0);
            let rounds = u64::from(rounds);
            assert_eq!(found, Settled { cut_short, rounds }, "{e}");
            assert_eq!(particles[0].velocity, Vector3::zeros(), "{e}");
        }
    }

    /// Five in a row, e = 0, the first comes in: one solution for all, a fifth of its speed each.
    #[test]
    fn a_row_that_does_not_bounce_moves_on_together_after_one_round() {
        let sphere = |place: u8| {
            let speed = f64::from(u8::from(place == 0));
            (1.0, [2.0 * f64::from(place), 0.0, 0.0], [speed, 0.0, 0.0])
        };
        let row: Vec<Sphere> = (0..5).map(sphere).collect();
        let (particles, found, notes) = settled(&row, "[effects.contact]\nrestitution=0\n", 0.0);
        assert_eq!((found.rounds, notes), (1, 4));
        for particle in &particles {
            // Four impulses of a few roundings.
            assert!((particle.velocity.x - 0.2).abs() < 1e-15);
        }
    }

    /// Three balls on the floor, the top one comes in with 1e-3: under a pull of 10 that would
    /// lift it by 5e-8 of a radius, and less after each of many bounces. One round ends it.
    #[test]
    fn bounces_too_low_to_show_end_in_one_round() {
        let ball = |place: u8| {
            let speed = if place == 2 { -1e-3 } else { 0.0 };
            (
                1.0,
                [0.0, 2.0 * f64::from(place) - 8.0, 0.0],
                [0.0, speed, 0.0],
            )
        };
        let pile: Vec<Sphere> = (0..3).map(ball).collect();
        let effects = "[effects.contact]\nrestitution=0.8\n[effects.cushions]\nhalf_width=9\n\
            half_length=9\nhalf_height=9\nrestitution=0.8\n";
        let (particles, found, _) = settled(&pile, effects, 10.0);
        assert_eq!((found.rounds, found.cut_short), (1, false));
        for particle in &particles {
            // Four roundings of 1e-3.
            assert!(particle.velocity.norm() < 1e-18, "{}", particle.velocity);
        }
        // Without a pull nothing says how high a bounce is.
        assert!(settled(&pile, effects, 0.0).1.rounds > 1);
    }

    /// Two that go side by side at 1000 and approach by 1e-10 do so by rounding alone.
    #[test]
    fn an_approach_below_the_rounding_of_the_velocities_is_none() {
        for (approach, impacts) in [(1e-10, 0), (1e-8, 1)] {
            let pair = [
                (1.0, [0.0; 3], [approach, 0.0, 1000.0]),
                (1.0, [2.0, 0.0, 0.0], [0.0, 0.0, 1000.0]),
            ];
            let (_, _, notes) = settled(&pair, "[effects.contact]\nrestitution=1\n", 0.0);
            assert_eq!(notes, impacts, "{approach}");
        }
    }

    /// A heavy ball presses on a light one at 60 degrees, which gets half its speed, less than
    /// the rest speed, and stops; thousands of times, or it stands after twenty stops and the heavy
    /// one goes past it, along the tangent.
    #[test]
    fn a_ball_that_is_stopped_again_and_again_stands() {
        let (cos, sin) = (0.5, 0.75_f64.sqrt());
        let pair = [
            (1e4, [0.0; 3], [1.0, 0.0, 0.0]),
            (1.0, [2.0 * cos, 0.0, 2.0 * sin], [0.0; 3]),
        ];
        let effects = "[effects.contact]\nrestitution=0\n[effects.rest]\nspeed=0.8\n";
        let (particles, found, _) = settled(&pair, effects, 0.0);
        assert_eq!(found.rounds, u64::from(STOPS_MAX) + 1);
        let along = Vector3::new(sin, 0.0, -cos) * sin;
        // Twenty impulses of a few roundings.
        assert!((particles[0].velocity - along).norm() < 1e-14);
        assert_eq!(particles[1].velocity, Vector3::zeros());
    }

    /// `dE = u.l' + l'.A l'/2` with `u = -A l`, `l' = (1 + e) l`. For A = ((1, -1/2), (-1/2, 1))
    /// and e = (1, 0) that is `l1 l2/2 - l2²/2`: a gain where l1 is the larger, and then the
    /// smaller e is taken for both.
    #[test]
    fn touches_of_several_restitutions_keep_theirs_only_where_that_gains_no_energy() {
        let matrix = [[1.0, -0.5], [-0.5, 1.0]];
        let entry = |i: usize, j: usize| matrix[i][j];
        for (stopping, wanted) in [([3.0, 1.0], [3.0, 1.0]), ([1.0, 3.0], [2.0, 3.0])] {
            let rate = |i: usize| -(0..2).map(|j| matrix[i][j] * stopping[j]).sum::<f64>();
            let found = reflected(&stopping, &[1.0, 0.0], &[rate(0), rate(1)], &entry);
            assert_eq!(found, wanted);
        }
    }

    /// Two touches that share a body, impulses off by a millionth: `dE = u.l + l.A l/2` is none
    /// at e = 1, and `-(1 - e²)/2 l.A l` below.
    #[test]
    fn reflections_lose_what_they_should_whatever_the_rounding_of_the_impulses() {
        let matrix = [[2.0, 0.5], [0.5, 1.0]];
        let entry = |i: usize, j: usize| matrix[i][j];
        let rates = [-3.0, -2.0];
        // A l = -u: determinant 1.75, l = (2, 2.5)/1.75.
        let stopping = [2.0 / 1.75 * (1.0 + 1e-6), 2.5 / 1.75];
        let exact: f64 = (2.0 * 3.0 + 2.5 * 2.0) / 1.75;
        for e in [1.0, 0.5] {
            let found = reflected(&stopping, &[e, e], &rates, &entry);
            let mut change = 0.0;
            for i in 0..2 {
                let row: f64 = (0..2).map(|j| matrix[i][j] * found[j]).sum();
                change += found[i] * (rates[i] + 0.5 * row);
            }
            let due = -0.5 * (1.0 - e * e) * exact;
            // The share is that of the impulses as they are, off by the square of a millionth.
            assert!((change - due).abs() < 1e-11 * exact, "{e}: {change} {due}");
        }
    }
}
