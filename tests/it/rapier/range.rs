//! Numbers that overflow, vanish or mean nothing to Rapier.

use carom::engine::{engine, plan, record};
use carom::error::Error;
use carom::physics::BodyState;
use carom::recording::Outcome;
use carom::scene::{Attraction, Contact, Drag, Gravity, Scene};
use proptest::prelude::*;

use super::{RAPIER, body, box_of, run, scene, spring};

/// A joint without stiffness and damping used to be a rigid bar: 1/0 is 0 to Rapier.
#[test]
fn a_spring_without_stiffness_is_no_spring_bit_for_bit() {
    let mut scene = scene(
        1.0,
        vec![body("a", 1.0, 0.1, 0.0, 1.0), body("b", 1.0, 0.1, 5.0, 0.0)],
    );
    for name in RAPIER {
        scene.effects.springs.clear();
        let without = run(&scene, name, 0.01);
        scene.effects.springs = spring(0.0, 1.0, 0.0);
        assert!(
            without.samples().eq(run(&scene, name, 0.01).samples()),
            "{name}"
        );
    }
}

#[test]
fn numbers_that_overflow_end_the_run_and_never_pass_in_silence() {
    let pair = || {
        scene(
            1.0,
            vec![body("a", 1.0, 1.0, 0.0, 0.0), body("b", 1.0, 1.0, 5.0, 0.0)],
        )
    };
    let mut fast = pair();
    fast.bodies[0].velocity[0] = 1e300;
    let mut far = pair();
    far.bodies[1].position[0] = 1e300;
    let mut strong = pair();
    strong.effects.attraction = Some(Attraction {
        constant: 1e308,
        softening: 0.0,
    });
    for scene in [fast, far, strong] {
        for name in RAPIER {
            let outcome = run(&scene, name, 0.01).outcome;
            assert!(
                matches!(outcome, Outcome::NonFinite { .. }),
                "{name}: {outcome:?}"
            );
        }
    }
    // Finite in 64 bits, infinite in 32: Rapier disables the bodies, and says so for one step.
    let mut heavy = pair();
    heavy.bodies.iter_mut().for_each(|body| body.mass = 1e19);
    heavy.effects.attraction = Some(Attraction {
        constant: 1e2,
        softening: 0.0,
    });
    let expected = Outcome::Disabled {
        time: 0.01,
        body: 0,
    };
    assert_eq!(run(&heavy, "rapier", 0.01).outcome, expected);
    assert_eq!(
        run(&heavy, "rapier-matched", 0.01).outcome,
        Outcome::Finished
    );
    // Coincident centres: neither NaN nor a lost body.
    let mut coincident = pair();
    coincident.bodies[1].position[0] = 0.0;
    coincident.effects.contact = Some(Contact { restitution: 0.5 });
    coincident.effects.attraction = Some(Attraction {
        constant: 1.0,
        softening: 0.0,
    });
    for name in RAPIER {
        assert_eq!(
            run(&coincident, name, 0.01).outcome,
            Outcome::Finished,
            "{name}"
        );
    }
}

/// A joint used to fling a ball so fast that the speed cap divided by infinity: it stood still.
#[test]
fn a_ball_flung_by_a_joint_ends_the_run() {
    let mut scene = scene(
        1.0,
        vec![
            body("a", 1.0, 1.0, 0.0, 1.0),
            body("b", 1.0, 1.0, 1e18, 0.0),
        ],
    );
    scene.effects.springs = spring(1e18, 1.0, 0.0);
    let outcome = run(&scene, "rapier", 0.01).outcome;
    assert_eq!(
        outcome,
        Outcome::NonFinite {
            time: 0.01,
            body: 0
        }
    );
}

