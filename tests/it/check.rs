//! `carom check` as a user types it: verdicts, exit codes, formats, and what it refuses.

use std::fs;
use std::path::Path;

use carom::case::{Library, Metric};
use carom::study::check::{Replay, replay};

use crate::command::carom;

/// A folder with a copy of some reference cases in `cases`.
fn copied(names: &[&str]) -> tempfile::TempDir {
    let scratch = tempfile::tempdir().unwrap();
    for name in names {
        let from = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("reference")
            .join(name);
        let to = scratch.path().join("cases").join(name);
        fs::create_dir_all(&to).unwrap();
        for file in fs::read_dir(from).unwrap() {
            let file = file.unwrap();
            fs::copy(file.path(), to.join(file.file_name())).unwrap();
        }
    }
    scratch
}

/// Changes the text of a case's file.
fn edit(folder: &Path, file: &str, change: impl Fn(&str) -> String) {
    let path = folder.join("cases").join(file);
    let text = fs::read_to_string(&path).unwrap();
    let changed = change(&text);
    assert_ne!(text, changed, "{file} is not changed");
    fs::write(path, changed).unwrap();
}

/// The first tolerance of a table of `expected.toml` becomes another number.
fn with_tolerance(text: &str, table: &str, tolerance: &str) -> String {
    let (before, after) = text.split_once(&format!("[{table}]")).unwrap();
    let (middle, after) = after.split_once("tolerance = ").unwrap();
    let (_, after) = after.split_once(',').unwrap();
    format!("{before}[{table}]{middle}tolerance = {tolerance},{after}")
}

#[test]
fn every_format_tells_the_same_verdict_and_the_exit_code_says_it() {
    let scratch = copied(&["headon-equal", "inelastic-e05"]);
    let folder = scratch.path();
    let check = |more: &[&str]| {
        let arguments = ["check", "--reference", "cases", "--engine", "lecture"];
        carom(folder, &[&arguments[..], more].concat())
    };
    let (code, text, _) = check(&[]);
    assert!(
        code == 0 && text.contains("lecture: 2 of 2 cases hold"),
        "{text}"
    );
    assert_eq!(check(&["--quiet"]), (0, String::new(), String::new()));
    edit(folder, "inelastic-e05/expected.toml", |text| {
        with_tolerance(text, "profile.lecture.truth", "1e-9")
    });
    let (code, text, _) = check(&[]);
    assert!(
        code == 1 && text.contains("lecture: 1 of 2 cases hold"),
        "{text}"
    );
    let (code, json, _) = check(&["--format", "json"]);
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(code == 1 && report["holds"] == false);
    let failed: Vec<_> = report["checks"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|check| {
            let mut all = check["comparisons"].as_array().unwrap().iter();
            all.any(|comparison| comparison["held"] == "fails")
        })
        .map(|check| check["case"].as_str().unwrap())
        .collect();
    assert_eq!(failed, ["inelastic-e05"]);
    let (code, junit, _) = check(&["--format", "junit"]);
    assert_eq!(code, 1);
    assert!(junit.contains("tests=\"2\" failures=\"1\""), "{junit}");
    assert_eq!(junit.matches("<failure").count(), 1);
    assert_eq!(junit.matches("<testcase").count(), 2);
}

/// A tolerance below the known value fails, names the first sample, and truth with both numbers.
#[test]
fn a_failure_names_the_first_sample_and_the_first_event() {
    let scratch = copied(&["oblique-inelastic"]);
    let folder = scratch.path();
    edit(folder, "oblique-inelastic/expected.toml", |text| {
        with_tolerance(text, "profile.lecture.truth", "1e-9")
    });
    let (code, text, _) = carom(
        folder,
        &["check", "--reference", "cases", "--engine", "lecture"],
    );
    assert_eq!(code, 1);
    assert!(
        text.contains("position is first beyond its tolerance at t = "),
        "{text}"
    );
    assert!(text.contains("where truth has"), "{text}");
}

