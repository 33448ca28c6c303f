//! The matrix of hard cases: what fails, fails as it is known to, and the command says so.

use std::fs;

use assert_cmd::Command;
use carom::case::Library;
use carom::engine::{EngineSpec, engine, engines, versions};
use carom::study::stability::{Bounded, Judged, judge};
use rayon::prelude::*;
use serde::Deserialize;

/// A failure that is known: a row of `hard/failures.csv`, which `carom stability` writes.
#[derive(Debug, Deserialize, PartialEq)]
struct Known {
    case: String,
    engine: String,
    version: String,
    dt: Option<f64>,
    outcome: String,
    at_time: Option<f64>,
    phase: Option<String>,
}

fn carom(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("carom").unwrap();
    command.args(arguments);
    command
}

fn known() -> Vec<Known> {
    let text = include_str!("../../hard/failures.csv");
    let mut table = csv::Reader::from_reader(text.as_bytes());
    table.deserialize().map(Result::unwrap).collect()
}

fn bounded(name: &str) -> Bounded {
    Bounded::of(Library::EmbeddedHard.case(name).unwrap()).unwrap()
}

/// The lecture at every step; the others at the middle one, which is 0.01 s where there are three.
fn steps(case: &Bounded, spec: &EngineSpec) -> Vec<f64> {
    let all = &case.expected.dt;
    if !spec.takes_steps() {
        vec![all[0]]
    } else if spec.name == "lecture" {
        all.clone()
    } else {
        vec![all[all.len() / 2]]
    }
}

fn run(case: &Bounded, spec: &EngineSpec, dt: f64) -> Judged {
    judge(&case.scene, &case.expected, spec, dt, u64::MAX).unwrap()
}

/// Every cell fails as the file says, at the same time and by the same phase, or holds where the
/// file says nothing: an engine that starts to hold is as much a change as one that starts to
/// fail. `exact` is left out, whose steps are those of `exact-fast`; `robust` holds everywhere,
/// see `robust_matrix`.
#[test]
fn what_fails_fails_as_it_is_known_to() {
    let known = known();
    let names = Library::EmbeddedHard.names().unwrap();
    let cases: Vec<Bounded> = names.iter().map(|name| bounded(name)).collect();
    let specs = engines().into_iter().filter(EngineSpec::is_built);
    let specs = specs.filter(|spec| !["exact", "robust"].contains(&spec.name.as_str()));
    let specs: Vec<EngineSpec> = specs.collect();
    let mut runs = Vec::new();
    for case in &cases {
        for spec in &specs {
            runs.extend(steps(case, spec).into_iter().map(|dt| (case, spec, dt)));
        }
    }
    let surprises: Vec<String> = runs
        .par_iter()
        .filter_map(|(case, spec, dt)| {
            let judged = run(case, spec, *dt);
            let expected = known.iter().find(|row| {
                row.case == case.scene.name && row.engine == spec.name && row.dt == judged.cell.dt
            });
            let found = (
                judged.cell.outcome.as_str(),
                judged.cell.at_time,
                judged.phase.as_deref(),
            );
            let due = expected.map_or(("Finished", None, None), |row| {
                (row.outcome.as_str(), row.at_time, row.phase.as_deref())
            });
            (found != due).then(|| {
                let broken = judged.broken.as_deref().unwrap_or("nothing");
                format!(
                    "{} on {} at {dt}: {found:?} ({broken}), known: {due:?}",
                    spec.name, case.scene.name
                )
            })
        })
        .collect();
    assert!(
        surprises.is_empty(),
        "if these are meant, put the failures.csv of `carom stability` in hard/:\n{}",
        surprises.join("\n")
    );
}

/// Findings about Rapier hold for the version that they were found with.
#[test]
fn known_failures_name_the_version_they_were_found_with() {
    let now = versions();
    for row in known() {
        let own = if row.engine.starts_with("rapier") {
            "rapier3d"
        } else {
            "carom"
        };
        let Some(version) = now.get(own) else {
            continue;
        };
        let due = format!("{own} {version}");
        assert_eq!(row.version, due, "{} on {}", row.engine, row.case);
    }
    let about = |engine: &str| known().iter().filter(|row| row.engine == engine).count();
    assert!(about("lecture") > 20 && about("rapier") > 20);
    assert_eq!(about("robust"), 0);
}

/// k dt²/mu is 40,000 where symplectic Euler needs less than 4: the integrator itself gives the
/// energy, by its own books, from the first sample on.
#[test]
fn a_blow_up_is_named_with_its_phase_at_its_first_crossing() {
    let case = bounded("spring-1e4-times");
    let judged = run(&case, &engine("lecture").unwrap(), 0.01);
    assert_eq!(judged.cell.outcome, "EnergyGrew");
    assert_eq!(judged.cell.at_time, Some(0.1));
    assert_eq!(judged.phase.as_deref(), Some("integrator"));
    // At a tenth of the step it is through all numbers before the first sample, at 0.1 s; the
    // crossing is found from step to step.
    let judged = run(&case, &engine("lecture").unwrap(), 0.001);
    assert_eq!(judged.cell.outcome, "EnergyGrew");
    assert!(judged.cell.at_time < Some(0.01), "{judged:?}");
    assert_eq!(judged.phase.as_deref(), Some("integrator"));
}

/// A budget of work ends a run at a sample, with everything before it kept.
#[test]
fn a_budget_of_counted_work_is_a_verdict() {
    let case = bounded("e-one-gas");
    let spec = engine("lecture").unwrap();
    let judged = judge(&case.scene, &case.expected, &spec, 0.01, 1000).unwrap();
    assert_eq!(judged.cell.outcome, "BudgetSpent");
    assert!(judged.cell.at_time < Some(case.scene.duration));
}

#[test]
fn the_command_leaves_tables_and_a_page() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("s");
    let cases = ["stability", "pi-1", "spring-1e4-times"];
    carom(&cases)
        .args(["--engine", "lecture,robust", "--out"])
        .arg(&out)
        .assert()
        .success();
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
    let table = read("stability.csv");
    let header = "case,engine,dt,outcome,energy_error,momentum_error,max_penetration,\
                  missed_events,at_time,steps,cost_ms";
    assert_eq!(table.lines().next(), Some(header));
    assert_eq!(table.lines().count(), 1 + 2 * 2 * 3);
    assert!(read("failures.csv").contains("spring-1e4-times,lecture,"));
    let page = read("README.md");
    assert!(
        page.contains("`robust` alone holds every case at every step."),
        "{page}"
    );
    assert!(page.contains("pi-1: 31"), "{page}");
}

#[test]
fn what_cannot_be_judged_is_one_line() {
    for (arguments, says) in [
        (vec!["stability", "wedg"], "wedge"),
        (vec!["stability", "--budget", "0"], "budget"),
        (vec!["stability", "--engine", "rapid"], "rapier"),
        (
            vec!["stability", "--hard", "reference", "headon-equal"],
            "expected.toml",
        ),
    ] {
        let ran = carom(&arguments)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .assert()
            .code(2);
        let said = String::from_utf8_lossy(&ran.get_output().stderr).into_owned();
        assert_eq!(said.trim_end().lines().count(), 1, "{said}");
        assert!(said.contains(says), "{said}");
    }
}
