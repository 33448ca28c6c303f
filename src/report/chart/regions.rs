//! Maps of verdicts over two numbers: rectangles in the plane, with a line that theory draws.

use super::ChartError;
use super::axis::{Axis, Scale, fitting};
use super::canvas::{Align, Canvas, Lettering, picture};
use super::legend::{Entry, Key, Legend};
use super::matrix::Tone;
use super::polyline::{Frame, Point, clipped, count, runs};
use super::text::{shortened, width};
use super::theme::{CANVAS, FRAME, INK, LABEL_PX, MARGIN, PAPER, Pen, QUIET, SMALL_PX};

/// Room on the left for the labels.
const LEFT: f64 = 96.0;
/// Between two panels.
const BETWEEN: f64 = 30.0;
/// Height of the line above the panels with their names.
const HEADING: f64 = 46.0;
/// Room below the panels for the labels and the name of the axis.
const FOOT: f64 = 96.0;

/// A picture of maps side by side, on the same axes.
#[derive(Debug, Clone, PartialEq)]
pub struct RegionsFigure {
    /// What is shown.
    pub title: String,
    /// What else the reader should know; may be empty.
    pub subtitle: String,
    /// Name of the values across.
    pub x_label: String,
    /// How they are laid out.
    pub x_scale: Scale,
    /// Name of the values up, which are laid out in equal ratios.
    pub y_label: String,
    /// What the tones stand for.
    pub key: Vec<(Tone, String)>,
    /// The line of theory.
    pub line: Vec<[f64; 2]>,
    /// What it says.
    pub line_label: String,
    /// The maps, from left to right.
    pub panels: Vec<RegionPanel>,
}

/// A map.
#[derive(Debug, Clone, PartialEq)]
pub struct RegionPanel {
    /// Its name, above.
    pub name: String,
    /// What is known.
    pub regions: Vec<Region>,
}

/// A rectangle of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Its lower left corner.
    pub low: [f64; 2],
    /// Its upper right corner.
    pub high: [f64; 2],
    /// How it is there.
    pub tone: Tone,
}

/// Draws maps of verdicts as a PNG.
///
/// # Errors
/// None that depends on the data: see [`ChartError`].
pub fn regions(figure: &RegionsFigure) -> Result<Vec<u8>, ChartError> {
    picture(|canvas| {
        let mut top = canvas.heading(&figure.title, &figure.subtitle)?;
        let line_pen = Pen::solid(INK, 5.0);
        let keys = figure.key.iter();
        let keys = keys.map(|(tone, says)| Entry::new(Key::Disc(tone.color()), says.clone()));
        let line = Entry::new(Key::Line(line_pen), figure.line_label.clone());
        let legend = Legend::flow(&[keys.collect(), vec![line]], CANVAS[0] - 2.0 * MARGIN, 3)?;
        legend.draw(canvas, MARGIN, top)?;
        top += legend.height;
        let whole = Frame {
            left: MARGIN + LEFT,
            top: top + HEADING + 30.0,
            right: CANVAS[0] - MARGIN,
            bottom: CANVAS[1] - FOOT,
        };
        let axes = axes(figure, &whole)?;
        let look = Lettering::new(LABEL_PX, INK, Align::Left);
        let label = shortened(&figure.y_label, LABEL_PX, CANVAS[0] - 2.0 * MARGIN)?;
        canvas.text(&label, [MARGIN, top + 22.0], look)?;
        for (panel, frame) in figure.panels.iter().zip(frames(figure, &whole)) {
            draw_panel(canvas, panel, &axes, &frame)?;
            let line = figure.line.iter().map(|at| place(*at, &axes, &frame));
            for run in runs(line) {
                for piece in clipped(&run, &frame) {
                    // A white rim parts the line from dark cells.
                    canvas.line(&piece, Pen::solid(PAPER, 9.0))?;
                    canvas.line(&piece, line_pen)?;
                }
            }
            canvas.rule(&frame.outline(), Pen::solid(FRAME, 2.0))?;
        }
        for label in &axes[1].labels {
            let at = [whole.left - 14.0, whole.y(label.share)];
            canvas.text(
                &label.text,
                at,
                Lettering::new(SMALL_PX, QUIET, Align::Right),
            )?;
        }
        let label = shortened(&figure.x_label, LABEL_PX, whole.width())?;
        let middle = f64::midpoint(whole.left, whole.right);
        let look = Lettering::new(LABEL_PX, INK, Align::Center);
        canvas.text(&label, [middle, whole.bottom + 66.0], look)
    })
}

/// The frame of each panel.
fn frames(figure: &RegionsFigure, whole: &Frame) -> Vec<Frame> {
    let panels = count(figure.panels.len());
    let each = (whole.width() - (panels - 1.0) * BETWEEN) / f64::max(panels, 1.0);
    let mut left = whole.left;
    let frame = |_: &RegionPanel| {
        let frame = Frame {
            left,
            right: left + each,
            ..*whole
        };
        left += each + BETWEEN;
        frame
    };
    figure.panels.iter().map(frame).collect()
}

