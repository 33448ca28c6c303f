//! The exact engine where flights have closed forms: truth, rules, both paths, honest digits.

use carom::case::{Case, Library};

use carom::engine::drive;
use carom::engine::exact::TieOrder;
use carom::engine::exact::flight::{FlightSimulation, certified};
use carom::engine::exact::forces::{Accuracy, ForcesSimulation};
use carom::engine::exact::{Certified, Real, Wide};
use carom::physics::Vector3;
use carom::recording::{CollapseReason, EventKind, Outcome, Recording};
use carom::scene::{Contact, Cushions, Effects, Gravity, Rest, Scene};

use crate::scenes::{body, scene};

/// Largest errors, in the units in which the issue states its bounds.
#[derive(Debug, Default)]
struct Errors {
    /// Of the diagonal of the box of all positions.
    position: f64,
    /// Of the largest speed.
    velocity: f64,
    /// Of the duration.
    time: f64,
    /// Of the impulse itself.
    impulse: f64,
}

/// As much work as the published settings allow.
const OPERATIONS: u64 = 10_000_000_000;

fn record<R: Real>(scene: &Scene, mut simulation: FlightSimulation<R>) -> Recording {
    drive(scene, "exact", &mut simulation)
}

fn run<R: Real>(scene: &Scene) -> Recording {
    record::<R>(scene, FlightSimulation::new(scene, TieOrder::Rule).unwrap())
}

fn searched<R: Real>(scene: &Scene) -> Recording {
    record::<R>(
        scene,
        FlightSimulation::searching(scene, TieOrder::Rule).unwrap(),
    )
}

/// The diagonal of the box of all positions, and the largest speed.
fn scales(recording: &Recording) -> (f64, f64) {
    let (mut low, mut high, mut speed) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], 0.0_f64);
    for state in recording.samples().flatten() {
        for axis in 0..3 {
            low[axis] = low[axis].min(state.position[axis]);
            high[axis] = high[axis].max(state.position[axis]);
        }
        speed = speed.max(state.velocity.norm());
    }
    let diagonal = (0..3)
        .map(|axis| (high[axis] - low[axis]).powi(2))
        .sum::<f64>();
    (diagonal.sqrt(), speed)
}

/// Asserts that both have the same events in the same order; gives how far they are apart.
fn errors(scene: &Scene, recording: &Recording, truth: &Recording) -> Errors {
    let name = &scene.name;
    assert_eq!(recording.outcome, Outcome::Finished, "{name}");
    let kinds = |r: &Recording| r.events.events().iter().map(|e| e.kind).collect::<Vec<_>>();
    assert_eq!(kinds(recording), kinds(truth), "{name}");
    assert_eq!(recording.sample_count(), truth.sample_count(), "{name}");
    let (diagonal, speed) = scales(truth);
    let mut errors = Errors::default();
    let pairs = recording.samples().flatten().zip(truth.samples().flatten());
    for (mine, theirs) in pairs {
        let off = (mine.position - theirs.position).norm() / diagonal;
        errors.position = errors.position.max(off);
        let off = (mine.velocity - theirs.velocity).norm() / speed;
        errors.velocity = errors.velocity.max(off);
    }
    for (mine, theirs) in recording.events.events().iter().zip(truth.events.events()) {
        errors.time = errors
            .time
            .max((mine.time - theirs.time).abs() / scene.duration);
        let off = (mine.impulse - theirs.impulse).abs();
        errors.impulse = errors.impulse.max(off / theirs.impulse);
    }
    errors
}

fn is_free(scene: &Scene) -> bool {
    scene.effects.attraction.is_none() && scene.effects.springs.is_empty()
}

