//! A check as text: a line a case, and all there is to know where something fails.

use std::borrow::BorrowMut as _;

use crate::case::Metric;
use crate::error::harmless;
use crate::report::{engineering, percent};
use crate::study::check::{Against, CaseCheck, CheckReport, Comparison, Held, Replay, Row};

/// Adds a line; foreign text in it cannot begin another one.
macro_rules! add {
    ($text:ident, $($arguments:tt)*) => {
        add_line($text.borrow_mut(), &format!($($arguments)*));
    };
}

fn add_line(text: &mut String, line: &str) {
    text.push_str(&harmless(line));
    text.push('\n');
}

/// The report of a check; with `all`, every metric of every case.
#[must_use]
pub fn check_text(report: &CheckReport, all: bool) -> String {
    let mut text = String::new();
    for checks in report.checks.chunk_by(|a, b| a.solver == b.solver) {
        of_solver(&mut text, checks, all);
    }
    text
}

fn of_solver(text: &mut String, checks: &[CaseCheck], all: bool) {
    let solver = &checks[0].solver;
    add!(text, "{}", heading(&checks[0]));
    let width = checks.iter().map(|check| check.case.len()).max();
    let width = width.unwrap_or(0);
    for check in checks {
        let word = if check.holds() { "holds" } else { "FAILS" };
        add!(
            text,
            "  {:width$}  {word}  {}",
            check.case,
            in_a_line(check)
        );
        if all || !check.holds() {
            text.push_str(&details(check));
        }
    }
    topics(text, checks);
    let held = checks.iter().filter(|check| check.holds()).count();
    add!(text, "{solver}: {held} of {} cases hold", checks.len());
    text.push('\n');
}

fn heading(check: &CaseCheck) -> String {
    if check.solver == check.like {
        check.solver.clone()
    } else {
        format!("{}, judged as `{}`", check.solver, check.like)
    }
}

/// The most telling of a check, in a line.
pub(in crate::report) fn in_a_line(check: &CaseCheck) -> String {
    if let Some(fault) = &check.fault {
        return fault.clone();
    }
    let failed = check.comparisons.iter();
    let failed = failed.filter(|comparison| comparison.held == Held::Fails);
    let mut broken = failed.flat_map(|comparison| {
        let rows = comparison.rows.iter().filter(|row| row.held == Held::Fails);
        rows.map(|row| (comparison.against, row))
    });
    if let Some((against, row)) = broken.next() {
        return format!(
            "{}: {} {}, may be {}",
            against.word(),
            row.metric.name(),
            with_unit(row.value, row),
            with_unit(row.tolerance, row)
        );
    }
    let said = check
        .comparisons
        .iter()
        .map(|comparison| in_short(check, comparison));
    said.collect::<Vec<_>>().join("; ")
}

fn in_short(check: &CaseCheck, comparison: &Comparison) -> String {
    let position = comparison
        .rows
        .iter()
        .find(|row| row.metric == Metric::Position);
    match (comparison.against, position) {
        (Against::Truth, position) => {
            let Some(row) = position.or(comparison.rows.first()) else {
                return "no truth".to_owned();
            };
            let mut text = format!(
                "{} {} off truth, may be {}",
                row.metric.name(),
                with_unit(row.value, row),
                with_unit(row.tolerance, row)
            );
            if comparison.held == Held::Excused {
                text.push_str(", better on the whole");
            }
            text
        }
        (Against::Baseline, _) if comparison.held == Held::Excused => comparison.said.join(" "),
        (Against::Baseline, _) if check.same_bits => "same bits as the baseline".to_owned(),
        (Against::Baseline, position) => position.map_or_else(String::new, |row| {
            format!("{} from the baseline", with_unit(row.value, row))
        }),
        (Against::Rapier, position) => {
            let sizes = position.zip(comparison.distances);
            sizes.map_or_else(String::new, |(row, [ours, theirs])| {
                let known = if row.held == Held::Holds {
                    "as the baseline".to_owned()
                } else {
                    format!("the baseline {}", with_unit(theirs, row))
                };
                format!("{} from Rapier, {known}", with_unit(ours, row))
            })
        }
    }
}

/// Every comparison of a check, row by row, with what disagrees first.
pub(super) fn details(check: &CaseCheck) -> String {
    let mut text = String::new();
    for comparison in &check.comparisons {
        add!(
            text,
            "      {} until {} s: {}",
            heading_of(comparison.against),
            comparison.until,
            word(comparison.held)
        );
        for row in &comparison.rows {
            add!(
                text,
                "        {:7} {:16} {:>11} of {:>11}  margin {:>8}  signed {:>9}  {}",
                word(row.held),
                row.metric.name(),
                with_unit(row.value, row),
                with_unit(row.tolerance, row),
                percent(row.margin),
                engineering(row.signed),
                row.place
            );
        }
        if let (Some([ours, theirs]), Some(row)) = (comparison.distances, comparison.rows.first()) {
            add!(
                text,
                "        {} from Rapier at most, the baseline {}",
                with_unit(ours, row),
                with_unit(theirs, row)
            );
        }
        for said in &comparison.said {
            add!(text, "        {said}");
        }
    }
    text
}

fn heading_of(against: Against) -> &'static str {
    match against {
        Against::Truth => "against truth",
        Against::Baseline => "against its baseline",
        Against::Rapier => "change of the distance to Rapier",
    }
}

fn word(held: Held) -> &'static str {
    match held {
        Held::Holds => "holds",
        Held::Excused => "excused",
        Held::Fails => "FAILS",
    }
}

fn with_unit(value: f64, row: &Row) -> String {
    match row.unit.as_str() {
        "share" => percent(value),
        "impacts" | "" => engineering(value),
        unit => format!("{} {unit}", engineering(value)),
    }
}

/// How many cases of each topic hold, where cases have topics.
fn topics(text: &mut String, checks: &[CaseCheck]) {
    let mut seen: Vec<&str> = Vec::new();
    for topic in checks.iter().filter_map(|check| check.topic.as_deref()) {
        if !seen.contains(&topic) {
            seen.push(topic);
        }
    }
    if seen.is_empty() {
        return;
    }
    let width = seen.iter().map(|topic| topic.len()).max().unwrap_or(0);
    for topic in seen {
        let of_topic = || {
            checks
                .iter()
                .filter(|check| check.topic.as_deref() == Some(topic))
        };
        let held = of_topic().filter(|check| check.holds()).count();
        let all = of_topic().count();
        let mark = if held == all { "" } else { "  <--" };
        add!(text, "  topic {topic:width$}  {held} of {all}{mark}");
    }
}

/// What a replay came to, in a sentence.
#[must_use]
pub fn replay_text(found: &Replay) -> String {
    match found {
        Replay::Same { samples, digest } => {
            format!("the same in every bit: {samples} samples, digest {digest}")
        }
        Replay::Differs {
            sample,
            time,
            body,
            component,
            recorded,
            replayed,
            ulps,
        } => format!(
            "differs first at t = {time} s (sample {sample}): {component} of `{body}` is \
             {replayed:?} now and {recorded:?} in the file, {ulps} ulp apart"
        ),
        Replay::Length { recorded, replayed } => format!(
            "the same in every bit as far as both go: {replayed} samples now, {recorded} in the \
             file"
        ),
    }
}
