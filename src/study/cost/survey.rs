//! The study of one scene: who takes part, every run compared, every run priced.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::contender::Contender;
use super::cuts::step_costs;
use super::ladder::{Rung, ladder};
use super::own_search::search_settings;
use super::phases::phases;
use super::push_out::push_out;
use super::{
    CostOptions, CostPoint, Ending, EngineCost, Errors, Reference, SceneCost, Stage, Watcher,
    sensitivity,
};
use crate::engine::{EngineSpec, StepGrid, prepare, record};
use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::scene::Scene;
use crate::study::Refusal;
use crate::study::stopwatch::{Job, prices};

/// A contender on one rung of its ladder.
pub(super) struct Run<'a> {
    contender: &'a Contender,
    rung: Rung,
}

/// A run that was recorded, or why there is no recording.
struct Ran {
    ending: Ending,
    recording: Option<Recording>,
}

/// Measures errors and prices of the engines on a scene.
///
/// # Errors
/// A scene that is not one, an engine that this build leaves out. An engine that refuses the
/// scene or blows up is a result.
pub fn scene_cost(
    scene: &Scene,
    specs: &[EngineSpec],
    options: &CostOptions,
    watch: Watcher,
) -> Result<SceneCost> {
    watch(Stage::Reference, 0, 1);
    let exact = Reference::exact(scene)?;
    let (presets, refusals) = taking_part(scene, specs)?;
    let (mut notes, mut reference) = match exact {
        Ok(reference) => (Vec::new(), Some(reference)),
        Err(why) => (
            vec![format!(
                "No common reference ({why}): errors are against each setting's own finest \
                 step, which therefore has none, and say nothing about the model."
            )],
            None,
        ),
    };
    let off = reference
        .as_mut()
        .and_then(|known| sensitivity(scene, known));
    if let Some(known) = &reference {
        notes.extend(cut(scene, known));
        if off.is_none() {
            notes.push("What a misplaced ball does could not be computed.".to_owned());
        }
    }
    let errors = errors(scene, &runs(&presets, options), reference.as_ref(), watch)?;
    let sample = reference
        .as_ref()
        .map_or(scene.sample_count(), |known| known.rest_sample(scene));
    let (points, size) = errors;
    let Measured {
        contenders,
        mut points,
        engines,
    } = match &reference {
        Some(known) => search_settings(&presets, &points, known, options, watch)?,
        None => Measured::only(presets, points),
    };
    let stepping: Vec<&EngineSpec> = engines
        .iter()
        .map(|engine| &engine.spec)
        .filter(|spec| spec.takes_steps())
        .collect();
    let phases = match &reference {
        Some(known) => phases(scene, &stepping, known, options, watch)?,
        None => Vec::new(),
    };
    if reference.is_some() {
        notes.extend(left_out(phases.len(), options.phases));
    }
    let runs = runs(&contenders, options);
    price(&mut points, &runs, sample, options, watch)?;
    let step_costs = step_costs(scene, specs, sample, options)?;
    let push_out = match &reference {
        Some(known) => push_out(scene, &stepping, known, sample, options, watch)?,
        None => Vec::new(),
    };
    Ok(SceneCost {
        scene: scene.clone(),
        size,
        compared_until: reference.as_ref().map(|known| known.until(scene)),
        priced_until: scene.sample_time(sample),
        sensitivity: off,
        engines,
        points,
        step_costs,
        phases,
        push_out,
        refusals,
        notes,
    })
}

/// Says so where the scene is compared only in part.
fn cut(scene: &Scene, reference: &Reference) -> Option<String> {
    let all = reference.comparable > scene.sample_count();
    let until = reference.until(scene);
    let note = format!(
        "Positions are compared until {until} s of {} s: up to the horizon, past which exact \
         vouches for nothing or a ball placed a hair off changes everything.",
        scene.duration
    );
    (!all).then_some(note)
}

/// Who took part and what came of it, by engine, setting and step.
pub(super) struct Measured {
    pub(super) contenders: Vec<Contender>,
    pub(super) points: Vec<CostPoint>,
    pub(super) engines: Vec<EngineCost>,
}

/// Says so where the exact engine refuses some of the later starts.
fn left_out(taken: usize, all: usize) -> Option<String> {
    (taken < all).then(|| format!("Of {all} later starts exact could take {taken}."))
}

