//! What each effect costs and changes: `effects.csv` and the page.

use std::collections::BTreeMap;
use std::io::{self, Write};

use serde::Serialize;

use super::case_page::with_unit;
use super::format::{aligned, code};
use super::template::fill;
use super::{Folder, engineering};
use crate::error::Result;
use crate::study::{Change, Effect, EffectRow, EffectStudy, PAIRS_MIN, ROUNDS_MIN};

const TEMPLATE: &str = include_str!("../../templates/effects.md");

/// What the template is given.
#[derive(Serialize)]
struct Page<'a> {
    study: &'a EffectStudy,
    rounds_min: usize,
    pairs_min: usize,
    findings: Vec<String>,
    dt: String,
    header: [&'static str; 10],
    rows: Vec<[String; 10]>,
    troubles: Vec<String>,
    versions: BTreeMap<&'static str, &'static str>,
}

/// The header of the table that people read.
const HEADER: [&str; 10] = [
    "engine",
    "effect",
    "change",
    "largest distance",
    "impacts",
    "lost, gained",
    "ms per sim. s",
    "of unchanged",
    "95 %",
    "steps, pairs, forces",
];

/// The files of the study of effects.
pub const EFFECTS_FILES: [&str; 3] = ["effects.csv", "README.md", "summary.json"];

/// Writes `effects.csv`, `README.md` and `summary.json`.
///
/// # Errors
/// A file that cannot be written, with its name.
pub fn write_effects(folder: &Folder, study: &EffectStudy) -> Result<()> {
    folder.write("effects.csv", |out| write_table(study, out))?;
    let troubles = study.rows.iter().filter(|row| row.outcome != "Finished");
    let trouble = |row: &EffectRow| {
        let [engine, effect, change, ..] = cells(study, row);
        format!("{} {effect} {change}: {}", code(&engine), row.outcome_text)
    };
    let page = Page {
        study,
        rounds_min: ROUNDS_MIN,
        pairs_min: PAIRS_MIN,
        findings: effects_findings(study),
        dt: engineering(study.dt_s),
        header: HEADER,
        rows: study.rows.iter().map(|row| cells(study, row)).collect(),
        troubles: troubles.map(trouble).collect(),
        versions: crate::engine::versions(),
    };
    let page = fill(TEMPLATE, page)?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))?;
    folder.write_summary(study)
}

/// What was found, a sentence each.
///
/// The findings name what is declared and never felt, and what costs most on each engine.
#[must_use]
pub fn effects_findings(study: &EffectStudy) -> Vec<String> {
    let mut findings: Vec<_> = study
        .never_felt()
        .iter()
        .map(|never| {
            format!(
                "`{}` is declared and never felt: without it not a bit changes on {}.",
                never.effect.name(),
                never.engines.join(", ")
            )
        })
        .collect();
    if findings.is_empty() {
        findings.push("Every effect that the scene declares is felt.".to_owned());
    }
    let mut engines: Vec<&str> = Vec::new();
    for row in &study.rows {
        if !engines.contains(&row.engine.as_str()) {
            engines.push(&row.engine);
        }
    }
    findings.extend(engines.iter().filter_map(|engine| dearest(study, engine)));
    findings.extend(engines.iter().filter_map(|engine| stirred(study, engine)));
    findings
}

/// The declared effect without which an engine is cheapest, where that is beyond chance.
fn dearest(study: &EffectStudy, engine: &str) -> Option<String> {
    let off = study
        .rows
        .iter()
        .filter(|row| row.engine == engine && row.change == Change::Off);
    let priced = off.filter_map(|row| Some((row.effect?, row.price?)));
    let saving = priced.filter(|(_, price)| price.ratio_high.is_some_and(|high| high < 1.0));
    let (effect, price) = saving.min_by(|a, b| a.1.ratio.total_cmp(&b.1.ratio))?;
    Some(format!(
        "On {engine} `{}` costs most: without it a simulated second takes {} of the time.",
        effect.name(),
        engineering(price.ratio)
    ))
}

