//! The sheet a picture is drawn on: plotters' SVG backend, addressed in pixels.

use std::cell::RefCell;
use std::collections::BTreeSet;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Polygon, Text};
use plotters::prelude::SVGBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoFont, RGBColor, ShapeStyle};

use super::polyline::{Frame, Point, circle, dashed, dotted};
use super::text::{FAMILY, SIZE_PER_PX, drawable, register, wrapped};
use super::theme::{CANVAS, INK, LineStyle, MARGIN, PAPER, Pen, QUIET, SIZE, SMALL_PX, TITLE_PX};
use super::{ChartError, png};

/// plotters rounds to whole units, so it draws on a sheet this many times as large as
/// the picture; otherwise slow curves would be staircases.
const UNITS_PER_PX: u8 = 8;

/// Which point of a text its position names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Align {
    /// Its left end.
    Left,
    /// Its middle.
    Center,
    /// Its right end.
    Right,
}

/// How a text looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lettering {
    /// Height of the letters in pixels.
    pub(super) px: f64,
    /// Colour.
    pub(super) color: RGBColor,
    /// Which point of the text its position names.
    pub(super) align: Align,
}

impl Lettering {
    /// Letters of that height and colour.
    pub(super) fn new(px: f64, color: RGBColor, align: Align) -> Self {
        Self { px, color, align }
    }
}

/// A white sheet; every length is in pixels, y runs down.
pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
    /// The colours used so far, which the PNG keeps exactly.
    inks: RefCell<BTreeSet<[u8; 3]>>,
}

/// Draws a picture and encodes it.
pub(super) fn picture(
    draw: impl FnOnce(&Canvas) -> Result<(), ChartError>,
) -> Result<Vec<u8>, ChartError> {
    picture_high(SIZE[1], draw)
}

/// Draws a picture of another height, px, and encodes it.
pub(super) fn picture_high(
    height: u32,
    draw: impl FnOnce(&Canvas) -> Result<(), ChartError>,
) -> Result<Vec<u8>, ChartError> {
    register()?;
    let mut svg = String::new();
    let scale = u32::from(UNITS_PER_PX);
    let size = (SIZE[0] * scale, height * scale);
    let inks = {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&PAPER)?;
        let canvas = Canvas {
            area,
            inks: RefCell::new(BTreeSet::from([rgb(PAPER)])),
        };
        draw(&canvas)?;
        canvas.area.present()?;
        canvas.inks.into_inner()
    };
    png::from_svg(
        &svg,
        [SIZE[0], height],
        1.0 / f32::from(UNITS_PER_PX),
        &inks,
    )
}

impl Canvas<'_> {
    /// A line through the points; a single point becomes a dot.
    pub(super) fn line(&self, points: &[Point], pen: Pen) -> Result<(), ChartError> {
        if let [point] = points {
            // Smaller from style to style, so that dots at the same place all show.
            let share = match pen.style {
                LineStyle::Solid => 1.0,
                LineStyle::Dashed => 0.9,
                LineStyle::Dotted => 0.4,
            };
            return self.disc(*point, pen.width * share, pen.color);
        }
        let pieces = match pen.style {
            LineStyle::Solid => vec![points.to_vec()],
            LineStyle::Dashed => dashed(points, pen.dash(), pen.gap()),
            LineStyle::Dotted => return self.dots(points, pen),
        };
        self.inks.borrow_mut().insert(rgb(pen.color));
        let style = ShapeStyle {
            color: pen.color.to_rgba(),
            filled: false,
            stroke_width: u32::try_from(units(pen.width)).unwrap_or(1),
        };
        for piece in pieces {
            let path: Vec<(i32, i32)> = piece.into_iter().map(place).collect();
            self.area.draw(&PathElement::new(path, style))?;
        }
        Ok(())
    }

    /// A line of the grid or of a frame: on whole pixels, so that all look equally thick.
    pub(super) fn rule(&self, points: &[Point], pen: Pen) -> Result<(), ChartError> {
        let points: Vec<Point> = points.iter().map(|p| p.map(f64::round)).collect();
        self.line(&points, pen)
    }

    /// Dots along a line, each on whole pixels: equal dots compress well. A white halo
    /// parts them from a line beneath, which otherwise would seem to change its colour.
    fn dots(&self, points: &[Point], pen: Pen) -> Result<(), ChartError> {
        let dots = dotted(points, pen.lead(), pen.gap());
        let radius = pen.width / 2.0;
        for (radius, color) in [(radius + pen.halo(), PAPER), (radius, pen.color)] {
            for [x, y] in &dots {
                self.disc([x.round(), y.round()], radius, color)?;
            }
        }
        Ok(())
    }

    /// A filled disc.
    pub(super) fn disc(
        &self,
        center: Point,
        radius: f64,
        color: RGBColor,
    ) -> Result<(), ChartError> {
        self.inks.borrow_mut().insert(rgb(color));
        let disc = Circle::new(place(center), units(radius), color.filled());
        Ok(self.area.draw(&disc)?)
    }

    /// The outline of a disc.
    pub(super) fn ring(&self, center: Point, radius: f64, pen: Pen) -> Result<(), ChartError> {
        self.line(&circle(center, radius), pen)
    }

    /// A filled rectangle.
    pub(super) fn fill(&self, frame: &Frame, color: RGBColor) -> Result<(), ChartError> {
        self.inks.borrow_mut().insert(rgb(color));
        let corners: Vec<(i32, i32)> = frame.outline().map(place).to_vec();
        Ok(self.area.draw(&Polygon::new(corners, color.filled()))?)
    }

    /// A text whose digits are centred on the row `at[1]`.
    pub(super) fn text(&self, text: &str, at: Point, look: Lettering) -> Result<(), ChartError> {
        self.inks.borrow_mut().insert(rgb(look.color));
        let h_pos = match look.align {
            Align::Left => HPos::Left,
            Align::Center => HPos::Center,
            Align::Right => HPos::Right,
        };
        // The backend puts the baseline 0.76 of the size below the position given;
        // digits of DejaVu Sans are 0.73 high.
        let baseline = (at[1] + look.px * 0.73 / 2.0).round();
        let top = baseline - 0.76 * look.px;
        let size = look.px * SIZE_PER_PX * f64::from(UNITS_PER_PX);
        let style = (FAMILY, size)
            .into_font()
            .color(&look.color)
            .pos(Pos::new(h_pos, VPos::Top));
        let element = Text::new(
            drawable(text).into_owned(),
            place([at[0].round(), top]),
            style,
        );
        Ok(self.area.draw(&element)?)
    }

    /// Title and subtitle, each in at most two lines; returns the row below them.
    pub(super) fn heading(&self, title: &str, subtitle: &str) -> Result<f64, ChartError> {
        let (lines, below) = heading(title, subtitle)?;
        for (line, row, px, color) in lines {
            let look = Lettering {
                px,
                color,
                align: Align::Left,
            };
            self.text(&line, [MARGIN, row], look)?;
        }
        Ok(below)
    }
}