/// Every case with truth that has neither attraction nor springs.
fn cases() -> Vec<Case> {
    let own = Library::Folder(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/exact").into());
    let mut cases = Vec::new();
    for library in [Library::Embedded, own] {
        for name in library.names().unwrap() {
            let case = library.case(&name).unwrap();
            if is_free(&case.scene) && case.truth.is_some() {
                cases.push(case);
            }
        }
    }
    assert!(cases.len() >= 32, "{} cases", cases.len());
    cases
}

fn assert_below(name: &str, errors: &Errors, bound: f64) {
    println!("{name:20} {errors:?}");
    let Errors {
        position,
        velocity,
        time,
        impulse,
    } = errors;
    let largest = position.max(*velocity).max(*time).max(*impulse);
    assert!(largest < bound, "{name}: {errors:?}");
}

/// What is published: rounding of the last digit, 1.1e-16 of a number, and no more. The issue
/// asks for 1e-11.
#[test]
fn wide_runs_reach_truth_to_the_last_digit() {
    for case in cases() {
        let truth = case.truth.as_ref().unwrap();
        let errors = errors(&case.scene, &run::<Wide>(&case.scene), truth);
        assert_below(&case.scene.name, &errors, 2.3e-16);
    }
}

/// Doubles alone: rounding, amplified by every impact. Half an ulp in an input moves the worst
/// of these cases, shot-1-13, by 1e-8. Longer ones, of 98 and 160 events, forget the last digits
/// of a double altogether and are for the wide run.
#[test]
fn fast_runs_reach_truth_within_amplified_rounding() {
    for case in cases() {
        let truth = case.truth.as_ref().unwrap();
        if truth.events.events().len() < 60 {
            let errors = errors(&case.scene, &run::<f64>(&case.scene), truth);
            assert_below(&case.scene.name, &errors, 1e-6);
        }
    }
}

/// Two ways to the same events: closed forms, and the search that knows none of them.
#[test]
fn closed_forms_and_search_agree() {
    for case in cases() {
        let closed = run::<Wide>(&case.scene);
        let errors = errors(&case.scene, &searched::<Wide>(&case.scene), &closed);
        assert_below(&case.scene.name, &errors, 2.3e-16);
    }
}

/// And a third, which shares no line with them but the arithmetic: series of high order, events
/// as roots of polynomials. Its steps are cut off at 1e-24, which the impacts of these cases
/// amplify by up to 1e9; in the long ones, of 98 and 160 events, it grows to 1e-10 and more.
#[test]
fn closed_forms_and_the_integrator_agree() {
    let mut compared = 0;
    for case in cases() {
        let scene = &case.scene;
        if scene.effects.rest.is_some() {
            continue;
        }
        let closed = run::<Wide>(scene);
        if closed.events.events().len() >= 60 {
            continue;
        }
        let mut integrator = ForcesSimulation::<Wide>::new(scene, Accuracy::WIDE).unwrap();
        let integrated = drive(scene, "integrated", &mut integrator);
        let errors = errors(scene, &integrated, &closed);
        assert_below(&scene.name, &errors, 1e-15);
        compared += 1;
    }
    assert!(compared >= 15, "{compared}");
}

/// A light ball between the -x wall and a heavy ball that comes in. Source: Galperin 2003,
/// "Playing pool with pi": masses 1 and 100^k make floor(pi 10^k) impacts.
fn pi_billiard(digits: i32) -> Scene {
    let heavy = 100.0_f64.powi(digits);
    let bodies = vec![
        body("light", 1.0, 0.1, [-31.5, 0.0, 0.0], [0.0; 3]),
        body("heavy", heavy, 0.1, [-30.5, 0.0, 0.0], [-1.0, 0.0, 0.0]),
    ];
    let effects = Effects {
        contact: Some(Contact { restitution: 1.0 }),
        cushions: Some(Cushions {
            half_width: 32.0,
            half_length: 1.0,
            half_height: None,
            restitution: 1.0,
        }),
        ..Effects::default()
    };
    // Over long before the heavy ball, which leaves at speed 1, is at the +x wall.
    scene(48.0, 1.0, bodies, effects)
}

#[test]
fn impacts_between_wall_light_and_heavy_ball_count_the_digits_of_pi() {
    for (digits, expected) in [
        (0, 3),
        (1, 31),
        (2, 314),
        (3, 3141),
        (4, 31415),
        (5, 314_159),
    ] {
        let scene = pi_billiard(digits);
        let count = |recording: &Recording| {
            assert_eq!(recording.outcome, Outcome::Finished);
            let counts = recording.events.counts();
            counts.contacts + counts.cushions
        };
        assert_eq!(
            count(&run::<f64>(&scene)),
            expected,
            "doubles, 100^{digits}"
        );
        assert_eq!(count(&run::<Wide>(&scene)), expected, "wide, 100^{digits}");
    }
}

/// With e = 0.5 each flight is half as long: the impacts end in finite time, at
/// t = v/g (1 + 2e/(1 - e)) after a throw from the floor, and the engine says so.
#[test]
fn a_ball_that_bounces_to_rest_ends_the_run_with_its_time() {
    let bodies = vec![body("ball", 1.0, 0.1, [0.0, -0.9, 0.0], [0.3, 4.0, 0.0])];
    let effects = Effects {
        cushions: Some(Cushions {
            half_width: 9.0,
            half_length: 9.0,
            half_height: Some(1.0),
            restitution: 0.5,
        }),
        gravity: Some(Gravity {
            acceleration: [0.0, -10.0, 0.0],
        }),
        ..Effects::default()
    };
    let scene = scene(4.0, 0.125, bodies, effects);
    let expected = 2.0 * 4.0 / 10.0 * 2.0;
    for recording in [
        run::<f64>(&scene),
        run::<Wide>(&scene),
        searched::<f64>(&scene),
    ] {
        let Outcome::Collapsed {
            time,
            a: 0,
            b: None,
            reason: CollapseReason::EndlessImpacts,
        } = recording.outcome
        else {
            panic!("{:?}", recording.outcome);
        };
        assert!((time - expected).abs() < 1e-8, "{time}");
        assert_eq!(recording.sample_count(), 1 + 12, "up to t = 1.5");
    }
}

fn refusal(scene: &Scene) -> String {
    match FlightSimulation::<f64>::new(scene, TieOrder::Rule) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("accepted"),
    }
}

