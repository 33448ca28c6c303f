//! The pictures of a study of stability: the heat map, and a map for springs and orbits each.

use super::{MATRIX, map_picture};
use crate::error::{Error, Result};
use crate::report::chart::{
    ChartError, MatrixColumn, MatrixFigure, MatrixRow, Region, RegionPanel, RegionsFigure, Scale,
    Tone, matrix, regions,
};
use crate::study::stability::{
    Cell, MapKind, MapPoint, StabilityMap, StabilityStudy, StabilitySummary,
};

fn unpictured(name: &'static str, wrong: &ChartError) -> Error {
    Error::Picture {
        name,
        message: wrong.to_string(),
    }
}

/// How bad a cell is.
fn tone(cell: &Cell) -> Tone {
    match cell.outcome.as_str() {
        "Finished" => Tone::Good,
        "EnergyGrew" => Tone::Bad,
        "NonFinite" | "Disabled" | "Collapsed" | "BudgetSpent" => Tone::Broken,
        _ if !cell.was_run() => Tone::Absent,
        _ => Tone::Poor,
    }
}

/// The heat map of cases, engines and steps.
///
/// # Errors
/// None that depends on the study.
pub(super) fn matrix_png(study: &StabilityStudy, summary: &StabilitySummary) -> Result<Vec<u8>> {
    let key = [
        (Tone::Good, "every bound held"),
        (Tone::Poor, "a bound broken"),
        (Tone::Bad, "energy grew"),
        (Tone::Broken, "ended early"),
        (Tone::Absent, "refused"),
    ];
    let columns = summary.scores.iter().map(|score| MatrixColumn {
        name: score.engine.clone(),
        score: format!("{}/{}", score.held, score.run),
    });
    let row = |(name, _): &(String, String)| MatrixRow {
        name: name.clone(),
        cells: study
            .engines
            .iter()
            .map(|spec| {
                let cells = study.of(name, &spec.name);
                cells.map(|judged| tone(&judged.cell)).collect()
            })
            .collect(),
    };
    let figure = MatrixFigure {
        title: "Which engine stays within bounds, at which step".to_owned(),
        subtitle: "hard cases; in each column from the coarsest step (left) to the finest, mostly \
                   0.1, 0.01 and 0.001 s"
            .to_owned(),
        key: key.map(|(tone, says)| (tone, says.to_owned())).to_vec(),
        columns: columns.collect(),
        rows: study.cases.iter().map(row).collect(),
    };
    matrix(&figure).map_err(|wrong| unpictured(MATRIX, &wrong))
}

/// How bad a run of a map is.
fn tone_of(point: &MapPoint) -> Tone {
    match (point.is_stable, point.growth) {
        (true, _) => Tone::Good,
        (false, Some(_)) => Tone::Bad,
        (false, None) => Tone::Broken,
    }
}

/// A map for springs or orbits.
///
/// # Errors
/// None that depends on the study.
pub(super) fn map_png(map: &StabilityMap) -> Result<Vec<u8>> {
    let region = |point: &MapPoint| {
        let [low, high] = map.kind.cell([point.x, point.y]);
        let tone = tone_of(point);
        Region { low, high, tone }
    };
    let panels = map.points.chunk_by(|a, b| a.engine == b.engine);
    let panels = panels.map(|points| RegionPanel {
        name: points[0].engine.clone(),
        regions: points.iter().map(region).collect(),
    });
    let (title, x_label, x_scale, y_label, line_label, lost) = match map.kind {
        MapKind::Spring => (
            "A spring and its damper against the step",
            "stiffness: k dt²/mu",
            Scale::Log,
            "damping: 2 kd dt/mu",
            "theory for symplectic Euler: the sum is 4",
            "energy over 30 times",
        ),
        MapKind::Orbit => (
            "An orbit against the step",
            "eccentricity",
            Scale::Linear,
            "step: w dt at the smallest distance",
            "theory for symplectic Euler: 2",
            "energy off by more than half",
        ),
    };
    let key = [
        (Tone::Good, "kept"),
        (Tone::Bad, lost),
        (Tone::Broken, "broke down"),
    ];
    let figure = RegionsFigure {
        title: title.to_owned(),
        subtitle: String::new(),
        x_label: x_label.to_owned(),
        x_scale,
        y_label: y_label.to_owned(),
        key: key
            .into_iter()
            .filter(|(tone, _)| map.points.iter().any(|point| tone_of(point) == *tone))
            .map(|(tone, says)| (tone, says.to_owned()))
            .collect(),
        line: limit(map),
        line_label: line_label.to_owned(),
        panels: panels.collect(),
    };
    regions(&figure).map_err(|wrong| unpictured(map_picture(map.kind), &wrong))
}

/// The line of theory, fine enough for its bend.
fn limit(map: &StabilityMap) -> Vec<[f64; 2]> {
    const PIECES: i32 = 400;
    let (Some(first), Some(last)) = (map.across.first(), map.across.last()) else {
        return Vec::new();
    };
    let [[low, lowest], _] = map
        .kind
        .cell([*first, map.up.first().copied().unwrap_or(1.0)]);
    let [_, [high, _]] = map.kind.cell([*last, 1.0]);
    let share = |piece: i32| f64::from(piece) / f64::from(PIECES);
    let x = |piece: i32| match map.kind {
        MapKind::Spring => low * (high / low).powf(share(piece)),
        MapKind::Orbit => low + (high - low) * share(piece),
    };
    let mut line: Vec<[f64; 2]> = Vec::new();
    for x in (0..=PIECES).map(x) {
        let y = map.kind.limit(x);
        if y > 0.0 {
            line.push([x, y.max(lowest)]);
        } else {
            // The line leaves the map through its lower edge.
            line.push([4.0, lowest]);
            break;
        }
    }
    line
}
