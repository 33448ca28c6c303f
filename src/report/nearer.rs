//! How near engines stay to the reference, and which of two is nearer, counted over cases and over
//! hard runs.

use super::format::{code, whole_percent};
use super::percent;
use crate::compare::RIGHT_WITHIN;
use crate::engine::EngineSpec;
use crate::study::stability::StabilitySummary;
use crate::study::{Summary, VoiceSummary, median};

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

/// How often each engine stays near the reference, and its middle error; where it computes another
/// model nothing is counted.
pub(super) fn within(summaries: &[Summary], engines: &[EngineSpec]) -> Option<String> {
    let judged = summaries
        .iter()
        .filter(|summary| !summary.verdicts.is_empty());
    let count = judged.count();
    let of_engine = |spec: &EngineSpec| {
        let all = summaries.iter().flat_map(|summary| {
            let verdicts = summary.verdicts.iter();
            verdicts.map(move |verdict| (summary, verdict))
        });
        let own = all.filter(|(_, verdict)| verdict.engine == spec.name);
        let (other, own): (Vec<_>, Vec<_>) = own.partition(|(summary, verdict)| {
            let voice = summary.voice(&verdict.engine);
            voice.is_some_and(|voice| voice.another_model.is_some())
        });
        let right = own.iter().filter(|(_, own)| own.is_right()).count();
        let errors: Vec<_> = own.iter().map(|(_, own)| own.error_relative).collect();
        if errors.is_empty() {
            return None;
        }
        let middle = percent(median(&errors));
        let other = match other.len() {
            0 => String::new(),
            count => format!("; another model in {count}"),
        };
        Some(format!(
            "{} in {right} of {} (median error {middle}{other})",
            code(&spec.name),
            own.len()
        ))
    };
    let rows: Vec<_> = engines.iter().filter_map(of_engine).collect();
    let said = format!(
        "{count} cases have a reference. The engines stay within {} of the scene's size of it, with \
         every impact in order: {}.",
        whole_percent(RIGHT_WITHIN),
        rows.join(", ")
    );
    (!rows.is_empty()).then_some(said)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Library;
    use crate::engine::{DEFAULT_DT, engine};
    use crate::study::side_by_side;

    #[test]
    fn the_second_engine_is_told_first_and_another_model_does_not_count() {
        let engines = [engine("lecture").unwrap(), engine("verlet").unwrap()];
        let summary = |case: &str| {
            let case = Library::Embedded.case(case).unwrap();
            Summary::of(&side_by_side(&case, &engines, DEFAULT_DT).unwrap())
        };
        let mut summaries = [summary("kepler-circle"), summary("spring-under")];
        let told = |summaries: &[Summary]| nearer(summaries, ["lecture", "verlet"], "0.01", None);
        let [first, second] = &told(&summaries)[..] else {
            panic!("two sentences");
        };
        assert!(
            first.starts_with("`verlet` is nearer to the reference than `lecture` in 2 of 2 cases"),
            "{first}"
        );
        assert!(
            second.starts_with("`lecture` is nearer than `verlet` in 0"),
            "{second}"
        );
        for voice in &mut summaries[1].voices {
            voice.another_model = Some("it has its own springs");
        }
        let told = told(&summaries);
        assert!(told[0].contains("in 1 of 1 cases"), "{}", told[0]);
        let left_out =
            "Left out of this count: `spring-under`, where `lecture` computes another model.";
        assert_eq!(told[2], left_out);
        let alone = within(&summaries[1..], &engines);
        assert_eq!(alone, None, "no figure of what is no error");
    }
}
