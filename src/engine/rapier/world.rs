//! What carom asks of a Rapier world, in whichever precision.

use super::layout::Layout;
use super::range::Range;
use crate::engine::RapierSettings;
use crate::physics::{BodyState, Vector3};

/// A world of one precision. Bodies and walls are parties, numbered bodies first, then walls
/// in the order of the [`Layout`].
pub(super) trait World: Send {
    /// The numbers it computes with.
    const RANGE: Range;

    /// A fresh world of that layout with these states. Shape: `[body]`.
    fn build(layout: &Layout, states: &[BodyState]) -> Self;

    /// The parameters that a world with these settings runs with, Rapier's defaults included.
    fn parameters(settings: &RapierSettings, length_unit: f64, step: f64) -> Parameters;

    /// One step.
    fn step(&mut self);

    /// The first body that the last step disabled.
    fn lost(&self) -> Option<usize>;

    /// Pairs that the narrow phase held in the last step.
    fn pair_count(&self) -> u64;

    /// Position and velocity of a body.
    fn state(&self, body: usize) -> BodyState;

    /// Velocity of a body.
    fn velocity(&self, body: usize) -> Vector3;

    /// Sets the velocity of a body to zero; awakens it, where bodies may sleep.
    fn stop(&mut self, body: usize);

    /// Replaces the force on a body; one that is not zero awakens it, where bodies may sleep.
    fn set_force(&mut self, body: usize, force: &Vector3);

    /// Tells, for every touching pair of parties, the impulse of the whole last step.
    fn each_impulse(&self, visit: impl FnMut(usize, usize, f64));
}

/// Integration parameters of a world, as plain numbers in scene units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Parameters {
    /// Substeps of a step: Rapier's `num_solver_iterations`.
    pub substeps: usize,
    /// Contacts are made this far ahead, scene length unit.
    pub prediction_distance: f64,
    /// A pair that moved less keeps its old contact, scene length unit; none: always anew.
    pub recycle_distance: Option<f64>,
    /// Passes of continuous collision detection; 0 is none.
    pub ccd_passes: usize,
    /// Speeds above are cut to it, scene length unit per second; none: no cap.
    pub speed_cap: Option<f64>,
    /// Fastest push-out of an overlap, scene length unit per second.
    pub push_out_speed: f64,
    /// When a body falls asleep; none: never.
    pub sleep: Option<Sleep>,
}

/// When Rapier puts a body to sleep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sleep {
    /// Slower than this, scene length unit per second …
    pub speed: f64,
    /// … for so long, s.
    pub after: f64,
}
