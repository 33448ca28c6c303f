//! Scenes that several tests share.

use carom::compare::{Drift, Sizes, metrics};
use carom::engine::{engine, record};
use carom::recording::Recording;
use carom::scene::{Attraction, Body, Contact, Effects, Scene, Units};

pub fn body(name: &str, mass: f64, radius: f64, position: [f64; 3], velocity: [f64; 3]) -> Body {
    Body {
        name: name.into(),
        mass,
        radius,
        position,
        velocity,
    }
}

pub fn scene(duration: f64, sample_every: f64, bodies: Vec<Body>, effects: Effects) -> Scene {
    Scene {
        name: "test".into(),
        title: None,
        source: None,
        watch: None,
        duration,
        sample_every,
        units: Units::default(),
        bodies,
        effects,
    }
}

/// Two spheres that meet obliquely in three dimensions.
pub fn oblique(restitution: f64, masses: [f64; 2]) -> Scene {
    let bodies = vec![
        body("a", masses[0], 0.5, [-2.0, 0.1, -0.2], [2.5, 0.0, 0.3]),
        body("b", masses[1], 0.4, [1.5, -0.1, 0.2], [-1.0, 0.2, 0.0]),
    ];
    let effects = Effects {
        contact: Some(Contact { restitution }),
        ..Effects::default()
    };
    scene(2.0, 0.125, bodies, effects)
}

/// A cluster that attracts and collides, from the lecture's generator.
pub fn cluster(count: usize, seed: u64, restitution: f64) -> Scene {
    let recipe = carom::scene::generate::Cluster {
        count,
        seed,
        extent: 12.0,
        ..Default::default()
    };
    let mut scene = recipe.scene().unwrap();
    scene.effects.contact = Some(Contact { restitution });
    scene.effects.attraction = Some(Attraction {
        constant: 5.5,
        softening: 0.0,
    });
    scene
}

pub fn lecture(scene: &Scene, dt: f64) -> Recording {
    record(scene, &engine("lecture").unwrap(), dt).unwrap()
}

/// Largest distance of one body between two recordings of the same shape.
pub fn apart(a: &Recording, b: &Recording) -> f64 {
    assert_eq!(a.sample_count(), b.sample_count());
    let pairs = a
        .samples()
        .zip(b.samples())
        .flat_map(|(a, b)| a.iter().zip(b));
    pairs
        .map(|(a, b)| (a.position - b.position).norm())
        .fold(0.0, f64::max)
}

/// Largest change of the total momentum, as a share of the largest sum of m |v|.
pub fn momentum_drift(scene: &Scene, recording: &Recording) -> f64 {
    let metrics = metrics(scene, recording);
    Drift::of(&metrics, &Sizes::of(recording, &metrics)).momentum_drift_max
}
