//! What each effect of a scene costs, and what it changes: one switched at a time.

use std::collections::HashMap;

use rayon::prelude::*;
use serde::Serialize;

use super::median::median;
use super::stopwatch::{Job, Price, Timing, paired, paired_ratio, prices};
use crate::compare::Divergence;
use crate::engine::{EngineSpec, record};
use crate::error::{Error, Result};
use crate::recording::{EventKind, Outcome, Recording, Work};
use crate::scene::{Attraction, Drag, Effect, Gravity, LengthUnit, Rest, Scene, Spring};

/// How a run differs from the scene as it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Change {
    /// Not at all: what the others are held against.
    Unchanged,
    /// A declared effect is taken away.
    Off,
    /// An undeclared effect is declared with its neutral value.
    OnNeutral,
}

impl Effect {
    /// The scene with this effect switched: off where it is declared, else on with its neutral
    /// value; none where there is no such value, or for springs no second body.
    #[must_use]
    pub fn switched(self, scene: &Scene) -> Option<(Change, Scene)> {
        let mut switched = scene.clone();
        if self.is_declared(scene) {
            self.take_away(&mut switched);
            return Some((Change::Off, switched));
        }
        let effects = &mut switched.effects;
        match self {
            Self::Contact | Self::Cushions => return None,
            Self::Drag => effects.drag = Some(Drag { coefficient: 0.0 }),
            Self::Rest => effects.rest = Some(Rest { speed: 0.0 }),
            Self::Attraction => {
                effects.attraction = Some(Attraction {
                    constant: 0.0,
                    softening: 0.0,
                });
            }
            Self::Gravity => {
                effects.gravity = Some(Gravity {
                    acceleration: [0.0; 3],
                });
            }
            Self::Springs => {
                let [a, b, ..] = scene.bodies.as_slice() else {
                    return None;
                };
                effects.springs = vec![Spring {
                    between: [a.name.clone(), b.name.clone()],
                    stiffness: 0.0,
                    rest_length: 1.0,
                    damping: 0.0,
                }];
            }
        }
        Some((Change::OnNeutral, switched))
    }

    fn take_away(self, scene: &mut Scene) {
        let effects = &mut scene.effects;
        match self {
            Self::Contact => effects.contact = None,
            Self::Cushions => effects.cushions = None,
            Self::Drag => effects.drag = None,
            Self::Rest => effects.rest = None,
            Self::Attraction => effects.attraction = None,
            Self::Gravity => effects.gravity = None,
            Self::Springs => effects.springs.clear(),
        }
    }
}

/// How far a changed run leaves the unchanged one, over the samples that both vouch for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Difference {
    /// Whether nothing changed, bit for bit: no position, velocity, event or outcome.
    pub is_none: bool,
    /// Largest distance of one body from where it is in the unchanged run, scene length unit.
    pub position_max: f64,
    /// Until when the two can be compared, s.
    pub compared_until_s: f64,
    /// Impacts of the unchanged run that have no match of the same bodies and wall.
    pub impacts_lost: u64,
    /// Impacts of the changed run that have no match of the same bodies and wall.
    pub impacts_gained: u64,
}

impl Difference {
    /// Compares a changed run with the unchanged one.
    #[must_use]
    pub fn between(scene: &Scene, unchanged: &Recording, changed: &Recording) -> Self {
        let divergence = Divergence::between(scene, unchanged, changed);
        let until = scene.sample_time(divergence.comparable - 1);
        let balance = impact_balance(unchanged, changed, until);
        let sum = |sign: i64| {
            let surplus = balance.values().map(|count| (sign * count).max(0));
            surplus.sum::<i64>().unsigned_abs()
        };
        Self {
            is_none: same_bits(unchanged, changed),
            position_max: divergence.largest().max_position,
            compared_until_s: until,
            impacts_lost: sum(-1),
            impacts_gained: sum(1),
        }
    }
}

/// How many more impacts of each kind the changed run has, up to a time.
fn impact_balance(
    unchanged: &Recording,
    changed: &Recording,
    until: f64,
) -> HashMap<EventKind, i64> {
    let mut balance = HashMap::new();
    for (recording, sign) in [(unchanged, -1), (changed, 1)] {
        let impacts = recording.events.impacts();
        for event in impacts.take_while(|event| event.time <= until) {
            *balance.entry(event.kind).or_default() += sign;
        }
    }
    balance
}

