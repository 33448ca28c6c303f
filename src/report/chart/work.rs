//! Work and precision: price over error, both on logarithmic axes.

use super::ChartError;
use super::axis::{Axis, extent, fitting};
use super::canvas::{Align, Canvas, Lettering, picture};
use super::legend::{Entry, Key, Legend};
use super::polyline::{Frame, Point, clipped, dotted};
use super::text::{shortened, width};
use super::theme::{
    CANVAS, FRAME, GRID, INK, LABEL_PX, LineStyle, MARGIN, PAPER, Pen, QUIET, SMALL_PX, color, mix,
};

/// Height of the line of text above the plot.
const HEADING: f64 = 42.0;
/// Room below the plot for the labels and the name of its axis.
const FOOT: f64 = 88.0;
/// Radius of a point.
pub(super) const POINT: f64 = 8.0;
/// Radius of a point of other settings.
const OTHER: f64 = 4.0;
/// Radius of the ring around a point of the front.
pub(super) const RING: f64 = 14.0;
/// Height of the letters beside points, in pixels: legible at a third of the size.
pub(super) const NOTE_PX: f64 = 22.0;

/// A picture of prices over errors.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkFigure {
    /// What is shown.
    pub title: String,
    /// What else the reader should know; may be empty.
    pub subtitle: String,
    /// Name and unit of the error, on the axis below.
    pub x_label: String,
    /// Name and unit of the price, on the upright axis.
    pub y_label: String,
    /// The curves; later ones lie on top.
    pub curves: Vec<WorkCurve>,
    /// Points (error, price) that nothing beats; ringed.
    pub front: Vec<[f64; 2]>,
    /// An error with a name, shown as an upright line: below it accuracy does not matter.
    pub enough: Option<(f64, String)>,
}

/// One way to compute, over its ladder of steps.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkCurve {
    /// Its name in the legend.
    pub label: String,
    /// Index of its colour; they repeat after [`super::COLOR_COUNT`].
    pub color: usize,
    /// How the line is broken.
    pub line: LineStyle,
    /// Joined in this order.
    pub points: Vec<WorkPoint>,
    /// Loose points (error, price) beneath: the same with other settings.
    pub others: Vec<[f64; 2]>,
}

/// One run. What is not finite and positive is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkPoint {
    /// Error; an exact 0 lies on a line of its own.
    pub error: f64,
    /// Price.
    pub price: f64,
    /// What is written beside it where there is room; may be empty.
    pub label: String,
}

/// Draws prices over errors as a PNG.
///
/// # Errors
/// None that depends on the data: see [`ChartError`].
pub fn work(figure: &WorkFigure) -> Result<Vec<u8>, ChartError> {
    picture(|canvas| {
        let mut top = canvas.heading(&figure.title, &figure.subtitle)?;
        let legend = Legend::flow(&entries(figure), CANVAS[0] - 2.0 * MARGIN, 5)?;
        legend.draw(canvas, MARGIN, top)?;
        top += legend.height;
        let plot = layout(figure, top)?;
        draw_axes(canvas, figure, &plot)?;
        draw_enough(canvas, figure, &plot)?;
        draw_curves(canvas, figure, &plot)?;
        draw_notes(canvas, figure, &plot)
    })
}

/// Where the plot is, and its axes.
pub(super) struct Plot {
    pub(super) frame: Frame,
    pub(super) errors: Axis,
    prices: Axis,
}

impl Plot {
    pub(super) fn place(&self, [error, price]: [f64; 2]) -> Option<Point> {
        let x = self.column(error)?;
        Some([x, self.frame.y(self.prices.share(price)?)])
    }

    /// The column of an error.
    pub(super) fn column(&self, error: f64) -> Option<f64> {
        Some(self.frame.x(self.errors.share(error)?))
    }
}

pub(super) fn pen(curve: &WorkCurve) -> Pen {
    Pen {
        color: color(curve.color),
        width: 4.5,
        style: curve.line,
    }
}

