//! What a picture of prices over errors shows, as plain data.

use super::curves::Weight;
use super::theme::LineStyle;

/// A picture of prices over errors.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkFigure {
    /// What is shown.
    pub title: String,
    /// What else the reader should know; may be empty.
    pub subtitle: String,
    /// Name and unit of the error, on the axis below.
    pub x_label: String,
    /// Name and unit of the price, on the upright axis.
    pub y_label: String,
    /// Smaller errors lie on a line of their own, as an exact 0 does.
    pub least: f64,
    /// The curves; later ones lie on top.
    pub curves: Vec<WorkCurve>,
    /// Points (error, price) that nothing beats, drawn as stairs.
    pub front: Vec<[f64; 2]>,
    /// Accuracies asked for, from small errors to large ones, with their answers above the plot.
    pub goals: Vec<Goal>,
    /// An error with a name, shown as an upright line: below it accuracy does not matter.
    pub enough: Option<(f64, String)>,
}

/// One way to compute, over its ladder of steps.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkCurve {
    /// Its name, written beside it.
    pub label: String,
    /// Index of its colour; they repeat after [`super::COLOR_COUNT`].
    pub color: usize,
    /// How the line is broken.
    pub line: LineStyle,
    /// What the picture is about, or beside it: grey, and labelled only where there is room.
    pub weight: Weight,
    /// Joined in this order.
    pub points: Vec<WorkPoint>,
    /// Loose points (error, price) beneath: the same with other settings.
    pub others: Vec<[f64; 2]>,
}

/// One run. What is not finite and positive is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkPoint {
    /// Error.
    pub error: f64,
    /// Price.
    pub price: f64,
    /// What is written beside it where there is room; may be empty.
    pub label: String,
}

/// An accuracy asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Goal {
    /// The largest error allowed: an upright line.
    pub error: f64,
    /// How it is called.
    pub name: String,
    /// The cheapest way to it, if there is one.
    pub answer: Option<Answer>,
}

/// The cheapest way to an accuracy.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Who.
    pub who: String,
    /// Index of the colour of its curve.
    pub color: usize,
    /// With which step and setting.
    pub how: String,
    /// Its error and price; ringed.
    pub at: [f64; 2],
}
