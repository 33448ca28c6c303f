//! The forces of a scene in the one shape that the Taylor recurrences ask for.

use super::scalar::{Real, Triple, add_scaled, dot, minus};
use crate::scene::Scene;

/// A force along the line between two bodies, and a damper on their relative velocity.
///
/// Equation: on body a, `(offset + scale (d² + s²)^power) d + damping (v_b - v_a)` with d from
/// a to b; the opposite on b. Attraction: `offset = 0`, `scale = G m_a m_b`, `power = -3/2`.
/// Spring: `offset = k`, `scale = -k l0`, `power = -1/2`, s = 0 where there is a scale.
/// Source: lecture, `computeAttraction()`; "스프링과 댐퍼" (springs and dampers), "최종 모델".
#[derive(Debug, Clone)]
pub(super) struct Link<T> {
    /// Indices of bodies a and b.
    pub(super) ends: [usize; 2],
    /// Power of the squared distance, a multiple of 1/2.
    pub(super) power: f64,
    pub(super) offset: T,
    pub(super) scale: T,
    pub(super) damping: Option<T>,
    /// s².
    pub(super) softening_squared: T,
}

impl<T: Real> Link<T> {
    /// `scale (d² + s²)^power` of that squared distance.
    pub(super) fn scaled_power(&self, squared: T) -> T {
        let root = squared.sqrt();
        let inverse = if self.power < -1.0 {
            T::from_f64(1.0) / (squared * root)
        } else {
            T::from_f64(1.0) / root
        };
        self.scale * inverse
    }

    /// The length below which the force no longer changes its kind: the softening of an
    /// attraction, 0 without.
    pub(super) fn softening(&self) -> f64 {
        if self.power < -1.0 {
            self.softening_squared.to_f64().sqrt()
        } else {
            0.0
        }
    }

    /// The force on body a.
    fn force(&self, position: &[Triple<T>], velocity: &[Triple<T>]) -> Triple<T> {
        let [a, b] = self.ends;
        let d = minus(&position[b], &position[a]);
        let factor = self.offset + self.scaled_power(dot(&d, &d) + self.softening_squared);
        let mut force = d.map(|d| d * factor);
        if let Some(damping) = self.damping {
            add_scaled(&mut force, damping, &minus(&velocity[b], &velocity[a]));
        }
        force
    }
}

/// All forces of a scene.
#[derive(Debug, Clone)]
pub(super) struct Law<T> {
    /// 1/m. Shape: `[body]`.
    pub(super) inverse_mass: Vec<T>,
    pub(super) links: Vec<Link<T>>,
    /// Drag coefficient k of `F = -k v`.
    pub(super) drag: Option<T>,
    /// Uniform acceleration.
    pub(super) gravity: Triple<T>,
}

impl<T: Real> Law<T> {
    pub(super) fn of(scene: &Scene) -> Self {
        let effects = &scene.effects;
        let mass = |body: usize| T::from_f64(scene.bodies[body].mass);
        let mut links = Vec::new();
        if let Some(attraction) = effects.attraction {
            let softening = T::from_f64(attraction.softening);
            for a in 0..scene.bodies.len() {
                links.extend((a + 1..scene.bodies.len()).map(|b| Link {
                    ends: [a, b],
                    power: -1.5,
                    offset: T::zero(),
                    scale: T::from_f64(attraction.constant) * mass(a) * mass(b),
                    damping: None,
                    softening_squared: softening * softening,
                }));
            }
        }
        for (spring, ends) in effects.springs.iter().zip(scene.spring_ends()) {
            let stiffness = T::from_f64(spring.stiffness);
            links.push(Link {
                ends,
                power: -0.5,
                offset: stiffness,
                scale: -(stiffness * T::from_f64(spring.rest_length)),
                damping: (spring.damping != 0.0).then(|| T::from_f64(spring.damping)),
                // A spring of no rest length has no power of the distance; any softening keeps
                // the power that its scale of 0 takes away finite, through coincident ends too.
                softening_squared: T::from_f64(if spring.rest_length == 0.0 { 1.0 } else { 0.0 }),
            });
        }
        let drag = effects.drag.filter(|drag| drag.coefficient != 0.0);
        let gravity = effects.gravity.map_or([0.0; 3], |g| g.acceleration);
        Self {
            inverse_mass: (0..scene.bodies.len())
                .map(|body| T::from_f64(1.0) / mass(body))
                .collect(),
            links,
            drag: drag.map(|drag| T::from_f64(drag.coefficient)),
            gravity: gravity.map(T::from_f64),
        }
    }

    /// Accelerations by all of it. Shape: `[body]`.
    pub(super) fn acceleration(
        &self,
        position: &[Triple<T>],
        velocity: &[Triple<T>],
    ) -> Vec<Triple<T>> {
        let mut acceleration = vec![self.gravity; position.len()];
        for link in &self.links {
            let [a, b] = link.ends;
            let force = link.force(position, velocity);
            add_scaled(&mut acceleration[a], self.inverse_mass[a], &force);
            add_scaled(&mut acceleration[b], -self.inverse_mass[b], &force);
        }
        self.add_drag(velocity, &mut acceleration);
        acceleration
    }

    pub(super) fn add_drag(&self, velocity: &[Triple<T>], acceleration: &mut [Triple<T>]) {
        let Some(drag) = self.drag else { return };
        for (body, inverse_mass) in self.inverse_mass.iter().enumerate() {
            let rate = -(drag * *inverse_mass);
            add_scaled(&mut acceleration[body], rate, &velocity[body]);
        }
    }

    pub(super) fn add_gravity(&self, acceleration: &mut [Triple<T>]) {
        for a in acceleration {
            add_scaled(a, T::from_f64(1.0), &self.gravity);
        }
    }
}
