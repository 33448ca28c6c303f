//! What stands in an output folder: nothing of somebody else is replaced, and the earlier result
//! stays until the new one is whole.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::command::carom;

/// Kills of each command in the normal run of the tests; `CAROM_KILLS` names another number.
const KILLS: u64 = 10;

/// The files below a folder by their path, without those that a killed run has staged.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let all = crate::command_line::files(folder).into_iter();
    let below = |path: String| {
        let below = Path::new(&path).strip_prefix(folder).unwrap();
        below.to_string_lossy().into_owned()
    };
    all.map(|(path, bytes)| (below(path), bytes))
        .filter(|(path, _)| !path.starts_with(".carom-stage-") && !path.contains("/.carom-stage-"))
        .collect()
}

/// Every name in a folder, hidden ones too.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// A command that must be refused: exit 2, one line that holds all of `said`.
fn refused(folder: &Path, arguments: &[&str], said: &[&str]) {
    let (code, out, error) = carom(folder, arguments);
    assert_eq!((code, out.as_str()), (2, ""), "{arguments:?}: {error}");
    let complaints: Vec<_> = error
        .lines()
        .filter(|line| !line.starts_with("warning"))
        .collect();
    assert_eq!(complaints.len(), 1, "{error}");
    for part in said {
        assert!(complaints[0].contains(part), "{part:?} in {error}");
    }
}

fn done(folder: &Path, arguments: &[&str]) {
    let (code, _, error) = carom(folder, arguments);
    assert_eq!(code, 0, "{arguments:?}: {error}");
}

/// A quick call of every command that writes a folder, with a file that it writes.
const WRITERS: [(&[&str], &str); 6] = [
    (
        &["run", "headon-equal", "--engine", "lecture"],
        "metrics.csv",
    ),
    (
        &["report", "headon-equal", "--engine", "lecture"],
        "README.md",
    ),
    (
        &[
            "cost",
            "headon-equal",
            "--engine",
            "lecture",
            "--repetitions",
            "1",
            "--budget",
            "300",
        ],
        "cost.csv",
    ),
    (
        &[
            "cost",
            "--bodies",
            "4",
            "--engine",
            "lecture",
            "--repetitions",
            "1",
        ],
        "bodies.csv",
    ),
    (
        &[
            "effects",
            "headon-equal",
            "--engine",
            "lecture",
            "--repetitions",
            "1",
        ],
        "effects.csv",
    ),
    (
        &["stability", "e-zero", "--engine", "lecture"],
        "failures.csv",
    ),
];

fn into<'a>(arguments: &[&'a str], out: &'a str) -> Vec<&'a str> {
    let mut all = arguments.to_vec();
    all.extend(["--quiet", "--out", out]);
    all
}

#[test]
fn a_foreign_file_is_never_replaced_unasked_and_others_stay() {
    for (writer, file) in WRITERS {
        let scratch = tempfile::tempdir().unwrap();
        let folder = scratch.path();
        let out = folder.join("d");
        let mine = ["trajectory-mine.csv", "events-notes.csv", "notes.txt"];
        fs::create_dir(&out).unwrap();
        for name in mine {
            fs::write(out.join(name), "precious").unwrap();
        }
        let arguments = into(writer, "d");
        for name in [file, "README.md", "summary.json"] {
            fs::write(out.join(name), "precious").unwrap();
            refused(
                folder,
                &arguments,
                &[name, "not written by", "--force", "--out"],
            );
            assert_eq!(fs::read(out.join(name)).unwrap(), b"precious", "{writer:?}");
            assert_eq!(names(&out).len(), 4, "{writer:?}");
            fs::remove_file(out.join(name)).unwrap();
        }
        fs::write(out.join("README.md"), "precious").unwrap();
        done(folder, &[&arguments[..], &["--force"]].concat());
        assert!(out.join("summary.json").is_file(), "{writer:?}");
        // A second run replaces what the first has written.
        done(folder, &arguments);
        for name in mine {
            assert_eq!(fs::read(out.join(name)).unwrap(), b"precious", "{writer:?}");
        }
        // What somebody changed since is somebody's.
        fs::write(out.join("README.md"), "my notes").unwrap();
        refused(folder, &arguments, &["README.md", "was changed"]);
        assert_eq!(fs::read(out.join("README.md")).unwrap(), b"my notes");
    }
}