fn entries(figure: &WorkFigure) -> Vec<Vec<Entry>> {
    let curves = figure.curves.iter();
    let lines = curves.map(|curve| {
        let key = if curve.points.len() > 1 {
            Key::Line(pen(curve))
        } else {
            Key::Disc(color(curve.color))
        };
        Entry::new(key, curve.label.clone())
    });
    let mut keys = Vec::new();
    if !figure.front.is_empty() {
        keys.push(Entry::new(
            Key::Ring(ring()),
            "nothing is better and cheaper",
        ));
    }
    if figure.curves.iter().any(|curve| !curve.others.is_empty()) {
        keys.push(Entry::new(Key::Remark, "small dots: other settings"));
    }
    vec![lines.collect(), keys]
}

pub(super) fn ring() -> Pen {
    Pen::solid(INK, 3.0)
}

pub(super) fn layout(figure: &WorkFigure, top: f64) -> Result<Plot, ChartError> {
    let (mut errors, mut prices) = (Vec::new(), Vec::new());
    for curve in &figure.curves {
        let points = curve.points.iter().map(|point| [point.error, point.price]);
        for [error, price] in points.chain(curve.others.iter().copied()) {
            if error.is_finite() && error >= 0.0 && price.is_finite() && price > 0.0 {
                errors.push(error);
                prices.push(price);
            }
        }
    }
    errors.extend(figure.enough.iter().map(|(error, _)| *error));
    let bottom = CANVAS[1] - FOOT;
    let rows = (bottom - top - HEADING).max(0.0) / (1.5 * SMALL_PX);
    let fits = |count: &u32| f64::from(*count) <= rows;
    let prices = snug(&prices, (3..=12).rfind(fits).unwrap_or(3));
    let mut gutter: f64 = 0.0;
    for label in &prices.labels {
        gutter = gutter.max(width(&label.text, SMALL_PX)?);
    }
    let frame = Frame {
        left: MARGIN + gutter + 14.0,
        top: top + HEADING,
        right: CANVAS[0] - MARGIN - 20.0,
        bottom,
    };
    let errors = fitting(frame.width(), |most| snug(&errors, most))?;
    Ok(Plot {
        frame,
        errors,
        prices,
    })
}

/// A logarithmic axis whose extreme values do not lie on its ends.
fn snug(values: &[f64], most: u32) -> Axis {
    let positive: Vec<f64> = values.iter().copied().filter(|v| *v > 0.0).collect();
    let mut all = values.to_vec();
    if let Some([low, high]) = extent(&positive) {
        all.extend([low / 1.2, high * 1.2]);
    }
    Axis::decades(&all, most)
}

pub(super) fn draw_axes(
    canvas: &Canvas,
    figure: &WorkFigure,
    plot: &Plot,
) -> Result<(), ChartError> {
    let frame = &plot.frame;
    let small = |align| Lettering {
        px: SMALL_PX,
        color: QUIET,
        align,
    };
    for label in &plot.prices.labels {
        let y = frame.y(label.share);
        canvas.rule(&[[frame.left, y], [frame.right, y]], Pen::solid(GRID, 2.0))?;
        canvas.text(&label.text, [frame.left - 12.0, y], small(Align::Right))?;
    }
    for label in &plot.errors.labels {
        let x = frame.x(label.share);
        canvas.rule(&[[x, frame.top], [x, frame.bottom]], Pen::solid(GRID, 2.0))?;
        canvas.text(&label.text, [x, frame.bottom + 22.0], small(Align::Center))?;
    }
    canvas.rule(&frame.outline(), Pen::solid(FRAME, 2.0))?;
    let name = |align| Lettering {
        px: LABEL_PX,
        color: INK,
        align,
    };
    let heading = [frame.left, frame.top - 0.45 * HEADING];
    let label = shortened(&figure.y_label, LABEL_PX, frame.width())?;
    canvas.text(&label, heading, name(Align::Left))?;
    let label = shortened(&figure.x_label, LABEL_PX, frame.width())?;
    let middle = f64::midpoint(frame.left, frame.right);
    canvas.text(&label, [middle, frame.bottom + 60.0], name(Align::Center))
}

