//! `metrics.csv` and `divergence.csv`, and the two tables of each recording.

use std::io::{self, Write};

use serde::Serialize;

use crate::compare::Metrics;
use crate::recording::finite_or_blank;
use crate::study::SideBySide;

/// A number that is left blank where it is not finite.
#[derive(Serialize)]
struct Number(#[serde(serialize_with = "finite_or_blank")] f64);

/// A row of `metrics.csv`; the names of the fields are the header.
#[derive(Serialize)]
struct MetricsRow<'a> {
    time: Number,
    engine: &'a str,
    kinetic_energy: Number,
    potential_energy: Number,
    total_energy: Number,
    momentum_x: Number,
    momentum_y: Number,
    momentum_z: Number,
    angular_momentum_x: Number,
    angular_momentum_y: Number,
    angular_momentum_z: Number,
    centre_of_mass_x: Number,
    centre_of_mass_y: Number,
    centre_of_mass_z: Number,
    attraction_energy: Number,
    spring_energy: Number,
    gravity_energy: Number,
    max_penetration: Number,
}

impl<'a> MetricsRow<'a> {
    fn new(engine: &'a str, at: &Metrics) -> Self {
        Self {
            time: Number(at.time),
            engine,
            kinetic_energy: Number(at.kinetic_energy),
            potential_energy: Number(at.potential_energy()),
            total_energy: Number(at.total_energy()),
            momentum_x: Number(at.momentum.x),
            momentum_y: Number(at.momentum.y),
            momentum_z: Number(at.momentum.z),
            angular_momentum_x: Number(at.angular_momentum.x),
            angular_momentum_y: Number(at.angular_momentum.y),
            angular_momentum_z: Number(at.angular_momentum.z),
            centre_of_mass_x: Number(at.centre_of_mass.x),
            centre_of_mass_y: Number(at.centre_of_mass.y),
            centre_of_mass_z: Number(at.centre_of_mass.z),
            attraction_energy: Number(at.attraction_energy),
            spring_energy: Number(at.spring_energy),
            gravity_energy: Number(at.gravity_energy),
            max_penetration: Number(at.max_penetration),
        }
    }
}

/// Writes `metrics.csv`: a row per voice and sample.
pub(super) fn write_metrics(comparison: &SideBySide, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for voice in &comparison.voices {
        for at in &voice.metrics {
            table.serialize(MetricsRow::new(voice.name(), at))?;
        }
    }
    table.flush()
}

/// A row of `divergence.csv`; the names of the fields are the header.
#[derive(Serialize)]
struct DivergenceRow<'a> {
    time: Number,
    engine_a: &'a str,
    engine_b: &'a str,
    rms_position: Number,
    max_position: Number,
    worst_body: &'a str,
    rms_velocity: Number,
    /// Of the total energies, without sign, scene units.
    energy_difference: Number,
    /// Of the momenta, the length of the vector, scene units.
    momentum_difference: Number,
    /// Of the angular momenta about the origin, the length of the vector, scene units.
    angular_momentum_difference: Number,
}

/// The header of `divergence.csv`, for one voice alone, so that a program finds the table it
/// expects.
const DIVERGENCE_HEADER: [&str; 10] = [
    "time",
    "engine_a",
    "engine_b",
    "rms_position",
    "max_position",
    "worst_body",
    "rms_velocity",
    "energy_difference",
    "momentum_difference",
    "angular_momentum_difference",
];

/// Writes `divergence.csv`: a row per pair of voices and sample.
pub(super) fn write_divergence(comparison: &SideBySide, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    if comparison.pairs.is_empty() {
        table.write_record(DIVERGENCE_HEADER)?;
    }
    for (divergence, _) in &comparison.pairs {
        let metrics = [&divergence.voice_a, &divergence.voice_b].map(|name| {
            comparison
                .voice(name)
                .map_or(&[][..], |voice| &voice.metrics)
        });
        let pairs = metrics[0].iter().zip(metrics[1]);
        for (at, (a, b)) in divergence.samples.iter().zip(pairs) {
            let energy = a.total_energy() - b.total_energy();
            let turning = a.angular_momentum - b.angular_momentum;
            table.serialize(DivergenceRow {
                time: Number(at.time),
                engine_a: &divergence.voice_a,
                engine_b: &divergence.voice_b,
                rms_position: Number(at.rms_position),
                max_position: Number(at.max_position),
                worst_body: &comparison.scene.bodies[at.worst_body].name,
                rms_velocity: Number(at.rms_velocity),
                energy_difference: Number(energy.abs()),
                momentum_difference: Number((a.momentum - b.momentum).norm()),
                angular_momentum_difference: Number(turning.norm()),
            })?;
        }
    }
    table.flush()
}
