//! Scenes without attraction and springs: flights in closed form from event to event.
//!
//! `law` says how a body flies; `encounter` and `plane` when it meets something;
//! `plan` what comes next for one body, `queue` for all; `world` lets it happen. `grid` keeps
//! the number of pairs to look at small.

mod certify;
mod encounter;
mod grid;
mod judge;
mod law;
mod model;
mod perturb;
mod plan;
mod plane;
mod queue;
mod runaway;
mod simulation;
mod turn;
mod watch;
mod world;

pub use certify::certified;

pub use simulation::FlightSimulation;
