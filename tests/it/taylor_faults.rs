//! Scenes that the half of `exact` with Taylor series once got wrong, against their truth.
//!
//! Each folder of `tests/faults` holds a scene, and where there is one right answer its samples
//! and impacts, computed in multiple precision by a method that shares nothing with carom.

use std::fs;
use std::path::PathBuf;

use carom::compare::Sizes;
use carom::engine::{DEFAULT_DT, engine, record};
use carom::recording::{Event, EventKind, Outcome, Recording, read_events, read_trajectory_start};
use carom::scene::Scene;

/// A scene with its truth.
struct Fault {
    scene: Scene,
    truth: Recording,
    events: Vec<Event>,
}

fn folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/faults/{name}"))
}

fn scene_of(name: &str) -> Scene {
    let text = fs::read_to_string(folder(name).join("scene.toml")).unwrap();
    carom::scene::parse(&text, name).unwrap()
}

fn fault(name: &str) -> Fault {
    let scene = scene_of(name);
    let file = |file: &str| fs::File::open(folder(name).join(file)).unwrap();
    let truth = read_trajectory_start("truth", &scene, file("truth.csv"), "truth.csv").unwrap();
    let events = read_events(&scene, file("events.csv"), "events.csv").unwrap();
    Fault {
        scene,
        truth,
        events: events.events().to_vec(),
    }
}

fn exact(scene: &Scene) -> Recording {
    record(scene, &engine("exact").unwrap(), DEFAULT_DT).unwrap()
}

/// The worst excess of an error over what is claimed: positions, velocities; at most 1 is honest.
fn excess(truth: &Recording, found: &Recording) -> (f64, f64) {
    let sizes = Sizes::of(found, &[]);
    let speeds = found.samples().flatten().map(|state| state.velocity.norm());
    let fastest = speeds.fold(0.0, f64::max);
    let digits = found.digits.as_ref().unwrap();
    let (mut of_position, mut of_velocity) = (0.0_f64, 0.0_f64);
    for ((own, right), digits) in found.samples().zip(truth.samples()).zip(digits) {
        for (own, right) in own.iter().zip(right) {
            let allowed = |digits: u8, size: f64| 10.0_f64.powi(-i32::from(digits)) * size;
            let position = (own.position - right.position).norm();
            let velocity = (own.velocity - right.velocity).norm();
            if digits.position > 0 && position > 0.0 {
                of_position = of_position.max(position / allowed(digits.position, sizes.length));
            }
            if digits.velocity > 0 && velocity > 0.0 {
                of_velocity = of_velocity.max(velocity / allowed(digits.velocity, fastest));
            }
        }
    }
    (of_position, of_velocity)
}

/// Impacts with all of one pair at one instant as one row, in the order of first rows.
fn summed(events: &[Event], near: f64) -> Vec<Event> {
    let mut rows: Vec<Event> = Vec::new();
    for event in events {
        let same = |row: &&mut Event| row.kind == event.kind && event.time - row.time <= near;
        match rows.iter_mut().rev().find(same) {
            Some(row) => row.impulse += event.impulse,
            None => rows.push(*event),
        }
    }
    rows
}

