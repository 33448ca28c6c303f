//! `carom effects`: what each effect of a scene costs, and what it changes.

use std::path::PathBuf;

use super::args::{EngineArgs, LibraryArgs, ReplaceArgs};
use super::output::{say, say_json, say_lines, spinner, warn};
use crate::case::scene_or_case;
use crate::error::{Error, Result};
use crate::report::{EFFECTS_FILES, Output, effects_findings, effects_table, write_effects};
use crate::study::{Change, REPETITIONS_MAX, Timing, effects, fits};

/// The engines unless others are asked for; the exact ones may take long, once for each effect.
const DEFAULT: [&str; 4] = ["lecture", "rapier", "rapier-f64", "rapier-matched"];

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// A scene file, or the name of a case
    scene: String,
    #[command(flatten)]
    engines: EngineArgs,
    #[command(flatten)]
    library: LibraryArgs,
    /// Timed repetitions of each row; ratios have an interval from 6 on
    #[arg(long, value_name = "N", default_value_t = 11)]
    repetitions: usize,
    /// Seed of the order of runs and of the intervals
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for the files [default: runs/effects-<scene>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    replace: ReplaceArgs,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    quiet: bool,
    /// Print JSON instead of the table
    #[arg(long, conflicts_with = "quiet")]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    if !(1..=REPETITIONS_MAX).contains(&args.repetitions) {
        return Err(Error::Argument {
            argument: "repetitions",
            found: args.repetitions.to_string(),
            remedy: format!("give 1 to {REPETITIONS_MAX}"),
        });
    }
    let specs = args.engines.specs(&DEFAULT)?;
    let case = scene_or_case(&args.scene, &args.library.library())?;
    let scene = &case.scene;
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from("runs").join(format!("effects-{}", scene.name)));
    for warning in scene.warnings() {
        warn(warning);
    }
    args.engines.prepare(scene, &specs)?;
    fits(scene, specs.len())?;
    let output = Output::open(&out, args.replace.replace())?;
    let folder = output.folder();
    folder.claim(EFFECTS_FILES)?;
    let bar = spinner(&scene.name, args.quiet);
    let timing = Timing {
        seed: args.seed,
        repetitions: args.repetitions,
    };
    let study = effects(scene, &specs, args.engines.dt, timing)?;
    write_effects(&folder, &study)?;
    output.commit()?;
    bar.finish_and_clear();
    let unchanged = study
        .rows
        .iter()
        .filter(|row| row.change == Change::Unchanged);
    for row in unchanged.filter(|row| row.outcome != "Finished") {
        warn(format_args!("{}: {}", row.engine, row.outcome_text));
    }
    if args.quiet {
        return Ok(());
    }
    if args.json {
        return say_json(&study);
    }
    say_lines(effects_table(&study))?;
    for finding in effects_findings(&study) {
        say(finding)?;
    }
    say(format_args!(
        "Written to {}",
        out.join("README.md").display()
    ))
}
