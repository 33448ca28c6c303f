//! Bad input gets one clear line with file, line and remedy, exit 2, and nothing is written.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

use crate::slips::{Slip, assert_named};

const GOOD: &str = r#"name = "two"
duration = 1.0
sample_every = 0.25
[[bodies]]
name = "a"
mass = 1.0
radius = 0.5
position = [0.0, 0.0, 0.0]
velocity = [1.0, 0.0, 0.0]
[[bodies]]
name = "b"
mass = 1.0
radius = 0.5
position = [3.0, 0.0, 0.0]
velocity = [0.0, 0.0, 0.0]
[effects.contact]
restitution = 0.5
[[effects.springs]]
between = ["a", "b"]
stiffness = 1.0
rest_length = 1.0
damping = 0.0
"#;

fn carom(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("carom").unwrap();
    command.current_dir(folder);
    command
}

/// Runs a scene file and expects exit 2 with one line on standard error.
fn complaint(text: &[u8], arguments: &[&str]) -> String {
    let scratch = tempfile::tempdir().unwrap();
    fs::write(scratch.path().join("s.toml"), text).unwrap();
    let output = carom(scratch.path())
        .args(["run", "s.toml", "--engine", "lecture", "--out", "out"])
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert_eq!(said.trim_end().lines().count(), 1, "one line, not: {said}");
    assert!(!said.contains("panicked"), "{said}");
    assert!(
        !scratch.path().join("out").exists(),
        "nothing may be written: {said}"
    );
    said
}

#[test]
fn the_good_scene_is_good() {
    let scratch = tempfile::tempdir().unwrap();
    fs::write(scratch.path().join("s.toml"), GOOD).unwrap();
    let run = ["run", "s.toml", "--engine", "lecture", "--out", "out"];
    carom(scratch.path()).args(run).assert().success();
    for file in [
        "trajectory-lecture.csv",
        "events-lecture.csv",
        "metrics.csv",
        "divergence.csv",
        "summary.json",
    ] {
        assert!(scratch.path().join("out").join(file).is_file(), "{file}");
    }
}

fn assert_named_with_their_place(slips: &[Slip]) {
    assert_named(GOOD, "error: s.toml", slips, |text| {
        complaint(text.as_bytes(), &[])
    });
}

#[test]
fn faults_of_the_scene_itself_are_named_with_their_place() {
    assert_named_with_their_place(&[
        ("name = \"two\"", "name = \"Two/../x\"", 1, "a-z, 0-9"),
        ("name = \"two\"", "name = \"\"", 1, "a-z, 0-9"),
        ("duration = 1.0", "duration = 0.0", 2, "above 0"),
        ("duration = 1.0", "duration = -1", 2, "above 0"),
        ("duration = 1.0", "duration = inf", 2, "finite"),
        (
            "duration = 1.0",
            "duration = 1.1",
            2,
            "multiple of sample_every",
        ),
        ("duration = 1.0", "duration = 1e300", 3, "sample less often"),
        ("duration = 1.0", "duration = \"long\"", 2, "invalid type"),
        ("sample_every = 0.25", "sample_every = nan", 3, "finite"),
        (
            "sample_every = 0.25",
            "sample_evry = 0.25",
            3,
            "sample_every",
        ),
        ("sample_every = 0.25", "", 1, "missing field `sample_every`"),
    ]);
}

#[test]
fn faults_of_a_body_are_named_with_their_place() {
    assert_named_with_their_place(&[
        ("mass = 1.0", "mass = 0", 6, "above 0"),
        ("mass = 1.0", "mass = -1.5", 6, "above 0"),
        ("mass = 1.0", "mass = 1e999", 6, ""),
        ("mass = 1.0", "masss = 1.0", 6, "mass"),
        ("radius = 0.5", "radius = 0.0", 7, "above 0"),
        (
            "position = [0.0, 0.0, 0.0]",
            "position = [0.0, nan, 0.0]",
            8,
            "finite",
        ),
        ("position = [0.0, 0.0, 0.0]", "position = [0.0, 0.0]", 8, ""),
        (
            "velocity = [1.0, 0.0, 0.0]",
            "velocity = [inf, 0.0, 0.0]",
            9,
            "finite",
        ),
        ("name = \"b\"", "name = \"a\"", 11, "name of bodies[0] too"),
        ("name = \"b\"", "name = \"  \"", 11, "give the body a name"),
        ("name = \"b\"", "name = \"b\\t\"", 11, "control characters"),
    ]);
}

#[test]
fn faults_of_an_effect_are_named_with_their_place() {
    assert_named_with_their_place(&[
        ("restitution = 0.5", "restitution = 1.5", 17, "from 0 to 1"),
        ("restitution = 0.5", "restitution = -0.1", 17, "from 0 to 1"),
        (
            "restitution = 0.5",
            "restitution = 0.5\nfriction = 0.1",
            18,
            "friction",
        ),
        ("[effects.contact]", "[effects.magnetism]", 16, "magnetism"),
        (
            "between = [\"a\", \"b\"]",
            "between = [\"a\", \"nobody\"]",
            19,
            "name two bodies",
        ),
        (
            "between = [\"a\", \"b\"]",
            "between = [\"a\", \"a\"]",
            19,
            "two different bodies",
        ),
        (
            "stiffness = 1.0",
            "stiffness = -1.0",
            20,
            "0 or a number above",
        ),
        (
            "[effects.contact]",
            "[effects.drag]\ncoefficient = -1.0\n[effects.contact]",
            17,
            "0 or a number above",
        ),
        ("[effects.contact]", "[effects.contact", 16, ""),
    ]);
}