#[test]
fn what_has_no_exact_meaning_is_refused_by_name() {
    let pair = |gap: f64| {
        vec![
            body("a", 1.0, 0.5, [0.0; 3], [0.0; 3]),
            body("b", 1.0, 0.5, [1.0 + gap, 0.0, 0.0], [0.0; 3]),
        ]
    };
    let effects = Effects {
        contact: Some(Contact { restitution: 1.0 }),
        ..Effects::default()
    };
    let told = refusal(&scene(1.0, 0.5, pair(-0.25), effects.clone()));
    assert!(
        told.contains("`a` and `b` overlap at the start by 2.500e-1"),
        "{told}"
    );
    let touching = scene(1.0, 0.5, pair(-1e-16), effects.clone());
    assert!(FlightSimulation::<f64>::new(&touching, TieOrder::Rule).is_ok());

    let mut outside = scene(1.0, 0.5, pair(0.5), effects.clone());
    outside.effects.cushions = Some(Cushions {
        half_width: 1.25,
        half_length: 1.0,
        half_height: None,
        restitution: 1.0,
    });
    let told = refusal(&outside);
    assert!(
        told.contains("`b` starts beyond the wall +x by 7.5"),
        "{told}"
    );

    let mut falling = scene(1.0, 0.5, pair(0.5), effects);
    falling.effects.gravity = Some(Gravity {
        acceleration: [0.0, -1.0, 0.0],
    });
    falling.effects.rest = Some(Rest { speed: 0.1 });
    let told = refusal(&falling);
    assert!(told.contains("rest together with gravity"), "{told}");
}

/// After the impact both are slower than the rest speed. The struck ball stops at once; what
/// is left of the striker's approach is lost, and its motion across stays.
#[test]
fn a_partner_of_a_stopped_ball_loses_its_approach_and_nothing_else() {
    let across = 3.0;
    let bodies = vec![
        body(
            "striker",
            1.0,
            0.5,
            [-2.0, 0.0, -across],
            [1.0, 0.0, across],
        ),
        body("target", 1.0, 0.5, [0.0; 3], [0.0; 3]),
    ];
    let effects = Effects {
        contact: Some(Contact { restitution: 0.5 }),
        rest: Some(Rest { speed: 0.875 }),
        ..Effects::default()
    };
    let mut scene = scene(2.0, 0.5, bodies, effects);
    // Head-on along x at the moment of impact, t = 1.
    scene.bodies[0].position[2] = -across;
    let recording = run::<Wide>(&scene);
    let kinds: Vec<_> = recording.events.events().iter().map(|e| e.kind).collect();
    let struck = [
        EventKind::Contact { a: 0, b: 1 },
        EventKind::Rest { body: 1 },
    ];
    assert_eq!(kinds, struck);
    let last = recording.sample(4);
    assert_eq!(last[0].velocity, Vector3::from([0.0, 0.0, across]));
    assert_eq!(last[0].position, Vector3::from([-1.0, 0.0, across]));
    assert_eq!(last[1].position, Vector3::from([0.0; 3]));
}

