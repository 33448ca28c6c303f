//! Settings of the exact engine.

use serde::Serialize;

/// Settings of the exact engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ExactSettings {
    /// Whether a second computation certifies the digits of the first.
    pub certify: bool,
    /// Bound on the work of each computation, in elementary operations, about one a nanosecond.
    /// To certify takes several: of flights three wide ones and one in doubles, and four more
    /// where impacts coincide; of motions under forces two, and a third where the order of impacts
    /// matters.
    pub operations: u64,
}

impl ExactSettings {
    /// The published settings, with or without certification: some twenty seconds a computation.
    pub(super) fn bounded(certify: bool) -> Self {
        Self {
            certify,
            operations: 20_000_000_000,
        }
    }

    pub(super) fn describe(self) -> &'static str {
        if self.certify {
            "From event to event without a time step, computed more than once to certify its own \
             digits."
        } else {
            "From event to event without a time step, in doubles, nothing certified."
        }
    }
}
