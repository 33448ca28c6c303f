//! One case on several engines, on one time grid, compared with each other and with truth.

use rayon::prelude::*;
use serde::Serialize;

use super::bounds::{SAMPLES_COMPARED_MAX, STATES_COMPARED_MAX};
use crate::case::{Case, Evidence};
use crate::compare::{
    ClusterFacts, Divergence, Drift, EventAgreement, Metrics, Sizes, Verdict, cluster_facts,
    compare_events, metrics,
};
use crate::engine::{EngineSpec, record};
use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::scene::Scene;

/// Recordings beside that of a voice that the engine `exact` holds to certify it.
const CERTIFYING: usize = 2;

/// One voice in a comparison: an engine's recording, or truth.
#[derive(Debug, Clone)]
pub struct Voice {
    /// The engine; none for truth.
    pub spec: Option<EngineSpec>,
    /// What it produced.
    pub recording: Recording,
    /// Conserved quantities, sample by sample.
    pub metrics: Vec<Metrics>,
    /// Its own sizes.
    pub scale: Sizes,
    /// How far the conserved quantities drift, as shares of the comparison's scale.
    pub drift: Drift,
}

impl Voice {
    fn new(scene: &Scene, spec: Option<EngineSpec>, recording: Recording) -> Self {
        let metrics = metrics(scene, &recording);
        let scale = Sizes::of(&recording, &metrics);
        let drift = Drift::of(&metrics, &scale);
        Self {
            spec,
            recording,
            metrics,
            scale,
            drift,
        }
    }

    /// Whether it takes steps, as the engines do that are to be judged.
    #[must_use]
    pub fn takes_steps(&self) -> bool {
        self.spec.as_ref().is_some_and(EngineSpec::takes_steps)
    }

    /// The name: an engine's, or `truth`.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.recording.voice
    }
}

/// An engine that cannot do a scene, and why.
#[derive(Debug, Clone, Serialize)]
pub struct Refusal {
    /// The engine.
    pub engine: String,
    /// What it cannot do, and the remedy.
    pub reason: String,
}

/// A case on several engines, compared.
#[derive(Debug, Clone)]
pub struct SideBySide {
    /// The scene.
    pub scene: Scene,
    /// Where the truth comes from, where there is one.
    pub origin: Option<String>,
    /// Who made the truth, where there is one.
    pub evidence: Option<Evidence>,
    /// The largest step asked for, s.
    pub dt: f64,
    /// The engines in the order asked for, then truth.
    pub voices: Vec<Voice>,
    /// The engines that cannot do the scene.
    pub refusals: Vec<Refusal>,
    /// Every pair of voices, in order.
    pub pairs: Vec<(Divergence, EventAgreement)>,
    /// The yardsticks of the comparison.
    pub scale: Sizes,
}

impl SideBySide {
    /// The voice of that name.
    #[must_use]
    pub fn voice(&self, name: &str) -> Option<&Voice> {
        self.voices.iter().find(|voice| voice.name() == name)
    }

    /// The voice that the engines are held against: the exact engine where it ran, else truth.
    #[must_use]
    pub fn reference(&self) -> Option<&Voice> {
        self.voices.iter().find(|voice| !voice.takes_steps())
    }

    /// Who is wrong, from when, and by how much: one verdict for each engine that takes steps.
    #[must_use]
    pub fn verdicts(&self) -> Vec<Verdict> {
        let Some(reference) = self.reference() else {
            return Vec::new();
        };
        let judged = self.voices.iter().filter(|voice| voice.takes_steps());
        let verdict = |voice: &Voice| {
            let (divergence, agreement) = self.pair(voice.name(), reference.name())?;
            Some(Verdict::on(
                &voice.recording,
                &reference.recording,
                divergence,
                agreement,
                self.scale.length,
            ))
        };
        judged.filter_map(verdict).collect()
    }

    /// What became of the cluster in each voice, all at one time; none where the bodies are no
    /// cluster. Shape: `[voice]`.
    #[must_use]
    pub fn cluster_facts(&self) -> Option<Vec<ClusterFacts>> {
        let voices = self.voices.iter();
        let measured = voices.map(|voice| (&voice.recording, voice.metrics.as_slice()));
        cluster_facts(&self.scene, &measured.collect::<Vec<_>>(), &self.scale)
    }

