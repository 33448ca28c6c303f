//! A user's own solver: a program that reads a scene and writes a trajectory, or the trajectory
//! that it left.
//!
//! The program is a guest that is not trusted: it has a time, a number of bytes, a temporary
//! folder and a process group of its own, and whatever it does, all of them end with it.
//! `command` splits the command and fills in its placeholders, `tables` writes what the program
//! reads, `folder` is where it works, `running` is the guard that ends it, `run` watches it.

mod command;
mod folder;
mod last_words;
mod process;
mod run;
mod running;
mod tables;

pub use running::end_all;

use std::fs::File;
use std::path::Path;
use std::time::Duration;

use self::command::SolverCommand;
use super::StepGrid;
use crate::error::Result;
use crate::input;
use crate::recording::{Recording, check_start, read_trajectory, trajectory_bytes_max};
use crate::scene::Scene;

/// A user's own solver: a command, ready to be started on a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct ExternalSolver {
    command: SolverCommand,
    limits: Limits,
}

/// What a user's solver may take on one scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Time by the wall clock, from its start to its end.
    pub time: Duration,
    /// Bytes that it may write to standard output, to standard error and to its trajectory, each.
    /// Where four times what the trajectory can need is more, that is allowed.
    pub output_bytes: u64,
}

impl Default for Limits {
    /// 10 s and 1 MiB.
    fn default() -> Self {
        Self {
            time: Duration::from_secs(10),
            output_bytes: 1 << 20,
        }
    }
}

impl ExternalSolver {
    /// A solver from the words of its command, split as a shell does; no shell is started.
    ///
    /// In each argument `{scene}`, `{bodies}`, `{effects}` and `{out}` stand for paths of files,
    /// `{dt}` for the step; see `docs/your-own-solver.md`.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::error::Error::Argument) if the command is empty or a quote stays open.
    pub fn parse(command: &str, limits: Limits) -> Result<Self> {
        let command = SolverCommand::parse(command)?;
        Ok(Self { command, limits })
    }

    /// What it may take on one scene.
    #[must_use]
    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// Runs the solver on a scene and reads what it wrote. `dt` is the largest step, s; the step
    /// that the solver is told divides the time between samples.
    ///
    /// # Errors
    /// [`Error::SolverStart`](crate::error::Error::SolverStart) if the program cannot be started, [`Error::Solver`](crate::error::Error::Solver) for what it did
    /// wrong: too long, too much, a failure, no trajectory of this scene. Otherwise as
    /// [`prepare`](super::prepare).
    pub fn record(&self, voice: &str, scene: &Scene, dt: f64) -> Result<Recording> {
        scene.checked()?;
        let grid = StepGrid::new(scene, dt)?;
        let mut recording = run::run(&self.command, self.limits, voice, scene, grid)?;
        recording.step = Some(grid.step);
        Ok(recording)
    }
}

/// A trajectory that was made elsewhere, from its file.
///
/// # Errors
/// [`Error::Read`](crate::error::Error::Read), or [`Error::Table`](crate::error::Error::Table) with the line of what is no trajectory of this scene.
pub fn trajectory_file(voice: &str, scene: &Scene, path: &Path) -> Result<Recording> {
    let file = input::open(path, trajectory_bytes_max(scene))?;
    trajectory(voice, scene, file, &path.display().to_string())
}

/// Reads a trajectory from the scene's start to its end.
fn trajectory(voice: &str, scene: &Scene, input: File, name: &str) -> Result<Recording> {
    let recording = read_trajectory(voice, scene, input, name)?;
    check_start(scene, &recording, name)?;
    Ok(recording)
}
