//! Impacts, stops, and the events that tell of them.

use carom::engine::DEFAULT_DT;
use carom::physics::{contact_impulse, cushion_impulse};
use carom::recording::{EventKind, Wall};
use carom::scene::{Contact, Drag, Gravity, LengthUnit, Rest};

use super::{RAPIER, body, box_of, head_on, last, run, scene, tolerance};

#[test]
fn after_a_two_ball_impact_the_speed_ratio_is_e_and_the_one_event_carries_j() {
    let places = [
        (LengthUnit::Millimetre, 100.0),
        (LengthUnit::Millimetre, 5000.0),
    ]
    .into_iter()
    .chain([(LengthUnit::Metre, 0.1), (LengthUnit::Metre, 5.0)]);
    for (unit, speed) in places {
        for (e, mass_ratio) in [0.0, 0.1, 0.5, 0.9, 1.0]
            .into_iter()
            .flat_map(|e| [(e, 1.0), (e, 3.0)])
        {
            let scene = head_on(unit, speed, mass_ratio, e);
            for name in ["lecture"].into_iter().chain(RAPIER) {
                let what = format!("{name} {unit:?} {speed} e {e} masses {mass_ratio}:1");
                let recording = run(&scene, name, (scene.duration / 100.0).min(DEFAULT_DT));
                let [a, b] = last(&recording) else {
                    unreachable!()
                };
                let ratio = (b.velocity.x - a.velocity.x) / speed;
                assert!((ratio - e).abs() < tolerance(name), "{what}: ratio {ratio}");
                let events = recording.events.events();
                // At e = 0 rounding may leave the lecture's balls approaching at 1e-17.
                assert!(
                    events.len() == 1 || name == "lecture" && e == 0.0,
                    "{what}: {events:?}"
                );
                assert_eq!(events[0].kind, EventKind::Contact { a: 0, b: 1 }, "{what}");
                let j = contact_impulse(e, 0.16 * mass_ratio, 0.16, -speed);
                assert!(
                    (events[0].impulse / j - 1.0).abs() < tolerance(name),
                    "{what}: {events:?}"
                );
            }
        }
    }
}

#[test]
fn a_wall_keeps_its_own_restitution_bouncier_or_duller_than_the_balls() {
    let (mass, speed) = (0.16, 5.0);
    for (balls, wall) in [
        (Some(0.9), 1.0),
        (Some(0.9), 0.3),
        (Some(0.0), 0.7),
        (None, 0.5),
    ] {
        let mut scene = scene(0.16, vec![body("a", mass, 0.04, 0.0, speed)]);
        scene.effects.contact = balls.map(|restitution| Contact { restitution });
        scene.effects.cushions = Some(box_of(0.5, wall));
        for name in RAPIER {
            let what = format!("{name} balls {balls:?} wall {wall}");
            let recording = run(&scene, name, 1e-3);
            let ratio = -last(&recording)[0].velocity.x / speed;
            assert!((ratio - wall).abs() < tolerance(name), "{what}: {ratio}");
            let [event] = recording.events.events() else {
                panic!("{what}: one event")
            };
            assert_eq!(
                event.kind,
                EventKind::Cushion {
                    body: 0,
                    wall: Wall::PlusX
                }
            );
            let j = cushion_impulse(wall, mass, speed);
            assert!(
                (event.impulse / j - 1.0).abs() < tolerance(name),
                "{what}: {event:?}"
            );
        }
    }
}

/// Bouncing, then lying on the floor: every impulse, over substeps and steps, is in the events.
/// Their sum is `m (g t + v)`; tolerance 500 steps of rounding at the largest momentum, 4 kg m/s.
#[test]
fn impulses_of_events_add_up_to_the_change_of_momentum() {
    let mut scene = scene(5.0, vec![body("a", 1.0, 0.1, 0.0, 0.0)]);
    scene.effects.gravity = Some(Gravity {
        acceleration: [0.0, -9.81, 0.0],
    });
    scene.effects.cushions = Some(box_of(5.0, 0.5));
    scene.effects.cushions.as_mut().unwrap().half_height = Some(1.0);
    for name in RAPIER {
        let recording = run(&scene, name, 0.01);
        let total: f64 = recording
            .events
            .events()
            .iter()
            .map(|event| event.impulse)
            .sum();
        let change = 9.81 * 5.0 + last(&recording)[0].velocity.y;
        let epsilon = if name == "rapier" {
            f64::from(f32::EPSILON)
        } else {
            f64::EPSILON
        };
        assert!(
            (total - change).abs() < 500.0 * 4.0 * epsilon,
            "{name}: {total} for {change}"
        );
        let count = recording.events.events().len();
        assert!(
            (4..=6).contains(&count),
            "{name}: lying is one event, not one a step: {count}"
        );
    }
}

#[test]
fn without_a_contact_effect_balls_pass_each_other_and_still_bounce_off_walls() {
    let mut scene = scene(
        2.0,
        vec![
            body("a", 1.0, 0.1, -0.3, 1.0),
            body("b", 1.0, 0.1, 0.3, -1.0),
        ],
    );
    scene.effects.cushions = Some(box_of(1.0, 1.0));
    for name in RAPIER {
        let recording = run(&scene, name, 0.01);
        let kinds: Vec<_> = recording
            .events
            .events()
            .iter()
            .map(|event| event.kind)
            .collect();
        let cushion = |body, wall| EventKind::Cushion { body, wall };
        assert_eq!(
            kinds,
            [cushion(0, Wall::PlusX), cushion(1, Wall::MinusX)],
            "{name}"
        );
        assert!(last(&recording)[0].velocity.x < -0.99, "{name}");
    }
    // Without walls there is nothing to touch, and no pair is ever looked at.
    scene.effects.cushions = None;
    assert_eq!(run(&scene, "rapier", 0.01).work.pair_tests, 0);
}

#[test]
fn a_slow_ball_stops_and_says_so() {
    let mut scene = scene(2.0, vec![body("a", 2.0, 0.1, 0.0, 1.0)]);
    scene.effects.drag = Some(Drag { coefficient: 2.0 });
    scene.effects.rest = Some(Rest { speed: 0.5 });
    for name in RAPIER {
        let recording = run(&scene, name, 0.01);
        let [event] = recording.events.events() else {
            panic!("{name}: one stop")
        };
        assert_eq!(event.kind, EventKind::Rest { body: 0 });
        // exp(-t) reaches 0.5 at 0.693 s; the last step takes up to 1 % off.
        assert!((event.time - 0.693).abs() < 0.02 && (0.99..1.0).contains(&event.impulse));
        assert_eq!(last(&recording)[0].velocity.x, 0.0, "{name}");
    }
}