#[test]
fn every_file_of_a_result_is_listed_and_one_that_is_not_written_again_goes() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let run = |engines| into(&["run", "headon-equal", "--engine", engines], "d");
    done(folder, &run("lecture,verlet"));
    let summary = fs::read(folder.join("d/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    let mut listed: Vec<_> = summary["files"].as_object().unwrap().keys().collect();
    let own = "summary.json".to_owned();
    listed.push(&own);
    listed.sort();
    assert_eq!(
        names(&folder.join("d")),
        listed.into_iter().cloned().collect::<Vec<_>>()
    );
    done(folder, &run("lecture"));
    let left = names(&folder.join("d"));
    assert!(!left.iter().any(|name| name.contains("verlet")), "{left:?}");
}

#[test]
fn a_report_leaves_foreign_indexes_and_files_in_the_place_of_cases() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let report = into(&["report", "headon-equal", "--engine", "lecture"], "r");
    done(folder, &report);
    let before = files(&folder.join("r"));
    let case = folder.join("r/headon-equal");
    fs::rename(&case, folder.join("aside")).unwrap();
    fs::write(&case, "precious").unwrap();
    refused(
        folder,
        &report,
        &["headon-equal", "where a folder is needed"],
    );
    fs::remove_file(&case).unwrap();
    fs::rename(folder.join("aside"), &case).unwrap();
    assert!(
        before == files(&folder.join("r")),
        "the earlier report stands"
    );
    fs::write(case.join("trajectory-lecture.csv"), "precious").unwrap();
    refused(folder, &report, &["trajectory-lecture.csv", "was changed"]);
    fs::write(folder.join("README.md"), "precious").unwrap();
    refused(
        folder,
        &into(&["report", "headon-equal"], "."),
        &["README.md"],
    );
}

#[cfg(unix)]
#[test]
fn links_are_neither_replaced_nor_written_through() {
    use std::os::unix::fs::symlink;
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let run = into(&["run", "headon-equal", "--engine", "lecture"], "d");
    for name in [
        "README.md",
        "metrics.csv",
        "trajectory-lecture.csv",
        "summary.json",
    ] {
        let link = folder.join("d").join(name);
        fs::create_dir_all(folder.join("d")).unwrap();
        fs::write(folder.join("real"), "precious").unwrap();
        for target in ["../real", "../nowhere"] {
            symlink(target, &link).unwrap();
            refused(folder, &run, &[name, "is a link"]);
            assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
            done(folder, &[&run[..], &["--force"]].concat());
            assert!(fs::symlink_metadata(&link).unwrap().is_file());
            assert_eq!(fs::read(folder.join("real")).unwrap(), b"precious");
            assert!(!folder.join("nowhere").exists());
            fs::remove_dir_all(folder.join("d")).unwrap();
            fs::create_dir(folder.join("d")).unwrap();
        }
    }
    fs::create_dir(folder.join("elsewhere")).unwrap();
    fs::create_dir(folder.join("r")).unwrap();
    symlink("../elsewhere", folder.join("r/headon-equal")).unwrap();
    let report = into(&["report", "headon-equal", "--engine", "lecture"], "r");
    refused(folder, &report, &["headon-equal", "is a link"]);
    assert!(names(&folder.join("elsewhere")).is_empty());
    symlink("nowhere", folder.join("new.toml")).unwrap();
    refused(
        folder,
        &["scenes", "new", "mine", "--out", "new.toml"],
        &["--force"],
    );
    assert!(!folder.join("nowhere").exists());
}

/// Starts carom with its output thrown away.
fn start(folder: &Path, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_carom"))
        .current_dir(folder)
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let there = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &there);
        } else {
            fs::copy(&path, &there).unwrap();
        }
    }
}

/// Whether a stage with a journal is left in a folder.
fn has_journal(folder: &Path) -> bool {
    let mut stages = names(folder).into_iter();
    stages.any(|name| folder.join(name).join("journal.json").is_file())
}