/// What is wrong with the impacts up to the last sample with digits to compare by.
fn wrong_events(case: &Fault, found: &Recording) -> Option<String> {
    let comparable = found
        .comparable_samples(&case.scene)
        .min(case.truth.sample_count());
    let until = case.scene.sample_time(comparable - 1);
    let near = 1e-12 * case.scene.duration;
    // What one sample shows is within the digits claimed; the impacts before it then are too.
    let before = |event: &&Event| event.time <= until - near;
    let strongest = case
        .events
        .iter()
        .fold(0.0_f64, |most, event| most.max(event.impulse));
    let strong = |event: &&Event| event.impulse > 1e-9 * strongest;
    let list = |events: &[Event]| -> Vec<Event> {
        let rows = summed(events, near);
        rows.iter().filter(before).filter(strong).copied().collect()
    };
    let (right, own) = (list(&case.events), list(found.events.events()));
    let kinds = |rows: &[Event]| -> Vec<EventKind> { rows.iter().map(|row| row.kind).collect() };
    if kinds(&right) != kinds(&own) {
        let first = right.iter().zip(&own).position(|(a, b)| a.kind != b.kind);
        return Some(format!(
            "{} impacts of {} up to {until} s, the first other one is number {first:?}",
            own.len(),
            right.len()
        ));
    }
    let known = 10.0
        * 10.0_f64.powi(-i32::from(
            found.fewest_digits(&case.scene).unwrap().position,
        ));
    let off = right.iter().zip(&own).find(|(right, own)| {
        (right.time - own.time).abs() > known * case.scene.duration
            || (right.impulse - own.impulse).abs() > known * strongest
    });
    off.map(|(right, own)| format!("{own:?} where {right:?} is right"))
}

/// What must hold of a case: its least digits where it ends, and whether it is undetermined.
struct Expected {
    name: &'static str,
    /// Digits of positions at the last sample of the truth that are the least to ask for.
    digits_at_last: u8,
}

const CASES: [Expected; 8] = [
    // A wall or a body held only by a higher derivative: the body went through it.
    Expected {
        name: "exact-through-wall",
        digits_at_last: 15,
    },
    Expected {
        name: "exact-through-ball",
        digits_at_last: 15,
    },
    // A step taken from rounding noise in the last term of its series.
    Expected {
        name: "exact-after-release",
        digits_at_last: 14,
    },
    // Errors grow 1e39-fold and 1e30-fold: what is claimed falls as they do.
    Expected {
        name: "lying-ball-elastic-box",
        digits_at_last: 0,
    },
    Expected {
        name: "billiards-beside-a-still-spring",
        digits_at_last: 0,
    },
    // A squared distance of which the squared radius is the 1e-24th part.
    Expected {
        name: "far-small-beside-a-spring",
        digits_at_last: 13,
    },
    Expected {
        name: "impact-on-a-sample",
        digits_at_last: 14,
    },
    // Hops far lower than the least bounce of the ball's own size.
    Expected {
        name: "low-elastic-bounce",
        digits_at_last: 14,
    },
];

