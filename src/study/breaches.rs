//! What a recording breaks of what must hold on its scene.

use std::fmt;

use serde::Serialize;

use crate::case::{
    End, EnergyBound, Expected, ImpactCounts, Mirror, MomentumBound, PenetrationBound, SpeedBound,
};
use crate::compare::Metrics;
use crate::physics::Vector3;
use crate::recording::{EventCounts, Outcome, Recording};
use crate::scene::Scene;

/// A bound that was broken: when for the first time, how far at worst, and what was allowed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Excess {
    /// Time of the first sample that breaks the bound, s.
    pub time: f64,
    /// The worst value of all samples.
    pub worst: f64,
    /// The largest value allowed.
    pub allowed: f64,
}

/// Something that must hold and does not.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Breach {
    /// The run ended before the scene did.
    Ended {
        /// How.
        outcome: Outcome,
    },
    /// The energy rose, as a share of its scale.
    EnergyGrew(Excess),
    /// The energy fell, as a share of its scale.
    EnergyLost(Excess),
    /// The momentum changed, as a share of its scale.
    MomentumOff(Excess),
    /// Bodies stand in each other or in walls, scene length unit.
    Penetrated(Excess),
    /// A body is too fast, scene length unit per second.
    TooFast(Excess),
    /// Bodies are not where their mirror images are, scene length unit.
    MirrorBroken(Excess),
    /// There were more or fewer contacts.
    ContactsOff {
        /// How many there were.
        found: u64,
        /// How many there are.
        due: u64,
    },
    /// There were too few contacts.
    ContactsMissed {
        /// How many there were.
        found: u64,
        /// How many there are at least.
        least: u64,
    },
    /// There were more or fewer impacts on cushions.
    CushionsOff {
        /// How many there were.
        found: u64,
        /// How many there are.
        due: u64,
    },
    /// A body ended elsewhere, scene length unit.
    EndsElsewhere(Excess),
    /// A body ended with another velocity, scene length unit per second.
    EndsOtherwise(Excess),
}

impl Breach {
    /// One bare word, for tables: that of the outcome where the run ended early.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Ended { outcome } => outcome.word(),
            Self::EnergyGrew(_) => "EnergyGrew",
            Self::EnergyLost(_) => "EnergyLost",
            Self::MomentumOff(_) => "MomentumOff",
            Self::Penetrated(_) => "Penetrated",
            Self::TooFast(_) => "TooFast",
            Self::MirrorBroken(_) => "MirrorBroken",
            Self::ContactsOff { .. } => "ContactsOff",
            Self::ContactsMissed { .. } => "ContactsMissed",
            Self::CushionsOff { .. } => "CushionsOff",
            Self::EndsElsewhere(_) => "EndsElsewhere",
            Self::EndsOtherwise(_) => "EndsOtherwise",
        }
    }

    /// When it was seen first, s: what is counted, at the end of the scene.
    #[must_use]
    pub fn time(&self, scene: &Scene) -> f64 {
        match self {
            Self::Ended { outcome } => outcome.time().unwrap_or(scene.duration),
            Self::EnergyGrew(excess)
            | Self::EnergyLost(excess)
            | Self::MomentumOff(excess)
            | Self::Penetrated(excess)
            | Self::TooFast(excess)
            | Self::MirrorBroken(excess)
            | Self::EndsElsewhere(excess)
            | Self::EndsOtherwise(excess) => excess.time,
            Self::ContactsOff { .. } | Self::ContactsMissed { .. } | Self::CushionsOff { .. } => {
                scene.duration
            }
        }
    }
}

