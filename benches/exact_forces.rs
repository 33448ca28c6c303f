//! The `exact` engine with forces: a Kepler orbit of e = 0.9 over 100 revolutions, with its
//! energy error and passes over the force law, and the lecture's cluster, run to its end.
//! `cargo bench --bench exact_forces`
#![allow(missing_docs)]

#[path = "support/paired.rs"]
mod paired;

use std::hint::black_box;
use std::time::Instant;

use carom::case::Library;
use carom::engine::Simulation;
use carom::engine::exact::forces::{Accuracy, ForcesSimulation, Real, Wide};
use carom::recording::initial_states;
use carom::scene::Scene;

/// Steps that REBOUND's IAS15 takes for the same orbit, and its least evaluations a step: seven
/// nodes, two rounds of the corrector, one at the start.
const IAS15: (u64, u64) = (9700, 15);

fn main() {
    let edges = Library::Folder(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/forces").into());
    let orbit = edges.case("kepler-e09-100").expect("a case").scene;
    kepler::<f64>("f64", &orbit, Accuracy::FAST);
    kepler::<Wide>("double-double", &orbit, Accuracy::WIDE);
    println!(
        "IAS15, for comparison: {} steps, {} evaluations and more",
        IAS15.0,
        IAS15.0 * IAS15.1
    );
    let rounds = paired::paired(
        9,
        1.0,
        || run::<f64>(&orbit, Accuracy::FAST),
        || run::<Wide>(&orbit, Accuracy::WIDE),
    );
    println!("100 revolutions: A f64, B double-double: {rounds}");
    {
        let name = "cluster-8";
        let scene = Library::Embedded.case(name).expect("a case").scene;
        let best = (0..5)
            .map(|_| {
                let start = Instant::now();
                run::<f64>(&scene, Accuracy::FAST);
                start.elapsed().as_secs_f64()
            })
            .fold(f64::INFINITY, f64::min);
        println!("{name}, f64: {best:.3} s, least of 5");
    }
}

fn run<T: Real>(scene: &Scene, accuracy: Accuracy) {
    let mut simulation = ForcesSimulation::<T>::new(black_box(scene), accuracy).expect("a scene");
    black_box(simulation.advance_to(scene.sample_count(), None));
}

/// Prints the largest relative error of the energy over all samples, and the work.
fn kepler<T: Real>(arithmetic: &str, scene: &Scene, accuracy: Accuracy) {
    let mut simulation = ForcesSimulation::<T>::new(scene, accuracy).expect("a scene");
    let mut states = initial_states(scene);
    let start = energy(scene, &states);
    let mut worst = 0.0_f64;
    for sample in 1..=scene.sample_count() {
        simulation.advance_to(sample, None);
        simulation.state_into(&mut states);
        worst = worst.max((energy(scene, &states) / start - 1.0).abs());
    }
    let work = simulation.work();
    println!(
        "{arithmetic}: energy error {worst:.1e}, {} steps, {} passes over the force law",
        work.steps, work.force_evaluations
    );
}

/// Energy of the relative motion, in double-double so that the sum adds no rounding.
fn energy(scene: &Scene, states: &[carom::physics::BodyState]) -> f64 {
    let attraction = scene.effects.attraction.expect("attraction");
    let [m0, m1] = [scene.bodies[0].mass, scene.bodies[1].mass].map(Wide::from_f64);
    let between = |of: fn(&carom::physics::BodyState) -> [f64; 3]| {
        let [a, b] = [of(&states[0]), of(&states[1])].map(|v| v.map(Wide::from_f64));
        let square = |axis: usize| (b[axis] - a[axis]) * (b[axis] - a[axis]);
        square(0) + square(1) + square(2)
    };
    let speed_squared = between(|state| state.velocity.into());
    let distance = between(|state| state.position.into()).sqrt();
    let reduced = m0 * m1 / (m0 + m1);
    let kinetic = (reduced * speed_squared).times(0.5);
    let potential = Wide::from_f64(attraction.constant) * m0 * m1 / distance;
    (kinetic - potential).to_f64()
}