/// The lines of a heading, each with its row, its height and its colour; and the row below them.
type Heading = (Vec<(String, f64, f64, RGBColor)>, f64);

/// Lays out title and subtitle.
pub(super) fn heading(title: &str, subtitle: &str) -> Result<Heading, ChartError> {
    let mut row = MARGIN - 8.0;
    let mut lines = Vec::new();
    for (text, px, color) in [(title, TITLE_PX, INK), (subtitle, SMALL_PX, QUIET)] {
        for line in wrapped(text, px, CANVAS[0] - 2.0 * MARGIN, 2)? {
            lines.push((line, row + 0.6 * px, px, color));
            row += 1.3 * px;
        }
    }
    Ok((lines, row + 8.0))
}

fn rgb(color: RGBColor) -> [u8; 3] {
    [color.0, color.1, color.2]
}

/// A point in the units of the sheet.
fn place(point: Point) -> (i32, i32) {
    (units(point[0]), units(point[1]))
}

/// A length in the units of the sheet.
fn units(px: f64) -> i32 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to some sheets around the picture; NaN becomes 0"
    )]
    let units = (px * f64::from(UNITS_PER_PX)).round().clamp(-1e6, 1e6) as i32;
    units
}

#[cfg(test)]
mod tests {
    use super::super::testing::decode;
    use super::*;

    #[test]
    fn a_line_lands_where_it_was_drawn() {
        let pen = Pen::solid(INK, 10.0);
        let bytes = picture(|canvas| canvas.line(&[[100.0, 200.0], [300.0, 200.0]], pen)).unwrap();
        let image = decode(&bytes);
        assert_eq!(image.at(200, 200), [INK.0, INK.1, INK.2]);
        assert_eq!(image.at(200, 210), [255; 3]);
        assert_eq!(image.at(320, 200), [255; 3]);
    }

    #[test]
    fn dashes_leave_gaps() {
        let pen = Pen {
            color: INK,
            width: 6.0,
            style: LineStyle::Dashed,
        };
        let bytes = picture(|canvas| canvas.line(&[[100.0, 200.0], [900.0, 200.0]], pen)).unwrap();
        let image = decode(&bytes);
        let dark = (100..900).filter(|x| image.at(*x, 200)[0] < 128).count();
        assert!((300..700).contains(&dark), "{dark} of 800");
    }

    #[test]
    fn every_text_is_drawn_in_letters_of_the_font() {
        let draw = |text: &str| {
            let look = Lettering {
                px: 40.0,
                color: INK,
                align: Align::Left,
            };
            picture(|canvas| canvas.text(text, [100.0, 400.0], look)).unwrap()
        };
        assert_eq!(draw("당구공"), draw("danggugong"));
        assert_ne!(draw("белый"), draw("belyi"));
    }

    #[test]
    fn special_characters_are_drawn_as_they_are() {
        let letters = |text: &str| {
            let look = Lettering {
                px: 80.0,
                color: INK,
                align: Align::Left,
            };
            let bytes = picture(|canvas| canvas.text(text, [100.0, 400.0], look)).unwrap();
            let image = decode(&bytes);
            image.pixels.iter().filter(|p| p[0] < 128).count()
        };
        let all = letters("a<b>&\"c'");
        let plain = letters("abc");
        assert!(plain > 500 && all > plain + 500, "{plain}, {all}");
        // An entity drawn literally would put more ink on the sheet.
        assert!(letters("&") * 2 < letters("&amp;"));
    }
}