/// The line where accuracy stops mattering, with its name at the upper end.
fn draw_enough(canvas: &Canvas, figure: &WorkFigure, plot: &Plot) -> Result<(), ChartError> {
    let Some((error, label)) = &figure.enough else {
        return Ok(());
    };
    let Some(share) = plot.errors.share(*error) else {
        return Ok(());
    };
    let frame = &plot.frame;
    let x = frame.x(share);
    let pen = Pen {
        color: QUIET,
        width: 3.0,
        style: LineStyle::Dashed,
    };
    canvas.line(&[[x, frame.top], [x, frame.bottom]], pen)?;
    let (room, align, at) = if share > 0.5 {
        (x - frame.left, Align::Right, x - 12.0)
    } else {
        (frame.right - x, Align::Left, x + 12.0)
    };
    let look = Lettering {
        px: NOTE_PX,
        color: QUIET,
        align,
    };
    let label = shortened(label, NOTE_PX, room - 24.0)?;
    canvas.text(&label, [at, frame.top + NOTE_PX], look)
}

pub(super) fn draw_curves(
    canvas: &Canvas,
    figure: &WorkFigure,
    plot: &Plot,
) -> Result<(), ChartError> {
    for curve in &figure.curves {
        let pale = mix(color(curve.color), PAPER, 0.45);
        for at in curve.others.iter().filter_map(|point| plot.place(*point)) {
            canvas.disc(at, OTHER, pale)?;
        }
    }
    for curve in &figure.curves {
        let places: Vec<Point> = places(curve, plot).map(|(at, _)| at).collect();
        if places.len() > 1 {
            for part in clipped(&places, &plot.frame) {
                canvas.line(&part, pen(curve))?;
            }
        }
        for at in places {
            canvas.disc(at, POINT, color(curve.color))?;
        }
    }
    for at in figure.front.iter().filter_map(|point| plot.place(*point)) {
        canvas.ring(at, RING, ring())?;
    }
    Ok(())
}

pub(super) fn places<'a>(
    curve: &'a WorkCurve,
    plot: &'a Plot,
) -> impl Iterator<Item = (Point, &'a WorkPoint)> {
    let points = curve.points.iter();
    points.filter_map(|point| Some((plot.place([point.error, point.price])?, point)))
}

/// Labels beside points where there is room: the ends of each curve first, then what lies
/// between. A label never covers a point or another label.
fn draw_notes(canvas: &Canvas, figure: &WorkFigure, plot: &Plot) -> Result<(), ChartError> {
    let mut taken: Vec<Frame> = Vec::new();
    for curve in &figure.curves {
        taken.extend(places(curve, plot).map(|(at, _)| around(at, POINT)));
    }
    for at in figure.front.iter().filter_map(|point| plot.place(*point)) {
        taken.push(around(at, RING));
    }
    let enough = figure.enough.as_ref();
    if let Some(share) = enough.and_then(|(error, _)| plot.errors.share(*error)) {
        let x = plot.frame.x(share);
        taken.push(Frame {
            left: x - 4.0,
            right: x + 4.0,
            ..plot.frame
        });
        // The name of the line.
        taken.push(Frame {
            bottom: plot.frame.top + 2.0 * NOTE_PX,
            ..plot.frame
        });
    }
    // Small dots and lines are covered only where a label finds no other place.
    let dots = figure.curves.iter().flat_map(|curve| &curve.others);
    let dots = dots.filter_map(|point| Some(around(plot.place(*point)?, OTHER)));
    let mut thin: Vec<Frame> = dots.collect();
    for curve in &figure.curves {
        let line: Vec<Point> = places(curve, plot).map(|(at, _)| at).collect();
        let beads = dotted(&line, 0.0, 2.0 * OTHER).into_iter();
        thin.extend(beads.map(|at| around(at, OTHER)));
    }
    for ends in [true, false] {
        for curve in &figure.curves {
            let all: Vec<_> = places(curve, plot).collect();
            let look = Lettering {
                px: NOTE_PX,
                color: mix(color(curve.color), INK, 0.35),
                align: Align::Left,
            };
            for (place, (at, point)) in all.iter().enumerate() {
                let is_end = place == 0 || place + 1 == all.len();
                let wanted = if ends {
                    is_end
                } else {
                    !is_end && place % 3 == 0 && place + 2 < all.len()
                };
                if !wanted || point.label.is_empty() {
                    continue;
                }
                let wide = width(&point.label, NOTE_PX)?;
                let clear = free(*at, wide, &plot.frame, &[&taken[..], &thin].concat());
                if let Some(free) = clear.or_else(|| free(*at, wide, &plot.frame, &taken)) {
                    let middle = f64::midpoint(free.top, free.bottom);
                    canvas.text(&point.label, [free.left, middle], look)?;
                    taken.push(free);
                }
            }
        }
    }
    Ok(())
}

