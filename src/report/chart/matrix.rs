//! A heat map of verdicts: a row for each case, a column for each engine, a cell for each run.

use plotters::style::RGBColor;

use super::ChartError;
use super::canvas::{Align, Canvas, Lettering, heading, picture_high};
use super::legend::{Entry, Key, Legend};
use super::polyline::{Frame, count};
use super::text::{shortened, width};
use super::theme::{CANVAS, FRAME, INK, MARGIN, PAPER, Pen, QUIET, color, mix};

/// Height of a row.
const ROW: f64 = 29.0;
/// Height of the letters of a row's name.
const NAME_PX: f64 = 22.0;
/// Height of the letters of a column's name, whose parts stand below each other.
const HEAD_PX: f64 = 18.0;
/// The names of the rows take at most this.
const NAMES_MAX: f64 = 300.0;
/// Between two columns.
const BETWEEN: f64 = 12.0;
/// Between two cells.
const GAP: f64 = 2.0;

/// How bad a cell is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// As it should be.
    Good,
    /// Something small is wrong.
    Poor,
    /// Something is badly wrong.
    Bad,
    /// It broke down.
    Broken,
    /// Nothing is known.
    Absent,
}

impl Tone {
    /// Its colour, told apart by colour-blind readers and in shades of grey too.
    pub(super) fn color(self) -> RGBColor {
        match self {
            Self::Good => mix(color(2), PAPER, 0.55),
            Self::Poor => color(4),
            Self::Bad => color(1),
            Self::Broken => color(6),
            Self::Absent => RGBColor(0xE4, 0xE4, 0xE4),
        }
    }
}

/// A picture of verdicts.
#[derive(Debug, Clone, PartialEq)]
pub struct MatrixFigure {
    /// What is shown.
    pub title: String,
    /// What else the reader should know; may be empty.
    pub subtitle: String,
    /// What the tones stand for.
    pub key: Vec<(Tone, String)>,
    /// The columns, from left to right.
    pub columns: Vec<MatrixColumn>,
    /// The rows, from top to bottom.
    pub rows: Vec<MatrixRow>,
}

/// A column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MatrixColumn {
    /// Its name, above; broken into lines at its hyphens.
    pub name: String,
    /// Written below it: how many of its cells are good.
    pub score: String,
}

/// A row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MatrixRow {
    /// Its name, on the left.
    pub name: String,
    /// The cells of each column, beside each other.
    pub cells: Vec<Vec<Tone>>,
}

/// Draws verdicts as a PNG, as high as it has rows.
///
/// # Errors
/// None that depends on the data: see [`ChartError`].
pub fn matrix(figure: &MatrixFigure) -> Result<Vec<u8>, ChartError> {
    super::text::register()?;
    let heads: Vec<Vec<String>> = figure
        .columns
        .iter()
        .map(|column| parts(&column.name))
        .collect();
    let lines = count(heads.iter().map(Vec::len).max().unwrap_or(0));
    let keys = figure
        .key
        .iter()
        .map(|(tone, says)| Entry::new(Key::Disc(tone.color()), says.clone()));
    let legend = Legend::flow(&[keys.collect()], CANVAS[0] - 2.0 * MARGIN, 3)?;
    let head = 1.15 * HEAD_PX * lines + 10.0;
    let high = count(figure.rows.len()) * ROW;
    let (_, below) = heading(&figure.title, &figure.subtitle)?;
    let total = below + legend.height + head + 8.0 + high + 24.0 + MARGIN;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "rows of pixels, clamped"
    )]
    let total = total.clamp(400.0, 20_000.0) as u32;
    picture_high(total, |canvas| {
        let mut top = canvas.heading(&figure.title, &figure.subtitle)?;
        legend.draw(canvas, MARGIN, top)?;
        top += legend.height + head + 8.0;
        let mut names: f64 = 0.0;
        for row in &figure.rows {
            names = names.max(width(&row.name, NAME_PX)?);
        }
        let whole = Frame {
            left: MARGIN + names.min(NAMES_MAX) + 16.0,
            top,
            right: CANVAS[0] - MARGIN,
            bottom: top + high,
        };
        for (row, place) in figure.rows.iter().zip(0..) {
            let top = whole.top + f64::from(place) * ROW;
            let name = shortened(&row.name, NAME_PX, NAMES_MAX)?;
            let at = [whole.left - 14.0, top + ROW / 2.0];
            canvas.text(&name, at, Lettering::new(NAME_PX, INK, Align::Right))?;
        }
        draw_columns(canvas, figure, &heads, &whole)
    })
}

