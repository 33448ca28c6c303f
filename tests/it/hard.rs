//! The hard cases: readable, right by the exact engine as far as that goes, and hard enough.

use std::collections::BTreeSet;

use carom::case::{Expected, Library, scene_or_case};
use carom::compare::{Sizes, metrics};
use carom::engine::{EngineKind, EngineSpec, engine, record};
use carom::error::Error;
use carom::physics::Vector3;
use carom::scene::{self, Scene};
use carom::study::{Breach, breaches};

use crate::scenes::lecture;
use crate::slips::assert_named;

const LIBRARY: Library = Library::EmbeddedHard;

fn case(name: &str) -> (Scene, Expected) {
    let case = LIBRARY.case(name).unwrap();
    (case.scene, case.expected.unwrap())
}

/// What the lecture's solver breaks of a case at a step.
fn broken_by_the_lecture(name: &str, dt: f64) -> Vec<Breach> {
    let (scene, expected) = case(name);
    let recording = lecture(&scene, dt);
    breaches(&scene, &expected, &recording, &metrics(&scene, &recording))
}

#[test]
fn every_hard_case_says_what_to_look_for_and_what_must_hold() {
    let names = LIBRARY.names().unwrap();
    assert!(names.len() >= 24, "{} cases", names.len());
    for name in &names {
        let case = LIBRARY.case(name).unwrap();
        let scene = &case.scene;
        assert!(scene.title.is_some(), "{name} has no title");
        assert!(scene.source.is_some(), "{name} does not say who made it");
        assert!(
            scene.watch.is_some(),
            "{name} does not say what to look for"
        );
        let expected = case
            .expected
            .unwrap_or_else(|| panic!("{name} expects nothing"));
        assert!(
            expected.energy.is_some(),
            "{name} says nothing of the energy"
        );
        let text = scene::to_toml(scene).unwrap();
        assert_eq!(scene::parse(&text, "again").unwrap(), *scene, "{name}");
    }
}

#[test]
fn names_resolve_among_the_hard_cases_too_and_theirs_do_not_hide_others() {
    let hard: BTreeSet<_> = LIBRARY.names().unwrap().into_iter().collect();
    let reference: BTreeSet<_> = Library::Embedded.names().unwrap().into_iter().collect();
    assert_eq!(hard.intersection(&reference).count(), 0);
    let found = scene_or_case("pi-2", &Library::Embedded).unwrap();
    assert!(found.expected.is_some());
    let hint = |name: &str| match scene_or_case(name, &Library::Embedded) {
        Err(Error::UnknownCase { hint, .. }) => hint,
        other => panic!("{name}: {other:?}"),
    };
    assert!(hint("wedg").contains("wedge"), "{}", hint("wedg"));
    assert!(
        hint("shot-0-7").contains("shot-0-75"),
        "{}",
        hint("shot-0-7")
    );
}

/// Scenes without an exact meaning: spheres overlap at the start.
const REFUSED: [&str; 3] = ["coincident-centres", "coincident-nearly", "overlap-1000"];

/// Scenes that the exact engine leaves before their end.
const LEFT: [&str; 0] = [];

/// Scenes whose end the exact engine does not certify: it answers, but claims nothing there.
///
/// - A row of impacts that must stay on one line doubles every error across it: pi-2 and on.
/// - An order of simultaneous impacts decides: two-at-once, wedge, the pile of twelve, the rack,
///   whose ulps do, and the cluster without bounce, whose impacts come one after the other at one
///   instant too.
const UNCLAIMED: [&str; 9] = [
    "collapse-cluster",
    "pi-2",
    "pi-3",
    "pi-4",
    "pi-5",
    "pile-on-floor",
    "rack-touching",
    "two-at-once",
    "wedge",
];

/// Work that the exact engine may take here: enough for every case that it carries through.
const OPERATIONS: u64 = 3_000_000_000;

