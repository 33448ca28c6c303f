//! The safeguards of `robust` one by one: each scene fails without its own.

use carom::case::Library;
use carom::compare::metrics;
use carom::engine::{drive, engine, prepare};
use carom::physics::{BodyState, Vector3};
use carom::recording::{Account, Concession, ConcessionKind, EventLog, Recording};
use carom::scene::{Attraction, Body, Cushions, Drag, Effects, Rest, Spring};

use crate::robust::{contact, crowded, floor, gains, robust};
use crate::scenes::{body, scene};

fn conceded(recording: &Recording, kind: ConcessionKind) -> u64 {
    let own = recording.concessions.iter().filter(|it| it.kind == kind);
    own.map(|it| it.count).sum()
}

/// Two bodies high above the floor, with a spring that no run can pay.
fn unpayable(effects: Effects) -> (Vec<Body>, Effects) {
    let bodies = vec![
        body("a", 1.0, 0.1, [-0.6, 3.0, 0.0], [0.0; 3]),
        body("b", 1.0, 0.1, [0.6, 3.0, 0.0], [0.0; 3]),
    ];
    let spring = Spring {
        between: ["a".into(), "b".into()],
        stiffness: 1e16,
        rest_length: 1.0,
        damping: 0.0,
    };
    let effects = Effects {
        springs: vec![spring],
        ..effects
    };
    (bodies, effects)
}

/// A ball that rises a millimetre above the floor, beside a spring for which every step is turned
/// back: it does not move, so it never comes down and meets nothing.
#[test]
fn bodies_that_turned_back_meet_nothing_on_the_way_they_did_not_go() {
    let (mut bodies, effects) = unpayable(floor(5.0, 0.5));
    bodies.push(body("c", 1.0, 0.5, [0.0, -4.499, 0.0], [0.0, 0.1, 0.0]));
    let scene = scene(1.0, 0.125, bodies, effects);
    let recording = robust(&scene, 0.125);
    assert_eq!(conceded(&recording, ConcessionKind::TurnedBack), 8);
    assert_eq!(recording.events.counts().cushions, 0);
    let measured = metrics(&scene, &recording);
    for (states, at) in recording.samples().zip(&measured) {
        for (state, body) in states.iter().zip(&scene.bodies) {
            assert_eq!(state.position, Vector3::from(body.position));
        }
        // Eight steps of a few roundings.
        assert!((at.kinetic_energy / measured[0].kinetic_energy - 1.0).abs() < 1e-14);
    }
}

/// A stiff dumbbell on the floor: it falls as a whole, but the floor that holds its lower end lets
/// the upper one sink, and nothing is found that the spring leads to. The push that was tried is
/// taken back with the step: nothing moved, and no wall gave any momentum.
#[test]
fn a_step_that_is_given_up_for_its_pushes_leaves_none_behind() {
    let (mut bodies, mut effects) = unpayable(floor(5.0, 0.5));
    effects.springs[0].rest_length = 2.0;
    for (body, y) in bodies.iter_mut().zip([-4.5, -2.5]) {
        (body.radius, body.position) = (0.5, [0.0, y, 0.0]);
    }
    let scene = scene(1.0, 0.125, bodies, effects);
    let mut simulation = prepare(&scene, &engine("robust").unwrap(), 0.125).unwrap();
    assert!(simulation.keep_ledger());
    let recording = drive(&scene, "robust", simulation.as_mut());
    assert_eq!(conceded(&recording, ConcessionKind::TurnedBack), 8);
    for (state, body) in recording
        .samples()
        .flatten()
        .zip(scene.bodies.iter().cycle())
    {
        assert_eq!(state.position, Vector3::from(body.position));
        assert_eq!(state.velocity, Vector3::zeros());
    }
    let pushed = simulation.ledger().unwrap().of(Account::Cushions).momentum;
    assert_eq!(pushed, Vector3::zeros());
}

/// Forces and places beyond the largest double: nothing is found that they lead to, bodies turn
/// back, and every number stays one.
#[test]
fn forces_beyond_the_largest_double_turn_bodies_back() {
    for (constant, stiffness) in [(1e308, 0.0), (0.0, 1e308), (1e200, 1e200)] {
        let (mut bodies, mut effects) = unpayable(Effects::default());
        effects.springs[0].stiffness = stiffness;
        effects.attraction = (constant > 0.0).then_some(Attraction {
            constant,
            softening: 0.0,
        });
        for body in &mut bodies {
            body.mass = 100.0;
            body.velocity = [0.0, 0.0, body.position[0]];
        }
        let scene = scene(0.25, 0.125, bodies, effects);
        let recording = robust(&scene, 0.125);
        for states in recording.samples() {
            let speed = states[0].velocity.norm();
            assert!(
                (speed - 0.6).abs() < 1e-15,
                "{constant} {stiffness}: {speed}"
            );
        }
    }
}

