//! `carom check`: does a solver still agree with truth, with itself and with Rapier?

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ValueEnum;
use rayon::prelude::*;

use super::args::{LibraryArgs, chosen};
use super::output::{progress, say, say_json, say_lines};
use crate::case::{Case, Library, REFERENCE};
use crate::engine::external::Limits;
use crate::engine::{DEFAULT_DT, EngineKind, EngineSpec, engines};
use crate::error::{Error, Result, number};
use crate::input;
use crate::recording::{read_trajectory_start, trajectory_bytes_max};
use crate::report::{blessing_text, check_junit, check_text, replay_text, write_blessing};
use crate::scene::check::check_scene_name;
use crate::study::check::{
    Blessing, Candidate, Program, Replay, Subject, TrajectoryFile, bless, check, digests, profile,
    replay,
};

/// Whom a program is judged like if nothing is said.
const DEFAULT_LIKE: &str = "lecture";

/// Seconds that a program may be given, at most: more than eleven days are a slip of the pen.
const LIMIT_MAX: f64 = 1e6;

/// How the report is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A line a case, more where something fails
    Text,
    /// All that was measured
    Json,
    /// XML as by `JUnit`, for the pages of continuous integration
    Junit,
}

#[derive(Debug, clap::Args)]
#[allow(clippy::struct_excessive_bools, reason = "switches of a command line")]
pub(super) struct Args {
    /// Names of cases [default: all]
    cases: Vec<String>,
    /// Engines, separated by commas [default: all hand-written ones]
    #[arg(long = "engine", value_name = "NAMES", value_delimiter = ',')]
    engines: Vec<String>,
    /// A program of your own: a command with {bodies} {effects} {scene} {dt} {out} where it wants
    /// them; see docs/your-own-solver.md
    #[arg(long, value_name = "COMMAND", conflicts_with_all = ["engines", "trajectory", "replay"])]
    solver: Option<String>,
    /// A trajectory made elsewhere, of exactly one case
    #[arg(long, value_name = "FILE", conflicts_with_all = ["engines", "replay", "bless"])]
    trajectory: Option<PathBuf>,
    /// Judge by what is stored of this engine [default: the engine itself, else lecture]
    #[arg(long, value_name = "NAME")]
    like: Option<String>,
    /// Time that a program may take on a case, s
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 10.0,
        allow_negative_numbers = true
    )]
    limit: f64,
    #[command(flatten)]
    library: LibraryArgs,
    /// How to print
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Print every metric of every case
    #[arg(long, short)]
    verbose: bool,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    quiet: bool,
    /// Derive every tolerance anew, show what changes, and store it
    #[arg(long, conflicts_with_all = ["replay", "digests"])]
    bless: bool,
    /// Store also what would notice less than before
    #[arg(long)]
    widen: bool,
    /// Run one case again and compare it bit by bit with a trajectory that `carom run` wrote
    #[arg(long, value_name = "FILE", conflicts_with = "digests")]
    replay: Option<PathBuf>,
    /// Print the digest of every recording, and judge nothing
    #[arg(long)]
    digests: bool,
}

/// Whether everything held.
pub(super) fn run(args: &Args) -> Result<bool> {
    if let Some(like) = &args.like {
        check_label(like)?;
    }
    let library = args.library.library();
    let cases = cases(&args.cases, &library)?;
    let specs = specs(&args.engines)?;
    if let Some(file) = &args.replay {
        return run_again(file, &cases, &specs, args);
    }
    let own = own_solver(args, &cases)?;
    let like = args.like.as_deref();
    let candidates: Vec<Candidate> = match &own {
        Some(own) => vec![Candidate::like(own.as_ref(), like.unwrap_or(DEFAULT_LIKE))],
        None => specs.iter().map(|spec| judged_as(spec, like)).collect(),
    };
    if args.digests {
        for (digest, case, solver) in digests(&cases, &candidates)? {
            say(format_args!("{digest}  {solver}/{case}"))?;
        }
        return Ok(true);
    }
    if args.bless {
        return store(&cases, &candidates, &library, args);
    }
    for candidate in &candidates {
        for case in &cases {
            profile(case, &candidate.like)?;
        }
    }
    let bar = progress(cases.len() * candidates.len(), args.quiet);
    let report = check(&cases, &library, &candidates, &|case| {
        bar.inc(1);
        bar.set_message(case);
    })?;
    bar.finish_and_clear();
    match args.format {
        Format::Text if args.quiet => {}
        Format::Text => say_lines(check_text(&report, args.verbose).trim_end())?,
        Format::Json => say_json(&report)?,
        Format::Junit => say_lines(check_junit(&report)?.trim_end())?,
    }
    Ok(report.holds)
}

/// A label stands in the names of files and as a key of `expected.toml`.
fn check_label(like: &str) -> Result<()> {
    check_scene_name(like).map_err(|fault| Error::Argument {
        argument: "like",
        found: fault.found,
        remedy: "use 1 to 100 of the characters a-z, 0-9 and `-`".into(),
    })
}

