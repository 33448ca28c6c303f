//! Motion over a step, with the pushes of surfaces that stay in touch.

use super::flow::Flow;
use super::together::{OPERATIONS_AN_ENTRY, coupling, square};
use super::touch::Touch;
use super::{Robust, mean_force};
use crate::engine::impulse::Particle;
use crate::engine::impulse::phases::Phases;
use crate::physics::Vector3;
use crate::physics::complementarity::pushes;

/// Rounds in which forces between bodies find the end of a step that they lead to.
const ROUNDS_MAX: u32 = 40;
/// Rounds that find the pushes of surfaces in touch while other forces depend on places.
const PUSH_ROUNDS: u32 = 6;
/// Halvings of a step, before it is given up.
const HALVINGS: u32 = 10;
/// Operations to move a body in a round, beside the forces.
const OPERATIONS_A_ROUND: u64 = 40;
/// Operations to see how a touch ends.
const OPERATIONS_A_TOUCH: u64 = 100;
/// Operations for an entry of the matrix of touches where dampers tie bodies, a body.
const OPERATIONS_A_COUPLED_ENTRY: u64 = 8;
/// Surfaces that press and slide may turn by this angle in a step.
const TURN: f64 = 0.05;

/// What a search for pushes came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pressed {
    /// None are needed.
    Nowhere,
    /// They keep the gaps closed.
    Found,
    /// With them gaps open or shrink by more than what counts as touching.
    Loose,
    /// With them the forces found no end of the step.
    Lost,
}

impl Robust {
    /// Takes the particles over a step of that length, or a shorter one, with the pushes of what
    /// stays in touch; gives the length taken.
    pub(super) fn press_on(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        dt: f64,
        length: f64,
    ) -> f64 {
        let whole = length;
        let mut length = length;
        let floor = self.shortest(dt);
        let mut halvings = 0;
        self.release();
        let resting = self.resting(particles, dt);
        while !self.work.is_spent() {
            length = self.travel(phases, particles, length, floor);
            if resting.is_empty() {
                return length;
            }
            let pressed = self.press(phases, particles, &resting, length);
            let longest = match pressed {
                Pressed::Nowhere => return length,
                Pressed::Found | Pressed::Loose => self.longest_slide(&resting).max(floor),
                Pressed::Lost if halvings < HALVINGS && length > floor => 0.5 * length,
                Pressed::Lost => {
                    self.give_up(phases, particles, whole);
                    return whole;
                }
            };
            if length <= longest * 1.001 {
                self.conceded.loose += u64::from(pressed == Pressed::Loose);
                return length;
            }
            halvings += 1;
            length = longest;
            self.release();
            particles.clone_from_slice(&self.start);
        }
        length
    }

