//! Tolerances, derived from runs: what a solver does at other steps, and what one ulp does.

use super::measure::{Measured, Scales, apart, measured};
use super::subject::Subject;
use crate::case::{Case, Evidence, Metric, Profile, Tolerance, Tolerances, thinning};
use crate::engine::{StepGrid, engine, record, versions};
use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::scene::Scene;
use crate::study::cost::slope;
use crate::study::stopwatch::Dice;

/// Scenes moved by one ulp.
const TWINS: u64 = 8;
/// Roundings of one step on a number, which another way to write the step commits elsewhere: a kick
/// `v + dt ((1/m) F)` has a quotient, two products and a sum, a drift fewer.
const ROUNDINGS: f64 = 4.0;
/// Positions are held against truth as long as no step of the ladder is off by more than this
/// share of the scene's length: past that, they say nothing about a solver.
pub(super) const HORIZON: f64 = 0.1;
/// And against the stored recording as long as rounding leaves three eighths of the digits: a
/// millionth of that length in double precision.
const ROUNDING_HORIZON: f64 = 0.375;
/// Highest order that is believed: that of the highest rung of the ladder, and one more.
const ORDER_MAX: f64 = 6.0;

/// What was derived of a solver on a case.
#[derive(Debug, Clone)]
pub struct Derived {
    /// Values, tolerances and where they come from.
    pub profile: Profile,
    /// Its recording on the samples that are stored, as far as it is compared.
    pub baseline: Recording,
}

/// The steps between two samples of a ladder: the step itself, three just below it, so that
/// impacts fall elsewhere within a step, and a half, a third and a quarter of it.
fn ladder(k: u64) -> Vec<u64> {
    let mut ladder = vec![k, k + 1, k + 2, k + 3, 2 * k, 3 * k, 4 * k];
    ladder.sort_unstable();
    ladder.dedup();
    ladder
}

/// Derives what a solver is known to do on a case with steps of `dt` s at most; `rapier` is the
/// stored recording of Rapier.
///
/// Against truth: `max over h of e(h) (dt/h)^p` over a ladder of steps h, p the measured order;
/// more what rounding does, and what the truth leaves open. Against the stored recording: 4
/// roundings a step, each growing as the largest of 8 twins grows that start an ulp away.
///
/// # Errors
/// A scene that the solver cannot compute, or one that it does not finish.
pub fn derive(
    case: &Case,
    subject: &dyn Subject,
    dt: f64,
    rapier: Option<&Recording>,
) -> Result<Derived> {
    let scene = &case.scene;
    let grid = StepGrid::new(scene, dt)?;
    let runs = ladder(grid.steps_per_sample)
        .into_iter()
        .map(|k| {
            #[allow(clippy::cast_precision_loss, reason = "steps stay far below 2^53")]
            let h = scene.sample_every / k as f64;
            Ok((h, finished(subject, scene, h)?))
        })
        .collect::<Result<Vec<_>>>()?;
    let run = &runs[0].1;
    let truth = case.truth.as_ref();
    let scales = Scales::of(scene, truth.unwrap_or(run));
    let rounding = Rounding::of(scene, subject, run, grid.step, &scales)?;
    let against_truth = against_truth(case, &runs, &scales, &rounding)?;
    let until = scene.sample_time(rounding.samples - 1);
    let baseline = against_baseline(until, &rounding);
    let stored_until = against_truth.until.max(until);
    let thinned = scene.every(thinning(scene));
    let stored = samples_up_to(&thinned, stored_until);
    let stored = run.every(thinning(scene)).up_to(stored, &thinned);
    let rapier = rapier.map(|rapier| against_rapier(&thinned, &stored, rapier, &baseline));
    Ok(Derived {
        profile: Profile {
            made: made(subject),
            dt,
            digest: run.digest(),
            truth: Some(against_truth),
            baseline: Some(baseline),
            rapier,
        },
        baseline: stored,
    })
}

/// How many samples lie up to a time, the start included.
#[must_use]
pub fn samples_up_to(scene: &Scene, until: f64) -> usize {
    let in_time = |sample: &usize| scene.sample_time(*sample) <= until * (1.0 + 1e-9);
    (0..=scene.sample_count())
        .take_while(in_time)
        .count()
        .max(1)
}

/// Versions, target and precision of this build.
fn made(subject: &dyn Subject) -> String {
    let versions: Vec<_> = versions()
        .into_iter()
        .filter(|(name, _)| subject.crates().contains(name))
        .map(|(name, version)| format!("{name} {version}"))
        .collect();
    let (arch, os) = (std::env::consts::ARCH, std::env::consts::OS);
    let precision = if subject.epsilon() > f64::EPSILON {
        "single"
    } else {
        "double"
    };
    format!(
        "{}; {arch}-{os}, {precision} precision",
        versions.join(", ")
    )
}

