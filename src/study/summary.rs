//! The figures of a comparison, as programs read them (`summary.json`) and pages show them.

use std::collections::BTreeMap;

use serde::Serialize;

use super::cost::EngineLimit;
use super::{Refusal, SideBySide, Voice};
use crate::case::Evidence;
use crate::compare::{
    ClusterFacts, Disagreement, Divergence, Drift, EventAgreement, Sizes, Verdict,
};
use crate::engine::{EngineSpec, notes, warnings};
use crate::recording::{
    Concession, Digits, Event, EventCounts, EventKind, Outcome, Undetermined, Work,
};
use crate::scene::{LengthUnit, Scene};

/// Everything about one comparison but the curves.
#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    /// Version of carom.
    pub carom_version: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Title of the scene, or its name.
    pub title: String,
    /// Where the scene comes from.
    pub source: Option<String>,
    /// What to look for.
    pub watch: Option<String>,
    /// Number of bodies.
    pub bodies: usize,
    /// s.
    pub duration_s: f64,
    /// s.
    pub sample_every_s: f64,
    /// Unit of length.
    pub length_unit: LengthUnit,
    /// Largest step asked for, s.
    pub dt_s: f64,
    /// What lengths, energies and momenta are measured against.
    pub scale: Sizes,
    /// Whether the model keeps the energy.
    pub model_conserves_energy: bool,
    /// Whether the model keeps the momentum.
    pub model_conserves_momentum: bool,
    /// Whether the model keeps the angular momentum.
    pub model_conserves_angular_momentum: bool,
    /// What is allowed but worth saying.
    pub warnings: Vec<String>,
    /// Where the truth comes from.
    pub truth_origin: Option<String>,
    /// Who made the truth.
    pub evidence: Option<Evidence>,
    /// Each engine, then truth.
    pub voices: Vec<VoiceSummary>,
    /// The voice that the engines are held against.
    pub reference: Option<String>,
    /// Who is wrong, from when, and by how much.
    pub verdicts: Vec<Verdict>,
    /// The engines that cannot do the scene.
    pub refusals: Vec<Refusal>,
    /// Each pair of voices.
    pub pairs: Vec<PairSummary>,
}

/// The figures of one voice.
#[derive(Debug, Clone, Serialize)]
pub struct VoiceSummary {
    /// Name of the voice.
    pub voice: String,
    /// The engine with its settings; none for truth.
    pub engine: Option<EngineSpec>,
    /// What the engine does to the scene from the start that is no physics.
    pub warnings: Vec<String>,
    /// What the harness supplies and what differs from the lecture.
    pub notes: Vec<String>,
    /// The step taken, s.
    pub step_s: Option<f64>,
    /// How it ended.
    pub outcome: Outcome,
    /// The same in words.
    pub outcome_text: String,
    /// Samples kept, the start included.
    pub samples: usize,
    /// Events counted.
    pub events: EventCounts,
    /// Events that share a row of the file with another.
    pub events_merged: u64,
    /// Counted work.
    pub work: Work,
    /// Fewest certified digits over the comparable samples; none where nothing is certified.
    pub digits_min: Option<Digits>,
    /// From when on the model has no single answer.
    pub undetermined: Option<Undetermined>,
    /// What the engine gave up to go on.
    pub concessions: Vec<Concession>,
    /// What became of the cluster, up to the last sample that all voices have; none where the
    /// bodies are no cluster.
    pub cluster: Option<ClusterFacts>,
    /// Drift of energy and momentum, and the deepest penetration.
    #[serde(flatten)]
    pub drift: Drift,
}

/// The figures of one pair of voices.
#[derive(Debug, Clone, Serialize)]
pub struct PairSummary {
    /// First voice.
    pub engine_a: String,
    /// Second voice.
    pub engine_b: String,
    /// Largest distance of one body, scene length unit.
    pub position_divergence_max: f64,
    /// The same over the scene's size.
    pub position_divergence_relative: f64,
    /// When, s.
    pub at_time_s: f64,
    /// Which body.
    pub worst_body: String,
    /// Largest rms difference of velocities, scene length unit per second.
    pub velocity_divergence_rms_max: f64,
    /// Largest difference of the total energies, over the energy scale of the comparison.
    pub energy_difference_max: f64,
    /// Largest difference of the total momenta, over the momentum scale of the comparison.
    pub momentum_difference_max: f64,
    /// Largest difference of the angular momenta about the centre of mass, over their scale.
    pub angular_momentum_difference_max: f64,
    /// Largest distance of the two centres of mass, scene length unit.
    pub centre_of_mass_difference_max: f64,
    /// Impacts that match in order.
    pub impacts_matched: usize,
    /// Largest difference in time of two matched impacts, s.
    pub impact_time_difference_max_s: f64,
    /// Largest difference in impulse of two matched impacts, over the larger of the two.
    pub impulse_difference_max: f64,
    /// Until when both go on and vouch for their positions, s.
    pub compared_until_s: f64,
    /// The first impact on which the two disagree.
    pub first_disagreement: Option<DisagreementSummary>,
    /// Largest distance of each body.
    pub body_position_divergence_max: BTreeMap<String, f64>,
}

