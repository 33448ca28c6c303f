//! What the drift sentinel leaves in its folder: a page, a table, a summary.

use std::io::{self, Write};

use serde::Serialize;

use super::Folder;
use super::check::text::in_a_line;
use super::format::{aligned, engineering};
use super::template::fill;
use crate::case::Metric;
use crate::error::Result;
use crate::study::check::{Against, CaseCheck, Held, RAPIER, Row};
use crate::study::drift::{DriftStudy, Found, Measured, ROUNDINGS, Restitution, Verdict, phases};

const TEMPLATE: &str = include_str!("../../templates/drift.md");

/// What stands in the table where a worker failed; the findings say how, unless it is known to.
const NOTHING: &str = "no recording";

/// The files of a study.
pub const DRIFT_FILES: [&str; 3] = ["drift.csv", "README.md", "summary.json"];

/// Writes `drift.csv`, `summary.json` and the page.
///
/// # Errors
/// A file that cannot be written, with its name.
pub fn write_drift(folder: &Folder, study: &DriftStudy) -> Result<()> {
    folder.write("drift.csv", |out| write_rows(study, out))?;
    let page = fill(TEMPLATE, Page::of(study))?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))?;
    folder.write_summary(study)
}

/// A row of `drift.csv`; the names of the fields are the header.
#[derive(Debug, Default, Serialize)]
struct CsvRow<'a> {
    version: &'a str,
    measure: &'a str,
    verdict: &'a str,
    expected: &'a str,
    /// What was off most, and by how much.
    metric: &'a str,
    deviation: Option<f64>,
    bound: Option<f64>,
    unit: &'a str,
    /// Effective restitutions over the phases of the impact.
    restitution_min: Option<f64>,
    restitution_max: Option<f64>,
    phases: Option<usize>,
    phases_held: Option<usize>,
    /// Of the recording of a case.
    digest: Option<&'a str>,
}

fn csv_row<'a>(version: &'a str, measured: &'a Measured) -> CsvRow<'a> {
    let row = CsvRow {
        version,
        measure: &measured.measure,
        verdict: measured.verdict.word(),
        expected: measured.expected.word(),
        ..CsvRow::default()
    };
    match &measured.found {
        Found::Restitution(found) => {
            let [least, most] = found.range();
            CsvRow {
                metric: "restitution",
                deviation: Some((found.restitution - least).max(most - found.restitution)),
                bound: Some(found.bound),
                restitution_min: Some(least),
                restitution_max: Some(most),
                phases: Some(found.effective.len()),
                phases_held: Some(found.held()),
                ..row
            }
        }
        Found::Case(check) => {
            let digest = check.digest.as_deref();
            match telling(check) {
                Some((_, worst)) => CsvRow {
                    metric: worst.metric.key(),
                    deviation: Some(worst.value),
                    bound: Some(worst.tolerance),
                    unit: &worst.unit,
                    digest,
                    ..row
                },
                None => CsvRow { digest, ..row },
            }
        }
        Found::Nothing(_) => row,
    }
}

fn write_rows(study: &DriftStudy, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for of in &study.versions {
        for measured in &of.measures {
            table.serialize(csv_row(&of.version, measured))?;
        }
    }
    table.flush()
}

/// The row of a check that decides: of the first comparison that fails, or of the truth, positions
/// before all others.
fn telling(check: &CaseCheck) -> Option<(Against, &Row)> {
    let fails = |held: Held| held == Held::Fails;
    let mut comparisons = check.comparisons.iter();
    let failed = comparisons.find(|it| fails(it.held));
    let of = failed.or(check.comparisons.first())?;
    let mut rows = of.rows.iter();
    let row = match failed {
        Some(_) => rows.find(|row| fails(row.held)),
        None => rows.find(|row| row.metric == Metric::Position),
    };
    Some((of.against, row?))
}

/// A restitution as people read it: three decimals, and a power of ten where they would hide it.
fn shown(restitution: f64) -> String {
    if restitution == 0.0 || restitution.abs() >= 5e-4 {
        format!("{restitution:.3}")
    } else {
        engineering(restitution)
    }
}

/// One number where the phases agree, else from where to where, and at how many the bound holds.
fn of_sweep(found: &Restitution) -> String {
    let [least, most] = found.range();
    if most - least <= found.bound {
        return shown(most);
    }
    let (held, all) = (found.held(), found.effective.len());
    format!("{} to {}, {held} of {all}", shown(least), shown(most))
}

