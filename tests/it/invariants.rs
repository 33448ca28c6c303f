//! What must hold whatever the numbers: conservation, symmetry, scaling, absent = neutral.

use carom::engine::{engine, prepare, record};
use carom::physics::BodyState;
use carom::recording::Recording;
use carom::scene::{Attraction, Contact, Cushions, Drag, Effects, Gravity, Rest, Scene, Spring};
use proptest::prelude::*;

use crate::scenes::{apart, body, cluster, lecture, momentum_drift, oblique, scene};

/// Forces come in exact opposite pairs and impulses in pairs equal to rounding, so momentum
/// drifts by rounding alone: about sqrt(steps) ulps, 1e-14, far below the promise of 1e-12.
#[test]
fn momentum_holds_without_walls() {
    for restitution in [0.0, 0.1, 0.5, 0.9, 1.0] {
        for masses in [[1.0, 1.0], [3.0, 1.0], [1e9, 1.0]] {
            let scene = oblique(restitution, masses);
            let recording = lecture(&scene, 0.01);
            assert!(recording.events.counts().contacts > 0, "no impact, no test");
            let drift = momentum_drift(&scene, &recording);
            assert!(
                drift < 1e-12,
                "e = {restitution}, masses {masses:?}: {drift:e}"
            );
        }
    }
    for seed in 1..=5 {
        let scene = cluster(12, seed, 0.1);
        let recording = lecture(&scene, 0.01);
        assert!(
            recording.events.counts().contacts > 10,
            "no impacts, no test"
        );
        let drift = momentum_drift(&scene, &recording);
        assert!(drift < 1e-12, "seed {seed}: {drift:e}");
    }
}

/// What a step keeps for the next, such as its last forces, is not used for other states.
#[test]
fn states_set_from_outside_go_on_as_a_start_does() {
    let at = |x: f64, speed: f64| BodyState {
        position: [x, 0.0, 0.0].into(),
        velocity: [0.0, 0.0, speed].into(),
    };
    let bodies = |states: &[BodyState; 2]| {
        let [a, b] = states.map(|state| (state.position.into(), state.velocity.into()));
        vec![body("a", 1.0, 0.1, a.0, a.1), body("b", 2.0, 0.1, b.0, b.1)]
    };
    let effects = Effects {
        attraction: Some(Attraction {
            constant: 3.0,
            softening: 0.0,
        }),
        drag: Some(Drag { coefficient: 0.1 }),
        ..Effects::default()
    };
    let (first, then) = (
        [at(-1.0, 0.5), at(1.0, -0.5)],
        [at(2.0, -1.0), at(-0.5, 0.3)],
    );
    // The one with steps of its own goes on with the length that it chose last.
    for name in RUNGS.into_iter().filter(|name| *name != "adaptive") {
        let spec = engine(name).unwrap();
        let run = scene(1.0, 0.25, bodies(&first), effects.clone());
        let mut simulation = prepare(&run, &spec, 0.01).unwrap();
        simulation.advance_to(1, None);
        simulation.set_state(1, &then);
        simulation.advance_to(2, None);
        let mut states = then;
        simulation.state_into(&mut states);
        let fresh = scene(0.25, 0.25, bodies(&then), effects.clone());
        let fresh = record(&fresh, &spec, 0.01).unwrap();
        assert_eq!(states[..], *fresh.sample(1), "{name}");
    }
}

fn mirrored(scene: &Scene, axis: usize) -> Scene {
    let mut scene = scene.clone();
    for body in &mut scene.bodies {
        body.position[axis] = -body.position[axis];
        body.velocity[axis] = -body.velocity[axis];
    }
    scene
}

/// Every operation of a step is odd or even in each coordinate, so mirroring is exact.
#[test]
fn a_mirrored_scene_moves_in_mirror_image_bit_for_bit() {
    let mut scenes = vec![oblique(0.9, [2.0, 1.0]), cluster(8, 3, 0.1)];
    scenes.push(
        carom::case::Library::Embedded
            .case("shot-2-61")
            .unwrap()
            .scene,
    );
    for original in scenes {
        for axis in [0, 2] {
            let a = lecture(&original, 0.01);
            let b = lecture(&mirrored(&original, axis), 0.01);
            for (a, b) in a
                .samples()
                .zip(b.samples())
                .flat_map(|(a, b)| a.iter().zip(b))
            {
                let mut image = *b;
                image.position[axis] = -image.position[axis];
                image.velocity[axis] = -image.velocity[axis];
                assert_eq!(*a, image, "{}, axis {axis}", original.name);
            }
        }
    }
}

