//! The page of a study of cost against the number of bodies.

use std::collections::BTreeMap;

use serde::Serialize;

use super::findings::bodies_findings;
use super::tables::{Row, overhead_rows, ratio_rows, step_rows, work_rows};
use crate::error::Result;
use crate::report::overhead::OVERHEAD_HEADER;
use crate::report::template::fill;
use crate::study::bodies::{BASE, BodiesStudy, Walls};

const TEMPLATE: &str = include_str!("../../../templates/bodies.md");

/// What the template is given.
#[derive(Serialize)]
struct Page {
    machine: String,
    load: Option<f64>,
    busy: bool,
    debug_build: bool,
    versions: BTreeMap<&'static str, &'static str>,
    build: String,
    /// Builds that were measured by other programs, and where.
    joined: Vec<[String; 2]>,
    dt: f64,
    filling: f64,
    walls: Walls,
    seed: u64,
    repetitions: usize,
    budget: u64,
    findings: Vec<String>,
    picture: bool,
    tables: Vec<Table>,
    refusals: Vec<String>,
}

/// A table with what a reader must know about it.
#[derive(Serialize)]
struct Table {
    title: String,
    header: Row,
    rows: Vec<Row>,
    note: String,
}

const STEPS_NOTE: &str = "For an engine without steps: what a stretch as long as a step costs it. \
    The other rungs of the ladder stand in this table and not in the picture, and of another \
    build `rapier` alone is drawn.";
const RATIOS_NOTE: &str = "Medians of the ratios of prices taken in the same round, with 95 % \
    bootstrap intervals; where an interval holds 1, the two are not ranked. Another build is \
    another program, run at another time: it is held against its own lecture, in its own rounds, \
    and no ratio pairs two builds.";
const PARTS_NOTE: &str = "Least squares on relative errors, so that 4 bodies count as much as the \
    most; no part is negative. What the fit leaves is the share by which it misses the costs: a \
    step is not quite such a sum, for memory is slower than caches, and a tree is deeper the more \
    it holds.";
const WORK_NOTE: &str = "The hand-written solver looks at every pair; Rapier counts those that come \
    near, and every ball with every wall of a closed box, for a wall is a half-space to it and near \
    to all; `--open` tells what that costs. An engine without steps has no such column: its counts are in the table of numbers.";

fn tables(study: &BodiesStudy) -> Vec<Table> {
    let head = |columns: Vec<String>| -> Row {
        std::iter::once("engine".to_owned())
            .chain(columns)
            .collect()
    };
    let sizes = || head(study.sizes().iter().map(usize::to_string).collect());
    let table = |title: String, header: Row, rows: Vec<Row>, note: &str| Table {
        title,
        header,
        rows,
        note: note.to_owned(),
    };
    let parts = head(OVERHEAD_HEADER.map(str::to_owned).to_vec());
    vec![
        table("A step, µs".into(), sizes(), step_rows(study), STEPS_NOTE),
        table(
            format!("Of the cost of {BASE}"),
            sizes(),
            ratio_rows(study),
            RATIOS_NOTE,
        ),
        table(
            "What is fixed, and what each body and pair adds".into(),
            parts,
            overhead_rows(study),
            PARTS_NOTE,
        ),
        table(
            "Pairs looked at and forces evaluated, a step".into(),
            sizes(),
            work_rows(study),
            WORK_NOTE,
        ),
    ]
}

/// The page as Markdown.
///
/// # Errors
/// A fault of the template.
pub(super) fn page(study: &BodiesStudy, picture: bool) -> Result<String> {
    let options = &study.options;
    let mut joined: Vec<[String; 2]> = Vec::new();
    for point in study
        .points
        .iter()
        .filter(|point| point.build != study.build)
    {
        let build = [point.build.clone(), point.machine.clone()];
        if !joined.contains(&build) {
            joined.push(build);
        }
    }
    let refusals = study.refusals.iter();
    let page = Page {
        machine: study.machine.describe(),
        load: study.machine.load,
        busy: study.machine.is_busy(),
        debug_build: cfg!(debug_assertions),
        versions: crate::engine::versions(),
        build: study.build.clone(),
        joined,
        dt: options.dt,
        filling: options.filling,
        walls: options.walls,
        seed: options.timing.seed,
        repetitions: options.timing.repetitions,
        budget: options.budget,
        findings: bodies_findings(study),
        picture,
        tables: tables(study),
        refusals: refusals
            .map(|refusal| format!("{}: {}", refusal.engine, refusal.reason))
            .collect(),
    };
    fill(TEMPLATE, page)
}
