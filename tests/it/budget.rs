//! A bound on the counted work bounds the time: what takes long is counted, and the count is
//! looked at where it grows.

use carom::engine::{engine, record, record_within};
use carom::recording::Outcome;
use carom::scene::{Attraction, Body, Contact, Cushions, Effects, Gravity, Scene, Spring};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

use crate::scenes::{body, scene};

/// Balls that overlap deeply, in a box too small for them or in an open heap, with or without a
/// pull, of equal or of unlike masses; small and fast, so that each of a few steps is full.
fn jam(seed: u64) -> Scene {
    let mut random = Pcg64::seed_from_u64(seed);
    #[allow(clippy::cast_precision_loss, reason = "53 bits fit")]
    let mut within = |low: f64, high: f64| {
        low + (high - low) * ((random.next_u64() >> 11) as f64 * 2f64.powi(-53))
    };
    #[allow(clippy::cast_possible_truncation, reason = "10 to 60")]
    #[allow(clippy::cast_sign_loss, reason = "10 to 60")]
    let count = within(10.0, 61.0) as usize;
    let [mixed, boxed, pulled, attracted, tied] =
        [0.5, 0.7, 0.7, 0.2, 0.2].map(|share| within(0.0, 1.0) < share);
    let spread = within(1.0, 3.0);
    let bodies: Vec<Body> = (0..count)
        .map(|place| {
            let mass = if mixed {
                10f64.powf(within(-3.0, 3.0))
            } else {
                1.0
            };
            let radius = if mixed { within(0.3, 1.0) } else { 0.8 };
            let position = [(); 3].map(|()| within(-spread, spread));
            let velocity = [(); 3].map(|()| within(-30.0, 30.0));
            body(&format!("b{place}"), mass, radius, position, velocity)
        })
        .collect();
    let restitution = [0.0, 0.1, 0.5, 0.9, 1.0][seed as usize % 5];
    let effects = Effects {
        contact: Some(Contact { restitution }),
        cushions: boxed.then(|| Cushions {
            half_width: within(1.5, 4.0),
            half_length: within(1.5, 4.0),
            half_height: (within(0.0, 1.0) < 0.7).then(|| within(1.1, 4.0)),
            restitution,
        }),
        gravity: pulled.then(|| Gravity {
            acceleration: [0.0, -(10f64.powf(within(0.0, 5.0))), 0.0],
        }),
        attraction: attracted.then_some(Attraction {
            constant: 5.0,
            softening: 0.1,
        }),
        springs: (1..if tied { count } else { 0 })
            .map(|place| Spring {
                between: [format!("b{}", place - 1), format!("b{place}")],
                stiffness: 100.0,
                rest_length: 1.0,
                damping: 1.0,
            })
            .collect(),
        ..Effects::default()
    };
    let mut scene = scene(0.1, 0.01, bodies, effects);
    scene.name = format!("jam-{seed}");
    scene
}

/// A budget used to be looked at between samples, and did not count what impacts solved together
/// take: 36 balls computed for minutes at a thousandth of theirs.
#[test]
fn a_spent_budget_ends_a_jam_within_its_step() {
    let robust = engine("robust").unwrap();
    let mut spent = 0;
    for seed in 0..20 {
        let scene = jam(seed);
        let budget = 300_000;
        let recording = record_within(&scene, &robust, 0.01, budget).unwrap();
        let total = recording.work.total();
        // What is done between two looks at the count: a round for 60 balls and 300 touches, whose
        // matrix takes 9e4 entries of some ten operations, ten to a unit, and a few solutions.
        assert!(total < budget + 300_000, "{}: {total}", scene.name);
        if matches!(recording.outcome, Outcome::BudgetSpent { .. }) {
            spent += 1;
        } else {
            assert!(total <= budget, "{}: {total}", scene.name);
        }
    }
    assert!(spent >= 10, "{spent}");
}

/// The plain engines look at the count in every step, too.
#[test]
fn a_spent_budget_ends_the_lecture_between_samples() {
    let mut scene = jam(0);
    (scene.duration, scene.sample_every) = (1000.0, 500.0);
    let lecture = engine("lecture").unwrap();
    let recording = record_within(&scene, &lecture, 0.001, 100_000).unwrap();
    assert!(matches!(recording.outcome, Outcome::BudgetSpent { .. }));
    assert!(recording.work.total() < 102_000);
    assert_eq!(recording.sample_count(), 1);
}

/// Nominal time of a unit of work of `robust`, ns; a budget may take three times as long.
#[cfg(target_os = "linux")]
const UNIT_NS: f64 = 10.0;

/// Time that the processor gave to this thread, ns.
#[cfg(target_os = "linux")]
fn processor_ns() -> u64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    told.split(' ').next().unwrap().parse().unwrap()
}

/// Times what a unit of work takes, over hostile scenes and jams. In an optimized build on a
/// machine of any load no scene takes longer than three times the nominal time.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "times, of an optimized build: CARGO_PROFILE_DEV_OPT_LEVEL=3 cargo test --test it -- --ignored --nocapture units_of_work"]
fn units_of_work_take_the_time_they_stand_for() {
    let robust = engine("robust").unwrap();
    let hostile = crate::hostile::drawn(2000).into_iter().zip(0..);
    let hostile = hostile.map(|((mut scene, dt), place)| {
        scene.name = format!("hostile-{place}");
        (scene, dt)
    });
    let jams = (0..200).map(|seed| (jam(seed), 0.01));
    let mut rates = Vec::new();
    for (scene, dt) in hostile.chain(jams) {
        let begin = processor_ns();
        let recording = record_within(&scene, &robust, dt, 50_000_000).unwrap();
        #[allow(clippy::cast_precision_loss, reason = "some billions")]
        let [took, units] = [processor_ns() - begin, recording.work.total()].map(|it| it as f64);
        let took = 1e-9 * took;
        // The time is told in ticks of 4 ms.
        if took > 0.04 {
            rates.push((1e9 * took / units, took, units, scene.name.clone()));
        }
    }
    rates.sort_by(|one, other| one.0.total_cmp(&other.0));
    let shown = rates.iter().take(5).chain(rates.iter().rev().take(12));
    for (rate, took, units, name) in shown {
        println!("{name}: {rate:.2} ns a unit, {units:e} units, {took:.3} s");
    }
    let middle = rates[rates.len() / 2].0;
    println!(
        "{} runs of 40 ms and more, half below {middle:.2} ns a unit",
        rates.len()
    );
    assert!(rates.last().unwrap().0 < 3.0 * UNIT_NS);
}

/// The plain case costs what it did: counting changes no number.
#[test]
fn a_budget_that_is_not_spent_changes_nothing() {
    let robust = engine("robust").unwrap();
    let mut scene = jam(3);
    scene.duration = 0.02;
    let free = record(&scene, &robust, 0.01).unwrap();
    let bounded = record_within(&scene, &robust, 0.01, free.work.total()).unwrap();
    assert_eq!(free.digest(), bounded.digest());
    assert_eq!(free.work, bounded.work);
}