    /// The time in which surfaces that press and slide turn by as much as they may.
    fn longest_slide(&self, resting: &[Touch]) -> f64 {
        let turn = |touch: &Touch| {
            let Some(b) = touch.b else { return 0.0 };
            let reach = self.start[touch.a].radius + self.start[b].radius;
            (self.start[touch.a].velocity - self.start[b].velocity).norm() / reach
        };
        let pressed = resting.iter().filter(|touch| self.is_pressed(touch));
        TURN / pressed.map(turn).fold(0.0, f64::max)
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
    /// takes the step with them.
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
    ) -> Pressed {
        let mut sizes = vec![0.0; resting.len()];
        for round in 0..=PUSH_ROUNDS {
            let count = resting.len() as u64;
            self.work.meter.add(OPERATIONS_A_TOUCH * count);
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
                return if round > 0 {
                    Pressed::Found
                } else {
                    Pressed::Nowhere
                };
            }
            if round == PUSH_ROUNDS || self.work.is_spent() {
                // Gaps that are off by less than what counts as touching stay closed all the same.
                let opens = |((touch, change), size): ((&Touch, &f64), &f64)| {
                    *change < -touch.near || (*size > 0.0 && *change > touch.near)
                };
                if resting.iter().zip(&changes).zip(&sizes).any(opens) {
                    return Pressed::Loose;
                }
                break;
            }
            self.count_matrix(count);
            let (flow, start) = (&self.flow, &self.start);
            let matrix = square(&ends, |one, other| pressing(one, other, flow, start));
            let rows = matrix.chunks_exact(ends.len());
            let free: Vec<f64> = changes
                .iter()
                .zip(rows)
                .map(|(g, row)| g - row.iter().zip(&sizes).map(|(b, l)| b * l).sum::<f64>())
                .collect();
            let guess: Vec<bool> = sizes.iter().map(|l| round == 0 || *l > 0.0).collect();
            let entry = |i: usize, j: usize| matrix[i * ends.len() + j];
            let before = self.work.meter.done();
            sizes = pushes(&entry, &free, &guess, &mut self.work.meter);
            self.work.charge_solution(before);
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
            if !self.try_travel(phases, particles, length) {
                return Pressed::Lost;
            }
        }
        Pressed::Found
    }

    /// Takes the particles over a step, a shorter one if the forces find no end, but not below a
    /// floor; gives its length.
    fn travel(
        &mut self,
        phases: &Phases,
        particles: &mut [Particle],
        length: f64,
        floor: f64,
    ) -> f64 {
        let mut shorter = length;
        for _ in 0..HALVINGS {
            if self.try_travel(phases, particles, shorter) {
                return shorter;
            }
            particles.clone_from_slice(&self.start);
            shorter *= 0.5;
            if shorter < floor {
                break;
            }
        }
        self.give_up(phases, particles, length);
        length
    }

    /// Nothing that keeps the energy was found: the bodies go back the way they came, relative to
    /// their centre of mass, which keeps energy and momentum.
    fn give_up(&mut self, phases: &Phases, particles: &mut [Particle], length: f64) {
        self.conceded.turned_back += 1;
        self.work.charge_failure();
        particles.clone_from_slice(&self.start);
        self.release();
        turn_back(phases, particles, length);
    }

    /// Counts a matrix of so many touches.
    fn count_matrix(&mut self, count: u64) {
        let an_entry = if self.flow.is_coupled() {
            OPERATIONS_A_COUPLED_ENTRY * self.start.len() as u64
        } else {
            OPERATIONS_AN_ENTRY
        };
        self.work.meter.add(an_entry * count * count);
    }

    /// Counts a motion of all bodies.
    fn charge_motion(&mut self) {
        self.work.charge_motion();
        self.work.count_bodies(OPERATIONS_A_ROUND);
        self.work.meter.add(self.flow.operations());
    }

    /// One attempt; whether the forces found the end of the step.
    fn try_travel(&mut self, phases: &Phases, particles: &mut [Particle], h: f64) -> bool {
        mean_force::set(phases, &self.start, particles, &self.pushes);
        self.flow.advance(particles, h);
        if phases.forces {
            self.work.charge_pass();
        }
        self.charge_motion();
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
            self.work.charge_pass();
            self.charge_motion();
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
}

/// `max` that does not pass over what is not a number.
fn larger(most: f64, value: f64) -> f64 {
    if value > most || value.is_nan() {
        value
    } else {
        most
    }
}

/// Turns velocities back, relative to that of the centre of mass, which goes on over the step
/// where nothing from outside is in its way.
fn turn_back(phases: &Phases, particles: &mut [Particle], length: f64) {
    let mass: f64 = particles.iter().map(|p| p.mass).sum();
    let momentum: Vector3 = particles.iter().map(|p| p.velocity * p.mass).sum();
    let mean = momentum / mass;
    let is_free = phases.cushions.is_none() && phases.gravity.is_none() && phases.decay.is_none();
    let moved = mean * if is_free { length } else { 0.0 };
    for particle in particles {
        particle.velocity = mean * 2.0 - particle.velocity;
        particle.position += moved;
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

#[cfg(test)]
mod tests {
    use super::super::touch::tests::start;
    use super::*;

    /// Velocities relative to the centre of mass change their sign: with the mean 2, 5 becomes -1
    /// and 1 becomes 3, which keeps momentum and energy. The centre goes on where nothing from
    /// outside acts.
    #[test]
    fn turning_back_keeps_momentum_and_energy_to_the_last_bit() {
        let spheres = [
            (1.0, [0.0; 3], [5.0, 0.0, 4.0]),
            (3.0, [8.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ];
        let walls = "[effects.cushions]\nhalf_width=99\nhalf_length=99\nrestitution=1\n";
        for (effects, goes) in [
            ("", true),
            (walls, false),
            ("[effects.gravity]\nacceleration=[0,-1,0]\n", false),
            ("[effects.drag]\ncoefficient=1\n", false),
        ] {
            let (phases, mut particles, _) = start(&spheres, effects);
            turn_back(&phases, &mut particles, 0.5);
            let [one, other] = [0, 1].map(|body| particles[body].velocity);
            assert_eq!(one, Vector3::new(-1.0, 0.0, -2.0));
            assert_eq!(other, Vector3::new(3.0, 0.0, 2.0));
            let moved = if goes {
                Vector3::new(1.0, 0.0, 0.5)
            } else {
                Vector3::zeros()
            };
            for (particle, (_, place, _)) in particles.iter().zip(spheres) {
                assert_eq!(particle.position, Vector3::from(place) + moved, "{effects}");
            }
        }
    }
}
