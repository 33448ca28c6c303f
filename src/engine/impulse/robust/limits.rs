//! How long a step may be, from each effect's own limit.

use super::super::Particle;
use super::super::phases::Phases;

/// Share of the time in which two attracting bodies pass each other or turn round.
const ENCOUNTER_SHARE: f64 = 0.02;
/// Phase of the fastest oscillation of the springs, in a step.
const SPRING_PHASE: f64 = 0.25;

/// Limits of a scene that do not change.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Of the springs, s.
    pub(super) springs: f64,
    /// Whether steps need none: no force depends on places.
    pub(super) are_absent: bool,
}

impl Limits {
    /// Equation, springs: `h <= 1/4 min max(1/w, kd/k)`, with
    /// `w² = sum k/m_a + sum k/m_b` over the springs at both ends, which bounds the square of any
    /// frequency they take part in. Where the damper is the stronger, the slow return at the rate
    /// k/kd is what a step must resolve.
    pub(super) fn of(phases: &Phases, particles: &[Particle]) -> Self {
        let at_body = |body: usize| -> f64 {
            let own = phases.springs.iter().filter(|it| it.ends.contains(&body));
            own.map(|it| it.stiffness).sum::<f64>() / particles[body].mass
        };
        let of_spring = |spring: &crate::physics::SpringDamper| {
            if spring.stiffness == 0.0 {
                return f64::INFINITY;
            }
            let [a, b] = spring.ends.map(at_body);
            let period = 1.0 / (a + b).sqrt();
            SPRING_PHASE * period.max(spring.damping / spring.stiffness)
        };
        let springs = phases.springs.iter().map(of_spring);
        Self {
            springs: springs.fold(f64::INFINITY, f64::min),
            are_absent: phases.attraction.is_none() && phases.springs.is_empty(),
        }
    }

    /// The longest step from these places, s.
    ///
    /// Equation, attraction: `h <= share min over pairs of min((r³/(G M))^(1/2), r/v)`, with r the
    /// softened distance and v the relative speed.
    pub(super) fn length(&self, phases: &Phases, particles: &[Particle]) -> f64 {
        let Some(effect) = phases.attraction else {
            return self.springs;
        };
        let softening = effect.softening * effect.softening;
        let mut rate_squared: f64 = 0.0;
        for (place, a) in particles.iter().enumerate() {
            for b in &particles[place + 1..] {
                let squared = (b.position - a.position).norm_squared() + softening;
                let pull = effect.constant.abs() * (a.mass + b.mass) / (squared * squared.sqrt());
                let pass = (b.velocity - a.velocity).norm_squared() / squared;
                // `max` passes over NaN, of coincident bodies at rest.
                rate_squared = rate_squared.max(pull).max(pass);
            }
        }
        self.springs.min(ENCOUNTER_SHARE / rate_squared.sqrt())
    }
}
