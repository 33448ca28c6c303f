//! Negative controls: a solver with one fault must fail a named check, and the same solver
//! without it must pass. The solver is the benchmark's plain loop, written again with faults.

use carom::physics::Vector3;

/// One deliberate fault.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    None,
    DropTheOne,
    SwapTheMasses,
    SkipThePushOut,
    ImpulseOnOneOnly,
    AlongTheVelocity,
}

#[derive(Debug, Clone, Copy)]
struct Sphere {
    x: Vector3,
    v: Vector3,
    m: f64,
    r: f64,
}

fn spheres(masses: [f64; 2]) -> [Sphere; 2] {
    let sphere = |x: [f64; 3], v: [f64; 3], m| Sphere {
        x: x.into(),
        v: v.into(),
        m,
        r: 0.5,
    };
    [
        sphere([-1.0, 0.2, -0.1], [3.0, 0.0, 0.4], masses[0]),
        sphere([0.8, 0.0, 0.1], [-0.5, 0.1, 0.0], masses[1]),
    ]
}

fn collide(pair: &mut [Sphere; 2], e: f64, fault: Fault) {
    let [a, b] = *pair;
    let apart = a.x - b.x;
    let distance = apart.norm();
    if distance >= a.r + b.r {
        return;
    }
    let mut n = apart / distance;
    if fault == Fault::AlongTheVelocity {
        n = (b.v - a.v).normalize();
    }
    let vr = (a.v - b.v).dot(&n);
    if vr < 0.0 {
        let one = if fault == Fault::DropTheOne { 0.0 } else { 1.0 };
        let j = -vr * (e + one) / (1.0 / a.m + 1.0 / b.m);
        let [m1, m2] = if fault == Fault::SwapTheMasses {
            [b.m, a.m]
        } else {
            [a.m, b.m]
        };
        pair[0].v += n * (j / m1);
        if fault != Fault::ImpulseOnOneOnly {
            pair[1].v -= n * (j / m2);
        }
    }
    if fault != Fault::SkipThePushOut {
        let out = n * (0.5 * (1.0 + e) * (a.r + b.r - distance));
        pair[0].x += out;
        pair[1].x -= out;
    }
}

/// Runs until the spheres have collided and are handled; gives before and after the impact.
fn impact(masses: [f64; 2], e: f64, fault: Fault) -> ([Sphere; 2], [Sphere; 2], Vector3) {
    let mut pair = spheres(masses);
    for _ in 0..1000 {
        for sphere in &mut pair {
            sphere.x += sphere.v * 0.01;
        }
        let before = pair;
        collide(&mut pair, e, fault);
        if pair[0].v != before[0].v {
            let n = (before[0].x - before[1].x).normalize();
            return (before, pair, n);
        }
    }
    panic!("the spheres never met");
}

const MASSES: [f64; 2] = [3.0, 1.0];

fn restitution_holds(fault: Fault) -> bool {
    let e = 0.5;
    let (before, after, n) = impact(MASSES, e, fault);
    let along = |pair: &[Sphere; 2]| (pair[0].v - pair[1].v).dot(&n);
    (along(&after) + e * along(&before)).abs() < 1e-12
}

fn momentum_holds(fault: Fault) -> bool {
    let (before, after, _) = impact(MASSES, 0.5, fault);
    let total = |pair: &[Sphere; 2]| pair[0].v * pair[0].m + pair[1].v * pair[1].m;
    (total(&after) - total(&before)).norm() < 1e-12
}

fn angular_momentum_holds(fault: Fault) -> bool {
    let (before, after, _) = impact(MASSES, 0.5, fault);
    // The impulses alone: positions as they were, before any push-out.
    let total = |pair: &[Sphere; 2]| {
        before[0].x.cross(&pair[0].v) * pair[0].m + before[1].x.cross(&pair[1].v) * pair[1].m
    };
    (total(&after) - total(&before)).norm() < 1e-12
}

fn spheres_are_apart(fault: Fault) -> bool {
    let (_, after, _) = impact(MASSES, 0.5, fault);
    (after[0].x - after[1].x).norm() >= after[0].r + after[1].r
}

type Check = fn(Fault) -> bool;

#[test]
fn each_fault_fails_its_check_and_a_sound_solver_none() {
    let checks: [(&str, Check); 4] = [
        ("restitution", restitution_holds),
        ("momentum", momentum_holds),
        ("angular momentum", angular_momentum_holds),
        ("penetration", spheres_are_apart),
    ];
    for (name, holds) in checks {
        assert!(holds(Fault::None), "{name} must hold for the sound solver");
    }
    let table = [
        (Fault::DropTheOne, "restitution"),
        (Fault::SwapTheMasses, "momentum"),
        (Fault::SkipThePushOut, "penetration"),
        (Fault::ImpulseOnOneOnly, "momentum"),
        (Fault::AlongTheVelocity, "angular momentum"),
    ];
    for (fault, caught_by) in table {
        let (_, holds) = checks.iter().find(|(name, _)| *name == caught_by).unwrap();
        assert!(!holds(fault), "{fault:?} must be caught by {caught_by}");
    }
}

/// The same four checks on the engine itself, which is what they are for.
#[test]
fn the_lecture_passes_the_same_checks() {
    use crate::scenes::{body, lecture, scene};
    use carom::scene::{Contact, Effects};

    let bodies = spheres(MASSES).map(|s| body("a", s.m, s.r, s.x.into(), s.v.into()));
    let [a, mut b] = bodies;
    b.name = "b".into();
    let effects = Effects {
        contact: Some(Contact { restitution: 0.5 }),
        ..Effects::default()
    };
    let scene = scene(0.64, 0.01, vec![a, b], effects);
    let recording = lecture(&scene, 0.01);
    let at = recording.events.events()[0].time;
    let sample = recording
        .samples()
        .enumerate()
        .find(|(n, _)| scene.sample_time(*n) >= at);
    let (sample, after) = sample.unwrap();
    let before = recording.sample(sample - 1);
    let (expected_before, expected_after, _) = impact(MASSES, 0.5, Fault::None);
    for (body, state) in after.iter().enumerate() {
        let moved = before[body].position + before[body].velocity * 0.01;
        assert!((moved - expected_before[body].x).norm() < 1e-14);
        assert!((state.velocity - expected_after[body].v).norm() < 1e-14);
        assert!((state.position - expected_after[body].x).norm() < 1e-14);
    }
}
