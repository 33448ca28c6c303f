//! The page of a study of cost.

use serde::Serialize;

use super::effort::{step_rows, work_rows};
use super::findings::{headline, of_scene};
use super::price_table::{NOTHING, PriceTable, Row};
use super::push_out::{self, PushOutPart};
use crate::error::Result;
use crate::report::case_page::with_unit;
use crate::report::engineering;
use crate::report::limits::estimate;
use crate::report::overhead::OVERHEAD_HEADER;
use crate::report::template::fill;
use crate::study::Ratio;
use crate::study::cost::{
    CostOptions, CostPoint, CostSummary, EngineLimit, Order, OrderRow, PriceTag, SceneCost,
    SceneCostSummary,
};

const TEMPLATE: &str = include_str!("../../../templates/cost.md");

/// Prices for which the error of each engine is told, ms per simulated second.
const PRICES: [f64; 5] = [0.001, 0.01, 0.1, 1.0, 10.0];

/// What the template is given.
#[derive(Serialize)]
struct Page<'a> {
    summary: &'a CostSummary,
    headline: Option<String>,
    busy: bool,
    /// The section on what was tuned on other scenes.
    tuning: Option<String>,
    parts: [&'static str; 5],
    scenes: &'a [ScenePart],
}

/// What the page has to say about one scene.
#[derive(Debug, Serialize)]
pub(super) struct ScenePart {
    name: String,
    title: String,
    bodies: usize,
    pictures: bool,
    findings: Vec<String>,
    notes: Vec<String>,
    refusals: Vec<String>,
    tags: PriceTable,
    targets: Vec<String>,
    ratios: Vec<Row>,
    prices: Vec<String>,
    errors: Vec<Row>,
    limits: Vec<LimitLine>,
    orders: Vec<Row>,
    work: Vec<Row>,
    steps: Vec<Row>,
    phases: usize,
    push_out: Vec<PushOutPart>,
    spent: Vec<Row>,
}

#[derive(Debug, Serialize)]
struct LimitLine {
    engine: String,
    kind: &'static str,
    stays: String,
    finest: String,
    slope: String,
    floor: String,
}

/// The page as Markdown.
///
/// # Errors
/// A fault of the template.
pub(super) fn page(
    summary: &CostSummary,
    scenes: &[ScenePart],
    tuning: Option<String>,
) -> Result<String> {
    let page = Page {
        summary,
        headline: (scenes.len() > 1).then(|| headline(summary)),
        busy: summary.made.machine.is_busy(),
        tuning,
        parts: OVERHEAD_HEADER,
        scenes,
    };
    fill(TEMPLATE, page)
}

impl ScenePart {
    /// What is worth saying of a scene's study.
    pub(super) fn of(cost: &SceneCost, summary: &SceneCostSummary, options: &CostOptions) -> Self {
        let (seed, runs) = (options.timing.seed, options.runs);
        let unit = summary.length_unit.symbol();
        let tags = cost.price_tags();
        let names: Vec<&str> = cost
            .engines
            .iter()
            .map(|engine| &*engine.spec.name)
            .collect();
        let bought = PRICES.map(|price| cost.for_price(price));
        let error_row = |(place, engine): (usize, &&str)| Row {
            engine: (*engine).to_owned(),
            cells: bought.iter().map(|all| left(all[place].1, unit)).collect(),
        };
        let limits = &summary.limits;
        let spent = cost.engines.iter().map(|engine| Row {
            engine: engine.spec.name.clone(),
            cells: vec![
                engine.settings.to_string(),
                engine.runs.to_string(),
                runs.saturating_sub(engine.runs).to_string(),
                engine.found.clone().unwrap_or_else(|| NOTHING.to_owned()),
            ],
        });
        let refusals = cost.refusals.iter();
        Self {
            name: summary.scene.clone(),
            title: summary.title.clone(),
            bodies: cost.scene.bodies.len(),
            pictures: cfg!(feature = "plots"),
            findings: of_scene(summary),
            notes: cost.notes.clone(),
            refusals: refusals
                .map(|refusal| format!("{}: {}", refusal.engine, refusal.reason))
                .collect(),
            tags: PriceTable::of(summary),
            targets: tags.iter().map(|tag| tag.target.name.to_owned()).collect(),
            ratios: ratios(&tags, &names, seed),
            prices: PRICES.map(|price| price.to_string()).to_vec(),
            errors: names.iter().enumerate().map(error_row).collect(),
            limits: limits.iter().map(|row| limit_line(row, unit)).collect(),
            orders: orders(cost),
            work: work_rows(cost),
            steps: step_rows(cost),
            phases: cost.phases.len(),
            push_out: push_out::parts(cost),
            spent: spent.collect(),
        }
    }
}

