//! How many digits a recording vouches for.

use serde::Serialize;

/// Positions with fewer digits than this are called not comparable.
pub const COMPARABLE_DIGITS: f64 = 6.0;

/// Decimal digits that a recording vouches for at one sample: at most what it has, rarely all.
///
/// Digits of positions are relative to the diagonal of the box of all positions, digits of
/// velocities to the largest speed: `-log10(error / scale)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Digits {
    /// Digits of every position.
    pub positions: f64,
    /// Digits of every velocity.
    pub velocities: f64,
}

/// From when on the model itself has no single answer: another order of simultaneous events
/// gives another course.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Undetermined {
    /// Time of the simultaneous events, s.
    pub time_s: f64,
    /// The bodies that take part.
    pub bodies: Vec<usize>,
    /// Largest distance between the answers at the end, scene length unit.
    pub spread: f64,
}
