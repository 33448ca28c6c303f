//! Bounds on the work: vanishing steps and events without end are noticed and ended.

use super::scalar::Real;

/// Steps in a row that may pass without time going on.
const STANDSTILL_MAX: u32 = 10_000;

/// Every so many steps, time must have gone on by [`PROGRESS_MIN`].
const WINDOW: u32 = 100_000;

/// Share of the duration: at 1e-3 no scene takes more than 1e8 steps.
const PROGRESS_MIN: f64 = 1e-3;

/// Watches the progress of time over steps.
#[derive(Debug, Clone)]
pub(super) struct Watchdog {
    duration: f64,
    standstill: u32,
    steps: u32,
    window_start: f64,
}

impl Watchdog {
    pub(super) fn new(duration: f64) -> Self {
        Self {
            duration,
            standstill: 0,
            steps: 0,
            window_start: 0.0,
        }
    }

    pub(super) fn restart(&mut self, time: f64) {
        *self = Self {
            window_start: time,
            ..Self::new(self.duration)
        };
    }

    /// Whether a step is too short to move time: bodies fall into one point, or a force has no
    /// direction.
    pub(super) fn is_vanishing<T: Real>(&self, time: f64, step: f64) -> bool {
        step <= 4.0 * T::ROUNDING * time.max(1e-6 * self.duration)
    }

    /// Counts a step; whether events or steps pile up.
    pub(super) fn runs_away(&mut self, time: f64, progress: f64) -> bool {
        self.standstill += 1;
        if progress > 1e-15 * self.duration {
            self.standstill = 0;
        }
        self.steps += 1;
        if self.steps == WINDOW {
            let stalled = time - self.window_start < PROGRESS_MIN * self.duration;
            self.steps = 0;
            self.window_start = time;
            return stalled;
        }
        self.standstill == STANDSTILL_MAX
    }
}
