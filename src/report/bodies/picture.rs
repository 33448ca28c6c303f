//! The picture of costs over numbers of bodies.

use super::tables::label;
use crate::engine::{EngineKind, EngineSpec, ImpulseSettings, engine};
use crate::error::{Error, Result};
use crate::report::chart::{
    Crossing, LineStyle, ScalingFigure, Spent, Weight, WorkCurve, WorkFigure, WorkPoint, scaling,
};
use crate::report::format::about;
use crate::study::bodies::{BASE, BodiesPoint, BodiesStudy, Series, Walls};

/// The rung that is drawn beside the lecture; the others lie on one of these two.
const RUNG: &str = "swept";
/// The engine that stands for its build where other builds are drawn beside; the other Rapier
/// worlds lie near it.
const OF_BUILD: &str = "rapier";

/// Draws costs of a step over numbers of bodies.
pub(super) fn cost_bodies_png(study: &BodiesStudy) -> Result<Vec<u8>> {
    scaling(&figure(study)).map_err(|wrong| Error::Picture {
        name: "cost-bodies.png",
        message: wrong.to_string(),
    })
}

/// Whether an engine is drawn: of the ladder the lecture and one rung; of another build one that
/// its features can change.
fn is_drawn(study: &BodiesStudy, series: Series) -> bool {
    let is_own = series.build == study.build;
    let drawn = |spec: EngineSpec| match spec.kind {
        EngineKind::Impulse(settings) => {
            is_own && (settings == ImpulseSettings::LECTURE || spec.name == RUNG)
        }
        EngineKind::Exact(_) => is_own,
        EngineKind::Rapier(_) => is_own || spec.name == OF_BUILD,
    };
    engine(series.engine).is_ok_and(drawn)
}

/// What is drawn; everything, where that would be nothing.
fn drawn(study: &BodiesStudy) -> Vec<Series<'_>> {
    let all = study.series();
    let some: Vec<_> = all
        .iter()
        .copied()
        .filter(|series| is_drawn(study, *series))
        .collect();
    if some.is_empty() { all } else { some }
}

#[allow(clippy::cast_precision_loss, reason = "far below 2^53 bodies")]
fn count(bodies: usize) -> f64 {
    bodies as f64
}

fn figure(study: &BodiesStudy) -> ScalingFigure {
    let drawn = drawn(study);
    let mut engines: Vec<&str> = Vec::new();
    let mut builds: Vec<&str> = vec![&study.build];
    for series in &drawn {
        if !engines.contains(&series.engine) {
            engines.push(series.engine);
        }
        if !builds.contains(&series.build) {
            builds.push(series.build);
        }
    }
    let place = |names: &[&str], name: &str| names.iter().position(|n| *n == name).unwrap_or(0);
    let color = |series: &Series| place(&engines, series.engine);
    let curve = |series: &Series| {
        let points = study.of(*series).into_iter();
        WorkCurve {
            label: label(study, *series),
            color: color(series),
            line: if builds.len() > 1 {
                LineStyle::of_voice(place(&builds, series.build))
            } else {
                // Solid and dashed in turn: neighbours that coincide both show.
                LineStyle::of_voice(color(series) % 2)
            },
            weight: Weight::Main,
            points: points.filter_map(|point| point_of(study, point)).collect(),
            others: Vec::new(),
        }
    };
    // Those of other builds are told in the findings: rings upon rings tell nothing.
    let own = drawn.iter().filter(|series| series.build == study.build);
    let crossings = own.flat_map(|series| {
        let crossovers = study.crossovers(*series).into_iter();
        crossovers.map(|crossover| Crossing {
            at: [crossover.bodies, crossover.step_us],
            color: color(series),
            label: about(crossover.bodies),
        })
    });
    let spent = drawn.iter().flat_map(|series| {
        let points = study.of(*series).into_iter();
        let unpaid = points.filter(|point| point.is_over_budget());
        unpaid.map(|point| Spent {
            bodies: count(point.bodies),
            color: color(series),
        })
    });
    ScalingFigure {
        crossings: crossings.collect(),
        crossings_label: format!("costs as much as {BASE}"),
        spent: spent.collect(),
        spent_label: "over its budget, not run".to_owned(),
        work: WorkFigure {
            least: 0.0,
            goals: Vec::new(),
            title: "What a step costs as the number of bodies grows".to_owned(),
            subtitle: format!(
                "elastic gas, {} of its {} box filled, dt {} s; {}; build {}",
                study.options.filling,
                match study.options.walls {
                    Walls::Closed => "closed",
                    Walls::Open => "former",
                },
                study.options.dt,
                study.machine.describe(),
                study.build
            ),
            x_label: "bodies".to_owned(),
            y_label: "µs a step".to_owned(),
            curves: drawn.iter().map(curve).collect(),
            front: Vec::new(),
            enough: None,
        },
    }
}

fn point_of(study: &BodiesStudy, point: &BodiesPoint) -> Option<WorkPoint> {
    Some(WorkPoint {
        error: count(point.bodies),
        price: point.per_step_us(study.options.dt)?,
        label: String::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::bodies::testing::{SIZES, study};

    /// Other builds have lines of their own in the colour of the engine; the ladder's other rungs
    /// are not drawn, and neither is what an unrelated build says of the lecture.
    #[test]
    fn each_engine_has_a_colour_and_each_build_a_line() {
        let laws = [
            (BASE, 2.0, 1e-3),
            ("verlet", 2.0, 2e-3),
            ("rapier", 1.0, 1.0),
            ("rapier-f64", 1.0, 0.5),
        ];
        let mut study = study(&laws);
        let mut other = study.points.clone();
        for point in &mut other {
            "parallel".clone_into(&mut point.build);
        }
        study.points.extend(other);
        let figure = figure(&study);
        let looks = figure.work.curves.iter();
        let looks: Vec<_> = looks.map(|c| (c.label.as_str(), c.color, c.line)).collect();
        assert_eq!(
            looks,
            [
                ("lecture", 0, LineStyle::Solid),
                ("rapier", 1, LineStyle::Solid),
                ("rapier-f64", 2, LineStyle::Solid),
                ("rapier (parallel)", 1, LineStyle::Dashed),
            ]
        );
        assert_eq!(figure.work.curves[0].points.len(), SIZES.len());
        let [own, _] = &figure.crossings[..] else {
            panic!("the crossings of the build that measured, and no others");
        };
        assert!((own.at[0] / 1000.0 - 1.0).abs() < 0.05 && own.color == 1);
    }
}
