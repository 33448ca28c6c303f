//! Surfaces that touch: gap, line of action, how fast they approach.

use super::super::Particle;
use super::super::contacts::line_of_action;
use super::super::phases::Phases;
use super::neighbours::Neighbours;
use crate::physics::{Meter, Vector3};
use crate::recording::{EventKind, Wall};

/// Surfaces nearer than this share of the smaller radius touch …
const NEAR: f64 = 1e-10;
/// … or nearer than so many roundings of the coordinates.
const ROUNDINGS: f64 = 16.0;
/// Bounces lower than this share of the smaller radius end, where they lose anyway: a pile of
/// balls comes to rest, and need not be followed through ever smaller and more frequent bounces.
const LOW: f64 = 1e-6;
/// Slower than this share of their speeds, and of what their forces make of them in a step, two
/// surfaces neither approach nor part.
const STILL: f64 = 1e-12;

/// Operations to see that a pair does not touch.
const OPERATIONS_A_PAIR: u64 = 10;
/// Operations to see that a body touches no wall.
const OPERATIONS_AT_WALLS: u64 = 40;

/// Two surfaces that touch, and what an impulse between them does.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub(super) kind: EventKind,
    /// The body that the normal points to.
    pub(super) a: usize,
    /// The body that it points from; none for a wall.
    pub(super) b: Option<usize>,
    pub(super) normal: Vector3,
    pub(super) restitution: f64,
    /// Distance of the surfaces, negative when they overlap.
    pub(super) gap: f64,
    /// Nearer than this they touch.
    pub(super) near: f64,
    /// Bounces lower than this end.
    low: f64,
    /// Rounding of the gap.
    rounding: f64,
}

impl Touch {
    /// A pair or a wall, which the scene must have.
    pub(super) fn of(kind: EventKind, phases: &Phases, particles: &[Particle]) -> Option<Self> {
        match kind {
            EventKind::Contact { a, b } => {
                let (one, other) = (&particles[a], &particles[b]);
                let apart = one.position - other.position;
                let distance = apart.norm();
                let far = one.position.amax().max(other.position.amax());
                Some(Self {
                    kind,
                    a,
                    b: Some(b),
                    normal: line_of_action(&apart, distance, &one.velocity, &other.velocity),
                    restitution: phases.contact?.restitution,
                    gap: distance - (one.radius + other.radius),
                    near: near(one.radius.min(other.radius), far),
                    low: LOW * one.radius.min(other.radius),
                    rounding: 2.0 * f64::EPSILON * (far + one.radius + other.radius),
                })
            }
            EventKind::Cushion { body, wall } => {
                let cushions = phases.cushions?;
                let (axis, side) = wall.axis_and_side();
                let half = cushions.half_extents()[axis];
                let particle = &particles[body];
                let mut normal = Vector3::zeros();
                normal[axis] = -side;
                Some(Self {
                    kind,
                    a: body,
                    b: None,
                    normal,
                    restitution: cushions.restitution,
                    gap: half - particle.radius - particle.position[axis] * side,
                    near: near(particle.radius, half.max(particle.position.amax())),
                    low: LOW * particle.radius,
                    rounding: 2.0 * f64::EPSILON * (half.max(particle.position.amax())),
                })
            }
            EventKind::Rest { .. } => None,
        }
    }

    /// Rate of the gap, negative on approach.
    pub(super) fn rate(&self, particles: &[Particle]) -> f64 {
        let own = particles[self.a].velocity.dot(&self.normal);
        self.b
            .map_or(own, |b| own - particles[b].velocity.dot(&self.normal))
    }

    /// Sizes of the relative velocity and of the bodies' accelerations, added up.
    fn sizes(&self, particles: &[Particle]) -> [f64; 2] {
        let own = &particles[self.a];
        let acceleration = |particle: &Particle| particle.force.norm() / particle.mass;
        match self.b.map(|b| &particles[b]) {
            Some(other) => [
                own.velocity.norm() + other.velocity.norm(),
                acceleration(own) + acceleration(other),
            ],
            None => [own.velocity.norm(), acceleration(own)],
        }
    }

    /// Below this a rate is none; `dt` is the step of the scene.
    pub(super) fn still(&self, particles: &[Particle], dt: f64) -> f64 {
        let [speed, acceleration] = self.sizes(particles);
        STILL * (speed + acceleration * dt)
    }

    /// A bounce slower than this would not rise above what counts as touching or, where bounces
    /// lose, above a height that does not show: `u² = 2 a h`.
    pub(super) fn slowest_bounce(&self, particles: &[Particle]) -> f64 {
        let [_, acceleration] = self.sizes(particles);
        let height = if self.restitution < 1.0 {
            self.near.max(self.low)
        } else {
            self.near
        };
        (2.0 * acceleration * height).sqrt()
    }

