//! Settings found by search: of each family on some shots, held against others.
//!
//! Two families search alike: the hand-written solver over its ladder of rungs, and Rapier over
//! its parameters; both over the step. Nothing that is measured depends on the clock, so the
//! same shots give the same settings.

mod coordinates;
mod objective;
mod search;
mod shots;

pub use coordinates::coordinates;
pub use objective::{effective, typical};
pub use search::{Coordinate, Search, Trial, Values, search};
pub use shots::{Shot, ShotError, measure};

use super::ladder::common_steps;
use super::{CostOptions, setting};
use crate::engine::{DEFAULT_DT, EngineKind, EngineSpec, engine};
use crate::error::Result;
use crate::scene::Scene;

/// What is searched together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// The hand-written solver: integrator, drag, impacts and step.
    HandWritten,
    /// Rapier: precision, parameters and step.
    Rapier,
}

impl Family {
    /// The word for it in tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::HandWritten => "hand-written",
            Self::Rapier => "rapier",
        }
    }

    /// The engine from whose settings the search begins.
    ///
    /// # Errors
    /// None: the table of engines has it.
    fn preset(self) -> Result<EngineSpec> {
        engine(match self {
            Self::HandWritten => "lecture",
            Self::Rapier => "rapier",
        })
    }

    /// Name and summary of the engine that it finds.
    fn found(self) -> (&'static str, &'static str) {
        match self {
            Self::HandWritten => (
                "lecture-tuned",
                "the lecture with the numerical choices found on the shots tuned on",
            ),
            Self::Rapier => (
                "rapier-tuned",
                "Rapier with the settings found on the shots tuned on",
            ),
        }
    }
}

/// A candidate of a family: settings and the largest step, s.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The settings.
    pub kind: EngineKind,
    /// The largest step, s.
    pub dt: f64,
}

/// What one family found.
#[derive(Debug, Clone)]
pub struct FamilyTuning {
    /// The family.
    pub family: Family,
    /// The engine from which it began.
    pub preset: EngineSpec,
    /// The engine that it found.
    pub spec: EngineSpec,
    /// Every trial with its errors. Shape of what is measured: `[shot tuned on]`.
    pub search: Search<Candidate, Vec<ShotError>>,
    /// On the shots that were not tuned on, at the step found: the start, and what was found.
    pub scores: Vec<Score>,
}

impl FamilyTuning {
    /// Settings in a word, as changes of those that the family began with.
    #[must_use]
    pub fn setting(&self, candidate: &Candidate) -> String {
        setting(&candidate.kind, &self.preset.kind)
    }

    /// The geometric mean over the shots scored on: the settings of the start, and those found;
    /// none without such a shot, or if they have not one unit.
    #[must_use]
    pub fn score(&self) -> Option<[f64; 2]> {
        let unit = self.scores.first()?.unit;
        if self.scores.iter().any(|score| score.unit != unit) {
            return None;
        }
        let mean = |which: fn(&Score) -> f64| typical(self.scores.iter().map(which));
        Some([mean(|score| score.start)?, mean(|score| score.found)?])
    }
}

/// Errors on a shot that was not tuned on, both at the step found, scene length unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Name of the scene.
    pub scene: String,
    /// Label of its lengths.
    pub unit: &'static str,
    /// With the settings of the start.
    pub start: f64,
    /// With the settings found.
    pub found: f64,
}

/// What all families found.
#[derive(Debug, Clone)]
pub struct Tuning {
    /// Names of the shots tuned on.
    pub tuned_on: Vec<String>,
    /// Scenes that are scored but have no exact reference, and why.
    pub unscored: Vec<String>,
    /// Trials that each family might make, each on every shot.
    pub trials_max: usize,
    /// Label of the length of errors.
    pub unit: &'static str,
    /// The families of this build.
    pub families: Vec<FamilyTuning>,
}

/// Is told how many trials of a family are done, and how many it may make.
pub type TuningWatcher<'a> = &'a dyn Fn(Family, usize, usize);

