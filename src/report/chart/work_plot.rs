//! Where the plot of prices over errors is, and its axes.

use super::ChartError;
use super::axis::{Axis, extent, fitting};
use super::polyline::{Frame, Point};
use super::text::{shortened, width};
use super::theme::{CANVAS, LABEL_PX, MARGIN, SMALL_PX};
use super::work_figure::{WorkCurve, WorkFigure, WorkPoint};
use super::work_look::{ANSWER, LEADERS};

/// Room below the plot for the labels and the name of its axis.
const FOOT: f64 = 88.0;

/// Where the plot is, and its axes.
pub(super) struct Plot {
    pub(super) frame: Frame,
    pub(super) errors: Axis,
    pub(super) prices: Axis,
    least: f64,
}

impl Plot {
    /// The column of an error.
    pub(super) fn column(&self, error: f64) -> Option<f64> {
        let share = self.errors.share(shown(error, self.least))?;
        Some(self.frame.x(share))
    }

    /// The place of an error and a price.
    pub(super) fn place(&self, [error, price]: [f64; 2]) -> Option<Point> {
        let row = self.frame.y(self.prices.share(price)?);
        Some([self.column(error)?, row])
    }

    /// The points of a curve that have a place.
    pub(super) fn places<'a>(&self, curve: &'a WorkCurve) -> Vec<(Point, &'a WorkPoint)> {
        let points = curve.points.iter();
        let placed =
            points.filter_map(|point| Some((self.place([point.error, point.price])?, point)));
        placed.collect()
    }
}

/// An error as the axis knows it: too small ones are 0.
fn shown(error: f64, least: f64) -> f64 {
    if (0.0..least).contains(&error) {
        0.0
    } else {
        error
    }
}

/// Lays the plot out below the row `top`, with room for the answers above it.
pub(super) fn layout(figure: &WorkFigure, top: f64) -> Result<Plot, ChartError> {
    let (mut errors, mut prices) = (Vec::new(), Vec::new());
    for curve in &figure.curves {
        let points = curve.points.iter().map(|point| [point.error, point.price]);
        for [error, price] in points.chain(curve.others.iter().copied()) {
            if error.is_finite() && error >= 0.0 && price.is_finite() && price > 0.0 {
                errors.push(shown(error, figure.least));
                prices.push(price);
            }
        }
    }
    errors.extend(figure.enough.iter().map(|(error, _)| *error));
    errors.extend(figure.goals.iter().map(|goal| goal.error));
    let top = if figure.goals.is_empty() {
        top + 20.0
    } else {
        top + 3.0 * ANSWER + LEADERS
    };
    let bottom = CANVAS[1] - FOOT;
    let rows = (bottom - top).max(0.0) / (1.5 * SMALL_PX);
    let fits = |count: &u32| f64::from(*count) <= rows;
    let prices = snug(&prices, (3..=12).rfind(fits).unwrap_or(3));
    let mut gutter: f64 = 0.0;
    for label in &prices.labels {
        gutter = gutter.max(width(&label.text, SMALL_PX)?);
    }
    let frame = Frame {
        left: MARGIN + gutter + 14.0,
        top,
        right: CANVAS[0] - MARGIN - 20.0,
        bottom,
    };
    let mut errors = fitting(frame.width(), |most| snug(&errors, most))?;
    if errors.zero_band() > 0.0 {
        "less".clone_into(&mut errors.labels[0].text);
    }
    Ok(Plot {
        frame,
        errors,
        prices,
        least: figure.least,
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

/// The name of the upright axis, and its place: within, since the answers stand above.
pub(super) fn price_label(figure: &WorkFigure, plot: &Plot) -> Result<(String, Frame), ChartError> {
    let frame = &plot.frame;
    let left = frame.x(0.7 * plot.errors.zero_band()) + 12.0;
    let name = shortened(&figure.y_label, LABEL_PX, frame.right - left)?;
    let place = Frame {
        left,
        top: frame.top + 6.0,
        right: left + width(&name, LABEL_PX)?,
        bottom: frame.top + 6.0 + 1.3 * LABEL_PX,
    };
    Ok((name, place))
}
