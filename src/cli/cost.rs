//! `carom cost`: what accuracy costs in time, on every engine.

use std::path::{Path, PathBuf};

use super::args::{LibraryArgs, ReplaceArgs, chosen};
use super::bodies::BodiesArgs;
use super::output::{progress, say, warn};
use super::studies::{COST_OPTIONS, Order};
use crate::case::{Library, scene_or_case};
use crate::engine::{EngineKind, EngineSpec, engines};
use crate::error::{Error, Result};
use crate::report::{CostReport, Folder, Output, claim_cost};
use crate::scene::Scene;
use crate::study::cost::{CostOptions, PHASES_MIN, Stage, Tuning, scene_cost, tune};
use crate::study::{BUDGET_MAX, PHASES_MAX, REPETITIONS_MAX, RUNS_MAX, Timing};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Scene files, or names of cases
    #[arg(required_unless_present = "sizes")]
    scenes: Vec<String>,
    /// Engines, separated by commas [default: all but exact, which errors are measured against, and
    /// robust, whose steps are its own]
    #[arg(long = "engine", value_name = "NAMES", value_delimiter = ',')]
    names: Vec<String>,
    #[command(flatten)]
    bodies: BodiesArgs,
    #[command(flatten)]
    library: LibraryArgs,
    /// Folder for the files [default: runs/cost, or runs/bodies with --bodies]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    replace: ReplaceArgs,
    /// Seed of the order of runs and of the intervals
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Rounds of timing after a warm-up; ratios have an interval from 6 on
    #[arg(long, default_value_t = 7)]
    repetitions: usize,
    /// Work a run may take, in steps x (bodies + pairs) [default: 1000000, or 300000000 with
    /// --bodies]
    #[arg(long)]
    budget: Option<u64>,
    /// Later starts from which every engine runs again, for orders and limits; best odd
    #[arg(long, default_value_t = 7)]
    phases: usize,
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

/// Work a run may take unless told otherwise.
const BUDGET: u64 = 1_000_000;

/// Whether it is the engine that errors are measured against.
fn is_reference(spec: &EngineSpec) -> bool {
    matches!(spec.kind, EngineKind::Exact(settings) if settings.certify)
}

fn specs(names: &[String]) -> Result<Vec<EngineSpec>> {
    if names.is_empty() {
        let built = engines().into_iter().filter(EngineSpec::is_built);
        let laddered = built.filter(|spec| !is_reference(spec) && !spec.chooses_its_steps());
        return Ok(laddered.collect());
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

/// Numbers that no study can be made with.
fn check(args: &Args) -> Result<()> {
    let count = |count: usize| count as u64;
    for (argument, found, least, most) in [
        (
            "repetitions",
            count(args.repetitions),
            1,
            count(REPETITIONS_MAX),
        ),
        ("budget", args.budget.unwrap_or(1), 1, BUDGET_MAX),
        ("runs", count(args.runs), 1, count(RUNS_MAX)),
        (
            "phases",
            count(args.phases),
            count(PHASES_MIN),
            count(PHASES_MAX),
        ),
    ] {
        if !(least..=most).contains(&found) {
            return Err(Error::Argument {
                argument,
                found: found.to_string(),
                remedy: format!("give {least} to {most}"),
            });
        }
    }
    Ok(())
}

pub(super) fn run(args: &Args) -> Result<()> {
    let mut specs = specs(&args.names)?;
    check(args)?;
    let timing = Timing {
        seed: args.seed,
        repetitions: args.repetitions,
    };
    let out = |folder: &str| {
        args.out
            .clone()
            .unwrap_or_else(|| Path::new("runs").join(folder))
    };
    if !args.bodies.sizes.is_empty() {
        let out = out("bodies");
        return args.bodies.run(
            &specs,
            timing,
            args.budget,
            (&out, args.replace.replace()),
            args.quiet,
        );
    }
    let library = args.library.library();
    let scenes = read(&args.scenes, &library)?;
    let tune_on = read(&args.tune_on, &library)?;
    let options = CostOptions {
        timing,
        budget: args.budget.unwrap_or(BUDGET),
        phases: args.phases,
        runs: args.runs,
    };
    let out = out("cost");
    let output = Output::open(&out, args.replace.replace())?;
    let folder = output.folder();
    claim_cost(&folder, &scenes.iter().collect::<Vec<_>>())?;
    let tuning = tuned(&tune_on, &scenes, &options, args.quiet)?;
    for family in tuning.iter().flat_map(|tuning| &tuning.families) {
        // In the place of the preset of that name, if it takes part.
        specs.retain(|spec| spec.name != family.spec.name);
        specs.push(family.spec.clone());
    }
    for scene in &scenes {
        for warning in scene.warnings() {
            warn(format_args!("{}: {warning}", scene.name));
        }
    }
    let scenes: Vec<&Scene> = scenes.iter().collect();
    Measuring {
        specs: &specs,
        options,
        tuning,
        quiet: args.quiet,
        warns: true,
    }
    .measure(&scenes, &folder)?;
    output.commit()?;
    if args.quiet {
        return Ok(());
    }
    say(format_args!(
        "Written to {}",
        out.join("README.md").display()
    ))
}

/// The study as a part of a report.
pub(super) fn beside_report(order: &Order, folder: &Folder) -> Result<()> {
    let named = order.engines.unwrap_or_default().iter().cloned();
    let mut engines: Vec<EngineSpec> = named.filter(|spec| !is_reference(spec)).collect();
    if engines.is_empty() {
        engines = specs(&[])?;
    }
    Measuring {
        specs: &engines,
        options: COST_OPTIONS,
        tuning: None,
        quiet: order.quiet,
        warns: false,
    }
    .measure(order.scenes, folder)
}

/// How scenes are measured.
struct Measuring<'a> {
    specs: &'a [EngineSpec],
    options: CostOptions,
    /// What was tuned beforehand on other scenes, if anything was.
    tuning: Option<Tuning>,
    /// Whether no progress is shown.
    quiet: bool,
    /// Whether what the reader must know is told at once, and not on the page alone.
    warns: bool,
}

impl Measuring<'_> {
    /// Measures scene by scene and keeps what it has after each, so that an interrupted study
    /// leaves what it has found.
    fn measure(self, scenes: &[&Scene], folder: &Folder) -> Result<()> {
        let mut report = CostReport::begin(self.options, self.tuning);
        for (place, scene) in scenes.iter().enumerate() {
            let bar = progress(1, self.quiet);
            let turn = format!("{}/{}", place + 1, scenes.len());
            let cost = scene_cost(scene, self.specs, &self.options, &|stage, done, all| {
                let doing = match stage {
                    Stage::Reference => "reference",
                    Stage::Errors => "errors",
                    Stage::Phases => "errors from later starts",
                    Stage::Pricing => "prices",
                    Stage::PushOut => "prices of push-out",
                };
                bar.set_length(all as u64);
                bar.set_position(done as u64);
                bar.set_message(format!("{turn} {}: {doing}", scene.name));
            })?;
            bar.finish_and_clear();
            for note in cost.notes.iter().filter(|_| self.warns) {
                warn(format_args!("{}: {note}", scene.name));
            }
            report.add(cost)?;
            folder.keep_unfinished(|folder| report.write(folder))?;
        }
        report.write(folder)
    }
}