/// A spring whose ends swing through each other, and a cluster that collapses into a heap: a step
/// that finds no end is halved, and none is turned back.
#[test]
fn a_step_without_an_end_is_halved_before_it_is_given_up() {
    for (library, name, dt) in [
        (Library::EmbeddedHard, "spring-100-times", 0.01),
        (Library::Embedded, "cluster-8", 0.1),
    ] {
        let recording = robust(&library.case(name).unwrap().scene, dt);
        assert_eq!(recording.concessions, [], "{name}");
    }
}

/// A ball that slides down another, with or without the spring beside it that makes every step
/// as long as it may be.
fn slide(speed: f64, dt: f64, beside: bool) -> Recording {
    let (mut bodies, mut effects) = unpayable(floor(5.0, 0.0));
    if beside {
        // At rest length, where it pulls at nothing.
        effects.springs[0].rest_length = 1.2;
    } else {
        effects.springs.clear();
    }
    bodies.push(body("large", 1e9, 2.0, [0.0, -3.0, 0.0], [0.0; 3]));
    bodies.push(body("small", 1.0, 0.1, [0.0, -0.9, 0.0], [speed, 0.0, 0.0]));
    robust(&scene(dt, dt, bodies, effects), dt)
}

/// With pushes found in rounds a slide of an eighth of a radian in one step keeps its surfaces in
/// touch to less than counts as such, 1e-10 of the smaller radius; one of a quarter does not, and
/// is a concession, unless the step may be divided.
#[test]
fn surfaces_that_slide_too_far_in_a_step_are_loose_and_said_to_be() {
    for (dt, beside, loose) in [(0.25, true, 0), (0.5, true, 1), (0.5, false, 0)] {
        let recording = slide(1.0, dt, beside);
        assert_eq!(
            conceded(&recording, ConcessionKind::Loose),
            loose,
            "{dt} {beside}"
        );
        let last = recording.sample(1);
        let [large, small] = [last.len() - 2, last.len() - 1].map(|body| last[body].position);
        let off = ((small - large).norm() - 2.1).abs();
        assert_eq!(off > 1e-11, loose > 0, "{dt} {beside}: {off:e}");
    }
}

/// A ball between a floor and a ceiling, and two that fly side by side, whose rates of drag differ:
/// nothing tells their search that they do not meet before it has looked some hundred times. That
/// counts as impacts, and the bounces end early.
#[test]
fn searches_that_look_often_are_paid_for_as_impacts() {
    let bounces = |other: f64| {
        let flying = |name: &str, mass: f64, z: f64| {
            body(name, mass, 0.5, [800.0, 0.0, z], [-50.0, 0.0, 0.0])
        };
        let bodies = vec![
            body("between", 1e9, 0.5, [-900.0, 0.0, 0.0], [0.0, 1e5, 0.0]),
            flying("one", 1.0, 0.0),
            flying("other", other, 1.0001),
        ];
        let effects = Effects {
            cushions: Some(Cushions {
                half_width: 1000.0,
                half_length: 1000.0,
                half_height: Some(1.0),
                restitution: 1.0,
            }),
            drag: Some(Drag { coefficient: 1.0 }),
            ..contact(1.0)
        };
        let recording = robust(&scene(1.0, 1.0, bodies, effects), 1.0);
        assert!(conceded(&recording, ConcessionKind::CutShort) > 0);
        recording.events.counts().cushions
    };
    let (cheap, dear) = (bounces(1.0), bounces(1.001));
    assert!(cheap > 40_000 && dear < cheap / 2, "{cheap} {dear}");
}

