//! The page of a study of cost.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{CostReport, tuning};
use crate::error::Result;
use crate::report::engineering;
use crate::report::template::fill;
use crate::study::cost::{
    Comparison, CostOptions, CostPoint, Machine, Order, PriceTag, Ratio, SceneCost, Verdict,
};

const TEMPLATE: &str = include_str!("../../../templates/cost.md");

/// Prices for which the error of each engine is told, ms per simulated second.
const PRICES: [f64; 5] = [0.001, 0.01, 0.1, 1.0, 10.0];

/// What the template is given.
#[derive(Serialize)]
struct Page<'a> {
    machine: &'a Machine,
    versions: BTreeMap<&'static str, &'static str>,
    seed: u64,
    repetitions: usize,
    budget: u64,
    runs: usize,
    /// The section on what was tuned on other scenes.
    tuning: Option<String>,
    debug_build: bool,
    scenes: Vec<ScenePart>,
}

#[derive(Serialize)]
struct ScenePart {
    name: String,
    title: String,
    bodies: usize,
    unit: &'static str,
    picture: bool,
    findings: Vec<String>,
    notes: Vec<String>,
    targets: Vec<String>,
    prices: Vec<String>,
    tags: Vec<Row>,
    errors: Vec<Row>,
    rankings: Vec<String>,
    verdicts: Vec<VerdictRow>,
    orders: Vec<Row>,
    spent: Vec<Row>,
    refusals: Vec<String>,
}

/// A row of a table: who, and a cell for each column.
#[derive(Serialize)]
struct Row {
    engine: String,
    cells: Vec<String>,
}

#[derive(Serialize)]
struct VerdictRow {
    engine: String,
    kind: &'static str,
    finest: String,
    slope: String,
    floor: String,
}

/// The page as Markdown.
///
/// # Errors
/// A fault of the template.
pub(super) fn page(report: &CostReport, pictures: bool) -> Result<String> {
    let CostOptions {
        seed,
        repetitions,
        budget,
        runs,
    } = report.options;
    let tuning = report.tuning.as_ref();
    let tuning = tuning.map(|tuning| tuning::section(report, tuning));
    let scenes = report.scenes.iter();
    let page = Page {
        machine: &report.machine,
        versions: crate::engine::versions(),
        seed,
        repetitions,
        budget,
        runs,
        tuning: tuning.transpose()?,
        debug_build: cfg!(debug_assertions),
        scenes: scenes
            .map(|cost| scene_part(cost, &report.options, pictures))
            .collect(),
    };
    fill(TEMPLATE, page)
}

fn scene_part(cost: &SceneCost, options: &CostOptions, pictures: bool) -> ScenePart {
    let unit = cost.scene.units.length.symbol();
    let tags = cost.price_tags();
    let column = |find: &dyn Fn(usize) -> String, count: usize| (0..count).map(find).collect();
    let tag_row = |(place, engine): (usize, &str)| Row {
        engine: engine.to_owned(),
        cells: column(&|at| priced(tags[at].cheapest[place].1), tags.len()),
    };
    let bought = PRICES.map(|price| cost.for_price(price));
    let error_row = |(place, engine): (usize, &str)| Row {
        engine: engine.to_owned(),
        cells: column(&|at| left(bought[at][place].1, unit), PRICES.len()),
    };
    let names: Vec<&str> = cost
        .engines
        .iter()
        .map(|engine| engine.spec.name.as_str())
        .collect();
    ScenePart {
        name: cost.scene.name.clone(),
        title: cost.scene.heading().to_owned(),
        bodies: cost.scene.bodies.len(),
        unit,
        picture: pictures,
        findings: findings(cost, &tags),
        notes: cost.notes.clone(),
        targets: tags.iter().map(|tag| with(tag.target, unit)).collect(),
        prices: PRICES.map(engineering).to_vec(),
        tags: names.iter().copied().enumerate().map(tag_row).collect(),
        errors: names.iter().copied().enumerate().map(error_row).collect(),
        rankings: tags
            .iter()
            .flat_map(|tag| {
                let ranked = tag.comparisons(options.seed).into_iter();
                let rows: Vec<_> = ranked.map(|row| ranking(tag.target, unit, &row)).collect();
                rows
            })
            .collect(),
        verdicts: cost
            .verdicts()
            .iter()
            .map(|row| verdict(row, unit))
            .collect(),
        orders: orders(cost),
        spent: cost
            .engines
            .iter()
            .map(|engine| Row {
                engine: engine.spec.name.clone(),
                cells: vec![
                    engine.settings.to_string(),
                    engine.runs.to_string(),
                    options.runs.saturating_sub(engine.runs).to_string(),
                    engine.found.clone().unwrap_or_else(|| "–".to_owned()),
                ],
            })
            .collect(),
        refusals: cost
            .refusals
            .iter()
            .map(|refusal| format!("{}: {}", refusal.engine, refusal.reason))
            .collect(),
    }
}