/// The first impact on which two voices disagree.
#[derive(Debug, Clone, Serialize)]
pub struct DisagreementSummary {
    /// s.
    pub time_s: f64,
    /// Who has what, in words.
    pub text: String,
}

impl Summary {
    /// The figures of a comparison.
    #[must_use]
    pub fn of(comparison: &SideBySide) -> Self {
        let scene = &comparison.scene;
        let clusters = comparison.cluster_facts();
        let cluster = |place: usize| clusters.as_ref().map(|facts| facts[place]);
        Self {
            carom_version: env!("CARGO_PKG_VERSION"),
            scene: scene.name.clone(),
            title: scene.heading().to_owned(),
            source: scene.source.clone(),
            watch: scene.watch.clone(),
            bodies: scene.bodies.len(),
            duration_s: scene.duration,
            sample_every_s: scene.sample_every,
            length_unit: scene.units.length,
            dt_s: comparison.dt,
            scale: comparison.scale,
            model_conserves_energy: scene.effects.conserve_energy(),
            model_conserves_momentum: scene.effects.conserve_momentum(),
            model_conserves_angular_momentum: scene.effects.conserve_angular_momentum(),
            warnings: scene.warnings().iter().map(ToString::to_string).collect(),
            truth_origin: comparison.origin.clone(),
            evidence: comparison.evidence,
            voices: comparison
                .voices
                .iter()
                .enumerate()
                .map(|(place, voice)| VoiceSummary::of(scene, voice, cluster(place)))
                .collect(),
            reference: comparison.reference().map(|voice| voice.name().to_owned()),
            verdicts: comparison.verdicts(),
            refusals: comparison.refusals.clone(),
            pairs: comparison
                .pairs
                .iter()
                .filter_map(|(divergence, agreement)| {
                    PairSummary::of(comparison, divergence, agreement)
                })
                .collect(),
        }
    }

    /// Tells each verdict what a study of cost on the same scene has found of its engine.
    pub fn tell_limits(&mut self, limits: &[EngineLimit]) {
        for verdict in &mut self.verdicts {
            let told = limits.iter().find(|row| row.engine == verdict.engine);
            verdict.limit = told.and_then(|row| row.limit);
        }
    }

    /// The figures of the pair, in either order.
    #[must_use]
    pub fn pair(&self, a: &str, b: &str) -> Option<&PairSummary> {
        self.pairs.iter().find(|pair| {
            (pair.engine_a == a && pair.engine_b == b) || (pair.engine_a == b && pair.engine_b == a)
        })
    }
}

impl VoiceSummary {
    fn of(scene: &Scene, voice: &Voice, cluster: Option<ClusterFacts>) -> Self {
        let recording = &voice.recording;
        Self {
            voice: voice.name().to_owned(),
            warnings: voice
                .spec
                .as_ref()
                .map(|spec| warnings(scene, spec))
                .unwrap_or_default(),
            notes: voice
                .spec
                .as_ref()
                .map(|spec| notes(scene, spec))
                .unwrap_or_default(),
            engine: voice.spec.clone(),
            step_s: recording.step,
            outcome: recording.outcome,
            outcome_text: recording.outcome.describe(scene).to_string(),
            samples: recording.sample_count(),
            events: recording.events.counts(),
            events_merged: recording.events.merged(),
            work: recording.work,
            digits_min: recording.fewest_digits(scene),
            undetermined: recording.undetermined.clone(),
            concessions: recording.concessions.clone(),
            cluster,
            drift: voice.drift,
        }
    }
}