    /// The touch at the end of a step, with its normal along the mean separation over the step:
    /// times the relative motion that is exactly the change of the gap.
    ///
    /// Equation: with q the separation, `(q0 + q1)/(|q0| + |q1|) . (q1 - q0) = |q1| - |q0|`.
    pub(super) fn mean(&self, phases: &Phases, start: &[Particle], end: &[Particle]) -> Self {
        let Some(mut touch) = Self::of(self.kind, phases, end) else {
            return *self;
        };
        if let Some(b) = self.b {
            let apart = |at: &[Particle]| at[self.a].position - at[b].position;
            let (before, after) = (apart(start), apart(end));
            let lengths = before.norm() + after.norm();
            if lengths > 0.0 {
                touch.normal = (before + after) / lengths;
            }
        }
        touch
    }

    /// Rounding of a gap, from the coordinates that enter.
    pub(super) fn rounding(&self) -> f64 {
        self.rounding
    }

    pub(super) fn touches(&self) -> bool {
        self.gap <= self.near
    }

    pub(super) fn shares_a_body(&self, other: &Self) -> bool {
        let has = |body: usize| other.a == body || other.b == Some(body);
        has(self.a) || self.b.is_some_and(has)
    }

    /// Body and direction of a push on each side.
    pub(super) fn arms(&self) -> impl Iterator<Item = (usize, Vector3)> {
        let other = self.b.map(|b| (b, -self.normal));
        std::iter::once((self.a, self.normal)).chain(other)
    }
}

fn near(radius: f64, far: f64) -> f64 {
    (NEAR * radius).max(ROUNDINGS * f64::EPSILON * far)
}

/// Every touching pair and wall, in the model's order; no matter how they move.
pub(super) fn touching(
    phases: &Phases,
    particles: &[Particle],
    neighbours: &mut Neighbours,
    into: &mut Vec<Touch>,
    meter: &mut Meter,
) {
    into.clear();
    let mut offer = |kind| {
        let touch = Touch::of(kind, phases, particles);
        into.extend(touch.filter(Touch::touches));
    };
    if phases.contact.is_some() {
        // More than what counts as near.
        let room = |p: &Particle| 1e-6 * p.radius + 64.0 * f64::EPSILON * p.position.amax();
        let room = particles.iter().map(room).fold(0.0_f64, f64::max);
        let near = neighbours.within(particles, 2.0 * room, meter);
        meter.add(OPERATIONS_A_PAIR * near.len() as u64);
        for [a, b] in near {
            let (one, other) = (&particles[*a], &particles[*b]);
            let rounding = 2.0 * ROUNDINGS * f64::EPSILON * one.position.amax();
            let reach = one.radius + other.radius + rounding;
            let squared = (one.position - other.position).norm_squared();
            // A hair more, for what counts as near; squares beyond doubles touch nothing.
            if squared <= reach * reach * 1.000_001 {
                offer(EventKind::Contact { a: *a, b: *b });
            }
        }
    }
    if let Some(cushions) = &phases.cushions {
        let half = cushions.half_extents();
        meter.add(OPERATIONS_AT_WALLS * particles.len() as u64);
        for (body, particle) in particles.iter().enumerate() {
            for wall in Wall::ALL {
                let (axis, side) = wall.axis_and_side();
                let room = half[axis] - particle.radius;
                if particle.position[axis] * side >= room - 1e-6 * (particle.radius + room.abs()) {
                    offer(EventKind::Cushion { body, wall });
                }
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::engine::impulse::particles;
    use crate::engine::spec::DragRule;

    /// Mass, place and velocity of a sphere of radius 1.
    pub(in super::super) type Sphere = (f64, [f64; 3], [f64; 3]);

    /// The start of a scene: what it calls for, the spheres, and what touches.
    pub(in super::super) fn start(
        spheres: &[Sphere],
        effects: &str,
    ) -> (Phases, Vec<Particle>, Vec<Touch>) {
        let body = |(place, (mass, position, velocity)): (usize, &Sphere)| {
            format!(
                "[[bodies]]\nname='b{place}'\nmass={mass:?}\nradius=1\n\
                 position={position:?}\nvelocity={velocity:?}\n"
            )
        };
        let bodies: String = spheres.iter().enumerate().map(body).collect();
        let text = format!("name='x'\nduration=1\nsample_every=1\n{bodies}{effects}");
        let scene = crate::scene::parse(&text, "x").unwrap();
        let phases = Phases::of(&scene, DragRule::Exponential);
        let particles = particles(&scene);
        let mut touches = Vec::new();
        touching(
            &phases,
            &particles,
            &mut Neighbours::default(),
            &mut touches,
            &mut Meter::default(),
        );
        (phases, particles, touches)
    }

    /// Far from the origin the rounding of places is more than what counts as near otherwise.
    #[test]
    fn far_spheres_touch_within_the_rounding_of_their_places() {
        for far in [1e9, 1e11] {
            let near = ROUNDINGS * f64::EPSILON * far;
            for (gap, count) in [(0.9 * near, 1), (1.2 * near, 0)] {
                let spheres = [
                    (1.0, [far, 0.0, 0.0], [0.0; 3]),
                    (1.0, [far + 2.0 + gap, 0.0, 0.0], [0.0; 3]),
                ];
                let (_, _, touches) = start(&spheres, "[effects.contact]\nrestitution=1\n");
                assert_eq!(touches.len(), count, "{far} {gap}");
            }
        }
    }
}
