//! The measurement: a gas of each size, every engine on it.

use super::stretch::{LEAD, STEPS_MIN, expected, steps};
use super::{BASE, BodiesOptions, BodiesPoint, BodiesStudy, Walls};
use crate::engine::{EngineSpec, build, engine, prepare};
use crate::error::{Error, Result};
use crate::recording::{Outcome, Work, initial_states};
use crate::scene::Scene;
use crate::scene::generate::Gas;
use crate::study::Machine;
use crate::study::stopwatch::{Job, Price, paired, prices};
use crate::study::{Refusal, median, paired_ratio};

/// Simulated time in which the lattice melts, s: two impacts a sphere, about, at a filling of 0.1.
const MELTING: f64 = 2.0;

/// An engine of the study, with the work a step that it has been seen to take.
struct Taking<'a> {
    spec: &'a EngineSpec,
    /// Numbers of bodies, ascending, and the work a step.
    seen: Vec<(usize, f64)>,
}

/// An engine at a size: the scene as long as it is to run, and how that ended.
struct Run<'a> {
    spec: &'a EngineSpec,
    scene: Scene,
    outcome: Outcome,
}

/// Measures what a step of each engine costs at each number of bodies.
///
/// `watch` is told the number of bodies, how many runs are done, and of how many; `keep` is given
/// the study after each number of bodies.
///
/// # Errors
/// A gas that cannot be made, an engine that this build leaves out, what `keep` complains of. An
/// engine that refuses the scene or blows up is a result.
pub fn bodies_cost(
    specs: &[EngineSpec],
    options: &BodiesOptions,
    watch: &dyn Fn(usize, usize, usize),
    keep: &dyn Fn(&BodiesStudy) -> Result<()>,
) -> Result<BodiesStudy> {
    let mut study = BodiesStudy {
        options: options.clone(),
        machine: Machine::this(),
        build: build(),
        points: Vec::new(),
        refusals: Vec::new(),
    };
    let mut all: Vec<Taking> = specs
        .iter()
        .map(|spec| Taking {
            spec,
            seen: Vec::new(),
        })
        .collect();
    for bodies in &options.sizes {
        watch(*bodies, 0, 1);
        measure(&mut study, &mut all, *bodies, watch)?;
        keep(&study)?;
    }
    Ok(study)
}

impl<'a> Taking<'a> {
    /// Runs the engine once, to see how it ends and what work it takes: as many steps as the
    /// budget pays, first by the work expected, then by the work counted.
    fn run(&mut self, gas: &Scene, options: &BodiesOptions) -> Result<Run<'a>> {
        let bodies = gas.bodies.len();
        let ended = |scene: Scene, outcome: Outcome| Run {
            spec: self.spec,
            scene,
            outcome,
        };
        let work = if self.spec.takes_steps() {
            expected(&self.seen, bodies)
        } else {
            0.0
        };
        let Some(wanted) = steps(bodies, work, options.budget) else {
            return Ok(ended(gas.clone(), Outcome::BudgetSpent { time: 0.0 }));
        };
        let scene = cut(gas, wanted, options.dt);
        let mut simulation = prepare(&scene, self.spec, options.dt)?;
        let mut states = initial_states(&scene);
        let mut taken = 0;
        while taken < scene.sample_count() {
            taken += 1;
            let halt = simulation.advance_to(taken, None);
            simulation.state_into(&mut states);
            let time = scene.sample_time(taken);
            if let Some(outcome) = halt.or(Outcome::blown_up(&states, time)) {
                return Ok(ended(scene, outcome));
            }
            let spent = units(simulation.work(), bodies);
            if self.spec.takes_steps() && spent > options.budget {
                break;
            }
        }
        let spent = units(simulation.work(), bodies);
        #[allow(clippy::cast_precision_loss, reason = "counts of some billions")]
        self.seen.push((bodies, spent as f64 / taken as f64));
        Ok(match taken.checked_sub(LEAD) {
            Some(timed) if timed >= STEPS_MIN => {
                ended(cut(gas, timed, options.dt), Outcome::Finished)
            }
            Some(_) | None => ended(scene, Outcome::BudgetSpent { time: 0.0 }),
        })
    }
}

