//! The paths of the bodies in a plane, to scale.

use plotters::style::RGBColor;

use super::ChartError;
use super::axis::{Axis, fitting};
use super::canvas::{Align, Canvas, Lettering, picture};
use super::legend::{Entry, Key, Legend};
use super::paths_figure::{PathBody, PathsFigure};
use super::polyline::{Frame, Point, clipped, runs, thinned};
use super::text::shortened;
use super::theme::{
    CANVAS, COLOR_COUNT, CUSHION, FRAME, GRID, INK, LABEL_PX, LineStyle, MARGIN, PAPER, Pen, QUIET,
    SMALL_PX, color, mix,
};
use super::window::{Window, window};

/// More bodies than this are not told apart by colour; the colour tells the voice.
const MOST_NAMED: usize = 12;
/// More bodies than this are drawn with plain thin lines.
const MOST_DASHED: usize = 200;
/// How many of a crowd are named.
const CROWD_NAMES: usize = 3;
/// Room for the labels left of the plot.
const GUTTER: f64 = 112.0;
/// Room for labels and name below the plot.
const FOOT: f64 = 84.0;
/// Room for the name of the upright axis above the plot.
const HEAD: f64 = 42.0;
/// Least width of a legend beside the plot.
const COLUMN: f64 = 380.0;

/// Draws paths as a PNG. Each body starts at a pale disc, true to its radius, and ends at
/// an outlined one for each voice.
///
/// # Errors
/// None that depends on the data: see [`ChartError`].
pub fn paths(figure: &PathsFigure) -> Result<Vec<u8>, ChartError> {
    picture(|canvas| {
        let top = canvas.heading(&figure.title, &figure.subtitle)?;
        let window = window(figure);
        let sheet = Sheet::layout(figure, window, top)?;
        let (left, top) = sheet.legend_at;
        sheet.legend.draw(canvas, left, top)?;
        sheet.draw_axes(canvas, figure)?;
        sheet.draw_starts(canvas, figure)?;
        sheet.draw_tracks(canvas, figure)?;
        sheet.draw_ends(canvas, figure)
    })
}

/// Where everything goes.
struct Sheet {
    window: Window,
    plot: Frame,
    legend: Legend,
    legend_at: (f64, f64),
}

impl Sheet {
    /// Puts the legend above the plot or beside it, whichever leaves the larger plot.
    fn layout(figure: &PathsFigure, window: Window, top: f64) -> Result<Self, ChartError> {
        let groups = entries(figure, &window);
        let full = CANVAS[0] - 2.0 * MARGIN;
        let above = Legend::flow(&groups, full, 4)?;
        let below_legend = Frame {
            left: MARGIN + GUTTER,
            top: top + above.height + HEAD,
            right: CANVAS[0] - MARGIN - 20.0,
            bottom: CANVAS[1] - FOOT,
        };
        let beside_legend = Frame {
            top: top + HEAD,
            right: CANVAS[0] - MARGIN - COLUMN - 40.0,
            ..below_legend
        };
        if window.scale_in(&below_legend) >= window.scale_in(&beside_legend) {
            let (window, plot) = window.filling(&below_legend);
            return Ok(Self {
                window,
                plot,
                legend: above,
                legend_at: (MARGIN, top),
            });
        }
        let (window, plot) = window.filling(&beside_legend);
        let left = plot.right + 50.0;
        Ok(Self {
            window,
            plot,
            legend: Legend::column(&groups, CANVAS[0] - MARGIN - left, 15)?,
            legend_at: (left, plot.top),
        })
    }

    fn place(&self, point: [f64; 2]) -> Option<Point> {
        self.window.place(point, &self.plot)
    }

    /// Radius of a disc in pixels: true to scale, but large enough to be seen.
    fn radius(&self, figure: &PathsFigure, body: &PathBody) -> f64 {
        let true_radius = body.radius.abs() * self.window.scale_in(&self.plot);
        let least = if figure.bodies.len() > MOST_DASHED {
            3.0
        } else {
            7.0
        };
        if true_radius.is_finite() {
            true_radius.clamp(least, 400.0)
        } else {
            least
        }
    }

