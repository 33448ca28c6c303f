//! Push-out priced by itself: the same engine with it and without it, at every step.

use super::contender::{Contender, STOCK};
use super::ladder::ladder;
use super::{CostOptions, Reference, Stage, Watcher};
use crate::compare::{Drift, Sizes, metrics};
use crate::engine::{EngineKind, EngineSpec, Impacts, ImpulseSettings, engines, record};
use crate::error::Result;
use crate::recording::Recording;
use crate::scene::Scene;
use crate::study::stopwatch::{Job, prices};
use crate::study::{Price, Ratio, paired_ratio};

/// An engine with its push-out against itself without it.
#[derive(Debug, Clone, PartialEq)]
pub struct PushOut {
    /// The engine, with push-out.
    pub engine: String,
    /// The engine of the same settings without it; one of the table, where it has that.
    pub without: String,
    /// Each step that both finish, from coarse to fine.
    pub rungs: Vec<PushOutRung>,
}

/// What push-out does and costs at one step.
#[derive(Debug, Clone, PartialEq)]
pub struct PushOutRung {
    /// The step, s.
    pub dt: f64,
    /// The price with push-out over that without; none with too few rounds.
    pub ratio: Option<Ratio>,
    /// Energy that push-out adds against the forces, over the energy scale of the reference: from
    /// each sample of the reference on to the next with it and without it, the differences
    /// added up.
    pub energy_added: Option<f64>,
    /// The run with push-out.
    pub with: Left,
    /// The run without.
    pub without: Left,
}

/// What one run leaves, and for which price.
#[derive(Debug, Clone, PartialEq)]
pub struct Left {
    /// Milliseconds per simulated second, the median.
    pub cost: f64,
    /// Largest distance of a body from the reference, scene length unit.
    pub error: Option<f64>,
    /// Deepest penetration at the end of a step, scene length unit.
    pub penetration: f64,
}

/// The same engine without its push-out; none if it has none.
fn without_push_out(spec: &EngineSpec) -> Option<EngineSpec> {
    let EngineKind::Impulse(settings) = spec.kind else {
        return None;
    };
    if settings.impacts != Impacts::Overlap {
        return None;
    }
    let kind = EngineKind::Impulse(ImpulseSettings {
        impacts: Impacts::OverlapInPlace,
        ..settings
    });
    let known = engines().into_iter().find(|other| other.kind == kind);
    Some(known.unwrap_or_else(|| EngineSpec {
        name: format!("{} without push-out", spec.name),
        summary: "the same without push-out",
        kind,
    }))
}

/// Prices push-out on every engine that has it; nothing on a scene in which nothing can meet.
///
/// # Errors
/// As [`record`].
pub(super) fn push_out(
    scene: &Scene,
    specs: &[&EngineSpec],
    known: &Reference,
    sample: usize,
    options: &CostOptions,
    watch: Watcher,
) -> Result<Vec<PushOut>> {
    if scene.effects.contact.is_none() && scene.effects.cushions.is_none() {
        return Ok(Vec::new());
    }
    let pairs = specs.iter().filter_map(|spec| {
        let without = without_push_out(spec)?;
        Some([(*spec).clone(), without])
    });
    let contender = |spec: EngineSpec| Contender {
        setting: STOCK.to_owned(),
        spec,
        scene: scene.clone(),
    };
    let pairs: Vec<[Contender; 2]> = pairs.map(|pair| pair.map(contender)).collect();
    let mut met = Vec::new();
    for pair in &pairs {
        for rung in ladder(scene, options.budget) {
            if rung.affordable
                && let Some(found) = Met::at(scene, pair, rung.dt, known)?
            {
                met.push((pair, found));
            }
        }
    }
    let jobs: Vec<Job> = met
        .iter()
        .flat_map(|(pair, found)| {
            let dt = found.dt;
            pair.each_ref().map(|contender| Job {
                scene: &contender.scene,
                spec: &contender.spec,
                dt,
                from: 0,
                to: sample,
            })
        })
        .collect();
    let watch = |done, all| watch(Stage::PushOut, done, all);
    let priced = prices(&jobs, options.timing, &watch)?;
    let of_pair = |pair: &[Contender; 2]| {
        let own = met.iter().zip(priced.chunks_exact(2));
        let own = own.filter(|((of, _), _)| std::ptr::eq(*of, pair));
        PushOut {
            engine: pair[0].spec.name.clone(),
            without: pair[1].spec.name.clone(),
            rungs: own
                .map(|((_, found), price)| {
                    found.priced([&price[0], &price[1]], options.timing.seed)
                })
                .collect(),
        }
    };
    Ok(pairs.iter().map(of_pair).collect())
}

