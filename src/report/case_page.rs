//! The page of one case: what was found, the pictures, the tables, the settings.

use serde::Serialize;

use super::format::{code, whole_percent};
use super::template::fill;
use super::{engineering, percent};
use crate::compare::{RIGHT_WITHIN, Verdict};
use crate::error::Result;
use crate::study::{PairSummary, Summary, VoiceSummary};

const TEMPLATE: &str = include_str!("../../templates/case.md");

/// What the template is given.
#[derive(Serialize)]
struct Page<'a> {
    summary: &'a Summary,
    unit: &'static str,
    size: String,
    findings: Vec<String>,
    verdicts: Vec<String>,
    in_report: bool,
    pictures: &'a [&'a str],
    shown: String,
    voices: Vec<VoiceRow>,
    pairs: Vec<PairRow>,
    settings: Vec<Settings>,
}

#[derive(Serialize)]
struct VoiceRow {
    name: String,
    step: String,
    outcome: String,
    contacts: u64,
    cushions: u64,
    rests: u64,
    energy: String,
    momentum: String,
    penetration: String,
    digits: String,
}

#[derive(Serialize)]
struct PairRow {
    names: String,
    position: String,
    relative: String,
    when: String,
    body: String,
    velocity: String,
    energy: String,
    momentum: String,
    matched: usize,
    impact_time: String,
    disagreement: String,
}

#[derive(Serialize)]
struct Settings {
    name: String,
    text: String,
    notes: Vec<String>,
}

/// The page as Markdown.
pub(super) fn case_page(
    summary: &Summary,
    pictures: &[&str],
    shown: &[&str],
    in_report: bool,
) -> Result<String> {
    let unit = summary.length_unit.symbol();
    let page = Page {
        summary,
        unit,
        size: with_unit(summary.scale.length, unit),
        findings: findings(summary, shown)
            .iter()
            .map(|(who, what)| format!("**{who}** {what}"))
            .collect(),
        verdicts: verdicts(summary),
        in_report,
        pictures,
        shown: shown.join(", "),
        voices: summary
            .voices
            .iter()
            .map(|voice| voice_row(summary, voice, unit))
            .collect(),
        pairs: summary
            .pairs
            .iter()
            .map(|pair| pair_row(pair, unit))
            .collect(),
        settings: summary.voices.iter().filter_map(settings).collect(),
    };
    fill(TEMPLATE, page)
}

/// What was found about these voices: who, and what about them.
#[must_use]
pub fn findings(summary: &Summary, voices: &[&str]) -> Vec<(String, String)> {
    let mut found: Vec<_> = summary
        .voices
        .iter()
        .filter(|voice| !voice.outcome.is_finished())
        .map(|voice| {
            (
                voice.voice.clone(),
                format!("did not finish: {}.", voice.outcome_text),
            )
        })
        .collect();
    let undetermined = summary.voices.iter().filter_map(|voice| {
        let from = voice.undetermined.as_ref()?;
        let apart = |spread| with_unit(spread, summary.length_unit.symbol());
        let spread = from.spread.map_or_else(
            || "elsewhere".to_owned(),
            |spread| format!("up to {} apart", apart(spread)),
        );
        let time = engineering(from.time);
        let told = format!(
            "finds the scene undetermined by the model from {time} s on: simultaneous events in \
             another order end {spread}, and no engine is called wrong for it."
        );
        Some((voice.voice.clone(), told))
    });
    found.extend(undetermined);
    let warned = summary.voices.iter().flat_map(|voice| {
        let warning = |text: &String| (voice.voice.clone(), format!("bends the scene: {text}."));
        voice.warnings.iter().map(warning)
    });
    found.extend(warned);
    found.extend(summary.refusals.iter().map(|refusal| {
        (
            refusal.engine.clone(),
            format!("refused: {}.", refusal.reason),
        )
    }));
    for (place, a) in voices.iter().enumerate() {
        let pairs = voices[place + 1..]
            .iter()
            .filter_map(|b| summary.pair(a, b));
        found.extend(pairs.map(|pair| parting(summary, pair)));
    }
    found
}

