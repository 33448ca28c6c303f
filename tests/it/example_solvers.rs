//! The solvers in `examples/` and in `docs/your-own-solver.md`, run as a user runs them.

use std::fs;
use std::path::{Path, PathBuf};

use carom::case::Library;
use carom::engine::{DEFAULT_DT, ExternalSolver, Limits};
use carom::error::Result;
use carom::recording::Recording;
use carom::scene::Scene;
use rayon::prelude::*;

use crate::scenes::lecture;

fn source(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// An example beside this test's own program; `cargo test` builds both.
fn example(name: &str) -> String {
    let deps = std::env::current_exe().unwrap();
    let profile = deps.parent().and_then(Path::parent).unwrap();
    let program = profile.join("examples").join(name);
    let program = program.with_extension(std::env::consts::EXE_EXTENSION);
    let made = |path: &Path| fs::metadata(path).and_then(|found| found.modified());
    let is_fresh = made(&program).is_ok_and(|program| {
        program >= made(&source("examples").join(name).with_extension("rs")).unwrap()
    });
    assert!(
        is_fresh,
        "{} is not there or not up to date; `cargo test` without --test builds it, or `cargo build --examples`",
        program.display()
    );
    shlex::try_quote(program.to_str().unwrap())
        .unwrap()
        .into_owned()
}

fn solved(command: &str, scene: &Scene) -> Result<Recording> {
    ExternalSolver::parse(command, Limits::default())?.record("example", scene, DEFAULT_DT)
}

/// The first sample and body in which two recordings of a scene differ in any bit.
fn first_difference(a: &Recording, b: &Recording) -> Option<(usize, usize)> {
    assert_eq!(a.sample_count(), b.sample_count());
    let bits = |recording: &Recording, sample: usize| -> Vec<[u64; 6]> {
        let states = recording.sample(sample).iter();
        let numbers = states.map(|state| {
            let [x, v] = [state.position, state.velocity];
            [x.x, x.y, x.z, v.x, v.y, v.z].map(f64::to_bits)
        });
        numbers.collect()
    };
    (0..a.sample_count()).find_map(|sample| {
        let (a, b) = (bits(a, sample), bits(b, sample));
        let body = a.iter().zip(&b).position(|(a, b)| a != b)?;
        Some((sample, body))
    })
}

/// The same bits as engine `lecture` on cases of a library; where numbers run out there, the
/// program's trajectory is refused with the line. How many run out.
fn assert_lectures_bits(library: &Library, names: &[String], command: &str) -> usize {
    let runs_out = |name: &String| {
        let scene = library.case(name).unwrap().scene;
        let ours = lecture(&scene, DEFAULT_DT);
        let theirs = solved(command, &scene);
        if ours.sample_count() == scene.sample_count() + 1 {
            let difference = first_difference(&theirs.unwrap(), &ours);
            assert_eq!(difference, None, "{name}: (sample, body)");
            return false;
        }
        let said = theirs.unwrap_err().to_string();
        assert!(
            said.contains("{out}, line ") && said.contains("not a finite number"),
            "{name}: {said}"
        );
        true
    };
    names.par_iter().filter(|name| runs_out(name)).count()
}

#[test]
fn the_lectures_solver_as_a_program_gives_the_engines_bits() {
    let program = example("lecture_solver");
    let command = format!("{program} {{bodies}} {{effects}} {{out}}");
    for (library, cases, some_run_out) in [
        (Library::Embedded, 32, false),
        (Library::EmbeddedHard, 48, true),
    ] {
        let names = library.names().unwrap();
        assert!(names.len() >= cases, "{} cases", names.len());
        let run_out = assert_lectures_bits(&library, &names, &command);
        assert_eq!(run_out > 0, some_run_out, "{run_out} in {library:?}");
    }
}

/// Negative control: without its blank filled in, balls pass through each other.
#[test]
fn the_exercise_differs_where_balls_collide_and_nowhere_else() {
    let program = example("exercise");
    let command = format!("{program} {{bodies}} {{effects}} {{out}}");
    let differs = |name: &str| {
        let scene = Library::Embedded.case(name).unwrap().scene;
        let ours = lecture(&scene, DEFAULT_DT);
        first_difference(&solved(&command, &scene).unwrap(), &ours).is_some()
    };
    for name in ["headon-equal", "shot-2-61", "billiard-pair"] {
        assert!(differs(name), "{name}");
    }
    for name in [
        "drag-to-rest",
        "cushion-one",
        "kepler-circle",
        "spring-chain",
    ] {
        assert!(!differs(name), "{name}");
    }
}

/// A source without its header comment and without the body of `collision_handler`.
fn without_the_blank(name: &str) -> String {
    let text = fs::read_to_string(source("examples").join(name)).unwrap();
    let code = text.lines().skip_while(|line| line.starts_with("//!"));
    let code = code.collect::<Vec<_>>().join("\n");
    let (before, rest) = code.split_once("\nfn collision_handler(").unwrap();
    let (signature, rest) = rest.split_once("{\n").unwrap();
    let (_, after) = rest.split_once("\n}\n").unwrap();
    format!("{before}\nfn collision_handler({signature}{{\n}}\n{after}")
}

#[test]
fn the_exercise_is_the_lectures_solver_but_for_its_blank() {
    let (exercise, whole) = ("exercise.rs", "lecture_solver.rs");
    assert_eq!(without_the_blank(exercise), without_the_blank(whole));
    let blank = fs::read_to_string(source("examples").join(exercise)).unwrap();
    for given_away in ["1.0 / a.mass", "1.0 / b.mass", "v1n"] {
        assert!(!blank.contains(given_away), "{given_away}");
    }
}

#[test]
fn the_examples_share_no_code_with_carom() {
    for name in ["exercise.rs", "lecture_solver.rs"] {
        let text = fs::read_to_string(source("examples").join(name)).unwrap();
        let code = text.lines().filter(|line| !line.trim().starts_with("//"));
        assert!(code.clone().count() > 100, "{name} is no longer read");
        for line in code {
            assert!(!line.contains("carom"), "{name}: {line}");
        }
    }
}

/// The program in the page for newcomers, run as the page says, does the lecture's steps.
///
/// It adds impulses up in another order than the slides do, so that rounding differs: seen up to
/// 7e-15 of the scene's size, which each impact may multiply by some tens.
#[test]
fn the_pages_program_does_the_lectures_steps() {
    let python = std::process::Command::new("python3")
        .arg("--version")
        .output();
    if !python.is_ok_and(|it| it.status.success()) {
        println!("there is no python3 here: the page's program is not run");
        return;
    }
    let page = fs::read_to_string(source("docs/your-own-solver.md")).unwrap();
    let (_, program) = page.split_once("```python\n").unwrap();
    let (program, _) = program.split_once("```").unwrap();
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("solver.py");
    fs::write(&file, program).unwrap();
    let command = format!(
        "python3 {} {{bodies}} {{effects}} {{out}}",
        shlex::try_quote(file.to_str().unwrap()).unwrap()
    );
    for name in [
        "headon-equal",
        "oblique-inelastic",
        "billiard-pair",
        "shot-2-61",
    ] {
        let scene = Library::Embedded.case(name).unwrap().scene;
        let ours = lecture(&scene, DEFAULT_DT);
        assert!(ours.events.counts().contacts > 0, "{name} shows little");
        let theirs = solved(&command, &scene).unwrap();
        let size = ours.samples().flatten().map(|state| state.position.norm());
        let apart = crate::scenes::apart(&ours, &theirs) / size.fold(0.0, f64::max);
        assert!(apart < 1e-12, "{name}: {apart:e}");
    }
    let attraction = Library::Embedded.case("kepler-circle").unwrap().scene;
    let said = solved(&command, &attraction).unwrap_err().to_string();
    assert!(
        said.ends_with("exit code 1; standard error ends: this solver knows no attraction"),
        "{said}"
    );
}

/// The page's table of complaints quotes what carom says: every piece of a complaint that is
/// neither a name nor a number stands in the sources.
#[test]
fn the_page_quotes_the_complaints_as_they_are() {
    let said: String = crate::layers::sources()
        .into_iter()
        .filter(|(path, _)| {
            let path = path.to_string_lossy();
            ["error.rs", "recording/", "engine/external/"]
                .iter()
                .any(|room| path.contains(room))
        })
        .map(|(_, text)| text)
        .collect();
    let page = fs::read_to_string(source("docs/your-own-solver.md")).unwrap();
    let (_, table) = page
        .split_once("| complaint | what to do |\n|---|---|\n")
        .unwrap();
    let mut quoted = 0;
    for row in table.lines() {
        let complaint = row.split('|').nth(1).unwrap();
        let pieces = complaint.split(|c: char| "…:'`({".contains(c) || c.is_ascii_digit());
        let words = pieces
            .map(str::trim)
            .filter(|piece| piece.starts_with(|c: char| c.is_lowercase()));
        for piece in words.filter(|piece| piece.len() > 1) {
            assert!(said.contains(piece), "`{piece}` of {row}");
            quoted += 1;
        }
    }
    assert!(
        quoted >= 20,
        "only {quoted} pieces found: the table is no longer read"
    );
}
