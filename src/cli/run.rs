//! `carom run`: one scene on some engines.

use std::path::PathBuf;

use super::args::{EngineArgs, LibraryArgs, ReplaceArgs};
use super::output::{say, say_json, spinner, warn};
use crate::case::scene_or_case;
use crate::error::Result;
use crate::report::{Output, Place, claim_comparison, findings, write_comparison};
use crate::study::{fits, side_by_side};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// A scene file, or the name of a case
    scene: String,
    #[command(flatten)]
    engines: EngineArgs,
    #[command(flatten)]
    library: LibraryArgs,
    /// Folder for the files [default: runs/<scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    replace: ReplaceArgs,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    quiet: bool,
    /// Print summary.json instead of sentences
    #[arg(long, conflicts_with = "quiet")]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let specs = args.engines.specs(&["lecture", "rapier", "exact"])?;
    let case = scene_or_case(&args.scene, &args.library.library())?;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from("runs").join(&case.scene.name));
    for warning in case.scene.warnings() {
        warn(warning);
    }
    args.engines.prepare(&case.scene, &specs)?;
    fits(&case.scene, specs.len() + usize::from(case.truth.is_some()))?;
    let output = Output::open(&out, args.replace.replace())?;
    let folder = output.folder();
    claim_comparison(&folder, &specs)?;
    let bar = spinner(&case.scene.name, args.quiet);
    let comparison = side_by_side(&case, &specs, args.engines.dt)?;
    let summary = write_comparison(&folder, &comparison, Place::Alone)?;
    output.commit()?;
    bar.finish_and_clear();
    for voice in summary
        .voices
        .iter()
        .filter(|voice| !voice.outcome.is_finished())
    {
        warn(format_args!("{}: {}", voice.voice, voice.outcome_text));
    }
    if args.quiet {
        return Ok(());
    }
    if args.json {
        return say_json(&summary);
    }
    let names: Vec<_> = summary
        .voices
        .iter()
        .map(|voice| voice.voice.as_str())
        .collect();
    for (who, what) in findings(&summary, &names) {
        say(format_args!("{who} {what}"))?;
    }
    say(format_args!(
        "Written to {}",
        out.join("README.md").display()
    ))
}
