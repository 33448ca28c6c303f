//! The index of a report: what was found over all cases, and a row for each.

use std::collections::BTreeMap;

use serde::Serialize;

use super::case_page::with_unit;
use super::format::{code, whole_percent};
use super::studies::StudyNote;
use super::template::{fill, plain_text};
use super::{Folder, Studies, engineering, percent};
use crate::case::{Evidence, TRUTH};
use crate::compare::{RIGHT_WITHIN, Remainder};
use crate::engine::EngineSpec;
use crate::error::Result;
use crate::study::{PairSummary, Summary, VoiceSummary, median};

const TEMPLATE: &str = include_str!("../../templates/index.md");

/// Two voices are far apart beyond this share of the scene's size.
const FAR_APART: f64 = 0.25;

/// What the template is given.
#[derive(Serialize)]
struct Page<'a> {
    findings: Vec<String>,
    telling: Option<Telling>,
    first: &'a str,
    second: &'a str,
    engines: Vec<EngineRow>,
    rows: Vec<Row>,
    reference_rows: Vec<ReferenceRow>,
    /// Whether a study of cost has told what kinds of error there are.
    told: bool,
    studies: Vec<StudyNote>,
    versions: BTreeMap<&'static str, &'static str>,
    dt: String,
    cases: usize,
    with_truth: usize,
    pictures: bool,
}

#[derive(Serialize)]
struct Telling {
    scene: String,
    title: String,
    caption: String,
}

#[derive(Serialize)]
struct EngineRow {
    name: String,
    takes_steps: bool,
    summary: &'static str,
    settings: String,
}

#[derive(Serialize)]
struct Row {
    scene: String,
    title: String,
    divergence: String,
    relative: String,
    energy: [String; 2],
    momentum: [String; 2],
    disagreement: String,
    trouble: String,
}

#[derive(Serialize)]
struct ReferenceRow {
    scene: String,
    reference: String,
    errors: Vec<String>,
}

/// All figures of a report, for programs.
#[derive(Serialize)]
struct Everything<'a> {
    versions: BTreeMap<&'static str, &'static str>,
    dt_s: f64,
    engines: &'a [EngineSpec],
    cases: &'a [Summary],
}

/// The files of the index.
pub const INDEX_FILES: [&str; 2] = ["README.md", "summary.json"];

/// Writes `README.md` and `summary.json` of a report.
///
/// # Errors
/// A file that cannot be written, with its name.
pub fn write_index(
    folder: &Folder,
    summaries: &[Summary],
    engines: &[EngineSpec],
    dt: f64,
    studies: &Studies,
) -> Result<()> {
    let page = index_page(summaries, engines, dt, studies)?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))?;
    let everything = Everything {
        versions: crate::engine::versions(),
        dt_s: dt,
        engines,
        cases: summaries,
    };
    folder.write_summary(&everything)
}

/// The index as Markdown. The first two engines are the ones that its table compares.
///
/// # Errors
/// A fault of the template.
pub fn index_page(
    summaries: &[Summary],
    engines: &[EngineSpec],
    dt: f64,
    studies: &Studies,
) -> Result<String> {
    let name = |place: usize| engines.get(place).map_or("", |spec| spec.name.as_str());
    let (first, second) = (name(0), name(1));
    let telling = most_telling(summaries, first, second);
    let page = Page {
        findings: findings(summaries, engines),
        telling: telling.map(|(summary, pair)| Telling {
            scene: summary.scene.clone(),
            title: summary.title.clone(),
            caption: caption(summary, pair),
        }),
        first,
        second,
        engines: engines
            .iter()
            .map(|spec| EngineRow {
                name: spec.name.clone(),
                takes_steps: spec.takes_steps(),
                summary: spec.summary,
                settings: spec.describe(),
            })
            .collect(),
        rows: summaries
            .iter()
            .map(|summary| row(summary, first, second))
            .collect(),
        reference_rows: summaries
            .iter()
            .filter_map(|summary| reference_row(summary, engines))
            .collect(),
        told: remainders(summaries, engines).is_some(),
        studies: studies.notes(),
        versions: crate::engine::versions(),
        dt: engineering(dt),
        cases: summaries.len(),
        with_truth: summaries
            .iter()
            .filter(|summary| summary.evidence == Some(Evidence::Independent))
            .count(),
        pictures: cfg!(feature = "plots"),
    };
    fill(TEMPLATE, page)
}