    /// The comparison of two voices, in either order.
    #[must_use]
    pub fn pair(&self, a: &str, b: &str) -> Option<&(Divergence, EventAgreement)> {
        self.pairs
            .iter()
            .find(|(divergence, _)| divergence.is_between(a, b))
    }
}

/// Sees that the recordings of so many voices fit into memory together.
///
/// # Errors
/// [`Error::Scene`] with how many samples would do.
pub fn fits(scene: &Scene, voices: usize) -> Result<()> {
    let samples = scene.sample_count();
    if samples > SAMPLES_COMPARED_MAX {
        return Err(Error::Scene {
            scene: scene.name.clone(),
            message: format!(
                "{samples} samples, more than the {SAMPLES_COMPARED_MAX} that a comparison can \
                 hold; sample less often or shorten `duration`"
            ),
        });
    }
    let recordings = voices.saturating_add(CERTIFYING);
    let states = (scene.sample_count() + 1).saturating_mul(scene.bodies.len());
    let all = recordings.saturating_mul(states);
    if all <= STATES_COMPARED_MAX {
        return Ok(());
    }
    Err(Error::Scene {
        scene: scene.name.clone(),
        message: format!(
            "{} samples of {} bodies in {voices} voices make {all} states to hold with those that \
             certify, more than {STATES_COMPARED_MAX}; take fewer engines, or sample less often",
            scene.sample_count() + 1,
            scene.bodies.len()
        ),
    })
}

/// Runs every engine on a case and compares all voices, pair by pair.
///
/// # Errors
/// As [`record`] and [`fits`], but an engine that refuses the scene or blows up is a result, not an error.
pub fn side_by_side(case: &Case, specs: &[EngineSpec], dt: f64) -> Result<SideBySide> {
    let scene = &case.scene;
    fits(scene, specs.len() + usize::from(case.truth.is_some()))?;
    let recorded: Vec<_> = specs
        .par_iter()
        .map(|spec| (spec, record(scene, spec, dt)))
        .collect();
    let (mut voices, mut refusals) = (Vec::new(), Vec::new());
    for (spec, recording) in recorded {
        match recording {
            Ok(recording) => voices.push(Voice::new(scene, Some(spec.clone()), recording)),
            Err(refusal @ Error::EngineCannot { .. }) => refusals.push(Refusal {
                engine: spec.name.clone(),
                reason: refusal.to_string(),
            }),
            Err(error) => return Err(error),
        }
    }
    // What carom's own engine stored says nothing beside that engine.
    let ran = voices.iter().any(|voice| !voice.takes_steps());
    let evidence = case
        .evidence
        .filter(|evidence| !(ran && *evidence == Evidence::Own));
    let truth = case.truth.iter().filter(|_| evidence.is_some());
    voices.extend(truth.map(|truth| Voice::new(scene, None, truth.clone())));
    let scale = common_scale(&voices);
    for voice in &mut voices {
        voice.drift = Drift::of(&voice.metrics, &scale);
    }
    let recordings: Vec<_> = voices.iter().map(|voice| &voice.recording).collect();
    let later = |a: usize| (a + 1..recordings.len()).map(move |b| (a, b));
    let pairs = (0..recordings.len())
        .flat_map(later)
        .map(|(a, b)| {
            let (a, b) = (recordings[a], recordings[b]);
            (
                Divergence::between(scene, a, b),
                compare_events(scene, a, b),
            )
        })
        .collect();
    Ok(SideBySide {
        scene: scene.clone(),
        origin: case.origin.clone().filter(|_| evidence.is_some()),
        evidence,
        dt,
        scale,
        voices,
        refusals,
        pairs,
    })
}

/// The sizes against which a comparison measures: those of the reference, or without one the
/// smallest of the voices that finished.
fn common_scale(voices: &[Voice]) -> Sizes {
    if let Some(reference) = voices.iter().find(|voice| !voice.takes_steps()) {
        return reference.scale;
    }
    let finished = voices
        .iter()
        .filter(|voice| voice.recording.outcome.is_finished());
    let of_all = || {
        voices
            .iter()
            .map(|voice| voice.scale)
            .reduce(Sizes::smaller)
    };
    let scale = finished.map(|voice| voice.scale).reduce(Sizes::smaller);
    scale.or_else(of_all).unwrap_or_default()
}
