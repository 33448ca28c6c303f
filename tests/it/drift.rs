//! The drift sentinel: what it measures, what it refuses, and what it says of seven versions.

use std::fs;
use std::path::{Path, PathBuf};

use carom::engine::{engine, versions};
use carom::error::Result;
use carom::physics::BodyState;
use carom::recording::{Recording, initial_states};
use carom::scene::Scene;
use carom::study::check::Subject;
use carom::study::drift::{
    Measure, Restitution, Verdict, Workers, effective_restitution, phases, restitution, two_balls,
};
use serde_json::Value;

use crate::command::carom;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("drift")
}

/// Two balls by the closed form, with a restitution that is off by `off`, at all phases or at the
/// last one alone.
struct Closed {
    off: f64,
    only_last: bool,
}

impl Subject for Closed {
    fn name(&self) -> &'static str {
        "closed"
    }

    fn record(&self, scene: &Scene, _dt: f64) -> Result<Recording> {
        let start = initial_states(scene);
        let speed = start[0].velocity.x;
        let gap = start[1].position.x - start[0].position.x - 2.0 * scene.bodies[0].radius;
        let meet = gap / speed;
        let last = 0.3 + phases().last().unwrap();
        let is_off = !self.only_last || (meet - last).abs() < 1e-9;
        let declared = scene.effects.contact.unwrap().restitution;
        let e = declared + if is_off { self.off } else { 0.0 };
        let mut recording = Recording::at_start("closed", scene);
        for sample in 1..=scene.sample_count() {
            let time = scene.sample_time(sample);
            let (before, after) = (time.min(meet), (time - meet).max(0.0));
            let share = [0.5 * (1.0 - e), 0.5 * (1.0 + e)];
            let velocity = if time < meet {
                [speed, 0.0]
            } else {
                share.map(|share| share * speed)
            };
            let states = [0, 1].map(|ball| {
                let mut state: BodyState = start[ball];
                state.position.x += start[ball].velocity.x * before;
                state.position.x += share[ball] * speed * after;
                state.velocity.x = velocity[ball];
                state
            });
            recording.push(&states);
        }
        Ok(recording)
    }
}

/// Just within the bound holds, just outside does not, on either side, also at one phase alone.
#[test]
fn a_restitution_holds_within_its_bound_and_not_outside() {
    let bound = Restitution::of(0.5, vec![0.5]).bound;
    assert!((bound - 64.0 * 2.0_f64.powi(-23)).abs() < 1e-20);
    for (times, holds) in [
        (0.0, true),
        (0.9, true),
        (-0.9, true),
        (1.1, false),
        (-1.1, false),
    ] {
        let off = times * bound;
        let all = Closed {
            off,
            only_last: false,
        };
        let found = restitution(&all, 0.5, 4.0).unwrap();
        assert_eq!(found.holds(), holds, "{times}: {found:?}");
        let one = Closed {
            off,
            only_last: true,
        };
        let found = restitution(&one, 0.5, 4.0).unwrap();
        assert_eq!(
            found.held(),
            if holds { 8 } else { 7 },
            "{times}: {found:?}"
        );
    }
    let unknown = Restitution::of(0.5, vec![0.5, f64::NAN]);
    assert!(!unknown.holds() && unknown.range()[0].is_nan());
}

/// Balls that pass through each other part as fast as they came, the wrong way round; balls that
/// never approach have no restitution.
#[test]
fn what_never_bounced_has_no_restitution_of_its_own() {
    let scene = two_balls(1.0, 4.0, 0.0);
    let start = initial_states(&scene);
    let mut through = Recording::at_start("x", &scene);
    through.push(&start);
    assert_eq!(effective_restitution(&through), -1.0);
    let mut apart = two_balls(1.0, -4.0, 0.0);
    apart.bodies[0].position[0] = -1.0;
    assert!(effective_restitution(&Recording::at_start("x", &apart)).is_nan());
}

/// What the sentinel says of a worker of carom's own version holds of carom's own engine too, and
/// of the lecture.
#[test]
fn the_engines_of_this_build_keep_the_restitution_at_every_phase() {
    for measure in Measure::all() {
        let Measure::Restitution {
            restitution: e,
            speed,
        } = measure
        else {
            continue;
        };
        for name in ["rapier", "lecture"] {
            let found = restitution(&engine(name).unwrap(), e, speed).unwrap();
            assert!(found.holds(), "{name}, {}: {found:?}", measure.name());
        }
    }
}

/// Each worker pins the version of its folder, in both of its files; carom's own version is there,
/// and nothing but bounds that hold is known of it.
#[test]
fn every_worker_pins_the_version_that_it_is_named_after() {
    let workers = Workers::read(&folder()).unwrap();
    assert_eq!(workers.versions.len(), 7);
    for of in &workers.versions {
        let manifest = of.manifest(&folder());
        let pinned = format!(
            "rapier3d = {{ version = \"={}\", default-features = false",
            of.version
        );
        assert!(
            fs::read_to_string(&manifest).unwrap().contains(&pinned),
            "{pinned}"
        );
        let lock = fs::read_to_string(manifest.with_file_name("Cargo.lock")).unwrap();
        let locked = format!("name = \"rapier3d\"\nversion = \"{}\"\n", of.version);
        assert!(lock.contains(&locked), "{locked}");
    }
    let own = versions()["rapier3d"];
    let own = workers.versions.iter().find(|of| of.version == own);
    let own = own.expect("a worker of the version that carom is built with");
    for measure in Measure::all() {
        assert_eq!(own.expected(&measure.name()), Verdict::Within);
    }
}