fn finished(subject: &dyn Subject, scene: &Scene, dt: f64) -> Result<Recording> {
    let run = subject.record(scene, dt)?;
    if run.outcome.is_finished() && run.sample_count() == scene.sample_count() + 1 {
        return Ok(run);
    }
    Err(Error::Profile {
        case: scene.name.clone(),
        message: format!(
            "`{}` does not finish it at a step of {dt} s: {}",
            subject.name(),
            run.outcome.describe(scene)
        ),
    })
}

/// What rounding may do to a solver's recording.
struct Rounding {
    /// How many samples can be compared: before rounding may do too much.
    samples: usize,
    /// How far positions may be off at the last of them, scene length unit …
    position: f64,
    /// … and velocities.
    velocity: f64,
    /// The sentence that says so.
    why: String,
    /// How far apart the twins are so far at each sample, scene length unit.
    spread: Vec<f64>,
    /// Roundings of a number up to the end of the scene, relative.
    share: f64,
}

impl Rounding {
    fn of(
        scene: &Scene,
        subject: &dyn Subject,
        run: &Recording,
        step: f64,
        scales: &Scales,
    ) -> Result<Self> {
        let all = run.sample_count();
        let twins = (0..TWINS)
            .map(|seed| subject.record(&moved_by_an_ulp(scene, subject.epsilon(), seed), step))
            .collect::<Result<Vec<_>>>()?;
        let spread = |metric, size: f64| -> Vec<f64> {
            let apart: Vec<Measured> = twins
                .iter()
                .map(|twin| apart(metric, run, twin, all))
                .collect();
            let least = size * subject.epsilon();
            let at = |sample: usize| {
                apart
                    .iter()
                    .filter_map(|twin| twin.points.get(sample))
                    .map(|at| at.value)
                    .fold(least, f64::max)
            };
            (0..all)
                .map(at)
                .scan(0.0, |most: &mut f64, at| {
                    *most = most.max(at);
                    Some(*most)
                })
                .collect()
        };
        let position = spread(Metric::Position, scales.coordinate);
        let velocity = spread(Metric::Velocity, scales.speed);
        let count = |sample: usize| ROUNDINGS * (scene.sample_time(sample) / step + 1.0);
        let all_ended = twins.iter().map(Recording::sample_count).min();
        let largest = subject.epsilon().powf(ROUNDING_HORIZON) * scales.length;
        let is_small = |sample: &usize| count(*sample) * position[*sample] <= largest;
        let samples = (0..all_ended.unwrap_or(all).min(all))
            .take_while(is_small)
            .count()
            .max(1);
        let last = samples - 1;
        let why = format!(
            "{} roundings in {:.0} steps, times the spread {:.1e} of {TWINS} twins moved by an ulp",
            ROUNDINGS,
            scene.sample_time(last) / step,
            position[last],
        );
        Ok(Self {
            samples,
            position: count(last) * position[last],
            velocity: count(last) * velocity[last],
            why,
            spread: position,
            share: count(all - 1) * subject.epsilon(),
        })
    }
}

/// The scene with every coordinate and velocity moved up or down to about the next number of an
/// arithmetic; zeros stay.
fn moved_by_an_ulp(scene: &Scene, epsilon: f64, seed: u64) -> Scene {
    let mut dice = Dice::new(seed);
    let mut twin = scene.clone();
    for body in &mut twin.bodies {
        for value in body.position.iter_mut().chain(&mut body.velocity) {
            let by = if dice.below(2) == 0 {
                epsilon
            } else {
                -epsilon
            };
            *value *= 1.0 + by;
        }
    }
    twin
}

fn against_truth(
    case: &Case,
    runs: &[(f64, Recording)],
    scales: &Scales,
    rounding: &Rounding,
) -> Result<Tolerances> {
    let scene = &case.scene;
    let whole = case.truth.as_ref();
    let samples = whole.map_or(1, |truth| before_horizon(scene, runs, truth, scales));
    let truth = whole.map(|truth| truth.up_to(samples, scene));
    let open = left_open(case, scales)?;
    let mut tolerances = Tolerances::up_to(scene.sample_time(samples - 1));
    let tells_events = runs.iter().any(|(_, run)| !run.events.events().is_empty());
    let each: Vec<(f64, Vec<Measured>)> = runs
        .iter()
        .map(|(h, run)| {
            (
                *h,
                measured(scene, run, tells_events, truth.as_ref(), scales),
            )
        })
        .collect();
    for (place, own) in each[0].1.iter().enumerate() {
        let errors: Vec<[f64; 2]> = each
            .iter()
            .map(|(h, all)| [*h, all[place].worst().1.value])
            .collect();
        let floor = match own.metric {
            // One ulp may move an impact by a whole step, so its spread counts as it is.
            Metric::Position => {
                rounding.spread[samples - 1] + rounding.share * scales.coordinate + open
            }
            Metric::Velocity => rounding.velocity,
            Metric::Penetration => rounding.share * scales.coordinate,
            Metric::ImpactTime => rounding.share * scene.duration,
            Metric::MissedImpacts => 0.0,
            Metric::Energy | Metric::Momentum | Metric::AngularMomentum => rounding.share,
        };
        tolerances.set(own.metric, carried(own.metric, &errors, floor));
    }
    Ok(tolerances)
}