/// Work in the units of the budget.
fn units(work: Work, bodies: usize) -> u64 {
    work.steps * bodies as u64 + work.pair_tests + work.force_evaluations + work.solving
}

/// Every engine with one number of bodies.
fn measure(
    study: &mut BodiesStudy,
    all: &mut [Taking],
    bodies: usize,
    watch: &dyn Fn(usize, usize, usize),
) -> Result<()> {
    let options = study.options.clone();
    let gas = molten(bodies, &options)?;
    let mut runs = Vec::new();
    for taking in all {
        match taking.run(&gas, &options) {
            Ok(run) => runs.push(run),
            Err(refusal @ Error::EngineCannot { .. }) => study.refusals.push(Refusal {
                engine: taking.spec.name.clone(),
                reason: format!("{bodies} bodies: {refusal}"),
            }),
            Err(error) => return Err(error),
        }
    }
    let finished = runs.iter().filter(|run| run.outcome.is_finished());
    let jobs = finished.map(|run| Job {
        scene: &run.scene,
        spec: run.spec,
        dt: options.dt,
        from: LEAD,
        to: run.scene.sample_count(),
    });
    let jobs: Vec<Job> = jobs.collect();
    let told = |done, total| watch(bodies, done, total);
    let mut found = prices(&jobs, options.timing, &told)?.into_iter();
    let priced = runs.iter().map(|run| {
        let price = run.outcome.is_finished().then(|| found.next()).flatten();
        (run, price)
    });
    let priced: Vec<(&Run, Option<Price>)> = priced.collect();
    let base = priced.iter().find(|(run, _)| run.spec.name == BASE);
    let base = base.and_then(|(_, price)| price.as_ref());
    for (run, price) in &priced {
        let point = point(study, run, bodies, price.as_ref(), base);
        study.points.push(point);
    }
    Ok(())
}

fn point(
    study: &BodiesStudy,
    run: &Run,
    bodies: usize,
    price: Option<&Price>,
    base: Option<&Price>,
) -> BodiesPoint {
    let options = &study.options;
    let step = run.spec.takes_steps().then_some(options.dt);
    let step_us = |cost: f64| Some(1e3 * step? * cost);
    let rounds = price
        .zip(base)
        .map(|(own, base)| [&own.rounds, &base.rounds]);
    let ratio = rounds.and_then(|[own, base]| paired_ratio(own, base, options.timing.seed));
    BodiesPoint {
        build: study.build.clone(),
        engine: run.spec.name.clone(),
        bodies,
        dt: step,
        filling: options.filling,
        walls: options.walls,
        seed: options.timing.seed,
        step_us: price.and_then(|price| step_us(price.median)),
        step_min_us: price.and_then(|price| step_us(price.min)),
        cost_ms_per_sim_s: price.map(|price| price.median),
        steps: price.map(|price| price.work.steps),
        force_evaluations: price.map(|price| price.work.force_evaluations),
        pair_tests: price.map(|price| price.work.pair_tests),
        ratio: rounds.map(|[own, base]| median(&paired(own, base))),
        ratio_low: ratio.map(|ratio| ratio.low),
        ratio_high: ratio.map(|ratio| ratio.high),
        outcome: run.outcome.word().to_owned(),
        machine: study.machine.describe(),
    }
}

/// The gas in motion: on its lattice nothing meets for a while, which would flatter whoever looks
/// for what meets.
fn molten(bodies: usize, options: &BodiesOptions) -> Result<Scene> {
    let mut gas = Gas::thinned(bodies, options.filling, options.timing.seed)?;
    gas.duration = MELTING;
    gas.sample_every = MELTING;
    let mut states = initial_states(&gas);
    let mut melting = prepare(&gas, &engine("exact-fast")?, MELTING)?;
    melting.advance_to(1, None);
    melting.state_into(&mut states);
    for (body, state) in gas.bodies.iter_mut().zip(states) {
        body.position = state.position.into();
        body.velocity = state.velocity.into();
    }
    match options.walls {
        Walls::Closed => {}
        Walls::Open => gas.effects.cushions = None,
    }
    Ok(gas)
}