/// The program or the file that is to be judged, if one is named.
fn own_solver(args: &Args, cases: &[Case]) -> Result<Option<Box<dyn Subject>>> {
    if let Some(command) = &args.solver {
        let limits = Limits {
            time: limit(args.limit)?,
            ..Limits::default()
        };
        return Ok(Some(Box::new(Program::parse(command, limits)?)));
    }
    let Some(file) = &args.trajectory else {
        return Ok(None);
    };
    if cases.len() != 1 {
        return Err(Error::Argument {
            argument: "trajectory",
            found: file.display().to_string(),
            remedy: "name the one case that it is a trajectory of".into(),
        });
    }
    Ok(Some(Box::new(TrajectoryFile::new(file.clone()))))
}

fn limit(seconds: f64) -> Result<Duration> {
    let limit = Duration::try_from_secs_f64(seconds).ok();
    let limit = limit.filter(|limit| !limit.is_zero() && seconds <= LIMIT_MAX);
    limit.ok_or_else(|| Error::Argument {
        argument: "limit",
        found: number(seconds),
        remedy: format!("give a finite number of seconds above 0, at most {LIMIT_MAX}"),
    })
}

fn cases(names: &[String], library: &Library) -> Result<Vec<Case>> {
    let names: BTreeSet<String> = if names.is_empty() {
        library.names()?.into_iter().collect()
    } else {
        names.iter().cloned().collect()
    };
    if names.is_empty() {
        return Err(Error::NoCases);
    }
    names.iter().map(|name| library.case(name)).collect()
}

/// The engines of these names; without names, all hand-written ones.
fn specs(names: &[String]) -> Result<Vec<EngineSpec>> {
    if !names.is_empty() {
        return chosen(names, &[]);
    }
    let all = engines().into_iter();
    Ok(all
        .filter(|spec| matches!(spec.kind, EngineKind::Impulse(_)))
        .collect())
}

fn judged_as<'a>(spec: &'a EngineSpec, like: Option<&str>) -> Candidate<'a> {
    like.map_or_else(|| Candidate::own(spec), |like| Candidate::like(spec, like))
}

/// `--replay`: one case, one engine, one file.
fn run_again(file: &Path, cases: &[Case], specs: &[EngineSpec], args: &Args) -> Result<bool> {
    let one = |remedy: &str| Error::Argument {
        argument: "replay",
        found: file.display().to_string(),
        remedy: remedy.to_owned(),
    };
    let [case] = cases else {
        return Err(one("name the one case that it is a recording of"));
    };
    let spec = match (specs, args.engines.is_empty()) {
        ([spec], _) => spec,
        (_, true) => &specs[0],
        (_, false) => return Err(one("name the one engine that made it")),
    };
    let scene = &case.scene;
    let table = input::open(file, trajectory_bytes_max(scene))?;
    let name = file.display().to_string();
    let recorded = read_trajectory_start(&spec.name, scene, table, &name)?;
    let replayed = spec.record(scene, DEFAULT_DT)?;
    let found = replay(scene, &recorded, &replayed);
    match args.format {
        Format::Json => say_json(&found)?,
        Format::Text | Format::Junit => say(format_args!(
            "{} on {}: {}",
            spec.name,
            scene.name,
            replay_text(&found)
        ))?,
    }
    Ok(matches!(found, Replay::Same { .. }))
}

/// `--bless`: shows what changes, and stores it unless that would notice less.
fn store(cases: &[Case], candidates: &[Candidate], library: &Library, args: &Args) -> Result<bool> {
    let Library::Folder(folder) = library else {
        return Err(Error::Argument {
            argument: "bless",
            found: "the cases compiled in".into(),
            remedy: format!(
                "name a folder of cases with --reference, or start where `{REFERENCE}` is"
            ),
        });
    };
    let bar = progress(cases.len() * candidates.len(), args.quiet);
    let jobs: Vec<(&Case, &Candidate)> = cases
        .iter()
        .flat_map(|case| candidates.iter().map(move |candidate| (case, candidate)))
        .collect();
    let blessings = jobs
        .par_iter()
        .map(|(case, candidate)| {
            let blessing = bless(case, library, candidate, DEFAULT_DT)?;
            bar.inc(1);
            Ok(blessing)
        })
        .collect::<Result<Vec<Blessing>>>()?;
    bar.finish_and_clear();
    say_lines(blessing_text(&blessings).trim_end())?;
    let wider = blessings
        .iter()
        .filter(|blessing| blessing.widens())
        .count();
    if wider > 0 && !args.widen {
        say(format_args!(
            "{wider} would notice less than before; nothing was written. If that is meant, say \
             --widen"
        ))?;
        return Ok(false);
    }
    let mut written = 0;
    for (case, of_case) in cases.iter().zip(blessings.chunks(candidates.len())) {
        let scene = &case.scene;
        let mut text = library.expected_text(&scene.name)?;
        for blessing in of_case
            .iter()
            .filter(|blessing| !blessing.changes.is_empty())
        {
            text = Some(write_blessing(folder, scene, text.as_deref(), blessing)?);
            written += 1;
        }
    }
    say(match written {
        0 => "nothing changes".to_owned(),
        _ => format!("{written} profiles written"),
    })?;
    Ok(true)
}
