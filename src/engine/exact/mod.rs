//! The exact engine: from event to event, without a time step.

mod flight;
mod real;
mod wide;

pub use flight::{
    Certified, Digits, FlightSimulation, Simultaneous, TieOrder, Undetermined, certified,
};
pub use real::Real;
pub use wide::Wide;
