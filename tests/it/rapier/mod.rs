//! The Rapier engines: impacts, events, forces, and what happens to numbers out of range.

mod impacts;
mod range;
mod repeat;
mod settings;
mod worlds;

use carom::engine::{engine, record};
use carom::physics::BodyState;
use carom::recording::Recording;
use carom::scene::{Body, Contact, Cushions, Effects, LengthUnit, Scene, Spring, Units};

const RAPIER: [&str; 4] = ["rapier", "rapier-f64", "rapier-matched", "rapier-tuned"];

/// Allowed error of a speed ratio or impulse: the bounds, 1e-6 in 64 bits and 1e-4 in 32.
/// Measured: 5e-16 and 3e-7, a few roundings of velocities.
fn tolerance(name: &str) -> f64 {
    if name == "rapier" { 1e-4 } else { 1e-6 }
}

fn body(name: &str, mass: f64, radius: f64, x: f64, vx: f64) -> Body {
    let (position, velocity) = ([x, 0.0, 0.0], [vx, 0.0, 0.0]);
    Body {
        name: name.into(),
        mass,
        radius,
        position,
        velocity,
    }
}

fn scene(duration: f64, bodies: Vec<Body>) -> Scene {
    Scene {
        name: "test".into(),
        title: None,
        source: None,
        watch: None,
        duration,
        sample_every: duration / 10.0,
        units: Units {
            length: LengthUnit::Metre,
        },
        bodies,
        effects: Effects::default(),
    }
}

fn run(scene: &Scene, name: &str, dt: f64) -> Recording {
    record(scene, &engine(name).unwrap(), dt).unwrap()
}

fn last(recording: &Recording) -> &[BodyState] {
    recording.sample(recording.sample_count() - 1)
}

fn box_of(half: f64, restitution: f64) -> Cushions {
    Cushions {
        half_width: half,
        half_length: half,
        half_height: None,
        restitution,
    }
}

fn spring(stiffness: f64, rest_length: f64, damping: f64) -> Vec<Spring> {
    vec![Spring {
        between: ["a".into(), "b".into()],
        stiffness,
        rest_length,
        damping,
    }]
}

/// Ball a, of `mass_ratio` times the mass, runs into ball b, which stands.
fn head_on(unit: LengthUnit, speed: f64, mass_ratio: f64, restitution: f64) -> Scene {
    let r = 0.04075 * unit.per_metre();
    let duration = 16.0 * r / speed;
    let (a, b) = (
        body("a", 0.16 * mass_ratio, r, 0.0, speed),
        body("b", 0.16, r, 5.3 * r, 0.0),
    );
    let mut scene = scene(duration, vec![a, b]);
    scene.units.length = unit;
    scene.effects.contact = Some(Contact { restitution });
    scene
}
