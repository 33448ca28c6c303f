//! What was found, in sentences: who overtakes whom, and how they stand at the end.

use std::cmp::Ordering;

use super::tables::{label, ratio};
use crate::engine::{EngineKind, engine};
use crate::report::engineering;
use crate::report::format::about;
use crate::study::bodies::{BASE, BodiesPoint, BodiesStudy, Crossover, Series};

/// The crossovers with the base, the ratios at the largest size, and how far the builds can be
/// compared.
#[must_use]
pub fn bodies_findings(study: &BodiesStudy) -> Vec<String> {
    let all = study.series();
    let others: Vec<_> = all.into_iter().filter(|series| is_told(*series)).collect();
    let mut found: Vec<_> = others
        .iter()
        .flat_map(|series| overtaking(study, *series))
        .collect();
    found.extend(
        others
            .iter()
            .filter_map(|series| at_the_end(study, *series)),
    );
    found.extend(
        others
            .iter()
            .filter_map(|series| other_build(study, *series)),
    );
    found.extend(unpaid(study));
    found.extend(controls(study));
    found
}

/// Whether a series is another kind of engine than the base; rungs of its ladder stand in the
/// tables.
fn is_told(series: Series) -> bool {
    engine(series.engine).map_or(true, |spec| match spec.kind {
        EngineKind::Impulse(_) => false,
        EngineKind::Exact(_) | EngineKind::Rapier(_) => true,
    })
}

/// Where a series overtakes the base or the base it, or who is ahead throughout.
fn overtaking(study: &BodiesStudy, series: Series) -> Vec<String> {
    let name = label(study, series);
    let crossovers = study.crossovers(series);
    if !crossovers.is_empty() {
        let sentences = crossovers
            .iter()
            .map(|crossover| crossing(&name, crossover));
        return sentences.collect();
    }
    let standings = study.standings(series);
    let decided: Vec<_> = standings.iter().filter(|at| at.is_decided()).collect();
    let sentence = match (decided.first(), decided.last()) {
        (Some(first), Some(last)) => {
            let word = if first.ratio < 1.0 { "less" } else { "more" };
            let (from, to) = (first.bodies, last.bodies);
            let range = if from == to {
                format!("with {from} bodies")
            } else {
                format!("from {from} to {to} bodies")
            };
            format!("{name} costs {word} than {BASE} wherever it can be told, {range}.")
        }
        _ if standings.is_empty() => return Vec::new(),
        _ => format!("{name} and {BASE} cannot be ranked at any number of bodies."),
    };
    vec![sentence]
}

fn crossing(name: &str, crossover: &Crossover) -> String {
    let [low, high] = crossover.between;
    let at = about(crossover.bodies);
    let (cheaper, dearer) = if crossover.is_cheaper_above {
        (name, BASE)
    } else {
        (BASE, name)
    };
    format!(
        "From about {at} bodies on (between {low} and {high}) {cheaper} costs less than {dearer}."
    )
}

/// The ratio at the largest number of bodies that both have.
fn at_the_end(study: &BodiesStudy, series: Series) -> Option<String> {
    let standings = study.standings(series);
    let last = standings.last()?;
    let (name, told) = (label(study, series), ratio(last));
    let how = match (last.interval, last.is_decided()) {
        (None, _) => format!("{name} costs {told} of {BASE}; too few rounds to rank them"),
        (_, false) => format!("{name} and {BASE} cannot be ranked: {told}"),
        (_, true) if last.ratio < 1.0 => format!("{name} costs {told} of {BASE}"),
        (_, true) => format!("{name} costs {told} times as much as {BASE}"),
    };
    Some(format!("At {} bodies {how}.", last.bodies))
}

/// Where an engine of another build is cheaper or dearer than in this one, each held against the
/// lecture of its own run.
fn other_build(study: &BodiesStudy, series: Series) -> Option<String> {
    if series.build == study.build {
        return None;
    }
    let own = study.standings(study.own(series.engine));
    let others = study.standings(series);
    let at = |wanted: Ordering| {
        let same = own.iter().flat_map(|own| {
            let others = others.iter().filter(|other| other.bodies == own.bodies);
            others.filter(move |other| other.against(own) == wanted)
        });
        let sizes: Vec<_> = same.map(|at| at.bodies.to_string()).collect();
        if sizes.is_empty() {
            "none".to_owned()
        } else {
            sizes.join(", ")
        }
    };
    Some(format!(
        "Held against the {BASE} of its own run, {} is cheaper than in the build {} at these \
         numbers of bodies: {}; dearer at: {}; the intervals overlap at: {}.",
        label(study, series),
        study.build,
        at(Ordering::Less),
        at(Ordering::Greater),
        at(Ordering::Equal)
    ))
}