/// Blessing twice changes nothing; a tighter tolerance in the file is only widened when that is
/// said, a wider one is taken back at once; what stands beside it stays.
#[test]
fn blessing_shows_what_changes_and_refuses_to_widen_unasked() {
    let scratch = copied(&["cushion-one"]);
    let folder = scratch.path();
    let bless = |more: &[&str]| {
        let arguments = [
            "check",
            "--reference",
            "cases",
            "--engine",
            "lecture",
            "--bless",
        ];
        carom(folder, &[&arguments[..], more].concat())
    };
    let expected = || fs::read_to_string(folder.join("cases/cushion-one/expected.toml")).unwrap();
    let first = expected();
    let (code, text, _) = bless(&[]);
    assert!(code == 0 && text.contains("nothing changes"), "{text}");
    assert_eq!(expected(), first);
    edit(folder, "cushion-one/expected.toml", |text| {
        with_tolerance(text, "profile.lecture.baseline", "1e-30")
    });
    let tight = expected();
    let (code, text, _) = bless(&[]);
    assert!(
        code == 1 && text.contains("WIDER") && text.contains("--widen"),
        "{text}"
    );
    assert_eq!(expected(), tight, "refused, so nothing was written");
    let (code, ..) = bless(&["--widen"]);
    assert_eq!((code, expected()), (0, first.clone()));
    edit(folder, "cushion-one/expected.toml", |text| {
        with_tolerance(text, "profile.lecture.baseline", "1e30")
    });
    let (code, text, _) = bless(&[]);
    assert!(code == 0 && text.contains("1 profiles written"), "{text}");
    assert_eq!(expected(), first);
}

/// A ball in free flight, with a truth of its own that is the line x = t: the profile's errors
/// are rounding, and a solver of anybody's can be stored under any name.
#[test]
fn a_case_of_ones_own_is_blessed_and_then_checked() {
    let scratch = tempfile::tempdir().unwrap();
    let case = scratch.path().join("cases/flight");
    fs::create_dir_all(&case).unwrap();
    let scene = "name='flight'\nduration=2\nsample_every=1\n[[bodies]]\nname='a'\nmass=1\n\
        radius=1\nposition=[0,0,0]\nvelocity=[1,0,0]\n";
    fs::write(case.join("scene.toml"), scene).unwrap();
    let truth = "time,body,x,y,z,vx,vy,vz\n0,a,0,0,0,1,0,0\n1,a,1,0,0,1,0,0\n2,a,2,0,0,1,0,0\n";
    fs::write(case.join("truth.csv"), truth).unwrap();
    let check = |more: &[&str]| {
        let arguments = ["check", "--reference", "cases", "--engine", "lecture"];
        carom(scratch.path(), &[&arguments[..], more].concat())
    };
    let (code, _, said) = check(&[]);
    assert!(
        code == 2 && said.contains("nothing is stored of `lecture`"),
        "{said}"
    );
    assert_eq!(check(&["--bless"]).0, 0);
    assert_eq!(check(&[]).0, 0);
    let library = Library::Folder(scratch.path().join("cases"));
    let profile = &library.case("flight").unwrap().expected.unwrap().profile["lecture"];
    let known = profile.truth.as_ref().unwrap();
    assert_eq!(known.until, 2.0);
    // 100 steps a second: at most 4 roundings of 2 in each of 200 steps, and those of the truth.
    let position = known.of(Metric::Position).unwrap();
    let room = 4.0 * 201.0 * 2.0 * f64::EPSILON + 4.0 * f64::EPSILON;
    assert!(
        position.value <= 1e-13 && position.tolerance <= room + 2e-13,
        "{position:?}"
    );
    assert!(known.of(Metric::Momentum).is_some());
    assert!(known.of(Metric::Penetration).is_none(), "nothing can touch");
}

/// A stored recording that is not the one whose digest is stored tells nothing about anybody.
#[test]
fn a_baseline_that_was_tampered_with_is_told() {
    let scratch = copied(&["inelastic-e05"]);
    let file = "inelastic-e05/baseline-lecture.csv";
    edit(scratch.path(), file, |text| {
        let (before, last) = text.trim_end().rsplit_once(',').unwrap();
        let moved = last.parse::<f64>().unwrap() + 1e-15;
        format!("{before},{moved:?}\n")
    });
    let arguments = ["check", "--reference", "cases", "--engine", "lecture"];
    let (code, _, said) = carom(scratch.path(), &arguments);
    assert_eq!(code, 2);
    assert!(said.contains("is not the recording whose digest"), "{said}");
}

