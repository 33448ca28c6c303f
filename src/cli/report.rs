//! `carom report`: every case on every engine.

use std::path::PathBuf;

use rayon::prelude::*;

use super::args::{EngineArgs, LibraryArgs, REPORTED};
use super::output::{progress, say, warn};
use crate::case::{self, Case};
use crate::error::{Error, Result};
use crate::report::{Folder, Place, write_comparison, write_index};
use crate::study::side_by_side;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Names of cases [default: all]
    cases: Vec<String>,
    #[command(flatten)]
    engines: EngineArgs,
    #[command(flatten)]
    library: LibraryArgs,
    /// Folder for the report
    #[arg(long, value_name = "DIR", default_value = "reports")]
    out: PathBuf,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let specs = args.engines.specs(&REPORTED)?;
    let dt = args.engines.dt;
    let library = args.library.library();
    let mut names = if args.cases.is_empty() {
        library.names()?
    } else {
        args.cases.clone()
    };
    names.sort();
    names.dedup();
    let cases = names
        .iter()
        .map(|name| case::case(name, &library))
        .collect::<Result<Vec<Case>>>()?;
    if cases.is_empty() {
        return Err(Error::NoCases);
    }
    for (case, spec) in cases
        .iter()
        .flat_map(|case| specs.iter().map(move |spec| (case, spec)))
    {
        match crate::engine::prepare(&case.scene, spec, dt) {
            // A refusal is a result: the report says so where the case stands.
            Ok(_) | Err(Error::EngineCannot { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    let folder = Folder::open(&args.out)?;
    // Until the new index stands, none tells of cases that are no longer as it says.
    folder.remove(|name| ["README.md", "summary.json"].contains(&name))?;
    for case in &cases {
        for warning in case.scene.warnings() {
            warn(format_args!("{}: {warning}", case.scene.name));
        }
    }
    let bar = progress(cases.len(), args.quiet);
    let summaries = cases
        .par_iter()
        .map(|case| {
            bar.set_message(case.scene.name.clone());
            let comparison = side_by_side(case, &specs, dt)?;
            let own = folder.folder(&case.scene.name)?;
            let summary = write_comparison(&own, &comparison, Place::InReport)?;
            bar.inc(1);
            Ok(summary)
        })
        .collect::<Result<Vec<_>>>()?;
    bar.finish_and_clear();
    write_index(&folder, &summaries, &specs, dt)?;
    for summary in &summaries {
        for voice in summary
            .voices
            .iter()
            .filter(|voice| !voice.outcome.is_finished())
        {
            warn(format_args!(
                "{}: {}: {}",
                summary.scene, voice.voice, voice.outcome_text
            ));
        }
    }
    if args.quiet {
        return Ok(());
    }
    say(format_args!(
        "{} on {}: {}",
        counted(summaries.len(), "case"),
        counted(specs.len(), "engine"),
        folder.path().join("README.md").display()
    ))
}

fn counted(count: usize, what: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {what}{plural}")
}
