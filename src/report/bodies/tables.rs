//! The tables that people read: a row for each engine, a column for each number of bodies.

use crate::report::engineering;
use crate::report::format::aligned;
use crate::report::overhead::overhead_cells;
use crate::study::bodies::{BASE, BodiesPoint, BodiesStudy, Series, Standing};

/// A row: who, and a cell for each column.
pub(super) type Row = Vec<String>;

/// An engine's name, with the build where it is another one.
pub(super) fn label(study: &BodiesStudy, series: Series) -> String {
    if series.build == study.build {
        series.engine.to_owned()
    } else {
        format!("{} ({})", series.engine, series.build)
    }
}

/// A row for each series, with a cell for each size from its point there.
fn rows(study: &BodiesStudy, cell: impl Fn(Series, &BodiesPoint) -> Option<String>) -> Vec<Row> {
    let sizes = study.sizes();
    let row = |series: Series| {
        let cell = |bodies: &usize| match study.at(series, *bodies) {
            Some(point) if point.is_over_budget() => "over budget".to_owned(),
            Some(point) => cell(series, point).unwrap_or_else(|| point.outcome.clone()),
            None => "–".to_owned(),
        };
        let cells = sizes.iter().map(cell);
        std::iter::once(label(study, series)).chain(cells).collect()
    };
    study.series().into_iter().map(row).collect()
}

/// Costs of a step, µs.
pub(super) fn step_rows(study: &BodiesStudy) -> Vec<Row> {
    let dt = study.options.dt;
    rows(study, |_, point| Some(engineering(point.per_step_us(dt)?)))
}

/// Costs over those of the base of the same build, with their intervals.
pub(super) fn ratio_rows(study: &BodiesStudy) -> Vec<Row> {
    rows(study, |series, point| {
        if series.engine == BASE {
            return Some("1".to_owned());
        }
        let standings = study.standings(series);
        let standing = standings.iter().find(|at| at.bodies == point.bodies);
        Some(standing.map_or("–".to_owned(), ratio))
    })
}

/// A ratio with its interval, in a cell or a sentence.
pub(super) fn ratio(standing: &Standing) -> String {
    let ratio = engineering(standing.ratio);
    match standing.interval {
        Some(ends) => format!("{ratio} ({})", ends.map(engineering).join(" to ")),
        None => ratio,
    }
}

/// Pairs looked at and forces evaluated in a step.
pub(super) fn work_rows(study: &BodiesStudy) -> Vec<Row> {
    rows(study, |_, point| {
        let counted = point.pair_tests? + point.force_evaluations?;
        if point.dt.is_none() {
            return Some("–".to_owned());
        }
        #[allow(clippy::cast_precision_loss, reason = "counts far below 2^53")]
        let a_step = counted as f64 / point.steps?.max(1) as f64;
        Some(engineering(a_step))
    })
}

/// The parts of a step's cost, for the engines that take steps.
pub(super) fn overhead_rows(study: &BodiesStudy) -> Vec<Row> {
    let series = study.series().into_iter();
    let stepping = series.filter(|series| study.of(*series).iter().any(|p| p.dt.is_some()));
    let row = |series: Series| {
        let overhead = study.overhead(series);
        let cells = overhead_cells(overhead.as_ref());
        std::iter::once(label(study, series)).chain(cells).collect()
    };
    stepping.map(row).collect()
}

/// The costs of a step for a terminal.
#[must_use]
pub fn bodies_table(study: &BodiesStudy) -> String {
    let head = std::iter::once("µs a step, bodies".to_owned());
    let sizes = study.sizes().into_iter().map(|bodies| bodies.to_string());
    let mut rows = vec![head.chain(sizes).collect()];
    rows.extend(step_rows(study));
    aligned(&rows)
}