    fn draw_axes(&self, canvas: &Canvas, figure: &PathsFigure) -> Result<(), ChartError> {
        let [across, up] = self.window.axes();
        let plot = &self.plot;
        let [low, high] = self.window.limits[0];
        let horizontal = fitting(plot.width(), |most| Axis::between(low, high, most))?;
        let [low, high] = self.window.limits[1];
        let rows = plot.height() / (2.2 * SMALL_PX);
        let most = (2..=9)
            .rfind(|count| f64::from(*count) <= rows)
            .unwrap_or(2);
        let vertical = Axis::between(low, high, most);
        let look = Lettering {
            px: SMALL_PX,
            color: INK,
            align: Align::Center,
        };
        let grid = Pen::solid(GRID, 2.0);
        for label in &horizontal.labels {
            let x = plot.x(label.share);
            canvas.rule(&[[x, plot.top], [x, plot.bottom]], grid)?;
            canvas.text(&label.text, [x, plot.bottom + 24.0], look)?;
        }
        let right = Lettering {
            align: Align::Right,
            ..look
        };
        for label in &vertical.labels {
            let share = if self.window.down {
                1.0 - label.share
            } else {
                label.share
            };
            let y = plot.y(share);
            canvas.rule(&[[plot.left, y], [plot.right, y]], grid)?;
            let text = shortened(&label.text, SMALL_PX, GUTTER)?;
            canvas.text(&text, [plot.left - 12.0, y], right)?;
        }
        canvas.rule(&plot.outline(), Pen::solid(FRAME, 2.0))?;
        let named = |axis: &Axis, index: usize| {
            let name = figure.axes[index].text(axis.exponent);
            match &axis.note {
                Some(note) => format!("{name}, {note}"),
                None => name,
            }
        };
        let name = shortened(&named(&horizontal, across), LABEL_PX, plot.width())?;
        let look = Lettering {
            px: LABEL_PX,
            ..look
        };
        canvas.text(&name, [plot.x(0.5), plot.bottom + 61.0], look)?;
        let name = shortened(&named(&vertical, up), LABEL_PX, plot.right - MARGIN)?;
        let look = Lettering {
            align: Align::Left,
            ..look
        };
        canvas.text(&name, [MARGIN, plot.top - 0.45 * HEAD], look)?;
        self.draw_cushions(canvas, figure)
    }

    fn draw_cushions(&self, canvas: &Canvas, figure: &PathsFigure) -> Result<(), ChartError> {
        let Some([a, b]) = figure.cushions else {
            return Ok(());
        };
        let corners = [[-a, -b], [a, -b], [a, b], [-a, b], [-a, -b]];
        for run in runs(corners.map(|corner| self.place(corner))) {
            for part in clipped(&run, &self.plot) {
                canvas.line(&part, Pen::solid(CUSHION, 5.0))?;
            }
        }
        Ok(())
    }

    fn draw_starts(&self, canvas: &Canvas, figure: &PathsFigure) -> Result<(), ChartError> {
        for (i, body) in figure.bodies.iter().enumerate() {
            let start = body.tracks.iter().flatten().find_map(|p| self.place(*p));
            let Some(start) = start.filter(|p| self.plot.contains(*p)) else {
                continue;
            };
            let color = start_color(figure, i);
            canvas.disc(start, self.radius(figure, body), color)?;
        }
        Ok(())
    }

