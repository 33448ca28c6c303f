//! What each phase books in the ledger, by its own formula.

use super::Particle;
use super::observer::Observer;
use super::phases::Phases;
use crate::physics::{Vector3, attraction_energy, gravity_energy, kinetic_energy};
use crate::recording::{Account, Entry};

/// An impact of two spheres.
///
/// Equation: `dE = -(1 - e)/(1 + e) J²/2 (1/m_a + 1/m_b)`, from `J = (1 + e) |v_r| m` with the
/// reduced mass m; no momentum.
pub(super) fn contact(restitution: f64, masses: [f64; 2], impulse: f64) -> Entry {
    let lost = (1.0 - restitution) / (1.0 + restitution);
    Entry {
        energy: -0.5 * lost * impulse * impulse * (1.0 / masses[0] + 1.0 / masses[1]),
        momentum: Vector3::zeros(),
    }
}

/// An impact on a wall with that inward normal.
///
/// Equation: `dE = -(1 - e)/(1 + e) J²/(2 m)`, `dp = J n`.
pub(super) fn cushion(restitution: f64, mass: f64, impulse: f64, inward: &Vector3) -> Entry {
    let lost = (1.0 - restitution) / (1.0 + restitution);
    Entry {
        energy: -0.5 * lost * impulse * impulse / mass,
        momentum: inward * impulse,
    }
}

/// A stop. Equation: `dE = -m v²/2`, `dp = -m v`.
pub(super) fn rest(mass: f64, velocity: &Vector3) -> Entry {
    Entry {
        energy: -kinetic_energy(mass, velocity),
        momentum: velocity * -mass,
    }
}

/// A motion without impacts over a time, from one set of states to another.
///
/// Equation: drag `dE = -k |dx|²/dt`, `dp = -k dx`; dampers `dE = -kd |dq|²/dt` with q the
/// separation; gravity `dp = m g dt`; the integrator is booked with what is left of the measured
/// change of kinetic and potential energy and of momentum.
pub(super) fn motion<O: Observer>(
    phases: &Phases,
    before: &[Particle],
    after: &[Particle],
    dt: f64,
    observer: &mut O,
) {
    if !O::BOOKS || dt <= 0.0 {
        return;
    }
    let moved = |body: usize| after[body].position - before[body].position;
    let mut known = Entry::NONE;
    let mut book = |account: Account, entry: Entry| {
        known.energy += entry.energy;
        known.momentum += entry.momentum;
        observer.book(account, entry);
    };
    if let Some(drag) = phases.drag.or(phases.decay) {
        let k = drag.coefficient;
        for body in 0..before.len() {
            let path = moved(body);
            let entry = Entry {
                energy: -k * path.norm_squared() / dt,
                momentum: path * -k,
            };
            book(Account::Drag, entry);
        }
    }
    for spring in &phases.springs {
        let stretched = moved(spring.ends[1]) - moved(spring.ends[0]);
        let entry = Entry {
            energy: -spring.damping * stretched.norm_squared() / dt,
            momentum: Vector3::zeros(),
        };
        book(Account::Dampers, entry);
    }
    if let Some(acceleration) = &phases.gravity {
        for particle in before {
            let entry = Entry {
                energy: 0.0,
                momentum: acceleration * (particle.mass * dt),
            };
            book(Account::Gravity, entry);
        }
    }
    let entry = Entry {
        energy: energy(phases, after) - energy(phases, before) - known.energy,
        momentum: momentum(after) - momentum(before) - known.momentum,
    };
    observer.book(Account::Integrator, entry);
}

/// The states before a motion, for whoever keeps books.
#[inline]
pub(super) fn kept<O: Observer>(particles: &[Particle]) -> Vec<Particle> {
    if O::BOOKS {
        particles.to_vec()
    } else {
        Vec::new()
    }
}

/// Lets bodies be pushed out of each other, and books what that does to the potential energy:
/// impulses leave it alone.
#[inline]
pub(super) fn pushing_out<O: Observer>(
    phases: &Phases,
    particles: &mut [Particle],
    observer: &mut O,
    push: impl FnOnce(&mut [Particle], &mut O),
) {
    if !O::BOOKS {
        push(particles, observer);
        return;
    }
    let before = potential_energy(phases, particles);
    push(particles, observer);
    let after = potential_energy(phases, particles);
    if after != before {
        let entry = Entry {
            energy: after - before,
            momentum: Vector3::zeros(),
        };
        observer.book(Account::PushOut, entry);
    }
}

fn momentum(particles: &[Particle]) -> Vector3 {
    particles.iter().map(|p| p.velocity * p.mass).sum()
}

fn energy(phases: &Phases, particles: &[Particle]) -> f64 {
    let kinetic = particles
        .iter()
        .map(|p| kinetic_energy(p.mass, &p.velocity));
    kinetic.sum::<f64>() + potential_energy(phases, particles)
}

/// Of attraction, springs and gravity.
fn potential_energy(phases: &Phases, particles: &[Particle]) -> f64 {
    let mut sum = 0.0;
    if let Some(effect) = phases.attraction {
        for (place, a) in particles.iter().enumerate() {
            for b in &particles[place + 1..] {
                let distance = (a.position - b.position).norm();
                let masses = [a.mass, b.mass];
                sum += attraction_energy(effect.constant, effect.softening, masses, distance);
            }
        }
    }
    for spring in &phases.springs {
        sum += spring.energy(spring.ends.map(|end| &particles[end].position));
    }
    if let Some(acceleration) = &phases.gravity {
        for particle in particles {
            sum += gravity_energy(particle.mass, acceleration, &particle.position);
        }
    }
    sum
}
