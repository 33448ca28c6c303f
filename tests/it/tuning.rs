//! Tuning on some shots and scoring on others: the tables it leaves, what it refuses, and the
//! constants of `rapier-tuned`.

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use carom::engine::engine;

const HEADER: &str = "family,trial,coordinate,setting,dt,scene,position_error_max,outcome,\
                      objective,accepted";

/// A run of `tuning.csv`.
#[derive(Debug, Clone, serde::Deserialize)]
struct Row {
    family: String,
    trial: usize,
    coordinate: Option<String>,
    setting: String,
    dt: f64,
    scene: String,
    position_error_max: Option<f64>,
    outcome: String,
    objective: f64,
    accepted: bool,
}

fn rows(path: &Path) -> Vec<Row> {
    let mut table = csv::Reader::from_path(path).unwrap();
    table.deserialize().collect::<Result<_, _>>().unwrap()
}

/// The runs of each trial of a family, in their order.
fn trials<'a>(rows: &'a [Row], family: &str) -> Vec<&'a [Row]> {
    let of_trial = rows.chunk_by(|a, b| (&a.family, a.trial) == (&b.family, b.trial));
    of_trial.filter(|runs| runs[0].family == family).collect()
}

/// The trial from which a search went on last: the best.
fn best<'a>(trials: &[&'a [Row]]) -> &'a [Row] {
    trials.iter().rfind(|runs| runs[0].accepted).unwrap()
}

fn families() -> &'static [&'static str] {
    if cfg!(feature = "rapier") {
        &["hand-written", "rapier"]
    } else {
        &["hand-written"]
    }
}

fn carom(folder: &Path, arguments: &[&str]) -> std::process::Output {
    let mut command = Command::cargo_bin("carom").unwrap();
    command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap()
}

fn tune(folder: &Path, out: &str) {
    let arguments = [
        "cost",
        "headon-equal",
        "--tune-on",
        "shot-2-96,shot-minus-0-94",
        "--engine",
        "lecture",
        "--budget",
        "3000",
        "--runs",
        "36",
        "--repetitions",
        "1",
        "--quiet",
        "--out",
        out,
    ];
    let output = carom(folder, &arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
}

#[test]
fn a_search_keeps_its_budget_tells_every_run_and_finds_the_same_again() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    tune(folder, "a");
    let text = fs::read_to_string(folder.join("a/tuning.csv")).unwrap();
    assert_eq!(text.lines().next().unwrap(), HEADER);
    let rows = rows(&folder.join("a/tuning.csv"));
    let page = fs::read_to_string(folder.join("a/README.md")).unwrap();
    for family in families() {
        let trials = trials(&rows, family);
        // 36 runs on two shots.
        assert!(
            (3..=18).contains(&trials.len()),
            "{family}: {}",
            trials.len()
        );
        let mut least = f64::INFINITY;
        for (place, runs) in trials.iter().enumerate() {
            let first = &runs[0];
            assert_eq!(first.trial, place + 1);
            assert_eq!(first.coordinate.is_none(), place == 0);
            let scenes: Vec<_> = runs.iter().map(|run| run.scene.as_str()).collect();
            assert_eq!(scenes, ["shot-2-96", "shot-minus-0-94"]);
            // The objective is the geometric mean of the two errors, all below the size here.
            let errors: Vec<f64> = runs
                .iter()
                .filter_map(|run| run.position_error_max)
                .collect();
            let mean = (errors[0] * errors[1]).sqrt();
            assert!((mean / first.objective - 1.0).abs() < 1e-12, "{runs:?}");
            // 121 samples of four balls: 1200 units of work a step between two.
            assert!(first.dt >= 0.0625 / 2.0, "{first:?}");
            assert_eq!(first.outcome, "Finished");
            if first.accepted {
                assert!(first.objective < least);
            }
            least = least.min(first.objective);
        }
        assert_eq!(best(&trials)[0].objective, least);
        assert!(page.contains(&format!("| {family} |")), "{page}");
    }
    let cost = fs::read_to_string(folder.join("a/cost.csv")).unwrap();
    assert!(
        cost.contains("\nheadon-equal,lecture-tuned,stock,"),
        "{cost}"
    );
    assert_eq!(cost.contains("rapier-tuned"), cfg!(feature = "rapier"));
    assert!(page.contains("Tuned on shot-2-96, shot-minus-0-94; scored on headon-equal."));
    tune(folder, "b");
    assert_eq!(
        text,
        fs::read_to_string(folder.join("b/tuning.csv")).unwrap()
    );
}

