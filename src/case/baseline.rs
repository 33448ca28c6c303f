//! The samples that a stored recording of an engine keeps.

use crate::scene::Scene;

/// A stored recording keeps no more samples than about this, besides the start: the tolerances
/// are for all of them, and the digest is over all that there were.
const SAMPLES: usize = 24;

/// Every how many samples of a scene one is kept: the least divisor of their count that leaves
/// few enough.
#[must_use]
pub fn thinning(scene: &Scene) -> usize {
    let count = scene.sample_count();
    let divides = |n: &usize| count.is_multiple_of(*n) && count / n <= SAMPLES;
    (1..=count).find(divides).unwrap_or(1)
}

/// The file of an engine's stored recording.
#[must_use]
pub fn baseline_file(engine: &str) -> String {
    format!("baseline-{engine}.csv")
}
