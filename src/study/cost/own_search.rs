//! The search of an engine's settings on the very scene that is priced.

use super::contender::{Contender, is_searched};
use super::survey::{Measured, errors, runs, runs_of};
use super::tune::{coordinates, effective, search, typical};
use super::{CostOptions, CostPoint, EngineCost, Reference, Watcher};
use crate::engine::EngineKind;
use crate::error::Result;

/// Searches the settings of every engine that has some to search, from the preset on: coordinate
/// search for the smallest geometric mean of the errors over its ladder of steps. Each setting
/// tried is a whole ladder, for the cheapest way to an accuracy is another at each.
///
/// `presets` have been measured already: `points` are theirs, in the same order.
pub(super) fn search_settings(
    presets: &[Contender],
    points: &[CostPoint],
    reference: &Reference,
    options: &CostOptions,
    watch: Watcher,
) -> Result<Measured> {
    let mut all = Measured {
        contenders: Vec::new(),
        points: Vec::new(),
        engines: Vec::new(),
    };
    let ladders = points.chunk_by(|a, b| a.engine == b.engine);
    for (preset, ladder) in presets.iter().zip(ladders) {
        let (tried, found) = if is_searched(&preset.spec) {
            search_own(preset, ladder, reference, options, watch)?
        } else {
            (vec![(preset.clone(), ladder.to_vec())], None)
        };
        all.engines.push(EngineCost {
            spec: preset.spec.clone(),
            settings: tried.len(),
            runs: tried.iter().map(|(_, ladder)| runs_of(ladder)).sum(),
            found,
        });
        for (contender, ladder) in tried {
            all.contenders.push(contender);
            all.points.extend(ladder);
        }
    }
    Ok(all)
}

type Tried = Vec<(Contender, Vec<CostPoint>)>;

/// Every setting tried with its ladder, the preset first, and the best of them in a word.
fn search_own(
    preset: &Contender,
    own: &[CostPoint],
    reference: &Reference,
    options: &CostOptions,
    watch: Watcher,
) -> Result<(Tried, Option<String>)> {
    let scene = &preset.scene;
    let ladders_max = options.runs / runs_of(own).max(1);
    let coordinates = coordinates(&preset.spec.kind, std::slice::from_ref(scene));
    let start = preset.spec.kind.clone();
    let mut measured = Some((preset.clone(), own.to_vec()));
    let found = search(
        start,
        ladders_max,
        &coordinates,
        |batch: &[EngineKind]| {
            // The start is the preset, whose ladder is known.
            if let Some((preset, ladder)) = measured.take() {
                let objective = over_ladder(&ladder, reference);
                return Ok(vec![((preset, ladder), objective)]);
            }
            let with = |kind| Contender::with(scene, &preset.spec, kind);
            let contenders: Vec<_> = batch.iter().map(with).collect();
            let (points, _) = errors(scene, &runs(&contenders, options), Some(reference), watch)?;
            let ladders = points.chunk_by(|a, b| a.setting == b.setting);
            let pairs = contenders.iter().zip(ladders).map(|(contender, ladder)| {
                let objective = over_ladder(ladder, reference);
                ((contender.clone(), ladder.to_vec()), objective)
            });
            Ok(pairs.collect())
        },
    )?;
    let name = found.found().measured.0.setting.clone();
    let tried = found.trials.into_iter().map(|trial| trial.measured);
    Ok((tried.collect(), Some(name)))
}

/// The geometric mean of the errors over the steps that were run.
fn over_ladder(ladder: &[CostPoint], reference: &Reference) -> f64 {
    let run = ladder.iter().filter(|point| !point.is_over_budget());
    let errors = run.map(|point| effective(point.error(), reference.sizes.length));
    typical(errors).unwrap_or(reference.sizes.length)
}

#[cfg(all(test, feature = "rapier"))]
mod tests {
    use super::super::contender::STOCK;
    use super::super::scene_cost;
    use super::*;
    use crate::engine::engine;
    use crate::study::Timing;

    const HIT: &str = "name='hit'\nduration=1\nsample_every=0.25\n[units]\nlength='mm'\n\
        [[bodies]]\nname='a'\nmass=1\nradius=40\nposition=[0,0,0]\nvelocity=[1000,0,0]\n\
        [[bodies]]\nname='b'\nmass=1\nradius=40\nposition=[300,0,30]\nvelocity=[0,0,0]\n\
        [effects.contact]\nrestitution=0.9\n";

    /// Every engine has the same runs to spend; what a search finds errs no more than the preset,
    /// by the measure that it searches with, and less than every other setting tried.
    #[test]
    fn a_world_is_searched_within_its_runs_and_others_run_as_they_come() {
        let scene = crate::scene::parse(HIT, "x").unwrap();
        let names = ["lecture", "rapier", "rapier-f64", "rapier-matched"];
        let specs: Vec<_> = names.map(|name| engine(name).unwrap()).to_vec();
        let options = CostOptions {
            timing: Timing {
                seed: 1,
                repetitions: 1,
            },
            phases: 3,
            // Three units of work a step, four samples: steps k = 1 ... 32.
            budget: 400,
            runs: 70,
        };
        let cost = scene_cost(&scene, &specs, &options, &|_, _, _| {}).unwrap();
        let reference = Reference::exact(&scene).unwrap().unwrap();
        for engine in &cost.engines {
            let name = &engine.spec.name;
            let of_engine = |point: &&CostPoint| point.engine == *name;
            let points: Vec<_> = cost.points.iter().filter(of_engine).cloned().collect();
            assert_eq!(runs_of(&points), engine.runs, "{name}");
            assert!(engine.runs <= options.runs, "{name}");
            let ladders = points.chunk_by(|a, b| a.setting == b.setting);
            let objective = |ladder: &[CostPoint]| over_ladder(ladder, &reference);
            let judged = ladders.map(|ladder| (ladder[0].setting.clone(), objective(ladder)));
            let judged: Vec<_> = judged.collect();
            assert_eq!(judged.len(), engine.settings, "{name}");
            assert_eq!(judged[0].0, STOCK, "{name}");
            let Some(found) = &engine.found else {
                assert_eq!(engine.settings, 1, "{name}");
                continue;
            };
            assert_eq!((engine.settings, engine.runs), (11, 66), "{name}");
            let least = judged.iter().map(|(_, error)| *error);
            let least = least.fold(f64::INFINITY, f64::min);
            let best = judged.iter().find(|(setting, _)| setting == found).unwrap();
            assert_eq!(best.1, least, "{name}: {judged:?}");
        }
        let searched = cost.engines.iter().filter(|engine| engine.found.is_some());
        assert_eq!(searched.count(), 2);
    }
}
