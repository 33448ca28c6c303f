//! Sizes and pens of the picture of prices over errors.

use plotters::style::RGBColor;

use super::curves::Weight;
use super::theme::{INK, PAPER, Pen, QUIET, color, mix};
use super::work_figure::WorkCurve;

/// Height of a line of the answers above the plot, of which there are three.
pub(super) const ANSWER: f64 = 36.0;
/// Height of the room for lines from the answers to their accuracies.
pub(super) const LEADERS: f64 = 34.0;
/// Radius of a point of other settings.
pub(super) const DOT: f64 = 4.0;
/// Radius of the ring around the cheapest point for an accuracy.
pub(super) const RING: f64 = 15.0;
/// Height of the letters of names, in pixels: easily read at a third of the size.
pub(super) const NAME_PX: f64 = 31.0;
/// Height of the letters beside points, in pixels: legible at a third of the size.
pub(super) const NOTE_PX: f64 = 26.0;

/// The colour of what is beside the matter.
pub(super) fn quiet() -> RGBColor {
    mix(QUIET, PAPER, 0.35)
}

/// The colour of a curve for letters, which need more contrast than lines.
pub(super) fn ink(index: usize) -> RGBColor {
    mix(color(index), INK, 0.35)
}

/// The pen of a curve.
pub(super) fn pen(curve: &WorkCurve) -> Pen {
    let (color, width) = match curve.weight {
        Weight::Main => (color(curve.color), 5.0),
        Weight::Aside => (mix(QUIET, PAPER, 0.6), 2.5),
    };
    Pen {
        color,
        width,
        style: curve.line,
    }
}

/// Radius of a point of a curve.
pub(super) fn point_radius(curve: &WorkCurve) -> f64 {
    match curve.weight {
        Weight::Main => 8.0,
        Weight::Aside => 5.0,
    }
}

/// The pen of the rings around the cheapest points.
pub(super) fn ring() -> Pen {
    Pen::solid(INK, 4.0)
}

/// The pen of the front.
pub(super) fn stairs() -> Pen {
    Pen::solid(mix(color(4), PAPER, 0.55), 13.0)
}
