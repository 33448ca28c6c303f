//! `carom cost`: what accuracy costs in time, on every engine.

use std::path::PathBuf;

use super::args::{LibraryArgs, chosen};
use super::output::{progress, say, warn};
use crate::case::scene_or_case;
use crate::engine::{EngineKind, EngineSpec, engines};
use crate::error::{Error, Result};
use crate::report::{CostReport, Folder, write_cost};
use crate::study::cost::{CostOptions, Machine, PHASES_MIN, Stage, scene_cost};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Scene files, or names of cases
    #[arg(required = true)]
    scenes: Vec<String>,
    /// Engines, separated by commas [default: all but exact, which errors are measured against]
    #[arg(long = "engine", value_name = "NAMES", value_delimiter = ',')]
    names: Vec<String>,
    #[command(flatten)]
    library: LibraryArgs,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "runs/cost")]
    out: PathBuf,
    /// Seed of the order of runs and of the intervals
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Rounds of timing after a warm-up
    #[arg(long, default_value_t = 5)]
    repetitions: usize,
    /// Work a run may take, in steps x (bodies + pairs)
    #[arg(long, default_value_t = 1_000_000)]
    budget: u64,
    /// Later starts from which every engine runs again, for orders and limits; best odd
    #[arg(long, default_value_t = 7)]
    phases: usize,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    quiet: bool,
}

/// Whether it is the engine that errors are measured against.
fn is_reference(spec: &EngineSpec) -> bool {
    matches!(spec.kind, EngineKind::Exact(settings) if settings.certify)
}

fn specs(names: &[String]) -> Result<Vec<EngineSpec>> {
    if names.is_empty() {
        let built = engines().into_iter().filter(EngineSpec::is_built);
        return Ok(built.filter(|spec| !is_reference(spec)).collect());
    }
    let specs = chosen(names, &[])?;
    match specs.iter().find(|spec| is_reference(spec)) {
        Some(spec) => Err(Error::Argument {
            argument: "engine",
            found: spec.name.clone(),
            remedy: "errors are measured against it; its price is that of exact-fast".into(),
        }),
        None => Ok(specs),
    }
}

/// Numbers that no study can be made with.
fn check(args: &Args) -> Result<()> {
    let phases = format!("give at least {PHASES_MIN}: fewer have no scatter to speak of");
    let above_zero = || "give a number above 0".to_owned();
    for (argument, found, least, remedy) in [
        ("repetitions", args.repetitions as u64, 1, above_zero()),
        ("budget", args.budget, 1, above_zero()),
        ("phases", args.phases as u64, PHASES_MIN as u64, phases),
    ] {
        if found < least {
            return Err(Error::Argument {
                argument,
                found: found.to_string(),
                remedy,
            });
        }
    }
    Ok(())
}

pub(super) fn run(args: &Args) -> Result<()> {
    let specs = specs(&args.names)?;
    check(args)?;
    let library = args.library.library();
    let mut scenes = Vec::new();
    for name in &args.scenes {
        let scene = scene_or_case(name, &library)?.scene;
        if scenes
            .iter()
            .all(|known: &crate::scene::Scene| known.name != scene.name)
        {
            scenes.push(scene);
        }
    }
    let options = CostOptions {
        seed: args.seed,
        repetitions: args.repetitions,
        budget: args.budget,
        phases: args.phases,
    };
    let folder = Folder::open(&args.out)?;
    let mut report = CostReport {
        options,
        machine: Machine::this(),
        scenes: Vec::new(),
    };
    for scene in &scenes {
        for warning in scene.warnings() {
            warn(format_args!("{}: {warning}", scene.name));
        }
        let bar = progress(1, args.quiet);
        let cost = scene_cost(scene, &specs, &options, &|stage, done, all| {
            let doing = match stage {
                Stage::Reference => "reference",
                Stage::Errors => "errors",
                Stage::Phases => "errors from later starts",
                Stage::Pricing => "prices",
                Stage::PushOut => "prices of push-out",
            };
            bar.set_length(all as u64);
            bar.set_position(done as u64);
            bar.set_message(format!("{}: {doing}", scene.name));
        })?;
        bar.finish_and_clear();
        for note in &cost.notes {
            warn(format_args!("{}: {note}", scene.name));
        }
        report.scenes.push(cost);
        // After each scene, so that an interrupted study leaves what it has found.
        write_cost(&folder, &report)?;
    }
    if args.quiet {
        return Ok(());
    }
    say(format_args!(
        "Written to {}",
        folder.path().join("README.md").display()
    ))
}
