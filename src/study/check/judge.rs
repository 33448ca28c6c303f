//! One run held against truth, against what is stored of the engine, and against Rapier.

use serde::Serialize;

use super::derive::{HORIZON, samples_up_to};
use super::measure::{Measured, Point, Scales, apart, measured};
use crate::case::{Case, Metric, Profile, Tolerance, Tolerances, thinning};
use crate::compare::{Disagreement, Sizes, compare_events};
use crate::recording::{Event, EventKind, Recording};
use crate::scene::Scene;

/// Stored samples after the one at which a run leaves the baseline: an impact that comes late or
/// early is over by then, and a wrong one shows.
const LATER: usize = 2;

/// What a run is held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Against {
    /// Independent evidence, and what the model of the scene keeps.
    Truth,
    /// The stored recording of the engine.
    Baseline,
    /// The stored recording of Rapier.
    Rapier,
}

impl Against {
    /// The word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Truth => "truth",
            Self::Baseline => "baseline",
            Self::Rapier => "rapier",
        }
    }
}

/// What a comparison came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Held {
    /// Every tolerance holds.
    Holds,
    /// A tolerance does not hold, but the run is nearer to truth than what it differs from, or
    /// differs only where nobody knows better.
    Excused,
    /// A tolerance does not hold.
    Fails,
}

/// One metric of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// What was measured.
    pub metric: Metric,
    /// Its unit; `share` for shares of a scale.
    pub unit: String,
    /// The value.
    pub value: f64,
    /// What it may be.
    pub tolerance: f64,
    /// What of the tolerance is left, as a share of it; negative where it does not hold.
    pub margin: f64,
    /// The value with its sign: of the component that is off most; for Rapier, how much farther
    /// away the run is than the baseline.
    pub signed: f64,
    /// Where it was largest, in words.
    pub place: String,
    /// Whether it holds.
    pub held: Held,
}

/// One comparison of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// With what.
    pub against: Against,
    /// Positions, velocities and impacts are compared up to this time, s.
    pub until: f64,
    /// What it came to.
    pub held: Held,
    /// Metric by metric.
    pub rows: Vec<Row>,
    /// Time of the first sample that disagrees, s; none where none does, or where what disagrees
    /// counts the run as a whole.
    pub first_at: Option<f64>,
    /// What disagrees first, in sentences.
    pub said: Vec<String>,
    /// How far the run is from Rapier at most, and how far the baseline is; only of that comparison.
    pub distances: Option<[f64; 2]>,
}

/// A run, and what it is judged by.
pub(super) struct Trial<'a> {
    pub case: &'a Case,
    pub profile: &'a Profile,
    /// The stored recording of the engine that the profile is of.
    pub baseline: Option<&'a Recording>,
    pub rapier: Option<&'a Recording>,
    pub run: &'a Recording,
    /// Whether the profile is that of the very solver that ran.
    pub is_own: bool,
}

impl Trial<'_> {
    /// Whether the run says what it met: trajectories made elsewhere do not.
    fn tells_events(&self) -> bool {
        !self.run.events.events().is_empty()
    }
}

/// Holds a run against everything that its profile names.
pub(super) fn judge(trial: &Trial) -> Vec<Comparison> {
    let truth = trial
        .profile
        .truth
        .as_ref()
        .map(|tolerances| against_truth(trial, tolerances));
    let tolerances = trial.profile.baseline.as_ref();
    let stored = tolerances.zip(trial.baseline);
    let baseline = stored.map(|(tolerances, stored)| against_baseline(trial, tolerances, stored));
    let known = baseline.as_ref().zip(trial.baseline);
    let rapier = trial.profile.rapier.as_ref().zip(trial.rapier);
    let rapier = rapier.zip(known);
    let rapier = rapier.map(|((tolerances, rapier), (baseline, stored))| {
        against_rapier(trial, tolerances, stored, rapier, baseline.held)
    });
    [truth, baseline, rapier].into_iter().flatten().collect()
}

fn row(scene: &Scene, measured: &Measured, tolerance: f64) -> Row {
    let (sample, worst) = measured.worst();
    let whole = measured.points.len() == 1;
    let place = match worst.place {
        Some((body, axis)) => format!(
            "`{}`, {} at t = {} s",
            scene.bodies[body].name,
            ["x", "y", "z"][axis],
            scene.sample_time(sample)
        ),
        None if whole => String::new(),
        None => format!("t = {} s", scene.sample_time(sample)),
    };
    let left = tolerance - worst.value;
    Row {
        metric: measured.metric,
        unit: unit(scene, measured.metric),
        value: worst.value,
        tolerance,
        margin: if tolerance > 0.0 {
            left / tolerance
        } else {
            left
        },
        signed: worst.signed,
        place,
        held: if worst.value <= tolerance {
            Held::Holds
        } else {
            Held::Fails
        },
    }
}