/// Tunes every family of this build on some shots and scores what it finds on others.
///
/// # Errors
/// A shot that is both tuned and scored on, one without an exact reference among those tuned on,
/// or other units of length than the first's; a scene that is not one.
pub fn tune(
    tuned_on: &[Scene],
    scored_on: &[Scene],
    options: &CostOptions,
    watch: TuningWatcher,
) -> Result<Tuning> {
    shots::check_apart(tuned_on, scored_on)?;
    let shots = tuned_on.iter().map(Shot::to_tune_on);
    let shots: Vec<Shot> = shots.collect::<Result<_>>()?;
    let steps = common_steps(tuned_on, options.budget)?;
    let trials_max = (options.runs / tuned_on.len().max(1)).max(1);
    let (mut held_out, mut unscored) = (Vec::new(), Vec::new());
    for scene in scored_on {
        match Shot::of(scene)? {
            Ok(shot) => held_out.push(shot),
            Err(why) => unscored.push(format!("{}: {why}", scene.name)),
        }
    }
    let mut families = Vec::new();
    for family in [Family::HandWritten, Family::Rapier] {
        let preset = family.preset()?;
        if !preset.is_built() {
            continue;
        }
        let watch = |done| watch(family, done, trials_max);
        let search = search_family(&preset, &shots, &steps, trials_max, &watch)?;
        let scores = scores(&preset, &search.found().candidate, &held_out)?;
        let (name, summary) = family.found();
        let spec = EngineSpec {
            name: name.to_owned(),
            summary,
            kind: search.found().candidate.kind.clone(),
        };
        families.push(FamilyTuning {
            family,
            preset,
            spec,
            search,
            scores,
        });
    }
    Ok(Tuning {
        tuned_on: tuned_on.iter().map(|scene| scene.name.clone()).collect(),
        unscored,
        trials_max,
        unit: tuned_on
            .first()
            .map_or("", |scene| scene.units.length.symbol()),
        families,
    })
}

fn search_family(
    preset: &EngineSpec,
    shots: &[Shot],
    steps: &[f64],
    trials_max: usize,
    watch: &dyn Fn(usize),
) -> Result<Search<Candidate, Vec<ShotError>>> {
    let start = Candidate {
        kind: preset.kind.clone(),
        dt: *steps.last().unwrap_or(&DEFAULT_DT),
    };
    let scenes: Vec<Scene> = shots.iter().map(|shot| shot.scene.clone()).collect();
    let coordinates = family_coordinates(&preset.kind, &scenes, steps);
    let mut done = 0;
    search(start, trials_max, &coordinates, |batch| {
        let measured = shots::measure(shots, batch)?;
        done += batch.len();
        watch(done);
        Ok(measured)
    })
}

/// What the kind of engine has, then the step. The search begins at the finest step that the
/// budget pays: a coarse one that hits a shot by luck would hold it fast.
fn family_coordinates(
    kind: &EngineKind,
    scenes: &[Scene],
    steps: &[f64],
) -> Vec<Coordinate<Candidate>> {
    let steps = steps.to_vec();
    let values = move |from: &Candidate| {
        let at = |dt: &f64| Candidate {
            kind: from.kind.clone(),
            dt: *dt,
        };
        steps.iter().map(at).collect()
    };
    let step = Coordinate {
        name: "dt",
        values: Box::new(values) as Values<Candidate>,
    };
    let precision = match kind {
        EngineKind::Rapier(_) => Some(coordinates::precision()),
        EngineKind::Impulse(_) | EngineKind::Exact(_) => None,
    };
    let settings = precision.into_iter().chain(coordinates(kind, scenes));
    let with_step = |coordinate: Coordinate<EngineKind>| Coordinate {
        name: coordinate.name,
        values: Box::new(move |from: &Candidate| {
            let kinds = (coordinate.values)(&from.kind).into_iter();
            kinds.map(|kind| Candidate { kind, dt: from.dt }).collect()
        }) as Values<Candidate>,
    };
    settings.map(with_step).chain([step]).collect()
}

/// The settings of the start and those found, both at the step found.
fn scores(preset: &EngineSpec, found: &Candidate, held_out: &[Shot]) -> Result<Vec<Score>> {
    let start = Candidate {
        kind: preset.kind.clone(),
        dt: found.dt,
    };
    let pair = [start, found.clone()];
    let score = |shot: &Shot| {
        let one = std::slice::from_ref(shot);
        let measured = shots::measure(one, &pair)?;
        Ok(Score {
            scene: shot.scene.name.clone(),
            unit: shot.scene.units.length.symbol(),
            start: measured[0].1,
            found: measured[1].1,
        })
    };
    held_out.iter().map(score).collect()
}
