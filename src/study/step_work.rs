//! How much work a step is counted as, the same for every engine.

use crate::scene::Scene;

/// The work that a step of any engine is counted as: bodies and pairs.
pub(super) fn work_a_step(scene: &Scene) -> u64 {
    let bodies = scene.bodies.len() as u64;
    bodies + bodies * bodies.saturating_sub(1) / 2
}