/// What rows come to together: the worst of them.
fn worst_of(rows: &[Row]) -> Held {
    let any = |held: Held| rows.iter().any(|row| row.held == held);
    match (any(Held::Fails), any(Held::Excused)) {
        (true, _) => Held::Fails,
        (false, true) => Held::Excused,
        (false, false) => Held::Holds,
    }
}

/// The unit of a metric on a scene.
fn unit(scene: &Scene, metric: Metric) -> String {
    let length = scene.units.length.symbol();
    match metric {
        Metric::Position | Metric::Penetration => length.to_owned(),
        Metric::Velocity => format!("{length}/s"),
        Metric::Energy | Metric::Momentum | Metric::AngularMomentum => "share".to_owned(),
        Metric::MissedImpacts => "impacts".to_owned(),
        Metric::ImpactTime => "s".to_owned(),
    }
}

fn against_truth(trial: &Trial, tolerances: &Tolerances) -> Comparison {
    let (scene, run) = (&trial.case.scene, trial.run);
    let samples = samples_up_to(scene, tolerances.until);
    let truth = trial.case.truth.as_ref();
    let truth = truth.map(|truth| truth.up_to(samples, scene));
    let scales = Scales::of(scene, trial.case.truth.as_ref().unwrap_or(run));
    let all = measured(scene, run, trial.tells_events(), truth.as_ref(), &scales);
    let judged = all
        .iter()
        .filter_map(|measured| Some((measured, tolerances.of(measured.metric)?)));
    let judged: Vec<(&Measured, &Tolerance)> = judged.collect();
    let mut rows: Vec<Row> = judged
        .iter()
        .map(|(measured, known)| row(scene, measured, known.tolerance))
        .collect();
    excuse_the_better(trial, tolerances, scales.length, &mut rows);
    let mut said = Vec::new();
    let first = judged
        .iter()
        .zip(&rows)
        .filter(|((measured, _), row)| measured.points.len() > 1 && row.held == Held::Fails)
        .filter_map(|((measured, known), _)| {
            Some((measured.first_beyond(known.tolerance)?, *measured, *known))
        })
        .min_by_key(|(sample, ..)| *sample);
    if let Some((sample, measured, known)) = first {
        said.push(first_sample(trial, measured, known, sample, truth.as_ref()));
    }
    let held = worst_of(&rows);
    if let (Held::Fails, true, Some(truth)) = (held, trial.tells_events(), &truth) {
        let first = compare_events(scene, run, truth).first_disagreement;
        said.extend(first.map(|first| first_event(scene, &first)));
    }
    Comparison {
        against: Against::Truth,
        until: tolerances.until,
        held,
        rows,
        first_at: first.map(|(sample, ..)| scene.sample_time(sample)),
        said,
        distances: None,
    }
}

/// What is better on the whole may be worse in a part: a scheme of high order keeps no angular
/// momentum that the lecture's keeps, but is off by less than the lecture's positions are; and one
/// that finds impacts which the profile misses has their times to be wrong about.
fn excuse_the_better(trial: &Trial, tolerances: &Tolerances, length: f64, rows: &mut [Row]) {
    let value = |metric| tolerances.of(metric).map(|known| known.value);
    let found = rows.iter().find(|row| row.metric == Metric::MissedImpacts);
    let finds_more = found.is_some_and(|row| Some(row.value) < value(Metric::MissedImpacts));
    let share = value(Metric::Position).map_or(0.0, |off| Sizes::share(off, length));
    for row in rows.iter_mut().filter(|row| row.held == Held::Fails) {
        let is_excused = match row.metric {
            Metric::ImpactTime => finds_more,
            Metric::Energy | Metric::Momentum | Metric::AngularMomentum => {
                row.value <= share && is_better(trial)
            }
            _ => false,
        };
        if is_excused {
            row.held = Held::Excused;
        }
    }
}

