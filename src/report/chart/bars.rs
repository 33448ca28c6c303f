//! Bars on logarithmic axes: the same rows in every group, side by side.

use super::ChartError;
use super::axis::{Axis, fitting};
use super::canvas::{Align, Canvas, Lettering, picture};
use super::polyline::{Frame, count};
use super::text::{shortened, width};
use super::theme::{
    CANVAS, FRAME, GRID, INK, LABEL_PX, MARGIN, PAPER, Pen, QUIET, SMALL_PX, color, mix,
};

/// Height of the line above the groups with their names.
const HEADING: f64 = 46.0;
/// Room below the groups for the labels and the name of the axis.
const FOOT: f64 = 88.0;
/// Between two groups.
const BETWEEN: f64 = 44.0;
/// The names of the rows take at most this.
const NAMES_MAX: f64 = 300.0;
/// Share of the height of a row that its bar takes.
const BAR: f64 = 0.76;

/// A picture of values, grouped.
#[derive(Debug, Clone, PartialEq)]
pub struct BarsFigure {
    /// What is shown.
    pub title: String,
    /// What else the reader should know; may be empty.
    pub subtitle: String,
    /// Name and unit of the values, below the groups.
    pub x_label: String,
    /// The rows, from top to bottom: name and index of colour.
    pub rows: Vec<(String, usize)>,
    /// The groups, from left to right.
    pub groups: Vec<BarGroup>,
}

/// A bar for each row.
#[derive(Debug, Clone, PartialEq)]
pub struct BarGroup {
    /// Its name, above.
    pub name: String,
    /// One for each row; where there is none, the reason is written instead.
    pub bars: Vec<Result<Bar, String>>,
}

/// A value. What is not finite and positive is drawn without a bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// How long the bar is.
    pub value: f64,
    /// Written on it.
    pub label: String,
    /// Whether it stands out.
    pub is_best: bool,
}

/// Draws bars as a PNG.
///
/// # Errors
/// None that depends on the data: see [`ChartError`].
pub fn bars(figure: &BarsFigure) -> Result<Vec<u8>, ChartError> {
    picture(|canvas| {
        let top = canvas.heading(&figure.title, &figure.subtitle)?;
        let plot = layout(figure, top)?;
        draw_names(canvas, figure, &plot)?;
        for (group, frame) in figure.groups.iter().zip(&plot.frames) {
            draw_grid(canvas, group, &plot.axis, frame)?;
            for ((bar, (_, color)), row) in group.bars.iter().zip(&figure.rows).zip(&plot.rows) {
                let row = Frame {
                    left: frame.left,
                    right: frame.right,
                    ..*row
                };
                draw_bar(canvas, bar, *color, &plot.axis, &row)?;
            }
            canvas.rule(&frame.outline(), Pen::solid(FRAME, 2.0))?;
        }
        let look = Lettering::new(LABEL_PX, INK, Align::Center);
        let label = shortened(&figure.x_label, LABEL_PX, CANVAS[0] - 2.0 * MARGIN)?;
        let middle = f64::midpoint(plot.whole.left, plot.whole.right);
        canvas.text(&label, [middle, plot.whole.bottom + 60.0], look)
    })
}

/// Where the groups and the rows are, and the axis that all groups share.
struct Plot {
    whole: Frame,
    frames: Vec<Frame>,
    rows: Vec<Frame>,
    axis: Axis,
}