impl Measured {
    /// Engines as they come, without a search: one ladder each.
    fn only(presets: Vec<Contender>, points: Vec<CostPoint>) -> Self {
        let ladders = points.chunk_by(|a, b| a.engine == b.engine);
        let pairs = presets.iter().zip(ladders);
        let engines = pairs.map(|(preset, ladder)| EngineCost {
            spec: preset.spec.clone(),
            settings: 1,
            runs: runs_of(ladder),
            found: None,
        });
        Self {
            engines: engines.collect(),
            contenders: presets,
            points,
        }
    }
}

/// How many of the points were run.
pub(super) fn runs_of(ladder: &[CostPoint]) -> usize {
    let run = ladder.iter().filter(|point| !point.is_over_budget());
    run.count()
}

/// The engines as they come that can do the scene, and those that cannot.
fn taking_part(scene: &Scene, specs: &[EngineSpec]) -> Result<(Vec<Contender>, Vec<Refusal>)> {
    let (mut presets, mut refusals) = (Vec::new(), Vec::new());
    for spec in specs {
        match prepare(scene, spec, scene.sample_every) {
            Err(refusal @ Error::EngineCannot { .. }) => {
                refusals.push(Refusal {
                    engine: spec.name.clone(),
                    reason: refusal.to_string(),
                });
                continue;
            }
            started => drop(started?),
        }
        presets.push(Contender::stock(scene, spec));
    }
    Ok((presets, refusals))
}

/// Every contender on its ladder; engines without steps run once.
pub(super) fn runs<'a>(contenders: &'a [Contender], options: &CostOptions) -> Vec<Run<'a>> {
    let of = |contender: &'a Contender| {
        let rungs = if contender.spec.takes_steps() {
            ladder(&contender.scene, options.budget)
        } else {
            vec![Rung {
                steps_per_sample: 1,
                dt: contender.scene.sample_every,
                affordable: true,
            }]
        };
        rungs.into_iter().map(move |rung| Run { contender, rung })
    };
    contenders.iter().flat_map(of).collect()
}

/// Records every run and compares it; also gives the size of the scene.
pub(super) fn errors(
    scene: &Scene,
    runs: &[Run],
    reference: Option<&Reference>,
    watch: Watcher,
) -> Result<(Vec<CostPoint>, f64)> {
    let done = AtomicUsize::new(0);
    let ladders: Vec<&[Run]> = runs
        .chunk_by(|a, b| std::ptr::eq(a.contender, b.contender))
        .collect();
    let measured = ladders.par_iter().map(|ladder| {
        let ran = ladder.iter().map(|run| {
            let ran = attempt(run);
            let count = done.fetch_add(1, Ordering::Relaxed) + 1;
            watch(Stage::Errors, count, runs.len());
            ran
        });
        let ran: Vec<Ran> = ran.collect::<Result<_>>()?;
        let own;
        let (known, last) = if let Some(reference) = reference {
            (Some(reference), ladder.len())
        } else {
            let finest = ran.iter().rposition(is_finished);
            own = finest
                .and_then(|place| ran[place].recording.clone())
                .map(|finest| Reference::new(scene, finest));
            (own.as_ref(), finest.unwrap_or(0))
        };
        let size = known.map(|known| known.sizes.length);
        let compared = ladder.iter().zip(ran).enumerate();
        let points = compared.map(|(place, (run, ran))| {
            let known = known.filter(|_| place < last);
            let errors = match (known, &ran.recording) {
                (Some(known), Some(recording)) => compare(scene, run, recording, known)?,
                _ => Errors::default(),
            };
            Ok(point(run, ran.ending, errors))
        });
        Ok((points.collect::<Result<Vec<_>>>()?, size))
    });
    let measured: Vec<(Vec<CostPoint>, Option<f64>)> = measured.collect::<Result<_>>()?;
    let sizes = measured.iter().filter_map(|(_, size)| *size);
    let size = sizes.reduce(f64::min).unwrap_or(0.0);
    Ok((
        measured
            .into_iter()
            .flat_map(|(points, _)| points)
            .collect(),
        size,
    ))
}

fn is_finished(ran: &Ran) -> bool {
    matches!(&ran.ending, Ending::Ran(outcome) if outcome.is_finished())
}

fn attempt(run: &Run) -> Result<Ran> {
    if !run.rung.affordable {
        return Ok(Ran {
            ending: Ending::OverBudget,
            recording: None,
        });
    }
    let contender = run.contender;
    match record(&contender.scene, &contender.spec, run.rung.dt) {
        Ok(recording) => Ok(Ran {
            ending: Ending::Ran(recording.outcome),
            recording: Some(recording),
        }),
        Err(refusal @ Error::EngineCannot { .. }) => Ok(Ran {
            ending: Ending::Refused(refusal.to_string()),
            recording: None,
        }),
        Err(error) => Err(error),
    }
}

