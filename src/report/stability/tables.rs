//! The tables of a study of stability.

use std::io::{self, Write};

use serde::Serialize;

use crate::engine::{EngineKind, versions};
use crate::report::format::engineering;
use crate::study::stability::{Judged, MapKind, StabilityMap, StabilityStudy, StabilitySummary};

/// Writes `stability.csv`: a row for every case, engine and step.
pub(super) fn write_cells(study: &StabilityStudy, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for judged in &study.cells {
        table.serialize(&judged.cell)?;
    }
    table.flush()
}

/// A row of `failures.csv`, which is also the file of failures that are known and expected.
#[derive(Serialize)]
struct Failure<'a> {
    case: &'a str,
    engine: &'a str,
    version: String,
    dt: Option<f64>,
    outcome: &'a str,
    at_time: Option<f64>,
    phase: Option<&'a str>,
    reason: Option<&'a str>,
}

/// Writes `failures.csv`: what was broken first in every cell that did not hold.
pub(super) fn write_failures(study: &StabilityStudy, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let failed = study.cells.iter().filter(|judged| !judged.cell.holds());
    for Judged {
        cell,
        broken,
        phase,
        ..
    } in failed
    {
        table.serialize(Failure {
            case: &cell.case,
            engine: &cell.engine,
            version: version(study, &cell.engine),
            dt: cell.dt,
            outcome: &cell.outcome,
            at_time: cell.at_time,
            phase: phase.as_deref(),
            reason: broken.as_deref(),
        })?;
    }
    table.flush()
}

/// The program that a finding about an engine holds for.
fn version(study: &StabilityStudy, engine: &str) -> String {
    let mut specs = study.engines.iter();
    let own = match specs
        .find(|spec| spec.name == engine)
        .map(|spec| &spec.kind)
    {
        Some(EngineKind::Rapier(_)) => "rapier3d",
        _ => "carom",
    };
    let known = versions();
    let version = known.get(own).copied().unwrap_or_default();
    format!("{own} {version}")
}

/// Writes the table of a map: a row for every run.
pub(super) fn write_map(map: &StabilityMap, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let [x, y, growth] = match map.kind {
        MapKind::Spring => ["k_dt2_over_mu", "two_kd_dt_over_mu", "energy_ratio_max"],
        MapKind::Orbit => ["eccentricity", "w_dt", "energy_drift_max"],
    };
    table.write_record(["engine", x, y, growth, "stable"])?;
    for point in &map.points {
        table.serialize((
            &point.engine,
            point.x,
            point.y,
            point.growth,
            point.is_stable,
        ))?;
    }
    table.flush()
}

/// How each engine did, for the terminal.
#[must_use]
pub fn stability_table(summary: &StabilitySummary) -> String {
    let names = summary.scores.iter().map(|score| score.engine.len());
    let wide = names.max().unwrap_or(0).max("engine".len());
    let mut lines = vec![format!(
        "{:wide$}  held  run  not run  cases held",
        "engine"
    )];
    lines.extend(summary.scores.iter().map(|score| {
        format!(
            "{:wide$}  {:4}  {:3}  {:7}  {:3} of {}",
            score.engine, score.held, score.run, score.not_run, score.cases_held, summary.cases
        )
    }));
    lines.join("\n")
}

/// Rows of cells of a table on a page.
pub(super) type Rows = Vec<Vec<String>>;

/// How each engine did, with the cost of its runs against the first engine's.
pub(super) fn scores(study: &StabilityStudy, summary: &StabilitySummary) -> Rows {
    let cost = |engine: &str| -> f64 {
        let cells = study.cells.iter();
        let own = cells.filter(|judged| judged.cell.engine == engine);
        own.filter_map(|judged| judged.cell.cost_ms).sum()
    };
    let takes_steps = |engine: &str| {
        let mut specs = study.engines.iter();
        specs.any(|spec| spec.name == engine && spec.takes_steps())
    };
    let row = |score: &crate::study::stability::Score| {
        vec![
            score.engine.clone(),
            format!("{} of {}", score.held, score.run),
            if takes_steps(&score.engine) {
                format!("{} of {}", score.cases_held, summary.cases)
            } else {
                "as runs".to_owned()
            },
            score.not_run.to_string(),
            format!("{} s", engineering(1e-3 * cost(&score.engine))),
        ]
    };
    summary.scores.iter().map(row).collect()
}

/// The prefix of the cases whose impacts spell the digits of pi.
const PI: &str = "pi-";

/// The cases whose impacts spell pi, each with the number there is.
pub(super) fn pi_header(study: &StabilityStudy) -> Vec<String> {
    pi_cases(study)
        .map(|case| {
            let cells = study.cells.iter();
            let due = cells
                .filter(|judged| judged.cell.case == case)
                .find_map(due);
            let due = due.map_or("?".to_owned(), |due| due.to_string());
            format!("{case}: {due}")
        })
        .collect()
}

/// How many impacts each engine counts there at its finest step.
pub(super) fn pi_rows(study: &StabilityStudy) -> Rows {
    let row = |engine: &str| {
        let counts = pi_cases(study).map(|case| {
            let finest = study.of(case, engine).last();
            let found = finest.and_then(|judged| Some((judged.impacts?, judged.cell.holds())));
            found.map_or("–".to_owned(), |(found, holds)| {
                if holds {
                    format!("**{found}**")
                } else {
                    found.to_string()
                }
            })
        });
        std::iter::once(engine.to_owned()).chain(counts).collect()
    };
    study.engines.iter().map(|spec| row(&spec.name)).collect()
}

fn pi_cases(study: &StabilityStudy) -> impl Iterator<Item = &str> {
    let names = study.cases.iter().map(|(name, _)| name.as_str());
    names.filter(|name| name.starts_with(PI))
}

/// Impacts that there are in truth.
fn due(judged: &Judged) -> Option<i64> {
    Some(judged.impacts?.cast_signed() + judged.cell.missed_events?)
}

/// Every case: who holds it at every step, and what breaks first where the lecture and Rapier fail.
pub(super) fn cases(study: &StabilityStudy) -> Rows {
    let row = |(name, title): &(String, String)| {
        let holds = |engine: &str| study.of(name, engine).all(|judged| judged.cell.holds());
        let engines = study.engines.iter().map(|spec| spec.name.as_str());
        let held: Vec<_> = engines.filter(|engine| holds(engine)).collect();
        let held = if held.len() == study.engines.len() {
            "all".to_owned()
        } else if held.is_empty() {
            "none".to_owned()
        } else {
            held.join(", ")
        };
        let first = |engine: &str| {
            let failed = study.of(name, engine).find(|judged| !judged.cell.holds());
            failed.map_or("–".to_owned(), super::findings::told)
        };
        vec![
            name.clone(),
            title.clone(),
            held,
            first("lecture"),
            first("rapier"),
        ]
    };
    study.cases.iter().map(row).collect()
}