pub(super) fn around([x, y]: Point, reach: f64) -> Frame {
    Frame {
        left: x - reach,
        top: y - reach,
        right: x + reach,
        bottom: y + reach,
    }
}

/// Room for a label beside a point, to the right, left, above or below, that nothing takes.
pub(super) fn free([x, y]: Point, wide: f64, frame: &Frame, taken: &[Frame]) -> Option<Frame> {
    let (gap, half) = (RING + 3.0, 0.55 * NOTE_PX);
    let [right, left] = [x + gap, x - gap - wide];
    let corners = [
        [right, y],
        [left, y],
        [right - gap, y - gap - half],
        [right - gap, y + gap + half],
        [left + gap, y - gap - half],
        [left + gap, y + gap + half],
    ];
    let label = |[left, middle]: Point| Frame {
        left,
        top: middle - half,
        right: left + wide,
        bottom: middle + half,
    };
    let fits = |label: &Frame| {
        let inside =
            frame.contains([label.left, label.top]) && frame.contains([label.right, label.bottom]);
        inside && !taken.iter().any(|other| overlap(label, other))
    };
    corners.into_iter().map(label).find(fits)
}

fn overlap(a: &Frame, b: &Frame) -> bool {
    a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom
}

#[cfg(test)]
mod tests {
    use super::super::testing::decode;
    use super::super::text::register;
    use super::*;

    fn point(error: f64, price: f64) -> WorkPoint {
        WorkPoint {
            error,
            price,
            label: "0.1 s".to_owned(),
        }
    }

    fn figure(points: Vec<WorkPoint>) -> WorkFigure {
        WorkFigure {
            title: "t".into(),
            subtitle: "s".into(),
            x_label: "error [mm]".into(),
            y_label: "price".into(),
            curves: vec![WorkCurve {
                label: "a".into(),
                color: 0,
                line: LineStyle::Solid,
                points,
                others: vec![[1.0, 1.0]],
            }],
            front: vec![[0.1, 10.0]],
            enough: Some((1.0, "enough".into())),
        }
    }

    #[test]
    fn points_land_on_their_decades() {
        register().unwrap();
        let figure = figure(vec![point(10.0, 1.0), point(0.1, 10.0)]);
        let plot = layout(&figure, 100.0).unwrap();
        let [[left, above], [right, below]] =
            [[0.1, 10.0], [10.0, 1.0]].map(|at| plot.place(at).unwrap());
        assert!(left < right && above < below);
        let middle = plot.place([1.0, 1.0]).unwrap();
        assert!((middle[0] - f64::midpoint(left, right)).abs() < 1e-9);
        let image = decode(&work(&figure).unwrap());
        assert!(image.ink() > 5000);
    }

    #[test]
    fn no_data_make_it_fail() {
        let strange = [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e308, 5e-324];
        let pairs = strange.iter().flat_map(|a| strange.map(|b| point(*a, b)));
        let mut all = figure(pairs.collect());
        assert_eq!(work(&all).unwrap(), work(&all).unwrap());
        all.enough = Some((f64::NAN, String::new()));
        decode(&work(&all).unwrap());
        let mut nothing = figure(Vec::new());
        nothing.curves.clear();
        decode(&work(&nothing).unwrap());
    }

    #[test]
    fn a_label_covers_no_point_and_no_other_label() {
        let frame = Frame {
            left: 0.0,
            top: 0.0,
            right: 400.0,
            bottom: 400.0,
        };
        let first = free([200.0, 200.0], 60.0, &frame, &[]).unwrap();
        assert!(first.left > 200.0);
        let second = free([200.0, 200.0], 60.0, &frame, &[first]).unwrap();
        assert!(second.right < 200.0 && !overlap(&first, &second));
        let everything = [frame];
        assert_eq!(free([200.0, 200.0], 60.0, &frame, &everything), None);
        let at_the_edge = free([395.0, 200.0], 60.0, &frame, &[]).unwrap();
        assert!(at_the_edge.right < 395.0);
    }
}