/// The neutral effects that change an engine's answer all the same.
fn stirred(study: &EffectStudy, engine: &str) -> Option<String> {
    let on = study
        .rows
        .iter()
        .filter(|row| row.engine == engine && row.change == Change::OnNeutral);
    let stirred = on.filter(|row| row.difference.is_some_and(|difference| !difference.is_none));
    let names: Vec<_> = stirred
        .filter_map(|row| row.effect)
        .map(|effect| format!("`{}`", effect.name()))
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "On {engine} the answer changes by declaring a neutral {}.",
            names.join(", ")
        )
    })
}

/// How people read a change.
fn in_words(change: Change) -> &'static str {
    match change {
        Change::Unchanged => "unchanged",
        Change::Off => "off",
        Change::OnNeutral => "on, neutral",
    }
}

/// A row for people, in the order of [`HEADER`].
fn cells(study: &EffectStudy, row: &EffectRow) -> [String; 10] {
    let unit = study.length_unit.symbol();
    let nothing = || "–".to_owned();
    let difference = row.difference.as_ref();
    let price = row.price.as_ref();
    let distance = difference.map_or_else(nothing, |difference| {
        if difference.is_none {
            "none, bit for bit".to_owned()
        } else {
            with_unit(difference.position_max, unit)
        }
    });
    [
        row.engine.clone(),
        row.effect.map_or("", Effect::name).to_owned(),
        in_words(row.change).to_owned(),
        if row.outcome == "Refused" {
            "refused".to_owned()
        } else {
            distance
        },
        row.impacts.map_or_else(nothing, |count| count.to_string()),
        difference.map_or_else(nothing, |difference| {
            match (difference.impacts_lost, difference.impacts_gained) {
                (0, 0) => "none".to_owned(),
                (lost, gained) => format!("-{lost}, +{gained}"),
            }
        }),
        price.map_or_else(nothing, |price| engineering(price.median_ms_per_sim_s)),
        price.map_or_else(nothing, |price| engineering(price.ratio)),
        price
            .and_then(|price| Some([price.ratio_low?, price.ratio_high?]))
            .map_or_else(nothing, |ends| ends.map(engineering).join(" to ")),
        row.work.map_or_else(nothing, |work| {
            format!(
                "{}, {}, {}",
                work.steps, work.pair_tests, work.force_evaluations
            )
        }),
    ]
}

/// The table of a study for a terminal.
#[must_use]
pub fn effects_table(study: &EffectStudy) -> String {
    let header = HEADER.map(str::to_owned);
    let rows = study.rows.iter().map(|row| cells(study, row));
    let rows = std::iter::once(header).chain(rows).map(Vec::from);
    aligned(&rows.collect::<Vec<_>>())
}

/// A row of `effects.csv`; the names of the fields are the header.
#[derive(Serialize)]
struct CsvRow<'a> {
    scene: &'a str,
    engine: &'a str,
    effect: &'a str,
    change: &'a str,
    position_difference_max: Option<f64>,
    impacts: Option<u64>,
    cost_ms_per_sim_s: Option<f64>,
    cost_ratio: Option<f64>,
    ratio_low: Option<f64>,
    ratio_high: Option<f64>,
    outcome: &'a str,
}

/// Writes `effects.csv`: a row per engine and effect; blank where there is no number.
fn write_table(study: &EffectStudy, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for row in &study.rows {
        let finite = |value: f64| value.is_finite().then_some(value);
        table.serialize(CsvRow {
            scene: &study.scene,
            engine: &row.engine,
            effect: row.effect.map_or("", Effect::name),
            change: match row.change {
                Change::Unchanged => "unchanged",
                Change::Off => "off",
                Change::OnNeutral => "on-neutral",
            },
            position_difference_max: row.difference.and_then(|d| finite(d.position_max)),
            impacts: row.impacts,
            cost_ms_per_sim_s: row.price.and_then(|p| finite(p.median_ms_per_sim_s)),
            cost_ratio: row.price.and_then(|p| finite(p.ratio)),
            ratio_low: row.price.and_then(|p| finite(p.ratio_low?)),
            ratio_high: row.price.and_then(|p| finite(p.ratio_high?)),
            outcome: row.outcome,
        })?;
    }
    table.flush()
}
