//! The time grid: samples of the scene, and the steps between two of them.

use crate::error::{Error, Result};
use crate::scene::Scene;

/// The lecture's largest step, s; the default everywhere.
///
/// DEVIATES: the slides clamp the wall-clock time of a frame to 0.01 s (`doSimulation`) and to
/// 0.1 s (`forceIntegration`); here the step is what was asked for, larger ones included.
pub const DEFAULT_DT: f64 = 0.01;

/// More steps than this are refused: an hour and more of computing, or a slip of the pen.
const STEPS_MAX: f64 = 1e10;

/// The steps between two samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepGrid {
    /// Time between two samples, s.
    pub sample_every: f64,
    /// Steps between two samples, k.
    pub steps_per_sample: u64,
    /// The step taken, s: `sample_every / k`.
    pub step: f64,
}

impl StepGrid {
    /// The largest step up to `dt` of which a whole number fits between two samples.
    ///
    /// Equation: `k = ceil(sample_every / dt - 1e-9)`, `h = sample_every / k`.
    ///
    /// # Errors
    /// [`Error::Step`] if `dt` is not a positive number or makes absurdly many steps.
    pub fn new(scene: &Scene, dt: f64) -> Result<Self> {
        let wrong = |message: String| Error::Step { dt, message };
        if !(dt.is_finite() && dt > 0.0) {
            return Err(wrong("give a finite number above 0".into()));
        }
        let steps_per_sample = (scene.sample_every / dt - 1e-9).ceil().max(1.0);
        let steps = steps_per_sample * (scene.duration / scene.sample_every).round();
        if steps > STEPS_MAX {
            return Err(wrong(format!(
                "makes {steps:.3e} steps, more than {STEPS_MAX:.0e}; take a larger step or a shorter scene"
            )));
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked"
        )]
        let count = steps_per_sample as u64;
        Ok(Self {
            sample_every: scene.sample_every,
            steps_per_sample: count,
            step: scene.sample_every / steps_per_sample,
        })
    }

    /// Time at the end of a step, counted from 1 within the interval before `sample`, s.
    ///
    /// The last step ends on the sample's own time, without accumulated rounding.
    #[must_use]
    #[allow(
        clippy::cast_precision_loss,
        reason = "step counts stay far below 2^53"
    )]
    #[inline]
    pub fn time(&self, sample: usize, step_in_interval: u64) -> f64 {
        if step_in_interval == self.steps_per_sample {
            return sample as f64 * self.sample_every;
        }
        let done = (sample - 1) as f64 * self.sample_every;
        done + step_in_interval as f64 * self.step
    }
}