#[test]
fn what_is_no_scene_at_all_is_said_so() {
    assert!(complaint(b"", &[]).contains("missing field `name`"));
    assert!(complaint(b"\xff\xfe\x00", &[]).contains("not UTF-8 from byte 0"));
    assert!(complaint(b"PNG\r\n\x1a\n\0\0", &[]).contains("s.toml:1:"));
    let no_bodies = "name = \"x\"\nduration = 1\nsample_every = 1\n";
    assert!(complaint(no_bodies.as_bytes(), &[]).contains("at least one [[bodies]]"));
}

#[test]
fn steps_that_cannot_be_taken_are_refused() {
    for dt in ["0", "-1", "nan", "inf", "1e-12"] {
        let said = complaint(GOOD.as_bytes(), &[&format!("--dt={dt}")]);
        assert!(said.contains("time step"), "{dt}: {said}");
    }
}

#[test]
fn names_that_are_not_there_are_listed() {
    let scratch = tempfile::tempdir().unwrap();
    let said = |arguments: &[&str]| {
        let output = carom(scratch.path()).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(said(&["run", "no-such-case"]).contains("neither a scene file nor a case"));
    assert!(said(&["run", "none.toml"]).contains("cannot be read"));
    assert!(said(&["run", "../etc"]).contains("neither a scene file nor a case"));
    assert!(said(&["run", "shot-2-96", "--engine", "newton"]).contains("lecture"));
    let twice = said(&["run", "shot-2-96", "--engine", "lecture,lecture"]);
    assert!(twice.contains("asked for twice"), "{twice}");
    assert!(said(&["report", "--reference", "nowhere"]).contains("cannot be read"));
}

#[test]
fn an_output_folder_that_cannot_be_made_is_said_before_the_run() {
    let scratch = tempfile::tempdir().unwrap();
    fs::write(scratch.path().join("file"), "precious").unwrap();
    let output = carom(scratch.path())
        .args([
            "run",
            "shot-2-96",
            "--engine",
            "lecture",
            "--out",
            "file/sub",
        ])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("file/sub") && said.contains("cannot be written"),
        "{said}"
    );
    assert_eq!(
        fs::read_to_string(scratch.path().join("file")).unwrap(),
        "precious"
    );
}

#[test]
fn an_overlapping_start_is_allowed_with_a_warning() {
    let scratch = tempfile::tempdir().unwrap();
    let text = GOOD.replacen("position = [3.0", "position = [0.5", 1);
    fs::write(scratch.path().join("s.toml"), text).unwrap();
    let run = ["run", "s.toml", "--engine", "lecture", "--out", "out"];
    let output = carom(scratch.path()).args(run).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success());
    assert!(said.contains("`a` and `b` by 5.000e-1"), "{said}");
}

#[test]
fn a_blow_up_is_a_result_with_a_warning() {
    let scratch = tempfile::tempdir().unwrap();
    let text = GOOD.replacen("stiffness = 1.0", "stiffness = 1e300", 1);
    fs::write(scratch.path().join("s.toml"), text).unwrap();
    let run = ["run", "s.toml", "--engine", "lecture", "--out", "out"];
    let output = carom(scratch.path()).args(run).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    assert!(said.contains("not finite by t = 0.25 s"), "{said}");
    let table = fs::read_to_string(scratch.path().join("out/trajectory-lecture.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 2, "the start alone is finite");
    for file in [
        "metrics.csv",
        "divergence.csv",
        "events-lecture.csv",
        "summary.json",
    ] {
        let text = fs::read_to_string(scratch.path().join("out").join(file)).unwrap();
        assert!(!text.contains("NaN") && !text.contains("inf"), "{file}");
    }
}

/// Ctrl-C in the middle of a run: exit 130, and whatever files there are are whole.
#[cfg(unix)]
#[test]
fn an_interrupt_leaves_complete_files_only() {
    let scratch = tempfile::tempdir().unwrap();
    let long = GOOD.replacen("duration = 1.0", "duration = 40000.0", 1);
    fs::write(scratch.path().join("s.toml"), long).unwrap();
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("carom"))
        .current_dir(scratch.path())
        .args([
            "run", "s.toml", "--engine", "lecture", "--out", "out", "--dt", "0.0001",
        ])
        .spawn()
        .unwrap();
    let out = scratch.path().join("out");
    while !out.exists() {
        assert_eq!(child.try_wait().unwrap(), None, "it ended before it began");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let pid = child.id().to_string();
    std::process::Command::new("kill")
        .args(["-INT", &pid])
        .status()
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    // A folder that was made for the run goes with it, unless the interrupt came before the stage.
    let left = fs::read_dir(&out).map_or(0, Iterator::count);
    assert_eq!(left, 0);
}
