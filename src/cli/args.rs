//! Arguments that several subcommands share.

use std::path::PathBuf;

use clap::Args;

use crate::case::Library;
use crate::engine::{DEFAULT_DT, EngineSpec, engine, engines, prepare};
use crate::error::{Error, Result};
use crate::report::Replace;
use crate::scene::Scene;

/// Which engines, and with which step.
#[derive(Debug, Args)]
pub(super) struct EngineArgs {
    /// Engines, separated by commas; pictures show the first two that take steps, and exact or truth
    #[arg(long = "engine", value_name = "NAMES", value_delimiter = ',')]
    names: Vec<String>,
    /// Largest time step, s; the step taken divides the time between samples
    #[arg(long, value_name = "SECONDS", default_value_t = DEFAULT_DT, allow_negative_numbers = true)]
    pub dt: f64,
}

impl EngineArgs {
    /// Sees that the engines can start on a scene. One that was not asked for by name may refuse:
    /// the comparison then says so.
    pub fn prepare(&self, scene: &Scene, specs: &[EngineSpec]) -> Result<()> {
        for spec in specs {
            match prepare(scene, spec, self.dt) {
                Err(Error::EngineCannot { .. }) if self.names.is_empty() => {}
                started => drop(started?),
            }
        }
        Ok(())
    }

    /// Whether engines were asked for by name.
    pub fn are_named(&self) -> bool {
        !self.names.is_empty()
    }

    /// The engines asked for, or these of the ones this build has.
    pub fn specs(&self, default: &[&str]) -> Result<Vec<EngineSpec>> {
        chosen(&self.names, default)
    }
}

/// The engines of these names; without names, those of `default` that this build has.
pub(super) fn chosen(names: &[String], default: &[&str]) -> Result<Vec<EngineSpec>> {
    if names.is_empty() {
        let built = engines().into_iter().filter(EngineSpec::is_built);
        return Ok(built
            .filter(|spec| default.contains(&spec.name.as_str()))
            .collect());
    }
    let mut specs: Vec<EngineSpec> = Vec::new();
    for name in names {
        let spec = engine(name.trim())?;
        if specs.contains(&spec) {
            return Err(Error::EngineTwice { name: spec.name });
        }
        specs.push(spec);
    }
    Ok(specs)
}

/// The engines that a report compares unless others are asked for.
pub(super) const REPORTED: [&str; 5] =
    ["lecture", "rapier", "rapier-f64", "rapier-matched", "exact"];

/// What the files of a result may replace.
#[derive(Debug, Args)]
pub(super) struct ReplaceArgs {
    /// Replace files in the output folder that carom did not write, or that were changed since
    #[arg(long)]
    force: bool,
}

impl ReplaceArgs {
    pub fn replace(&self) -> Replace {
        if self.force {
            Replace::All
        } else {
            Replace::Own
        }
    }
}

/// Where cases come from.
#[derive(Debug, Args)]
pub(super) struct LibraryArgs {
    /// Folder of cases [default: reference/ if there is one, else those compiled in]
    #[arg(long, value_name = "DIR")]
    reference: Option<PathBuf>,
}

impl LibraryArgs {
    pub fn library(&self) -> Library {
        Library::choose(self.reference.as_deref())
    }
}
