//! The key to colours and line styles, in rows beside or above the plot.

use plotters::style::RGBColor;

use super::ChartError;
use super::canvas::{Align, Canvas, Lettering};
use super::text::{shortened, width};
use super::theme::{INK, LABEL_PX, LineStyle, Pen, QUIET};

/// Height of one row in pixels.
const ROW: f64 = 40.0;
/// Room for the sample of a line.
const LINE_KEY: f64 = 90.0;
/// Room for a disc or a ring.
const DISC_KEY: f64 = 26.0;
/// Between the key and its text.
const GAP: f64 = 12.0;
/// Between one entry and the next.
const BETWEEN: f64 = 40.0;

/// The sample that stands before the text of an entry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Key {
    /// A piece of a line.
    Line(Pen),
    /// A filled disc.
    Disc(RGBColor),
    /// The outline of a disc.
    Ring(Pen),
    /// Short upright strokes.
    Strokes(RGBColor),
    /// Nothing: the text is a remark.
    Remark,
}

/// One line of the key.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    /// Sample.
    pub(super) key: Key,
    /// What it stands for.
    pub(super) label: String,
}

impl Entry {
    /// An entry.
    pub(super) fn new(key: Key, label: impl Into<String>) -> Self {
        let label = label.into();
        Self { key, label }
    }
}

/// Entries with their places, relative to the upper left corner.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Legend {
    placed: Vec<(f64, f64, Entry)>,
    /// Height of all rows in pixels.
    pub(super) height: f64,
}

impl Legend {
    /// Lays the groups out in rows of the given width, each group on new rows unless
    /// everything fits on one. At most `most` rows; what is left out is counted.
    pub(super) fn flow(groups: &[Vec<Entry>], room: f64, most: usize) -> Result<Self, ChartError> {
        let one_row = total_width(groups)? <= room;
        Self::rows(groups, one_row, room, most)
    }

    /// Lays the entries out below each other; as [`Legend::flow`] does if they are more
    /// than `most`.
    pub(super) fn column(
        groups: &[Vec<Entry>],
        room: f64,
        most: usize,
    ) -> Result<Self, ChartError> {
        let single: Vec<Vec<Entry>> = groups.iter().flatten().map(|e| vec![e.clone()]).collect();
        if single.len() > most {
            return Self::flow(groups, room, most);
        }
        Self::rows(&single, false, room, most)
    }

    fn rows(
        groups: &[Vec<Entry>],
        one_row: bool,
        room: f64,
        most: usize,
    ) -> Result<Self, ChartError> {
        let mut rows: Vec<Vec<(f64, Entry)>> = Vec::new();
        let mut left = f64::INFINITY;
        for (i, group) in groups.iter().enumerate() {
            if !one_row || i == 0 {
                left = f64::INFINITY;
            }
            for entry in group {
                let text_room = room - key_width(entry.key);
                let label = shortened(&entry.label, LABEL_PX, text_room)?;
                let entry = Entry::new(entry.key, label);
                let wide = entry_width(&entry)?;
                match rows.last_mut() {
                    Some(row) if left + wide <= room => row.push((left, entry)),
                    Some(_) | None => {
                        left = 0.0;
                        rows.push(vec![(left, entry)]);
                    }
                }
                left += wide + BETWEEN;
            }
        }
        let hidden: usize = rows.iter().skip(most).map(Vec::len).sum();
        rows.truncate(most);
        if let (Some(row), true) = (rows.last_mut(), hidden > 0) {
            replace_end(row, hidden, room)?;
        }
        let mut height = 0.0;
        let mut placed = Vec::new();
        for row in rows {
            let middle = height + ROW / 2.0;
            placed.extend(row.into_iter().map(|(left, entry)| (left, middle, entry)));
            height += ROW;
        }
        Ok(Self { placed, height })
    }

    /// Draws the entries below and to the right of a point.
    pub(super) fn draw(&self, canvas: &Canvas, left: f64, top: f64) -> Result<(), ChartError> {
        for (x, y, entry) in &self.placed {
            let (x, y) = (left + x, top + y);
            draw_key(canvas, entry.key, x, y)?;
            let color = match entry.key {
                Key::Remark => QUIET,
                Key::Line(_) | Key::Disc(_) | Key::Ring(_) | Key::Strokes(_) => INK,
            };
            let look = Lettering {
                px: LABEL_PX,
                color,
                align: Align::Left,
            };
            canvas.text(&entry.label, [x + key_width(entry.key), y], look)?;
        }
        Ok(())
    }
}

