//! Costs over numbers of bodies, both on logarithmic axes: the plot of work and precision, with
//! a number where the error stands.

use super::ChartError;
use super::axis::{Axis, fitting};
use super::canvas::{Align, Lettering, picture};
use super::legend::{Entry, Key, Legend};
use super::polyline::{Frame, dotted};
use super::room::{NEAR, Room, around};
use super::text::width;
use super::theme::{CANVAS, INK, MARGIN, Pen, color};
use super::work::{draw_axes, draw_curves};
use super::work_figure::WorkFigure;
use super::work_look::{NOTE_PX, RING, pen, point_radius, ring};
use super::work_plot::{Plot, layout};

/// Length of the stroke that stands for a run over its budget.
const STROKE: f64 = 26.0;

/// A picture of costs over numbers of bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct ScalingFigure {
    /// Names, axes and curves; the error of a point is its number of bodies.
    pub work: WorkFigure,
    /// Where curves cross; ringed and labelled.
    pub crossings: Vec<Crossing>,
    /// What the rings stand for.
    pub crossings_label: String,
    /// Runs that were not made.
    pub spent: Vec<Spent>,
    /// What the strokes at the upper edge stand for.
    pub spent_label: String,
}

/// A place where two curves cross.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossing {
    /// Number and cost.
    pub at: [f64; 2],
    /// Index of its colour.
    pub color: usize,
    /// What is written beside it, where there is room.
    pub label: String,
}

/// A run that was not made: a stroke at the upper edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spent {
    /// Number of bodies.
    pub bodies: f64,
    /// Index of the colour of its engine.
    pub color: usize,
}

/// Draws costs over numbers of bodies as a PNG.
///
/// # Errors
/// None that depends on the data: see [`ChartError`].
pub fn scaling(figure: &ScalingFigure) -> Result<Vec<u8>, ChartError> {
    picture(|canvas| {
        let mut top = canvas.heading(&figure.work.title, &figure.work.subtitle)?;
        let legend = Legend::flow(&entries(figure), CANVAS[0] - 2.0 * MARGIN, 5)?;
        legend.draw(canvas, MARGIN, top)?;
        top += legend.height;
        let mut plot = layout(&figure.work, top)?;
        plot.errors = numbers(figure, &plot.frame)?;
        draw_axes(canvas, &figure.work, &plot)?;
        draw_curves(canvas, &figure.work, &plot)?;
        for (stroke, color_of) in strokes(figure, &plot) {
            canvas.line(&stroke, Pen::solid(color(color_of), 6.0))?;
        }
        let mut room = room(figure, &plot);
        for crossing in &figure.crossings {
            let Some(at) = plot.place(crossing.at) else {
                continue;
            };
            canvas.ring(at, RING, Pen::solid(color(crossing.color), 3.0))?;
            let size = [width(&crossing.label, NOTE_PX)?, 1.1 * NOTE_PX];
            if let Some(free) = room.beside(&[at], &NEAR, size) {
                let look = Lettering {
                    px: NOTE_PX,
                    color: color(crossing.color),
                    align: Align::Left,
                };
                let middle = f64::midpoint(free.top, free.bottom);
                canvas.text(&crossing.label, [free.left, middle], look)?;
            }
        }
        Ok(())
    })
}

/// The axis of the numbers of bodies: round ones, so that the largest may lie on its end.
fn numbers(figure: &ScalingFigure, frame: &Frame) -> Result<Axis, ChartError> {
    let points = figure.work.curves.iter().flat_map(|curve| &curve.points);
    let measured = points.map(|point| point.error);
    let all: Vec<f64> = measured
        .chain(figure.spent.iter().map(|spent| spent.bodies))
        .filter(|bodies| *bodies > 0.0)
        .collect();
    fitting(frame.width(), |most| Axis::decades(&all, most))
}

fn entries(figure: &ScalingFigure) -> Vec<Vec<Entry>> {
    let curves = figure.work.curves.iter();
    let lines = curves.map(|curve| Entry::new(Key::Line(pen(curve)), curve.label.clone()));
    let mut keys = Vec::new();
    if !figure.crossings.is_empty() {
        keys.push(Entry::new(
            Key::Ring(ring()),
            figure.crossings_label.clone(),
        ));
    }
    if !figure.spent.is_empty() {
        keys.push(Entry::new(Key::Strokes(INK), figure.spent_label.clone()));
    }
    vec![lines.collect(), keys]
}

