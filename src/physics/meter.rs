//! Counted work with a limit, for what may take long within one call.

/// Elementary operations done, about one a nanosecond, and how many may be done.
///
/// A count and no clock: the same computation ends at the same place on every machine.
#[derive(Debug, Clone, Copy)]
pub struct Meter {
    done: u64,
    limit: u64,
}

impl Default for Meter {
    fn default() -> Self {
        Self::limited(u64::MAX)
    }
}

impl Meter {
    /// That ends at so many operations.
    #[must_use]
    pub fn limited(limit: u64) -> Self {
        Self { done: 0, limit }
    }

    /// Sets how many operations may be done, those that were done included.
    pub fn limit(&mut self, limit: u64) {
        self.limit = limit;
    }

    /// Counts so many operations.
    #[inline]
    pub fn add(&mut self, operations: u64) {
        self.done = self.done.saturating_add(operations);
    }

    /// Operations done.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.done
    }

    /// Whether more operations are done than may be.
    #[must_use]
    #[inline]
    pub fn is_spent(&self) -> bool {
        self.done > self.limit
    }
}