impl fmt::Display for Breach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut beyond = |what: &str,
                          Excess {
                              time,
                              worst,
                              allowed,
                          }: &Excess| {
            // Times are n times the spacing of samples, rounded: 0.1 + 0.2.
            let time = (time * 1e9).round() / 1e9;
            write!(
                f,
                "{what} {worst:.3e} where {allowed:.3e} is allowed, from {time} s on"
            )
        };
        match self {
            Self::Ended { outcome } => write!(f, "ended early: {}", outcome.word()),
            Self::EnergyGrew(excess) => beyond("energy grew by", excess),
            Self::EnergyLost(excess) => beyond("energy fell by", excess),
            Self::MomentumOff(excess) => beyond("momentum off by", excess),
            Self::Penetrated(excess) => beyond("penetration of", excess),
            Self::TooFast(excess) => beyond("a speed of", excess),
            Self::MirrorBroken(excess) => beyond("mirror image off by", excess),
            Self::ContactsOff { found, due } => write!(f, "{found} contacts where there are {due}"),
            Self::ContactsMissed { found, least } => {
                write!(f, "{found} contacts where there are {least} at least")
            }
            Self::CushionsOff { found, due } => write!(f, "{found} cushions where there are {due}"),
            Self::EndsElsewhere(excess) => beyond("end position off by", excess),
            Self::EndsOtherwise(excess) => beyond("end velocity off by", excess),
        }
    }
}

/// Everything that a recording breaks; `metrics` are those of the recording.
#[must_use]
pub fn breaches(
    scene: &Scene,
    expected: &Expected,
    recording: &Recording,
    metrics: &[Metrics],
) -> Vec<Breach> {
    let mut broken = Vec::new();
    if !recording.outcome.is_finished() {
        broken.push(Breach::Ended {
            outcome: recording.outcome,
        });
    }
    if let Some(bound) = &expected.energy {
        broken.extend(energy(bound, metrics));
    }
    if let Some(bound) = &expected.momentum {
        broken.extend(momentum(bound, metrics));
    }
    if let Some(bound) = &expected.penetration {
        broken.extend(penetration(bound, scene, recording, metrics));
    }
    if let Some(bound) = &expected.speed {
        broken.extend(speed(bound, scene, recording));
    }
    if let Some(mirror) = &expected.mirror {
        broken.extend(images(mirror, scene, recording));
    }
    if let Some(counts) = &expected.impacts {
        broken.extend(missed(counts, recording.events.counts()));
    }
    if let Some(end) = &expected.end
        && recording.outcome.is_finished()
    {
        broken.extend(ends(end, scene, recording));
    }
    broken
}

/// The values at the samples against the largest allowed; what is not a number is too large.
fn excess(
    values: impl Iterator<Item = (f64, f64)>,
    allowed: impl Fn(usize) -> f64,
) -> Option<Excess> {
    let mut found: Option<Excess> = None;
    for (sample, (time, value)) in values.enumerate() {
        let allowed = allowed(sample);
        if value <= allowed {
            continue;
        }
        let value = if value.is_nan() { f64::INFINITY } else { value };
        match &mut found {
            Some(excess) if value > excess.worst => {
                (excess.worst, excess.allowed) = (value, allowed);
            }
            Some(_) => {}
            None => {
                found = Some(Excess {
                    time,
                    worst: value,
                    allowed,
                });
            }
        }
    }
    found
}

/// (time, rise of the energy above its start as a share of the scale) at every sample.
pub(super) fn energy_rises<'a>(
    bound: &EnergyBound,
    metrics: &'a [Metrics],
) -> impl Iterator<Item = (f64, f64)> + use<'a> {
    let start = metrics[0].total_energy();
    let scale = bound.scale.unwrap_or_else(|| metrics[0].start_energy());
    metrics
        .iter()
        .map(move |at| (at.time, (at.total_energy() - start) / scale))
}

/// (time, change of the momentum as a share of the scale) at every sample.
pub(super) fn momentum_changes<'a>(
    bound: &MomentumBound,
    metrics: &'a [Metrics],
) -> impl Iterator<Item = (f64, f64)> + use<'a> {
    let start = metrics[0].momentum;
    let scale = bound.scale.unwrap_or(metrics[0].momentum_scale);
    metrics
        .iter()
        .map(move |at| (at.time, (at.momentum - start).norm() / scale))
}

fn energy(bound: &EnergyBound, metrics: &[Metrics]) -> impl Iterator<Item = Breach> {
    let rises = energy_rises(bound, metrics);
    let grew = excess(rises, |_| bound.gain_max).map(Breach::EnergyGrew);
    let falls = || energy_rises(bound, metrics).map(|(time, rise)| (time, -rise));
    let lost = bound.loss_max.and_then(|loss| excess(falls(), |_| loss));
    grew.into_iter().chain(lost.map(Breach::EnergyLost))
}