fn compare(scene: &Scene, run: &Run, recording: &Recording, known: &Reference) -> Result<Errors> {
    let contender = run.contender;
    let local = known.local_error(&contender.scene, &contender.spec, run.rung.dt)?;
    Ok(Errors {
        local,
        ..known.errors(scene, recording)
    })
}

fn point(run: &Run, ending: Ending, errors: Errors) -> CostPoint {
    let spec = &run.contender.spec;
    let grid = StepGrid::new(&run.contender.scene, run.rung.dt);
    let step = grid.map_or(run.rung.dt, |grid| grid.step);
    CostPoint {
        engine: spec.name.clone(),
        setting: run.contender.setting.clone(),
        dt: spec.takes_steps().then_some(step),
        errors,
        price: None,
        ending,
    }
}

/// Prices the runs that finished, up to a sample.
fn price(
    points: &mut [CostPoint],
    runs: &[Run],
    sample: usize,
    options: &CostOptions,
    watch: Watcher,
) -> Result<()> {
    let finished = |point: &&mut CostPoint| matches!(&point.ending, Ending::Ran(outcome) if outcome.is_finished());
    let pairs = points.iter_mut().zip(runs);
    let (priced, jobs): (Vec<&mut CostPoint>, Vec<Job>) = pairs
        .filter(|(point, _)| finished(point))
        .map(|(point, run)| {
            let job = Job {
                scene: &run.contender.scene,
                spec: &run.contender.spec,
                dt: run.rung.dt,
                from: 0,
                to: sample,
            };
            (point, job)
        })
        .unzip();
    let found = prices(&jobs, options.timing, &|done, all| {
        watch(Stage::Pricing, done, all);
    })?;
    for (point, price) in priced.into_iter().zip(found) {
        point.price = Some(price);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::engine;
    use crate::study::Timing;

    const OPTIONS: CostOptions = CostOptions {
        timing: Timing {
            seed: 1,
            repetitions: 1,
        },
        budget: 100,
        phases: 3,
        runs: 30,
    };

    fn study(text: &str, names: &[&str]) -> SceneCost {
        let scene = crate::scene::parse(text, "x").unwrap();
        let specs: Vec<_> = names.iter().map(|name| engine(name).unwrap()).collect();
        scene_cost(&scene, &specs, &OPTIONS, &|_, _, _| {}).unwrap()
    }

    const FALL: &str = "name='fall'\nduration=2\nsample_every=1\n\
        [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
        [effects.gravity]\nacceleration=[0,-8,0]\n";

    /// Symplectic Euler's error of a fall is g h t / 2: first order, exactly.
    #[test]
    fn the_lecture_is_of_first_order_on_a_fall() {
        let cost = study(FALL, &["lecture", "exact-fast"]);
        let errors: Vec<_> = cost.stock("lecture").map(CostPoint::error).collect();
        assert_eq!(errors.len(), 7, "k = 1 ... 32 and one over the budget");
        for (k, error) in errors[..6].iter().enumerate() {
            let wanted = 8.0 * 0.5_f64.powi(i32::try_from(k).unwrap());
            assert!((error.unwrap() - wanted).abs() < 1e-9, "{error:?} {wanted}");
        }
        let last = cost.stock("lecture").last().unwrap();
        assert!(last.is_over_budget() && last.price.is_none() && last.error().is_none());
        assert!(
            cost.stock("lecture")
                .take(6)
                .all(|point| point.cost() > Some(0.0))
        );
        let exact = cost.stock("exact-fast").next().unwrap();
        assert!(exact.dt.is_none() && exact.error().unwrap() < 1e-12);
        assert_eq!(cost.limits(1).len(), 1);
    }

    /// Rest together with gravity is undefined for `exact`: the finest step stands in.
    #[test]
    fn without_truth_the_finest_step_is_the_reference_and_a_note_says_so() {
        let cost = study(
            &format!("{FALL}[effects.rest]\nspeed=0.1\n"),
            &["lecture", "exact-fast"],
        );
        assert_eq!(cost.refusals.len(), 1);
        assert!(
            cost.notes[0].contains("own finest step"),
            "{:?}",
            cost.notes
        );
        let points: Vec<_> = cost.stock("lecture").collect();
        assert_eq!(points[5].error(), None);
        let error = points[0].error().unwrap();
        assert!((error - (8.0 - 0.25)).abs() < 1e-9, "{error}");
    }
}
