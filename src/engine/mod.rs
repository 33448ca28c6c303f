//! *How* a scene is computed: engines, what they plan to do, and the recorder that drives them.

pub mod exact;
mod impulse;
mod plan;
#[cfg(feature = "rapier")]
mod rapier;
mod record;
mod spec;
mod steps;

pub use impulse::ImpulseSimulation;
pub use plan::{Phase, Plan};
pub use record::record;
pub use spec::{EngineKind, EngineSpec, Forces, Precision, RapierSettings, engine, engines};
pub use steps::{DEFAULT_DT, StepGrid};

use crate::error::Result;
use crate::physics::BodyState;
use crate::recording::{EventLog, Outcome, Work};
use crate::scene::Scene;

/// A scene in the course of being computed, one sample after the other.
///
/// A recorder drives it and observes; a stopwatch calls [`advance_to`](Self::advance_to) alone,
/// without a log, and then nothing is observed at no cost.
pub trait Simulation {
    /// Computes on until the time of that sample; earlier samples are no-ops.
    ///
    /// With a `log`, notes every event on the way. Gives the outcome if the engine cannot go
    /// on; the state is then no longer meaningful.
    fn advance_to(&mut self, sample: usize, log: Option<&mut EventLog>) -> Option<Outcome>;

    /// Copies the present state. Shape of `into`: `[body]`.
    fn state_into(&self, into: &mut [BodyState]);

    /// Puts the simulation on a sample with these states. Shape: `[body]`.
    fn set_state(&mut self, sample: usize, states: &[BodyState]);

    /// Work counted so far.
    fn work(&self) -> Work;
}

/// Prepares an engine for a scene: checks that it can, plans only what the scene declares.
///
/// `dt` is the largest step, s; the step taken divides the time between samples.
///
/// # Errors
/// A scene that is not one, a step that cannot be taken, an engine that this build leaves out
/// or that cannot do an effect of the scene.
pub fn prepare(scene: &Scene, spec: &EngineSpec, dt: f64) -> Result<Box<dyn Simulation + Send>> {
    scene.checked()?;
    let grid = StepGrid::new(scene, dt)?;
    match &spec.kind {
        EngineKind::Impulse => Ok(Box::new(ImpulseSimulation::new(scene, grid))),
        #[cfg(feature = "rapier")]
        EngineKind::Rapier(settings) => Ok(rapier::simulation(scene, settings, grid)),
        #[cfg(not(feature = "rapier"))]
        EngineKind::Rapier(_) => Err(not_built(spec)),
    }
}

/// The phases of one step of an engine on a scene, in order; nothing else runs.
///
/// # Errors
/// As [`prepare`].
pub fn plan(scene: &Scene, spec: &EngineSpec, dt: f64) -> Result<Plan> {
    scene.checked()?;
    let grid = StepGrid::new(scene, dt)?;
    let phases = match &spec.kind {
        EngineKind::Impulse => ImpulseSimulation::new(scene, grid).phases(),
        #[cfg(feature = "rapier")]
        EngineKind::Rapier(settings) => rapier::phases(scene, settings, grid),
        #[cfg(not(feature = "rapier"))]
        EngineKind::Rapier(_) => return Err(not_built(spec)),
    };
    Ok(Plan {
        engine: spec.name.clone(),
        step: grid.step,
        phases,
    })
}

#[cfg(not(feature = "rapier"))]
fn not_built(spec: &EngineSpec) -> crate::error::Error {
    crate::error::Error::EngineNotBuilt {
        name: spec.name.clone(),
        feature: "rapier",
    }
}

/// Placeholder until merge.
pub fn notes(_scene: &Scene, _spec: &EngineSpec) -> Vec<String> {
    Vec::new()
}
/// Versions.
pub fn versions() -> std::collections::BTreeMap<&'static str, String> {
    std::collections::BTreeMap::from([("carom", env!("CARGO_PKG_VERSION").to_owned())])
}
