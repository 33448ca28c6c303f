//! The paths of the bodies in a plane, to scale.

use super::ChartError;
use super::axis::{Axis, fitting};
use super::canvas::{Align, Canvas, Lettering, picture};
use super::legend::Legend;
use super::paths_figure::{PathBody, PathsFigure};
use super::paths_look::{MOST_DASHED, end_ring, entries, pen, start_color, voice_count};
use super::polyline::{Frame, Point, circle, clipped, runs, thinned};
use super::text::shortened;
use super::theme::{CANVAS, CUSHION, FRAME, GRID, INK, LABEL_PX, LineStyle, MARGIN, Pen, SMALL_PX};
use super::window::{Window, window};

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
            self.draw_within(canvas, &run, Pen::solid(CUSHION, 5.0))?;
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
                    self.draw_within(canvas, &run, pen)?;
                }
            }
        }
        Ok(())
    }

    /// The part of a line within the plot. Where it leaves, it ends half its width
    /// before the edge, so that no ink crosses the frame.
    fn draw_within(&self, canvas: &Canvas, run: &[Point], pen: Pen) -> Result<(), ChartError> {
        let margin = match pen.style {
            LineStyle::Solid | LineStyle::Dashed => 0.0,
            LineStyle::Dotted => pen.halo(),
        };
        let within = self.plot.inset(pen.width / 2.0 + margin);
        for part in clipped(run, &within) {
            canvas.line(&part, pen)?;
        }
        Ok(())
    }

    fn draw_ends(&self, canvas: &Canvas, figure: &PathsFigure) -> Result<(), ChartError> {
        let voices = voice_count(figure);
        for voice in 0..voices {
            for (i, body) in figure.bodies.iter().enumerate() {
                let track = body.tracks.get(voice).into_iter().flatten();
                let end = track.rev().find_map(|point| self.place(*point));
                let Some(end) = end.filter(|p| self.plot.contains(*p)) else {
                    continue;
                };
                let (radius, pen) = end_ring(
                    self.radius(figure, body),
                    pen(figure, i, voice),
                    voices - 1 - voice,
                );
                self.draw_within(canvas, &circle(end, radius), pen)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::paths_figure::{AxisLabel, View};
    use super::super::testing::decode;
    use super::super::theme::TITLE_PX;
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
    fn coincident_voices_all_show() {
        for bodies in [1, 30] {
            let track = vec![[0.0, 0.0], [100.0, 30.0]];
            let mut body = body("a", 1.0, track.clone());
            body.tracks.push(track);
            let figure = figure(vec![body; bodies]);
            let image = decode(&paths(&figure).unwrap());
            // Ink of each voice on the path, between the discs at its ends.
            for voice in 0..3 {
                let ink = pen(&figure, 0, voice).color;
                let rows = image.pixels.chunks(1440).skip(250);
                let on_path = rows.flat_map(|row| &row[400..900]);
                let wanted = [ink.0, ink.1, ink.2];
                let count = on_path.filter(|pixel| **pixel == wanted).count();
                assert!(count > 200, "{bodies} bodies, voice {voice}: {count}");
            }
        }
    }

    #[test]
    fn no_ink_of_a_path_leaves_the_frame() {
        for far in [
            [1e231, 1e230],
            [1e5, -1e5],
            [-1e231, 1.0],
            [f64::MAX, f64::MIN],
        ] {
            let at = |i: u32| vec![[f64::from(i), 0.0], [f64::from(i), 20.0]];
            let mut bodies: Vec<PathBody> = (0..9).map(|i| body("a", 0.3, at(i * 3))).collect();
            let mut runaway = vec![[3.0, 7.0]; 9];
            runaway[4] = far;
            let mut far_body = body("far", 0.3, vec![[3.0, 7.0]]);
            far_body.tracks[0] = runaway;
            bodies.push(far_body);
            let figure = figure(bodies);
            let image = decode(&paths(&figure).unwrap());
            let top = MARGIN + 1.3 * (TITLE_PX + SMALL_PX);
            let sheet = Sheet::layout(&figure, window(&figure), top).unwrap();
            assert_eq!(sheet.window.leaving, 1);
            // Right of the plot and left of it there is no ink of any body.
            let colored = |pixel: &[u8; 3]| pixel.iter().max() > pixel.iter().min();
            let plot = sheet.plot;
            for (i, pixel) in image.pixels.iter().enumerate() {
                let pixels = u32::try_from(i).unwrap();
                let (x, y) = (f64::from(pixels % 1440), f64::from(pixels / 1440));
                let beside = x < plot.left - 3.0 || x > plot.right + 3.0 && x < plot.right + 40.0;
                let outside = y > 300.0 && beside || y > plot.bottom + 60.0;
                assert!(!(outside && colored(pixel)), "{far:?}: {x} {y} {pixel:?}");
            }
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