fn bounded_exact() -> EngineSpec {
    let mut exact = engine("exact").unwrap();
    let EngineKind::Exact(settings) = &mut exact.kind else {
        panic!("exact is another kind of engine");
    };
    settings.operations = OPERATIONS;
    exact
}

/// Closed forms are written as the nearest doubles, and so are the exact engine's answers: an ulp
/// of the largest coordinate in all; the certified digits may be as few as nine on top.
fn rounding(scene: &Scene, size: f64) -> f64 {
    let coordinates = scene.bodies.iter().flat_map(|body| body.position);
    let largest = coordinates.fold(size, |most, x| most.max(x.abs()));
    1e-9 * size + 4.0 * f64::EPSILON * largest
}

/// The exact engine breaks nothing as long as it certifies its positions, and its end is that of
/// the closed form.
#[test]
fn what_must_hold_holds_for_the_exact_engine() {
    let exact = bounded_exact();
    let (mut refused, mut left, mut unclaimed) = (Vec::new(), Vec::new(), Vec::new());
    for name in LIBRARY.names().unwrap() {
        let (scene, expected) = case(&name);
        let recording = match record(&scene, &exact, 0.01) {
            Ok(recording) => recording,
            Err(Error::EngineCannot { .. }) => {
                refused.push(name);
                continue;
            }
            Err(error) => panic!("{name}: {error}"),
        };
        let comparable = recording.comparable_samples(&scene);
        let claims = |time: f64| time < scene.sample_time(comparable) - 1e-9;
        let metrics = metrics(&scene, &recording);
        for breach in breaches(&scene, &expected, &recording, &metrics) {
            let is_claimed = match breach {
                Breach::Ended { .. } => false,
                Breach::EnergyGrew(excess)
                | Breach::EnergyLost(excess)
                | Breach::MomentumOff(excess)
                | Breach::Penetrated(excess)
                | Breach::TooFast(excess)
                | Breach::MirrorBroken(excess)
                | Breach::EndsElsewhere(excess)
                | Breach::EndsOtherwise(excess) => claims(excess.time),
                Breach::ContactsOff { .. }
                | Breach::ContactsMissed { .. }
                | Breach::CushionsOff { .. } => recording.outcome.is_finished(),
            };
            assert!(!is_claimed, "{name}: {breach}");
        }
        if !recording.outcome.is_finished() {
            left.push(name);
            continue;
        }
        if comparable < recording.sample_count() {
            unclaimed.push(name);
            continue;
        }
        let Some(end) = &expected.end else { continue };
        let size = Sizes::of(&recording, &metrics).length;
        let states = recording.sample(recording.sample_count() - 1);
        for due in &end.bodies {
            let state = &states[scene.body_index(&due.name).unwrap()];
            let apart = (state.position - Vector3::from(due.position)).norm();
            assert!(
                apart <= rounding(&scene, size),
                "{name}, {}: {apart:e}",
                due.name
            );
        }
    }
    assert_eq!(refused, REFUSED);
    assert_eq!(left, LEFT, "left before the end");
    assert_eq!(unclaimed, UNCLAIMED);
}

/// Galperin 2003: ceil(pi/atan(sqrt(m/M))) - 1 impacts, the digits of pi for M/m = 100^k.
#[test]
fn impacts_count_out_the_digits_of_pi() {
    let fast = engine("exact-fast").unwrap();
    for (k, digits) in [3, 31, 314, 3141, 31415, 314_159].into_iter().enumerate() {
        let (scene, expected) = case(&format!("pi-{k}"));
        let angle = (scene.bodies[1].mass / scene.bodies[0].mass).sqrt().atan();
        assert_eq!(
            (std::f64::consts::PI / angle).ceil() - 1.0,
            f64::from(digits)
        );
        let due = expected.impacts.unwrap();
        let due = due.contacts.unwrap() + due.cushions.unwrap();
        assert_eq!(
            due,
            u64::try_from(digits).unwrap(),
            "pi-{k} expects another count"
        );
        let counts = record(&scene, &fast, 0.01).unwrap().events.counts();
        assert_eq!(counts.contacts + counts.cushions, due, "pi-{k}");
    }
}

