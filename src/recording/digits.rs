//! How many digits a recording vouches for.

use serde::Serialize;

/// Positions with fewer digits than this are called not comparable.
pub const COMPARABLE_DIGITS: u8 = 6;

/// Decimal digits that a recording vouches for at one sample: at most what it has, rarely all.
///
/// Digits of positions are relative to the diagonal of the box of all positions, digits of
/// velocities to the largest speed: `-log10(error / scale)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Digits {
    /// Digits of every position.
    pub position: u8,
    /// Digits of every velocity.
    pub velocity: u8,
}

/// From when on the model itself has no single answer: another order of simultaneous events
/// gives another course.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Undetermined {
    /// Time of the simultaneous events, s.
    #[serde(rename = "time_s")]
    pub time: f64,
    /// The bodies that take part.
    pub bodies: Vec<usize>,
    /// Largest distance between the answers, scene length unit, where they were computed.
    pub spread: Option<f64>,
}