/// Which engines were not run at which sizes.
fn unpaid(study: &BodiesStudy) -> Option<String> {
    let unpaid = study.series().into_iter().filter_map(|series| {
        let points = study.of(series).into_iter();
        let first = points
            .filter(|point| point.is_over_budget())
            .min_by_key(|p| p.bodies)?;
        Some(format!("{} at {}", label(study, series), first.bodies))
    });
    let unpaid: Vec<_> = unpaid.collect();
    (!unpaid.is_empty()).then(|| {
        format!(
            "Over the budget of work, so not run: {} bodies and more.",
            unpaid.join(", ")
        )
    })
}

/// How much the same hand-written engine differs between builds, which Rapier's features cannot
/// have done: what the machine did in between.
fn controls(study: &BodiesStudy) -> Vec<String> {
    let all = study.series().into_iter();
    let same = all.filter(|series| series.engine == BASE && series.build != study.build);
    let control = |series: Series| {
        let ratio = |point: &BodiesPoint| {
            let own = study.at(study.own(BASE), point.bodies)?;
            Some(point.cost_ms_per_sim_s? / own.cost_ms_per_sim_s?)
        };
        let ratios: Vec<_> = study.of(series).into_iter().filter_map(ratio).collect();
        let low = ratios.iter().copied().reduce(f64::min)?;
        let high = ratios.iter().copied().reduce(f64::max)?;
        Some(format!(
            "{BASE} itself costs {} to {} times as much in the build {} as in {}: they are separate \
             runs, so that times of different builds are told apart only by more than that.",
            engineering(low),
            engineering(high),
            series.build,
            study.build
        ))
    };
    same.filter_map(control).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::bodies::testing::study;

    /// n²/1000 against n and against n/2000: the first meets it at 1000 bodies and costs a tenth
    /// of it at 10,000; the second costs less from the start.
    #[test]
    fn crossovers_and_the_end_are_told_and_nothing_is_left_out() {
        let mut study = study(&[
            (BASE, 2.0, 1e-3),
            ("rapier", 1.0, 1.0),
            ("exact-fast", 1.0, 5e-4),
        ]);
        for point in &mut study.points {
            if point.engine == BASE && point.bodies == 4 {
                "BudgetSpent".clone_into(&mut point.outcome);
            }
        }
        let found = bodies_findings(&study);
        let begins = |words: &str| found.iter().any(|line| line.starts_with(words));
        assert!(begins(
            "From about 1000 bodies on (between 300 and 3000) rapier costs less than"
        ));
        assert!(begins(
            "exact-fast costs less than lecture wherever it can be told, from 4 to"
        ));
        assert!(
            begins("At 10000 bodies rapier costs 0.100 (0.0"),
            "{found:?}"
        );
        assert!(begins("Over the budget of work, so not run: lecture at 4"));
        assert_eq!(found.len(), 5, "{found:?}");
    }

    /// The lecture in another build tells how far separate runs can be compared; where an engine
    /// is cheaper there is told by ratios within each run.
    #[test]
    fn another_build_has_its_control_and_its_gain() {
        let mut own = study(&[(BASE, 2.0, 1e-3), ("rapier", 2.0, 2e-3)]);
        let mut other = study(&[(BASE, 2.0, 1.5e-3), ("rapier", 2.0, 1.5e-3)]);
        for point in &mut other.points {
            "parallel".clone_into(&mut point.build);
        }
        own.points.extend(other.points);
        let found = bodies_findings(&own);
        let has = |words: &str| found.iter().any(|line| line.contains(words));
        assert!(has(
            "lecture itself costs 1.50 to 1.50 times as much in the build parallel"
        ));
        assert!(has("rapier (parallel) and lecture cannot be ranked: 1.00"));
        assert!(has(
            "cheaper than in the build default at these numbers of bodies: 4, 10, 30, 100"
        ));
        assert!(has("dearer at: none"), "{found:?}");
    }
}
