//! `carom plan`: the phases of a step, engine by engine.

use std::fmt::Write;

use serde::Serialize;

use super::args::{EngineArgs, LibraryArgs, REPORTED};
use super::output::{say, say_json, say_lines};
use crate::case::scene_or_case;
use crate::engine::{EngineSpec, Plan, notes, plan};
use crate::error::{Error, Result, harmless, number};
use crate::scene::Scene;
use crate::study::Refusal;

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
    let specs = args.engines.specs(&REPORTED)?;
    let case = scene_or_case(&args.scene, &args.library.library())?;
    args.engines.prepare(&case.scene, &specs)?;
    let plans = specs
        .iter()
        .map(|spec| Row::of(&case.scene, spec, args.engines.dt))
        .collect::<Result<Vec<_>>>()?;
    if args.json {
        return say_json(&plans);
    }
    for (row, spec) in plans.iter().zip(&specs) {
        match row {
            Row::Plan(plan) => say_lines(in_words(plan, &notes(&case.scene, spec)))?,
            Row::Refusal(Refusal { engine, reason }) => {
                say(engine)?;
                say(format_args!("      * {reason}"))?;
                say("")?;
            }
        }
    }
    Ok(())
}

/// What an engine does, or why it cannot.
#[derive(Serialize)]
#[serde(untagged)]
enum Row {
    Plan(Plan),
    Refusal(Refusal),
}

impl Row {
    fn of(scene: &Scene, spec: &EngineSpec, dt: f64) -> Result<Self> {
        match plan(scene, spec, dt) {
            Ok(plan) => Ok(Self::Plan(plan)),
            Err(refusal @ Error::EngineCannot { .. }) => Ok(Self::Refusal(Refusal {
                engine: spec.name.clone(),
                reason: refusal.to_string(),
            })),
            Err(error) => Err(error),
        }
    }
}

fn in_words(plan: &Plan, notes: &[String]) -> String {
    let step = plan.step.map_or_else(
        || "no step".to_owned(),
        |step| format!("step {} s", number(step)),
    );
    let mut text = format!("{}, {step}\n", harmless(&plan.engine));
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
        let _ = writeln!(text, "      * {}", harmless(note));
    }
    text
}