/// Every mistake in `workers.toml` is one line with its place and what would be right.
#[test]
fn mistakes_in_the_list_of_workers_are_told() {
    let good = "[[worker]]\nversion = \"0.36.1\"\nwhy = \"x\"\n";
    assert!(Workers::parse(good, "w.toml", &folder()).is_ok());
    let table = [
        (good.replace("why", "reason"), "w.toml:3:1: ", "reason"),
        (good.replace("why = \"x\"\n", ""), "w.toml:1:1: ", "why"),
        (
            "worker = []\n".to_owned(),
            "w.toml:1:",
            "give a version at least",
        ),
        (
            good.replace("0.36.1", "0.99.0"),
            "w.toml:2:",
            "there is no worker",
        ),
        (
            good.replace("0.36.1", "../x"),
            "w.toml:2:",
            "a version such as",
        ),
        (good.repeat(2), "w.toml:5:", "name each version once"),
        (
            format!("{good}red = [\"e 2 at 4 m/s\"]\n"),
            "w.toml:4:",
            "no such measure",
        ),
        (
            format!("{good}moved = [\"e 1 at 4 m/s\"]\n"),
            "w.toml:4:",
            "only a case moves",
        ),
        (
            format!("{good}red = [\"cushion-one\"]\nmoved = [\"cushion-one\"]\n"),
            "w.toml:5:",
            "only a case moves",
        ),
    ];
    for (text, place, said) in table {
        let wrong = Workers::parse(&text, "w.toml", &folder())
            .unwrap_err()
            .to_string();
        assert!(
            wrong.starts_with(place) && wrong.contains(said),
            "{text}{wrong}"
        );
        assert!(!wrong.contains('\n'), "{wrong}");
    }
}

/// A folder of one worker of version 0.0.1, with that source.
fn scratch(source: &str, known: &str) -> tempfile::TempDir {
    let scratch = tempfile::tempdir().unwrap();
    let worker = scratch.path().join("drift/rapier-0.0.1");
    fs::create_dir_all(worker.join("src")).unwrap();
    let write = |name: &str, text: &str| fs::write(worker.join(name), text).unwrap();
    write(
        "Cargo.toml",
        "[package]\nname = \"fake\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[workspace]\n",
    );
    write(
        "Cargo.lock",
        "version = 4\n\n[[package]]\nname = \"fake\"\nversion = \"0.0.0\"\n",
    );
    write("src/main.rs", source);
    let list = format!("[[worker]]\nversion = \"0.0.1\"\nwhy = \"made up\"\n{known}");
    fs::write(scratch.path().join("drift/workers.toml"), list).unwrap();
    scratch
}

const HERE: [&str; 3] = ["drift", "--workers", "drift"];

/// A worker in which balls fly through everything.
const FLIGHT: &str = r#"
use std::{env, fs};

fn main() {
    let paths: Vec<String> = env::args().collect();
    assert_eq!(paths.len(), 5);
    let bodies = fs::read_to_string(&paths[1]).unwrap();
    let effects = fs::read_to_string(&paths[2]).unwrap();
    let number = |key: &str| -> f64 {
        let row = effects.lines().find(|row| row.contains(key)).unwrap();
        row.rsplit(',').next().unwrap().parse().unwrap()
    };
    let mut out = String::from("time,body,x,y,z,vx,vy,vz\n");
    for sample in 0..=number(",samples,") as u32 {
        let time = f64::from(sample) * number(",sample_every,");
        for row in bodies.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let of: Vec<f64> = cells[3..].iter().map(|cell| cell.parse().unwrap()).collect();
            let x = [0, 1, 2].map(|axis| of[axis] + time * of[axis + 3]);
            out += &format!("{time:?},{},{:?},{:?},{:?},", cells[0], x[0], x[1], x[2]);
            out += &format!("{:?},{:?},{:?}\n", of[3], of[4], of[5]);
        }
    }
    fs::write(&paths[3], out).unwrap();
}
"#;