/// Lengths times a power of two, with every constant scaled to match, only moves exponents.
#[test]
fn scaling_the_unit_of_length_by_a_power_of_two_is_exact() {
    let mut original = carom::case::Library::Embedded
        .case("shot-2-61")
        .unwrap()
        .scene;
    original.effects.attraction = Some(Attraction {
        constant: 5.5e6,
        softening: 0.0,
    });
    original.effects.gravity = Some(Gravity {
        acceleration: [3.0, 0.0, -40.0],
    });
    original.effects.springs = vec![Spring {
        between: ["ball0".into(), "ball1".into()],
        stiffness: 2.0,
        rest_length: 300.0,
        damping: 0.1,
    }];
    let factor = 1024.0;
    let mut scaled = original.clone();
    for body in &mut scaled.bodies {
        body.radius *= factor;
        body.position = body.position.map(|x| x * factor);
        body.velocity = body.velocity.map(|v| v * factor);
    }
    let effects = &mut scaled.effects;
    let cushions = effects.cushions.as_mut().unwrap();
    cushions.half_width *= factor;
    cushions.half_length *= factor;
    effects.rest.as_mut().unwrap().speed *= factor;
    effects.attraction.as_mut().unwrap().constant *= factor.powi(3);
    effects.gravity.as_mut().unwrap().acceleration =
        effects.gravity.unwrap().acceleration.map(|g| g * factor);
    effects.springs[0].rest_length *= factor;
    let (a, b) = (lecture(&original, 0.01), lecture(&scaled, 0.01));
    for (a, b) in a
        .samples()
        .zip(b.samples())
        .flat_map(|(a, b)| a.iter().zip(b))
    {
        assert_eq!(a.position * factor, b.position);
        assert_eq!(a.velocity * factor, b.velocity);
    }
}

/// Two bodies in the other order meet the same impact: only the sign of the normal changes.
#[test]
fn the_order_of_two_bodies_does_not_matter() {
    let original = oblique(0.5, [3.0, 1.0]);
    let mut swapped = original.clone();
    swapped.bodies.reverse();
    let (a, b) = (lecture(&original, 0.01), lecture(&swapped, 0.01));
    for (a, b) in a.samples().zip(b.samples()) {
        assert_eq!([a[0], a[1]], [b[1], b[0]]);
    }
}

/// In a moving frame the same happens, to the rounding of the larger coordinates: positions
/// reach 20 after 2 s at speed 8, so 200 steps of half an ulp of 32 (3.6e-15) each, 7e-13;
/// the impact happens in the same step and multiplies that by less than 10.
#[test]
fn a_boost_changes_nothing_but_the_frame() {
    let original = oblique(0.9, [2.0, 1.0]);
    let boost = [8.0, -4.0, 2.0];
    let mut boosted = original.clone();
    for body in &mut boosted.bodies {
        body.velocity = [0, 1, 2].map(|axis| body.velocity[axis] + boost[axis]);
    }
    let (a, b) = (lecture(&original, 0.01), lecture(&boosted, 0.01));
    for (sample, (a, b)) in a.samples().zip(b.samples()).enumerate() {
        let moved = nalgebra::Vector3::from(boost) * original.sample_time(sample);
        for (a, b) in a.iter().zip(b) {
            let error = (a.position + moved - b.position).norm();
            assert!(error < 1e-11, "sample {sample}: {error:e}");
        }
    }
}

/// Every effect that is not declared and has a neutral value, one at a time, then all together.
fn neutral(effects: &Effects) -> Vec<(&'static str, Effects)> {
    let with = |change: fn(&mut Effects)| {
        let mut changed = effects.clone();
        change(&mut changed);
        changed
    };
    let every = [
        ("drag", with(|e| e.drag = Some(Drag { coefficient: 0.0 }))),
        ("rest", with(|e| e.rest = Some(Rest { speed: 0.0 }))),
        (
            "attraction",
            with(|e| {
                e.attraction = Some(Attraction {
                    constant: 0.0,
                    softening: 0.0,
                })
            }),
        ),
        (
            "gravity",
            with(|e| {
                e.gravity = Some(Gravity {
                    acceleration: [0.0; 3],
                })
            }),
        ),
        (
            "springs",
            with(|e| {
                e.springs = vec![Spring {
                    between: ["a".into(), "b".into()],
                    stiffness: 0.0,
                    rest_length: 1.0,
                    damping: 0.0,
                }];
            }),
        ),
    ];
    let is_absent = |name: &str| match name {
        "drag" => effects.drag.is_none(),
        "rest" => effects.rest.is_none(),
        "attraction" => effects.attraction.is_none(),
        "gravity" => effects.gravity.is_none(),
        "springs" => effects.springs.is_empty(),
        _ => panic!("{name} has no neutral value"),
    };
    let absent = every.into_iter().filter(|(name, _)| is_absent(name));
    let mut neutral: Vec<_> = absent.collect();
    let mut together = effects.clone();
    for (name, changed) in &neutral {
        match *name {
            "drag" => together.drag = changed.drag,
            "rest" => together.rest = changed.rest,
            "attraction" => together.attraction = changed.attraction,
            "gravity" => together.gravity = changed.gravity,
            _ => together.springs.clone_from(&changed.springs),
        }
    }
    neutral.push(("all together", together));
    neutral
}