/// Whether two recordings hold the same numbers; equal zeros of two signs are not the same.
fn same_bits(a: &Recording, b: &Recording) -> bool {
    let bits = |recording: &Recording| -> Vec<u64> {
        let states = recording.samples().flatten();
        let numbers = states.flat_map(|state| [state.position, state.velocity]);
        numbers
            .flat_map(<[f64; 3]>::from)
            .map(f64::to_bits)
            .collect()
    };
    a.outcome == b.outcome && a.events.events() == b.events.events() && bits(a) == bits(b)
}

/// One engine on the scene with one effect switched.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectRow {
    /// The engine.
    pub engine: String,
    /// The effect that was switched; none for the scene as it stands.
    pub effect: Option<Effect>,
    /// Which way it was switched.
    pub change: Change,
    /// How the run ended, `Refused` where it did not start.
    pub outcome: &'static str,
    /// The same in words, with time and body or with the reason of the refusal.
    pub outcome_text: String,
    /// Impacts of the run.
    pub impacts: Option<u64>,
    /// Against the unchanged run.
    pub difference: Option<Difference>,
    /// Counted work of the run.
    pub work: Option<Work>,
    /// What a simulated second costs.
    pub price: Option<EffectPrice>,
}

/// The cost of a simulated second, and how it stands to that of the unchanged scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EffectPrice {
    /// Median over the repetitions, ms.
    pub median_ms_per_sim_s: f64,
    /// Least of the repetitions, ms.
    pub min_ms_per_sim_s: f64,
    /// Median over the repetitions of this cost over that of the unchanged scene beside it.
    pub ratio: f64,
    /// Lower end of the 95 % interval of that median; none with too few repetitions.
    pub ratio_low: Option<f64>,
    /// Upper end of it.
    pub ratio_high: Option<f64>,
    /// Repetitions that were timed.
    pub repetitions: usize,
}

impl EffectPrice {
    fn new(own: &Price, unchanged: &Price, seed: u64) -> Self {
        let interval = paired_ratio(&own.rounds, &unchanged.rounds, seed);
        Self {
            median_ms_per_sim_s: own.median,
            min_ms_per_sim_s: own.min,
            ratio: median(&paired(&own.rounds, &unchanged.rounds)),
            ratio_low: interval.map(|ratio| ratio.low),
            ratio_high: interval.map(|ratio| ratio.high),
            repetitions: own.rounds.len(),
        }
    }
}

/// What each effect of a scene costs and changes, on every engine asked for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectStudy {
    /// Name of the scene.
    pub scene: String,
    /// Title of the scene, or its name.
    pub title: String,
    /// Unit of length.
    pub length_unit: LengthUnit,
    /// Largest step asked for, s.
    pub dt_s: f64,
    /// Repetitions asked for.
    pub repetitions: usize,
    /// Seed of the order of runs and of the intervals.
    pub seed: u64,
    /// For each engine the scene as it stands, then every effect that can be switched.
    pub rows: Vec<EffectRow>,
}

/// An effect that changes nothing, and for whom.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct NeverFelt {
    /// The effect, which the scene declares.
    pub effect: Effect,
    /// The engines whose run without it is the same bit for bit.
    pub engines: Vec<String>,
}

impl EffectStudy {
    /// The effects that the scene declares and never feels: without them the run of at least
    /// one engine stays the same bit for bit.
    #[must_use]
    pub fn never_felt(&self) -> Vec<NeverFelt> {
        let engines = |effect: Effect| {
            let rows = self.rows.iter().filter(move |row| {
                row.effect == Some(effect)
                    && row.change == Change::Off
                    && row.difference.is_some_and(|difference| difference.is_none)
            });
            rows.map(|row| row.engine.clone()).collect()
        };
        let all = Effect::ALL.map(|effect| NeverFelt {
            effect,
            engines: engines(effect),
        });
        all.into_iter()
            .filter(|never| !never.engines.is_empty())
            .collect()
    }

    /// The row of an engine with that effect switched, or of the scene as it stands.
    #[must_use]
    pub fn row(&self, engine: &str, effect: Option<Effect>) -> Option<&EffectRow> {
        let mut rows = self.rows.iter();
        rows.find(|row| row.engine == engine && row.effect == effect)
    }
}

/// Switches each effect of a scene, one at a time, on each engine; records what changes, and
/// times `advance_to` without recording.
///
/// # Errors
/// As [`record`], but an engine that refuses a scene or blows up is a result, not an error.
pub fn effects(
    scene: &Scene,
    specs: &[EngineSpec],
    dt: f64,
    timing: Timing,
) -> Result<EffectStudy> {
    let mut rows = Vec::new();
    for spec in specs {
        rows.extend(on_engine(scene, spec, dt, timing)?);
    }
    Ok(EffectStudy {
        scene: scene.name.clone(),
        title: scene.heading().to_owned(),
        length_unit: scene.units.length,
        dt_s: dt,
        repetitions: timing.repetitions,
        seed: timing.seed,
        rows,
    })
}