#[test]
fn what_is_tuned_on_is_not_scored_and_needs_an_exact_answer() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let mut twin = carom::case::Library::Embedded
        .case("shot-2-96")
        .unwrap()
        .scene;
    twin.name = "another-name".into();
    let text = carom::scene::to_toml(&twin).unwrap();
    fs::write(folder.join("twin.toml"), text).unwrap();
    twin.name = "unanswered".into();
    twin.bodies[1].position = twin.bodies[0].position;
    let text = carom::scene::to_toml(&twin).unwrap();
    fs::write(folder.join("unanswered.toml"), text).unwrap();
    for (scored, tuned, part) in [
        (
            "shot-2-96",
            "shot-0-41,shot-2-96",
            "`shot-2-96` is scored as well",
        ),
        ("twin.toml", "shot-2-96", "`another-name` is scored as well"),
        (
            "shot-0-41",
            "shot-2-96,kepler-circle",
            "tune on scenes of one unit",
        ),
        (
            "shot-0-41",
            "unanswered.toml",
            "nothing to measure errors against",
        ),
    ] {
        let output = carom(folder, &["cost", scored, "--tune-on", tuned]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(part) && said.contains("--tune-on"), "{said}");
        let errors = said.lines().filter(|line| line.starts_with("error"));
        assert_eq!(errors.count(), 1, "{said}");
        assert!(!folder.join("runs").exists(), "nothing may be written");
    }
}

/// The table that the command in the documentation of `RapierSettings::tuned` left.
fn stored() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tuning/tuning.csv")
}

/// The constants in the table of engines are those that the stored search found.
#[test]
fn the_tuned_preset_is_what_the_stored_search_found() {
    let rows = rows(&stored());
    let found = best(&trials(&rows, "rapier"));
    let (stock, tuned) = (engine("rapier").unwrap(), engine("rapier-tuned").unwrap());
    assert_eq!(tuned.kind.changed_from(&stock.kind), found[0].setting);
    assert!(tuned.summary.contains("tuned on"), "{}", tuned.summary);
}

/// The stored errors are those that this build computes: both ends of the search, on the shot
/// with the nearest horizon. One part in a million: the same operations in the same order, and
/// room for a processor that fuses some of them.
#[cfg(feature = "rapier")]
#[test]
fn the_stored_search_can_be_made_again() {
    use carom::study::cost::{Candidate, Shot, measure};

    let scene = carom::case::Library::Embedded
        .case("shot-minus-0-94")
        .unwrap()
        .scene;
    let shot = Shot::of(&scene).unwrap().unwrap();
    let rows = rows(&stored());
    let trials = trials(&rows, "rapier");
    for (runs, name) in [(trials[0], "rapier"), (best(&trials), "rapier-tuned")] {
        let run = runs.iter().find(|run| run.scene == scene.name).unwrap();
        let candidate = Candidate {
            kind: engine(name).unwrap().kind,
            dt: run.dt,
        };
        let measured = measure(std::slice::from_ref(&shot), &[candidate]).unwrap();
        let error = measured[0].0[0].position_max.unwrap();
        let stored = run.position_error_max.unwrap();
        assert!(
            (error / stored - 1.0).abs() < 1e-6,
            "{name}: {error}, stored {stored}"
        );
    }
}
