//! Forces, joints, plans, and the life of a world.

use carom::engine::{engine, notes, plan, prepare, versions, warnings};
use carom::scene::{Attraction, Contact, Drag, Gravity, LengthUnit, Rest, Scene};

use super::{RAPIER, body, box_of, head_on, last, run, scene, spring};

/// Symplectic Euler with the same forces in the same order: the same bits.
#[test]
fn matched_is_the_lecture_bit_for_bit_where_nothing_touches() {
    let mut kepler = scene(
        10.0,
        vec![
            body("a", 1000.0, 0.01, 0.0, 0.0),
            body("b", 1.0, 0.01, 10.0, 0.0),
        ],
    );
    kepler.bodies[1].velocity = [0.0, 0.3, 9.0];
    kepler.effects.attraction = Some(Attraction {
        constant: 1.0,
        softening: 0.0,
    });
    let mut springs = scene(
        10.0,
        vec![
            body("a", 1.3, 0.01, 0.0, 0.1),
            body("b", 0.7, 0.01, 2.0, 0.0),
        ],
    );
    springs.bodies[1].velocity = [0.0, 0.3, 0.9];
    springs.effects.springs = spring(30.0, 1.0, 0.2);
    let mut all = springs.clone();
    all.effects.drag = Some(Drag { coefficient: 0.3 });
    all.effects.gravity = Some(Gravity {
        acceleration: [0.0, -9.81, 0.3],
    });
    for scene in [kepler, springs, all] {
        let (lecture, matched) = (
            run(&scene, "lecture", 0.01),
            run(&scene, "rapier-matched", 0.01),
        );
        assert!(lecture.samples().eq(matched.samples()));
        assert_eq!(lecture.work, matched.work);
        // Control: the stock engine does something else, so equality is not vacuous.
        assert!(
            !lecture
                .samples()
                .eq(run(&scene, "rapier-f64", 0.01).samples())
        );
    }
}

/// Equation: `v_n = v_0 / (1 + c dt)^n`, c = k/m; n roundings of two operations each.
#[test]
fn native_drag_divides_by_one_plus_c_dt_each_step() {
    let mut scene = scene(1.0, vec![body("a", 0.16, 0.04, 0.0, 5.0)]);
    scene.effects.drag = Some(Drag { coefficient: 0.05 });
    let expected = 5.0 / (1.0_f64 + 0.05 / 0.16 * 0.01).powi(100);
    for (name, epsilon) in [
        ("rapier", f64::from(f32::EPSILON)),
        ("rapier-f64", f64::EPSILON),
    ] {
        let recording = run(&scene, name, 0.01);
        let v = last(&recording)[0].velocity.x;
        assert!(
            (v / expected - 1.0).abs() < 300.0 * epsilon,
            "{name}: {v} for {expected}"
        );
    }
}

#[test]
fn balls_joined_by_a_spring_still_collide() {
    let mut scene = scene(
        1.0,
        vec![body("a", 1.0, 0.1, 0.0, 2.0), body("b", 1.0, 0.1, 1.0, 0.0)],
    );
    scene.effects.springs = spring(0.1, 1.0, 0.0);
    scene.effects.contact = Some(Contact { restitution: 1.0 });
    for name in RAPIER {
        assert_eq!(
            run(&scene, name, 0.01).events.counts().contacts,
            1,
            "{name}"
        );
    }
}

#[test]
fn watching_does_not_change_what_is_watched() {
    let scene = head_on(LengthUnit::Metre, 5.0, 3.0, 0.5);
    for name in RAPIER {
        let recording = run(&scene, name, 1e-3);
        let mut unwatched = prepare(&scene, &engine(name).unwrap(), 1e-3).unwrap();
        assert_eq!(unwatched.advance_to(scene.sample_count(), None), None);
        let mut states = recording.sample(0).to_vec();
        unwatched.state_into(&mut states);
        assert_eq!(states, last(&recording), "{name}");
    }
}

/// What Rapier carries from step to step must not outlive `set_state`.
#[test]
fn set_state_is_a_fresh_start() {
    let mut scene = head_on(LengthUnit::Metre, 5.0, 1.0, 0.9);
    scene.effects.cushions = Some(box_of(0.4, 0.8));
    for name in RAPIER {
        let once = run(&scene, name, 1e-3);
        let mut simulation = prepare(&scene, &engine(name).unwrap(), 1e-3).unwrap();
        simulation.advance_to(7, None);
        simulation.set_state(0, once.sample(0));
        simulation.advance_to(scene.sample_count(), None);
        let mut states = once.sample(0).to_vec();
        simulation.state_into(&mut states);
        assert_eq!(states, last(&once), "{name}");
    }
}