/// A scene with one effect switched.
struct Variant {
    effect: Option<Effect>,
    change: Change,
    scene: Scene,
}

impl Variant {
    /// The scene as it stands, then every effect that can be switched.
    fn all(scene: &Scene) -> Vec<Self> {
        let unchanged = Self {
            effect: None,
            change: Change::Unchanged,
            scene: scene.clone(),
        };
        let switched = Effect::ALL.into_iter().filter_map(|effect| {
            let (change, scene) = effect.switched(scene)?;
            Some(Self {
                effect: Some(effect),
                change,
                scene,
            })
        });
        std::iter::once(unchanged).chain(switched).collect()
    }

    fn refused(&self, engine: &str, reason: &Error) -> EffectRow {
        EffectRow {
            engine: engine.to_owned(),
            effect: self.effect,
            change: self.change,
            outcome: "Refused",
            outcome_text: reason.to_string(),
            impacts: None,
            difference: None,
            work: None,
            price: None,
        }
    }

    fn ran(
        &self,
        recording: &Recording,
        unchanged: &Recording,
        price: Option<EffectPrice>,
    ) -> EffectRow {
        let counts = recording.events.counts();
        let difference = || Difference::between(&self.scene, unchanged, recording);
        EffectRow {
            engine: recording.voice.clone(),
            effect: self.effect,
            change: self.change,
            outcome: recording.outcome.word(),
            outcome_text: Outcome::describe(&recording.outcome, &self.scene).to_string(),
            impacts: Some(counts.contacts + counts.cushions),
            difference: self.effect.map(|_| difference()),
            work: Some(recording.work),
            price,
        }
    }
}

fn on_engine(scene: &Scene, spec: &EngineSpec, dt: f64, timing: Timing) -> Result<Vec<EffectRow>> {
    let variants = Variant::all(scene);
    let runs: Vec<_> = variants
        .par_iter()
        .map(|variant| record(&variant.scene, spec, dt))
        .collect();
    let mut recorded = Vec::new();
    for run in runs {
        match run {
            Ok(recording) => recorded.push(Ok(recording)),
            Err(refusal @ Error::EngineCannot { .. }) => recorded.push(Err(refusal)),
            Err(error) => return Err(error),
        }
    }
    let unchanged = match &recorded[0] {
        Ok(unchanged) => unchanged.clone(),
        // Nothing to hold the others against.
        Err(refusal) => return Ok(vec![variants[0].refused(&spec.name, refusal)]),
    };
    let prices = priced(&variants, &recorded, spec, dt, timing)?;
    let rows = variants.iter().zip(&recorded).zip(prices);
    let row = |((variant, run), price): ((&Variant, &Result<Recording>), _)| match run {
        Ok(recording) => variant.ran(recording, &unchanged, price),
        Err(refusal) => variant.refused(&spec.name, refusal),
    };
    Ok(rows.map(row).collect())
}

/// The price of each variant that has a recording past its start, in their order.
fn priced(
    variants: &[Variant],
    recorded: &[Result<Recording>],
    spec: &EngineSpec,
    dt: f64,
    timing: Timing,
) -> Result<Vec<Option<EffectPrice>>> {
    // Timed as far as the recording goes: past it the numbers mean nothing.
    let samples = |run: &Result<Recording>| run.as_ref().map_or(0, |run| run.sample_count() - 1);
    let jobs = variants.iter().zip(recorded).map(|(variant, run)| Job {
        scene: &variant.scene,
        spec,
        dt,
        from: 0,
        to: samples(run),
    });
    let is_timed: Vec<bool> = recorded.iter().map(|run| samples(run) > 0).collect();
    let jobs: Vec<Job> = jobs.filter(|job| job.to > 0).collect();
    let mut found = prices(&jobs, timing, &|_, _| {})?.into_iter();
    let prices: Vec<Option<Price>> = is_timed
        .into_iter()
        .map(|timed| timed.then(|| found.next()).flatten())
        .collect();
    let against = |own: &Price| Some(EffectPrice::new(own, prices[0].as_ref()?, timing.seed));
    Ok(prices.iter().map(|own| against(own.as_ref()?)).collect())
}