fn layout(figure: &BarsFigure, top: f64) -> Result<Plot, ChartError> {
    let mut names: f64 = 0.0;
    for (name, _) in &figure.rows {
        names = names.max(width(name, LABEL_PX)?);
    }
    let left = MARGIN + names.min(NAMES_MAX) + 16.0;
    let whole = Frame {
        left,
        top: top + HEADING,
        right: CANVAS[0] - MARGIN,
        bottom: CANVAS[1] - FOOT,
    };
    let groups = f64::max(count(figure.groups.len()), 1.0);
    let each = (whole.width() - (groups - 1.0) * BETWEEN) / groups;
    let high = whole.height() / f64::max(count(figure.rows.len()), 1.0);
    let mut frames = Vec::new();
    let mut start = whole.left;
    for _ in &figure.groups {
        frames.push(Frame {
            left: start,
            right: start + each,
            ..whole
        });
        start += each + BETWEEN;
    }
    let mut rows = Vec::new();
    let mut start = whole.top;
    for _ in &figure.rows {
        rows.push(Frame {
            top: start,
            bottom: start + high,
            ..whole
        });
        start += high;
    }
    let all = figure.groups.iter().flat_map(|group| &group.bars);
    let values: Vec<f64> = all
        .flatten()
        .map(|bar| bar.value)
        .filter(|v| *v > 0.0)
        .collect();
    let axis = fitting(each, |most| Axis::decades(&values, most))?;
    Ok(Plot {
        whole,
        frames,
        rows,
        axis,
    })
}

fn draw_names(canvas: &Canvas, figure: &BarsFigure, plot: &Plot) -> Result<(), ChartError> {
    for ((name, _), row) in figure.rows.iter().zip(&plot.rows) {
        let name = shortened(name, LABEL_PX, NAMES_MAX)?;
        let at = [row.left - 16.0, f64::midpoint(row.top, row.bottom)];
        canvas.text(&name, at, Lettering::new(LABEL_PX, INK, Align::Right))?;
    }
    Ok(())
}

fn draw_grid(
    canvas: &Canvas,
    group: &BarGroup,
    axis: &Axis,
    frame: &Frame,
) -> Result<(), ChartError> {
    let name = shortened(&group.name, LABEL_PX, frame.width())?;
    let middle = f64::midpoint(frame.left, frame.right);
    let look = Lettering::new(LABEL_PX, INK, Align::Center);
    canvas.text(&name, [middle, frame.top - 0.5 * HEADING], look)?;
    for label in &axis.labels {
        let x = frame.x(label.share);
        canvas.rule(&[[x, frame.top], [x, frame.bottom]], Pen::solid(GRID, 2.0))?;
        let reach = width(&label.text, SMALL_PX)? / 2.0;
        let room = frame.left - BETWEEN / 2.0 + reach..=frame.right + BETWEEN / 2.0 - reach;
        if room.contains(&x) {
            let look = Lettering::new(SMALL_PX, QUIET, Align::Center);
            canvas.text(&label.text, [x, frame.bottom + 22.0], look)?;
        }
    }
    Ok(())
}

fn draw_bar(
    canvas: &Canvas,
    bar: &Result<Bar, String>,
    index: usize,
    axis: &Axis,
    row: &Frame,
) -> Result<(), ChartError> {
    let middle = f64::midpoint(row.top, row.bottom);
    let half = 0.5 * BAR * row.height();
    let px = SMALL_PX.min(1.6 * half);
    let (text, ink) = match bar {
        Ok(bar) => (&bar.label, INK),
        Err(reason) => (reason, mix(QUIET, PAPER, 0.4)),
    };
    let end = bar.as_ref().ok().and_then(|bar| axis.share(bar.value));
    if let (Ok(bar), Some(share)) = (bar, end) {
        let filled = Frame {
            top: middle - half,
            right: row.x(share.clamp(0.0, 1.0)),
            bottom: middle + half,
            ..*row
        };
        let paler = if bar.is_best { 0.5 } else { 0.72 };
        canvas.fill(&filled, mix(color(index), PAPER, paler))?;
        if bar.is_best {
            canvas.rule(&filled.outline(), Pen::solid(INK, 4.0))?;
        }
    }
    let text = shortened(text, px, row.width() - 20.0)?;
    let at = [row.left + 12.0, middle];
    canvas.text(&text, at, Lettering::new(px, ink, Align::Left))
}