/// A stiff spring that swings far used to be followed to the end of its scene in one step, where
/// rounding had left the last two coefficients of a series at zero; and a spring of no length
/// had no direction in the middle of its swing.
#[test]
fn springs_swing_to_their_closed_form_in_doubles() {
    let fast = engine("exact-fast").unwrap();
    for name in [
        "spring-tame",
        "spring-100-times",
        "spring-1e4-times",
        "spring-zero-length",
    ] {
        let (scene, expected) = case(name);
        let recording = record(&scene, &fast, 0.01).unwrap();
        assert!(recording.outcome.is_finished(), "{name}");
        // A step of about two radians rounds the state by an ulp, which the phase keeps: at
        // worst all add up, over 2e4 radians 1e4 ulps of a phase.
        let end = expected.end.unwrap();
        for (due, state) in end
            .bodies
            .iter()
            .zip(recording.sample(recording.sample_count() - 1))
        {
            let apart = (state.position - Vector3::from(due.position)).norm();
            assert!(
                apart < 1e4 * f64::EPSILON,
                "{name}, {}: {apart:e}",
                due.name
            );
        }
    }
}

/// Every kind of breach is found where the lecture's solver is known to break something.
#[test]
fn the_lecture_breaks_each_bound_somewhere() {
    let kinds = |name: &str, dt: f64| {
        let broken = broken_by_the_lecture(name, dt);
        let kind = |breach: &Breach| serde_json::to_value(breach).unwrap()["kind"].to_string();
        broken.iter().map(kind).collect::<BTreeSet<_>>()
    };
    for (name, dt, kind) in [
        ("spring-100-times", 0.01, "ended"),
        ("spring-100-times", 0.01, "energy-grew"),
        ("fall-softened", 0.01, "energy-lost"),
        ("damper-100-times", 0.01, "momentum-off"),
        ("corner-both-walls", 0.1, "penetrated"),
        ("pile-on-floor", 0.01, "too-fast"),
        ("two-at-once", 0.01, "mirror-broken"),
        ("tunnel-1e4", 0.01, "contacts-off"),
        ("rack-touching", 0.1, "contacts-missed"),
        ("tunnel-box", 0.01, "cushions-off"),
        ("tunnel-1e4", 0.01, "ends-elsewhere"),
        ("tunnel-1e4", 0.01, "ends-otherwise"),
    ] {
        let found = kinds(name, dt);
        assert!(
            found.contains(&format!("\"{kind}\"")),
            "{name}: {kind} is not in {found:?}"
        );
    }
}

/// Where the steps are small enough the lecture's solver holds, so the bounds are not out of reach.
#[test]
fn the_lecture_holds_where_its_steps_are_small_enough() {
    for (name, dt) in [
        ("ball-ball-cushion", 0.001),
        ("cradle-0", 0.01),
        ("cradle-1mm", 0.01),
        ("damper-tame", 0.01),
        ("e-zero", 0.01),
        ("far-1e7", 0.001),
        ("mass-ratio-1e9", 0.01),
        ("million-steps", 1e-5),
        ("radius-1e-6", 0.001),
        ("spring-tame", 0.001),
        ("stack-of-five", 0.001),
        ("tunnel-1e2", 0.001),
    ] {
        let broken = broken_by_the_lecture(name, dt);
        assert_eq!(broken, [], "{name} at {dt}");
    }
}

