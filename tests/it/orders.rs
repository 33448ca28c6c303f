//! The rungs of the ladder converge as stated, against closed forms and the exact engine.

use carom::engine::exact::forces::{Accuracy, ForcesSimulation};
use carom::engine::{drive, engine, record};
use carom::recording::Recording;
use carom::scene::{Attraction, Contact, Drag, Effects, Gravity, Scene, Spring};

use crate::scenes::{body, scene};

/// A measured order may be off by this much.
const WITHIN: f64 = 0.15;

/// Slope of `log error` against `log dt`, by least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let count = f64::from(u32::try_from(points.len()).unwrap());
    let logs = || points.iter().map(|(dt, error)| (dt.ln(), error.ln()));
    let (mean_x, mean_y) = logs().fold((0.0, 0.0), |(x, y), (a, b)| (x + a / count, y + b / count));
    let products = logs()
        .map(|(x, y)| (x - mean_x) * (y - mean_y))
        .sum::<f64>();
    products / logs().map(|(x, _)| (x - mean_x).powi(2)).sum::<f64>()
}

/// Largest distance of a body from where it should be at the last sample.
fn error(found: &Recording, truth: &Recording) -> f64 {
    let last = truth.sample_count() - 1;
    let both = found.sample(last).iter().zip(truth.sample(last));
    both.map(|(own, other)| (own.position - other.position).norm())
        .fold(0.0, f64::max)
}

/// The order at which a rung converges on the exact answer, its error being the geometric mean
/// over these scenes, which differ in the phase at which the steps meet the impacts.
fn order(name: &str, scenes: &[Scene], steps: &[u32]) -> f64 {
    let spec = engine(name).unwrap();
    let truths: Vec<Recording> = scenes
        .iter()
        .map(|scene| {
            let mut exact = ForcesSimulation::<f64>::new(scene, Accuracy::FAST).unwrap();
            drive(scene, "exact", &mut exact)
        })
        .collect();
    let points: Vec<_> = steps
        .iter()
        .map(|count| {
            let logs = scenes.iter().zip(&truths).map(|(scene, truth)| {
                let dt = scene.sample_every / f64::from(*count);
                error(&record(scene, &spec, dt).unwrap(), truth).ln()
            });
            let mean = logs.sum::<f64>() / f64::from(u32::try_from(scenes.len()).unwrap());
            (1.0 / f64::from(*count), mean.exp())
        })
        .collect();
    println!("{name}: {points:?}");
    slope(&points)
}

fn assert_order(name: &str, scenes: &[Scene], steps: &[u32], stated: f64) {
    let found = order(name, scenes, steps);
    assert!(
        (found - stated).abs() < WITHIN,
        "{name}: order {found}, stated {stated}"
    );
}

fn orbit() -> Scene {
    let effects = Effects {
        attraction: Some(Attraction {
            constant: 1.0,
            softening: 0.0,
        }),
        ..Effects::default()
    };
    // Two thirds of the speed of the circle, so that distances vary.
    let bodies = vec![
        body("sun", 3.0, 0.01, [0.0; 3], [0.0, 0.1, 0.0]),
        body("planet", 1.0, 0.01, [2.0, 0.0, 0.0], [0.0, 0.2, 1.0]),
    ];
    scene(2.0, 1.0, bodies, effects)
}

fn damped() -> Scene {
    let effects = Effects {
        drag: Some(Drag { coefficient: 0.7 }),
        gravity: Some(Gravity {
            acceleration: [0.0, -3.0, 0.0],
        }),
        springs: vec![Spring {
            between: ["a".into(), "b".into()],
            stiffness: 4.0,
            rest_length: 1.0,
            damping: 0.6,
        }],
        ..Effects::default()
    };
    let bodies = vec![
        body("a", 2.0, 0.1, [0.0; 3], [0.5, 0.0, 0.3]),
        body("b", 1.0, 0.1, [1.7, 0.2, 0.0], [0.0, 0.4, -0.8]),
    ];
    scene(2.0, 1.0, bodies, effects)
}