#[cfg(test)]
mod tests {
    use super::super::testing::decode;
    use super::super::text::register;
    use super::*;

    fn bar(value: f64, is_best: bool) -> Bar {
        Bar {
            value,
            label: String::new(),
            is_best,
        }
    }

    fn figure(rows: usize, groups: Vec<Vec<Bar>>) -> BarsFigure {
        let groups = groups.into_iter().map(|bars| BarGroup {
            name: "1 mm".to_owned(),
            bars: bars.into_iter().map(Ok).collect(),
        });
        BarsFigure {
            title: "t".to_owned(),
            subtitle: "s".to_owned(),
            x_label: "price".to_owned(),
            rows: (0..rows).map(|row| (format!("row {row}"), row)).collect(),
            groups: groups.collect(),
        }
    }

    /// Inks of a row of pixels within a group, at a third of the height of its bar, where no
    /// text is.
    fn length(bytes: &[u8], frame: &Frame, row: &Frame) -> usize {
        let image = decode(bytes);
        let pixel = |x: f64| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "within the picture"
            )]
            let at = |v: f64| v as usize;
            image.at(at(x), at(f64::midpoint(row.top, row.bottom)))
        };
        let mut x = frame.left + 4.0;
        let first = pixel(x);
        let mut length = 0;
        // Lines of the grid lie beneath bars, so that a bar is one colour to its end.
        while pixel(x) == first && x < frame.right - 4.0 {
            length += 1;
            x += 1.0;
        }
        length
    }

    /// Ten times the value is a decade longer, in every group.
    #[test]
    fn bars_are_as_long_as_their_logarithms() {
        register().unwrap();
        let groups = vec![
            vec![bar(1.0, false), bar(10.0, false)],
            vec![bar(100.0, false), bar(1e-1, false)],
        ];
        let figure = figure(2, groups);
        let bytes = bars(&figure).unwrap();
        let plot = layout(&figure, 40.0 - 8.0 + 1.3 * (38.0 + SMALL_PX) + 8.0).unwrap();
        let long = |group: usize, row: usize| {
            let pixels = length(&bytes, &plot.frames[group], &plot.rows[row]);
            f64::from(u32::try_from(pixels).unwrap())
        };
        let decade = plot.axis.share(10.0).unwrap() - plot.axis.share(1.0).unwrap();
        let decade = decade * plot.frames[0].width();
        // Two edges, each smoothed over a pixel or two.
        assert!((long(0, 1) - long(0, 0) - decade).abs() < 4.0);
        assert!((long(1, 0) - long(0, 0) - 2.0 * decade).abs() < 4.0);
    }

    #[test]
    fn what_stands_out_has_an_outline_and_what_is_missing_a_word() {
        let plain = bars(&figure(1, vec![vec![bar(2.0, false)]])).unwrap();
        let best = bars(&figure(1, vec![vec![bar(2.0, true)]])).unwrap();
        let mut none = figure(1, vec![vec![bar(2.0, false)]]);
        none.groups[0].bars[0] = Err("not reached".to_owned());
        let none = bars(&none).unwrap();
        let dark = |bytes: &[u8]| {
            let image = decode(bytes);
            image.pixels.iter().filter(|pixel| pixel[0] < 64).count()
        };
        assert!(dark(&best) > dark(&plain) + 1000);
        assert!(decode(&none).ink() > 1000);
    }

    #[test]
    fn no_data_make_it_fail() {
        let strange = [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e308, 5e-324];
        let all = strange.iter().map(|value| bar(*value, true)).collect();
        let figure = |rows, groups| super::bars(&figure(rows, groups)).unwrap();
        assert_eq!(decode(&figure(6, vec![all])).pixels.len(), 1440 * 900);
        decode(&figure(0, Vec::new()));
        decode(&figure(3, vec![Vec::new()]));
        let many = vec![(0..40).map(|_| bar(1.0, false)).collect()];
        decode(&figure(40, many));
    }
}
