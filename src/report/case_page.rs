//! The page of one case: what was found, the pictures, the tables, the settings.

use serde::Serialize;

use super::format::{code, whole_percent};
use super::models::other_models;
use super::studies::CaseStudies;
use super::template::fill;
use super::{engineering, limits, percent};
use crate::case::TRUTH;
use crate::compare::{ClusterFacts, RIGHT_WITHIN, TOUCHING, Verdict};
use crate::error::Result;
use crate::recording::Concession;
use crate::study::{PairSummary, Summary, VoiceSummary};

const TEMPLATE: &str = include_str!("../../templates/case.md");

/// What the template is given.
#[derive(Serialize)]
struct Page<'a> {
    summary: &'a Summary,
    unit: &'static str,
    size: String,
    /// Who computes another model than the scene's, and which.
    models: Vec<String>,
    findings: Vec<String>,
    verdicts: Vec<String>,
    /// None for a page that stands alone.
    studies: Option<CaseStudies>,
    pictures: &'a [&'a str],
    shown: String,
    voices: Vec<VoiceRow>,
    cluster: Option<ClusterTable>,
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
    angular_momentum: String,
    penetration: String,
    digits: String,
}

/// What became of the cluster in each voice, the reference first.
#[derive(Serialize)]
struct ClusterTable {
    until: String,
    touching: String,
    rows: Vec<ClusterRow>,
}

#[derive(Serialize)]
struct ClusterRow {
    name: String,
    collapse: String,
    energy_lost: String,
    clump: usize,
    bound: usize,
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
    angular_momentum: String,
    matched: usize,
    impact_time: String,
    impulse: String,
    disagreement: String,
}

#[derive(Serialize)]
struct Settings {
    name: String,
    text: String,
    notes: Vec<String>,
}

/// The page as Markdown; `studies` are those of the report that it stands in.
pub(super) fn case_page(
    summary: &Summary,
    pictures: &[&str],
    shown: &[&str],
    studies: Option<CaseStudies>,
) -> Result<String> {
    let unit = summary.length_unit.symbol();
    let page = Page {
        summary,
        unit,
        size: with_unit(summary.scale.length, unit),
        models: other_models(summary),
        findings: findings(summary, shown)
            .iter()
            .map(|(who, what)| format!("**{who}** {what}"))
            .collect(),
        verdicts: verdicts(summary),
        studies,
        pictures,
        shown: shown.join(", "),
        voices: summary
            .voices
            .iter()
            .map(|voice| voice_row(summary, voice, unit))
            .collect(),
        cluster: cluster_table(summary),
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
             another order end {spread}, and no engine is held to it from there."
        );
        Some((voice.voice.clone(), told))
    });
    found.extend(undetermined);
    let gave_way = summary.voices.iter().flat_map(|voice| {
        let told = |concession: &Concession| {
            (
                voice.voice.clone(),
                format!("gave way to go on: {concession}."),
            )
        };
        voice.concessions.iter().map(told)
    });
    found.extend(gave_way);
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

/// Who deviates from the reference, from when and by how much, a sentence each.
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
        let stands = if off.is_empty() {
            format!("{} stays within {error}.", code(&verdict.engine))
        } else {
            let off = off.join(", ");
            format!(
                "{} deviates from it: {off}; by at most {error}.",
                code(&verdict.engine)
            )
        };
        let voice = summary.voice(&verdict.engine);
        if voice.is_some_and(|voice| voice.another_model.is_some()) {
            return format!("{stands} It computes another model, so that this is no error.");
        }
        match &verdict.limit {
            Some(limit) => format!("{stands} {}", limits::sentence(limit, unit)),
            None => stands,
        }
    };
    let engines = summary.verdicts.iter().map(sentence);
    engines.chain(against_truth(summary)).collect()
}

/// How the reference itself stands against truth, if it is another voice.
fn against_truth(summary: &Summary) -> Option<String> {
    let reference = summary.reference.as_ref()?;
    let pair = summary.pair(reference, TRUTH)?;
    let apart = if pair.position_divergence_max == 0.0 {
        "agree in every digit".to_owned()
    } else {
        let most = with_unit(pair.position_divergence_max, summary.length_unit.symbol());
        let share = percent(pair.position_divergence_relative);
        format!("differ by at most {most} ({share} of the size)")
    };
    let impacts = match pair.impacts_matched {
        0 => String::new(),
        1 => ", with one impact in common".to_owned(),
        many => format!(", with {many} impacts in common"),
    };
    let until = engineering(pair.compared_until_s);
    Some(format!(
        "The independent truth and {reference} {apart} up to {until} s{impacts}."
    ))
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
    let angular_momentum = if summary.model_conserves_angular_momentum {
        format!("drift {}", percent(drift.angular_momentum_drift_max))
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
        angular_momentum,
        digits: voice.digits_min.map_or("–".into(), |digits| {
            format!("{} / {}", digits.position, digits.velocity)
        }),
        penetration: with_unit(drift.max_penetration, unit),
    }
}