fn of_case(check: &CaseCheck) -> String {
    if check.fault.is_some() {
        return NOTHING.to_owned();
    }
    if check.same_bits {
        return "same bits".to_owned();
    }
    let Some((against, row)) = telling(check) else {
        return "nothing to compare".to_owned();
    };
    let off = match row.unit.as_str() {
        "share" => super::percent(row.value),
        unit => format!("{} {unit}", engineering(row.value)),
    };
    let what = match row.metric {
        Metric::Position => String::new(),
        metric => format!("{} ", metric.name()),
    };
    match against {
        Against::Truth => format!("{what}{off} off"),
        Against::Baseline | Against::Rapier => format!("{what}{off}"),
    }
}

/// What was found, without the verdict.
fn value(measured: &Measured) -> String {
    match &measured.found {
        Found::Restitution(found) => of_sweep(found),
        Found::Case(check) => of_case(check),
        Found::Nothing(_) => NOTHING.to_owned(),
    }
}

/// A cell of the table; a value within its bounds stands alone.
fn cell(measured: &Measured) -> String {
    let mark = if measured.is_expected() { "" } else { " (!)" };
    match measured.verdict {
        Verdict::Within => format!("{}{mark}", value(measured)),
        other => format!("{} {}{mark}", other.word().to_uppercase(), value(measured)),
    }
}

/// The table: a row a measure, a column a version. The first row holds the versions.
fn rows(study: &DriftStudy) -> Vec<Vec<String>> {
    let versions = study.versions.iter();
    let heading = std::iter::once("measure".to_owned());
    let mut rows = vec![
        heading
            .chain(versions.map(|of| of.version.clone()))
            .collect(),
    ];
    let measures = study.versions.first().map_or(0, |of| of.measures.len());
    for measure in 0..measures {
        let name = study.versions[0].measures[measure].measure.clone();
        let cells = study.versions.iter().map(|of| cell(&of.measures[measure]));
        rows.push(std::iter::once(name).chain(cells).collect());
    }
    rows
}

/// Every measure of every version, for the terminal.
#[must_use]
pub fn drift_table(study: &DriftStudy) -> String {
    aligned(&rows(study))
}

/// What the study has found: a sentence a version, and one for each measure that came to something
/// else than is known.
#[must_use]
pub fn drift_findings(study: &DriftStudy) -> Vec<String> {
    let told = study.versions.iter().map(|of| {
        let [within, moved, red] =
            [Verdict::Within, Verdict::Moved, Verdict::Red].map(|verdict| of.count(verdict));
        format!(
            "rapier3d {}: {within} within bounds, {moved} moved, {red} red.",
            of.version
        )
    });
    let surprises = study.surprises().map(|(version, measured)| {
        let line = match &measured.found {
            Found::Case(check) => in_a_line(check),
            Found::Restitution(found) => {
                format!("{} where {} is due", of_sweep(found), found.restitution)
            }
            Found::Nothing(fault) => fault.clone(),
        };
        format!(
            "SURPRISE: rapier3d {version} on {} is {}, and known to be {}: {line}",
            measured.measure,
            measured.verdict.word(),
            measured.expected.word(),
        )
    });
    told.chain(surprises).collect()
}

/// What the template is given.
#[derive(Serialize)]
struct Page<'a> {
    study: &'a DriftStudy,
    holds: bool,
    /// The version of Rapier that cases are stored of.
    own: String,
    findings: Vec<String>,
    heading: Vec<String>,
    rows: Vec<Vec<String>>,
    roundings: f64,
    bound: String,
    phases: usize,
    like: &'a str,
}

impl<'a> Page<'a> {
    fn of(study: &'a DriftStudy) -> Self {
        let mut rows = rows(study);
        let heading = rows.remove(0);
        let own = study.made.versions.get("rapier3d").cloned();
        Self {
            study,
            holds: study.holds(),
            own: own.unwrap_or_default(),
            findings: drift_findings(study),
            heading,
            rows,
            roundings: ROUNDINGS,
            bound: engineering(ROUNDINGS * f64::from(f32::EPSILON)),
            phases: phases().count(),
            like: RAPIER,
        }
    }
}
