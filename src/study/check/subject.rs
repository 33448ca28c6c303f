//! What is checked: anything that computes a scene.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Instant;

use crate::engine::external::{ExternalSolver, Limits, trajectory_file};
use crate::engine::{EngineKind, EngineSpec, Precision, Simulation, StepGrid, drive, record};
use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::scene::Scene;

/// Anything that computes a scene and can be held against what is known about it.
pub trait Subject: Sync {
    /// The name in reports.
    fn name(&self) -> &str;

    /// Computes a scene with steps of `dt` s at most.
    ///
    /// # Errors
    /// What kept it from that.
    fn record(&self, scene: &Scene, dt: f64) -> Result<Recording>;

    /// The relative distance of neighbouring numbers in its arithmetic.
    fn epsilon(&self) -> f64 {
        f64::EPSILON
    }

    /// The crates of whose versions its results may depend.
    fn crates(&self) -> &'static [&'static str] {
        &["carom"]
    }
}

impl Subject for EngineSpec {
    fn name(&self) -> &str {
        &self.name
    }

    fn record(&self, scene: &Scene, dt: f64) -> Result<Recording> {
        record(scene, self, dt)
    }

    fn epsilon(&self) -> f64 {
        match &self.kind {
            EngineKind::Rapier(settings) if settings.precision == Precision::Single => {
                f32::EPSILON.into()
            }
            EngineKind::Impulse(_) | EngineKind::Exact(_) | EngineKind::Rapier(_) => f64::EPSILON,
        }
    }

    fn crates(&self) -> &'static [&'static str] {
        match self.kind {
            EngineKind::Impulse(_) | EngineKind::Exact(_) => &["carom"],
            EngineKind::Rapier(_) => &["carom", "rapier3d"],
        }
    }
}

/// A simulation of your own: implements the trait that carom's engines implement.
pub struct Own<F> {
    name: String,
    make: F,
}

impl<F, S> Own<F>
where
    F: Fn(&Scene, StepGrid) -> S + Sync,
    S: Simulation,
{
    /// `make` puts your simulation at the start of a scene, to take the steps of a grid.
    pub fn new(name: impl Into<String>, make: F) -> Self {
        Self {
            name: name.into(),
            make,
        }
    }
}

impl<F, S> Subject for Own<F>
where
    F: Fn(&Scene, StepGrid) -> S + Sync,
    S: Simulation,
{
    fn name(&self) -> &str {
        &self.name
    }

    fn record(&self, scene: &Scene, dt: f64) -> Result<Recording> {
        scene.checked()?;
        let grid = StepGrid::new(scene, dt)?;
        let mut simulation = (self.make)(scene, grid);
        let mut recording = drive(scene, &self.name, &mut simulation);
        recording.step = Some(grid.step);
        Ok(recording)
    }
}

/// Cases on which a program ran out of time before it is given up, if it finished none.
const TIMEOUTS_MAX: u32 = 2;

/// A program that writes trajectories, as a solver.
pub struct Program {
    solver: ExternalSolver,
    finished: AtomicBool,
    timeouts: AtomicU32,
}

impl Program {
    /// The program that a command line starts, with what it may take on a case.
    ///
    /// # Errors
    /// As [`ExternalSolver::parse`].
    pub fn parse(command: &str, limits: Limits) -> Result<Self> {
        Ok(Self {
            solver: ExternalSolver::parse(command, limits)?,
            finished: AtomicBool::new(false),
            timeouts: AtomicU32::new(0),
        })
    }
}

impl Subject for Program {
    fn name(&self) -> &'static str {
        "solver"
    }

    /// A program that hangs on its first cases is not started on the others: it would take its
    /// time on each of them.
    fn record(&self, scene: &Scene, dt: f64) -> Result<Recording> {
        let timeouts = self.timeouts.load(Ordering::Relaxed);
        if timeouts >= TIMEOUTS_MAX && !self.finished.load(Ordering::Relaxed) {
            return Err(Error::Solver {
                scene: scene.name.clone(),
                message: format!(
                    "not started: it ran out of time on {timeouts} cases and finished none"
                ),
            });
        }
        let begin = Instant::now();
        let recorded = self.solver.record(self.name(), scene, dt);
        match &recorded {
            Ok(_) => self.finished.store(true, Ordering::Relaxed),
            Err(_) if begin.elapsed() >= self.solver.limits().time => {
                self.timeouts.fetch_add(1, Ordering::Relaxed);
            }
            Err(_) => {}
        }
        recorded
    }
}

/// A trajectory that was made elsewhere, as a solver of its one scene.
pub struct TrajectoryFile {
    name: String,
    path: PathBuf,
}

impl TrajectoryFile {
    /// The trajectory in that file.
    #[must_use]
    pub fn new(path: PathBuf) -> Self {
        Self {
            name: path.display().to_string(),
            path,
        }
    }
}

impl Subject for TrajectoryFile {
    fn name(&self) -> &str {
        &self.name
    }

    fn record(&self, scene: &Scene, _dt: f64) -> Result<Recording> {
        trajectory_file(&self.name, scene, &self.path)
    }
}
