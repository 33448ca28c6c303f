//! The engine's own recording, checked like any other's.
//!
//! Two computations that share a fault agree, and certify it. What the model keeps is a witness
//! that shares nothing with them: no overlap, energy, momentum. A breach withdraws the digits from
//! there on.

use super::claim::Scale;
use crate::physics::{
    BodyState, SpringDamper, Vector3, attraction_energy, gravity_energy, kinetic_energy, momentum,
};
use crate::recording::{Concession, ConcessionKind, Digits, Recording};
use crate::scene::Scene;
use crate::scene::overlap::for_each_overlap;

/// Errors that the digits claimed allow, times this, are no breach: the sums that are compared
/// round as well, by about an ulp for each of ten operations.
const ROOM: f64 = 10.0;

/// Takes the digits from the first sample on that breaks a law of the model, and says so.
pub(super) fn audited(scene: &Scene, recording: &mut Recording) {
    let Some(mut digits) = recording.digits.take() else {
        return;
    };
    if let Some(first) = first_breach(scene, recording, &digits) {
        for own in &mut digits[first..] {
            (own.position, own.velocity) = (0, 0);
        }
        recording.concessions.push(Concession {
            kind: ConcessionKind::BrokenLaw,
            count: (digits.len() - first) as u64,
        });
    }
    recording.digits = Some(digits);
}

/// The first sample that breaks a law by more than its digits allow.
fn first_breach(scene: &Scene, recording: &Recording, digits: &[Digits]) -> Option<usize> {
    let books = Books::of(scene, recording);
    let mut before = f64::INFINITY;
    for (sample, (states, digits)) in recording.samples().zip(digits).enumerate() {
        let allowed = |digits: u8, size: f64| ROOM * 10.0_f64.powi(-i32::from(digits)) * size;
        let position = allowed(digits.position, books.scale.diagonal);
        if digits.position == 0 {
            return None;
        }
        if books.depth(states) > position + ROOM * f64::EPSILON * books.scale.coordinate {
            return Some(sample);
        }
        if digits.velocity == 0 {
            continue;
        }
        let velocity = allowed(digits.velocity, books.scale.speed);
        let (energy, room) = books.energy(states, position, velocity);
        let grows = energy - before > room;
        let falls = books.keeps_energy && before - energy > room;
        if before.is_finite() && (grows || falls) || books.momentum_is_off(sample, states, velocity)
        {
            return Some(sample);
        }
        before = if books.keeps_energy && before.is_finite() {
            before
        } else {
            energy.min(before)
        };
    }
    None
}

/// What is kept of a scene.
struct Books<'a> {
    scene: &'a Scene,
    masses: Vec<f64>,
    springs: Vec<SpringDamper>,
    scale: Scale,
    /// Whether nothing takes energy out.
    keeps_energy: bool,
    /// Momentum at the start, where only gravity changes it.
    momentum: Option<Vector3>,
    /// Depth of overlaps at the start: rounding of the scene file.
    start_depth: f64,
}

impl<'a> Books<'a> {
    fn of(scene: &'a Scene, recording: &Recording) -> Self {
        let effects = &scene.effects;
        let masses: Vec<f64> = scene.bodies.iter().map(|body| body.mass).collect();
        let drags = effects.drag.is_some_and(|drag| drag.coefficient != 0.0);
        let damps = effects.springs.iter().any(|spring| spring.damping != 0.0);
        let is_elastic = effects
            .contact
            .is_none_or(|contact| contact.restitution == 1.0)
            && effects
                .cushions
                .is_none_or(|cushions| cushions.restitution == 1.0);
        let passive = !drags && effects.rest.is_none();
        let keeps_momentum = passive && effects.cushions.is_none();
        let mut books = Self {
            keeps_energy: passive && !damps && (is_elastic || recording.events.events().is_empty()),
            momentum: keeps_momentum.then(|| momentum(&masses, recording.sample(0))),
            springs: SpringDamper::all(scene),
            scale: Scale::of(recording),
            start_depth: 0.0,
            masses,
            scene,
        };
        books.start_depth = books.depth(recording.sample(0)).max(0.0);
        books
    }

    /// The deepest overlap, beyond that of the start.
    fn depth(&self, states: &[BodyState]) -> f64 {
        let mut deepest = 0.0_f64;
        let bodies = states.iter().zip(&self.scene.bodies);
        if self.scene.effects.contact.is_some() {
            let spheres: Vec<_> = bodies
                .clone()
                .map(|(s, body)| (s.position, body.radius))
                .collect();
            for_each_overlap(&spheres, |overlap| deepest = deepest.max(overlap.depth));
        }
        if let Some(cushions) = self.scene.effects.cushions {
            for (state, body) in bodies {
                for (x, half) in state.position.iter().zip(cushions.half_extents()) {
                    deepest = deepest.max(x.abs() + body.radius - half);
                }
            }
        }
        deepest - self.start_depth
    }

