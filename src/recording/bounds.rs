//! How large what is recorded may be, and the tables that hold it.

use crate::scene::{Body, Scene};

/// Events that a log keeps one by one. Each takes 40 bytes, and its latest of the same bodies up
/// to 100 more: 140 MB. What comes after is counted with those merged.
pub(super) const EVENTS_MAX: usize = 1_000_000;

/// Bytes of a table of events. The shortest row has 12, which makes 2.8 million events of up to
/// 140 bytes while they are read: 400 MB.
pub(crate) const EVENTS_BYTES_MAX: u64 = 32 << 20;

/// Rows that are read on to tell a missing row from another order: half a second.
pub(super) const ROWS_AHEAD_MAX: usize = 500_000;

/// Characters of a double with all its digits, sign, exponent and comma.
const NUMBER_BYTES: u64 = 25;

/// Times what the table of a trajectory can need that it may have.
const ROOM: u64 = 4;

/// What a small table may have in any case: one of another scene is told by its rows.
const SMALL: u64 = 1 << 20;

/// Bytes that the trajectory of a scene takes with all the digits of every number.
#[must_use]
pub fn trajectory_bytes(scene: &Scene) -> u64 {
    let row = |body: &Body| 7 * NUMBER_BYTES + 2 * body.name.len() as u64 + 3;
    let sample: u64 = scene.bodies.iter().map(row).sum();
    let samples = scene.sample_count() as u64 + 2;
    sample.saturating_mul(samples)
}

/// Bytes that the table of a trajectory may have. It is read as a stream: memory is that of the
/// scene's states.
#[must_use]
pub fn trajectory_bytes_max(scene: &Scene) -> u64 {
    SMALL.max(trajectory_room(scene))
}

/// Bytes that a solver may write in any case, however small its limit is.
#[must_use]
pub fn trajectory_room(scene: &Scene) -> u64 {
    ROOM.saturating_mul(trajectory_bytes(scene))
}
