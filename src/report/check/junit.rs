//! A check as the XML of `JUnit`, which the pages of continuous integration show.

use serde::Serialize;

use super::text::{details, in_a_line};
use crate::error::Result;
use crate::report::template::fill_xml;
use crate::study::check::{CaseCheck, CheckReport};

const TEMPLATE: &str = include_str!("../../../templates/check.xml");

#[derive(Serialize)]
struct Page {
    checks: usize,
    failures: usize,
    suites: Vec<Suite>,
}

#[derive(Serialize)]
struct Suite {
    solver: String,
    failures: usize,
    cases: Vec<Case>,
}

#[derive(Serialize)]
struct Case {
    name: String,
    topic: Option<String>,
    failure: Option<String>,
    details: String,
}

/// The report of a check as the XML of `JUnit`: a suite a solver, a test a case.
///
/// # Errors
/// A fault of the template.
pub fn check_junit(report: &CheckReport) -> Result<String> {
    let case = |check: &CaseCheck| Case {
        name: check.case.clone(),
        topic: check.topic.clone(),
        failure: (!check.holds()).then(|| in_a_line(check)),
        details: details(check),
    };
    let failures = |checks: &[CaseCheck]| checks.iter().filter(|check| !check.holds()).count();
    let suites = report.checks.chunk_by(|a, b| a.solver == b.solver);
    fill_xml(
        TEMPLATE,
        Page {
            checks: report.checks.len(),
            failures: failures(&report.checks),
            suites: suites
                .map(|checks| Suite {
                    solver: checks[0].solver.clone(),
                    failures: failures(checks),
                    cases: checks.iter().map(case).collect(),
                })
                .collect(),
        },
    )
}
