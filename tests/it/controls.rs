//! Negative controls: four named checks of one impact, which take any solver.
//!
//! The same checks run on the `lecture` engine, on a sound copy of its impact, and on that copy
//! with one fault each, where the named check must fail: a check that no fault can fail says
//! nothing about the engine either.

use carom::engine::{engine, record};
use carom::physics::Vector3;
use carom::scene::{Contact, Effects, Scene};

use crate::scenes::{body, scene};

const DT: f64 = 0.01;

/// A sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sphere {
    position: Vector3,
    velocity: Vector3,
    mass: f64,
    radius: f64,
}

/// Two spheres about to meet.
#[derive(Debug, Clone, Copy)]
struct Setup {
    spheres: [Sphere; 2],
    restitution: f64,
}

/// What a solver made of the step in which the two met: moved but not yet handled, and handled.
#[derive(Debug, Clone, Copy)]
struct Impact {
    before: [Sphere; 2],
    after: [Sphere; 2],
    /// From b to a, as they lay before.
    normal: Vector3,
}

/// Anything that carries two spheres through their impact.
type Solver<'a> = &'a dyn Fn(&Setup) -> Impact;

impl Impact {
    fn new(before: [Sphere; 2], after: [Sphere; 2]) -> Self {
        let normal = (before[0].position - before[1].position).normalize();
        Self {
            before,
            after,
            normal,
        }
    }

    /// Sum of m |v| before: the scale of what may be lost to rounding.
    fn scale(&self) -> f64 {
        self.before.iter().map(|s| s.mass * s.velocity.norm()).sum()
    }
}

/// Off-centre in three dimensions; elastic or not; unequal masses, since a swap of equal ones
/// is no fault.
fn setups() -> Vec<Setup> {
    let sphere = |position: [f64; 3], velocity: [f64; 3], mass, radius| Sphere {
        position: position.into(),
        velocity: velocity.into(),
        mass,
        radius,
    };
    let mut setups = Vec::new();
    for restitution in [0.1, 0.5, 1.0] {
        for masses in [[3.0, 1.0], [0.2, 5.0]] {
            let spheres = [
                sphere([-1.0, 0.2, -0.1], [3.0, 0.0, 0.4], masses[0], 0.5),
                sphere([0.8, 0.0, 0.1], [-0.5, 0.1, 0.0], masses[1], 0.4),
            ];
            setups.push(Setup {
                spheres,
                restitution,
            });
        }
    }
    setups
}

// The checks. Each is rounding alone: a dozen operations on numbers of the scale, 1e-15 of it
// each, so 1e-13 of the scale.

const ROUNDING: f64 = 1e-13;

/// `v_n' = -e v_n` along the line of centres.
fn restitution(impact: &Impact, e: f64) -> bool {
    let along = |pair: &[Sphere; 2]| (pair[0].velocity - pair[1].velocity).dot(&impact.normal);
    let [before, after] = [along(&impact.before), along(&impact.after)];
    (after + e * before).abs() < ROUNDING * before.abs()
}

/// `sum m v` is the same before and after.
fn momentum(impact: &Impact, _: f64) -> bool {
    let total = |pair: &[Sphere; 2]| pair.iter().map(|s| s.velocity * s.mass).sum::<Vector3>();
    (total(&impact.after) - total(&impact.before)).norm() < ROUNDING * impact.scale()
}

/// `sum m x × v` is the same before and after the impulses alone, at the positions before: the
/// push-out moves the centres by the same length whatever the masses and does not keep it.
fn angular_momentum(impact: &Impact, _: f64) -> bool {
    let total = |pair: &[Sphere; 2]| {
        let arms = impact.before.iter().map(|s| s.position);
        let turns = arms.zip(pair).map(|(x, s)| x.cross(&s.velocity) * s.mass);
        turns.sum::<Vector3>()
    };
    (total(&impact.after) - total(&impact.before)).norm() < ROUNDING * impact.scale()
}

/// They overlapped and no longer do.
fn penetration(impact: &Impact, _: f64) -> bool {
    let gap = |[a, b]: &[Sphere; 2]| (a.position - b.position).norm() - a.radius - b.radius;
    gap(&impact.before) < 0.0 && gap(&impact.after) >= 0.0
}

type Check = fn(&Impact, f64) -> bool;

const CHECKS: [(&str, Check); 4] = [
    ("restitution", restitution),
    ("momentum", momentum),
    ("angular momentum", angular_momentum),
    ("penetration", penetration),
];

/// The names of the checks that a solver fails on one setup.
fn failed(solver: Solver, setup: &Setup) -> Vec<&'static str> {
    let impact = solver(setup);
    let fails = |(_, holds): &&(&str, Check)| !holds(&impact, setup.restitution);
    CHECKS.iter().filter(fails).map(|(name, _)| *name).collect()
}

// The solvers.

