//! Settings tuned on some shots and scored on others: `tuning.csv`, and a section of the page.

use std::io::{self, Write};

use serde::Serialize;

use crate::error::Result;
use crate::report::engineering;
use crate::report::template::fill;
use crate::study::cost::{Candidate, CostSummary, FamilyTuning, ShotError, Trial, Tuning};

const TEMPLATE: &str = include_str!("../../../templates/tuning.md");

/// A row of `tuning.csv`; the names of the fields are the header.
#[derive(Serialize)]
struct TuningRow<'a> {
    family: &'a str,
    /// Counted from 1 in each family.
    trial: usize,
    /// Blank for the start.
    coordinate: Option<&'a str>,
    setting: String,
    dt: f64,
    scene: &'a str,
    position_error_max: Option<f64>,
    outcome: &'a str,
    /// The geometric mean over the trial's shots, failed runs and all.
    objective: f64,
    accepted: bool,
}

/// Writes `tuning.csv`: a row for every run of the search, in its order.
pub(super) fn write_trials(tuning: &Tuning, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for family in &tuning.families {
        for (place, trial) in family.search.trials.iter().enumerate() {
            for error in &trial.measured {
                table.serialize(row(family, place + 1, trial, error))?;
            }
        }
    }
    table.flush()
}

fn row<'a>(
    family: &FamilyTuning,
    number: usize,
    trial: &Trial<Candidate, Vec<ShotError>>,
    error: &'a ShotError,
) -> TuningRow<'a> {
    TuningRow {
        family: family.family.word(),
        trial: number,
        coordinate: trial.coordinate,
        setting: family.setting(&trial.candidate),
        dt: trial.candidate.dt,
        scene: &error.scene,
        position_error_max: error.position_max,
        outcome: error.ending.word(),
        objective: trial.objective,
        accepted: trial.accepted,
    }
}

/// What the template is given.
#[derive(Serialize)]
struct Section<'a> {
    tuned_on: &'a [String],
    scored_on: Vec<&'a str>,
    trials_max: usize,
    runs_max: usize,
    budget: u64,
    families: Vec<FamilyPart>,
    rows: Vec<Row>,
    unscored: &'a [String],
}

#[derive(Serialize)]
struct FamilyPart {
    word: &'static str,
    preset: String,
    name: String,
    described: String,
    setting: String,
    first_dt: String,
    first: String,
    dt: String,
    last: String,
    trials: usize,
    unspent: usize,
    ended: &'static str,
}

/// A shot that was scored: the start and the find of each family in turn.
#[derive(Serialize)]
struct Row {
    shot: String,
    cells: Vec<String>,
}

/// The section as Markdown.
///
/// # Errors
/// A fault of the template.
pub(super) fn section(tuning: &Tuning, summary: &CostSummary) -> Result<String> {
    let scenes = summary.scenes.iter();
    let families = tuning.families.iter();
    fill(
        TEMPLATE,
        Section {
            tuned_on: &tuning.tuned_on,
            scored_on: scenes.map(|cost| cost.scene.as_str()).collect(),
            trials_max: tuning.trials_max,
            runs_max: tuning.trials_max * tuning.tuned_on.len(),
            budget: summary.options.budget,
            families: families.map(|family| part(tuning, family)).collect(),
            rows: rows(tuning),
            unscored: &tuning.unscored,
        },
    )
}

fn part(tuning: &Tuning, family: &FamilyTuning) -> FamilyPart {
    let (start, found) = (family.search.start(), family.search.found());
    let trials = family.search.trials.len();
    FamilyPart {
        word: family.family.word(),
        preset: family.preset.name.clone(),
        name: family.spec.name.clone(),
        described: family.spec.describe(),
        setting: family.setting(&found.candidate),
        first_dt: engineering(start.candidate.dt),
        first: with(start.objective, tuning.unit),
        dt: engineering(found.candidate.dt),
        last: with(found.objective, tuning.unit),
        trials,
        unspent: tuning.trials_max - trials,
        ended: if family.search.is_settled {
            "nothing helps"
        } else {
            "budget spent"
        },
    }
}

fn rows(tuning: &Tuning) -> Vec<Row> {
    let scores = tuning
        .families
        .first()
        .map_or(&[][..], |first| &first.scores);
    let row = |(place, score): (usize, &crate::study::cost::Score)| Row {
        shot: score.scene.clone(),
        cells: tuning
            .families
            .iter()
            .flat_map(|family| {
                let score = &family.scores[place];
                [score.start, score.found].map(|error| with(error, score.unit))
            })
            .collect(),
    };
    let mut rows: Vec<Row> = scores.iter().enumerate().map(row).collect();
    let means = tuning.families.iter().map(FamilyTuning::score);
    if let Some(means) = means.collect::<Option<Vec<_>>>()
        && let Some(unit) = scores.first().map(|score| score.unit)
    {
        let cells = means.into_iter().flatten();
        rows.push(Row {
            shot: "geometric mean".to_owned(),
            cells: cells.map(|error| with(error, unit)).collect(),
        });
    }
    rows
}

fn with(error: f64, unit: &str) -> String {
    format!("{} {unit}", engineering(error))
        .trim_end()
        .to_owned()
}
