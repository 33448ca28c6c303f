//! *How* a scene is computed: engines, what they plan to do, and the recorder that drives them.

pub mod exact;
pub mod external;
mod impulse;
mod plan;
#[cfg(feature = "rapier")]
mod rapier;
mod record;
mod spec;
mod steps;

pub use external::{ExternalSolver, Limits, trajectory_file};
pub use impulse::ImpulseSimulation;
pub use plan::{Phase, Plan};
pub use record::{drive, drive_to, record, record_within};
pub use spec::{
    CcdBody, DragRule, EngineKind, EngineSpec, ExactSettings, Forces, Impacts, ImpulseSettings,
    Integrator, LengthScale, Precision, RapierSettings, engine, engines,
};
pub use steps::{DEFAULT_DT, StepGrid};

use std::collections::BTreeMap;

use crate::error::Result;
use crate::physics::BodyState;
use crate::recording::{Concession, EventLog, Ledger, Outcome, Work};
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

    /// Bounds the counted work, if the engine can: past it, the present step ends, and what it
    /// computes is given up as [`Outcome::BudgetSpent`].
    fn limit(&mut self, _budget: u64) {}

    /// Starts to book what each phase takes and gives; whether the engine can. Until then nothing
    /// is booked, at no cost.
    fn keep_ledger(&mut self) -> bool {
        false
    }

    /// What was booked so far, once books are kept.
    fn ledger(&self) -> Option<&Ledger> {
        None
    }

    /// What the engine gave up so far to go on.
    fn concessions(&self) -> Vec<Concession> {
        Vec::new()
    }
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
        EngineKind::Impulse(settings) => Ok(impulse::simulation(scene, grid, *settings)),
        EngineKind::Exact(settings) => exact::simulation(scene, *settings),
        #[cfg(feature = "rapier")]
        EngineKind::Rapier(settings) => rapier::simulation(scene, settings, grid),
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
        EngineKind::Impulse(settings) => impulse::phases(scene, *settings),
        EngineKind::Exact(settings) => exact::phases(scene, *settings)?,
        #[cfg(feature = "rapier")]
        EngineKind::Rapier(settings) => rapier::phases(scene, settings, grid)?,
        #[cfg(not(feature = "rapier"))]
        EngineKind::Rapier(_) => return Err(not_built(spec)),
    };
    Ok(Plan {
        engine: spec.name.clone(),
        step: spec.takes_steps().then_some(grid.step),
        phases,
    })
}

/// What an engine does differently from the lecture on this scene, a line each; printed in
/// plans and reports.
///
/// For the lecture's own solver: its departures from the slides that can matter here. For a
/// Rapier world: what carom itself supplies, and what Rapier computes in another way.
#[must_use]
pub fn notes(scene: &Scene, spec: &EngineSpec) -> Vec<String> {
    match &spec.kind {
        EngineKind::Impulse(settings) => impulse::notes(scene, *settings),
        EngineKind::Exact(_) => Vec::new(),
        #[cfg(feature = "rapier")]
        EngineKind::Rapier(settings) => rapier::notes(scene, settings),
        #[cfg(not(feature = "rapier"))]
        EngineKind::Rapier(_) => Vec::new(),
    }
}

/// What an engine does to this scene from the start that has nothing to do with its physics;
/// printed where the findings are.
#[must_use]
pub fn warnings(scene: &Scene, spec: &EngineSpec) -> Vec<String> {
    match &spec.kind {
        EngineKind::Impulse(_) | EngineKind::Exact(_) => Vec::new(),
        EngineKind::Rapier(settings) => {
            #[cfg(feature = "rapier")]
            return rapier::warnings(scene, settings);
            #[cfg(not(feature = "rapier"))]
            return {
                let _ = (scene, settings);
                Vec::new()
            };
        }
    }
}

#[cfg(not(feature = "rapier"))]
fn not_built(spec: &EngineSpec) -> crate::error::Error {
    crate::error::Error::EngineNotBuilt {
        name: spec.name.clone(),
        feature: "rapier",
    }
}

/// Versions of carom and, in a build that has it, of Rapier, as the crates state them.
#[must_use]
pub fn versions() -> BTreeMap<&'static str, &'static str> {
    BTreeMap::from([
        ("carom", env!("CARGO_PKG_VERSION")),
        #[cfg(feature = "rapier")]
        ("rapier3d", rapier::VERSION),
    ])
}

/// The build, in a word for tables: what makes the same engines faster or slower.
///
/// `default`, or the features of Rapier's crates that are on, `parallel` and `simd8`; then what
/// the processor is told to be able to do beyond its family's least, and `debug` for a build
/// without full optimisation. All engines of a program are of the same build.
#[must_use]
pub fn build() -> String {
    let marks = [
        ("parallel", cfg!(feature = "rapier-parallel")),
        ("simd8", cfg!(feature = "rapier-simd8")),
        ("avx2", cfg!(target_feature = "avx2")),
        ("avx512", cfg!(target_feature = "avx512f")),
        ("debug", cfg!(debug_assertions)),
    ];
    let on: Vec<_> = marks
        .iter()
        .filter_map(|(mark, on)| on.then_some(*mark))
        .collect();
    if on.is_empty() {
        "default".to_owned()
    } else {
        on.join("+")
    }
}
