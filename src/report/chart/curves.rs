//! Curves over time, in one to three panels that share the time axis.

use super::ChartError;
use super::axis::{Axis, Scale, Steadiness, fitting};
use super::canvas::{Align, Canvas, Lettering, picture};
use super::legend::{Entry, Key, Legend};
use super::polyline::{Frame, clipped, runs, thinned_columns};
use super::text::{shortened, width};
use super::theme::{
    CANVAS, DASHED_PX, DOT, FRAME, GRID, INK, LABEL_PX, LineStyle, MARGIN, PAPER, Pen, QUIET,
    SMALL_PX, color, mix,
};
use super::ticks::with_exponent;

/// Height of the line of text above a panel.
const HEADING: f64 = 42.0;
/// Height of one row of marks.
const MARK_ROW: f64 = 26.0;
/// Room below the panels for the labels and the name of the time axis.
const FOOT: f64 = 88.0;
/// More marks than this and they would grey the panels out: no lines through them.
const MOST_GUIDES: usize = 40;

/// A picture of curves over time.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvesFigure {
    /// What is shown.
    pub title: String,
    /// What else the reader should know; may be empty.
    pub subtitle: String,
    /// Name and unit of the shared axis, such as `time [s]`.
    pub x_label: String,
    /// One to three, from top to bottom.
    pub panels: Vec<Panel>,
    /// Instants to point out, such as impacts: one row of strokes each, below the panels.
    pub marks: Vec<Marks>,
}

/// One plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Name and unit, such as `total energy [kg·mm²/s²]`.
    pub y_label: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// The curves; later ones lie on top.
    pub curves: Vec<Curve>,
    /// Linear scale: the size that changes are compared with where the values themselves
    /// do not tell, as with one component of a momentum; 0 if they do.
    pub size: f64,
    /// Linear scale: a range below this share of the size is drawn as a flat line with a
    /// note, instead of magnifying rounding noise to the height of the panel; 0 to
    /// magnify all the same.
    pub least_span: f64,
}

impl Panel {
    /// A panel without curves that draws ranges below 1e-9 of the values flat.
    #[must_use]
    pub fn new(y_label: impl Into<String>, scale: Scale) -> Self {
        Self {
            y_label: y_label.into(),
            scale,
            curves: Vec::new(),
            size: 0.0,
            least_span: 1e-9,
        }
    }
}

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its name in the legend; curves of several panels with the same name and look
    /// share an entry.
    pub label: String,
    /// Index of its colour; they repeat after [`super::COLOR_COUNT`].
    pub color: usize,
    /// How the line is broken.
    pub line: LineStyle,
    /// Main curve or companion.
    pub weight: Weight,
    /// Time and value. A value that is not finite leaves a gap.
    pub points: Vec<[f64; 2]>,
}

/// How much a curve stands out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    /// What the picture is about.
    Main,
    /// Thinner and paler, drawn beneath: a part of a total, a reference.
    Aside,
}

/// Instants to point out.
#[derive(Debug, Clone, PartialEq)]
pub struct Marks {
    /// Their name in the legend.
    pub label: String,
    /// Index of their colour.
    pub color: usize,
    /// When; those outside the time span of the curves are not drawn.
    pub times: Vec<f64>,
}

/// Draws curves over time as a PNG.
///
/// # Errors
/// None that depends on the data: see [`ChartError`].
pub fn curves(figure: &CurvesFigure) -> Result<Vec<u8>, ChartError> {
    picture(|canvas| {
        let mut top = canvas.heading(&figure.title, &figure.subtitle)?;
        let legend = Legend::flow(&entries(figure), CANVAS[0] - 2.0 * MARGIN, 4)?;
        legend.draw(canvas, MARGIN, top)?;
        top += legend.height;
        let plots = layout(figure, top)?;
        let times = time_axis(figure, &plots)?;
        for (panel, plot) in figure.panels.iter().zip(&plots) {
            draw_panel(canvas, panel, plot, &times, &figure.marks)?;
        }
        if let Some(last) = plots.last() {
            draw_foot(canvas, figure, &last.frame, &times)?;
        }
        Ok(())
    })
}

/// A panel's place and its upright axis.
struct Plot {
    frame: Frame,
    axis: Axis,
}

