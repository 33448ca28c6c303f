//! `carom drift`: do published versions of Rapier still give what is known of them?

use std::path::{Path, PathBuf};

use super::args::{LibraryArgs, ReplaceArgs};
use super::output::{progress, say, say_json, say_lines};
use crate::error::Result;
use crate::report::{DRIFT_FILES, Output, drift_findings, drift_table, write_drift};
use crate::study::drift::{Workers, drift};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Versions of Rapier, separated by commas [default: all that have a worker]
    #[arg(long, value_name = "VERSIONS", value_delimiter = ',')]
    versions: Vec<String>,
    /// Folder of workers [default: drift/ in the sources that carom was built from]
    #[arg(long, value_name = "DIR")]
    workers: Option<PathBuf>,
    #[command(flatten)]
    library: LibraryArgs,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "runs/drift")]
    out: PathBuf,
    #[command(flatten)]
    replace: ReplaceArgs,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    quiet: bool,
    /// Print the study as JSON instead of the table
    #[arg(long, conflicts_with = "quiet")]
    json: bool,
}

/// Whether every measure came to what is known.
pub(super) fn run(args: &Args) -> Result<bool> {
    let folder = match &args.workers {
        Some(folder) => folder.clone(),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("drift"),
    };
    let workers = Workers::read(&folder)?;
    let versions = workers.chosen(&args.versions)?;
    let output = Output::open(&args.out, args.replace.replace())?;
    let out = output.folder();
    out.claim(DRIFT_FILES)?;
    let bar = progress(2 * versions.len(), args.quiet);
    let study = drift(
        &folder,
        &versions,
        &args.library.library(),
        &|what, done| {
            bar.set_position(done as u64);
            bar.set_message(what);
        },
    )?;
    bar.finish_and_clear();
    write_drift(&out, &study)?;
    output.commit()?;
    if args.json {
        say_json(&study)?;
    } else if !args.quiet {
        say_lines(drift_table(&study))?;
        for finding in drift_findings(&study) {
            say(finding)?;
        }
        say(format_args!(
            "Written to {}",
            args.out.join("README.md").display()
        ))?;
    }
    Ok(study.holds())
}
