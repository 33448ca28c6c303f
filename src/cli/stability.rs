//! `carom stability`: which engine survives what, at which step.

use std::path::PathBuf;

use super::args::{ReplaceArgs, chosen};
use super::output::{progress, say, say_json, say_lines};
use super::studies::Order;
use crate::case::Library;
use crate::engine::{EngineSpec, engines};
use crate::error::{Error, Result};
use crate::report::{
    Folder, Output, STABILITY_FILES, stability_findings, stability_table, write_stability,
};
use crate::study::BUDGET_MAX;
use crate::study::stability::{
    Bounded, MapKind, StabilityStudy, StabilitySummary, stability, stability_map,
};

/// Work a run may count unless told otherwise: a thousand balls for two thousand steps.
const BUDGET: u64 = 1_100_000_000;

/// The maps that stand beside the whole matrix.
const MAPS: [MapKind; 2] = [MapKind::Spring, MapKind::Orbit];

/// The engines of the maps, if they take part; more panels would be too narrow.
const MAPPED: [&str; 4] = ["lecture", "verlet", "rapier-f64", "robust"];

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Names of hard cases [default: all, with maps for springs and orbits]
    cases: Vec<String>,
    /// Engines, separated by commas [default: all but exact, which is exact-fast with certificates]
    #[arg(long = "engine", value_name = "NAMES", value_delimiter = ',')]
    names: Vec<String>,
    /// Folder of hard cases [default: hard/ if there is one, else those compiled in]
    #[arg(long, value_name = "DIR")]
    hard: Option<PathBuf>,
    /// Work a run may count: steps, looks at pairs, evaluations of forces
    #[arg(long, default_value_t = BUDGET)]
    budget: u64,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "runs/stability")]
    out: PathBuf,
    #[command(flatten)]
    replace: ReplaceArgs,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    quiet: bool,
    /// Print the summary as JSON instead of the table
    #[arg(long, conflicts_with = "quiet")]
    json: bool,
}

/// Every engine that this build has, in order; without the one that certifies, whose steps are
/// those of `exact-fast`.
fn specs(names: &[String]) -> Result<Vec<EngineSpec>> {
    if !names.is_empty() {
        return chosen(names, &[]);
    }
    let built = engines().into_iter().filter(EngineSpec::is_built);
    Ok(built.filter(|spec| spec.name != "exact").collect())
}

fn cases(names: &[String], library: &Library) -> Result<Vec<Bounded>> {
    let mut names = if names.is_empty() {
        library.names()?
    } else {
        names.to_vec()
    };
    names.sort();
    names.dedup();
    let mut cases = Vec::new();
    for name in &names {
        let case = Bounded::of(library.case(name)?);
        cases.push(case.ok_or_else(|| {
            Error::Argument {
                argument: "cases",
                found: name.clone(),
                remedy: "it has no expected.toml that says what must hold; see `carom scenes list \
                     --hard`"
                    .into(),
            }
        })?);
    }
    if cases.is_empty() {
        return Err(Error::NoCases);
    }
    Ok(cases)
}

fn make(
    cases: &[Bounded],
    specs: &[EngineSpec],
    budget: u64,
    folder: &Folder,
    kinds: &[MapKind],
    quiet: bool,
) -> Result<(StabilityStudy, StabilitySummary)> {
    let bar = progress(1, quiet);
    let study = stability(cases, specs, budget, &|case, done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        bar.set_message(case);
    })?;
    bar.set_message("maps");
    let mapped = specs
        .iter()
        .filter(|spec| MAPPED.contains(&spec.name.as_str()));
    let mapped: Vec<EngineSpec> = mapped.cloned().collect();
    let kinds = kinds.iter().filter(|_| !mapped.is_empty());
    let maps = kinds.map(|kind| stability_map(*kind, &mapped));
    let maps = maps.collect::<Result<Vec<_>>>()?;
    bar.finish_and_clear();
    let summary = write_stability(folder, &study, &maps)?;
    Ok((study, summary))
}

pub(super) fn run(args: &Args) -> Result<()> {
    if !(1..=BUDGET_MAX).contains(&args.budget) {
        return Err(Error::Argument {
            argument: "budget",
            found: args.budget.to_string(),
            remedy: format!("give 1 to {BUDGET_MAX}"),
        });
    }
    let specs = specs(&args.names)?;
    let library = match &args.hard {
        Some(folder) => Library::choose(Some(folder)),
        None => Library::hard(),
    };
    let cases = cases(&args.cases, &library)?;
    let output = Output::open(&args.out, args.replace.replace())?;
    let folder = output.folder();
    folder.claim(STABILITY_FILES)?;
    // Whoever asks for some cases asks for those.
    let maps = if args.cases.is_empty() {
        &MAPS[..]
    } else {
        &[]
    };
    let (study, summary) = make(&cases, &specs, args.budget, &folder, maps, args.quiet)?;
    output.commit()?;
    if args.quiet {
        return Ok(());
    }
    if args.json {
        return say_json(&summary);
    }
    say_lines(stability_table(&summary))?;
    for finding in stability_findings(&study, &summary) {
        say(finding)?;
    }
    say(format_args!(
        "Written to {}",
        args.out.join("README.md").display()
    ))
}

/// The study as a part of a report: of the hard cases, whatever the cases of the report are.
pub(super) fn beside_report(order: &Order, folder: &Folder) -> Result<()> {
    let specs = match order.engines {
        Some(engines) => engines.to_vec(),
        None => specs(&[])?,
    };
    let cases = cases(&[], &Library::hard())?;
    make(&cases, &specs, BUDGET, folder, &MAPS, order.quiet)?;
    Ok(())
}
