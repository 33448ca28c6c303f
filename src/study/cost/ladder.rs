//! The ladder of steps: powers of two of the sample spacing, as far as the budget reaches.

use crate::engine::StepGrid;
use crate::error::{Error, Result};
use crate::scene::Scene;

/// More rungs than this say nothing new: the step is then a millionth of the sample spacing.
const RUNGS_MAX: u32 = 21;

/// One step size on a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rung {
    /// Steps between two samples, k.
    pub steps_per_sample: u64,
    /// The step, s: the time between samples over k.
    pub dt: f64,
    /// Whether the run stays within its budget.
    pub affordable: bool,
}

/// Steps k = 1, 2, 4, ... between two samples, from coarse to fine.
///
/// The work of a run is counted as steps x (bodies + pairs), the same for every engine. The
/// first rung beyond the `budget` ends the ladder and is marked.
#[must_use]
pub fn ladder(scene: &Scene, budget: u64) -> Vec<Rung> {
    let mut rungs = Vec::new();
    for power in 0..RUNGS_MAX {
        let steps_per_sample = 1_u64 << power;
        let dt = halved(scene.sample_every, power);
        let affordable = work(scene, steps_per_sample) <= budget;
        rungs.push(Rung {
            steps_per_sample,
            dt,
            affordable,
        });
        if !affordable {
            break;
        }
    }
    rungs
}

/// The work that a step of any engine is counted as: bodies and pairs.
pub(super) fn work_a_step(scene: &Scene) -> u64 {
    let bodies = scene.bodies.len() as u64;
    bodies + bodies * bodies.saturating_sub(1) / 2
}

/// The steps that all of these scenes can take, s, from coarse to fine: halves of the longest
/// spacing of samples, as long as every run stays within its budget.
///
/// # Errors
/// [`Error::Argument`] if not even the coarsest does.
pub fn common_steps(scenes: &[Scene], budget: u64) -> Result<Vec<f64>> {
    let spacings = scenes.iter().map(|scene| scene.sample_every);
    let longest = spacings.fold(0.0, f64::max);
    let is_affordable = |dt: &f64| {
        scenes.iter().all(|scene| {
            StepGrid::new(scene, *dt).is_ok_and(|grid| work(scene, grid.steps_per_sample) <= budget)
        })
    };
    let steps = (0..RUNGS_MAX).map(|power| halved(longest, power));
    let steps: Vec<f64> = steps.take_while(is_affordable).collect();
    if steps.is_empty() {
        return Err(Error::Argument {
            argument: "budget",
            found: budget.to_string(),
            remedy: "not enough for a step between two samples; give more".into(),
        });
    }
    Ok(steps)
}

fn halved(length: f64, power: u32) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "a power of two")]
    let parts = (1_u64 << power) as f64;
    length / parts
}

/// Counted work of a run: steps x (bodies + pairs).
fn work(scene: &Scene, steps_per_sample: u64) -> u64 {
    let steps = steps_per_sample.saturating_mul(scene.sample_count() as u64);
    steps.saturating_mul(work_a_step(scene))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two bodies make three units of work a step; four samples make k = 1 cost 12.
    #[test]
    fn the_ladder_halves_the_step_until_the_budget_is_spent() {
        let text = "name='x'\nduration=4\nsample_every=1\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
            [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[9,0,0]\nvelocity=[0,0,0]\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let steps = |budget| -> Vec<(f64, bool)> {
            let rungs = ladder(&scene, budget);
            rungs
                .iter()
                .map(|rung| (rung.dt, rung.affordable))
                .collect()
        };
        assert_eq!(
            steps(48),
            [(1.0, true), (0.5, true), (0.25, true), (0.125, false)]
        );
        assert_eq!(steps(47), [(1.0, true), (0.5, true), (0.25, false)]);
        assert_eq!(steps(1), [(1.0, false)]);
        // The other scene is sampled twice as often, for half as long: the same work.
        let mut other = scene.clone();
        (other.duration, other.sample_every) = (2.0, 0.5);
        let both = [scene, other];
        assert_eq!(common_steps(&both, 48).unwrap(), [1.0, 0.5, 0.25]);
        assert!(common_steps(&both, 11).is_err());
    }
}
