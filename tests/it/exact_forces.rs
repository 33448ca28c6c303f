//! The `exact` engine on scenes with attraction or springs, against truth.

use carom::case::Library;
use carom::compare::{Drift, Sizes, cluster_facts, metrics};
use carom::engine::drive;
use carom::engine::exact::forces::{Accuracy, ForcesSimulation, Real, Wide, certified};
use carom::recording::{CollapseReason, Outcome, Recording};
use carom::scene::{Attraction, Contact, Cushions, Effects, Gravity, Rest, Scene, Spring};

use crate::scenes::{body, scene};

/// As much work as the published settings allow.
const OPERATIONS: u64 = 10_000_000_000;

/// A recording by the integrator in that arithmetic.
fn computed<T: Real>(scene: &Scene, accuracy: Accuracy) -> Recording {
    let mut simulation = ForcesSimulation::<T>::new(scene, accuracy).unwrap();
    drive(scene, "exact", &mut simulation)
}

/// A recording in doubles, on past collapse; refusals are given back.
fn fast(scene: &Scene) -> carom::error::Result<Recording> {
    let mut simulation = ForcesSimulation::<f64>::new(scene, Accuracy::FAST)?;
    Ok(drive(scene, "exact", &mut simulation))
}

/// Largest errors: positions over the diagonal of the box, velocities over the largest speed,
/// event times over the duration.
#[derive(Debug)]
struct Errors {
    position: f64,
    velocity: f64,
    event: f64,
}

fn errors(scene: &Scene, truth: &Recording, found: &Recording) -> Errors {
    assert_eq!(
        found.sample_count(),
        truth.sample_count(),
        "{:?}",
        found.outcome
    );
    let size = size_of(truth);
    let speeds = truth.samples().flatten().map(|state| state.velocity.norm());
    let fastest = speeds.fold(0.0, f64::max);
    let (mut position, mut velocity) = (0.0_f64, 0.0_f64);
    for (own, other) in found.samples().flatten().zip(truth.samples().flatten()) {
        position = position.max((own.position - other.position).norm() / size);
        velocity = velocity.max((own.velocity - other.velocity).norm() / fastest);
    }
    let kinds = |recording: &Recording| -> Vec<_> {
        recording
            .events
            .events()
            .iter()
            .map(|event| event.kind)
            .collect()
    };
    assert_eq!(kinds(found), kinds(truth));
    let events = found.events.events().iter().zip(truth.events.events());
    let event = events
        .map(|(own, other)| (own.time - other.time).abs() / scene.duration)
        .fold(0.0, f64::max);
    Errors {
        position,
        velocity,
        event,
    }
}

const CASES: [&str; 9] = [
    "falling-pair",
    "kepler-circle",
    "kepler-e06",
    "spring-chain",
    "spring-critical",
    "spring-over",
    "spring-under",
    "spring-under-line",
    "spring-under-simple",
];

/// The bound is the one asked for; doubles reach 1e-13 and less, wide numbers the rounding of
/// the output.
#[test]
fn agrees_with_truth() {
    for name in CASES {
        let case = Library::Embedded.case(name).unwrap();
        let (scene, truth) = (&case.scene, &case.truth.unwrap());
        for (arithmetic, recording) in [
            ("f64", computed::<f64>(scene, Accuracy::FAST)),
            ("wide", computed::<Wide>(scene, Accuracy::WIDE)),
        ] {
            let errors = errors(scene, truth, &recording);
            println!("{name} {arithmetic} {errors:?} {:?}", recording.work);
            let worst = errors.position.max(errors.velocity).max(errors.event);
            assert!(worst <= 1e-11, "{name} {arithmetic}: {errors:?}");
        }
    }
}

/// The scenes of `tests/forces`, each at an edge: nearly parabolic orbits, mass ratio 1e15,
/// three bodies, stiff and over-damped springs; truth by `make_truth.py` beside them.
const EDGES: [&str; 9] = [
    "figure-eight",
    "kepler-e09-100",
    "kepler-e099",
    "kepler-e099-peri",
    "kepler-mass",
    "over-1e4",
    "over-1e6",
    "stiff-1e4",
    "stiff-1e6",
];

