//! Rapier worlds: the engines `rapier`, `rapier-f64`, `rapier-matched` and `rapier-tuned`.
//!
//! The only folder that names Rapier. What a scene calls for is laid out in plain numbers
//! ([`layout`]); `worlds` builds it from the crate of the wanted precision, one source for
//! both; [`simulation`] steps it, adds the forces that Rapier has no feature for ([`harness`])
//! and tells events from the impulses of contact pairs ([`watch`]).

mod describe;
mod harness;
mod layout;
mod range;
mod simulation;
mod watch;
mod world;
mod worlds;

pub use describe::{VERSION, notes, warnings};

use super::{Phase, Precision, RapierSettings, Simulation, StepGrid};
use crate::error::Result;
use crate::scene::Scene;
use layout::Layout;
use simulation::RapierSimulation;
use world::{Parameters, World};

/// Puts a checked scene at its start.
///
/// # Errors
/// [`Error::EngineCannot`](crate::error::Error::EngineCannot) if a number of the scene means
/// nothing in that precision, such as a radius that rounds to zero.
pub fn simulation(
    scene: &Scene,
    settings: &RapierSettings,
    grid: StepGrid,
) -> Result<Box<dyn Simulation + Send>> {
    let layout = laid_out(scene, settings, grid)?;
    Ok(match settings.precision {
        Precision::Single => Box::new(RapierSimulation::<worlds::Single>::new(scene, layout, grid)),
        Precision::Double => Box::new(RapierSimulation::<worlds::Double>::new(scene, layout, grid)),
    })
}

/// The phases of a step of this scene, in order.
///
/// # Errors
/// As [`simulation`].
pub fn phases(scene: &Scene, settings: &RapierSettings, grid: StepGrid) -> Result<Vec<Phase>> {
    let layout = laid_out(scene, settings, grid)?;
    let parameters = parameters(settings, layout.length_unit, grid.step);
    Ok(describe::phases(scene, &layout, &parameters))
}

fn laid_out(scene: &Scene, settings: &RapierSettings, grid: StepGrid) -> Result<Layout> {
    let layout = Layout::new(scene, settings, grid.step)?;
    let parameters = parameters(settings, layout.length_unit, grid.step);
    layout.check_joints(scene, parameters.substeps)?;
    Ok(layout)
}

/// The parameters that a world with these settings runs with, Rapier's defaults included.
fn parameters(settings: &RapierSettings, length_unit: f64, step: f64) -> Parameters {
    match settings.precision {
        Precision::Single => worlds::Single::parameters(settings, length_unit, step),
        Precision::Double => worlds::Double::parameters(settings, length_unit, step),
    }
}