fn momentum(bound: &MomentumBound, metrics: &[Metrics]) -> Option<Breach> {
    let changes = momentum_changes(bound, metrics);
    excess(changes, |_| bound.change_max).map(Breach::MomentumOff)
}

fn penetration(
    bound: &PenetrationBound,
    scene: &Scene,
    recording: &Recording,
    metrics: &[Metrics],
) -> Option<Breach> {
    let radii = scene.bodies.iter().map(|body| body.radius);
    let room = bound.depth_max * radii.fold(f64::INFINITY, f64::min);
    let from = first_after(scene, bound.after);
    let allowed = |place: usize| {
        let states = recording.sample(from + place).iter();
        let coordinate = states.fold(0.0_f64, |most, state| most.max(state.position.amax()));
        room + bound.ulps * f64::EPSILON * coordinate
    };
    let depths = metrics.iter().skip(from);
    excess(depths.map(|at| (at.time, at.max_penetration)), allowed).map(Breach::Penetrated)
}

fn speed(bound: &SpeedBound, scene: &Scene, recording: &Recording) -> Option<Breach> {
    let samples = recording.samples().enumerate();
    let speeds = samples
        .skip(first_after(scene, bound.after))
        .map(|(sample, states)| {
            let speeds = states.iter().map(|state| state.velocity.norm());
            (scene.sample_time(sample), speeds.fold(0.0, f64::max))
        });
    excess(speeds, |_| bound.max).map(Breach::TooFast)
}

/// The first sample at that time or later.
fn first_after(scene: &Scene, after: f64) -> usize {
    let samples = 0..=scene.sample_count();
    let mut later = samples.skip_while(|sample| scene.sample_time(*sample) < after);
    later.next().unwrap_or(scene.sample_count())
}

fn images(mirror: &Mirror, scene: &Scene, recording: &Recording) -> Option<Breach> {
    let partners = mirror.partners(scene).ok()?;
    let apart = recording.samples().enumerate().map(|(sample, states)| {
        let pairs = states.iter().zip(&partners);
        let apart = pairs.map(|(state, partner)| {
            (mirror.image(state).position - states[*partner].position).norm()
        });
        (scene.sample_time(sample), apart.fold(0.0, f64::max))
    });
    excess(apart, |_| mirror.within).map(Breach::MirrorBroken)
}

fn missed(counts: &ImpactCounts, found: EventCounts) -> impl Iterator<Item = Breach> {
    let EventCounts {
        contacts, cushions, ..
    } = found;
    let other = counts.contacts.filter(|due| *due != contacts);
    let fewer = counts.contacts_min.filter(|least| *least > contacts);
    let walls = counts.cushions.filter(|due| *due != cushions);
    let broken = [
        other.map(|due| Breach::ContactsOff {
            found: contacts,
            due,
        }),
        fewer.map(|least| Breach::ContactsMissed {
            found: contacts,
            least,
        }),
        walls.map(|due| Breach::CushionsOff {
            found: cushions,
            due,
        }),
    ];
    broken.into_iter().flatten()
}

fn ends(end: &End, scene: &Scene, recording: &Recording) -> impl Iterator<Item = Breach> {
    let states = recording.sample(recording.sample_count() - 1);
    let known = || {
        let bodies = end.bodies.iter();
        bodies.filter_map(|due| Some((due, states.get(scene.body_index(&due.name)?)?)))
    };
    let time = scene.duration;
    let places =
        known().map(|(due, state)| (time, (state.position - Vector3::from(due.position)).norm()));
    let elsewhere = excess(places, |_| end.within).map(Breach::EndsElsewhere);
    let velocities = known().filter_map(|(due, state)| {
        let velocity = Vector3::from(due.velocity?);
        Some((time, (state.velocity - velocity).norm()))
    });
    let within = end.within_velocity.unwrap_or(f64::INFINITY);
    let otherwise = excess(velocities, |_| within).map(Breach::EndsOtherwise);
    elsewhere.into_iter().chain(otherwise)
}
