//! Contacts that press: kept closed from step to step.

use super::scalar::{Real, Triple};
use super::series::{as_real, contact_matrix};
use super::simulation::ForcesSimulation;
use super::touch::{Arms, Touch, arms};
use crate::physics::cholesky::Cholesky;

/// Operations for an entry of the matrix of contacts.
pub(super) const OPERATIONS_AN_ENTRY: f64 = 12.0;

impl<T: Real> ForcesSimulation<T> {
    /// Takes what rounding opened or moved in held contacts out of positions and velocities,
    /// one Newton step over the masses, and factors their matrix.
    ///
    /// The matrix is that of the places after the correction: an acceleration off by the
    /// correction's share would open the contacts a hundredfold within a long step.
    pub(super) fn close_held(&mut self) -> Cholesky<T> {
        if self.held.is_empty() {
            return Cholesky::empty();
        }
        let count = as_real(self.held.len());
        self.effort
            .add::<T>(count * count * (count / 3.0 + OPERATIONS_AN_ENTRY));
        let (mut position, mut velocity) = (self.positions(), self.velocities());
        let inverse_mass = self.law.inverse_mass.clone();
        let (places, factor) = self.held_matrix(&position);
        let open = |touch: &Touch| {
            let gap = self.surfaces.gap(*touch, &position);
            -gap.times(self.surfaces.reach(*touch))
        };
        let mut open: Vec<T> = self.held.iter().map(open).collect();
        factor.solve(&mut open);
        for (arms, open) in places.iter().zip(open) {
            arms.push(open, &inverse_mass, &mut position);
        }
        let (places, factor) = self.held_matrix(&position);
        let mut moving: Vec<T> = places.iter().map(|arms| -arms.rate(&velocity)).collect();
        factor.solve(&mut moving);
        for (arms, moving) in places.iter().zip(moving) {
            arms.push(moving, &inverse_mass, &mut velocity);
        }
        self.set_positions(&position);
        self.set_velocities(&velocity);
        factor
    }

    /// Directions of the held contacts, and their matrix; one that has come to depend on the
    /// others is left to them.
    fn held_matrix(&mut self, position: &[Triple<T>]) -> (Vec<Arms<T>>, Cholesky<T>) {
        let places: Vec<_> = self.held.iter().map(|held| arms(*held, position)).collect();
        let inverse_mass = &self.law.inverse_mass;
        let entry = |i: usize, j: usize| contact_matrix(inverse_mass, &places[i], &places[j]);
        let (factor, kept) = Cholesky::of(places.len(), entry);
        if kept.len() < places.len() {
            let held = std::mem::take(&mut self.held);
            for (index, touch) in held.into_iter().enumerate() {
                let side = if kept.contains(&index) {
                    &mut self.held
                } else {
                    &mut self.idle
                };
                side.push(touch);
            }
        }
        (kept.iter().map(|index| places[*index]).collect(), factor)
    }
}
