//! Who is wrong, from when, and by how much.

use serde::Serialize;

use super::{Divergence, EventAgreement, Limit, Sizes};
use crate::recording::Recording;

/// An engine counts as right while it stays within this share of the scene's size of the
/// reference.
pub const RIGHT_WITHIN: f64 = 0.01;

/// How an engine stands against a reference: the exact engine, or independent truth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// The engine.
    pub engine: String,
    /// What it is held against.
    pub reference: String,
    /// When it first leaves the reference by more than [`RIGHT_WITHIN`] of the size, s.
    pub wrong_from_s: Option<f64>,
    /// When it first has another impact than the reference, s.
    pub other_story_from_s: Option<f64>,
    /// Largest distance of a body from the reference, scene length unit.
    pub error_max: f64,
    /// The same over the scene's size.
    pub error_relative: f64,
    /// When the engine stopped before the reference did, s.
    pub stopped_at_s: Option<f64>,
    /// Until when the reference vouches for its positions, s; later nobody is called wrong.
    pub comparable_until_s: f64,
    /// What is left of the error as the step goes to 0, where a study of cost has told.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<Limit>,
}

impl Verdict {
    /// The verdict on an engine, given how it parts from the reference.
    #[must_use]
    pub fn on(
        engine: &Recording,
        reference: &Recording,
        divergence: &Divergence,
        agreement: &EventAgreement,
        size: f64,
    ) -> Self {
        let largest = divergence.largest();
        let comparable_until_s = divergence.samples[divergence.comparable - 1].time;
        let story = agreement.first_disagreement.map(|first| first.time());
        Self {
            engine: engine.voice.clone(),
            reference: reference.voice.clone(),
            wrong_from_s: divergence.first_beyond(RIGHT_WITHIN * size),
            other_story_from_s: story.filter(|time| *time <= comparable_until_s),
            error_max: largest.max_position,
            error_relative: Sizes::share(largest.max_position, size),
            stopped_at_s: (engine.sample_count() < reference.sample_count())
                .then(|| divergence.samples[divergence.samples.len() - 1].time),
            comparable_until_s,
            limit: None,
        }
    }

    /// Whether the engine stays right as long as the reference vouches for itself.
    #[must_use]
    pub fn is_right(&self) -> bool {
        self.wrong_from_s.is_none()
            && self.other_story_from_s.is_none()
            && self.stopped_at_s.is_none()
    }
}