/// Kills a command at moments spread over its run; the folder is the old result or the new one,
/// or the next run completes it; and the next run leaves the new one and nothing else.
fn killed_at_any_moment(old: &[&str], new: &[&str]) {
    let kills = std::env::var("CAROM_KILLS").map_or(KILLS, |count| count.parse().unwrap());
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    done(folder, &into(old, "old"));
    let begun = Instant::now();
    done(folder, &into(new, "new"));
    let whole = begun.elapsed();
    let [before, after] = ["old", "new"].map(|name| files(&folder.join(name)));
    assert!(before != after);
    let (mut kept, mut replaced, mut begun_to_replace) = (0, 0, 0);
    for kill in 0..kills {
        copy(&folder.join("old"), &folder.join("d"));
        let mut child = start(folder, &into(new, "d"));
        // Spread evenly, the later half of the moments around the end.
        let share = (kill as f64 + 0.5) / kills as f64;
        thread::sleep(whole.mul_f64(if kill % 2 == 0 {
            share
        } else {
            0.8 + 0.3 * share
        }));
        child.kill().unwrap();
        child.wait().unwrap();
        let found = files(&folder.join("d"));
        if found == before {
            kept += 1;
        } else if found == after {
            replaced += 1;
        } else {
            // Between two renames: the journal is there, from which the next run completes it.
            assert!(
                has_journal(&folder.join("d")),
                "kill {kill}: a mix of two results"
            );
            begun_to_replace += 1;
        }
        if kill % 5 == 0 || found != before && found != after {
            done(folder, &into(new, "d"));
            assert!(
                files(&folder.join("d")) == after,
                "kill {kill}: not repaired"
            );
            assert_eq!(names(&folder.join("d")), names(&folder.join("new")));
        }
        fs::remove_dir_all(folder.join("d")).unwrap();
    }
    println!(
        "{kills} kills of {new:?}: {kept} left the old result, {replaced} the new one, and \
         {begun_to_replace} what the next run completed"
    );
}

#[test]
fn a_run_killed_at_any_moment_leaves_the_old_result_or_the_new_one() {
    killed_at_any_moment(
        &["run", "headon-equal", "--engine", "lecture,verlet"],
        &["run", "shot-2-96", "--engine", "lecture,exact-fast"],
    );
}

#[test]
fn a_report_killed_at_any_moment_leaves_the_old_result_or_the_new_one() {
    killed_at_any_moment(
        &[
            "report",
            "headon-equal",
            "shot-2-96",
            "--engine",
            "lecture,verlet",
        ],
        &[
            "report",
            "headon-equal",
            "shot-2-96",
            "--engine",
            "lecture,exact-fast",
            "--dt",
            "0.005",
        ],
    );
}

/// An interrupted study of several scenes leaves the earlier result, and beside it what it has
/// found.
#[cfg(unix)]
#[test]
fn an_interrupted_study_leaves_the_earlier_result_and_its_own_part_beside_it() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let quick = [
        "--engine",
        "lecture",
        "--repetitions",
        "1",
        "--budget",
        "300",
    ];
    let study = |scenes: &[&'static str]| into(&[&["cost"], scenes, &quick].concat(), "d");
    done(folder, &study(&["headon-equal", "kepler-circle"]));
    let before = files(&folder.join("d"));
    // The reference of the second scene takes many seconds.
    let long = study(&["headon-equal", "cluster-30"]);
    let mut child = start(folder, &long);
    let part = folder.join("d/unfinished/cost.csv");
    let patience = Instant::now();
    while !part.exists() && patience.elapsed() < Duration::from_secs(60) {
        thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let mut found = files(&folder.join("d"));
    let unfinished: Vec<_> = found
        .keys()
        .filter(|path| path.starts_with("unfinished/"))
        .cloned()
        .collect();
    assert!(
        unfinished.contains(&"unfinished/README.md".to_owned()),
        "{unfinished:?}"
    );
    for path in unfinished {
        found.remove(&path);
    }
    assert!(before == found, "the earlier result stands");
    done(folder, &study(&["headon-equal"]));
    assert!(!folder.join("d/unfinished").exists());
}

/// Joined rows live in the very file that the study replaces.
#[test]
fn joined_rows_outlive_an_interrupted_study() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let study = |sizes, join: &[&'static str]| {
        let arguments = [
            &[
                "cost",
                "--bodies",
                sizes,
                "--engine",
                "lecture",
                "--repetitions",
                "1",
            ],
            join,
        ];
        into(&arguments.concat(), "d")
    };
    done(folder, &study("4", &[]));
    let table = fs::read_to_string(folder.join("d/bodies.csv")).unwrap();
    let build = table.lines().nth(1).unwrap().split(',').next().unwrap();
    let other = table.replace(&format!("\n{build},"), "\nother,");
    fs::write(folder.join("other.csv"), other).unwrap();
    done(folder, &study("4", &["--join", "other.csv"]));
    let joined = fs::read(folder.join("d/bodies.csv")).unwrap();
    let mut child = start(folder, &study("4,10000,20000", &["--join", "other.csv"]));
    let part = folder.join("d/unfinished/bodies.csv");
    let patience = Instant::now();
    while !part.exists() && patience.elapsed() < Duration::from_secs(60) {
        thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(fs::read(folder.join("d/bodies.csv")).unwrap(), joined);
    let part = fs::read_to_string(part).unwrap();
    assert!(
        part.contains("\nother,"),
        "joined rows stand in the part too: {part}"
    );
}

#[test]
fn two_runs_into_one_folder_exclude_each_other() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let long = into(
        &[
            "run",
            "cluster-8",
            "--engine",
            "lecture",
            "--dt",
            "0.000002",
        ],
        "d",
    );
    let mut child = start(folder, &long);
    let patience = Instant::now();
    while !folder.join("d").exists() && patience.elapsed() < Duration::from_secs(30) {
        thread::sleep(Duration::from_millis(2));
    }
    thread::sleep(Duration::from_millis(50));
    let short = into(&["run", "headon-equal", "--engine", "lecture"], "d");
    refused(folder, &short, &["another carom is writing there", "--out"]);
    child.kill().unwrap();
    child.wait().unwrap();
    // The lock has ended with its holder, and the next run removes what that has staged.
    done(folder, &short);
    assert!(
        !names(&folder.join("d"))
            .iter()
            .any(|name| name.starts_with('.'))
    );
}

