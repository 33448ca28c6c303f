//! Counted work with a limit, so that no scene computes without end.

use crate::physics::real::Real;

/// Elementary operations done, about one a nanosecond, and how many may be done.
///
/// A count and no clock: the same scene ends at the same event on every machine.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    done: f64,
    limit: f64,
}

impl Effort {
    #[allow(clippy::cast_precision_loss, reason = "a limit need not be exact")]
    pub(super) fn limited(limit: u64) -> Self {
        Self {
            done: 0.0,
            limit: limit as f64,
        }
    }

    /// Counts so many operations in that arithmetic.
    #[inline]
    pub(super) fn add<T: Real>(&mut self, operations: f64) {
        self.done += operations * T::COST;
    }

    pub(super) fn done(&self) -> f64 {
        self.done
    }

    #[inline]
    pub(super) fn is_spent(&self) -> bool {
        self.done > self.limit
    }
}
