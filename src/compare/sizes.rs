//! The yardsticks of a comparison: what a length, an energy or a momentum is measured against.

use serde::Serialize;

use super::Metrics;
use crate::recording::Recording;

/// Sizes of a scene in motion. A share of zero is taken as zero, see [`Sizes::share`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sizes {
    /// Diagonal of the box of all positions, scene length unit.
    pub length: f64,
    /// Largest |kinetic| + |potential| energy.
    pub energy: f64,
    /// Largest sum of m |v|.
    pub momentum: f64,
}

impl Sizes {
    /// The sizes of one recording.
    #[must_use]
    pub fn of(recording: &Recording, metrics: &[Metrics]) -> Self {
        let corners = recording.samples().flatten().map(|s| s.position);
        let corners = corners.fold(None, |corners, position| match corners {
            None => Some((position, position)),
            Some((low, high)) => Some((position.inf(&low), position.sup(&high))),
        });
        // `hypot` does not overflow where squares would.
        let length = corners.map_or(0.0, |(low, high)| {
            (high.x - low.x).hypot(high.y - low.y).hypot(high.z - low.z)
        });
        let largest = |value: fn(&Metrics) -> f64| metrics.iter().map(value).fold(0.0, f64::max);
        Self {
            length,
            energy: largest(Metrics::energy_scale),
            momentum: largest(|at| at.momentum_scale),
        }
    }

    /// The smaller of each size: a recording that flies apart must not make the errors of the
    /// others look small, nor its own.
    #[must_use]
    pub fn smaller(self, other: Self) -> Self {
        Self {
            length: self.length.min(other.length),
            energy: self.energy.min(other.energy),
            momentum: self.momentum.min(other.momentum),
        }
    }

    /// A part as a share of a size; 0 where the size is 0.
    #[must_use]
    pub fn share(part: f64, size: f64) -> f64 {
        if size == 0.0 { 0.0 } else { part / size }
    }
}