/// A limit on the size of files stands for a full disk: the write fails halfway.
#[cfg(unix)]
#[test]
fn a_write_that_fails_leaves_the_earlier_result() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    done(
        folder,
        &into(&["run", "headon-equal", "--engine", "lecture"], "d"),
    );
    let before = files(&folder.join("d"));
    let limited = format!(
        "ulimit -f 64; exec {} run shot-2-96 --engine lecture --dt 0.001 --quiet --out d",
        env!("CARGO_BIN_EXE_carom")
    );
    let output = Command::new("sh")
        .current_dir(folder)
        .args(["-c", &limited])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("what stood there before is unchanged"),
        "{said}"
    );
    assert!(before == files(&folder.join("d")));
    assert_eq!(
        names(&folder.join("d")).len(),
        before.len(),
        "nothing staged is left"
    );
}

/// Makes a stage with a journal as a killed run leaves it; the files in it hold `new`.
fn stage(root: &Path, name: &str, journal: &str, staged: &[&str]) -> std::path::PathBuf {
    let stage = root.join(name);
    fs::create_dir_all(stage.join("files")).unwrap();
    let mark = "A result of carom in the making. The next run into the folder around it removes this one.\n";
    fs::write(stage.join("about.txt"), mark).unwrap();
    for path in staged {
        let path = stage.join("files").join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "new").unwrap();
    }
    fs::write(stage.join("journal.json"), journal).unwrap();
    stage
}

/// `printf old | sha256sum`
const OLD: &str = "cba06b5736faf67e54b07b561eae94395e774c517a7d910a54369e1263ccfbd4";

const RUN: [&str; 4] = ["run", "headon-equal", "--engine", "lecture"];

/// A commit that was killed halfway is completed by the next run, before its own.
#[test]
fn a_commit_that_was_begun_is_completed() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let root = folder.join("d");
    let journal = format!(
        r#"{{"remove": [{{"path": "gone.csv", "before": "{OLD}"}}], "prune": [],
            "place": [{{"path": "b.csv", "before": null}}, {{"path": "c.csv", "before": "{OLD}"}},
                      {{"path": "sub/a.csv", "before": null}}]}}"#
    );
    // Of `b.csv` and `c.csv` the first was placed before the kill.
    let stage = stage(&root, ".carom-stage-x", &journal, &["c.csv", "sub/a.csv"]);
    for (name, text) in [("gone.csv", "old"), ("b.csv", "new"), ("c.csv", "old")] {
        fs::write(root.join(name), text).unwrap();
    }
    done(folder, &into(&RUN, "d"));
    assert!(!root.join("gone.csv").exists());
    for name in ["b.csv", "c.csv", "sub/a.csv"] {
        assert_eq!(fs::read(root.join(name)).unwrap(), b"new", "{name}");
    }
    assert!(!stage.exists());
}

