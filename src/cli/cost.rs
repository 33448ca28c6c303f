//! `carom cost`: what accuracy costs in time, on every engine.

use std::path::PathBuf;

use super::args::{LibraryArgs, chosen};
use super::output::{progress, say, warn};
use crate::case::{Library, scene_or_case};
use crate::engine::{EngineKind, EngineSpec, engines};
use crate::error::{Error, Result};
use crate::report::{CostReport, Folder, write_cost};
use crate::scene::Scene;
use crate::study::cost::{CostOptions, Machine, Stage, Tuning, scene_cost, tune};

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
    /// Runs that each search of settings may take
    #[arg(long, value_name = "N", default_value_t = 180)]
    runs: usize,
    /// Tune the hand-written solver and Rapier on these other scenes, separated by commas
    #[arg(long, value_name = "SCENES", value_delimiter = ',')]
    tune_on: Vec<String>,
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

/// The scenes of these names, each once.
fn read(names: &[String], library: &Library) -> Result<Vec<Scene>> {
    let mut scenes: Vec<Scene> = Vec::new();
    for name in names {
        let scene = scene_or_case(name, library)?.scene;
        if scenes.iter().all(|known| known.name != scene.name) {
            scenes.push(scene);
        }
    }
    Ok(scenes)
}

/// What a search finds on other scenes than those that are scored; nothing if it is not asked for.
fn tuned(
    tune_on: &[Scene],
    scenes: &[Scene],
    options: &CostOptions,
    quiet: bool,
) -> Result<Option<Tuning>> {
    if tune_on.is_empty() {
        return Ok(None);
    }
    let bar = progress(1, quiet);
    let tuning = tune(tune_on, scenes, options, &|family, done, most| {
        bar.set_length(most as u64);
        bar.set_position(done as u64);
        bar.set_message(format!("tuning {}", family.word()));
    })?;
    bar.finish_and_clear();
    Ok(Some(tuning))
}

pub(super) fn run(args: &Args) -> Result<()> {
    let mut specs = specs(&args.names)?;
    for (argument, is_zero) in [
        ("repetitions", args.repetitions == 0),
        ("budget", args.budget == 0),
        ("runs", args.runs == 0),
    ] {
        if is_zero {
            return Err(Error::Argument {
                argument,
                found: "0".into(),
                remedy: "give a number above 0".into(),
            });
        }
    }
    let library = args.library.library();
    let scenes = read(&args.scenes, &library)?;
    let tune_on = read(&args.tune_on, &library)?;
    let options = CostOptions {
        seed: args.seed,
        repetitions: args.repetitions,
        budget: args.budget,
        runs: args.runs,
    };
    let tuning = tuned(&tune_on, &scenes, &options, args.quiet)?;
    for family in tuning.iter().flat_map(|tuning| &tuning.families) {
        // In the place of the preset of that name, if it takes part.
        specs.retain(|spec| spec.name != family.spec.name);
        specs.push(family.spec.clone());
    }
    let folder = Folder::open(&args.out)?;
    let mut report = CostReport {
        options,
        machine: Machine::this(),
        tuning,
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
                Stage::Pricing => "prices",
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
