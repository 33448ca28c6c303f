//! What the tests of the study share.

use super::{BASE, BodiesOptions, BodiesPoint, BodiesStudy, Walls};
use crate::study::Machine;
use crate::study::{Timing, paired_ratio};

pub(crate) const SIZES: [usize; 8] = [4, 10, 30, 100, 300, 1000, 3000, 10_000];

/// Engines with steps of `factor * bodies^power` µs, with noise of 2 % in seven rounds.
pub(crate) fn study(laws: &[(&str, f64, f64)]) -> BodiesStudy {
    let dt = 0.01;
    let mut points = Vec::new();
    // Seven rounds of each engine at each size: other noise for each engine, around the same median.
    let rounds = |(place, bodies): (usize, usize)| -> (f64, Vec<f64>) {
        let (_, power, factor) = laws[place];
        #[allow(clippy::cast_precision_loss, reason = "ten thousand bodies")]
        let cost = 1e-3 / dt * factor * (bodies as f64).powf(power);
        let noise = if place % 2 == 0 { 0.01 } else { -0.02 };
        let noisy = (-3..=3).map(|round| cost * (1.0 + noise * f64::from(round)));
        (cost, noisy.collect())
    };
    for (place, (engine, _, _)) in laws.iter().enumerate() {
        for bodies in SIZES {
            let (cost, own) = rounds((place, bodies));
            let step_us = 1e3 * dt * cost;
            let base = laws.iter().position(|(name, _, _)| *name == BASE);
            let ratio = base.and_then(|base| paired_ratio(&own, &rounds((base, bodies)).1, 1));
            points.push(BodiesPoint {
                build: "default".to_owned(),
                engine: (*engine).to_owned(),
                bodies,
                dt: Some(dt),
                filling: 0.1,
                walls: Walls::Closed,
                seed: 1,
                step_us: Some(step_us),
                step_min_us: Some(0.94 * step_us),
                cost_ms_per_sim_s: Some(cost),
                steps: Some(32),
                force_evaluations: Some(0),
                pair_tests: Some(32),
                ratio: ratio.map(|ratio| ratio.median),
                ratio_low: ratio.map(|ratio| ratio.low),
                ratio_high: ratio.map(|ratio| ratio.high),
                outcome: "Finished".to_owned(),
                machine: "here".to_owned(),
            });
        }
    }
    BodiesStudy {
        options: BodiesOptions {
            sizes: SIZES.to_vec(),
            dt,
            filling: 0.1,
            walls: Walls::Closed,
            timing: Timing {
                seed: 1,
                repetitions: 7,
            },
            budget: 1,
        },
        machine: Machine::this(),
        build: "default".to_owned(),
        points,
        refusals: Vec::new(),
    }
}