/// Effects that act, each there or not.
fn acting() -> impl Strategy<Value = Effects> {
    let drag = proptest::option::of((0.0..20.0).prop_map(|coefficient| Drag { coefficient }));
    let rest = proptest::option::of((0.0..2.0).prop_map(|speed| Rest { speed }));
    let attraction = (0.0..30.0, prop_oneof![Just(0.0), 0.0..1.0]);
    let attraction = attraction.prop_map(|(constant, softening)| Attraction {
        constant,
        softening,
    });
    let gravity = vector().prop_map(|acceleration| Gravity { acceleration });
    let springs =
        (0.0..50.0, 0.0..2.0, 0.0..5.0).prop_map(|(stiffness, rest_length, damping)| Spring {
            between: ["b".into(), "a".into()],
            stiffness,
            rest_length,
            damping,
        });
    let (attraction, gravity) = (
        proptest::option::of(attraction),
        proptest::option::of(gravity),
    );
    let springs = proptest::collection::vec(springs, 0..2);
    (drag, rest, attraction, gravity, springs).prop_map(
        |(drag, rest, attraction, gravity, springs)| Effects {
            drag,
            rest,
            attraction,
            gravity,
            springs,
            ..Effects::default()
        },
    )
}

fn assert_same_bits(a: &Recording, b: &Recording, what: &str) {
    assert_eq!(a.sample_count(), b.sample_count(), "{what}");
    assert_eq!(a.events.events(), b.events.events(), "{what}");
    for (a, b) in a
        .samples()
        .zip(b.samples())
        .flat_map(|(a, b)| a.iter().zip(b))
    {
        for axis in 0..3 {
            assert_eq!(
                a.position[axis].to_bits(),
                b.position[axis].to_bits(),
                "{what}"
            );
            assert_eq!(
                a.velocity[axis].to_bits(),
                b.velocity[axis].to_bits(),
                "{what}"
            );
        }
    }
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(-0.0),
        -3.0..3.0,
        Just(1.0),
        Just(f64::EPSILON)
    ]
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

fn mass() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1.0), 0.1..10.0, Just(1e9), Just(1e-9)]
}

/// The hand-written engines.
const RUNGS: [&str; 7] = [
    "lecture",
    "lecture-in-place",
    "exact-drag",
    "verlet",
    "swept",
    "swept-4",
    "adaptive",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn absent_equals_neutral_bit_for_bit(
        bodies in proptest::collection::vec((mass(), vector(), vector()), 2..4),
        restitution in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0],
        contact in any::<bool>(),
        walls in prop_oneof![Just(None), Just(Some(None)), Just(Some(Some(2.0)))],
        acting in prop_oneof![Just(Effects::default()), acting()],
    ) {
        let names = ["a", "b", "c", "d"];
        let bodies: Vec<_> = bodies
            .into_iter()
            .zip(names)
            .map(|((mass, position, velocity), name)| body(name, mass, 0.5, position, velocity))
            .collect();
        let effects = Effects {
            contact: contact.then_some(Contact { restitution }),
            cushions: walls.map(|half_height| Cushions {
                half_width: 2.5, half_length: 3.0, half_height, restitution: 0.8,
            }),
            ..acting
        };
        for rung in RUNGS {
            let run = |effects: Effects| {
                let scene = scene(1.0, 0.25, bodies.clone(), effects);
                record(&scene, &engine(rung).unwrap(), 0.02).unwrap()
            };
            let absent = run(effects.clone());
            // Past the numbers whose squares overflow, no coefficient of 0 is neutral: 0 times
            // infinity. A light ball in strong drag gets there.
            let small = |x: &f64| x.abs() < 1e100;
            let tame = absent.outcome.is_finished() && absent.samples().flatten().all(|state| {
                state.position.iter().chain(state.velocity.iter()).all(small)
            });
            prop_assume!(tame);
            for (name, effects) in neutral(&effects) {
                assert_same_bits(&absent, &run(effects), &format!("{rung}: {name}"));
            }
        }
    }

    /// Whatever the scene, momentum holds to rounding where nothing outside acts: relative to
    /// the sum of m |v| over the whole run, 100 steps of a few ulps.
    #[test]
    fn momentum_holds_for_any_spheres(
        bodies in proptest::collection::vec((mass(), vector(), vector()), 2..5),
        restitution in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0],
    ) {
        let names = ["a", "b", "c", "d", "e"];
        let bodies: Vec<_> = bodies
            .into_iter()
            .zip(names)
            .map(|((mass, position, velocity), name)| body(name, mass, 0.5, position, velocity))
            .collect();
        let effects = Effects { contact: Some(Contact { restitution }), ..Effects::default() };
        let scene = scene(1.0, 0.25, bodies, effects);
        let drift = momentum_drift(&scene, &lecture(&scene, 0.01));
        prop_assert!(drift < 1e-12, "{drift:e}");
    }
}

/// Negative control: the comparisons above can fail.
#[test]
fn a_changed_scene_is_seen() {
    let original = oblique(0.9, [2.0, 1.0]);
    let mut changed = original.clone();
    changed.effects.drag = Some(Drag { coefficient: 1e-9 });
    assert!(apart(&lecture(&original, 0.01), &lecture(&changed, 0.01)) > 0.0);
    let drift = momentum_drift(&changed, &lecture(&changed, 0.01));
    assert!(
        drift > 1e-12,
        "drag must show as a drift of momentum: {drift:e}"
    );
}
