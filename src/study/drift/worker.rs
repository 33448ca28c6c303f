//! A built worker, as a subject.

use std::path::Path;

use crate::engine::{ExternalSolver, Limits};
use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::scene::Scene;
use crate::study::check::Subject;

/// A program that computes scenes with one version of Rapier, in single precision.
#[derive(Debug, Clone, PartialEq)]
pub struct Worker {
    name: String,
    program: String,
}

impl Worker {
    /// The worker of that name.
    ///
    /// # Errors
    /// [`Error::DriftWorker`] if its path is not UTF-8.
    pub fn new(name: &str, program: &Path) -> Result<Self> {
        let unquoted = || Error::DriftWorker {
            worker: name.to_owned(),
            message: format!(
                "{} is not UTF-8; put carom's sources into a folder that is",
                program.display()
            ),
        };
        let program = program
            .to_str()
            .and_then(|path| shlex::try_quote(path).ok());
        Ok(Self {
            name: name.to_owned(),
            program: program.ok_or_else(unquoted)?.into_owned(),
        })
    }
}

impl Subject for Worker {
    fn name(&self) -> &str {
        &self.name
    }

    /// The tables of a scene do not tell its unit, and Rapier wants to know how long a metre is.
    fn record(&self, scene: &Scene, dt: f64) -> Result<Recording> {
        let (program, unit) = (&self.program, scene.units.length.per_metre());
        let command = format!("{program} {{bodies}} {{effects}} {{out}} {unit}");
        ExternalSolver::parse(&command, Limits::default())?.record(&self.name, scene, dt)
    }

    fn epsilon(&self) -> f64 {
        f32::EPSILON.into()
    }
}
