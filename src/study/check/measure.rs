//! The metrics of a run, sample by sample, so that the first sample that disagrees can be named.

use crate::case::Metric;
use crate::compare::{Metrics, Sizes, compare_events, metrics};
use crate::physics::{BodyState, Vector3};
use crate::recording::Recording;
use crate::scene::Scene;

/// A metric at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Its size, never negative.
    pub value: f64,
    /// The same with its sign: of the component that is off most, where it is a vector.
    pub signed: f64,
    /// The body that it is of, where it is of one, and the component.
    pub place: Option<(usize, usize)>,
}

/// A metric over a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Which one.
    pub metric: Metric,
    /// At every sample; a single point for what counts the run as a whole. Never empty.
    pub points: Vec<Point>,
}

impl Measured {
    /// The largest point and its sample; one that is no number counts as larger than all.
    #[must_use]
    pub fn worst(&self) -> (usize, Point) {
        let points = self.points.iter().copied().enumerate();
        let larger = |worst: (usize, Point), at: (usize, Point)| {
            if at.1.value > worst.1.value || (at.1.value.is_nan() && !worst.1.value.is_nan()) {
                at
            } else {
                worst
            }
        };
        points.reduce(larger).unwrap_or((0, Point::of(0.0)))
    }

    /// The first sample at which a tolerance does not hold.
    #[must_use]
    pub fn first_beyond(&self, tolerance: f64) -> Option<usize> {
        let beyond = |at: &Point| at.value > tolerance || at.value.is_nan();
        self.points.iter().position(beyond)
    }

    /// The largest value up to each sample.
    pub fn so_far(&self) -> impl Iterator<Item = f64> {
        self.points.iter().scan(0.0_f64, |most, at| {
            *most = most.max(at.value);
            Some(*most)
        })
    }
}

impl Point {
    fn of(signed: f64) -> Self {
        Self {
            value: signed.abs(),
            signed,
            place: None,
        }
    }

    fn of_vector(vector: &Vector3, size: f64) -> Self {
        Self {
            value: Sizes::share(vector.norm(), size),
            signed: Sizes::share(vector[vector.iamax()], size),
            place: None,
        }
    }
}

/// How far apart two recordings are in position or velocity, over so many samples.
///
/// Both begin with the same sample; a recording that ends earlier is compared as far as it goes.
#[must_use]
pub fn apart(metric: Metric, run: &Recording, other: &Recording, samples: usize) -> Measured {
    let vector = |state: &BodyState| match metric {
        Metric::Velocity => state.velocity,
        _ => state.position,
    };
    let farthest = |(ours, theirs): (&[BodyState], &[BodyState])| {
        let mut worst = Point::of(0.0);
        for (body, (a, b)) in ours.iter().zip(theirs).enumerate() {
            let difference = vector(a) - vector(b);
            let distance = difference.norm();
            if distance > worst.value || distance.is_nan() {
                let axis = difference.iamax();
                worst = Point {
                    value: distance,
                    signed: difference[axis],
                    place: Some((body, axis)),
                };
            }
        }
        worst
    };
    let both = run.samples().zip(other.samples()).take(samples);
    Measured {
        metric,
        points: both.map(farthest).collect(),
    }
}

/// The sizes that shares are of.
#[derive(Debug, Clone, Copy)]
pub struct Scales {
    energy: f64,
    momentum: f64,
    angular_momentum: f64,
    /// The length of the scene, scene length unit.
    pub length: f64,
    /// The largest speed, scene length unit per second.
    pub speed: f64,
    /// The largest coordinate, scene length unit.
    pub coordinate: f64,
}

impl Scales {
    /// Those of a recording.
    #[must_use]
    pub fn of(scene: &Scene, recording: &Recording) -> Self {
        let sizes = Sizes::of(recording, &metrics(scene, recording));
        let turning = |states: &[BodyState]| -> f64 {
            let pairs = scene.bodies.iter().zip(states);
            pairs
                .map(|(body, s)| body.mass * s.position.norm() * s.velocity.norm())
                .sum()
        };
        let states = || recording.samples().flatten();
        Self {
            energy: sizes.energy,
            momentum: sizes.momentum,
            angular_momentum: recording.samples().map(turning).fold(0.0, f64::max),
            length: sizes.length,
            speed: states().map(|s| s.velocity.norm()).fold(0.0, f64::max),
            coordinate: states().map(|s| s.position.amax()).fold(0.0, f64::max),
        }
    }
}

/// Every metric of a run that truth and the model say something about, as far as the truth goes;
/// impacts where the run tells them.
#[must_use]
pub fn measured(
    scene: &Scene,
    run: &Recording,
    tells_events: bool,
    truth: Option<&Recording>,
    scales: &Scales,
) -> Vec<Measured> {
    let mut all = Vec::new();
    if let Some(truth) = truth {
        let samples = truth.comparable_samples(scene);
        all.push(apart(Metric::Position, run, truth, samples));
        if tells_events {
            all.extend(impacts(scene, run, truth));
        }
    }
    all.extend(kept(scene, run, scales));
    all
}

/// What the model of the scene keeps, and does not: its change since the start; and how deep
/// bodies stand in each other.
fn kept(scene: &Scene, run: &Recording, scales: &Scales) -> Vec<Measured> {
    let all = metrics(scene, run);
    let start = all[0];
    let effects = &scene.effects;
    let over = |metric, point: &dyn Fn(&Metrics) -> Point| Measured {
        metric,
        points: all.iter().map(point).collect(),
    };
    let mut kept = Vec::new();
    if effects.conserve_energy() {
        kept.push(over(Metric::Energy, &|at| {
            let change = at.total_energy() - start.total_energy();
            Point::of(Sizes::share(change, scales.energy))
        }));
    }
    if effects.conserve_momentum() {
        kept.push(over(Metric::Momentum, &|at| {
            Point::of_vector(&(at.momentum - start.momentum), scales.momentum)
        }));
    }
    if effects.conserve_angular_momentum() {
        kept.push(over(Metric::AngularMomentum, &|at| {
            let change = at.angular_momentum - start.angular_momentum;
            Point::of_vector(&change, scales.angular_momentum)
        }));
    }
    if effects.contact.is_some() || effects.cushions.is_some() {
        kept.push(over(Metric::Penetration, &|at| {
            Point::of(at.max_penetration)
        }));
    }
    kept
}

/// How the impacts of a run match those of the truth, as far as the truth goes.
fn impacts(scene: &Scene, run: &Recording, truth: &Recording) -> Vec<Measured> {
    let due = truth.events.impacts().count();
    if due == 0 {
        return Vec::new();
    }
    let agreement = compare_events(scene, run, truth);
    #[allow(
        clippy::cast_precision_loss,
        reason = "impacts are far fewer than 2^53"
    )]
    let missed = due.saturating_sub(agreement.matched) as f64;
    let whole = |metric, value| Measured {
        metric,
        points: vec![Point::of(value)],
    };
    vec![
        whole(Metric::MissedImpacts, missed),
        whole(Metric::ImpactTime, agreement.time_difference_max),
    ]
}