impl PairSummary {
    fn of(
        comparison: &SideBySide,
        divergence: &Divergence,
        agreement: &EventAgreement,
    ) -> Option<Self> {
        let scene = &comparison.scene;
        let a = comparison.voice(&divergence.voice_a)?;
        let b = comparison.voice(&divergence.voice_b)?;
        let largest = divergence.largest();
        let both = || a.metrics.iter().zip(&b.metrics);
        let scale = &comparison.scale;
        let energies = both().map(|(a, b)| (a.total_energy() - b.total_energy()).abs());
        let momenta = both().map(|(a, b)| (a.momentum - b.momentum).norm());
        let spins = both().map(|(a, b)| (a.spin - b.spin).norm());
        let centres = both().map(|(a, b)| (a.centre_of_mass - b.centre_of_mass).norm());
        let named = |(body, distance): (&crate::scene::Body, &f64)| (body.name.clone(), *distance);
        Some(Self {
            engine_a: divergence.voice_a.clone(),
            engine_b: divergence.voice_b.clone(),
            position_divergence_max: largest.max_position,
            position_divergence_relative: Sizes::share(largest.max_position, scale.length),
            at_time_s: largest.time,
            worst_body: scene.bodies[largest.worst_body].name.clone(),
            velocity_divergence_rms_max: divergence
                .samples
                .iter()
                .map(|at| at.rms_velocity)
                .fold(0.0, f64::max),
            energy_difference_max: Sizes::share(energies.fold(0.0, f64::max), scale.energy),
            momentum_difference_max: Sizes::share(momenta.fold(0.0, f64::max), scale.momentum),
            angular_momentum_difference_max: Sizes::share(
                spins.fold(0.0, f64::max),
                scale.angular_momentum,
            ),
            centre_of_mass_difference_max: centres.fold(0.0, f64::max),
            impacts_matched: agreement.matched,
            impact_time_difference_max_s: agreement.time_difference_max,
            impulse_difference_max: agreement.impulse_difference_max,
            compared_until_s: divergence.samples[divergence.comparable - 1].time,
            first_disagreement: agreement.first_disagreement.map(|disagreement| {
                let voices = [divergence.voice_a.as_str(), divergence.voice_b.as_str()];
                DisagreementSummary::of(scene, voices, &disagreement)
            }),
            body_position_divergence_max: scene
                .bodies
                .iter()
                .zip(&divergence.body_max)
                .map(named)
                .collect(),
        })
    }
}

impl DisagreementSummary {
    fn of(scene: &Scene, voices: [&str; 2], disagreement: &Disagreement) -> Self {
        let says = |voice: &str, event: Option<Event>| match event {
            Some(event) => format!("{voice} has {}", describe(scene, &event)),
            None => format!("{voice} has no further impact there"),
        };
        let [a, b] = [disagreement.event_a, disagreement.event_b];
        let text = format!("{}, {}", says(voices[0], a), says(voices[1], b));
        Self {
            time_s: disagreement.time(),
            text,
        }
    }
}

/// An impact in words: who, against whom, when.
fn describe(scene: &Scene, event: &Event) -> String {
    let name = |body: usize| crate::error::code(&scene.bodies[body].name);
    let what = match event.kind {
        EventKind::Contact { a, b } => format!("{} hit {}", name(a), name(b)),
        EventKind::Cushion { body, wall } => format!("{} hit cushion {wall}", name(body)),
        EventKind::Rest { body } => format!("{} stop", name(body)),
    };
    format!("{what} at {:.4} s", event.time)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Library;
    use crate::compare::{Limit, Remainder};
    use crate::engine::{DEFAULT_DT, engine};
    use crate::recording::Recording;
    use crate::study::side_by_side;

    fn clusters(
        case: &str,
        truth: impl Fn(&Scene) -> Option<Recording>,
    ) -> Vec<Option<ClusterFacts>> {
        let mut case = Library::Embedded.case(case).unwrap();
        case.truth = truth(&case.scene);
        let comparison = side_by_side(&case, &[engine("lecture").unwrap()], DEFAULT_DT).unwrap();
        let voices = Summary::of(&comparison).voices;
        voices.into_iter().map(|voice| voice.cluster).collect()
    }

    #[test]
    fn cluster_facts_stand_where_bodies_attract_and_collide() {
        let facts = clusters("cluster-8", |_| None)[0].unwrap();
        assert_eq!(facts.until_s, 4.0);
        assert_eq!(
            (facts.largest_clump, facts.bound_bodies),
            (8, 8),
            "{facts:?}"
        );
        assert_eq!(clusters("headon-equal", |_| None), [None]);
    }

    #[test]
    fn a_verdict_is_told_the_limit_of_its_own_engine() {
        let case = Library::Embedded.case("headon-equal").unwrap();
        let comparison = side_by_side(&case, &[engine("lecture").unwrap()], DEFAULT_DT).unwrap();
        let mut summary = Summary::of(&comparison);
        let json =
            |summary: &Summary| serde_json::to_value(summary).unwrap()["verdicts"][0].clone();
        assert!(json(&summary).get("limit").is_none());
        let limit = Limit {
            kind: Remainder::Discretisation,
            stays: None,
            slope: Some(1.0),
            finest: 0.5,
            floor: 1e-12,
        };
        let of = |engine: &str| EngineLimit {
            engine: engine.into(),
            limit: Some(limit),
        };
        summary.tell_limits(&[of("verlet")]);
        assert_eq!(summary.verdicts[0].limit, None);
        summary.tell_limits(&[of("verlet"), of("lecture")]);
        assert_eq!(json(&summary)["limit"]["kind"], "discretisation");
    }

    /// To its own end, the lecture's run has collapsed.
    #[test]
    fn a_voice_that_ends_early_ends_the_facts_of_all() {
        let start = |scene: &Scene| Some(Recording::at_start(crate::case::TRUTH, scene));
        let facts = clusters("cluster-8", start);
        assert_eq!(facts[0].unwrap().until_s, 0.0);
        assert_eq!(facts[0], facts[1]);
    }
}
