//! Which of two engines is nearer to the reference, counted over cases and over hard runs.

use super::format::code;
use crate::study::stability::StabilitySummary;
use crate::study::{Summary, VoiceSummary};

/// Where each of two engines is nearer to the reference than the other, the second one first: it
/// is the one that the first was not written for. A case counts if both finished it and compute
/// the model that it declares.
pub(super) fn nearer(
    summaries: &[Summary],
    [first, second]: [&str; 2],
    dt: &str,
    hard: Option<&StabilitySummary>,
) -> Vec<String> {
    let compared = summaries
        .iter()
        .filter_map(|summary| errors(summary, [first, second]));
    let compared: Vec<[f64; 2]> = compared.collect();
    if compared.is_empty() {
        return Vec::new();
    }
    let count = |is: fn(&[f64; 2]) -> bool| compared.iter().filter(|errors| is(errors)).count();
    let runs = |holder: &str, breaker: &str| {
        let held = hard.and_then(|hard| hard.held_where_broken(holder, breaker));
        held.map_or_else(String::new, |held| {
            let breaker = code(breaker);
            format!("; of the hard runs it holds {held} that {breaker} breaks")
        })
    };
    let told = [
        format!(
            "{} is nearer to the reference than {} in {} of {} cases (the largest error of \
             position, both at steps of at most {dt} s){}.",
            code(second),
            code(first),
            count(|[first, second]| second < first),
            compared.len(),
            runs(second, first)
        ),
        format!(
            "{} is nearer than {} in {} of these{}; in {} both are equally near.",
            code(first),
            code(second),
            count(|[first, second]| first < second),
            runs(first, second),
            count(|[first, second]| first == second)
        ),
    ];
    told.into_iter()
        .chain(left_out(summaries, [first, second]))
        .collect()
}

/// The largest errors of both on a case on which both can be compared.
fn errors(summary: &Summary, names: [&str; 2]) -> Option<[f64; 2]> {
    let error = |name: &str| {
        let verdict = summary.verdicts.iter().find(|own| own.engine == name)?;
        let is_whole = verdict.stopped_at_s.is_none();
        let voice = summary.voice(name)?;
        (is_whole && voice.another_model.is_none()).then_some(verdict.error_max)
    };
    Some([error(names[0])?, error(names[1])?])
}

/// Cases that do not count because one of these computes another model.
fn left_out(summaries: &[Summary], names: [&str; 2]) -> Option<String> {
    let another = |summary: &Summary| {
        let voices = names.iter().filter_map(|name| summary.voice(name));
        let other: Vec<&VoiceSummary> = voices
            .filter(|voice| voice.another_model.is_some())
            .collect();
        let told = other.first()?;
        let (scene, who) = (code(&summary.scene), code(&told.voice));
        Some(format!("{scene}, where {who} computes another model"))
    };
    let cases: Vec<_> = summaries.iter().filter_map(another).collect();
    (!cases.is_empty()).then(|| format!("Left out of this count: {}.", cases.join("; ")))
}