/// What was edited after the kill is somebody's, and a stage that somebody made names no file
/// that carom did not write, none outside, and none through a link.
#[test]
fn a_journal_is_obeyed_only_for_files_that_are_as_they_were() {
    let one = |act: &str, path: &str, before: &str| {
        let before = if before.is_empty() {
            "null".to_owned()
        } else {
            format!("\"{before}\"")
        };
        let mut lists = ["remove", "place"].map(|name| (name, String::new()));
        for (name, list) in &mut lists {
            if *name == act {
                *list = format!("{{\"path\": \"{path}\", \"before\": {before}}}");
            }
        }
        format!(
            "{{\"remove\": [{}], \"prune\": [], \"place\": [{}]}}",
            lists[0].1, lists[1].1
        )
    };
    for (act, path, before) in [
        ("remove", "mine.txt", ""),
        ("remove", "mine.txt", OLD),
        ("place", "mine.txt", ""),
        ("place", "mine.txt", OLD),
        ("remove", "../precious", ""),
        ("remove", "link/precious", ""),
        ("place", "link/mine.txt", ""),
        ("place", "link/new.txt", ""),
        ("remove", "", ""),
    ] {
        let scratch = tempfile::tempdir().unwrap();
        let folder = scratch.path();
        fs::create_dir_all(folder.join("other")).unwrap();
        for name in ["precious", "other/precious", "other/mine.txt"] {
            fs::write(folder.join(name), "precious").unwrap();
        }
        let staged: &[&str] = if act == "place" { &[path] } else { &[] };
        let left = stage(
            &folder.join("d"),
            ".carom-stage-x",
            &one(act, path, before),
            staged,
        );
        fs::write(folder.join("d/mine.txt"), "edited").unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink("../other", folder.join("d/link")).unwrap();
        done(folder, &into(&RUN, "d"));
        assert_eq!(
            fs::read(folder.join("d/mine.txt")).unwrap(),
            b"edited",
            "{act} {path}"
        );
        for name in ["precious", "other/precious", "other/mine.txt"] {
            assert_eq!(
                fs::read(folder.join(name)).unwrap(),
                b"precious",
                "{act} {path}"
            );
        }
        assert_eq!(names(&folder.join("other")).len(), 2, "{act} {path}");
        assert!(!left.exists());
    }
    // A folder of that kind of name without the mark is not carom's.
    let scratch = tempfile::tempdir().unwrap();
    let notes = scratch.path().join("d/.carom-stage-notes");
    fs::create_dir_all(&notes).unwrap();
    fs::write(notes.join("precious"), "precious").unwrap();
    done(scratch.path(), &into(&RUN, "d"));
    assert_eq!(fs::read(notes.join("precious")).unwrap(), b"precious");
}

/// Only a part that carom marked as one goes when the whole is there.
#[test]
fn a_whole_result_in_the_place_of_a_part_stays() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    done(folder, &into(&RUN, "whole"));
    let before = files(&folder.join("whole"));
    copy(&folder.join("whole"), &folder.join("d/unfinished"));
    done(folder, &into(&RUN, "d"));
    assert!(before == files(&folder.join("d/unfinished")));
    let cost = [
        "cost",
        "headon-equal",
        "--engine",
        "lecture",
        "--repetitions",
        "1",
        "--budget",
        "300",
    ];
    fs::create_dir(folder.join("e")).unwrap();
    copy(&folder.join("whole"), &folder.join("e/unfinished"));
    refused(folder, &into(&cost, "e"), &["unfinished", "not written by"]);
    assert!(before == files(&folder.join("e/unfinished")));
    #[cfg(unix)]
    {
        fs::create_dir(folder.join("f")).unwrap();
        std::os::unix::fs::symlink("../whole", folder.join("f/unfinished")).unwrap();
        done(folder, &into(&RUN, "f"));
        refused(folder, &into(&cost, "f"), &["unfinished", "is a link"]);
        assert!(before == files(&folder.join("whole")));
    }
}

/// The folder is removed while a run is on: that run fails, the next one does not.
#[test]
fn a_folder_that_is_removed_during_a_run_can_be_used_again() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let long = ["run", "cluster-8", "--engine", "lecture", "--dt", "0.00002"];
    let mut child = start(folder, &into(&long, "d"));
    let patience = Instant::now();
    while !folder.join("d").exists() && patience.elapsed() < Duration::from_secs(30) {
        thread::sleep(Duration::from_millis(2));
    }
    thread::sleep(Duration::from_millis(100));
    fs::remove_dir_all(folder.join("d")).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(2));
    done(folder, &into(&RUN, "d"));
    assert!(
        !names(&folder.join("d"))
            .iter()
            .any(|name| name.starts_with('.'))
    );
}
