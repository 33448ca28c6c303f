//! What the plan costs: a step of the `lecture` engine against the same arithmetic as one
//! plain loop, written by hand for exactly the effects of the scene.
//! `cargo bench --bench lecture_step`
#![allow(missing_docs, clippy::cast_precision_loss)]

#[path = "support/paired.rs"]
mod paired;
#[path = "support/plain_loop.rs"]
mod plain_loop;

use std::hint::black_box;

use carom::engine::{ImpulseSimulation, StepGrid};
use plain_loop::{COMBINATIONS, Combination, Plain};

const STEPS: u64 = 500;

/// Work of a round: about 5 ms, whatever the number of pairs.
const ROUND_NS: u64 = 5_000_000;

const ROUNDS: usize = 101;

/// What A may cost over B: a share, or where a step is so short that the clock decides, a time.
const BAR: &str = "A/B up to 1.05, or 5 ns more";

fn main() {
    println!("a step: A lecture through the plan, B plain loop; bar: {BAR}, of the minima");
    let missed = COMBINATIONS
        .iter()
        .filter(|combination| !holds(combination));
    let missed: Vec<_> = missed.map(|combination| combination.name).collect();
    if !missed.is_empty() {
        println!("missed: {}", missed.join("; "));
    }
}

fn holds(combination: &Combination) -> bool {
    let scene = (combination.scene)();
    let grid = StepGrid::new(&scene, 0.01).expect("a step");
    let engine = ImpulseSimulation::new(&scene, grid);
    let plain = Plain::of(&scene);
    let pairs = scene.bodies.len() * scene.bodies.len() / 2;
    let repeat = ROUND_NS / (STEPS * (10 + 5 * pairs as u64)) + 1;
    let result = paired::paired(
        ROUNDS,
        (STEPS * repeat) as f64,
        || {
            for _ in 0..repeat {
                let mut run = black_box(&engine).clone();
                run.take_steps(STEPS);
                black_box(&run);
            }
        },
        || {
            for _ in 0..repeat {
                let mut run = black_box(&plain).clone();
                (combination.run)(&mut run, grid.step, STEPS);
                black_box(&run);
            }
        },
    );
    let (a, b) = (result.min_a_ns, result.min_b_ns);
    let holds = a <= 1.05 * b || a - b <= 5.0;
    let verdict = if holds { "held" } else { "missed" };
    println!(
        "{} ({} effects, {} bodies): {result}; {verdict}",
        combination.name,
        combination.effects,
        scene.bodies.len()
    );
    holds
}