const EXPECTED: &str = "dt = [0.1, 0.01]
[energy]
gain_max = 0.0
why = \"w\"
[momentum]
change_max = 0.0
why = \"w\"
[penetration]
depth_max = 0.1
after = 0.5
why = \"w\"
[impacts]
contacts = 1
why = \"w\"
[mirror]
axis = \"z\"
within = 0.0
why = \"w\"
[end]
within = 0.1
within_velocity = 0.1
why = \"w\"
[[end.bodies]]
name = \"target\"
position = [0, 0, 0]
velocity = [0, 0, 0]
";

/// What is wrong in an expectation is said with file, line and remedy, as in a scene.
#[test]
fn faults_of_an_expectation_are_named_with_their_place() {
    let (scene, _) = case("tunnel-1e2");
    let parse = |text: &str| Expected::parse(text, "e.toml", &scene);
    let good = parse(EXPECTED).unwrap();
    assert_eq!(good.dt, [0.1, 0.01]);
    assert_eq!(
        parse("").unwrap().dt,
        [0.1, 0.01, 0.001],
        "the default ladder"
    );
    let slips = [
        ("dt = [0.1, 0.01]", "dt = []", 1, "give one step"),
        (
            "dt = [0.1, 0.01]",
            "dt = [0.1, 0.1]",
            1,
            "largest to the smallest",
        ),
        ("dt = [0.1, 0.01]", "dt = [-0.1]", 1, "above 0"),
        ("gain_max = 0.0", "gain_max = -1", 3, "0 or a number above"),
        ("gain_max = 0.0", "", 2, "missing field `gain_max`"),
        ("gain_max = 0.0", "gain = 0.0", 3, "unknown field `gain`"),
        (
            "why = \"w\"",
            "why = \" \"",
            4,
            "where the bound comes from",
        ),
        (
            "change_max = 0.0",
            "change_max = 0\nscale = 0",
            7,
            "above 0",
        ),
        ("after = 0.5", "after = 2", 10, "the scene ends at 1 s"),
        ("contacts = 1", "", 12, "give contacts"),
        ("contacts = 1", "cushions = 1", 13, "no such effect"),
        ("contacts = 1", "contacts = 1.5", 13, "invalid type"),
        ("axis = \"z\"", "axis = \"x\"", 15, "`bullet` has no image"),
        ("axis = \"z\"", "axis = \"w\"", 16, "unknown variant"),
        ("within_velocity = 0.1\n", "", 25, "end.within_velocity"),
        (
            "name = \"target\"",
            "name = \"ghost\"",
            24,
            "no body has that name",
        ),
        ("position = [0, 0, 0]", "position = [0, 0]", 25, "3 are due"),
        (
            "velocity = [0, 0, 0]",
            "velocity = [0, 0, nan]",
            26,
            "finite",
        ),
    ];
    assert_named(EXPECTED, "e.toml", &slips, |text| {
        parse(text).unwrap_err().to_string()
    });
}

#[test]
fn a_scene_that_starts_at_rest_needs_a_scale() {
    let (scene, expected) = case("fall-softened");
    let mut without = expected.clone();
    without.momentum.as_mut().unwrap().scale = None;
    let fault = without.check(&scene).unwrap_err().to_string();
    assert!(fault.contains("momentum.scale"), "{fault}");
    assert!(expected.check(&scene).is_ok());
}

#[test]
fn the_command_line_knows_the_hard_cases() {
    let scratch = tempfile::tempdir().unwrap();
    let said = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("carom").unwrap();
        let output = command
            .current_dir(scratch.path())
            .args(arguments)
            .output()
            .unwrap();
        assert!(output.status.success(), "{arguments:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let listed = said(&["scenes", "list", "--hard"]);
    assert_eq!(listed.lines().count(), LIBRARY.names().unwrap().len());
    assert!(!said(&["scenes", "list"]).contains("pi-2"));
    assert!(said(&["scenes", "show", "pi-2"]).contains("name = \"pi-2\""));
    said(&["run", "pi-0", "--engine", "lecture,exact", "--out", "out"]);
    assert!(scratch.path().join("out/summary.json").is_file());
}
