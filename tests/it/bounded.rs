//! Every input has a bound that is checked before memory is taken: exit 2 and one line, where
//! the program may have no more than 1.5 GB of addresses, and within seconds.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// kB of addresses that a child may have: the peak of memory stays under 1 GB, and threads have
/// addresses for their stacks that they never touch.
const ADDRESSES_KB: u32 = 1_500_000;

/// A refusal is due within 2 s; tests share the machine with each other.
const PATIENCE: Duration = Duration::from_secs(20);

const BODY: &str = "[[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n";

fn scene() -> String {
    format!("name='x'\nduration=1\nsample_every=1\n{BODY}")
}

/// A folder with `x.toml`.
fn folder() -> tempfile::TempDir {
    let scratch = tempfile::tempdir().unwrap();
    fs::write(scratch.path().join("x.toml"), scene()).unwrap();
    scratch
}

/// Exit code and standard error of a child with few addresses.
fn confined(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let start = Instant::now();
    let output = Command::new("sh")
        .args([
            "-c",
            &format!("ulimit -v {ADDRESSES_KB}; exec \"$0\" \"$@\""),
        ])
        .arg(assert_cmd::cargo::cargo_bin("carom"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let took = start.elapsed();
    assert!(took < PATIENCE, "{arguments:?}: {took:?}");
    let said = String::from_utf8(output.stderr).unwrap();
    (output.status.code(), said)
}

/// Expects exit 2 and one line that holds some words.
fn refused(folder: &Path, arguments: &[&str], words: &str) {
    let (code, said) = confined(folder, arguments);
    assert_eq!(code, Some(2), "{arguments:?}: {said}");
    assert_eq!(said.trim_end().lines().count(), 1, "{arguments:?}: {said}");
    assert!(said.len() < 1000, "{} bytes", said.len());
    assert!(said.contains(words), "{arguments:?}: {said}");
}

/// A file of so many bytes that takes no room: zeros, which are no line ends.
fn hollow(path: &Path, bytes: u64) {
    File::create(path).unwrap().set_len(bytes).unwrap();
}

#[test]
fn counts_past_their_bound_are_refused() {
    let scratch = folder();
    let most = "18446744073709551615";
    let many = "100000000000";
    for (option, bound) in [
        ("--phases", "to 1000"),
        ("--repetitions", "1 to 10000"),
        ("--runs", "1 to 100000"),
        ("--budget", "1 to 1000000000000"),
    ] {
        for count in [most, "10000000000000"] {
            refused(scratch.path(), &["cost", "x.toml", option, count], bound);
        }
        refused(scratch.path(), &["cost", "x.toml", option, "0"], "give ");
    }
    refused(
        scratch.path(),
        &["cost", "x.toml", "--phases", many],
        "1000",
    );
    refused(scratch.path(), &["cost", "--bodies", most], "1 to 32000");
    refused(
        scratch.path(),
        &["cost", "--bodies", "4,1000000"],
        "1 to 32000",
    );
    refused(
        scratch.path(),
        &["effects", "x.toml", "--repetitions", most],
        "1 to 10000",
    );
    refused(
        scratch.path(),
        &["stability", "--budget", most],
        "1 to 1000000000000",
    );
    for dt in ["--dt=nan", "--dt=inf", "--dt=-1", "--dt=0"] {
        refused(scratch.path(), &["cost", "--bodies", "4", dt], "time step");
    }
    for dt in ["1e-300", "5e-324", "nan", "inf", "-1", "0"] {
        let dt = format!("--dt={dt}");
        for command in ["run", "plan", "effects"] {
            refused(scratch.path(), &[command, "x.toml", &dt], "time step");
        }
    }
}

#[test]
fn recipes_that_cannot_be_made_are_refused() {
    let scratch = folder();
    for (recipe, words) in [
        (vec!["rack", "--gap=-82", "--rows", "1000000000"], "--gap"),
        (vec!["rack", "--gap=-1"], "--gap"),
        (vec!["rack", "--gap=nan"], "--gap"),
        (vec!["rack", "--jitter=inf"], "--jitter"),
        (vec!["rack", "--jitter=-1"], "--jitter"),
        (vec!["rack", "--jitter=300"], "--rows"),
        (vec!["rack", "--rows", "0"], "--rows"),
        (vec!["rack", "--rows", "18446744073709551615"], "--rows"),
        (vec!["rack", "--rows", "17", "--gap", "1"], "--rows"),
        (vec!["cluster", "--count", "0"], "--count"),
        (
            vec!["cluster", "--count", "18446744073709551615"],
            "--count",
        ),
        (vec!["cluster", "--count", "1000000"], "--count"),
        (vec!["cluster", "--count", "32000"], "--extent"),
        (
            vec!["cluster", "--count", "10000", "--extent", "50"],
            "--extent",
        ),
        (vec!["cluster", "--extent=nan"], "--extent"),
        (vec!["cluster", "--extent=-3"], "--extent"),
        (vec!["cluster", "--extent=inf"], "--extent"),
        (vec!["gas", "--cells", "0"], "--cells"),
        (vec!["gas", "--cells", "21"], "--cells"),
        (vec!["gas", "--cells", "18446744073709551615"], "--cells"),
        (vec!["gas", "--count", "1000000"], "--count"),
        (vec!["gas", "--filling", "0.75"], "--filling"),
        (
            vec!["gas", "--filling", "0.74", "--cells", "2"],
            "--filling",
        ),
        (vec!["gas", "--filling=nan"], "--filling"),
        (vec!["gas", "--filling=-0.1"], "--filling"),
        (vec!["gas", "--filling", "5e-324"], "--filling"),
    ] {
        let arguments = [&["scenes", "generate"], recipe.as_slice()].concat();
        refused(scratch.path(), &arguments, words);
    }
}

/// What the largest recipes make is a scene that can be read back.
#[test]
fn the_largest_recipes_make_scenes_that_are_read() {
    let scratch = folder();
    for recipe in [
        ["gas", "--cells", "20"],
        ["gas", "--count", "32000"],
        ["rack", "--rows", "14"],
    ] {
        let arguments = [
            &["scenes", "generate"],
            &recipe[..],
            &["--out", "g.toml", "--force"],
        ];
        let (code, said) = confined(scratch.path(), &arguments.concat());
        assert_eq!((code, said.as_str()), (Some(0), ""));
        let (code, said) = confined(scratch.path(), &["plan", "g.toml", "--engine", "lecture"]);
        assert_eq!((code, said.as_str()), (Some(0), ""));
    }
}

#[test]
fn scene_files_past_a_bound_are_refused() {
    let scratch = folder();
    let bodies = |count: usize| {
        let body = |i: usize| {
            let y = 3 * i;
            format!(
                "[[bodies]]\nname='s{i}'\nmass=1\nradius=1\nposition=[0,{y},0]\nvelocity=[0,0,0]\n"
            )
        };
        let all: String = (0..count).map(body).collect();
        format!("name='x'\nduration=1\nsample_every=1\n{all}")
    };
    let lines = |line: &str, bytes: usize| line.repeat(bytes / line.len());
    let mib = 1 << 20;
    for (text, words) in [
        (lines("\n", 100 * mib), "bytes, more than"),
        (bodies(1_000_000), "bytes, more than"),
        (bodies(32_001), "at most 32000"),
        (
            format!("x=[{}]", lines("{a.a.a.a.a.a.a=1},", 8 * mib)),
            "signs",
        ),
        (
            format!("x=[{}]", lines("{1.1.1.1.1.1.1=1},", 8 * mib)),
            "signs",
        ),
        (lines("[[a]]\n", 8 * mib), "signs"),
        (format!("a{}=1\n", lines(".a", 8 * mib - 8)), "signs"),
        (format!("x=[{}]", lines("1,", 8 * mib - 8)), "x.toml:1:1"),
        (lines("x ", 8 * mib), "x.toml:1:"),
        (format!("x={}", lines("[", mib / 8)), "x.toml:1:"),
        (format!("x={}", lines("{a=", mib / 8)), "x.toml:1:"),
        (scene().replace("=1\n", "=1e300\n"), "steps, more than"),
        (
            scene().replace("duration=1", "duration=4e6"),
            "samples, more than",
        ),
    ] {
        fs::write(scratch.path().join("x.toml"), text).unwrap();
        refused(
            scratch.path(),
            &["run", "x.toml", "--engine", "lecture"],
            words,
        );
    }
}

/// All pairs of coincident bodies overlap; they were listed to be counted.
#[test]
fn a_heap_of_coincident_bodies_is_warned_of_in_little_memory() {
    let scratch = folder();
    let body = |i: usize| BODY.replace("'a'", &format!("'s{i}'"));
    let all: String = (0..20_000).map(body).collect();
    let head = "name='x'\nduration=1\nsample_every=1\n";
    let text = format!("{head}{all}[effects.contact]\nrestitution=1\n");
    fs::write(scratch.path().join("x.toml"), text).unwrap();
    let (code, said) = confined(scratch.path(), &["run", "x.toml", "--engine", "exact"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.starts_with("warning: more than 20000000 pair(s) overlap"),
        "{said}"
    );
    assert!(
        said.contains("error: exact cannot compute this scene"),
        "{said}"
    );
}

/// Recordings of many engines are in memory together.
#[test]
fn states_are_counted_over_all_engines() {
    let scratch = folder();
    let text = scene().replace("duration=1", "duration=150000");
    let bodies: String = (0..20)
        .map(|i| BODY.replace("'a'", &format!("'s{i}'")))
        .collect();
    fs::write(scratch.path().join("x.toml"), text.replace(BODY, &bodies)).unwrap();
    let words = "states to hold";
    refused(
        scratch.path(),
        &["run", "x.toml", "--engine", "lecture,verlet,exact"],
        words,
    );
}

/// Every file that is read, with what names it on the command line.
#[test]
fn endless_and_huge_files_are_refused() {
    let scratch = folder();
    let at = |name: &str| scratch.path().join(name);
    hollow(&at("huge"), 1_500_000_000);
    hollow(&at("small"), 1_000_000);
    fs::create_dir(at("dir")).unwrap();
    let mut lines = File::create(at("lines")).unwrap();
    for _ in 0..100 {
        lines.write_all(&[b'\n'; 1 << 20]).unwrap();
    }
    let device = Path::new("/dev/zero").exists().then_some("/dev/zero");
    for file in ["huge", "small", "dir", "lines"].into_iter().chain(device) {
        let headon = ["check", "headon-equal"];
        let trajectory = [&headon[..], &["--trajectory", file]].concat();
        refused(scratch.path(), &trajectory, "cannot be read");
        let replay = [&headon[..], &["--engine", "lecture", "--replay", file]].concat();
        refused(scratch.path(), &replay, "cannot be read");
        refused(
            scratch.path(),
            &["cost", "--bodies", "4", "--join", file],
            "cannot be read",
        );
    }
}

#[test]
fn endless_and_huge_files_of_cases_are_refused() {
    let scratch = folder();
    let case = scratch.path().join("reference/x");
    fs::create_dir_all(&case).unwrap();
    let check = [
        "run",
        "x",
        "--reference",
        "reference",
        "--engine",
        "lecture",
    ];
    for name in [
        "truth.csv",
        "events.csv",
        "expected.toml",
        "ORIGIN.md",
        "scene.toml",
    ] {
        fs::write(case.join("scene.toml"), scene()).unwrap();
        if name == "events.csv" {
            let rows = "time,body,x,y,z,vx,vy,vz\n0,a,0,0,0,0,0,0\n1,a,0,0,0,0,0,0\n";
            fs::write(case.join("truth.csv"), rows).unwrap();
        }
        let file = case.join(name);
        hollow(&file, 1_500_000_000);
        refused(scratch.path(), &check, "cannot be read");
        fs::remove_file(&file).unwrap();
        if Path::new("/dev/zero").exists() {
            std::os::unix::fs::symlink("/dev/zero", &file).unwrap();
            refused(scratch.path(), &check, "cannot be read");
            fs::remove_file(&file).unwrap();
        }
        let _ = fs::remove_file(case.join("truth.csv"));
    }
}

/// A stored study that is no such file is left out of a report with a warning.
#[test]
fn an_endless_summary_of_a_study_is_left_out() {
    let scratch = folder();
    let study = scratch.path().join("out/cost");
    fs::create_dir_all(&study).unwrap();
    fs::write(study.join("README.md"), "page").unwrap();
    hollow(&study.join("summary.json"), 1_500_000_000);
    let report = [
        "report",
        "headon-equal",
        "--engine",
        "lecture",
        "--out",
        "out",
    ];
    let (code, said) = confined(scratch.path(), &report);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("1500000000 bytes, more than"), "{said}");
}
