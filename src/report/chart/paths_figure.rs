//! What a picture of paths is drawn from.

use super::ticks::with_exponent;

/// A picture of paths in a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct PathsFigure {
    /// What is shown.
    pub title: String,
    /// What else the reader should know; may be empty.
    pub subtitle: String,
    /// The two axes of the points.
    pub axes: [AxisLabel; 2],
    /// How the plane is looked at.
    pub view: View,
    /// Half extents of the table along both axes, for a table around the origin.
    pub cushions: Option<[f64; 2]>,
    /// What moves.
    pub bodies: Vec<PathBody>,
    /// Names of the engines, in the order of [`PathBody::tracks`]; up to three are told
    /// apart.
    pub voices: Vec<String>,
}

/// How the plane is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// On the x-z plane of a right-handed system with y up, from above: x to the right
    /// and z down, or turned by a quarter (z to the right, x up) where that is the wider
    /// picture. Never mirrored.
    Above,
    /// The first axis to the right, the second up, as for x and y seen from the side.
    Side,
}

/// Name and unit of an axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AxisLabel {
    /// Such as "x".
    pub name: String,
    /// Such as "mm"; may be empty.
    pub unit: String,
}

impl AxisLabel {
    /// A label.
    #[must_use]
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
        }
    }

    pub(super) fn text(&self, exponent: i32) -> String {
        let plain = if self.unit.is_empty() {
            self.name.clone()
        } else {
            format!("{} [{}]", self.name, self.unit)
        };
        with_exponent(&plain, exponent)
    }
}

/// A body and where each voice saw it go.
#[derive(Debug, Clone, PartialEq)]
pub struct PathBody {
    /// Its name.
    pub name: String,
    /// Its radius, in the unit of the axes.
    pub radius: f64,
    /// Points in the plane, `[voice][sample]`. One that is not finite leaves a gap.
    pub tracks: Vec<Vec<[f64; 2]>>,
}
