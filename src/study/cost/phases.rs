//! Every engine again from later starts: where its steps fall against the events is then
//! another, and the physics is the same.

use rayon::prelude::*;

use super::contender::{Contender, STOCK};
use super::survey::{errors, runs};
use super::{CostOptions, CostPoint, Errors, Reference, Stage, Watcher};
use crate::engine::{EngineSpec, engine, record};
use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::study::stopwatch::Dice;

/// Every engine that takes steps over its ladder, all from one later start.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// How much later than the scene it starts, s.
    pub shift: f64,
    /// Its runs, by engine and step from coarse to fine; nothing is priced.
    pub points: Vec<CostPoint>,
}

impl Phase {
    /// (dt, error) of an engine.
    pub(super) fn errors(
        &self,
        engine: &str,
        value: impl Fn(&Errors) -> Option<f64>,
    ) -> Vec<(f64, Option<f64>)> {
        let own = self.points.iter().filter(|point| point.engine == engine);
        own.filter_map(|point| Some((point.dt?, value(&point.errors))))
            .collect()
    }
}

/// The starts of the phases, s after the start of the scene: evenly spaced over one interval
/// between samples, which is the coarsest step, all moved by one random offset.
///
/// They are the points of a lattice of n cells, n odd. Halving the step then only changes their
/// order within it: at every rung of the ladder they are evenly spaced over the step. With n
/// even every other one would fall on its neighbour.
/// Source: randomly shifted lattice rules, Cranley and Patterson 1976.
fn shifts(count: usize, sample_every: f64, seed: u64) -> Vec<f64> {
    const GRAIN: usize = 1 << 20;
    #[allow(clippy::cast_precision_loss, reason = "far below 2^53")]
    let number = |count: usize| count as f64;
    let cells = number(count | 1);
    let offset = (number(Dice::new(seed).below(GRAIN)) + 0.5) / number(GRAIN);
    let place = |cell: usize| sample_every * (number(cell) + offset) / cells;
    (0..count).map(place).collect()
}

/// A scene from a later start, with what its runs are measured against.
struct Later {
    scene: Scene,
    reference: Reference,
}

impl Later {
    /// Lets the exact engine take the scene to its later start, and computes it anew from there;
    /// none where it certifies nothing, as from spheres that rounding has made overlap.
    ///
    /// `known` is the reference of the scene itself: past its horizon nothing is compared.
    fn of(scene: &Scene, shift: f64, known: &Reference) -> Result<Option<Self>> {
        let beginning = Scene {
            duration: shift,
            sample_every: shift,
            ..scene.clone()
        };
        let run = match record(&beginning, &engine("exact")?, shift) {
            Ok(run) => run,
            Err(Error::EngineCannot { .. }) => return Ok(None),
            Err(error) => return Err(error),
        };
        if run.comparable_samples(&beginning) < 2 {
            return Ok(None);
        }
        let mut later = scene.clone();
        for (body, state) in later.bodies.iter_mut().zip(run.sample(1)) {
            body.position = state.position.into();
            body.velocity = state.velocity.into();
        }
        let Ok(mut reference) = Reference::exact(&later)? else {
            return Ok(None);
        };
        if known.comparable <= scene.sample_count() {
            let before_horizon = known.comparable.saturating_sub(1).max(2);
            reference.comparable = reference.comparable.min(before_horizon);
        }
        Ok(Some(Self {
            scene: later,
            reference,
        }))
    }

    /// Every engine over its ladder from this start.
    fn points(
        &self,
        specs: &[&EngineSpec],
        options: &CostOptions,
        watch: Watcher,
    ) -> Result<Vec<CostPoint>> {
        let contender = |spec: &&EngineSpec| Contender {
            setting: STOCK.to_owned(),
            spec: (*spec).clone(),
            scene: self.scene.clone(),
        };
        let contenders: Vec<Contender> = specs.iter().map(contender).collect();
        let runs = runs(&contenders, options);
        Ok(errors(&self.scene, &runs, Some(&self.reference), watch)?.0)
    }
}

/// Runs every engine over its ladder from every start that the exact engine can take.
///
/// # Errors
/// As [`record`]; what an engine cannot do is a result.
pub(super) fn phases(
    scene: &Scene,
    specs: &[&EngineSpec],
    known: &Reference,
    options: &CostOptions,
    watch: Watcher,
) -> Result<Vec<Phase>> {
    let all = shifts(options.phases, scene.sample_every, options.timing.seed);
    let mut found = Vec::new();
    // As many references at once as can be made at once.
    for shifts in all.chunks(rayon::current_num_threads()) {
        let starts = shifts
            .par_iter()
            .map(|shift| Ok(Later::of(scene, *shift, known)?.map(|later| (*shift, later))));
        let starts: Vec<_> = starts.collect::<Result<_>>()?;
        for (shift, later) in starts.into_iter().flatten() {
            let place = found.len();
            let watch =
                |_, done, all| watch(Stage::Phases, place * all + done, options.phases * all);
            let points = later.points(specs, options, &watch)?;
            found.push(Phase { shift, points });
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The places within the step, in cells, modulo the whole.
    #[test]
    fn phases_are_evenly_spaced_at_every_rung() {
        let found = shifts(7, 1.0, 3);
        assert!(found.iter().all(|shift| (0.0..1.0).contains(shift)));
        assert_ne!(found, shifts(7, 1.0, 4), "the seed moves them");
        for rung in 0..12 {
            let step = 0.5_f64.powi(rung);
            let mut within: Vec<f64> = found.iter().map(|shift| shift % step / step).collect();
            within.sort_by(f64::total_cmp);
            for pair in within.windows(2) {
                // Each of the seven quotients keeps 2^-53 times 2^rung.
                assert!((pair[1] - pair[0] - 1.0 / 7.0).abs() < 1e-11, "{within:?}");
            }
        }
        assert_eq!(shifts(6, 1.0, 3), found[..6]);
    }

    /// A fall that starts later has its start: x = x0 - g t²/2, v = -g t; and the same errors,
    /// since symplectic Euler errs by g h t/2 wherever it starts.
    #[test]
    fn a_later_start_is_on_the_exact_path() {
        let text = "name='fall'\nduration=2\nsample_every=1\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
            [effects.gravity]\nacceleration=[0,-8,0]\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let known = Reference::exact(&scene).unwrap().unwrap();
        let later = Later::of(&scene, 0.25, &known).unwrap().unwrap();
        assert_eq!(later.scene.bodies[0].position, [0.0, -0.25, 0.0]);
        assert_eq!(later.scene.bodies[0].velocity, [0.0, -2.0, 0.0]);
        let lecture = engine("lecture").unwrap();
        let run = record(&later.scene, &lecture, 0.5).unwrap();
        let error = later.reference.errors(&later.scene, &run).position_max;
        assert!((error.unwrap() - 4.0).abs() < 1e-12);
    }

    /// Nothing past the horizon of the scene itself: a later start has its samples later.
    #[test]
    fn a_later_start_is_compared_up_to_the_same_horizon() {
        let text = "name='x'\nduration=8\nsample_every=1\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[1,0,0]\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let mut known = Reference::exact(&scene).unwrap().unwrap();
        let until = |known: &Reference| {
            let later = Later::of(&scene, 0.5, known).unwrap().unwrap();
            later.reference.until(&later.scene)
        };
        assert_eq!(until(&known), 8.0);
        known.comparable = 5;
        assert_eq!((known.until(&scene), until(&known)), (4.0, 3.0));
    }
}