/// The answers in sentences: who is cheapest at each accuracy, and where accuracy stops mattering.
fn findings(cost: &SceneCost, tags: &[PriceTag]) -> Vec<String> {
    let unit = cost.scene.units.length.symbol();
    let mut found = Vec::new();
    for tag in tags {
        let stepping = tag.cheapest.iter().filter(|(engine, _)| {
            let steps = |of: &crate::study::cost::EngineCost| {
                of.spec.name == *engine && of.spec.takes_steps()
            };
            cost.engines.iter().any(steps)
        });
        let kept = stepping.filter_map(|(engine, point)| Some((engine, (*point)?)));
        let by_cost = |a: &(_, &CostPoint), b: &(_, &CostPoint)| {
            let price = |point: &CostPoint| point.cost().unwrap_or(f64::INFINITY);
            price(a.1).total_cmp(&price(b.1))
        };
        let target = with(tag.target, unit);
        found.push(match kept.min_by(by_cost) {
            Some((engine, point)) => format!(
                "Of the engines that take steps, {engine} keeps {target} for the least time: {}.",
                priced(Some(point))
            ),
            None => format!("No engine that takes steps keeps {target} within its budget."),
        });
    }
    if let Some(off) = &cost.sensitivity {
        found.push(format!(
            "A better answer than {} is for nobody: `{}` placed {} off moves the result by as much.",
            with(off.distance, unit),
            off.body.replace('`', "'"),
            with(off.moved, unit)
        ));
    }
    found
}

/// A price with how it is had.
fn priced(point: Option<&CostPoint>) -> String {
    let Some((point, cost)) = point.and_then(|point| Some((point, point.cost()?))) else {
        return "–".to_owned();
    };
    format!("{} ({})", engineering(cost), way(point))
}

/// An error with how it is had.
fn left(point: Option<&CostPoint>, unit: &str) -> String {
    let Some((point, error)) = point.and_then(|point| Some((point, point.error()?))) else {
        return "–".to_owned();
    };
    format!("{} ({})", with(error, unit), way(point))
}

/// Step and setting of a point.
fn way(point: &CostPoint) -> String {
    let step = point.dt.map_or("no step".to_owned(), |dt| {
        format!("dt {} s", engineering(dt))
    });
    if point.is_stock() {
        step
    } else {
        format!("{step}, {}", point.setting)
    }
}

fn with(value: f64, unit: &str) -> String {
    format!("{} {unit}", engineering(value))
        .trim_end()
        .to_owned()
}

/// A comparison in words; no ranking where the interval spans 1.
fn ranking(target: f64, unit: &str, row: &Comparison) -> String {
    let target = with(target, unit);
    let (engine, cheapest) = (row.engine, row.cheapest);
    match row.ratio {
        None => format!("{target}: {engine} and {cheapest} are not ranked, too few rounds."),
        Some(ratio @ Ratio { median, low, high }) => {
            let interval = [low, high].map(engineering).join(" to ");
            if ratio.is_decided() {
                let median = engineering(median);
                format!(
                    "{target}: {engine} takes {median} times as long as {cheapest} ({interval})."
                )
            } else {
                format!("{target}: {engine} and {cheapest} cannot be ranked ({interval}).")
            }
        }
    }
}

fn verdict(row: &Verdict, unit: &str) -> VerdictRow {
    let limit = row.limit;
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    VerdictRow {
        engine: row.engine.clone(),
        kind: limit.map_or("too few points", |limit| limit.kind.word()),
        finest: or_dash(limit.map(|limit| with(limit.finest, unit))),
        slope: or_dash(
            limit
                .and_then(|limit| limit.slope)
                .map(|slope| format!("{slope:.2}")),
        ),
        floor: with(row.floor, unit),
    }
}

/// The orders of position, energy and local error, with their intervals.
fn orders(cost: &SceneCost) -> Vec<Row> {
    let rows = cost.orders();
    let cell = |order: Option<Order>| match order {
        Some(Order { order, low, high }) => format!("{order:.2} ({low:.2} to {high:.2})"),
        None => String::new(),
    };
    let of_engine = rows.chunk_by(|a, b| a.engine == b.engine);
    let row = |chunk: &[crate::study::cost::OrderRow]| Row {
        engine: chunk[0].engine.clone(),
        cells: chunk.iter().map(|row| cell(row.fit.order)).collect(),
    };
    of_engine.map(row).collect()
}
