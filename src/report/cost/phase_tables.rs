//! `phases.csv`, every raw point that the orders are fitted on, and `limits.csv`.

use std::io::{self, Write};

use serde::Serialize;

use super::tables::write_rows;
use crate::study::cost::{CostPoint, LimitRow, SceneCost};

/// A row of `phases.csv`; the names of the fields are the header.
#[derive(Serialize)]
struct PhaseRow {
    scene: String,
    engine: String,
    shift_s: f64,
    dt: Option<f64>,
    position_error_rms: Option<f64>,
    position_error_max: Option<f64>,
    event_time_error: Option<f64>,
    energy_error: Option<f64>,
    local_error: Option<f64>,
    outcome: &'static str,
}

/// Writes `phases.csv`: a row for every run from a later start.
pub(super) fn write_phases(scenes: &[SceneCost], out: &mut dyn Write) -> io::Result<()> {
    let phases = scenes
        .iter()
        .flat_map(|cost| cost.phases.iter().map(move |phase| (cost, phase)));
    let rows = phases.flat_map(|(cost, phase)| {
        let row = move |point: &CostPoint| PhaseRow {
            scene: cost.scene.name.clone(),
            engine: point.engine.clone(),
            shift_s: phase.shift,
            dt: point.dt,
            position_error_rms: point.errors.position_rms,
            position_error_max: point.errors.position_max,
            event_time_error: point.errors.event_time,
            energy_error: point.errors.energy,
            local_error: point.errors.local,
            outcome: point.ending.word(),
        };
        phase.points.iter().map(row)
    });
    let header = [
        "scene",
        "engine",
        "shift_s",
        "dt",
        "position_error_rms",
        "position_error_max",
        "event_time_error",
        "energy_error",
        "local_error",
        "outcome",
    ];
    write_rows(&header, rows, out)
}

/// Writes `limits.csv`: a row for every engine that takes steps.
pub(super) fn write_limits(scenes: &[SceneCost], seed: u64, out: &mut dyn Write) -> io::Result<()> {
    let rows = scenes.iter().flat_map(|cost| {
        let limits = cost.limits(seed).into_iter();
        limits.map(|row| LimitRow::new(&cost.scene.name, &row))
    });
    let header = [
        "scene",
        "engine",
        "kind",
        "limit",
        "limit_low",
        "limit_high",
        "slope",
        "finest",
        "floor",
    ];
    write_rows(&header, rows, out)
}