/// The pen of a curve.
fn pen(curve: &Curve) -> Pen {
    let width = match curve.line {
        LineStyle::Solid => 8.0,
        LineStyle::Dashed => DASHED_PX,
        LineStyle::Dotted => DASHED_PX * DOT,
    };
    let full = color(curve.color);
    let (color, width) = match curve.weight {
        Weight::Main => (full, width),
        Weight::Aside => (mix(full, PAPER, 0.2), width * 0.45),
    };
    Pen {
        color,
        width,
        style: curve.line,
    }
}

/// The legend: every look once, then the marks.
fn entries(figure: &CurvesFigure) -> Vec<Vec<Entry>> {
    let mut lines: Vec<Entry> = Vec::new();
    for curve in figure.panels.iter().flat_map(|panel| &panel.curves) {
        let entry = Entry::new(Key::Line(pen(curve)), curve.label.clone());
        if !lines.contains(&entry) {
            lines.push(entry);
        }
    }
    let strokes = |marks: &Marks| Entry::new(Key::Strokes(color(marks.color)), &*marks.label);
    vec![lines, figure.marks.iter().map(strokes).collect()]
}

/// Shares the height among the panels; their left edges leave room for the widest label.
fn layout(figure: &CurvesFigure, top: f64) -> Result<Vec<Plot>, ChartError> {
    let mark_rows = figure.marks.iter().fold(0.0, |sum, _| sum + MARK_ROW);
    let bottom = CANVAS[1] - FOOT - mark_rows;
    let count = figure
        .panels
        .iter()
        .fold(0.0_f64, |sum, _| sum + 1.0)
        .max(1.0);
    let each = (bottom - top) / count;
    let rows = f64::max(each - HEADING, 0.0) / (1.5 * SMALL_PX);
    let fits = |count: &u32| f64::from(*count) <= rows;
    let most = (3..=12).rfind(fits).unwrap_or(3);
    let axes: Vec<Axis> = figure
        .panels
        .iter()
        .map(|panel| upright_axis(panel, most))
        .collect();
    let mut gutter: f64 = 0.0;
    for label in axes.iter().flat_map(|axis| &axis.labels) {
        gutter = gutter.max(width(&label.text, SMALL_PX)?);
    }
    let mut row = top;
    let mut plots = Vec::new();
    for axis in axes {
        let frame = Frame {
            left: MARGIN + gutter + 14.0,
            top: row + HEADING,
            right: CANVAS[0] - MARGIN - 20.0,
            bottom: row + each,
        };
        row += each;
        plots.push(Plot { frame, axis });
    }
    Ok(plots)
}

fn upright_axis(panel: &Panel, most: u32) -> Axis {
    let values: Vec<f64> = panel
        .curves
        .iter()
        .flat_map(|curve| curve.points.iter())
        .filter(|point| point[0].is_finite())
        .map(|point| point[1])
        .collect();
    match panel.scale {
        Scale::Linear => {
            let steady = Steadiness {
                size: if panel.size.is_finite() {
                    panel.size.abs().min(1e300)
                } else {
                    0.0
                },
                least_span: panel.least_span,
            };
            Axis::holding(&values, steady, most)
        }
        Scale::Log => Axis::decades(&values, most),
    }
}

/// The time axis, with as many labels as fit side by side.
fn time_axis(figure: &CurvesFigure, plots: &[Plot]) -> Result<Axis, ChartError> {
    let mut times: Vec<f64> = figure
        .panels
        .iter()
        .flat_map(|panel| &panel.curves)
        .flat_map(|curve| curve.points.iter().map(|point| point[0]))
        .filter(|time| time.is_finite())
        .collect();
    if times.is_empty() {
        times.extend(figure.marks.iter().flat_map(|marks| &marks.times));
    }
    let room = plots.first().map_or(CANVAS[0], |plot| plot.frame.width());
    fitting(room, |most| Axis::tight(&times, most))
}

