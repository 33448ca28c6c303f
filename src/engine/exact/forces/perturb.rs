//! A scene with forces whose inputs are moved by less than a double can tell.

use super::scalar::Real;
use super::simulation::ForcesSimulation;
use crate::engine::exact::nudge::directions;
use crate::scene::Scene;

impl<T: Real> ForcesSimulation<T> {
    /// The same from inputs moved by the relative `share`, up or down by lot: states, masses,
    /// forces and restitutions. Radii and walls are doubles and stay.
    pub(super) fn perturbed(mut self, scene: &Scene, (share, seed): (f64, u64)) -> Self {
        let directions = directions(scene, seed);
        let by = |direction: f64| T::from_f64(direction).times(share);
        let (mut positions, mut velocities) = (self.positions(), self.velocities());
        let factor = |own: f64, direction: f64| {
            let relative = if own == 0.0 { 0.0 } else { direction / own };
            T::one() + by(relative)
        };
        let masses = scene.bodies.iter().zip(&directions.bodies);
        let heavier: Vec<T> = masses
            .map(|(own, moved)| factor(own.mass, moved.mass))
            .collect();
        for (body, direction) in directions.bodies.iter().enumerate() {
            for axis in 0..3 {
                positions[body][axis] += by(direction.position[axis]);
                velocities[body][axis] += by(direction.velocity[axis]);
            }
            self.law.inverse_mass[body] /= heavier[body];
        }
        self.set_positions(&positions);
        self.set_velocities(&velocities);
        let (own, moved) = (&scene.effects, &directions.effects);
        let springs = own.springs.len();
        let (attraction, elastic) = {
            let count = self.law.links.len() - springs;
            self.law.links.split_at_mut(count)
        };
        if let (Some(own), Some(moved)) = (own.attraction, moved.attraction) {
            for link in attraction {
                let [a, b] = link.ends;
                link.scale *= factor(own.constant, moved.constant) * heavier[a] * heavier[b];
            }
        }
        for (link, (own, moved)) in elastic
            .iter_mut()
            .zip(own.springs.iter().zip(&moved.springs))
        {
            let stiffer = factor(own.stiffness, moved.stiffness);
            link.offset *= stiffer;
            link.scale *= stiffer * factor(own.rest_length, moved.rest_length);
        }
        if let (Some(drag), Some(moved)) = (&mut self.law.drag, moved.drag) {
            *drag += by(moved.coefficient);
        }
        if let Some(moved) = moved.gravity {
            for axis in 0..3 {
                self.law.gravity[axis] += by(moved.acceleration[axis]);
            }
        }
        if let (Some(e), Some(moved)) = (&mut self.surfaces.contact, moved.contact) {
            *e += by(moved.restitution);
        }
        if let (Some((e, _)), Some(moved)) = (&mut self.surfaces.cushions, moved.cushions) {
            *e += by(moved.restitution);
        }
        self
    }
}