/// The axes that all panels share: across, up.
fn axes(figure: &RegionsFigure, whole: &Frame) -> Result<[Axis; 2], ChartError> {
    let values = |axis: usize| -> Vec<f64> {
        let panels = figure.panels.iter().flat_map(|panel| &panel.regions);
        panels
            .flat_map(|region| [region.low[axis], region.high[axis]])
            .collect()
    };
    let wide = frames(figure, whole)
        .first()
        .map_or(whole.width(), Frame::width);
    let across = fitting(wide, |most| match figure.x_scale {
        Scale::Linear => Axis::tight(&values(0), most),
        Scale::Log => Axis::decades(&values(0), most),
    })?;
    Ok([across, Axis::decades(&values(1), 9)])
}

fn place([x, y]: [f64; 2], axes: &[Axis; 2], frame: &Frame) -> Option<Point> {
    Some([frame.x(axes[0].share(x)?), frame.y(axes[1].share(y)?)])
}

fn draw_panel(
    canvas: &Canvas,
    panel: &RegionPanel,
    axes: &[Axis; 2],
    frame: &Frame,
) -> Result<(), ChartError> {
    let middle = f64::midpoint(frame.left, frame.right);
    let name = shortened(&panel.name, LABEL_PX, frame.width())?;
    let look = Lettering::new(LABEL_PX, INK, Align::Center);
    canvas.text(&name, [middle, frame.top - 0.5 * HEADING], look)?;
    for region in &panel.regions {
        let corners = [region.low, region.high].map(|corner| place(corner, axes, frame));
        let [Some([left, bottom]), Some([right, top])] = corners else {
            continue;
        };
        let held = |x: f64| x.clamp(frame.left, frame.right).round();
        let within = |y: f64| y.clamp(frame.top, frame.bottom).round();
        let cell = Frame {
            left: held(left),
            top: within(top),
            right: held(right),
            bottom: within(bottom),
        };
        canvas.fill(&cell, region.tone.color())?;
    }
    for label in &axes[0].labels {
        let reach = width(&label.text, SMALL_PX)? / 2.0;
        let x = frame.x(label.share);
        let room = frame.left - BETWEEN / 2.0 + reach..=frame.right + BETWEEN / 2.0 - reach;
        if room.contains(&x) {
            let look = Lettering::new(SMALL_PX, QUIET, Align::Center);
            canvas.text(&label.text, [x, frame.bottom + 24.0], look)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::testing::decode;
    use super::*;

    fn figure(regions: Vec<Region>, line: Vec<[f64; 2]>) -> RegionsFigure {
        RegionsFigure {
            title: "t".into(),
            subtitle: "s".into(),
            x_label: "x".into(),
            x_scale: Scale::Log,
            y_label: "y".into(),
            key: vec![(Tone::Good, "good".into())],
            line,
            line_label: "theory".into(),
            panels: vec![RegionPanel {
                name: "a".into(),
                regions,
            }],
        }
    }

    fn region(low: [f64; 2], high: [f64; 2], tone: Tone) -> Region {
        Region { low, high, tone }
    }

    /// Two decades by two decades in four equal parts, one of them bad.
    #[test]
    fn equal_ratios_take_equal_room() {
        let corners = [[1.0, 1.0], [10.0, 1.0], [1.0, 10.0], [10.0, 10.0]];
        let regions = corners.map(|[x, y]| {
            let tone = if x * y > 50.0 { Tone::Bad } else { Tone::Good };
            region([x, y], [10.0 * x, 10.0 * y], tone)
        });
        let image = decode(&super::regions(&figure(regions.to_vec(), Vec::new())).unwrap());
        let count = |tone: Tone| {
            let plotters::style::RGBColor(r, g, b) = tone.color();
            image.pixels.iter().filter(|p| **p == [r, g, b]).count()
        };
        let (good, bad) = (count(Tone::Good), count(Tone::Bad));
        assert!(
            bad > 50_000 && good.abs_diff(3 * bad) < bad / 20,
            "{good} {bad}"
        );
    }

    #[test]
    fn the_line_is_seen_and_no_data_make_it_fail() {
        let cell = region([1.0, 1.0], [100.0, 100.0], Tone::Good);
        let dark = |line| {
            let image = decode(&super::regions(&figure(vec![cell], line)).unwrap());
            image.pixels.iter().filter(|pixel| pixel[0] < 64).count()
        };
        assert!(dark(vec![[1.0, 50.0], [100.0, 2.0]]) > dark(Vec::new()) + 1000);
        let strange = [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e308, 5e-324];
        let all = strange.map(|v| region([v, v], [v, 1.0], Tone::Bad));
        let line = strange.map(|v| [v, 1.0]);
        decode(&super::regions(&figure(all.to_vec(), line.to_vec())).unwrap());
        let mut nothing = figure(Vec::new(), Vec::new());
        nothing.panels.clear();
        decode(&super::regions(&nothing).unwrap());
    }
}