#[test]
fn what_is_claimed_holds_on_every_scene_that_was_once_wrong() {
    let mut wrong = Vec::new();
    for Expected {
        name,
        digits_at_last,
    } in CASES
    {
        let case = fault(name);
        let found = exact(&case.scene);
        let mut say = |what: String| wrong.push(format!("{name}: {what}"));
        if found.outcome != Outcome::Finished {
            say(format!("{:?}", found.outcome));
        }
        let (position, velocity) = excess(&case.truth, &found);
        let digits = found.digits.as_ref().unwrap();
        let claimed: Vec<_> = digits.iter().map(|d| (d.position, d.velocity)).collect();
        println!("{name}: {position:.2e} {velocity:.2e} of what is claimed, {claimed:?}");
        if position > 1.0 || velocity > 1.0 {
            say(format!(
                "errors of positions {position:.2e} and of velocities {velocity:.2e} times what is claimed"
            ));
        }
        if let Some(what) = wrong_events(&case, &found) {
            say(what);
        }
        if let Some(from) = &found.undetermined {
            say(format!("{from:?}"));
        }
        let last = digits[case.truth.sample_count().min(digits.len()) - 1];
        if last.position < digits_at_last {
            say(format!("{last:?} at the end"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Bodies that start at one point, softened: their forces are finite everywhere. They used to end
/// as "bodies fell into one point", in which nothing falls.
#[test]
fn softened_bodies_go_through_one_point() {
    let scene = scene_of("softened-coincident");
    let found = exact(&scene);
    assert_eq!(found.outcome, Outcome::Finished);
    let digits = found.digits.as_ref().unwrap();
    assert!(digits.iter().all(|d| d.position >= 14 && d.velocity >= 14));
    // d'' = -11 d/(d² + 1)^(3/2) from d = 0, d' = 1: the energy d'²/2 - 11/(d² + 1)^(1/2) stays, and
    // the centre of mass moves on at 0.5 m/s.
    for (sample, states) in found.samples().enumerate() {
        let apart = states[1].position - states[0].position;
        let speed = states[1].velocity - states[0].velocity;
        let energy = 0.5 * speed.norm_squared() - 11.0 / (apart.norm_squared() + 1.0).sqrt();
        assert!((energy + 10.5).abs() < 1e-13, "{sample}: {energy}");
        let middle = 0.5 * (states[0].position.x + states[1].position.x);
        assert!(
            (middle - 0.5 * scene.sample_time(sample)).abs() < 1e-15,
            "{sample}: {middle}"
        );
    }
}

/// One body under strong drag beside an attraction that has nothing to attract: a closed form.
#[test]
fn strong_drag_beside_attraction_of_nothing_is_a_closed_form() {
    let scene = scene_of("stiff-drag-beside-attraction");
    let found = exact(&scene);
    assert_eq!(found.outcome, Outcome::Finished);
    for (sample, states) in found.samples().enumerate().skip(1) {
        let lost = (-1e6 * scene.sample_time(sample)).exp_m1();
        assert!(
            (states[0].position.x + lost * 1e-6).abs() < 1e-20,
            "{sample}"
        );
        assert!(
            (states[0].velocity.x - (1.0 + lost)).abs() < 1e-15,
            "{sample}"
        );
    }
}

/// The same drag on two bodies that do attract: stiff, but regular.
#[test]
fn strong_drag_on_bodies_that_attract_is_regular() {
    let mut scene = scene_of("stiff-drag-beside-attraction");
    let other = carom::scene::Body {
        name: "b1".into(),
        position: [0.0, 2.0, 0.0],
        velocity: [0.0; 3],
        ..scene.bodies[0].clone()
    };
    scene.bodies.push(other);
    scene.duration = 0.25;
    if let Some(drag) = &mut scene.effects.drag {
        drag.coefficient = 1e4;
    }
    let found = exact(&scene);
    assert_eq!(found.outcome, Outcome::Finished);
    let last = found.digits.as_ref().unwrap().last().unwrap();
    assert!(last.position >= 10, "{last:?}");
    // On the slow course force and drag balance: d' = -2/(1e4 d²), up to 1e-4 of it.
    let apart = found.sample(1)[1].position - found.sample(1)[0].position;
    let slow = (8.0_f64 - 6.0 * 0.25 / 1e4).cbrt();
    assert!((apart.norm() - slow).abs() < 1e-7, "{apart:?} {slow}");
}

/// Eight bodies at one point, softened, and one of 3e-247 kg: `exact` ended at once, and
/// `exact-fast` finished, off by half, without a word.
#[test]
fn what_exact_goes_through_exact_fast_does_too() {
    let scene = scene_of("fast-off-without-a-word");
    let found = exact(&scene);
    let fast = record(&scene, &engine("exact-fast").unwrap(), DEFAULT_DT).unwrap();
    assert_eq!([found.outcome, fast.outcome], [Outcome::Finished; 2]);
    let last = found.digits.as_ref().unwrap().last().unwrap();
    assert!(last.position >= 12, "{last:?}");
    let length = Sizes::of(&found, &[]).length;
    let both = found.samples().flatten().zip(fast.samples().flatten());
    let apart = both
        .map(|(a, b)| (a.position - b.position).norm())
        .fold(0.0, f64::max);
    assert!(apart < 1e-10 * length, "{apart:e} of {length}");
}

/// Where order decides at an exact tie, nothing is claimed that the other order does not share.
#[test]
fn a_symmetric_tie_is_claimed_up_to_it_and_not_beyond() {
    let case = fault("symmetric-tie");
    let found = exact(&case.scene);
    let (position, velocity) = excess(&case.truth, &found);
    assert!(
        position <= 1.0 && velocity <= 1.0,
        "{position:e} {velocity:e}"
    );
}
