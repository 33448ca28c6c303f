//! What the tests of the study share.

use super::{BodiesOptions, BodiesPoint, BodiesStudy, Walls};
use crate::study::Timing;
use crate::study::cost::Machine;

pub(crate) const SIZES: [usize; 8] = [4, 10, 30, 100, 300, 1000, 3000, 10_000];

/// Engines with steps of `factor * bodies^power` µs, with noise of 2 % in seven rounds.
pub(crate) fn study(laws: &[(&str, f64, f64)]) -> BodiesStudy {
    let dt = 0.01;
    let mut points = Vec::new();
    for (place, (engine, power, factor)) in laws.iter().enumerate() {
        for bodies in SIZES {
            #[allow(clippy::cast_precision_loss, reason = "ten thousand bodies")]
            let step_us = factor * (bodies as f64).powf(*power);
            let cost = 1e-3 * step_us / dt;
            // Other noise for each engine, around the same median.
            let noise = if place % 2 == 0 { 0.01 } else { -0.02 };
            let rounds = (-3..=3).map(|round| cost * (1.0 + noise * f64::from(round)));
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
                outcome: "Finished".to_owned(),
                machine: "here".to_owned(),
                rounds: rounds.collect(),
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
