//! What an event costs: gases of spheres, and a four-ball shot beside the lecture's solver.
//! `cargo bench --bench exact_flight`
#![allow(missing_docs, clippy::cast_precision_loss)]

#[path = "support/paired.rs"]
mod paired;
#[path = "support/reference_loop.rs"]
mod reference_loop;

use std::hint::black_box;
use std::time::Instant;

use carom::case::Library;
use carom::engine::exact::TieOrder;
use carom::engine::exact::flight::FlightSimulation;
use carom::engine::{ImpulseSimulation, Simulation, StepGrid};
use carom::scene::Scene;
use carom::scene::generate::Gas;

const ROUNDS: usize = 7;

/// A whole shot costs no more than a tenth of the lecture's at dt 1e-3.
const BAR_SHOT: &str = "A/B up to 1.00";

fn main() {
    let only = std::env::args().nth(1).unwrap_or_default();
    if only != "gas" {
        for name in ["shot-2-61", "shot-2-96", "billiards-a"] {
            shot(name);
        }
    }
    if only != "shot" {
        for cells in [6, 7, 14, 30] {
            gas(cells);
        }
    }
}

/// Collisions per second in equilibrium: a fifth of a collision time or more is run first.
fn gas(cells: usize) {
    let recipe = Gas {
        cells,
        filling: 0.49,
        seed: 1,
    };
    let mut scene = recipe.scene().expect("a gas");
    // About 200,000 collisions a round, however many spheres share them.
    scene.sample_every = 2.0e4 / scene.bodies.len() as f64;
    scene.duration = scene.sample_every * (ROUNDS + 1) as f64;
    let mut run = FlightSimulation::<f64>::new(&scene, TieOrder::Rule).expect("a run");
    run.advance_to(1, None);
    let (mut best, mut reference) = (f64::INFINITY, f64::INFINITY);
    for round in 2..=ROUNDS + 1 {
        let before = (run.event_count(), run.work().pair_tests);
        let seconds = timed(|| {
            run.advance_to(round, None);
        });
        let events = (run.event_count() - before.0) as f64;
        best = best.min(seconds / events);
        reference = reference.min(timed(|| reference_loop::work(200_000)) / 200_000.0);
        if round == ROUNDS + 1 {
            println!(
                "gas of {}: {:.3e} collisions/s, {:.0} ns each, {:.1} pairs looked at; reference loop {:.0} ns",
                scene.bodies.len(),
                1.0 / best,
                1e9 * best,
                (run.work().pair_tests - before.1) as f64 / events,
                1e9 * reference
            );
        }
    }
}

/// A whole shot with all its events until everything rests, without a log.
fn shot(name: &str) {
    let scene = Library::Embedded.case(name).expect("a case").scene;
    let grid = StepGrid::new(&scene, 1e-3).expect("a step");
    let lecture = ImpulseSimulation::new(&scene, grid);
    let result = paired::paired(
        21,
        50.0,
        || {
            for _ in 0..50 {
                black_box(whole(&scene));
            }
        },
        || {
            for _ in 0..50 {
                let mut run = black_box(&lecture).clone();
                run.take_steps(grid.steps_per_sample * scene.sample_count() as u64 / 10);
                black_box(&run);
            }
        },
    );
    let events = whole(&scene).event_count();
    println!(
        "{name}, {events} events: A exact, whole; B lecture at dt 1e-3, a tenth of it: {result}; bar: {BAR_SHOT}"
    );
}

fn whole(scene: &Scene) -> FlightSimulation<f64> {
    let mut run = FlightSimulation::new(scene, TieOrder::Rule).expect("a run");
    run.advance_to(scene.sample_count(), None);
    run
}

fn timed(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}
