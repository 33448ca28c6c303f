//! The work-precision picture of a scene.

use crate::error::{Error, Result};
use crate::report::chart::{LineStyle, WorkCurve, WorkFigure, WorkPoint, work};
use crate::report::engineering;
use crate::study::cost::{CostPoint, EngineCost, SceneCost, pareto_front};

/// Draws price over error of every engine.
pub(super) fn work_precision_png(cost: &SceneCost) -> Result<Vec<u8>> {
    work(&figure(cost)).map_err(|wrong| Error::Picture {
        name: "work-precision",
        message: wrong.to_string(),
    })
}

/// Error and price of a point that has both; the error no smaller than the picture shows.
fn pair(point: &CostPoint, least: f64) -> Option<[f64; 2]> {
    Some([point.error()?.max(least), point.cost()?])
}

/// The smallest error that is shown: a decade below that of any step, so that an engine without
/// steps, whose error is rounding, does not squeeze all others to the side.
fn least_shown(cost: &SceneCost) -> f64 {
    let stepping = cost.points.iter().filter(|point| point.dt.is_some());
    let positive = stepping
        .filter_map(CostPoint::error)
        .filter(|error| *error > 0.0);
    positive.reduce(f64::min).map_or(0.0, |error| 0.1 * error)
}

fn figure(cost: &SceneCost) -> WorkFigure {
    let scene = &cost.scene;
    let unit = scene.units.length.symbol();
    let engines = cost.engines.iter().enumerate();
    let least = least_shown(cost);
    let curves = engines.map(|(place, engine)| curve(cost, place, engine, least));
    let points = cost.points.iter();
    let (exact, all): (Vec<_>, Vec<_>) = points
        .filter_map(|point| Some((pair(point, 0.0)?, pair(point, least)?)))
        .unzip();
    let front = pareto_front(&exact).into_iter().map(|place| all[place]);
    let until = cost.compared_until.map_or_else(
        || "against each one's own finest step".to_owned(),
        |until| format!("up to {} s", engineering(until)),
    );
    let sensitivity = cost.sensitivity.as_ref();
    WorkFigure {
        title: scene.heading().to_owned(),
        subtitle: format!("what accuracy costs: steps dt beside the points, errors {until}"),
        x_label: if unit.is_empty() {
            "largest position error".to_owned()
        } else {
            format!("largest position error [{unit}]")
        },
        y_label: "ms per simulated second".to_owned(),
        curves: curves.collect(),
        front: front.collect(),
        enough: sensitivity.map(|off| {
            let moved = format!("{} {unit}", engineering(off.moved));
            let label = format!("a ball placed {} off does this", moved.trim_end());
            (off.distance, label)
        }),
    }
}

fn curve(cost: &SceneCost, place: usize, engine: &EngineCost, least: f64) -> WorkCurve {
    let name = &engine.spec.name;
    let unit = cost.scene.units.length.symbol();
    let label = |point: &CostPoint| match (point.dt, point.error()) {
        (Some(dt), _) => format!("{} s", engineering(dt)),
        (None, Some(error)) if error < least => format!("← {} {unit}", engineering(error))
            .trim_end()
            .to_owned(),
        (None, _) => String::new(),
    };
    let point = |point: &CostPoint| {
        let [error, price] = pair(point, least)?;
        Some(WorkPoint {
            error,
            price,
            label: label(point),
        })
    };
    let others = cost.points.iter();
    let others = others.filter(|point| point.engine == *name && !point.is_stock());
    WorkCurve {
        label: name.clone(),
        color: place,
        // Solid and dashed in turn: neighbours that coincide both show.
        line: LineStyle::of_voice(place % 2),
        points: cost.stock(name).filter_map(point).collect(),
        others: others.filter_map(|point| pair(point, least)).collect(),
    }
}