/// The case whose picture says most: of those in which two engines disagree about the course
/// of events and end up far apart, the one with the fewest impacts, for it is read most
/// easily. Where there is none, the one in which they are farthest apart.
fn most_telling<'a>(
    summaries: &'a [Summary],
    first: &str,
    second: &str,
) -> Option<(&'a Summary, &'a PairSummary)> {
    let pairs = summaries
        .iter()
        .filter_map(|summary| Some((summary, summary.pair(first, second)?)));
    let pairs: Vec<_> = pairs.collect();
    let impacts = |(summary, _): &(&Summary, &PairSummary)| {
        let events = summary.voices.iter().map(|voice| voice.events);
        events
            .map(|events| events.contacts + events.cushions)
            .sum::<u64>()
    };
    let tells = |(_, pair): &&(&Summary, &PairSummary)| {
        pair.first_disagreement.is_some() && pair.position_divergence_relative > FAR_APART
    };
    let distance = |(_, pair): &(&Summary, &PairSummary)| pair.position_divergence_relative;
    let readable = pairs.iter().filter(tells).min_by_key(|case| impacts(case));
    let farthest = || {
        pairs
            .iter()
            .max_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    readable.or_else(farthest).copied()
}

fn caption(summary: &Summary, pair: &PairSummary) -> String {
    let unit = summary.length_unit.symbol();
    let told = pair
        .first_disagreement
        .as_ref()
        .map_or(String::new(), |first| {
            format!(" The first impact on which they disagree: {}.", first.text)
        });
    format!(
        "{}: {} and {} part by {} ({} of the scene's size).{told}",
        plain_text(&summary.title),
        pair.engine_a,
        pair.engine_b,
        with_unit(pair.position_divergence_max, unit),
        percent(pair.position_divergence_relative)
    )
}

/// What was found, a sentence each, all counted here and now.
fn findings(summaries: &[Summary], engines: &[EngineSpec]) -> Vec<String> {
    let mut sentences = Vec::new();
    if let [first, second, ..] = engines {
        sentences.extend(parting(summaries, &first.name, &second.name));
    }
    sentences.extend(energy_drifts(summaries, engines));
    sentences.extend(verdicts(summaries, engines));
    sentences.extend(remainders(summaries, engines));
    let unfinished: Vec<_> = summaries
        .iter()
        .flat_map(|summary| summary.voices.iter().map(move |voice| (summary, voice)))
        .filter(|(_, voice)| !voice.outcome.is_finished())
        .map(|(summary, voice)| {
            format!(
                "{} in `{}`: {}",
                voice.voice, summary.scene, voice.outcome_text
            )
        })
        .collect();
    let refused: Vec<_> = summaries
        .iter()
        .flat_map(|summary| {
            summary
                .refusals
                .iter()
                .map(move |refusal| (summary, refusal))
        })
        .map(|(summary, refusal)| format!("{} refused `{}`", refusal.engine, summary.scene))
        .collect();
    if !refused.is_empty() {
        sentences.push(format!("{}.", refused.join("; ")));
    } else if unfinished.is_empty() {
        sentences.push("Every engine finished every case.".into());
    }
    if !unfinished.is_empty() {
        sentences.push(format!("Not finished: {}.", unfinished.join("; ")));
    }
    sentences
}

fn parting(summaries: &[Summary], first: &str, second: &str) -> Option<String> {
    let pairs: Vec<_> = summaries
        .iter()
        .filter_map(|summary| Some((summary, summary.pair(first, second)?)))
        .collect();
    let farthest = pairs.iter().max_by(|(_, a), (_, b)| {
        a.position_divergence_relative
            .total_cmp(&b.position_divergence_relative)
    })?;
    let together = pairs
        .iter()
        .filter(|(_, p)| p.position_divergence_relative <= RIGHT_WITHIN)
        .count();
    let stories = pairs
        .iter()
        .filter(|(_, pair)| pair.first_disagreement.is_some())
        .count();
    let (summary, pair) = farthest;
    Some(format!(
        "In {together} of {} cases `{first}` and `{second}` stay within {} of the scene's size of each \
         other; in {stories} they disagree about which impact comes next. They part most in \
         [{}]({}/README.md), by {} ({} of its size).",
        pairs.len(),
        whole_percent(RIGHT_WITHIN),
        plain_text(&summary.title),
        summary.scene,
        with_unit(pair.position_divergence_max, summary.length_unit.symbol()),
        percent(pair.position_divergence_relative),
    ))
}

/// The worst drift of energy of each engine where the model keeps it.
fn energy_drifts(summaries: &[Summary], engines: &[EngineSpec]) -> Option<String> {
    let worst = |spec: &EngineSpec| {
        let drifts = summaries
            .iter()
            .filter(|summary| summary.model_conserves_energy);
        let drifts = drifts.filter_map(|summary| {
            let voice = summary
                .voices
                .iter()
                .find(|voice| voice.voice == spec.name)?;
            Some((voice.drift.energy_drift_max, &summary.scene))
        });
        let (drift, scene) = drifts.max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(format!("`{}` {} in `{scene}`", spec.name, percent(drift)))
    };
    let worst: Vec<_> = engines.iter().filter_map(worst).collect();
    let said = format!(
        "Where the model keeps the energy, it drifts by up to: {}.",
        worst.join(", ")
    );
    (!worst.is_empty()).then_some(said)
}

/// How often each engine is right, and its middle error.
fn verdicts(summaries: &[Summary], engines: &[EngineSpec]) -> Option<String> {
    let judged = summaries
        .iter()
        .filter(|summary| !summary.verdicts.is_empty());
    let count = judged.count();
    let of_engine = |spec: &EngineSpec| {
        let all = summaries.iter().flat_map(|summary| &summary.verdicts);
        let own: Vec<_> = all.filter(|verdict| verdict.engine == spec.name).collect();
        let right = own.iter().filter(|verdict| verdict.is_right()).count();
        let errors: Vec<_> = own.iter().map(|verdict| verdict.error_relative).collect();
        if errors.is_empty() {
            return None;
        }
        let middle = percent(median(&errors));
        Some(format!(
            "`{}` in {right} (median error {middle})",
            spec.name
        ))
    };
    let rows: Vec<_> = engines.iter().filter_map(of_engine).collect();
    let said = format!(
        "In {count} cases the right answer is known. The engines stay within {} of the scene's \
         size of it, with every impact in order: {}.",
        whole_percent(RIGHT_WITHIN),
        rows.join(", ")
    );
    (!rows.is_empty()).then_some(said)
}

/// How often each engine's error is of which kind, where a study of cost has told.
fn remainders(summaries: &[Summary], engines: &[EngineSpec]) -> Option<String> {
    let of_engine = |spec: &EngineSpec| {
        let all = summaries.iter().flat_map(|summary| &summary.verdicts);
        let own = all.filter(|verdict| verdict.engine == spec.name);
        let limits: Vec<_> = own.filter_map(|verdict| verdict.limit).collect();
        let count = |kind: Remainder| limits.iter().filter(|limit| limit.kind == kind).count();
        let kinds = Remainder::ALL.into_iter().filter(|kind| count(*kind) > 0);
        let told: Vec<_> = kinds
            .map(|kind| format!("*{}* in {}", kind.word(), count(kind)))
            .collect();
        (!told.is_empty()).then(|| format!("{} {}", code(&spec.name), told.join(", ")))
    };
    let rows: Vec<_> = engines.iter().filter_map(of_engine).collect();
    let said = format!(
        "What is left of the error as the step goes to 0 is: {}.",
        rows.join("; ")
    );
    (!rows.is_empty()).then_some(said)
}

fn row(summary: &Summary, first: &str, second: &str) -> Row {
    let unit = summary.length_unit.symbol();
    let voice = |name: &str| summary.voices.iter().find(|voice| voice.voice == name);
    let both = [first, second].map(voice);
    let nothing = || "–".to_owned();
    let energy = |voice: &VoiceSummary| {
        if summary.model_conserves_energy {
            percent(voice.drift.energy_drift_max)
        } else {
            format!("({})", percent(voice.drift.energy_change))
        }
    };
    let momentum = |voice: &VoiceSummary| {
        if summary.model_conserves_momentum {
            percent(voice.drift.momentum_drift_max)
        } else {
            nothing()
        }
    };
    let pair = summary.pair(first, second);
    let unfinished = both
        .iter()
        .flatten()
        .filter(|voice| !voice.outcome.is_finished());
    let troubles = unfinished.map(|voice| format!("{}: {}", voice.voice, voice.outcome.word()));
    let refused = summary
        .refusals
        .iter()
        .map(|refusal| format!("{}: refused", refusal.engine));
    Row {
        scene: summary.scene.clone(),
        title: summary.title.clone(),
        divergence: pair.map_or_else(nothing, |p| with_unit(p.position_divergence_max, unit)),
        relative: pair.map_or_else(nothing, |p| percent(p.position_divergence_relative)),
        energy: both.map(|voice| voice.map_or_else(nothing, energy)),
        momentum: both.map(|voice| voice.map_or_else(nothing, momentum)),
        disagreement: pair.map_or_else(nothing, disagreement),
        trouble: troubles.chain(refused).collect::<Vec<_>>().join(", "),
    }
}

fn disagreement(pair: &PairSummary) -> String {
    match &pair.first_disagreement {
        Some(first) => first.text.clone(),
        None if pair.impacts_matched > 0 => "none".to_owned(),
        None => "no impacts".to_owned(),
    }
}

fn reference_row(summary: &Summary, engines: &[EngineSpec]) -> Option<ReferenceRow> {
    let reference = summary.reference.as_ref()?;
    let unit = summary.length_unit.symbol();
    let cell = |spec: &EngineSpec| {
        // The exact engine is itself the reference; it is held against truth.
        let against = if spec.takes_steps() {
            reference.as_str()
        } else {
            TRUTH
        };
        let Some(pair) = summary.pair(&spec.name, against) else {
            return "–".to_owned();
        };
        let error = with_unit(pair.position_divergence_max, unit);
        let mut verdicts = summary.verdicts.iter();
        let own = verdicts.find(|verdict| verdict.engine == spec.name);
        match own.and_then(|verdict| verdict.limit) {
            Some(limit) => format!("{error}, *{}*", limit.kind.word()),
            None => error,
        }
    };
    Some(ReferenceRow {
        scene: summary.scene.clone(),
        reference: reference.clone(),
        errors: engines.iter().map(cell).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Library;
    use crate::compare::Limit;
    use crate::engine::{DEFAULT_DT, engine};
    use crate::study::cost::EngineLimit;
    use crate::study::side_by_side;

    #[test]
    fn the_index_counts_the_kinds_of_error_and_names_each() {
        let engines = [engine("lecture").unwrap(), engine("exact-fast").unwrap()];
        let summary = |case: &str| {
            let case = Library::Embedded.case(case).unwrap();
            Summary::of(&side_by_side(&case, &engines, DEFAULT_DT).unwrap())
        };
        let mut summaries = [summary("headon-equal"), summary("kepler-circle")];
        let page = |summaries: &[Summary]| {
            index_page(summaries, &engines, DEFAULT_DT, &Studies::default()).unwrap()
        };
        assert!(!page(&summaries).contains("What is left of the error"));
        summaries[1].tell_limits(&[EngineLimit {
            engine: "lecture".into(),
            limit: Some(Limit {
                kind: Remainder::Discretisation,
                stays: None,
                slope: Some(1.0),
                finest: 1e-3,
                floor: 1e-12,
            }),
        }]);
        let page = page(&summaries);
        assert!(
            page.contains("as the step goes to 0 is: `lecture` *discretisation* in 1."),
            "{page}"
        );
        let cells = page
            .lines()
            .filter(|line| line.contains(", *discretisation* |"));
        assert_eq!(cells.count(), 1, "{page}");
    }
}
