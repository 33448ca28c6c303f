//! What a step of a scene costs before the first body and for each body: the scene cut to its
//! first few bodies, more of them at a time.

use super::CostOptions;
use crate::engine::{DEFAULT_DT, EngineSpec, StepGrid, record};
use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::study::Overhead;
use crate::study::stopwatch::{Job, prices};

/// What a step of an engine costs on a scene cut to its first bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct StepCost {
    /// The engine.
    pub engine: String,
    /// Numbers of bodies, ascending, and a step, the median over the rounds, µs.
    pub steps_us: Vec<(usize, f64)>,
    /// What of it is fixed, and what there is for each body and pair; none with too few bodies.
    pub overhead: Option<Overhead>,
}

/// The numbers of bodies that a scene is cut to: each up to four, then half as many again.
fn sizes(bodies: usize) -> Vec<usize> {
    let next = |size: &usize| Some((size + 1).max(size * 3 / 2));
    let fewer = std::iter::successors(Some(1), next).take_while(|size| *size < bodies);
    fewer.chain([bodies]).collect()
}

/// The scene with its first bodies alone; springs between those stay.
fn cut(scene: &Scene, bodies: usize) -> Scene {
    let mut few = scene.clone();
    few.bodies.truncate(bodies);
    let stays = |name: &String| few.bodies.iter().any(|body| body.name == *name);
    few.effects
        .springs
        .retain(|spring| spring.between.iter().all(stays));
    few
}

/// The last sample to be timed: as far as the scene is priced, or as far as the budget reaches;
/// none where it does not reach two samples.
fn last(scene: &Scene, grid: StepGrid, sample: usize, budget: u64) -> Option<usize> {
    let work = super::ladder::work_a_step(scene).saturating_mul(grid.steps_per_sample);
    let affordable = usize::try_from(budget / work.max(1)).unwrap_or(usize::MAX);
    let last = sample.min(affordable);
    (last >= 2).then_some(last)
}

/// Times a step of the default size of each engine that takes steps, with more and more of the
/// scene's bodies, up to the sample up to which the scene is priced.
///
/// # Errors
/// As [`record`]; an engine that refuses a cut scene or blows up on it has no cost there.
pub(super) fn step_costs(
    scene: &Scene,
    specs: &[EngineSpec],
    sample: usize,
    options: &CostOptions,
) -> Result<Vec<StepCost>> {
    let cuts: Vec<Scene> = sizes(scene.bodies.len())
        .into_iter()
        .map(|bodies| cut(scene, bodies))
        .collect();
    let stepping = specs.iter().filter(|spec| spec.takes_steps());
    let mut jobs = Vec::new();
    for (spec, few) in stepping.flat_map(|spec| cuts.iter().map(move |few| (spec, few))) {
        let grid = StepGrid::new(few, DEFAULT_DT)?;
        let Some(to) = last(few, grid, sample, options.budget) else {
            continue;
        };
        match record(few, spec, DEFAULT_DT) {
            Ok(run) if run.outcome.is_finished() => jobs.push(Job {
                scene: few,
                spec,
                dt: DEFAULT_DT,
                from: 1,
                to,
            }),
            Ok(_) | Err(Error::EngineCannot { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    let found = prices(&jobs, options.timing, &|_, _| {})?;
    let mut costs: Vec<StepCost> = Vec::new();
    for (job, price) in jobs.iter().zip(found) {
        let step_us = 1e3 * StepGrid::new(job.scene, job.dt)?.step * price.median;
        let point = (job.scene.bodies.len(), step_us);
        match costs.last_mut() {
            Some(last) if last.engine == job.spec.name => last.steps_us.push(point),
            Some(_) | None => costs.push(StepCost {
                engine: job.spec.name.clone(),
                steps_us: vec![point],
                overhead: None,
            }),
        }
    }
    for cost in &mut costs {
        cost.overhead = Overhead::of(&cost.steps_us);
    }
    Ok(costs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::engine;
    use crate::study::Timing;

    const CHAIN: &str = "name='x'\nduration=4\nsample_every=1\n\
        [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
        [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[9,0,0]\nvelocity=[0,0,0]\n\
        [[bodies]]\nname='c'\nmass=1\nradius=1\nposition=[18,0,0]\nvelocity=[0,0,0]\n\
        [[effects.springs]]\nbetween=['a','b']\nstiffness=1\nrest_length=9\ndamping=0\n\
        [[effects.springs]]\nbetween=['b','c']\nstiffness=1\nrest_length=9\ndamping=0\n";

    #[test]
    fn a_cut_scene_keeps_the_springs_between_its_bodies() {
        let scene = crate::scene::parse(CHAIN, "x").unwrap();
        let springs = [1, 2, 3].map(|bodies| {
            let few = cut(&scene, bodies);
            few.checked().unwrap();
            few.effects.springs.len()
        });
        assert_eq!(springs, [0, 1, 2]);
    }

    #[test]
    fn sizes_end_with_the_whole_scene() {
        assert_eq!(sizes(1), [1]);
        assert_eq!(sizes(4), [1, 2, 3, 4]);
        assert_eq!(sizes(16), [1, 2, 3, 4, 6, 9, 13, 16]);
    }

    #[test]
    fn every_engine_that_takes_steps_has_its_costs() {
        let scene = crate::scene::parse(CHAIN, "x").unwrap();
        let specs = ["lecture", "exact-fast", "verlet"].map(|name| engine(name).unwrap());
        let options = CostOptions {
            timing: Timing {
                seed: 1,
                repetitions: 1,
            },
            budget: 100_000,
            phases: 3,
            runs: 30,
        };
        let costs = step_costs(&scene, &specs, 4, &options).unwrap();
        let names: Vec<_> = costs.iter().map(|cost| cost.engine.as_str()).collect();
        assert_eq!(names, ["lecture", "verlet"]);
        for cost in &costs {
            let sizes: Vec<_> = cost.steps_us.iter().map(|(bodies, _)| *bodies).collect();
            assert_eq!(sizes, [1, 2, 3]);
            assert!(cost.steps_us.iter().all(|(_, step_us)| *step_us > 0.0));
            assert!(cost.overhead.is_some());
        }
        // 600 units a sample of three bodies: 100 steps, three bodies and three pairs.
        let poor = CostOptions {
            budget: 1199,
            ..options
        };
        let costs = step_costs(&scene, &specs, 4, &poor).unwrap();
        assert_eq!(costs[0].steps_us.len(), 2);
    }
}