/// Asserts that no sample is farther from `other` than it claims; gives the least claim.
fn assert_honest(name: &str, claimed: &Certified, other: &Recording) -> (u8, u8) {
    let (diagonal, speed) = scales(&claimed.recording);
    let samples = claimed.recording.samples().zip(other.samples());
    let mut least = (15, 15);
    for (sample, ((mine, theirs), digits)) in samples.zip(&claimed.digits).enumerate() {
        for (mine, theirs) in mine.iter().zip(theirs) {
            let position = (mine.position - theirs.position).norm() / diagonal;
            let velocity = (mine.velocity - theirs.velocity).norm() / speed;
            // No digit is no claim: two velocities may differ by twice the largest speed.
            let bound = |digits: u8| match digits {
                0 => f64::INFINITY,
                digits => 10.0_f64.powi(-i32::from(digits)),
            };
            let bounds = [digits.position, digits.velocity].map(bound);
            assert!(
                position <= bounds[0],
                "{name}, sample {sample}: {position:e} {digits:?}"
            );
            assert!(
                velocity <= bounds[1],
                "{name}, sample {sample}: {velocity:e} {digits:?}"
            );
        }
        least = (least.0.min(digits.position), least.1.min(digits.velocity));
    }
    least
}

#[test]
fn claimed_digits_hold_against_truth_and_are_worth_having() {
    for case in cases() {
        let claimed = certified(&case.scene, OPERATIONS).unwrap();
        let least = assert_honest(&case.scene.name, &claimed, case.truth.as_ref().unwrap());
        println!(
            "{:20} {least:?} {:?}",
            case.scene.name, claimed.undetermined
        );
        assert!(
            least.0 >= 10 && least.1 >= 10,
            "{}: {least:?}",
            case.scene.name
        );
    }
}

/// A gas loses a digit with every impact or so of a sphere. A run by another path has other
/// roundings, and must stay within the claims all the way down to no digit at all.
#[test]
fn claimed_digits_hold_in_a_gas_until_none_is_left() {
    for seed in 1..=2 {
        let recipe = carom::scene::generate::Gas {
            cells: 2,
            filling: 0.4,
            seed,
        };
        let mut scene = recipe.scene().unwrap();
        (scene.duration, scene.sample_every) = (16.0, 0.0625);
        let claimed = certified(&scene, OPERATIONS).unwrap();
        let other = searched::<Wide>(&scene);
        assert_honest("gas", &claimed, &other);
        let digits: Vec<_> = claimed
            .digits
            .iter()
            .map(|digits| digits.position)
            .collect();
        println!("{digits:?}");
        assert_eq!((digits[1], digits[256]), (15, 0));
        let horizon = digits.iter().position(|digits| *digits < 6).unwrap();
        // Not too modest either: in the end the paths do part, and soon after the claim does.
        let (diagonal, _) = scales(&claimed.recording);
        let parted = (0..=256).find(|sample| {
            let pairs = claimed
                .recording
                .sample(*sample)
                .iter()
                .zip(other.sample(*sample));
            let apart = pairs.map(|(a, b)| (a.position - b.position).norm());
            apart.fold(0.0, f64::max) > 1e-6 * diagonal
        });
        println!("horizon {horizon}, parted {parted:?}");
        assert!(
            parted.is_some_and(|parted| parted <= 2 * horizon),
            "{parted:?} {horizon}"
        );
    }
}

/// The cue ball hits two touching balls at once, mirror-symmetrically: whichever impact is
/// taken first sends the other ball away slower.
#[test]
fn a_symmetrical_break_is_undetermined_and_a_corner_is_not() {
    let half = 3.0_f64.sqrt() / 2.0;
    let bodies = vec![
        body("cue", 1.0, 0.5, [-3.0, 0.0, 0.0], [2.0, 0.0, 0.0]),
        body("left", 1.0, 0.5, [half, 0.0, -0.5], [0.0; 3]),
        body("right", 1.0, 0.5, [half, 0.0, 0.5], [0.0; 3]),
    ];
    let effects = Effects {
        contact: Some(Contact { restitution: 1.0 }),
        ..Effects::default()
    };
    let scene = scene(4.0, 0.5, bodies, effects);
    let found = certified(&scene, OPERATIONS)
        .unwrap()
        .undetermined
        .expect("undetermined");
    assert!((found.time - 1.5).abs() < 1e-9, "{found:?}");
    assert_eq!(found.bodies, [0]);
    assert!(found.spread > Some(0.5), "{found:?}");

    let corner = Library::Embedded.case("corner-double").unwrap().scene;
    assert_eq!(certified(&corner, OPERATIONS).unwrap().undetermined, None);
}