/// The gas for so many steps after the lead, a sample each.
#[allow(clippy::cast_precision_loss, reason = "some hundred steps")]
fn cut(gas: &Scene, steps: usize, dt: f64) -> Scene {
    let mut scene = gas.clone();
    scene.sample_every = dt;
    scene.duration = (LEAD + steps) as f64 * dt;
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Vector3;
    use crate::study::Timing;

    fn options(sizes: &[usize], budget: u64) -> BodiesOptions {
        BodiesOptions {
            sizes: sizes.to_vec(),
            dt: 0.01,
            filling: 0.1,
            walls: Walls::Closed,
            timing: Timing {
                seed: 1,
                repetitions: 1,
            },
            budget,
        }
    }

    fn study(names: &[&str], options: &BodiesOptions) -> BodiesStudy {
        let specs: Vec<_> = names.iter().map(|name| engine(name).unwrap()).collect();
        bodies_cost(&specs, options, &|_, _, _| {}, &|_| Ok(())).unwrap()
    }

    /// 30 bodies are 465 units a step, 435 of them pairs; 10 bodies are 55 and 45.
    #[test]
    fn every_engine_has_a_point_at_every_size_and_counts_its_work() {
        let study = study(&[BASE, "exact-fast"], &options(&[10, 30], 4650));
        assert_eq!(study.points.len(), 4);
        let lecture = study.of(study.own(BASE));
        let counted = lecture.iter().map(|point| (point.steps, point.pair_tests));
        let ten = (Some(82), Some(82 * 45));
        let thirty = (Some(8), Some(8 * 435));
        assert_eq!(counted.collect::<Vec<_>>(), [ten, thirty]);
        assert!(lecture.iter().all(|point| point.step_us > Some(0.0)));
        let exact = study.at(study.series()[1], 30).unwrap();
        assert_eq!((exact.dt, exact.step_us), (None, None));
        assert!(exact.cost_ms_per_sim_s > Some(0.0) && exact.ratio > Some(0.0));
        assert_eq!(lecture[1].ratio, Some(1.0));
        assert_eq!(exact.ratio_low, None, "one round has no interval");
    }

    /// A step of 30 bodies takes 465 units; five steps cannot be paid with 2000.
    #[test]
    fn what_is_over_its_budget_is_marked_and_not_missing() {
        let study = study(&[BASE], &options(&[10, 30], 2000));
        let lecture = study.of(study.own(BASE));
        assert!(!lecture[0].is_over_budget() && lecture[0].step_us.is_some());
        assert!(lecture[1].is_over_budget());
        assert_eq!((lecture[1].step_us, lecture[1].steps), (None, None));
    }

    /// What the first size lets expect is not what the second takes: with 100 bodies hardly a step
    /// is without an impact, and each costs `swept` another look at all pairs.
    #[test]
    fn the_work_counted_ends_a_run_that_was_expected_to_be_cheap() {
        let budget = 32 * 5050;
        let study = study(&["swept"], &options(&[4, 100], budget));
        let point = study.at(study.series()[0], 100).unwrap();
        let steps = point.steps.unwrap();
        assert!((3..30).contains(&steps), "{point:?}");
        assert!(point.pair_tests.unwrap() > 4950 * steps, "{point:?}");
    }

    /// Hard spheres keep their energy, to rounding, and no longer stand on the lattice.
    #[test]
    fn the_gas_is_in_motion_and_has_its_energy() {
        let options = options(&[30], 1);
        let before = Gas::thinned(30, 0.1, 1).unwrap();
        let after = molten(30, &options).unwrap();
        let energy = |scene: &Scene| -> f64 {
            let speeds = scene.bodies.iter().map(|body| Vector3::from(body.velocity));
            speeds.map(|v| v.norm_squared()).sum()
        };
        assert!((energy(&after) / energy(&before) - 1.0).abs() < 1e-12);
        let bent = before.bodies.iter().zip(&after.bodies);
        let bent = bent.filter(|(before, after)| before.velocity != after.velocity);
        assert!(bent.count() > 15);
        assert!(after.warnings().is_empty());
        let open = BodiesOptions {
            walls: Walls::Open,
            ..options
        };
        let open = molten(30, &open).unwrap();
        assert_eq!(open.bodies, after.bodies);
        assert_eq!(open.effects.contact, after.effects.contact);
        assert!(open.effects.cushions.is_none() && after.effects.cushions.is_some());
    }
}