    fn draw_tracks(&self, canvas: &Canvas, figure: &PathsFigure) -> Result<(), ChartError> {
        for voice in 0..voice_count(figure) {
            for (i, body) in figure.bodies.iter().enumerate() {
                let track = body.tracks.get(voice).into_iter().flatten();
                let pen = pen(figure, i, voice);
                for run in runs(track.map(|point| self.place(*point))) {
                    let run = thinned(&run);
                    // A body that never moves is shown by its discs.
                    let start = run.first().copied().unwrap_or_default();
                    let far = |p: &Point| (p[0] - start[0]).hypot(p[1] - start[1]) > 0.1;
                    if !run.iter().any(far) {
                        continue;
                    }
                    for part in clipped(&run, &self.plot) {
                        canvas.line(&part, pen)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn draw_ends(&self, canvas: &Canvas, figure: &PathsFigure) -> Result<(), ChartError> {
        for voice in 0..voice_count(figure) {
            for (i, body) in figure.bodies.iter().enumerate() {
                let track = body.tracks.get(voice).into_iter().flatten();
                let end = track.rev().find_map(|point| self.place(*point));
                let Some(end) = end.filter(|p| self.plot.contains(*p)) else {
                    continue;
                };
                let pen = pen(figure, i, voice);
                let radius = self.radius(figure, body);
                let width = (pen.width * 0.6).min(radius / 3.0);
                // A pattern cannot be read on a small ring.
                let style = if radius < 12.0 {
                    LineStyle::Solid
                } else {
                    pen.style
                };
                let pen = Pen {
                    width,
                    style,
                    ..pen
                };
                canvas.ring(end, radius - width / 2.0, pen)?;
            }
        }
        Ok(())
    }
}

fn voice_count(figure: &PathsFigure) -> usize {
    figure
        .bodies
        .iter()
        .map(|body| body.tracks.len())
        .max()
        .unwrap_or(0)
}

fn is_crowd(figure: &PathsFigure) -> bool {
    figure.bodies.len() > MOST_NAMED
}

/// The colour of a start disc: pale, so that what lies on it can be seen.
fn start_color(figure: &PathsFigure, body: usize) -> RGBColor {
    if is_crowd(figure) {
        mix(QUIET, PAPER, 0.7)
    } else {
        mix(color(body), PAPER, 0.65)
    }
}

/// The pen of one body's track in one voice.
fn pen(figure: &PathsFigure, body: usize, voice: usize) -> Pen {
    match figure.bodies.len() {
        0..=MOST_NAMED => Pen::of_voice(voice, color(body), 1.0),
        // Too many to be told apart: the colour tells the voice.
        13..=MOST_DASHED => Pen::of_voice(voice, color(voice), 0.65),
        _ => Pen::solid(color(voice), if voice == 0 { 3.0 } else { 1.5 }),
    }
}

/// The legend: bodies by colour, voices by line style, what the discs mean, and remarks.
fn entries(figure: &PathsFigure, window: &Window) -> Vec<Vec<Entry>> {
    let crowd = is_crowd(figure);
    let bodies = if crowd {
        let names: Vec<&str> = figure.bodies.iter().map(|b| b.name.as_str()).collect();
        let rest = names.len() - CROWD_NAMES;
        vec![
            Entry::new(Key::Remark, names[..CROWD_NAMES].join(", ")),
            Entry::new(Key::Remark, format!("… and {rest} more")),
        ]
    } else {
        let entry = |(i, body): (usize, &PathBody)| Entry::new(Key::Disc(color(i)), &*body.name);
        figure.bodies.iter().enumerate().map(entry).collect()
    };
    let voice_pen = |voice: usize| {
        if crowd {
            pen(figure, 0, voice)
        } else {
            Pen::of_voice(voice, QUIET, 1.0)
        }
    };
    let voices = figure.voices.iter().enumerate();
    let voices = voices.map(|(i, name)| Entry::new(Key::Line(voice_pen(i)), &**name));
    let mut discs = vec![
        Entry::new(Key::Disc(mix(QUIET, PAPER, 0.65)), "start"),
        Entry::new(Key::Ring(Pen::solid(QUIET, 4.0)), "end"),
    ];
    if figure.bodies.is_empty() {
        discs = vec![Entry::new(Key::Remark, "no bodies")];
    }
    if !crowd && figure.bodies.len() > COLOR_COUNT {
        discs.push(Entry::new(Key::Remark, "colours repeat"));
    }
    if window.leaving > 0 {
        let count = format!("{} of {}", window.leaving, figure.bodies.len());
        discs.push(Entry::new(
            Key::Remark,
            format!("{count} leave the picture"),
        ));
    }
    vec![bodies, voices.chain(discs).collect()]
}

#[cfg(test)]
mod tests {
    use super::super::paths_figure::{AxisLabel, View};
    use super::super::testing::decode;
    use super::*;

    fn figure(bodies: Vec<PathBody>) -> PathsFigure {
        PathsFigure {
            title: "title".to_owned(),
            subtitle: "subtitle".to_owned(),
            axes: [AxisLabel::new("x", "mm"), AxisLabel::new("z", "mm")],
            view: View::Above,
            cushions: None,
            bodies,
            voices: vec!["lecture".to_owned(), "rapier".to_owned()],
        }
    }

    fn body(name: &str, radius: f64, track: Vec<[f64; 2]>) -> PathBody {
        PathBody {
            name: name.to_owned(),
            radius,
            tracks: vec![track.clone(), track],
        }
    }

    #[test]
    fn degenerate_data_give_a_picture() {
        let tracks: [Vec<[f64; 2]>; 8] = [
            vec![],
            vec![[0.0, 0.0]],
            vec![[5.0, 5.0], [5.0, 5.0]],
            vec![[f64::NAN, 0.0], [0.0, f64::INFINITY]],
            vec![[-1e300, 0.0], [1e300, 0.0]],
            vec![[f64::MIN, f64::MAX], [f64::MAX, 0.0]],
            vec![[0.0, 1e-300], [2e-300, 0.0]],
            vec![[1e9, 1e9], [1e9 + 1e-3, 1e9]],
        ];
        let radii = [0.0, f64::NAN, 1e300, -1.0];
        let line = vec![[0.0, 0.0], [3.0, 4.0]];
        let cases = tracks.map(|track| (1.0, track)).into_iter();
        for (radius, track) in cases.chain(radii.map(|radius| (radius, line.clone()))) {
            let figure = figure(vec![body("a", radius, track.clone())]);
            let image = decode(&paths(&figure).unwrap());
            assert!(image.ink() > 5_000, "{track:?} {radius}");
        }
        assert!(decode(&paths(&figure(Vec::new())).unwrap()).ink() > 5_000);
    }

    #[test]
    fn odd_names_give_a_picture_of_the_same_size() {
        let names = ["<script>&\"'", "", "]]>", "\u{0}\u{1B}[31m", "당구공"];
        let mut bodies: Vec<PathBody> = Vec::new();
        for name in names {
            bodies.push(body(&name.repeat(100), 1.0, vec![[0.0, 0.0], [9.0, 3.0]]));
        }
        let mut figure = figure(bodies);
        figure.voices[0] = "&".repeat(900);
        figure.axes[1] = AxisLabel::new("<".repeat(500), "");
        assert!(decode(&paths(&figure).unwrap()).ink() > 5_000);
    }

    #[test]
    fn coincident_voices_both_show() {
        let track = vec![[0.0, 0.0], [100.0, 30.0]];
        let image = decode(&paths(&figure(vec![body("a", 1.0, track)])).unwrap());
        for voice in 0..2 {
            let pen = Pen::of_voice(voice, color(0), 1.0);
            let wanted = [pen.color.0, pen.color.1, pen.color.2];
            let count = image.pixels.iter().filter(|p| **p == wanted).count();
            assert!(count > 800, "voice {voice}: {count}");
        }
    }

    #[test]
    fn same_data_same_bytes() {
        let circle = |i: u32| [f64::from(i).cos() * 10.0, f64::from(i).sin() * 10.0];
        let figure = figure(vec![body("a", 1.0, (0..50).map(circle).collect())]);
        assert_eq!(paths(&figure).unwrap(), paths(&figure).unwrap());
    }

    #[test]
    fn ten_thousand_bodies_give_a_picture() {
        let place = |i: u32| [f64::from(i % 100), f64::from(i / 100)];
        let bodies = (0..10_000)
            .map(|i| {
                let [x, z] = place(i);
                body(&format!("b{i}"), 0.3, vec![[x, z], [x + 0.5, z + 0.5]])
            })
            .collect();
        assert!(decode(&paths(&figure(bodies)).unwrap()).ink() > 50_000);
    }
}