/// A light ball in front of a heavy one, both as fast: nothing approaches, until drag slows the
/// light one down. They meet where `1 + (1 - exp(-t)) - 1000 (1 - exp(-t/1000))` is 0.
#[test]
fn a_heavy_ball_catches_up_under_drag_with_a_light_one_that_was_as_fast() {
    let bodies = vec![
        body("light", 1.0, 0.5, [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        body("heavy", 1000.0, 0.5, [0.0; 3], [1.0, 0.0, 0.0]),
    ];
    let effects = Effects {
        drag: Some(Drag { coefficient: 1.0 }),
        ..contact(1.0)
    };
    let recording = robust(&scene(2.0, 0.125, bodies, effects), 0.125);
    let met = recording.events.events()[0].time;
    let gap = 1.0 - (-met).exp_m1() + 1000.0 * (-met / 1000.0).exp_m1();
    // A few roundings of places near 3.
    assert!(gap.abs() < 1e-14, "{met}: {gap:e}");
}

/// Alone under drag: from speed v at rate c a ball stops at r after `ln(v/r)/c`, `(v - r)/c` on.
/// One that is slower than r from the start stops at once, whether anything slows it or not.
#[test]
fn a_ball_with_nothing_to_meet_still_stops_at_the_rest_speed() {
    for (speed, coefficient, goes) in [(3.0, 1.0, 4.0), (0.5, 1.0, 0.0), (0.5, 0.0, 0.0)] {
        let bodies = vec![body("a", 2.0, 0.5, [0.0; 3], [speed, 0.0, 0.0])];
        let effects = Effects {
            drag: Some(Drag { coefficient }),
            rest: Some(Rest { speed: 1.0 }),
            ..Effects::default()
        };
        let recording = robust(&scene(4.0, 1.0, bodies, effects), 0.125);
        let last = recording.sample(4)[0];
        assert_eq!(last.velocity, Vector3::zeros());
        // The time is found to 60 halvings of a step, the place to a few roundings of 4.
        assert!(
            (last.position.x - goes).abs() < 1e-14,
            "{}",
            last.position.x
        );
    }
}

/// A ball that sticks in a wall by 0.25 and moves out of it is put to the wall at once.
#[test]
fn a_ball_that_leaves_a_wall_it_sticks_in_starts_at_the_wall() {
    let bodies = vec![body("a", 1.0, 0.5, [9.75, 0.0, 0.0], [-1.0, 0.0, 0.0])];
    let mut effects = floor(10.0, 1.0);
    effects.gravity = None;
    let recording = robust(&scene(0.25, 0.125, bodies, effects), 0.125);
    assert_eq!(recording.sample(2)[0].position.x, 9.5 - 0.25);
}

/// Two that fly side by side, a tenth of a step's way apart, are known not to meet: no step looks
/// at them.
#[test]
fn what_cannot_meet_is_not_looked_at() {
    let flying = |name: &str, z: f64| body(name, 1.0, 0.5, [0.0, 0.0, z], [1.0, 0.0, 0.0]);
    let bodies = vec![flying("a", 0.0), flying("b", 1.0125)];
    let recording = robust(&scene(1.0, 0.125, bodies, contact(1.0)), 0.125);
    assert_eq!((recording.work.steps, recording.work.pair_tests), (8, 0));
}

/// An impact at the very end of a step belongs to it: a sample shows the state after it.
#[test]
fn an_impact_at_the_instant_of_a_sample_is_in_it() {
    let bodies = vec![
        body("a", 1.0, 0.5, [-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        body("b", 1.0, 0.5, [0.0; 3], [0.0; 3]),
    ];
    // Numbers without rounding: after eight steps of 1/8 they touch.
    let recording = robust(&scene(1.0, 0.125, bodies, contact(1.0)), 0.125);
    let before = recording.sample(7).iter().map(|state| state.velocity.x);
    let after = recording.sample(8).iter().map(|state| state.velocity.x);
    assert_eq!(before.collect::<Vec<_>>(), [1.0, 0.0]);
    assert_eq!(after.collect::<Vec<_>>(), [0.0, 1.0]);
}

/// What was known of the old states is forgotten with them: that nothing is near, and that there
/// is no room.
#[test]
fn states_set_from_outside_are_looked_at_anew() {
    let bodies = vec![
        body("a", 1.0, 0.5, [-9e6, 0.0, 0.0], [1.0, 0.0, 0.0]),
        body("b", 1.0, 0.5, [0.0; 3], [0.0; 3]),
    ];
    let far = scene(1.0, 0.125, bodies, contact(1.0));
    let mut simulation = prepare(&far, &engine("robust").unwrap(), 0.125).unwrap();
    simulation.advance_to(1, None);
    let at = |x: f64, speed: f64| BodyState {
        position: Vector3::x() * x,
        velocity: Vector3::x() * speed,
    };
    simulation.set_state(1, &[at(-1.0625, 1.0), at(0.0, 0.0)]);
    let mut log = EventLog::default();
    simulation.advance_to(2, Some(&mut log));
    assert_eq!(log.counts().contacts, 1);
    let full = crowded();
    let mut simulation = prepare(&full, &engine("robust").unwrap(), 0.01).unwrap();
    let mut states = vec![at(0.0, 0.0); full.bodies.len()];
    for sample in 0..2 {
        simulation.state_into(&mut states);
        simulation.set_state(sample, &states);
        simulation.advance_to(sample + 1, None);
    }
    let jammed = Concession {
        kind: ConcessionKind::Jammed,
        count: 2,
    };
    assert_eq!(simulation.concessions(), [jammed]);
}

/// As many as a box has no room for, in a row: that is tried once, and said; in a box with a
/// hair more room they find it.
#[test]
fn a_box_is_jammed_only_where_its_balls_do_not_fit() {
    for (half_width, jammed) in [(3.99, 1), (4.01, 0)] {
        let ball = |n: u8| {
            body(
                &format!("b{n}"),
                f64::from(n) + 1.0,
                1.0,
                [f64::from(n) - 2.0, 0.0, 0.0],
                [0.0; 3],
            )
        };
        let mut effects = contact(0.5);
        effects.cushions = Some(Cushions {
            half_width,
            half_length: 1.0,
            half_height: Some(1.0),
            restitution: 0.5,
        });
        let scene = scene(0.1, 0.05, (0..4).map(ball).collect(), effects);
        let recording = robust(&scene, 0.01);
        assert_eq!(
            conceded(&recording, ConcessionKind::Jammed),
            jammed,
            "{half_width}"
        );
        let [gained, _] = gains(&scene, &recording);
        assert_eq!(gained.max(0.0), 0.0);
    }
}
