//! `cost.csv`, `work.csv` and `orders.csv`: every point once, drawn and judged afterwards.

use std::io::{self, Write};

use serde::Serialize;

use crate::engine::engine;
use crate::scene::Scene;
use crate::study::cost::{CostPoint, OrderRow, SceneCost};

/// A row of `cost.csv`; the names of the fields are the header.
#[derive(Serialize)]
struct CostRow<'a> {
    scene: &'a str,
    engine: &'a str,
    setting: &'a str,
    dt: Option<f64>,
    position_error_rms: Option<f64>,
    position_error_max: Option<f64>,
    event_time_error: Option<f64>,
    energy_error: Option<f64>,
    local_error: Option<f64>,
    cost_ms_per_sim_s: Option<f64>,
    cost_min_ms_per_sim_s: Option<f64>,
    steps: Option<u64>,
    outcome: &'a str,
}

impl<'a> CostRow<'a> {
    fn new(scene: &'a str, point: &'a CostPoint) -> Self {
        let price = point.price.as_ref();
        Self {
            scene,
            engine: &point.engine,
            setting: &point.setting,
            dt: point.dt,
            position_error_rms: point.errors.position_rms,
            position_error_max: point.errors.position_max,
            event_time_error: point.errors.event_time,
            energy_error: point.errors.energy,
            local_error: point.errors.local,
            cost_ms_per_sim_s: point.cost(),
            cost_min_ms_per_sim_s: price.map(|price| price.min),
            steps: price.map(|price| price.work.steps),
            outcome: point.ending.word(),
        }
    }
}

/// Writes `cost.csv`: a row for every run, those that failed or were too dear included.
pub(super) fn write_points(scenes: &[SceneCost], out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for cost in scenes {
        for point in &cost.points {
            table.serialize(CostRow::new(&cost.scene.name, point))?;
        }
    }
    table.flush()
}

/// A row of `work.csv`; the names of the fields are the header.
#[derive(Serialize)]
struct WorkRow<'a> {
    scene: &'a str,
    engine: &'a str,
    setting: &'a str,
    dt: Option<f64>,
    steps_per_sim_s: f64,
    force_evaluations_per_sim_s: f64,
    pair_tests_per_sim_s: f64,
}

/// Writes `work.csv`: what each run that was priced counted in a simulated second.
pub(super) fn write_work(scenes: &[SceneCost], out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let mut is_empty = true;
    for cost in scenes {
        for point in &cost.points {
            let Some([steps, forces, pairs]) = cost.work_per_sim_s(point) else {
                continue;
            };
            is_empty = false;
            table.serialize(WorkRow {
                scene: &cost.scene.name,
                engine: &point.engine,
                setting: &point.setting,
                dt: point.dt,
                steps_per_sim_s: steps,
                force_evaluations_per_sim_s: forces,
                pair_tests_per_sim_s: pairs,
            })?;
        }
    }
    if is_empty {
        // No run was priced: the header, so that a program finds the table it expects.
        table.write_record([
            "scene",
            "engine",
            "setting",
            "dt",
            "steps_per_sim_s",
            "force_evaluations_per_sim_s",
            "pair_tests_per_sim_s",
        ])?;
    }
    table.flush()
}

/// A row of `orders.csv`; the names of the fields are the header.
#[derive(Serialize)]
struct OrdersRow<'a> {
    scene: &'a str,
    engine: &'a str,
    error: &'a str,
    order: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
    /// Blank where the engine states none.
    stated_order: Option<u8>,
    points: usize,
}

impl<'a> OrdersRow<'a> {
    fn new(scene: &'a Scene, row: &'a OrderRow) -> Self {
        let effects = &scene.effects;
        let impacts = effects.contact.is_some() || effects.cushions.is_some();
        let spec = engine(&row.engine).ok();
        let order = row.fit.order;
        Self {
            scene: &scene.name,
            engine: &row.engine,
            error: row.error,
            order: order.map(|order| order.order),
            low: order.map(|order| order.low),
            high: order.map(|order| order.high),
            stated_order: spec.and_then(|spec| spec.stated_order(impacts)),
            points: row.fit.points,
        }
    }
}

/// Writes `orders.csv`: a row for every error of every engine that takes steps.
pub(super) fn write_orders(scenes: &[SceneCost], out: &mut dyn Write) -> io::Result<()> {
    let orders: Vec<_> = scenes.iter().map(|cost| (cost, cost.orders())).collect();
    let rows = orders.iter().flat_map(|(cost, orders)| {
        let row = |row| OrdersRow::new(&cost.scene, row);
        orders.iter().map(row)
    });
    let header = [
        "scene",
        "engine",
        "error",
        "order",
        "low",
        "high",
        "stated_order",
        "points",
    ];
    write_rows(&header, rows, out)
}

/// Writes a table; without a row the header, so that a program finds the table it expects.
pub(super) fn write_rows(
    header: &[&str],
    rows: impl Iterator<Item = impl Serialize>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let mut is_empty = true;
    for row in rows {
        table.serialize(row)?;
        is_empty = false;
    }
    if is_empty {
        table.write_record(header)?;
    }
    table.flush()
}