/// Who is wrong, from when and by how much, a sentence each.
fn verdicts(summary: &Summary) -> Vec<String> {
    let unit = summary.length_unit.symbol();
    let sentence = |verdict: &Verdict| {
        let error = format!(
            "{} ({} of the size)",
            with_unit(verdict.error_max, unit),
            percent(verdict.error_relative)
        );
        let mut off = Vec::new();
        off.extend(verdict.wrong_from_s.map(|time| {
            let off = whole_percent(RIGHT_WITHIN);
            format!("more than {off} off from {} s on", engineering(time))
        }));
        off.extend(
            verdict
                .other_story_from_s
                .map(|time| format!("other impacts from {} s on", engineering(time))),
        );
        off.extend(
            verdict
                .stopped_at_s
                .map(|time| format!("stopped at {} s", engineering(time))),
        );
        if off.is_empty() {
            format!("{} stays within {error}.", code(&verdict.engine))
        } else {
            let off = off.join(", ");
            format!(
                "{} leaves it: {off}; at most {error}.",
                code(&verdict.engine)
            )
        }
    };
    summary.verdicts.iter().map(sentence).collect()
}

fn parting(summary: &Summary, pair: &PairSummary) -> (String, String) {
    let told = match &pair.first_disagreement {
        Some(first) => {
            format!(
                "; from {:.4} s on they tell another story: {}",
                first.time_s, first.text
            )
        }
        None if pair.impacts_matched > 0 => {
            format!("; all {} impacts match in order", pair.impacts_matched)
        }
        None => String::new(),
    };
    let until = if pair.compared_until_s < summary.duration_s {
        format!(", compared until {} s", engineering(pair.compared_until_s))
    } else {
        String::new()
    };
    let what = format!(
        "are at most {} apart ({} of the scene's size), {} at {} s{until}{told}.",
        with_unit(pair.position_divergence_max, summary.length_unit.symbol()),
        percent(pair.position_divergence_relative),
        code(&pair.worst_body),
        engineering(pair.at_time_s),
    );
    (format!("{} and {}", pair.engine_a, pair.engine_b), what)
}

fn voice_row(summary: &Summary, voice: &VoiceSummary, unit: &str) -> VoiceRow {
    let drift = &voice.drift;
    let energy = if summary.model_conserves_energy {
        format!("drift {}", percent(drift.energy_drift_max))
    } else {
        format!("change {}", percent(drift.energy_change))
    };
    let momentum = if summary.model_conserves_momentum {
        format!("drift {}", percent(drift.momentum_drift_max))
    } else {
        "not kept by the model".to_owned()
    };
    VoiceRow {
        name: voice.voice.clone(),
        step: voice
            .step_s
            .map_or("none".into(), |step| format!("{} s", engineering(step))),
        outcome: voice.outcome.word().to_owned(),
        contacts: voice.events.contacts,
        cushions: voice.events.cushions,
        rests: voice.events.rests,
        energy,
        momentum,
        digits: voice.digits_min.map_or("–".into(), |digits| {
            format!("{} / {}", digits.position, digits.velocity)
        }),
        penetration: with_unit(drift.max_penetration, unit),
    }
}

fn pair_row(pair: &PairSummary, unit: &str) -> PairRow {
    let speed = if unit.is_empty() {
        String::new()
    } else {
        format!("{unit}/s")
    };
    PairRow {
        names: format!("{} – {}", pair.engine_a, pair.engine_b),
        position: with_unit(pair.position_divergence_max, unit),
        relative: percent(pair.position_divergence_relative),
        when: format!("{} s", engineering(pair.at_time_s)),
        body: pair.worst_body.clone(),
        velocity: with_unit(pair.velocity_divergence_rms_max, &speed),
        energy: percent(pair.energy_difference_max),
        momentum: percent(pair.momentum_difference_max),
        matched: pair.impacts_matched,
        impact_time: format!("{} s", engineering(pair.impact_time_difference_max_s)),
        disagreement: pair
            .first_disagreement
            .as_ref()
            .map_or("none".to_owned(), |first| first.text.clone()),
    }
}

fn settings(voice: &VoiceSummary) -> Option<Settings> {
    let engine = voice.engine.as_ref()?;
    Some(Settings {
        name: voice.voice.clone(),
        text: engine.describe(),
        notes: voice.notes.clone(),
    })
}

/// A length with its unit.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", engineering(value))
        .trim_end()
        .to_owned()
}