/// The parts of a name, each with its hyphen.
fn parts(name: &str) -> Vec<String> {
    name.split_inclusive('-').map(str::to_owned).collect()
}

fn draw_columns(
    canvas: &Canvas,
    figure: &MatrixFigure,
    heads: &[Vec<String>],
    whole: &Frame,
) -> Result<(), ChartError> {
    let columns = count(heads.len()).max(1.0);
    let each = (whole.width() - (columns - 1.0) * BETWEEN) / columns;
    for (place, head) in heads.iter().enumerate() {
        let left = whole.left + count(place) * (each + BETWEEN);
        let middle = left + each / 2.0;
        let mut y = whole.top - 14.0 - 1.15 * HEAD_PX * (count(head.len()) - 1.0);
        for line in head {
            let line = shortened(line, HEAD_PX, each + BETWEEN)?;
            canvas.text(
                &line,
                [middle, y],
                Lettering::new(HEAD_PX, INK, Align::Center),
            )?;
            y += 1.15 * HEAD_PX;
        }
        for (row, down) in figure.rows.iter().zip(0..) {
            let cells = row.cells.get(place).map_or(&[][..], Vec::as_slice);
            let top = whole.top + f64::from(down) * ROW + GAP / 2.0;
            let wide = each / count(cells.len()).max(1.0);
            for (tone, across) in cells.iter().zip(0..) {
                let start = left + f64::from(across) * wide;
                let cell = Frame {
                    left: start,
                    top,
                    right: start + wide - GAP,
                    bottom: top + ROW - GAP,
                };
                canvas.fill(&cell, tone.color())?;
            }
        }
        let frame = Frame {
            left: left - GAP,
            top: whole.top - GAP / 2.0,
            right: left + each,
            bottom: whole.bottom + GAP / 2.0,
        };
        canvas.rule(&frame.outline(), Pen::solid(FRAME, 1.5))?;
        let score = shortened(&figure.columns[place].score, HEAD_PX, each + BETWEEN)?;
        let at = [middle, whole.bottom + 20.0];
        canvas.text(&score, at, Lettering::new(HEAD_PX, QUIET, Align::Center))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::testing::decode_high;
    use super::*;

    fn figure(rows: usize, cells: &[Tone]) -> MatrixFigure {
        MatrixFigure {
            title: "t".into(),
            subtitle: "s".into(),
            key: vec![(Tone::Good, "good".into())],
            columns: vec![MatrixColumn {
                name: "rapier-f64".into(),
                score: "1 of 2".into(),
            }],
            rows: (0..rows)
                .map(|row| MatrixRow {
                    name: format!("case {row}"),
                    cells: vec![cells.to_vec()],
                })
                .collect(),
        }
    }

    fn of_color(bytes: &[u8], tone: Tone) -> usize {
        let RGBColor(r, g, b) = tone.color();
        let image = decode_high(bytes);
        image.pixels.iter().filter(|p| **p == [r, g, b]).count()
    }

    /// A column is as wide as the cells of it together, whatever their number.
    #[test]
    fn cells_share_their_column() {
        let two = matrix(&figure(3, &[Tone::Bad, Tone::Poor])).unwrap();
        let one = matrix(&figure(3, &[Tone::Bad])).unwrap();
        let [bad, poor] = [Tone::Bad, Tone::Poor].map(|tone| of_color(&two, tone));
        assert!(
            bad > 10_000 && bad.abs_diff(poor) < bad / 20,
            "{bad} {poor}"
        );
        let alone = of_color(&one, Tone::Bad);
        assert!(alone.abs_diff(2 * bad) < alone / 20, "{alone} {bad}");
    }

    #[test]
    fn it_is_as_high_as_it_has_rows_and_no_data_make_it_fail() {
        let high = |rows| decode_high(&matrix(&figure(rows, &[Tone::Good])).unwrap()).height;
        assert_eq!(high(60) - high(50), 290);
        matrix(&figure(0, &[])).unwrap();
        let mut ragged = figure(2, &[]);
        ragged.columns.clear();
        matrix(&ragged).unwrap();
    }
}