#[test]
fn numbers_that_mean_nothing_to_an_engine_are_refused_by_name() {
    let refused = |scene: &Scene, name: &str, field: &str| {
        let error = record(scene, &engine(name).unwrap(), 0.01).unwrap_err();
        assert!(matches!(error, Error::EngineCannot { .. }), "{error}");
        assert!(error.to_string().contains(field), "{error}");
        assert!(plan(scene, &engine(name).unwrap(), 0.01).is_err());
    };
    let pair = || {
        scene(
            1.0,
            vec![body("a", 1.0, 0.1, 0.0, 1.0), body("b", 1.0, 0.1, 1.0, 0.0)],
        )
    };
    let mut tiny = pair();
    tiny.bodies[1].radius = 1e-30;
    refused(&tiny, "rapier", "bodies[1].radius (`b`)");
    assert_eq!(run(&tiny, "rapier-f64", 0.01).outcome, Outcome::Finished);
    let mut light = pair();
    light.bodies[0].mass = 1e-300;
    refused(&light, "rapier", "bodies[0].mass (`a`)");
    let mut heavy = pair();
    heavy.bodies[0].mass = 1e21;
    assert_eq!(
        run(&heavy, "rapier-f64", 0.01).outcome,
        Outcome::Finished,
        "nothing acts on it"
    );
    heavy.effects.contact = Some(Contact { restitution: 1.0 });
    refused(&heavy, "rapier-f64", "bodies[0].mass (`a`)");
    let mut weak = pair();
    weak.effects.springs = spring(1e-16, 1.0, 0.0);
    refused(&weak, "rapier-f64", "effects.springs[0]");
    assert_eq!(
        run(&weak, "rapier-matched", 0.01).outcome,
        Outcome::Finished
    );
}

/// Numbers of any size, most of them far from what an engine is made for.
fn any_size() -> impl Strategy<Value = f64> {
    prop_oneof![
        -2.0..2.0,
        (-20.0..20.0).prop_map(|n| 10.0_f64.powf(n)),
        (-320.0..308.0).prop_map(|n| 10.0_f64.powf(n))
    ]
}

fn any_scene() -> impl Strategy<Value = Scene> {
    let positive = || any_size().prop_map(|x| x.abs().max(f64::MIN_POSITIVE));
    let one = (positive(), positive(), any_size(), any_size());
    let bodies = prop::collection::vec(one, 2..4);
    let effects = (any_size(), positive(), positive(), positive(), 0..64_u8);
    (bodies, effects).prop_map(|(bodies, (g, k, length, damping, declared))| {
        let named = bodies.iter().zip(["a", "b", "c"]);
        let bodies = named.map(|(&(mass, radius, x, v), name)| body(name, mass, radius, x, v));
        let mut scene = scene(0.1, bodies.collect());
        let is = |bit: u8| declared & (1 << bit) != 0;
        let effects = &mut scene.effects;
        effects.contact = is(0).then_some(Contact { restitution: 0.5 });
        effects.cushions = is(1).then_some(box_of(length, 1.0));
        effects.attraction = is(2).then_some(Attraction {
            constant: g,
            softening: 0.0,
        });
        effects.gravity = is(3).then_some(Gravity {
            acceleration: [0.0, g, 0.0],
        });
        effects.drag = is(4).then_some(Drag { coefficient: k });
        effects.springs = if is(5) {
            spring(k, length, damping)
        } else {
            Vec::new()
        };
        scene
    })
}

proptest! {
    #[test]
    fn no_scene_makes_an_engine_panic(scene in any_scene()) {
        for name in ["lecture"].into_iter().chain(RAPIER) {
            match record(&scene, &engine(name).unwrap(), 0.01) {
                Ok(recording) => {
                    let whole = recording.sample_count() == scene.sample_count() + 1;
                    prop_assert_eq!(whole, recording.outcome == Outcome::Finished);
                    let mut states = recording.samples().flatten();
                    prop_assert!(states.all(BodyState::is_finite));
                }
                Err(error) => prop_assert!(matches!(error, Error::EngineCannot { .. }), "{error}"),
            }
        }
    }
}