fn draw_panel(
    canvas: &Canvas,
    panel: &Panel,
    plot: &Plot,
    times: &Axis,
    marks: &[Marks],
) -> Result<(), ChartError> {
    let frame = &plot.frame;
    draw_heading(canvas, panel, plot)?;
    draw_grid(canvas, plot, times)?;
    for marks in marks
        .iter()
        .filter(|marks| marks.times.len() <= MOST_GUIDES)
    {
        let pen = Pen::solid(mix(color(marks.color), PAPER, 0.7), 2.0);
        for x in columns(marks, times, frame) {
            canvas.rule(&[[x, frame.top], [x, frame.bottom]], pen)?;
        }
    }
    canvas.rule(&frame.outline(), Pen::solid(FRAME, 2.0))?;
    for weight in [Weight::Aside, Weight::Main] {
        for curve in panel.curves.iter().filter(|curve| curve.weight == weight) {
            let points = curve.points.iter().map(|point| {
                let x = frame.x(times.share(point[0])?);
                Some([x, frame.y(plot.axis.share(point[1])?)])
            });
            for run in runs(points) {
                for part in clipped(&thinned_columns(&run), frame) {
                    canvas.line(&part, pen(curve))?;
                }
            }
        }
    }
    Ok(())
}

/// Name of the upright axis on the left, what must be known about it on the right.
fn draw_heading(canvas: &Canvas, panel: &Panel, plot: &Plot) -> Result<(), ChartError> {
    let frame = &plot.frame;
    let row = frame.top - 0.45 * HEADING;
    let room = frame.width();
    let note = plot.axis.note.as_deref().unwrap_or_default();
    let note = shortened(note, SMALL_PX, 0.5 * room)?;
    let taken = width(&note, SMALL_PX)?;
    let look = Lettering {
        px: SMALL_PX,
        color: QUIET,
        align: Align::Right,
    };
    canvas.text(&note, [frame.right, row], look)?;
    let label = with_exponent(&panel.y_label, plot.axis.exponent);
    let label = shortened(&label, LABEL_PX, room - taken - 30.0)?;
    let look = Lettering {
        px: LABEL_PX,
        color: INK,
        align: Align::Left,
    };
    canvas.text(&label, [frame.left, row], look)
}

/// Lines and labels of the upright axis; upright lines at the labels of the time axis.
fn draw_grid(canvas: &Canvas, plot: &Plot, times: &Axis) -> Result<(), ChartError> {
    let frame = &plot.frame;
    let band = plot.axis.zero_band();
    if band > 0.0 {
        let top = frame.y(band * 0.6);
        canvas.fill(&Frame { top, ..*frame }, mix(GRID, PAPER, 0.55))?;
    }
    let across = |y: f64| [[frame.left, y], [frame.right, y]];
    for share in &plot.axis.minor {
        canvas.rule(
            &across(frame.y(*share)),
            Pen::solid(mix(GRID, PAPER, 0.5), 1.0),
        )?;
    }
    for label in &times.labels {
        let x = frame.x(label.share);
        canvas.rule(&[[x, frame.top], [x, frame.bottom]], Pen::solid(GRID, 2.0))?;
    }
    let look = Lettering {
        px: SMALL_PX,
        color: INK,
        align: Align::Right,
    };
    for label in &plot.axis.labels {
        let y = frame.y(label.share);
        canvas.rule(&across(y), Pen::solid(GRID, 2.0))?;
        canvas.text(&label.text, [frame.left - 12.0, y], look)?;
    }
    Ok(())
}

/// Where the marks lie, each column once.
fn columns(marks: &Marks, times: &Axis, frame: &Frame) -> Vec<f64> {
    let mut columns: Vec<f64> = marks
        .times
        .iter()
        .filter_map(|time| times.share(*time))
        .filter(|share| (0.0..=1.0).contains(share))
        .map(|share| frame.x(share).round())
        .collect();
    columns.sort_by(f64::total_cmp);
    columns.dedup();
    columns
}

/// Rows of marks, labels and name of the time axis.
fn draw_foot(
    canvas: &Canvas,
    figure: &CurvesFigure,
    frame: &Frame,
    times: &Axis,
) -> Result<(), ChartError> {
    let mut row = frame.bottom;
    for marks in &figure.marks {
        let columns = columns(marks, times, frame);
        let width = if columns.len() > 100 { 1.5 } else { 3.0 };
        for x in columns {
            let ends = [[x, row + 6.0], [x, row + MARK_ROW - 2.0]];
            canvas.line(&ends, Pen::solid(color(marks.color), width))?;
        }
        row += MARK_ROW;
    }
    let look = Lettering {
        px: SMALL_PX,
        color: INK,
        align: Align::Center,
    };
    for label in &times.labels {
        canvas.text(&label.text, [frame.x(label.share), row + 22.0], look)?;
    }
    let name = with_exponent(&figure.x_label, times.exponent);
    let name = match &times.note {
        Some(note) => format!("{name}, {note}"),
        None => name,
    };
    let name = shortened(&name, LABEL_PX, frame.width())?;
    let look = Lettering {
        px: LABEL_PX,
        ..look
    };
    canvas.text(&name, [frame.x(0.5), row + 60.0], look)
}

