//! The exact engine: from event to event, without a time step.

mod flight;
mod real;
mod wide;

pub use flight::{FlightSimulation, Simultaneous, TieOrder};
pub use real::Real;
pub use wide::Wide;