    /// The energy, and by how much it may be off where positions and velocities are by that much.
    ///
    /// Equation: to first order `sum m |v| dv + sum |dU/dx| dx`; a difference of two samples has
    /// twice that, which the room that is left covers.
    fn energy(&self, states: &[BodyState], position: f64, velocity: f64) -> (f64, f64) {
        let effects = &self.scene.effects;
        let (mut energy, mut room, mut size) = (0.0, 0.0, 0.0_f64);
        let mut add = |own: f64, off: f64| {
            energy += own;
            room += off;
            size += own.abs();
        };
        for (m, state) in self.masses.iter().zip(states) {
            let speed = state.velocity.norm();
            add(
                kinetic_energy(*m, &state.velocity),
                m * velocity * (speed + velocity),
            );
            if let Some(gravity) = effects.gravity {
                let acceleration: Vector3 = gravity.acceleration.into();
                let own = gravity_energy(*m, &acceleration, &state.position);
                add(own, m * acceleration.norm() * position);
            }
        }
        for spring in &self.springs {
            let ends = spring.ends.map(|end| &states[end].position);
            let stretch = ((ends[1] - ends[0]).norm() - spring.rest_length).abs();
            add(
                spring.energy(ends),
                spring.stiffness * 2.0 * position * (stretch + 2.0 * position),
            );
        }
        if let Some(attraction) = effects.attraction {
            for a in 0..states.len() {
                for b in a + 1..states.len() {
                    let distance = (states[a].position - states[b].position).norm();
                    let masses = [self.masses[a], self.masses[b]];
                    let own = attraction_energy(
                        attraction.constant,
                        attraction.softening,
                        masses,
                        distance,
                    );
                    let least = (distance.hypot(attraction.softening) - 2.0 * position).max(0.0);
                    add(own, own.abs() * 2.0 * position / least);
                }
            }
        }
        (energy, 2.0 * room + 100.0 * f64::EPSILON * size)
    }

    fn momentum_is_off(&self, sample: usize, states: &[BodyState], velocity: f64) -> bool {
        let Some(start) = self.momentum else {
            return false;
        };
        let mass: f64 = self.masses.iter().sum();
        let gravity = self
            .scene
            .effects
            .gravity
            .map_or([0.0; 3], |g| g.acceleration);
        let gained = Vector3::from(gravity) * (mass * self.scene.sample_time(sample));
        let off = (momentum(&self.masses, states) - start - gained).norm();
        let sizes = self
            .masses
            .iter()
            .zip(states)
            .map(|(m, state)| m * state.velocity.norm());
        let rounding = 100.0 * f64::EPSILON * (sizes.sum::<f64>() + gained.norm());
        off > 2.0 * mass * velocity + rounding
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Body, Contact, Cushions, Effects, Units};

    fn scene() -> Scene {
        let body = |name: &str, x: f64, v: f64| Body {
            name: name.into(),
            mass: 1.0,
            radius: 0.25,
            position: [x, 0.0, 0.0],
            velocity: [v, 0.0, 0.0],
        };
        let cushions = Cushions {
            half_width: 2.0,
            half_length: 2.0,
            half_height: None,
            restitution: 1.0,
        };
        Scene {
            name: "test".into(),
            title: None,
            source: None,
            watch: None,
            duration: 4.0,
            sample_every: 1.0,
            units: Units::default(),
            bodies: vec![body("a", -1.5, 0.0), body("b", 1.0, 0.25)],
            effects: Effects {
                contact: Some(Contact { restitution: 1.0 }),
                cushions: Some(cushions),
                ..Effects::default()
            },
        }
    }

    /// Body b flies on with these speeds, a sample each, whatever stands in its way.
    fn digits_after(scene: &Scene, speeds: [f64; 4]) -> (Vec<u8>, usize) {
        let mut recording = Recording::at_start("exact", scene);
        let mut states = recording.sample(0).to_vec();
        for speed in speeds {
            states[1].position.x += states[1].velocity.x;
            states[1].velocity.x = speed;
            recording.push(&states);
        }
        let full = Digits {
            position: 15,
            velocity: 15,
        };
        recording.digits = Some(vec![full; recording.sample_count()]);
        audited(scene, &mut recording);
        let digits = recording.digits.unwrap();
        (
            digits.iter().map(|d| d.position).collect(),
            recording.concessions.len(),
        )
    }

    #[test]
    fn a_recording_that_goes_through_a_wall_loses_its_digits_from_there_on() {
        let through = digits_after(&scene(), [0.25, 0.25, 0.25, 0.25]);
        assert_eq!(through, (vec![15, 15, 15, 15, 0], 1));
    }

    #[test]
    fn energy_that_nothing_takes_is_missed_and_a_bounce_is_not() {
        let slower = digits_after(&scene(), [0.25, 0.125, 0.125, 0.125]);
        assert_eq!(slower, (vec![15, 15, 0, 0, 0], 1));
        let bounce = digits_after(&scene(), [0.25, 0.25, -0.25, -0.25]);
        assert_eq!(bounce, (vec![15; 5], 0));
    }

    #[test]
    fn momentum_that_nothing_gives_is_noticed() {
        let mut free = scene();
        free.effects.cushions = None;
        free.bodies[0].velocity = [0.0, 0.0, 0.25];
        let turned = digits_after(&free, [0.25, -0.25, -0.25, -0.25]);
        assert_eq!(turned, (vec![15, 15, 0, 0, 0], 1));
    }
}
