//! `carom report`: every case on every engine.

use std::path::PathBuf;

use rayon::prelude::*;

use super::args::{EngineArgs, LibraryArgs, REPORTED, ReplaceArgs};
use super::output::{progress, say, warn};
use super::studies::{self, Order};
use crate::case::{self, Case};
use crate::engine::EngineSpec;
use crate::error::{Error, Result};
use crate::report::{
    Folder, INDEX_FILES, Output, Place, Studies, claim_comparison, write_comparison, write_index,
};
use crate::study::{Summary, fits, side_by_side};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Names of cases [default: all]
    cases: Vec<String>,
    #[command(flatten)]
    engines: EngineArgs,
    #[command(flatten)]
    library: LibraryArgs,
    /// Studies to make beside the cases, separated by commas: cost, stability (some minutes each). Without it the
    /// report tells of those that its folder holds already, with their date
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    studies: Vec<String>,
    /// Folder for the report
    #[arg(long, value_name = "DIR", default_value = "reports")]
    out: PathBuf,
    #[command(flatten)]
    replace: ReplaceArgs,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let specs = args.engines.specs(&REPORTED)?;
    let dt = args.engines.dt;
    let cases = cases(args)?;
    let scenes: Vec<_> = cases.iter().map(|case| &case.scene).collect();
    let asked = studies::asked(&args.studies, &scenes)?;
    let pairs = cases
        .iter()
        .flat_map(|case| specs.iter().map(move |spec| (case, spec)));
    for (case, spec) in pairs {
        match crate::engine::prepare(&case.scene, spec, dt) {
            // A refusal is a result: the report says so where the case stands.
            Ok(_) | Err(Error::EngineCannot { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    for case in &cases {
        fits(&case.scene, specs.len() + usize::from(case.truth.is_some()))?;
    }
    let output = Output::open(&args.out, args.replace.replace())?;
    let folder = output.folder();
    folder.claim(INDEX_FILES)?;
    for case in &cases {
        claim_comparison(&folder.folder(&case.scene.name), &specs)?;
    }
    for case in &cases {
        for warning in case.scene.warnings() {
            warn(format_args!("{}: {warning}", case.scene.name));
        }
    }
    for study in &asked {
        study.claim(&folder, &scenes)?;
    }
    for study in asked {
        study.make(&Order {
            scenes: &scenes,
            engines: args.engines.are_named().then_some(&specs[..]),
            report: &folder,
            quiet: args.quiet,
        })?;
    }
    let (studies, complaints) = Studies::read(&folder);
    for complaint in complaints {
        warn(complaint);
    }
    let summaries = compare(args, &cases, &specs, &folder, &studies)?;
    write_index(&folder, &summaries, &specs, dt, &studies)?;
    output.commit()?;
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
        args.out.join("README.md").display()
    ))
}

/// The cases asked for, or all of them.
fn cases(args: &Args) -> Result<Vec<Case>> {
    let library = args.library.library();
    let mut names = if args.cases.is_empty() {
        library.names()?
    } else {
        args.cases.clone()
    };
    names.sort();
    names.dedup();
    let cases = names.iter().map(|name| case::case(name, &library));
    let cases = cases.collect::<Result<Vec<Case>>>()?;
    if cases.is_empty() {
        return Err(Error::NoCases);
    }
    Ok(cases)
}

/// Runs every case on every engine and writes its folder.
fn compare(
    args: &Args,
    cases: &[Case],
    specs: &[EngineSpec],
    folder: &Folder,
    studies: &Studies,
) -> Result<Vec<Summary>> {
    let bar = progress(cases.len(), args.quiet);
    let compared = cases.par_iter().map(|case| {
        bar.set_message(case.scene.name.clone());
        let comparison = side_by_side(case, specs, args.engines.dt)?;
        let own = folder.folder(&case.scene.name);
        let summary = write_comparison(&own, &comparison, Place::InReport(studies))?;
        bar.inc(1);
        Ok(summary)
    });
    let summaries = compared.collect::<Result<Vec<_>>>()?;
    bar.finish_and_clear();
    Ok(summaries)
}

fn counted(count: usize, what: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {what}{plural}")
}