#[test]
fn a_replay_names_the_first_number_that_differs_in_any_bit() {
    let case = Library::Embedded.case("shot-2-61").unwrap();
    let run = crate::scenes::lecture(&case.scene, 0.01);
    let Replay::Same { samples, digest } = replay(&case.scene, &run, &run) else {
        panic!("a recording differs from itself");
    };
    assert_eq!((samples, digest), (121, run.digest()));
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let again = |file: &str| {
        let arguments = [
            "check",
            "shot-2-61",
            "--engine",
            "lecture",
            "--replay",
            file,
        ];
        carom(folder, &arguments)
    };
    carom(
        folder,
        &[
            "run",
            "shot-2-61",
            "--engine",
            "lecture",
            "--quiet",
            "--out",
            "run",
        ],
    );
    let file = "run/trajectory-lecture.csv";
    let (code, text, _) = again(file);
    assert!(
        code == 0 && text.contains("the same in every bit: 121 samples"),
        "{text}"
    );
    // The last digit of one number, 12 samples on.
    let text = fs::read_to_string(folder.join(file)).unwrap();
    let rows: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut columns: Vec<String> = rows[50].split(',').map(str::to_owned).collect();
    let moved: f64 = columns[4].parse().unwrap();
    columns[4] = format!("{:?}", moved.next_up());
    let mut changed = rows.clone();
    changed[50] = columns.join(",");
    fs::write(folder.join("changed.csv"), changed.join("\n")).unwrap();
    let (code, text, _) = again("changed.csv");
    assert_eq!(code, 1);
    assert!(
        text.contains("(sample 12): z of `ball1`") && text.contains("1 ulp apart"),
        "{text}"
    );
}

#[test]
fn what_cannot_be_checked_is_refused_in_one_line() {
    let scratch = tempfile::tempdir().unwrap();
    let table: [(&[&str], &str); 9] = [
        (&["headon-equel"], "neither a scene file nor a case"),
        (
            &["headon-equal", "--engine", "lectur"],
            "no engine is called `lectur`",
        ),
        (
            &["headon-equal", "--engine", "rapier-f64"],
            "nothing is stored of",
        ),
        (
            &["headon-equal", "--like", "mine"],
            "nothing is stored of `mine`",
        ),
        (&["headon-equal", "--solver", "cp 'x"], "a quote stays open"),
        (
            &["headon-equal", "--solver", "no-such-program"],
            "cannot be started",
        ),
        (
            &["headon-equal", "--solver", "cp", "--limit", "-1"],
            "--limit -1",
        ),
        (
            &["headon-equal", "headon-3-to-1", "--trajectory", "x.csv"],
            "name the one case",
        ),
        (&["headon-equal", "--bless"], "--reference"),
    ];
    for (arguments, said) in table {
        let (code, _, complaint) = carom(scratch.path(), &[&["check"], arguments].concat());
        assert_eq!(code, 2, "{arguments:?}: {complaint}");
        assert!(complaint.contains(said), "{arguments:?}: {complaint}");
        assert_eq!(complaint.trim_end().lines().count(), 1, "{complaint}");
    }
}

/// What a program does wrong is a failed check with its reason, within its time.
#[cfg(unix)]
#[test]
fn a_program_that_misbehaves_fails_its_check_and_says_why() {
    let scratch = tempfile::tempdir().unwrap();
    let table = [
        ("sleep 60", "took longer than"),
        ("sh -c 'echo no memory >&2; exit 3'", "no memory"),
        ("sh -c 'kill -SEGV $$'", "signal 11"),
        ("yes", "wrote more than"),
        ("sh -c 'echo time,body,x,y,z,vx,vy,vz; echo 0,a'", "line 2"),
        ("true", "nothing is there"),
    ];
    for (command, reason) in table {
        let begin = std::time::Instant::now();
        let arguments = ["check", "headon-equal", "--solver", command, "--limit", "1"];
        let (code, text, said) = carom(scratch.path(), &arguments);
        assert_eq!(code, 1, "{command}: {text}{said}");
        assert!(text.contains(reason), "{command}: {text}");
        assert!(
            begin.elapsed().as_secs() < 20,
            "{command} outlived its limit"
        );
    }
    // One that hangs is not waited for on every case.
    let arguments = ["check", "--solver", "sleep 60", "--limit", "0.5"];
    let (code, text, _) = carom(scratch.path(), &arguments);
    assert_eq!(code, 1);
    assert!(text.contains("not started: it ran out of time"), "{text}");
}