/// The first sample that disagrees, in a sentence.
fn first_sample(
    trial: &Trial,
    measured: &Measured,
    known: &Tolerance,
    sample: usize,
    truth: Option<&Recording>,
) -> String {
    let scene = &trial.case.scene;
    let at = measured.points[sample];
    let time = scene.sample_time(sample);
    let name = measured.metric.name();
    let of = match (at.place, truth) {
        (Some((body, axis)), Some(truth)) => format!(
            ": `{}` has {} = {} where truth has {}",
            scene.bodies[body].name,
            ["x", "y", "z"][axis],
            trial.run.sample(sample)[body].position[axis],
            truth.sample(sample)[body].position[axis],
        ),
        _ => String::new(),
    };
    format!(
        "{name} is first beyond its tolerance at t = {time} s (sample {sample}), by {:.3e} of \
         {:.3e}{of}",
        at.value, known.tolerance
    )
}

/// The first event that disagrees, in a sentence.
fn first_event(scene: &Scene, first: &Disagreement) -> String {
    let name = |body: usize| format!("`{}`", scene.bodies[body].name);
    let tell = |event: &Event| {
        let what = match event.kind {
            EventKind::Contact { a, b } => format!("{} hits {}", name(a), name(b)),
            EventKind::Cushion { body, wall } => format!("{} hits the wall {wall}", name(body)),
            EventKind::Rest { body } => format!("{} stops", name(body)),
        };
        format!("{what} at t = {:.6} s", event.time)
    };
    match (&first.event_a, &first.event_b) {
        (Some(ours), Some(theirs)) => format!(
            "the first event that disagrees: {} where truth has: {}",
            tell(ours),
            tell(theirs)
        ),
        (Some(ours), None) => format!(
            "the first event that disagrees: {}, which truth does not have",
            tell(ours)
        ),
        (None, Some(theirs)) => format!(
            "the first event that disagrees: truth has: {}, which is missing",
            tell(theirs)
        ),
        (None, None) => String::new(),
    }
}

fn against_baseline(trial: &Trial, tolerances: &Tolerances, stored: &Recording) -> Comparison {
    let scene = trial.case.scene.every(thinning(&trial.case.scene));
    let run = trial.run.every(thinning(&trial.case.scene));
    let samples = samples_up_to(&scene, tolerances.until).min(stored.sample_count());
    let all = tolerances.all().map(|(metric, known)| {
        let measured = apart(metric, &run, stored, samples);
        (measured, known.tolerance)
    });
    let all: Vec<(Measured, f64)> = all.collect();
    let mut rows: Vec<Row> = all
        .iter()
        .map(|(measured, tolerance)| row(&scene, measured, *tolerance))
        .collect();
    let first = all
        .iter()
        .filter_map(|(measured, tolerance)| measured.first_beyond(*tolerance))
        .min();
    // A run that ends early has not been compared to the end.
    let ended = (run.sample_count() < samples).then(|| run.sample_count());
    let first = first.or(ended);
    let mut said = Vec::new();
    let held = first.map_or(Held::Holds, |first| {
        let time = scene.sample_time(first);
        if let Some(reason) = excuse_for(trial, first) {
            said.push(format!("leaves the baseline by t = {time} s, {reason}"));
            return Held::Excused;
        }
        said.push(leaves(trial, &scene, &all, first));
        Held::Fails
    });
    excuse(&mut rows, held);
    Comparison {
        against: Against::Baseline,
        until: tolerances.until,
        held,
        rows,
        first_at: first.map(|first| scene.sample_time(first)),
        said,
        distances: None,
    }
}

/// Where a run leaves the baseline, in a sentence.
fn leaves(trial: &Trial, scene: &Scene, all: &[(Measured, f64)], first: usize) -> String {
    let time = scene.sample_time(first);
    let place = all.iter().find_map(|(measured, _)| {
        let at = measured.points.get(first)?;
        let (body, axis) = at.place?;
        Some(format!(
            ": {} of `{}` along {} is off by {:.3e} {}",
            measured.metric.name(),
            trial.case.scene.bodies[body].name,
            ["x", "y", "z"][axis],
            at.signed,
            unit(scene, measured.metric)
        ))
    });
    format!(
        "leaves the baseline by t = {time} s{}",
        place.unwrap_or_default()
    )
}