#[test]
fn the_plan_has_a_phase_for_what_the_scene_declares_and_nothing_else() {
    let mut scene = scene(
        1.0,
        vec![
            body("a", 1.0, 0.1, 0.0, 500.0),
            body("b", 1.0, 0.1, 5.0, 0.0),
        ],
    );
    let names = |scene: &Scene, name: &str| -> Vec<&'static str> {
        let plan = plan(scene, &engine(name).unwrap(), 0.01).unwrap();
        plan.phases.iter().map(|phase| phase.name).collect()
    };
    assert_eq!(names(&scene, "rapier"), ["drift"]);
    assert_eq!(names(&scene, "rapier-matched"), ["drift"]);
    let said = notes(&scene, &engine("rapier").unwrap()).join("\n");
    assert!(said.contains("cut at 400 m/s"), "{said}");
    let warned = warnings(&scene, &engine("rapier").unwrap()).join("\n");
    assert!(warned.starts_with("`a` starts faster"), "{warned}");
    assert!(warnings(&scene, &engine("rapier-matched").unwrap()).is_empty());
    scene.effects.drag = Some(Drag { coefficient: 0.1 });
    scene.effects.contact = Some(Contact { restitution: 0.5 });
    assert_eq!(
        names(&scene, "rapier"),
        ["detection", "contacts", "drift", "restitution", "drag"]
    );
    let matched = [
        "drag",
        "detection",
        "kick",
        "contacts",
        "drift",
        "restitution",
    ];
    assert_eq!(names(&scene, "rapier-matched"), matched);
}

/// Whatever a scene declares: no joint without springs, nothing detected, solved or swept without
/// something to touch, and no phase for an effect that is not there.
#[test]
fn no_combination_of_effects_has_a_phase_that_it_does_not_call_for() {
    let bodies = vec![body("a", 1.0, 0.1, 0.0, 1.0), body("b", 1.0, 0.1, 5.0, 0.0)];
    for declared in 0..1 << 7 {
        let has = |bit: usize| declared & (1 << bit) != 0;
        let [contact, cushions, drag, rest, attraction, gravity, springs] =
            [0, 1, 2, 3, 4, 5, 6].map(has);
        let mut scene = scene(1.0, bodies.clone());
        let effects = &mut scene.effects;
        effects.contact = contact.then_some(Contact { restitution: 0.5 });
        effects.cushions = cushions.then(|| box_of(9.0, 0.5));
        effects.drag = drag.then_some(Drag { coefficient: 0.1 });
        effects.rest = rest.then_some(Rest { speed: 0.1 });
        effects.attraction = attraction.then_some(Attraction {
            constant: 1.0,
            softening: 0.0,
        });
        effects.gravity = gravity.then_some(Gravity {
            acceleration: [0.0, -9.81, 0.0],
        });
        if springs {
            effects.springs = spring(30.0, 1.0, 0.2);
        }
        for name in RAPIER {
            let plan = plan(&scene, &engine(name).unwrap(), 0.01).unwrap();
            let phases: Vec<_> = plan.phases.iter().map(|phase| phase.name).collect();
            let native = name != "rapier-matched";
            let touches = contact || cushions;
            let expected = [
                ("attraction", attraction),
                ("drag", drag),
                ("springs", springs),
                ("gravity", gravity),
                ("detection", touches),
                ("contacts", contact),
                ("cushions", cushions),
                ("restitution", touches),
                ("sweep", cushions && native),
                ("rest", rest),
                ("drift", true),
            ];
            let what = format!("{name} {declared:07b}: {phases:?}");
            for (phase, expected) in expected {
                let count = phases.iter().filter(|name| **name == phase).count();
                assert_eq!(count, usize::from(expected), "{phase} in {what}");
            }
            let known = |name: &&str| *name == "kick" || expected.iter().any(|(n, _)| n == name);
            assert!(phases.iter().all(known), "{what}");
            let joints = plan.phases.iter().any(|p| p.method.contains("joint"));
            assert_eq!(joints, springs && native, "{what}");
            if !touches {
                let words = ["prediction", "closer than", "collision", "substep of soft"];
                let said = format!("{:?}", plan.phases);
                assert!(!words.iter().any(|word| said.contains(word)), "{what}");
            }
        }
    }
}

#[test]
fn the_version_in_reports_is_the_one_that_cargo_locked() {
    let version = versions()["rapier3d"];
    assert_eq!(rapier3d::VERSION, rapier3d_f64::VERSION);
    let lock = include_str!("../../../Cargo.lock");
    for name in ["rapier3d", "rapier3d-f64"] {
        assert!(
            lock.contains(&format!("name = \"{name}\"\nversion = \"{version}\"")),
            "{name}"
        );
    }
}