#[cfg(test)]
mod tests {
    use super::super::testing::decode;
    use super::*;

    fn curve(points: Vec<[f64; 2]>) -> Curve {
        Curve {
            label: "lecture − rapier".to_owned(),
            color: 0,
            line: LineStyle::Solid,
            weight: Weight::Main,
            points,
        }
    }

    fn figure(scale: Scale, points: Vec<[f64; 2]>) -> CurvesFigure {
        let mut panel = Panel::new("distance [mm]", scale);
        panel.curves.push(curve(points));
        CurvesFigure {
            title: "title".to_owned(),
            subtitle: String::new(),
            x_label: "time [s]".to_owned(),
            panels: vec![panel],
            marks: Vec::new(),
        }
    }

    /// Pixels in the full colour of the first curve.
    fn drawn(figure: &CurvesFigure) -> usize {
        let wanted = color(0);
        let image = decode(&curves(figure).unwrap());
        let hits = |pixel: &&[u8; 3]| **pixel == [wanted.0, wanted.1, wanted.2];
        image.pixels.iter().filter(hits).count()
    }

    #[test]
    fn a_curve_crosses_the_panel() {
        let line: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i), f64::from(i)]).collect();
        assert!(drawn(&figure(Scale::Linear, line)) > 4_000);
    }

    #[test]
    fn degenerate_data_give_a_picture() {
        let tables: [&[[f64; 2]]; 9] = [
            &[],
            &[[0.0, 1.0]],
            &[[0.0, 0.0], [1.0, 0.0]],
            &[[0.0, f64::NAN], [f64::INFINITY, 1.0]],
            &[[0.0, 1e300], [1.0, -1e300]],
            &[[0.0, f64::MAX], [1.0, f64::MIN]],
            &[[0.0, 1e-300], [1e-300, 2e-300]],
            &[[0.0, 5e-324], [1.0, 0.0]],
            &[[1e9, 7.0], [1e9 + 1e-6, 7.0]],
        ];
        for points in tables {
            for scale in [Scale::Linear, Scale::Log] {
                let image = decode(&curves(&figure(scale, points.to_vec())).unwrap());
                assert!(image.ink() > 5_000, "{points:?} {scale:?}");
            }
        }
    }

    #[test]
    fn a_value_that_is_not_finite_breaks_the_curve() {
        let whole: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i), 1.0]).collect();
        let mut broken = whole.clone();
        for point in &mut broken[30..60] {
            point[1] = f64::NAN;
        }
        let (whole, broken) = (figure(Scale::Linear, whole), figure(Scale::Linear, broken));
        assert!(drawn(&broken) * 10 < drawn(&whole) * 8);
    }

    #[test]
    fn zeros_on_a_log_axis_are_drawn() {
        assert!(drawn(&figure(Scale::Log, vec![[0.0, 0.0], [1.0, 0.0]])) > 4_000);
    }

    #[test]
    fn no_panel_no_name_and_special_characters() {
        let mut empty = figure(Scale::Linear, Vec::new());
        empty.panels.clear();
        assert!(decode(&curves(&empty).unwrap()).ink() > 100);
        let mut odd = figure(Scale::Linear, vec![[0.0, 1.0], [1.0, 2.0]]);
        odd.title = "<b>&\"'\u{0}\n".repeat(500);
        odd.panels[0].y_label = "&lt;".repeat(500);
        odd.panels[0].curves[0].label = "]]><!--".repeat(500);
        odd.marks.push(Marks {
            label: "impacts & <rests>".to_owned(),
            color: 1,
            times: vec![0.5, f64::NAN, -7.0],
        });
        assert!(decode(&curves(&odd).unwrap()).ink() > 5_000);
    }

    #[test]
    fn same_data_same_bytes() {
        let wave = |i: u32| [f64::from(i) * 0.1, (f64::from(i) * 0.3).sin()];
        let figure = figure(Scale::Linear, (0..500).map(wave).collect());
        assert_eq!(curves(&figure).unwrap(), curves(&figure).unwrap());
    }
}