/// Makes room at the end of the last row for the number of entries left out.
fn replace_end(row: &mut Vec<(f64, Entry)>, hidden: usize, room: f64) -> Result<(), ChartError> {
    let mut hidden = hidden;
    loop {
        let left = match row.last() {
            Some((left, entry)) => left + entry_width(entry)? + BETWEEN,
            None => 0.0,
        };
        let entry = Entry::new(Key::Remark, format!("… and {hidden} more"));
        if row.is_empty() || left + entry_width(&entry)? <= room {
            row.push((left, entry));
            return Ok(());
        }
        row.pop();
        hidden += 1;
    }
}

fn draw_key(canvas: &Canvas, key: Key, x: f64, y: f64) -> Result<(), ChartError> {
    let middle = [x + DISC_KEY / 2.0, y];
    match key {
        Key::Line(pen) => canvas.line(&[[x + 4.0, y], [x + 4.0 + sample(pen), y]], pen),
        Key::Disc(color) => canvas.disc(middle, DISC_KEY / 2.0, color),
        Key::Ring(pen) => canvas.ring(middle, DISC_KEY / 2.0 - 2.0, pen),
        Key::Strokes(color) => [4.0, 12.0, 20.0].into_iter().try_for_each(|shift| {
            let ends = [[x + shift, y - 9.0], [x + shift, y + 9.0]];
            canvas.line(&ends, Pen::solid(color, 3.0))
        }),
        Key::Remark => Ok(()),
    }
}

/// Length of the sample of a line: as many whole dashes as there is room for.
fn sample(pen: Pen) -> f64 {
    let room = LINE_KEY - 8.0;
    match pen.style {
        LineStyle::Solid | LineStyle::Dotted => room,
        LineStyle::Dashed => {
            let (dash, gap) = (pen.dash(), pen.gap());
            ((room + gap) / (dash + gap)).floor() * (dash + gap) - gap
        }
    }
}

fn key_width(key: Key) -> f64 {
    match key {
        Key::Line(_) => LINE_KEY + GAP,
        Key::Disc(_) | Key::Ring(_) | Key::Strokes(_) => DISC_KEY + GAP,
        Key::Remark => 0.0,
    }
}

fn entry_width(entry: &Entry) -> Result<f64, ChartError> {
    Ok(key_width(entry.key) + width(&entry.label, LABEL_PX)?)
}

fn total_width(groups: &[Vec<Entry>]) -> Result<f64, ChartError> {
    let mut total = -BETWEEN;
    for entry in groups.iter().flatten() {
        total += entry_width(entry)? + BETWEEN;
    }
    Ok(total)
}

#[cfg(test)]
mod tests {
    use super::super::text::register;
    use super::*;

    fn entries(count: usize) -> Vec<Entry> {
        (0..count)
            .map(|i| Entry::new(Key::Disc(INK), format!("body {i}")))
            .collect()
    }

    #[test]
    fn groups_share_a_row_only_if_everything_fits() {
        register().unwrap();
        let groups = [entries(2), entries(2)];
        assert!((Legend::flow(&groups, 1300.0, 5).unwrap().height - ROW).abs() < 1e-9);
        let narrow = Legend::flow(&groups, 400.0, 5).unwrap();
        assert!((narrow.height - 2.0 * ROW).abs() < 1e-9);
        assert!(narrow.placed[2].0.abs() < 1e-9);
    }

    #[test]
    fn a_column_has_one_entry_a_row_while_there_are_rows() {
        register().unwrap();
        let groups = [entries(2), entries(2)];
        let column = Legend::column(&groups, 1300.0, 5).unwrap();
        assert!((column.height - 4.0 * ROW).abs() < 1e-9);
        assert!((Legend::column(&groups, 1300.0, 3).unwrap().height - ROW).abs() < 1e-9);
    }

    #[test]
    fn what_is_left_out_is_counted() {
        register().unwrap();
        let legend = Legend::flow(&[entries(100)], 800.0, 2).unwrap();
        assert!((legend.height - 2.0 * ROW).abs() < 1e-9);
        let shown = legend.placed.len() - 1;
        let last = &legend.placed[shown].2;
        assert_eq!(last.label, format!("… and {} more", 100 - shown));
    }

    #[test]
    fn nothing_reaches_beyond_the_room() {
        register().unwrap();
        let mut groups = [entries(9), Vec::new()];
        groups[1].push(Entry::new(Key::Remark, "very ".repeat(200)));
        let legend = Legend::flow(&groups, 500.0, 20).unwrap();
        for (left, _, entry) in &legend.placed {
            assert!(left + entry_width(entry).unwrap() <= 500.0, "{entry:?}");
        }
    }
}