/// What is left at one step with push-out and without.
struct Met {
    dt: f64,
    energy_added: Option<f64>,
    /// Error and deepest penetration of each.
    left: [(Option<f64>, f64); 2],
}

impl Met {
    /// Runs both; none if one of them does not finish.
    fn at(
        scene: &Scene,
        pair: &[Contender; 2],
        dt: f64,
        known: &Reference,
    ) -> Result<Option<Self>> {
        let mut left = Vec::new();
        for contender in pair {
            let run = record(scene, &contender.spec, dt)?;
            if !run.outcome.is_finished() {
                return Ok(None);
            }
            let error = known.errors(scene, &run).position_max;
            left.push((error, deepest(scene, &contender.spec, dt)?));
        }
        let [with, without] = pair.each_ref().map(|contender| {
            let hops = known.one_by_one(scene, &contender.spec, dt);
            hops.map(|hops| hops.map(|hops| energies(scene, &hops)))
        });
        let energy_added = with?.zip(without?).map(|(with, without)| {
            let added: f64 = with.iter().zip(&without).map(|(a, b)| a - b).sum();
            Sizes::share(added, known.sizes.energy)
        });
        Ok(Some(Self {
            dt,
            energy_added: energy_added.filter(|added| added.is_finite()),
            left: [left[0], left[1]],
        }))
    }

    fn priced(&self, prices: [&Price; 2], seed: u64) -> PushOutRung {
        let left = |side: usize| Left {
            cost: prices[side].median,
            error: self.left[side].0,
            penetration: self.left[side].1,
        };
        PushOutRung {
            dt: self.dt,
            ratio: paired_ratio(&prices[0].rounds, &prices[1].rounds, seed),
            energy_added: self.energy_added,
            with: left(0),
            without: left(1),
        }
    }
}

fn energies(scene: &Scene, run: &Recording) -> Vec<f64> {
    let all = metrics(scene, run);
    all.iter()
        .map(crate::compare::Metrics::total_energy)
        .collect()
}

/// The deepest penetration at the end of any step: the same run, sampled at each; at every second,
/// fourth ... step where a scene may not have so many samples.
fn deepest(scene: &Scene, spec: &EngineSpec, dt: f64) -> Result<f64> {
    let mut every_step = Scene {
        sample_every: dt,
        ..scene.clone()
    };
    while every_step.check().is_err() && every_step.sample_every < scene.sample_every {
        every_step.sample_every *= 2.0;
    }
    let run = record(&every_step, spec, dt)?;
    let all = metrics(&every_step, &run);
    Ok(Drift::of(&all, &Sizes::of(&run, &all)).max_penetration)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::engine;

    #[test]
    fn the_twin_of_an_engine_differs_in_push_out_alone() {
        let twin = |name: &str| without_push_out(&engine(name).unwrap()).map(|spec| spec.name);
        assert_eq!(twin("lecture").as_deref(), Some("lecture-in-place"));
        assert_eq!(twin("verlet").as_deref(), Some("verlet without push-out"));
        assert_eq!(
            (twin("lecture-in-place"), twin("swept"), twin("rapier")),
            (None, None, None)
        );
    }

    /// Closed form: symplectic Euler with g = 10 and h = 1/8 falls `y = -g h² n (n + 1)/2` and is
    /// 0.4375 deep in the floor after 3 steps. At e = 0.5 push-out lifts the ball by 1.5 times
    /// that, and so adds m g times that to its energy; then it flies to the end of the sample.
    #[test]
    fn push_out_adds_the_weight_times_the_way_it_lifts() {
        let text = "name='x'\nduration=0.5\nsample_every=0.5\n\
            [[bodies]]\nname='a'\nmass=2\nradius=0.5\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
            [effects.gravity]\nacceleration=[0,-10,0]\n\
            [effects.cushions]\nhalf_width=9\nhalf_length=9\nhalf_height=1\nrestitution=0.5\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let known = Reference::exact(&scene).unwrap().unwrap();
        let pair = ["lecture", "lecture-in-place"].map(|name| Contender {
            setting: STOCK.to_owned(),
            spec: engine(name).unwrap(),
            scene: scene.clone(),
        });
        let met = Met::at(&scene, &pair, 0.125, &known).unwrap().unwrap();
        let added = met.energy_added.unwrap() * known.sizes.energy;
        assert!((added - 2.0 * 10.0 * 1.5 * 0.4375).abs() < 1e-12, "{added}");
        assert_eq!(met.left.map(|(_, penetration)| penetration), [0.0, 0.4375]);
        assert_ne!(met.left[0].0, met.left[1].0, "the errors are their own");
    }
}