/// How many samples of the truth lie before the horizon of a solver: where no step of the ladder
/// is off by a share of the scene's length. At least two, the start among them.
fn before_horizon(
    scene: &Scene,
    runs: &[(f64, Recording)],
    truth: &Recording,
    scales: &Scales,
) -> usize {
    let comparable = truth.comparable_samples(scene);
    let far = |(_, run): &(f64, Recording)| {
        apart(Metric::Position, run, truth, comparable).first_beyond(HORIZON * scales.length)
    };
    let first = runs.iter().filter_map(far).min().unwrap_or(comparable);
    first.max(2).min(comparable)
}

/// What the truth leaves open of positions, scene length unit: its doubles, or where carom made
/// it, the digits that it certifies.
fn left_open(case: &Case, scales: &Scales) -> Result<f64> {
    let doubles = f64::EPSILON * scales.coordinate;
    if case.evidence != Some(Evidence::Own) {
        return Ok(doubles);
    }
    let scene = &case.scene;
    let exact = record(scene, &engine("exact")?, scene.sample_every)?;
    let digits = exact
        .fewest_digits(scene)
        .map_or(0, |digits| digits.position);
    Ok(doubles + scales.length * 10_f64.powi(-i32::from(digits)))
}

/// The largest error of a ladder of `[step, error]`, each carried to the first step by the
/// measured order, and a floor.
///
/// Equation: `max over h of e(h) (dt/h)^p + floor`, p the slope of log e over log h by least
/// squares, over the errors above twice the floor; 0 where fewer than three are.
fn carried(metric: Metric, errors: &[[f64; 2]], floor: f64) -> Tolerance {
    let [dt, value] = errors[0];
    let above: Vec<[f64; 2]> = errors
        .iter()
        .filter(|[_, error]| *error > 2.0 * floor && *error > 0.0)
        .map(|[h, error]| [h.ln(), error.ln()])
        .collect();
    let order = if metric == Metric::MissedImpacts || above.len() < 3 {
        0.0
    } else {
        slope(&above).0.clamp(0.0, ORDER_MAX)
    };
    let carry = |[h, error]: &[f64; 2]| (error * (dt / h).powf(order), *h);
    let (worst, at) = errors
        .iter()
        .map(carry)
        .fold((0.0, dt), |most, at| if at.0 > most.0 { at } else { most });
    let why = if worst > 0.0 {
        format!(
            "order {order:.2} over {} steps down to {:.1e} s, worst carried from {at:.2e} s; floor \
             {floor:.1e}",
            errors.len(),
            errors.last().map_or(dt, |[h, _]| *h),
        )
    } else {
        format!("none at {} steps; floor {floor:.1e}", errors.len())
    };
    Tolerance {
        value,
        tolerance: worst + floor,
        why,
    }
}

fn against_baseline(until: f64, rounding: &Rounding) -> Tolerances {
    let mut tolerances = Tolerances::up_to(until);
    let of = |tolerance: f64, why: String| Tolerance {
        value: 0.0,
        tolerance,
        why,
    };
    tolerances.set(
        Metric::Position,
        of(rounding.position, rounding.why.clone()),
    );
    let why = "the same with the spread of the velocities".to_owned();
    tolerances.set(Metric::Velocity, of(rounding.velocity, why));
    tolerances
}

fn against_rapier(
    thinned: &Scene,
    stored: &Recording,
    rapier: &Recording,
    baseline: &Tolerances,
) -> Tolerances {
    let samples = samples_up_to(thinned, baseline.until);
    let distance = apart(Metric::Position, stored, rapier, samples)
        .worst()
        .1
        .value;
    let tolerance = baseline
        .of(Metric::Position)
        .map_or(0.0, |own| own.tolerance);
    let mut tolerances = Tolerances::up_to(baseline.until);
    tolerances.set(
        Metric::Position,
        Tolerance {
            value: distance,
            tolerance,
            why: "on the change of the distance: no larger than the distance to the baseline, by \
                  the triangle inequality"
                .to_owned(),
        },
    );
    tolerances
}