fn scene_of(setup: &Setup) -> Scene {
    let bodies = setup.spheres.iter().zip(["a", "b"]).map(|(s, name)| {
        let [position, velocity] = [s.position, s.velocity].map(Into::into);
        body(name, s.mass, s.radius, position, velocity)
    });
    let effects = Effects {
        contact: Some(Contact {
            restitution: setup.restitution,
        }),
        ..Effects::default()
    };
    scene(64.0 * DT, DT, bodies.collect(), effects)
}

/// The engine itself, recorded step by step. Where nothing pulls, a sphere moves by `dt v`
/// before the step looks for contacts.
fn lecture(setup: &Setup) -> Impact {
    let scene = scene_of(setup);
    let recording = record(&scene, &engine("lecture").unwrap(), DT).unwrap();
    let steps = recording.work.steps as usize;
    assert_eq!(steps, scene.sample_count(), "one sample a step");
    let spheres = |sample: usize| {
        let mut spheres = setup.spheres;
        for (sphere, state) in spheres.iter_mut().zip(recording.sample(sample)) {
            (sphere.position, sphere.velocity) = (state.position, state.velocity);
        }
        spheres
    };
    let met = (1..=steps).find(|n| spheres(*n)[0].velocity != spheres(n - 1)[0].velocity);
    let met = met.expect("the spheres never met");
    let mut before = spheres(met - 1);
    for sphere in &mut before {
        sphere.position += sphere.velocity * DT;
    }
    Impact::new(before, spheres(met))
}

/// One deliberate fault.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    DropTheOne,
    SwapTheMasses,
    SkipThePushOut,
    ImpulseOnOneOnly,
    AlongTheVelocity,
}

/// The engine's impact written again, sound or with one fault.
fn copy(setup: &Setup, fault: Option<Fault>) -> Impact {
    let mut pair = setup.spheres;
    for _ in 0..64 {
        for sphere in &mut pair {
            sphere.position += sphere.velocity * DT;
        }
        let before = pair;
        collide(&mut pair, setup.restitution, fault);
        if pair[0].velocity != before[0].velocity {
            return Impact::new(before, pair);
        }
    }
    panic!("the spheres never met");
}

fn collide(pair: &mut [Sphere; 2], e: f64, fault: Option<Fault>) {
    let has = |this: Fault| fault == Some(this);
    let [a, b] = *pair;
    let apart = a.position - b.position;
    let distance = apart.norm();
    if distance >= a.radius + b.radius {
        return;
    }
    let mut n = apart / distance;
    if has(Fault::AlongTheVelocity) {
        n = (b.velocity - a.velocity).normalize();
    }
    let vr = (a.velocity - b.velocity).dot(&n);
    if vr < 0.0 {
        let one = if has(Fault::DropTheOne) { 0.0 } else { 1.0 };
        let j = -vr * (e + one) / (1.0 / a.mass + 1.0 / b.mass);
        let [m1, m2] = if has(Fault::SwapTheMasses) {
            [b.mass, a.mass]
        } else {
            [a.mass, b.mass]
        };
        pair[0].velocity += n * (j / m1);
        if !has(Fault::ImpulseOnOneOnly) {
            pair[1].velocity -= n * (j / m2);
        }
    }
    if !has(Fault::SkipThePushOut) {
        let out = n * (0.5 * (1.0 + e) * (a.radius + b.radius - distance));
        pair[0].position += out;
        pair[1].position -= out;
    }
}

#[test]
fn the_lecture_passes_every_check() {
    for setup in setups() {
        assert_eq!(failed(&lecture, &setup), [""; 0], "{setup:?}");
    }
}

#[test]
fn a_sound_copy_passes_every_check() {
    for setup in setups() {
        let sound: Solver = &|setup| copy(setup, None);
        assert_eq!(failed(sound, &setup), [""; 0], "{setup:?}");
    }
}

/// The faults are the engine's own only if the copy without them is the engine.
///
/// A dozen operations on numbers up to 4, half an ulp of 4 (4.4e-16) each.
#[test]
fn the_sound_copy_is_the_lecture() {
    for setup in setups() {
        let [engine, copy] = [lecture(&setup), copy(&setup, None)];
        let pairs = [(engine.before, copy.before), (engine.after, copy.after)];
        for (a, b) in pairs.iter().flat_map(|(a, b)| a.iter().zip(b)) {
            assert!((a.position - b.position).norm() < 1e-14, "{a:?} {b:?}");
            assert!((a.velocity - b.velocity).norm() < 1e-14, "{a:?} {b:?}");
        }
    }
}

#[test]
fn each_fault_fails_its_check() {
    let table = [
        (Fault::DropTheOne, "restitution"),
        (Fault::SwapTheMasses, "momentum"),
        (Fault::SkipThePushOut, "penetration"),
        (Fault::ImpulseOnOneOnly, "momentum"),
        (Fault::AlongTheVelocity, "angular momentum"),
    ];
    for (fault, check) in table {
        for setup in setups() {
            let faulty: Solver = &|setup| copy(setup, Some(fault));
            let failed = failed(faulty, &setup);
            assert!(
                failed.contains(&check),
                "{fault:?} must fail {check}, failed {failed:?}: {setup:?}"
            );
        }
    }
}
