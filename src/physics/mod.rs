//! Pure formulas: state, impulse law, forces, energy, momentum.
//!
//! Every function that the `lecture` engine uses keeps the slides' order of arithmetic, every
//! operator left to right, so that the engine reproduces their C++ to the last bit.

pub mod cholesky;
pub mod closing;
pub mod complementarity;
mod energy;
mod force;
mod impulse;
mod meter;
mod momentum;
pub mod real;
mod spring;
mod state;

pub use energy::{attraction_energy, gravity_energy, kinetic_energy, spring_energy};
pub use force::{attraction, spring_damper};
pub use impulse::{contact_impulse, cushion_impulse};
pub use meter::Meter;
pub use momentum::{angular_momentum, centre_of_mass, momentum};
pub use spring::SpringDamper;
pub use state::{BodyState, is_finite};

/// Three components, in the order x, y, z.
pub type Vector3 = nalgebra::Vector3<f64>;

/// Euclidean length, as the slides' `len()`: `sqrt((x x + y y) + z z)`.
///
/// Valid for: components below about 1e154 in size, beyond which the squares overflow.
#[must_use]
#[inline]
pub fn length(vector: &Vector3) -> f64 {
    ((vector.x * vector.x + vector.y * vector.y) + vector.z * vector.z).sqrt()
}