/// From cargo to the exit code: a worker that is as wrong as it is known to be is as expected, and
/// one that turns out worse, or better, is told.
#[test]
fn a_worker_that_is_not_as_known_is_told() {
    let all: Vec<String> = Measure::all()
        .map(|it| format!("{:?}", it.name()))
        .collect();
    let known = format!("red = [{}]\n", all.join(", "));
    let scratch_known = scratch(FLIGHT, &known);
    let (code, text, said) = carom(scratch_known.path(), &HERE);
    assert_eq!(code, 0, "{text}{said}");
    assert!(text.contains("e 0.5 at 4 m/s     RED -1.000\n"), "{text}");
    assert!(
        !text.contains("(!)") && !text.contains("SURPRISE"),
        "{text}"
    );
    let page = fs::read_to_string(scratch_known.path().join("runs/drift/README.md")).unwrap();
    assert!(page.contains("| e 0.5 at 4 m/s | RED -1.000 |"), "{page}");
    // A blank line would end the table: heading, rule and fourteen rows stand together.
    let lines: Vec<&str> = page.lines().collect();
    let table = lines.split(|line| !line.starts_with('|'));
    let heights: Vec<usize> = table.map(<[_]>::len).filter(|rows| *rows > 0).collect();
    assert_eq!(heights, [16], "{page}");
    let table = fs::read_to_string(scratch_known.path().join("runs/drift/drift.csv")).unwrap();
    let row = "0.0.1,e 0.5 at 4 m/s,red,red,restitution,1.5,";
    assert!(table.contains(row), "{table}");

    let others = format!("red = [{}]\n", all[1..].join(", "));
    fs::write(
        scratch_known.path().join("drift/workers.toml"),
        format!("[[worker]]\nversion = \"0.0.1\"\nwhy = \"made up\"\n{others}"),
    )
    .unwrap();
    let (code, text, _) = carom(scratch_known.path(), &HERE);
    assert_eq!(code, 1, "{text}");
    assert_eq!(text.matches("(!)").count(), 1, "{text}");
    let told = "SURPRISE: rapier3d 0.0.1 on e 0 at 0.5 m/s is red, and known to be within: -1.000 where 0 is due";
    assert!(text.contains(told), "{text}");
}

/// A worker that breaks off is red on everything, with its last words, and ends nothing else.
#[test]
fn a_worker_that_fails_is_red() {
    let failing = scratch(
        "fn main() { eprintln!(\"no such effect\"); std::process::exit(2) }",
        "",
    );
    let (code, text, _) = carom(failing.path(), &HERE);
    assert_eq!(code, 1, "{text}");
    assert_eq!(
        text.matches("SURPRISE").count(),
        Measure::all().count(),
        "{text}"
    );
    assert!(
        text.contains("shot-2-61          RED no recording (!)\n"),
        "{text}"
    );
    assert!(
        text.contains("failed with exit code 2; standard error ends: no such effect"),
        "{text}"
    );
}

/// What keeps the sentinel from running is one line and exit code 2.
#[test]
fn what_keeps_it_from_running_is_told_in_a_line() {
    let broken = scratch("fn main() { no_such_function() }", "");
    let list = broken.path().join("drift/workers.toml");
    let table = [
        (&HERE[..], "worker of rapier3d 0.0.1: cannot be built: "),
        (
            &["drift", "--workers", "nowhere"],
            "give the folder `drift` of a checkout",
        ),
        (
            &["drift", "--workers", "drift", "--versions", "1.0.0"],
            "--versions 1.0.0: there are 0.0.1",
        ),
    ];
    for (arguments, due) in table {
        let (code, text, said) = carom(broken.path(), arguments);
        assert_eq!((code, text.as_str()), (2, ""), "{said}");
        assert!(said.contains(due) && said.lines().count() == 1, "{said}");
    }
    fs::write(list, b"\xff").unwrap();
    let (code, _, said) = carom(broken.path(), &HERE);
    assert!(
        code == 2 && said.contains("workers.toml: not UTF-8 from byte 0"),
        "{said}"
    );
}

/// Builds every worker, which needs the network once and minutes:
/// `cargo test --features drift --test it -- --ignored seven_versions`.
#[test]
#[ignore = "compiles seven versions of Rapier"]
fn seven_versions_give_what_is_known_of_them() {
    let scratch = tempfile::tempdir().unwrap();
    let (code, text, said) = carom(scratch.path(), &["drift", "--json"]);
    assert_eq!(code, 0, "{said}{text}");
    let study: Value = serde_json::from_str(&text).unwrap();
    let measures = |version: &str| {
        let versions = study["versions"].as_array().unwrap();
        let of = versions.iter().find(|of| of["version"] == version).unwrap();
        of["measures"].as_array().unwrap().clone()
    };
    let count = |version: &str, verdict: &str| {
        let measures = measures(version);
        measures
            .iter()
            .filter(|it| it["verdict"] == verdict)
            .count()
    };
    assert_eq!(count("0.35.0-beta.0", "red"), 11);
    // Slow balls do not bounce at all in the beta, whatever their restitution.
    for measure in measures("0.35.0-beta.0") {
        let name = measure["measure"].as_str().unwrap();
        if name.ends_with("at 0.5 m/s") {
            let found = measure["found"]["restitution"]["effective"]
                .as_array()
                .unwrap();
            let most = found.iter().map(|e| e.as_f64().unwrap().abs());
            assert!(most.fold(0.0, f64::max) < 1e-5, "{measure}");
        }
    }
    let own = versions()["rapier3d"];
    assert_eq!(count(own, "within"), Measure::all().count());
    let cases = measures(own)
        .into_iter()
        .filter(|it| it["found"]["case"].is_object());
    let same = cases.map(|it| it["found"]["case"]["same_bits"] == true);
    assert_eq!(same.collect::<Vec<_>>(), [true; 4]);
}
