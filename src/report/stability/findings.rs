//! What a study of stability has found, in sentences.

use crate::report::format::engineering;
use crate::study::stability::{Judged, StabilityStudy, StabilitySummary};

/// The engine that was tuned on the hard cases.
const ROBUST: &str = "robust";

/// The finding that the index of a report tells.
pub(in crate::report) fn headline(summary: &StabilitySummary) -> String {
    let told = summary
        .scores
        .iter()
        .map(|score| format!("`{}` {} of {}", score.engine, score.held, score.run));
    format!(
        "{} hard cases, {} runs of an engine that takes steps (each case at its own steps, of which \
         `expected.toml` tells); every bound holds in so many of the runs that an engine did not \
         refuse: {}.{}",
        summary.cases,
        summary.runs(),
        told.collect::<Vec<_>>().join(", "),
        caveat(summary)
    )
}

/// What must stand wherever the score of `robust` does.
fn caveat(summary: &StabilitySummary) -> &'static str {
    if summary.scores.iter().any(|score| score.engine == ROBUST) {
        " The constants of `robust` were set on these very cases, so that its score is no \
         independent evidence."
    } else {
        ""
    }
}

/// What the study has found, a sentence each.
#[must_use]
pub fn stability_findings(study: &StabilityStudy, summary: &StabilitySummary) -> Vec<String> {
    let mut findings = vec![headline(summary)];
    let all: Vec<_> = summary
        .scores
        .iter()
        .filter(|score| score.cases_held == summary.cases)
        .map(|score| format!("`{}`", score.engine))
        .collect();
    findings.push(match &all[..] {
        [] => "No engine holds every case at every step.".to_owned(),
        [one] => format!("{one} alone holds every case at every step."),
        many => format!("{} hold every case at every step.", many.join(" and ")),
    });
    findings.extend(
        study
            .engines
            .iter()
            .filter_map(|spec| common(study, &spec.name)),
    );
    findings
}

/// How an engine mostly fails, and which phase of its own did it most often.
fn common(study: &StabilityStudy, engine: &str) -> Option<String> {
    let failed = || {
        let cells = study.cells.iter();
        cells.filter(|judged| {
            judged.cell.engine == engine && judged.cell.was_run() && !judged.cell.holds()
        })
    };
    let (outcome, count) = most(failed().map(|judged| judged.cell.outcome.clone()))?;
    let phases = failed().filter(|judged| judged.cell.outcome == "EnergyGrew");
    let heated = most(phases.filter_map(|judged| judged.phase.clone()));
    let heated = heated.map_or(String::new(), |(phase, count)| {
        format!("; where its energy grows, {phase} gives most of it in {count}")
    });
    Some(format!(
        "`{engine}` fails in {} runs, most often by `{outcome}` ({count}){heated}.",
        failed().count()
    ))
}

/// The commonest of some words, the first of them by name, and how often it is there.
fn most(words: impl Iterator<Item = String>) -> Option<(String, usize)> {
    let mut counted = std::collections::BTreeMap::new();
    for word in words {
        *counted.entry(word).or_insert(0_usize) += 1;
    }
    let mut found: Option<(String, usize)> = None;
    for (word, count) in counted {
        if found.as_ref().is_none_or(|(_, most)| count > *most) {
            found = Some((word, count));
        }
    }
    found
}

/// What broke a cell first, when, and who did it.
pub(super) fn told(judged: &Judged) -> String {
    let step = judged
        .cell
        .dt
        .map_or(String::new(), |dt| format!("dt {} s: ", engineering(dt)));
    let broken = judged.broken.as_deref().unwrap_or("every bound held");
    let phase = judged
        .phase
        .as_ref()
        .map_or(String::new(), |phase| format!(" ({phase})"));
    format!("{step}{broken}{phase}")
}