fn edges() -> Library {
    Library::Folder(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/forces").into())
}

#[test]
fn agrees_with_truth_at_the_edges() {
    for name in EDGES {
        let case = edges().case(name).unwrap();
        let (scene, truth) = (&case.scene, &case.truth.unwrap());
        for (arithmetic, recording, bound) in [
            ("f64", computed::<f64>(scene, Accuracy::FAST), 1e-8),
            ("wide", computed::<Wide>(scene, Accuracy::WIDE), 1e-11),
        ] {
            let errors = errors(scene, truth, &recording);
            println!("{name} {arithmetic} {errors:?} {:?}", recording.work);
            let worst = errors.position.max(errors.velocity).max(errors.event);
            assert!(worst <= bound, "{name} {arithmetic}: {errors:?}");
        }
    }
}

/// What is claimed must be true: the error against truth stays below the claim at every
/// sample, and the claim is not idle.
#[test]
fn certified_digits_are_honest_against_truth() {
    let cases = CASES.iter().map(|name| Library::Embedded.case(name));
    let edges = EDGES.iter().map(|name| edges().case(name));
    for case in cases.chain(edges) {
        let case = case.unwrap();
        let (scene, truth) = (&case.scene, case.truth.unwrap());
        let certified = certified(scene, OPERATIONS).unwrap();
        let recording = &certified.recording;
        assert_eq!(recording.sample_count(), truth.sample_count());
        let (mut low, mut high) = (truth.sample(0)[0].position, truth.sample(0)[0].position);
        let mut fastest = 0.0_f64;
        let both = recording.samples().zip(truth.samples());
        for ((own, other), digits) in both.zip(&certified.digits) {
            for state in other {
                (low, high) = (low.inf(&state.position), high.sup(&state.position));
                fastest = fastest.max(state.velocity.norm());
            }
            let size = (high - low).norm();
            for (own, other) in own.iter().zip(other) {
                let position = (own.position - other.position).norm() / size;
                let velocity = (own.velocity - other.velocity).norm();
                let claimed = |digits: u8| 10.0_f64.powi(-i32::from(digits));
                assert!(
                    position <= claimed(digits.position),
                    "{}: {position:e}",
                    scene.name
                );
                assert!(
                    velocity <= claimed(digits.velocity) * fastest,
                    "{}",
                    scene.name
                );
            }
        }
        let last = certified.digits.last().unwrap();
        println!("{} {last:?}", scene.name);
        assert!(
            last.position >= 13 && last.velocity >= 13,
            "{}: {last:?}",
            scene.name
        );
    }
}

fn attraction(constant: f64) -> Option<Attraction> {
    Some(Attraction {
        constant,
        softening: 0.0,
    })
}

fn contact(restitution: f64) -> Option<Contact> {
    Some(Contact { restitution })
}

/// Every pair turns about its centre of mass for ever once it has collapsed: distance, energy
/// and angular momentum stay to rounding from then on.
#[test]
fn a_collapsed_pair_stays_in_contact() {
    let bodies = vec![
        body("a", 2.0, 0.4, [-1.1, 0.3, -0.7], [0.0, 0.3, 0.1]),
        body("b", 3.0, 0.5, [0.9, -0.4, 1.2], [0.1, -0.2, 0.0]),
    ];
    let effects = Effects {
        attraction: attraction(5.5),
        contact: contact(0.5),
        ..Effects::default()
    };
    let scene = scene(8.0, 0.0625, bodies, effects);
    let certified = certified(&scene, OPERATIONS).unwrap();
    let recording = &certified.recording;
    assert_eq!(recording.outcome, Outcome::Finished);
    let metrics = metrics(&scene, recording);
    let settled = &metrics[40..];
    let first = settled[0];
    for (at, states) in settled.iter().zip(recording.samples().skip(40)) {
        let distance = (states[0].position - states[1].position).norm();
        assert!((distance - 0.9).abs() < 1e-15, "{distance}");
        let energy = (at.total_energy() - first.total_energy()) / first.energy_scale();
        assert!(energy.abs() < 1e-14, "{energy:e}");
        let turn = (at.angular_momentum - metrics[0].angular_momentum).norm();
        assert!(
            turn < 1e-14 * metrics[0].angular_momentum.norm() * 10.0,
            "{turn:e}"
        );
    }
    let last = certified.digits.last().unwrap();
    assert!(last.position >= 13, "{last:?}");
}

/// A ball stands on the floor, another hangs above it on a stretched spring: pressed at first,
/// the lower one is lifted when the spring pulls with its weight. With no damper nothing
/// dissipates until it lands.
#[test]
fn a_ball_leaves_the_floor_when_the_spring_pulls() {
    let bodies = vec![
        body("low", 1.0, 0.5, [0.0, -4.5, 0.0], [0.0; 3]),
        body("high", 1.0, 0.5, [0.0, -3.5, 0.0], [0.0; 3]),
    ];
    let (k, g) = (100.0, 10.0);
    let effects = Effects {
        cushions: Some(Cushions {
            half_width: 9.0,
            half_length: 9.0,
            half_height: Some(5.0),
            restitution: 0.5,
        }),
        gravity: Some(Gravity {
            acceleration: [0.0, -g, 0.0],
        }),
        springs: vec![Spring {
            between: ["low".into(), "high".into()],
            stiffness: k,
            rest_length: 2.0,
            damping: 0.0,
        }],
        ..Effects::default()
    };
    let scene = scene(0.5, 0.0078125, bodies, effects);
    // About the balance of the upper one, 0.1 below the rest length, amplitude 0.9 and rate 10:
    // the stretch is -0.1 - 0.9 cos(10 t), and the pull outweighs the ball at a stretch of 0.1.
    let lift = (-0.2_f64 / 0.9).acos() / 10.0;
    for recording in [
        fast(&scene).unwrap(),
        certified(&scene, OPERATIONS).unwrap().recording,
    ] {
        assert_eq!(recording.outcome, Outcome::Finished);
        for (sample, states) in recording.samples().enumerate() {
            let time = scene.sample_time(sample);
            if time < lift {
                let high = -4.5 + 2.0 - 0.1 - 0.9 * (10.0 * time).cos();
                assert!((states[1].position.y - high).abs() < 1e-14);
                assert_eq!(states[0].position.y, -4.5);
            } else {
                assert!(states[0].position.y > -4.5, "at {time}");
            }
        }
        let metrics = metrics(&scene, &recording);
        let drift = Drift::of(&metrics, &Sizes::of(&recording, &metrics)).energy_drift_max;
        assert!(drift < 1e-14, "{drift:e}");
        assert!(recording.events.events().is_empty());
    }
}

/// The lecture's cluster: certified until an impact on a touching cluster lets the model
/// itself lose its single answer; from there on one of the answers, until the clump turns as
/// one rigid body.
#[test]
fn the_lectures_cluster_collapses() {
    let scene = Library::Embedded.case("cluster-8").unwrap().scene;
    let certified = certified(&scene, OPERATIONS).unwrap();
    assert_eq!(certified.recording.outcome, Outcome::Finished);
    let from = certified.undetermined.unwrap();
    assert!((1.7..1.9).contains(&from.time), "{from:?}");
    assert!(from.spread.unwrap() > 1e-3, "{from:?}");
    let determined = |sample: &usize| scene.sample_time(*sample) < from.time;
    let sure = (0..certified.digits.len()).take_while(determined).count();
    assert!(certified.digits[sure - 1].position >= 10);
    let whole = fast(&scene).unwrap();
    assert_eq!(whole.outcome, Outcome::Finished);
    let size = size_of(&whole);
    for (own, other) in whole
        .samples()
        .zip(certified.recording.samples())
        .take(sure)
    {
        for (own, other) in own.iter().zip(other) {
            assert!((own.position - other.position).norm() < 1e-6 * size);
        }
    }
    let at = metrics(&scene, &whole);
    let sizes = Sizes::of(&whole, &at);
    let drift = Drift::of(&at, &sizes);
    assert!(drift.max_penetration < 1e-12, "{drift:?}");
    assert!(drift.momentum_drift_max < 1e-12, "{drift:?}");
    let other = (
        &certified.recording,
        &*metrics(&scene, &certified.recording),
    );
    for facts in cluster_facts(&scene, &[(&whole, &at), other], &sizes).unwrap() {
        let clump = (facts.largest_clump, facts.bound_bodies);
        assert_eq!(clump, (8, 8), "{facts:?}");
    }
    let last = metrics(&scene, &whole).into_iter().rev().take(8);
    let kinetic: Vec<f64> = last.map(|at| at.total_energy()).collect();
    assert!((kinetic[0] / kinetic[7] - 1.0).abs() < 1e-12, "{kinetic:?}");
}

/// Half an ulp on every input moves a chaotic scene; the claim of the run itself concerns
/// the inputs as they are, so a third computation must stay within it.
#[test]
fn claims_hold_against_a_third_computation() {
    let third = Accuracy {
        order: 31,
        short_order: 9,
        step: 0.8,
        tolerance: 1e-26,
        bounce_height: 1e-26,
    };
    let mut counted = 0;
    for seed in 0..2 {
        let scene = cloud(seed);
        let certified = certified(&scene, OPERATIONS).unwrap();
        let shorter = Scene {
            duration: scene.sample_time(certified.recording.sample_count() - 1),
            ..scene.clone()
        };
        let other = ForcesSimulation::<Wide>::new(&shorter, third).unwrap();
        let other = drive(
            &shorter,
            "exact",
            &mut other.patient().limited(2_000_000_000),
        );
        let size = size_of(&certified.recording);
        let both = certified.recording.samples().zip(other.samples());
        for ((one, other), digits) in both.zip(&certified.digits) {
            for (one, other) in one.iter().zip(other) {
                let error = (one.position - other.position).norm() / size;
                let claimed = 10.0_f64.powi(-i32::from(digits.position));
                assert!(error <= claimed, "seed {seed}: {error:e} > {claimed:e}");
                counted += 1;
            }
        }
    }
    assert!(counted > 300, "{counted}");
}

/// Six spheres that fall together and collide, inelastically.
fn cloud(seed: u32) -> Scene {
    let bodies = (0..6_u32).map(|i| {
        let phase = |k: u32| f64::from((i * 7919 + seed * 104_729 + k * 1299) % 1000) / 1000.0;
        let turn = std::f64::consts::TAU * f64::from(i) / 6.0;
        let (radius, out) = (0.3 + 0.2 * phase(1), 2.0 + 0.5 * phase(2));
        let position = [out * turn.cos(), 0.6 * phase(3), out * turn.sin()];
        body(
            &format!("p{i}"),
            1.0 + 3.0 * phase(4),
            radius,
            position,
            [0.2 * phase(5), 0.1 * phase(6), -0.2 * phase(7)],
        )
    });
    let effects = Effects {
        attraction: attraction(2.0),
        contact: contact(0.4),
        ..Effects::default()
    };
    scene(2.0, 0.03125, bodies.collect(), effects)
}

#[test]
fn what_has_no_exact_meaning_is_refused_by_name() {
    let two = |distance: f64| {
        vec![
            body("left", 1.0, 0.5, [0.0; 3], [0.0; 3]),
            body("right", 1.0, 0.5, [distance, 0.0, 0.0], [0.0; 3]),
        ]
    };
    let effects = Effects {
        attraction: attraction(1.0),
        contact: contact(0.5),
        ..Effects::default()
    };
    let message = |scene: &Scene| fast(scene).unwrap_err().to_string();
    let deep = message(&scene(1.0, 0.5, two(0.75), effects.clone()));
    assert!(deep.contains("`left` and `right`, 2.5e-1 deep"), "{deep}");
    let resting = Effects {
        rest: Some(Rest { speed: 0.1 }),
        ..effects
    };
    let rest = message(&scene(1.0, 0.5, two(2.0), resting));
    assert!(rest.contains("rest together with attraction"), "{rest}");
}

/// Points that fall into each other, bodies at one place, bounces without loss: an end with
/// time and names, or a finish, but no panic and no endless loop.
#[test]
fn singular_scenes_end_with_time_and_bodies() {
    let points = |x: [f64; 3]| {
        vec![
            body("a", 1.0, 1e-3, [-0.5, 0.0, 0.0], [0.0; 3]),
            body("b", 1.0, 1e-3, x, [0.0; 3]),
        ]
    };
    let effects = Effects {
        attraction: attraction(1.0),
        ..Effects::default()
    };
    let falling = fast(&scene(4.0, 0.5, points([0.5, 0.0, 0.0]), effects.clone())).unwrap();
    let Outcome::Collapsed { time, a, b, reason } = falling.outcome else {
        panic!("{:?}", falling.outcome);
    };
    // Free fall of two unit masses from distance 1: pi/4 with G = 1.
    assert!((time - std::f64::consts::FRAC_PI_4).abs() < 1e-9, "{time}");
    assert_eq!((a, b), (0, Some(1)));
    assert_eq!(reason, CollapseReason::Singularity);
    let together = fast(&scene(4.0, 0.5, points([-0.5, 0.0, 0.0]), effects)).unwrap();
    assert!(matches!(together.outcome, Outcome::Collapsed { .. }));
    let elastic = Effects {
        attraction: attraction(1.0),
        contact: contact(1.0),
        ..Effects::default()
    };
    let bouncing = fast(&scene(4.0, 0.5, points([0.5, 0.0, 0.0]), elastic)).unwrap();
    assert_eq!(bouncing.outcome, Outcome::Finished);
    assert_eq!(bouncing.events.counts().contacts, 3);
}

/// Three in a row hit at once from both sides: the model's order decides, another order gives
/// another answer, and the recording says so and goes on.
#[test]
fn simultaneous_impacts_are_undetermined_and_go_on() {
    let ball = |name: &str, x: f64, v: f64| body(name, 1.0, 0.5, [x, 0.0, 0.0], [v, 0.0, 0.0]);
    let bodies = vec![
        ball("a", -2.0, 1.0),
        ball("b", 0.0, 0.0),
        ball("c", 2.0, -1.0),
    ];
    let effects = Effects {
        attraction: attraction(1e-3),
        contact: contact(0.5),
        ..Effects::default()
    };
    let scene = scene(1.5, 0.0625, bodies, effects);
    let certified = certified(&scene, OPERATIONS).unwrap();
    assert_eq!(certified.recording.outcome, Outcome::Finished);
    let undetermined = certified.undetermined.expect("two impacts at once");
    assert!((0.9..1.0).contains(&undetermined.time), "{undetermined:?}");
}

/// Diagonal of the box of all positions of a recording.
fn size_of(recording: &Recording) -> f64 {
    Sizes::of(recording, &[]).length
}

/// A hundred revolutions of e = 0.9 in doubles: the energy as asked for, with fewer passes
/// over the force law than the 9700 steps of IAS15 at 15 evaluations each.
#[test]
fn a_hundred_revolutions_keep_their_energy() {
    let scene = edges().case("kepler-e09-100").unwrap().scene;
    let recording = computed::<f64>(&scene, Accuracy::FAST);
    let energies: Vec<f64> = metrics(&scene, &recording)
        .iter()
        .map(|at| at.total_energy())
        .collect();
    // 9.5e-15 by the sum in double-double of the benchmark; this sum cancels 20-fold near the
    // near point, which adds rounding of 4e-15.
    for energy in &energies {
        let error = (energy / energies[0] - 1.0).abs();
        assert!(error < 2e-14, "{error:e}");
    }
    assert!(recording.work.force_evaluations < 9700 * 15);
}

/// A ball dropped on a floor bounces ever lower: after a fall of `t = sqrt(2 h/g)` each flight
/// lasts e times the one before, the first 2 e t, so that it lies still from `t (1 + e)/(1 - e)`.
#[test]
fn a_ball_comes_to_rest_on_the_floor() {
    let (g, e, radius) = (9.81, 0.6, 0.1);
    let bodies = vec![body("ball", 1.0, radius, [0.0; 3], [0.3, 0.0, 0.0])];
    let effects = Effects {
        cushions: Some(Cushions {
            half_width: 5.0,
            half_length: 5.0,
            half_height: Some(1.0),
            restitution: e,
        }),
        gravity: Some(Gravity {
            acceleration: [0.0, -g, 0.0],
        }),
        ..Effects::default()
    };
    let scene = scene(3.0, 0.0625, bodies, effects);
    let fall: f64 = (2.0 * (1.0 - radius) / g).sqrt();
    let height = |time: f64| {
        let (mut since, mut flight) = (time - fall, 2.0 * e * fall);
        if since < 0.0 {
            return -0.5 * g * time * time;
        }
        // Flights shorter than 1e-12 s rise less than 1e-23.
        while since >= flight && flight > 1e-12 {
            since -= flight;
            flight *= e;
        }
        let low = radius - 1.0;
        let up = 0.5 * g * (flight - since).max(0.0) * since;
        if flight > 1e-12 { low + up } else { low }
    };
    for recording in [
        fast(&scene).unwrap(),
        certified(&scene, OPERATIONS).unwrap().recording,
    ] {
        assert_eq!(recording.outcome, Outcome::Finished);
        for (sample, states) in recording.samples().enumerate() {
            let time = scene.sample_time(sample);
            let [x, y, z] = states[0].position.into();
            // Speeds of 4 m/s at times good to a few ulp of 2 s, here and there.
            assert!((y - height(time)).abs() < 1e-14, "{time}: {y}");
            assert!(
                (x - 0.3 * time).abs() < 1e-15 && z == 0.0,
                "{time}: {x} {z}"
            );
        }
        let last = recording.sample(scene.sample_count())[0];
        assert_eq!(last.velocity.y, 0.0);
        assert!(recording.sample_count() > 30 && fall * (1.0 + e) / (1.0 - e) < 2.0);
    }
}

/// Two bodies fall head-on from rest and bounce to rest on each other: every impact at the time
/// of Kepler's radial flight, and at the end of the series they lie together.
///
/// With `y = v² R/(2 mu)`, v the speed at distance R, the apex is `R/(1 - y)` and the way from
/// there to R takes `sqrt(r³/(2 mu)) (sqrt(y (1 - y)) + asin(sqrt y))`.
#[test]
fn a_falling_pair_bounces_to_rest_when_kepler_says() {
    let (g, masses, e) = (3.0, [2.0, 1.0], 0.6);
    let bodies = vec![
        body("a", masses[0], 0.3, [-1.0, 0.0, 0.0], [0.0; 3]),
        body("b", masses[1], 0.2, [1.0, 0.0, 0.0], [0.0; 3]),
    ];
    let effects = Effects {
        attraction: attraction(g),
        contact: contact(e),
        ..Effects::default()
    };
    let (mu, reach, apart) = (g * (masses[0] + masses[1]), 0.5, 2.0);
    let from_apex = |y: f64| {
        let apex: f64 = reach / (1.0 - y);
        (apex.powi(3) / (2.0 * mu)).sqrt() * ((y * (1.0 - y)).sqrt() + y.sqrt().asin())
    };
    let mut y: f64 = 1.0 - reach / apart;
    let mut time = from_apex(y);
    let mut times = Vec::new();
    for _ in 0..200 {
        times.push(time);
        y *= e * e;
        time += 2.0 * from_apex(y);
    }
    let scene = scene(3.0, 0.0625, bodies, effects);
    for recording in [
        fast(&scene).unwrap(),
        certified(&scene, OPERATIONS).unwrap().recording,
    ] {
        assert_eq!(recording.outcome, Outcome::Finished);
        // The last bounces are merged in the list, and lie within 1e-12 s of each other.
        let events = recording.events.events();
        assert!(events.len() >= 20, "{}", events.len());
        for (event, time) in events.iter().zip(&times).take(20) {
            // A few ulp of the largest time, twice or thrice at each bounce.
            assert!((event.time - time).abs() < 1e-14, "{} {time}", event.time);
        }
        let lying = (0..recording.sample_count()).filter(|n| scene.sample_time(*n) > time);
        assert!(lying.clone().count() > 10, "{time}");
        for states in lying.map(|sample| recording.sample(sample)) {
            let distance = (states[1].position - states[0].position).norm();
            // The pull of 24 and 12 m/s² and the contact's answer cancel to an ulp; over a second
            // of one step that leaves a few 1e-15 m/s and m.
            assert!((distance - reach).abs() < 1e-14, "{distance}");
            assert!(states.iter().all(|state| state.velocity.norm() < 1e-14));
        }
    }
}