fn cluster_table(summary: &Summary) -> Option<ClusterTable> {
    let is_reference = |voice: &VoiceSummary| summary.reference.as_ref() == Some(&voice.voice);
    let (first, others): (Vec<_>, Vec<_>) =
        summary.voices.iter().partition(|voice| is_reference(voice));
    let voices = first.into_iter().chain(others);
    let facts = voices.filter_map(|voice| Some((voice, voice.cluster?)));
    let facts: Vec<_> = facts.collect();
    let row = |(voice, facts): &(&VoiceSummary, ClusterFacts)| ClusterRow {
        name: if is_reference(voice) {
            format!("{} (reference)", voice.voice)
        } else {
            voice.voice.clone()
        },
        collapse: facts
            .collapse_time_s
            .map_or("–".into(), |time| format!("{} s", engineering(time))),
        energy_lost: percent(facts.energy_lost),
        clump: facts.largest_clump,
        bound: facts.bound_bodies,
    };
    // One time for all, as `cluster_facts` has it.
    let (_, any) = facts.first()?;
    Some(ClusterTable {
        until: format!("{} s", engineering(any.until_s)),
        touching: whole_percent(TOUCHING),
        rows: facts.iter().map(row).collect(),
    })
}

fn pair_row(pair: &PairSummary, unit: &str) -> PairRow {
    let speed = if unit.is_empty() {
        String::new()
    } else {
        format!("{unit}/s")
    };
    let matched = |difference: String| {
        if pair.impacts_matched > 0 {
            difference
        } else {
            "–".to_owned()
        }
    };
    PairRow {
        names: format!("{} – {}", pair.engine_a, pair.engine_b),
        position: with_unit(pair.position_divergence_max, unit),
        relative: percent(pair.position_divergence_relative),
        when: format!("{} s", engineering(pair.at_time_s)),
        body: code(&pair.worst_body),
        velocity: with_unit(pair.velocity_divergence_rms_max, &speed),
        energy: percent(pair.energy_difference_max),
        momentum: percent(pair.momentum_difference_max),
        angular_momentum: percent(pair.angular_momentum_difference_max),
        matched: pair.impacts_matched,
        impact_time: matched(format!(
            "{} s",
            engineering(pair.impact_time_difference_max_s)
        )),
        impulse: matched(percent(pair.impulse_difference_max)),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Library;
    use crate::compare::{Limit, Remainder};
    use crate::engine::{DEFAULT_DT, engine};
    use crate::recording::Recording;
    use crate::study::cost::EngineLimit;
    use crate::study::side_by_side;

    /// The page of a case on the lecture's engine, with this truth if any.
    fn page(case: &str, truth: Option<fn(&crate::scene::Scene) -> Recording>) -> String {
        let mut case = Library::Embedded.case(case).unwrap();
        if let Some(truth) = truth {
            case.truth = Some(truth(&case.scene));
        }
        let comparison = side_by_side(&case, &[engine("lecture").unwrap()], DEFAULT_DT).unwrap();
        case_page(&Summary::of(&comparison), &[], &["lecture"], None).unwrap()
    }

    /// The cells of the table that has this in its first row: `[row][cell]`, without the rule.
    fn table(page: &str, header: &str) -> Vec<Vec<String>> {
        let lines = page.lines().skip_while(|line| !line.contains(header));
        let cells = |line: &str| line.split('|').map(|cell| cell.trim().to_owned()).collect();
        lines
            .take_while(|line| line.starts_with('|'))
            .filter(|line| !line.starts_with("|---"))
            .map(cells)
            .collect()
    }

    #[test]
    fn the_cluster_table_names_its_time_and_the_reference_first() {
        let page = page("cluster-8", Some(|scene| Recording::at_start(TRUTH, scene)));
        assert!(page.contains("## The cluster until 0 s"), "{page}");
        let rows = table(&page, "time of collapse");
        let names: Vec<_> = rows.iter().map(|row| row[1].as_str()).collect();
        assert_eq!(names, ["voice", "truth (reference)", "lecture"]);
        assert_eq!(rows[1][2..], rows[2][2..]);
    }

    #[test]
    fn a_verdict_says_what_kind_of_error_it_is_about() {
        let case = Library::Embedded.case("headon-equal").unwrap();
        let comparison = side_by_side(&case, &[engine("lecture").unwrap()], DEFAULT_DT).unwrap();
        let mut summary = Summary::of(&comparison);
        let limit = Limit {
            kind: Remainder::Discretisation,
            stays: None,
            slope: Some(1.0),
            finest: 1e-3,
            floor: 1e-12,
        };
        let page = |summary: &Summary| case_page(summary, &[], &["lecture"], None).unwrap();
        assert!(!page(&summary).contains("The error is"));
        summary.tell_limits(&[EngineLimit {
            engine: "lecture".into(),
            limit: Some(limit),
        }]);
        let told = "of the size). The error is *discretisation*: it shrinks with the step";
        assert!(page(&summary).contains(told), "{}", page(&summary));
    }

    /// An oblique impact that is seen late has another line of centres, so another impulse.
    /// Without a matched impact there is no difference, rather than one of zero.
    #[test]
    fn matched_impacts_show_how_far_time_and_impulse_are_off() {
        let pair = |page: &str| {
            let rows = table(page, "largest impulse difference");
            let column = |name: &str| rows[0].iter().position(|cell| cell == name).unwrap();
            [
                "impacts matched",
                "largest time difference",
                "largest impulse difference",
            ]
            .map(|name| rows[1][column(name)].clone())
        };
        let oblique = pair(&page("oblique-elastic", None));
        assert_eq!(oblique[0], "1");
        assert!(
            oblique[1].ends_with(" s") && oblique[1] != "0 s",
            "{oblique:?}"
        );
        assert!(
            oblique[2].ends_with(" %") && oblique[2] != "0 %",
            "{oblique:?}"
        );
        assert_eq!(pair(&page("kepler-circle", None)), ["0", "–", "–"]);
    }
}
