//! Push-out, priced separately: its table on the page and `push-out.csv`.

use std::io::{self, Write};

use serde::Serialize;

use super::tables::write_rows;
use crate::report::case_page::with_unit;
use crate::report::{engineering, percent};
use crate::study::cost::{PushOut, PushOutRung, SceneCost};

/// The page shows every so many-th rung of the ladder, from the finest up.
const SHOWN: usize = 3;

/// What the template is given of one engine.
#[derive(Debug, Serialize)]
pub(super) struct PushOutPart {
    engine: String,
    without: String,
    rows: Vec<Row>,
}

#[derive(Debug, Serialize)]
struct Row {
    dt: String,
    ratio: String,
    error_with: String,
    error_without: String,
    energy_added: String,
    penetration_with: String,
    penetration_without: String,
}

/// The tables of a scene.
pub(super) fn parts(cost: &SceneCost) -> Vec<PushOutPart> {
    let unit = cost.scene.units.length.symbol();
    let part = |found: &PushOut| PushOutPart {
        engine: found.engine.clone(),
        without: found.without.clone(),
        rows: {
            let mut shown: Vec<_> = found.rungs.iter().rev().step_by(SHOWN).collect();
            shown.reverse();
            shown.into_iter().map(|rung| row(rung, unit)).collect()
        },
    };
    let all = cost.push_out.iter();
    all.filter(|found| !found.rungs.is_empty())
        .map(part)
        .collect()
}

fn row(rung: &PushOutRung, unit: &str) -> Row {
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    let length = |value: Option<f64>| or_dash(value.map(|value| with_unit(value, unit)));
    Row {
        dt: format!("{} s", engineering(rung.dt)),
        ratio: or_dash(rung.ratio.map(|ratio| {
            let [median, low, high] = [ratio.median, ratio.low, ratio.high].map(engineering);
            format!("{median} ({low} to {high})")
        })),
        error_with: length(rung.with.error),
        error_without: length(rung.without.error),
        energy_added: or_dash(rung.energy_added.map(percent)),
        penetration_with: length(Some(rung.with.penetration)),
        penetration_without: length(Some(rung.without.penetration)),
    }
}

/// A row of `push-out.csv`; the names of the fields are the header.
#[derive(Serialize)]
struct PushOutRow<'a> {
    scene: &'a str,
    engine: &'a str,
    without: &'a str,
    dt: f64,
    cost_ratio: Option<f64>,
    cost_ratio_low: Option<f64>,
    cost_ratio_high: Option<f64>,
    position_error_max: Option<f64>,
    position_error_max_without: Option<f64>,
    energy_added: Option<f64>,
    max_penetration: f64,
    max_penetration_without: f64,
}

/// Writes `push-out.csv`: a row for every step of every engine that has push-out.
pub(super) fn write_push_out(scenes: &[SceneCost], out: &mut dyn Write) -> io::Result<()> {
    let all = scenes
        .iter()
        .flat_map(|cost| cost.push_out.iter().map(move |found| (cost, found)));
    let rows = all.flat_map(|(cost, found)| {
        let rungs = found.rungs.iter();
        rungs.map(move |rung| PushOutRow {
            scene: &cost.scene.name,
            engine: &found.engine,
            without: &found.without,
            dt: rung.dt,
            cost_ratio: rung.ratio.map(|ratio| ratio.median),
            cost_ratio_low: rung.ratio.map(|ratio| ratio.low),
            cost_ratio_high: rung.ratio.map(|ratio| ratio.high),
            position_error_max: rung.with.error,
            position_error_max_without: rung.without.error,
            energy_added: rung.energy_added,
            max_penetration: rung.with.penetration,
            max_penetration_without: rung.without.penetration,
        })
    });
    let header = [
        "scene",
        "engine",
        "without",
        "dt",
        "cost_ratio",
        "cost_ratio_low",
        "cost_ratio_high",
        "position_error_max",
        "position_error_max_without",
        "energy_added",
        "max_penetration",
        "max_penetration_without",
    ];
    write_rows(&header, rows, out)
}
