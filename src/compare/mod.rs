//! Two or more recordings of one scene: conserved quantities, divergence, events in order.

mod cluster;
mod divergence;
mod events;
mod metrics;

pub use cluster::{ClusterFacts, cluster_facts};
pub use divergence::{Divergence, DivergenceSample};
pub use events::{Disagreement, EventAgreement, compare_events};
pub use metrics::{Drift, Metrics, metrics};

use crate::recording::Recording;

/// Diagonal of the box of all positions that any of the recordings visits, scene length unit:
/// the yardstick for divergences.
///
/// A scene in which nothing moves and one body stands alone has size 0.
#[must_use]
pub fn scene_size(recordings: &[Recording]) -> f64 {
    let positions = recordings
        .iter()
        .flat_map(Recording::samples)
        .flatten()
        .map(|s| s.position);
    let corners = positions.fold(None, |corners, position| match corners {
        None => Some((position, position)),
        Some((low, high)) => Some((position.inf(&low), position.sup(&high))),
    });
    corners.map_or(0.0, |(low, high)| (high - low).norm())
}
