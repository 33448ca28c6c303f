//! The findings of a study of stability, as programs read them (`summary.json`) and the index of
//! a report tells them, today's and those of a study that was stored.

use serde::{Deserialize, Serialize};

use super::{Cell, Judged, StabilityStudy};
use crate::study::Made;

/// How many of its cells an engine held.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Score {
    /// The engine.
    pub engine: String,
    /// Cells in which every bound held.
    pub held: usize,
    /// All its cells that were run.
    pub run: usize,
    /// Cells that it refused.
    pub not_run: usize,
    /// Cases that it held at every step.
    pub cases_held: usize,
}

/// A study of stability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StabilitySummary {
    /// When, with what and where it was made.
    #[serde(flatten)]
    pub made: Made,
    /// How many cases there are.
    pub cases: usize,
    /// The engines in the order of the study.
    pub scores: Vec<Score>,
    /// Every cell that did not hold: what was broken first, and by which phase.
    pub failures: Vec<Judged>,
}

impl StabilitySummary {
    /// Of a study made today.
    #[must_use]
    pub fn of(study: &StabilityStudy) -> Self {
        let failures = study.cells.iter().filter(|judged| !judged.cell.holds());
        Self {
            made: Made::now(),
            cases: study.cases.len(),
            scores: study
                .engines
                .iter()
                .map(|spec| Score::of(study, &spec.name))
                .collect(),
            failures: failures.cloned().collect(),
        }
    }

    /// Runs, a case at a step each, in which one engine holds every bound and another breaks one;
    /// none where one of them took no part.
    #[must_use]
    pub fn held_where_broken(&self, holder: &str, breaker: &str) -> Option<usize> {
        let took_part = |name: &str| self.scores.iter().any(|score| score.engine == name);
        if !took_part(holder) || !took_part(breaker) {
            return None;
        }
        let of = |name: &str| {
            let failures = self.failures.iter().map(|judged| &judged.cell);
            let name = name.to_owned();
            failures.filter(move |cell| cell.engine == name)
        };
        let fails_too = |broken: &Cell| {
            let same = |cell: &Cell| cell.dt.is_none() || cell.dt == broken.dt;
            of(holder).any(|cell| cell.case == broken.case && same(cell))
        };
        let broken = of(breaker).filter(|cell| cell.was_run() && !fails_too(cell));
        Some(broken.count())
    }

    /// The most runs that an engine takes part in, a case at a step each, refused ones included.
    #[must_use]
    pub fn runs(&self) -> usize {
        let runs = self.scores.iter().map(|score| score.run + score.not_run);
        runs.max().unwrap_or(0)
    }
}

impl Score {
    fn of(study: &StabilityStudy, engine: &str) -> Self {
        let mut score = Self {
            engine: engine.to_owned(),
            held: 0,
            run: 0,
            not_run: 0,
            cases_held: 0,
        };
        for (case, _) in &study.cases {
            let mut all_held = true;
            for Judged { cell, .. } in study.of(case, engine) {
                score.held += usize::from(cell.holds());
                score.run += usize::from(cell.was_run());
                score.not_run += usize::from(!cell.was_run());
                all_held &= cell.holds();
            }
            score.cases_held += usize::from(all_held);
        }
        score
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn broken(engine: &str, case: &str, dt: Option<f64>) -> Judged {
        let cell = Cell {
            case: case.to_owned(),
            engine: engine.to_owned(),
            dt,
            outcome: "EnergyGrew".to_owned(),
            energy_error: None,
            momentum_error: None,
            max_penetration: None,
            missed_events: None,
            at_time: None,
            steps: Some(1),
            cost_ms: None,
        };
        Judged {
            cell,
            broken: None,
            phase: None,
            impacts: None,
        }
    }

    #[test]
    fn a_run_counts_at_the_same_case_and_step_alone() {
        let score = |engine: &str| Score {
            engine: engine.to_owned(),
            held: 0,
            run: 3,
            not_run: 1,
            cases_held: 0,
        };
        let summary = StabilitySummary {
            made: Made::now(),
            cases: 2,
            scores: ["a", "b"].map(score).to_vec(),
            failures: vec![
                broken("a", "x", Some(0.1)),
                broken("a", "x", Some(0.01)),
                broken("a", "y", Some(0.1)),
                broken("b", "x", Some(0.1)),
            ],
        };
        assert_eq!(summary.held_where_broken("b", "a"), Some(2));
        assert_eq!(summary.held_where_broken("a", "b"), Some(0));
        assert_eq!(summary.held_where_broken("a", "absent"), None);
        assert_eq!(summary.runs(), 4);
    }
}
