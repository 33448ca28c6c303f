//! What a step costs, and what a simulated second takes, in rows of the page.

use super::price_table::Row;
use crate::engine::DEFAULT_DT;
use crate::report::engineering;
use crate::report::overhead::overhead_cells;
use crate::study::cost::{CostPoint, SceneCost};

/// Steps, forces and pairs of a simulated second: each engine as it comes, with the largest step
/// up to the default one.
pub(super) fn work_rows(cost: &SceneCost) -> Vec<Row> {
    let row = |engine: &str| {
        let usual = |point: &&CostPoint| point.dt.is_none_or(|dt| dt <= DEFAULT_DT);
        let mut points = cost.stock(engine).filter(|point| point.price.is_some());
        let point = points.find(usual)?;
        let work = cost.work_per_sim_s(point)?;
        let step = point.dt.map_or("none".to_owned(), engineering);
        let counts = work.map(engineering);
        Some(Row {
            engine: engine.to_owned(),
            cells: [step].into_iter().chain(counts).collect(),
        })
    };
    let engines = cost.engines.iter();
    engines
        .filter_map(|engine| row(&engine.spec.name))
        .collect()
}

/// What a step of each engine costs with the first body alone and with all, and its parts.
pub(super) fn step_rows(cost: &SceneCost) -> Vec<Row> {
    let rows = cost.step_costs.iter().map(|step| {
        let ends = [step.steps_us.first(), step.steps_us.last()];
        let ends = ends.map(|end| match end {
            Some((bodies, step_us)) => format!("{} ({bodies})", engineering(1e3 * step_us)),
            None => "–".to_owned(),
        });
        let parts = overhead_cells(step.overhead.as_ref());
        Row {
            engine: step.engine.clone(),
            cells: ends.into_iter().chain(parts).collect(),
        }
    });
    rows.collect()
}
