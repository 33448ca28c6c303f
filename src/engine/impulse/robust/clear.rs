//! How long nothing can meet: then steps are nothing but motion.

use super::Robust;
use crate::engine::impulse::Particle;
use crate::engine::impulse::phases::Phases;

/// Operations to see how long a pair cannot meet …
const OPERATIONS_A_PAIR: u64 = 15;
/// … and a body no wall.
const OPERATIONS_A_BODY: u64 = 20;

impl Robust {
    /// Whether nothing can meet or stop for longer than a step, where speeds never grow.
    ///
    /// Sets `clear`: the least time in which any two surfaces could meet at their present speeds,
    /// or a body slow down to the rest speed.
    pub(super) fn becomes_clear(
        &mut self,
        phases: &Phases,
        particles: &[Particle],
        dt: f64,
    ) -> bool {
        self.clear = 0.0;
        if phases.gravity.is_some() || !self.limits.are_absent {
            return false;
        }
        let mut clear = f64::INFINITY;
        self.work.count_bodies(OPERATIONS_A_BODY);
        if phases.contact.is_some() {
            self.work.count_pairs(OPERATIONS_A_PAIR);
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
                    // Surfaces in touch that stay so give 0/0, which `min` passes over.
                    clear = clear.min(gap / speed);
                }
            }
        }
        if let Some(cushions) = &phases.cushions {
            let half = cushions.half_extents();
            for particle in particles {
                for (axis, half) in half.iter().enumerate() {
                    let room = half - particle.radius - particle.position[axis].abs();
                    if room.is_nan() || room <= 0.0 {
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
}