/// Three bodies that attract and meet, obliquely and several times; the phase moves them.
fn meeting(phase: u32) -> Scene {
    let effects = Effects {
        attraction: Some(Attraction {
            constant: 3.0,
            softening: 0.0,
        }),
        contact: Some(Contact { restitution: 0.9 }),
        ..Effects::default()
    };
    let shift = 0.013 * f64::from(phase);
    let bodies = vec![
        body("a", 2.0, 0.3, [-1.5 - shift, 0.1, 0.0], [0.4, 0.0, 0.1]),
        body(
            "b",
            1.0,
            0.2,
            [1.2 + 0.7 * shift, 0.0, 0.1],
            [-0.5, 0.0, 0.0],
        ),
        body(
            "c",
            1.5,
            0.25,
            [0.1, 1.6 + 1.3 * shift, -0.2],
            [0.0, -0.7, 0.0],
        ),
    ];
    scene(1.75, 1.75, bodies, effects)
}

#[test]
fn rungs_converge_as_stated_where_nothing_collides() {
    for scene in [orbit(), damped()] {
        let scenes = [scene];
        let coarse = [64, 128, 256, 512, 1024];
        assert_order("lecture", &scenes, &coarse, 1.0);
        assert_order("exact-drag", &scenes, &coarse, 1.0);
        assert_order("verlet", &scenes, &coarse, 2.0);
        assert_order("swept", &scenes, &coarse, 2.0);
        assert_order("swept-4", &scenes, &[16, 32, 64, 128], 4.0);
    }
}

/// The tolerance of the adaptive rung is the fifth power of the step asked for; how much of it
/// an end gets is for the scene, so that the slope is looser.
#[test]
fn the_adaptive_rung_follows_its_tolerance() {
    for scene in [orbit(), damped()] {
        let found = order("adaptive", &[scene], &[2, 4, 8, 16, 32]);
        assert!((4.0..6.0).contains(&found), "{found}");
    }
}

/// A tolerance of 2.6e-20 of the size is below rounding: every step was rejected until it was a
/// thousandth. Now the seven stages of a step come about once a step.
#[test]
fn the_adaptive_rung_used_to_take_a_thousand_steps_for_one_below_rounding() {
    let scene = orbit();
    let recording = record(&scene, &engine("adaptive").unwrap(), 1.0 / 4096.0).unwrap();
    let work = recording.work;
    assert_eq!(work.steps, 8192);
    let stages = work.force_evaluations / work.steps;
    assert!((7..=14).contains(&stages), "{stages}");
}

/// Drag alone: `x = x0 + v0 (1 - exp(-c t))/c`. The lecture is of order 1, the decay exact.
#[test]
fn exact_drag_is_exact() {
    let effects = Effects {
        drag: Some(Drag { coefficient: 0.8 }),
        ..Effects::default()
    };
    let bodies = vec![body("a", 2.0, 0.1, [0.5, 0.0, 0.0], [3.0, -1.0, 0.0])];
    let scene = scene(2.0, 1.0, bodies, effects);
    let steps = [16, 32, 64, 128, 256];
    assert_order("lecture", std::slice::from_ref(&scene), &steps, 1.0);
    let path = -(-0.4_f64 * 2.0).exp_m1() / 0.4;
    for name in ["exact-drag", "verlet", "swept"] {
        let recording = record(&scene, &engine(name).unwrap(), 0.25).unwrap();
        let end = recording.sample(2)[0].position;
        // Eight steps, each of a few roundings.
        assert!((end.x - (0.5 + 3.0 * path)).abs() < 4e-15, "{name}: {end}");
    }
}

/// Impacts leave the order of the rungs that find their time; overlap-then-push loses it.
#[test]
fn swept_rungs_keep_their_order_through_impacts() {
    let scenes: Vec<Scene> = (0..12).map(meeting).collect();
    let exact = record(&scenes[0], &engine("exact-fast").unwrap(), 1.0).unwrap();
    assert!(exact.events.impacts().count() >= 3);
    let steps = [128, 256, 512, 1024, 2048];
    assert_order("swept", &scenes, &steps, 2.0);
    assert_order("swept-4", &scenes, &[64, 128, 256, 512], 4.0);
    for name in ["lecture", "verlet"] {
        let found = order(name, &scenes, &steps);
        assert!((0.7..1.3).contains(&found), "{name}: {found}");
    }
}