/// Why a run may leave the baseline at a stored sample, if it may.
///
/// Before the horizon of the profile: because it is nearer to truth all along. Past it, as long as
/// the baseline itself is near truth: because it is nearer there, over the next samples too.
/// Farther on a distance from truth says nothing, and a solver that is judged as another one may
/// differ; the engine itself may not.
fn excuse_for(trial: &Trial, first: usize) -> Option<&'static str> {
    const NEARER: &str = "and is nearer to truth than the baseline is";
    let nobody_knows = (!trial.is_own).then_some("where nobody can say who is right");
    let known = trial.case.truth.as_ref().zip(trial.profile.truth.as_ref());
    let Some((truth, known)) = known else {
        return nobody_knows;
    };
    let scene = &trial.case.scene;
    let sample = first * thinning(scene);
    if scene.sample_time(sample) <= known.until {
        return is_better(trial).then_some(NEARER);
    }
    let errors = errors(trial, first + LATER);
    let Some((ours, theirs)) = errors.filter(|_| sample < truth.comparable_samples(scene)) else {
        return nobody_knows;
    };
    let horizon = HORIZON * Scales::of(scene, truth).length;
    match theirs.points.get(first) {
        Some(at) if at.value <= horizon => {}
        _ => return nobody_knows,
    }
    let from_there = |error: &Measured| -> f64 {
        let points = error.points.iter().skip(first);
        points.map(|at| at.value).sum()
    };
    (from_there(&ours) < from_there(&theirs)).then_some(NEARER)
}

/// The errors of the run and of the baseline against truth at stored samples: up to the horizon of
/// the profile, and up to this one at least, as far as all of them go.
fn errors(trial: &Trial, sample: usize) -> Option<(Measured, Measured)> {
    let known = trial.case.truth.as_ref().zip(trial.profile.truth.as_ref());
    let ((truth, known), stored) = known.zip(trial.baseline)?;
    let scene = &trial.case.scene;
    let every = thinning(scene);
    let vouched = truth.comparable_samples(scene).div_ceil(every);
    let samples = samples_up_to(&scene.every(every), known.until).max(sample + 1);
    let samples = samples.min(stored.sample_count()).min(vouched);
    let (run, truth) = (trial.run.every(every), truth.every(every));
    let error = |of: &Recording| apart(Metric::Position, of, &truth, samples);
    (run.sample_count() >= samples).then(|| (error(&run), error(stored)))
}

/// Whether the run is nearer to truth than the baseline, up to every sample before the horizon of
/// the profile.
fn is_better(trial: &Trial) -> bool {
    let room = trial.profile.baseline.as_ref();
    let room = room.and_then(|known| known.of(Metric::Position));
    let room = room.map_or(0.0, |known| known.tolerance);
    errors(trial, 0).is_some_and(|(ours, theirs)| {
        let mut pairs = ours.so_far().zip(theirs.so_far());
        pairs.all(|(ours, theirs)| ours <= theirs + room)
    })
}

/// Gives failed rows the verdict of their comparison.
fn excuse(rows: &mut [Row], held: Held) {
    for row in rows.iter_mut().filter(|row| row.held == Held::Fails) {
        row.held = held;
    }
}

fn against_rapier(
    trial: &Trial,
    tolerances: &Tolerances,
    stored: &Recording,
    rapier: &Recording,
    baseline: Held,
) -> Comparison {
    let scene = trial.case.scene.every(thinning(&trial.case.scene));
    let run = trial.run.every(thinning(&trial.case.scene));
    let samples = samples_up_to(&scene, tolerances.until)
        .min(stored.sample_count())
        .min(run.sample_count());
    let ours = apart(Metric::Position, &run, rapier, samples);
    let theirs = apart(Metric::Position, stored, rapier, samples);
    let pairs = ours.points.iter().zip(&theirs.points);
    let changes = pairs.map(|(ours, theirs)| {
        let signed = ours.value - theirs.value;
        Point {
            value: signed.abs(),
            signed,
            place: ours.place,
        }
    });
    let change = Measured {
        metric: Metric::Position,
        points: changes.collect(),
    };
    let known = tolerances.of(Metric::Position);
    let mut rows: Vec<Row> = known
        .map(|known| row(&scene, &change, known.tolerance))
        .into_iter()
        .collect();
    // Who leaves the baseline with good reason leaves its distance to Rapier as well.
    if baseline == Held::Excused {
        excuse(&mut rows, Held::Excused);
    }
    let first = known.and_then(|known| change.first_beyond(known.tolerance));
    Comparison {
        against: Against::Rapier,
        until: tolerances.until,
        held: worst_of(&rows),
        rows,
        first_at: first.map(|first| scene.sample_time(first)),
        said: Vec::new(),
        distances: Some([ours.worst().1.value, theirs.worst().1.value]),
    }
}
