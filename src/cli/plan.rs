//! `carom plan`: the phases of a step, engine by engine.

use std::fmt::Write;

use super::args::{EngineArgs, LibraryArgs};
use super::output::say;
use crate::case::scene_or_case;
use crate::engine::{Plan, notes, plan};
use crate::error::Result;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// A scene file, or the name of a case
    scene: String,
    #[command(flatten)]
    engines: EngineArgs,
    #[command(flatten)]
    library: LibraryArgs,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> Result<()> {
    let specs = args
        .engines
        .specs(&["lecture", "rapier", "rapier-f64", "rapier-matched"])?;
    let case = scene_or_case(&args.scene, &args.library.library())?;
    let plans = specs
        .iter()
        .map(|spec| plan(&case.scene, spec, args.engines.dt))
        .collect::<Result<Vec<_>>>()?;
    if args.json {
        return say(serde_json::to_string_pretty(&plans)?);
    }
    for (plan, spec) in plans.iter().zip(&specs) {
        say(in_words(plan, &notes(&case.scene, spec)))?;
    }
    Ok(())
}

fn in_words(plan: &Plan, notes: &[String]) -> String {
    let step = plan
        .step
        .map_or_else(|| "no step".to_owned(), |step| format!("step {step} s"));
    let mut text = format!("{}, {step}\n", plan.engine);
    for (number, phase) in plan.phases.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "  {:2}  {:<11} {}",
            number + 1,
            phase.name,
            phase.method
        );
    }
    for note in notes {
        let _ = writeln!(text, "      * {note}");
    }
    text
}