/// The strokes of the runs that were not made, and their colours; side by side where several
/// have the same number of bodies.
fn strokes(figure: &ScalingFigure, plot: &Plot) -> Vec<([[f64; 2]; 2], usize)> {
    let frame = plot.frame;
    let stroke = |(place, spent): (usize, &Spent)| {
        let before = figure.spent[..place].iter();
        let beside = before.filter(|other| other.bodies == spent.bodies).count();
        #[allow(clippy::cast_precision_loss, reason = "a handful of engines")]
        let x = plot.column(spent.bodies)? - 12.0 * beside as f64;
        let ends = [[x, frame.top + 4.0], [x, frame.top + 4.0 + STROKE]];
        Some((ends, spent.color))
    };
    figure.spent.iter().enumerate().filter_map(stroke).collect()
}

/// What labels must not cover, points and rings, and should not, the lines of the curves.
fn room(figure: &ScalingFigure, plot: &Plot) -> Room {
    let mut room = Room::new(plot.frame);
    for curve in &figure.work.curves {
        let line: Vec<_> = plot.places(curve).iter().map(|(at, _)| *at).collect();
        let radius = point_radius(curve);
        for at in dotted(&line, 0.0, radius) {
            room.spare(around(at, 0.5 * radius));
        }
        for at in line {
            room.take(around(at, radius));
        }
    }
    for crossing in &figure.crossings {
        if let Some(at) = plot.place(crossing.at) {
            room.take(around(at, RING));
        }
    }
    room
}

#[cfg(test)]
mod tests {
    use super::super::testing::decode;
    use super::super::{LineStyle, Weight, WorkCurve, WorkPoint};
    use super::*;

    fn figure(points: &[[f64; 2]]) -> ScalingFigure {
        let point = |[bodies, cost]: &[f64; 2]| WorkPoint {
            error: *bodies,
            price: *cost,
            label: String::new(),
        };
        ScalingFigure {
            work: WorkFigure {
                least: 0.0,
                goals: Vec::new(),
                title: "t".into(),
                subtitle: "s".into(),
                x_label: "bodies".into(),
                y_label: "price".into(),
                curves: vec![WorkCurve {
                    weight: Weight::Main,
                    label: "a".into(),
                    color: 0,
                    line: LineStyle::Solid,
                    points: points.iter().map(point).collect(),
                    others: Vec::new(),
                }],
                front: Vec::new(),
                enough: None,
            },
            crossings: Vec::new(),
            crossings_label: "crossing".into(),
            spent: Vec::new(),
            spent_label: "spent".into(),
        }
    }

    #[test]
    fn crossings_and_runs_not_made_leave_their_marks() {
        let plain = figure(&[[4.0, 1.0], [10_000.0, 100.0]]);
        let mut marked = plain.clone();
        marked.spent = vec![
            Spent {
                bodies: 10_000.0,
                color: 1,
            };
            2
        ];
        marked.crossings = vec![Crossing {
            at: [200.0, 10.0],
            color: 1,
            label: "200".into(),
        }];
        let ink = |figure: &ScalingFigure| decode(&scaling(figure).unwrap()).ink();
        assert!(ink(&marked) > ink(&plain) + 1000);
        let plot = layout(&marked.work, 100.0).unwrap();
        let [(first, _), (second, _)] = strokes(&marked, &plot)[..] else {
            panic!("two strokes");
        };
        assert!(second[0][0] < first[0][0] - 10.0, "side by side");
    }

    #[test]
    fn no_data_make_it_fail() {
        let strange = [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e308, 5e-324];
        let pairs = strange.iter().flat_map(|a| strange.map(|b| [*a, b]));
        let mut all = figure(&pairs.collect::<Vec<_>>());
        all.crossings = vec![Crossing {
            at: [f64::NAN, 1.0],
            color: 0,
            label: String::new(),
        }];
        all.spent = vec![Spent {
            bodies: f64::NAN,
            color: 0,
        }];
        decode(&scaling(&all).unwrap());
        let mut nothing = figure(&[]);
        nothing.work.curves.clear();
        decode(&scaling(&nothing).unwrap());
    }
}