/// An error with how it is had.
fn left(point: Option<&CostPoint>, unit: &str) -> String {
    let Some((point, error)) = point.and_then(|point| Some((point, point.error()?))) else {
        return NOTHING.to_owned();
    };
    let step = point.dt.map(|dt| format!("dt {} s", engineering(dt)));
    let setting = (!point.is_stock()).then(|| point.setting.clone());
    let way: Vec<_> = step.into_iter().chain(setting).collect();
    let error = with_unit(error, unit);
    if way.is_empty() {
        return error;
    }
    format!("{error} ({})", way.join(", "))
}

/// How many times as much as the cheapest each engine takes for each accuracy; only engines that
/// keep one, and no row where there were too few rounds for any ratio.
fn ratios(tags: &[PriceTag], names: &[&str], seed: u64) -> Vec<Row> {
    let compared: Vec<_> = tags.iter().map(|tag| tag.comparisons(seed)).collect();
    if compared.iter().flatten().all(|row| row.ratio.is_none()) {
        return Vec::new();
    }
    let cell = |engine: &str, place: usize| {
        let keeps = |(name, point): &(&str, Option<&CostPoint>)| *name == engine && point.is_some();
        let against = compared[place].iter().find(|row| row.engine == engine);
        match against {
            Some(against) => Some(ranking(against.ratio)),
            None if tags[place].cheapest.iter().any(keeps) => Some("cheapest".to_owned()),
            None => None,
        }
    };
    let row = |engine: &&str| {
        let cells: Vec<_> = (0..tags.len()).map(|place| cell(engine, place)).collect();
        cells.iter().any(Option::is_some).then(|| Row {
            engine: (*engine).to_owned(),
            cells: cells
                .into_iter()
                .map(|cell| cell.unwrap_or(NOTHING.into()))
                .collect(),
        })
    };
    names.iter().filter_map(row).collect()
}

/// A ratio with its interval; no ranking where the interval spans 1.
fn ranking(ratio: Option<Ratio>) -> String {
    let Some(ratio @ Ratio { median, low, high }) = ratio else {
        return "too few rounds".to_owned();
    };
    let [median, low, high] = [median, low, high].map(engineering);
    if ratio.is_decided() {
        format!("{median} ({low} to {high})")
    } else {
        format!("not ranked ({low} to {high})")
    }
}

fn limit_line(row: &EngineLimit, unit: &str) -> LimitLine {
    let limit = row.limit;
    let or_nothing = |text: Option<String>| text.unwrap_or_else(|| NOTHING.to_owned());
    let stays = limit.and_then(|limit| limit.stays);
    let slope = limit.and_then(|limit| limit.slope);
    LimitLine {
        engine: row.engine.clone(),
        kind: limit.map_or("too few points", |limit| limit.kind.word()),
        stays: or_nothing(stays.map(|stays| estimate(&stays, unit))),
        finest: or_nothing(limit.map(|limit| with_unit(limit.finest, unit))),
        slope: or_nothing(slope.map(|slope| format!("{slope:.2}"))),
        floor: or_nothing(limit.map(|limit| with_unit(limit.floor, unit))),
    }
}

/// The orders of position, energy and local error, with their intervals; only engines that have
/// one.
fn orders(cost: &SceneCost) -> Vec<Row> {
    let rows = cost.orders();
    let cell = |order: Option<Order>| match order {
        Some(Order { order, low, high }) => format!("{order:.2} ({low:.2} to {high:.2})"),
        None => NOTHING.to_owned(),
    };
    let of_engine = rows.chunk_by(|a, b| a.engine == b.engine);
    let of_engine = of_engine.filter(|rows| rows.iter().any(|row| row.fit.order.is_some()));
    let row = |chunk: &[OrderRow]| Row {
        engine: chunk[0].engine.clone(),
        cells: chunk.iter().map(|row| cell(row.fit.order)).collect(),
    };
    of_engine.map(row).collect()
}
