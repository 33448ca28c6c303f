//! The page of a study of stability.

use serde::Serialize;

use super::tables::{self, Rows};
use super::{MATRIX, findings::stability_findings, map_picture, map_table};
use crate::error::Result;
use crate::report::template::fill;
use crate::study::stability::{MapKind, StabilityMap, StabilityStudy, StabilitySummary};

const TEMPLATE: &str = include_str!("../../../templates/stability.md");

/// A load above this is more than the study itself with its two threads for the maps.
const LOAD_MAX: f64 = 2.0;

/// What the template is given.
#[derive(Serialize)]
struct Page<'a> {
    summary: &'a StabilitySummary,
    machine: String,
    /// Whether more ran than this program, which is one by itself.
    busy: bool,
    budget: u64,
    pictures: bool,
    matrix: &'static str,
    findings: Vec<String>,
    scores: Rows,
    pi_header: Vec<String>,
    pi: Rows,
    maps: Vec<Map>,
    cases: Rows,
}

/// A map with what a reader must know about it.
#[derive(Serialize)]
struct Map {
    title: &'static str,
    text: &'static str,
    picture: &'static str,
    table: &'static str,
}

impl Map {
    fn of(map: &StabilityMap) -> Self {
        let (title, text) = match map.kind {
            MapKind::Spring => (
                "Springs and dampers against the step",
                "Two balls of 1 and 3 kg on a spring that is stretched by a tenth, 256 steps, for \
                 every stiffness k and damping kd; mu = m_a m_b/(m_a + m_b). The line is the limit \
                 of symplectic Euler, which is the lecture's step: k dt²/mu + 2 kd dt/mu = 4. A run \
                 is lost if it ends early or its energy passes thirty times that of the start.",
            ),
            MapKind::Orbit => (
                "Orbits against the step",
                "Ten revolutions of two balls of 1 and 3 kg, from the far point, for every \
                 eccentricity; w² = G M/q³ with q the smallest distance. The line is the limit of \
                 symplectic Euler for the pull linearised there: w dt = 2. A run is lost if its \
                 energy is ever off by more than half: it is another orbit then, or none.",
            ),
        };
        Self {
            title,
            text,
            picture: map_picture(map.kind),
            table: map_table(map.kind),
        }
    }
}

/// The page as Markdown.
///
/// # Errors
/// A fault of the template.
pub(super) fn page(
    study: &StabilityStudy,
    summary: &StabilitySummary,
    maps: &[StabilityMap],
) -> Result<String> {
    fill(
        TEMPLATE,
        Page {
            summary,
            machine: summary.made.machine.describe(),
            busy: summary
                .made
                .machine
                .load
                .is_some_and(|load| load > LOAD_MAX),
            budget: study.budget,
            pictures: cfg!(feature = "plots"),
            matrix: MATRIX,
            findings: stability_findings(study, summary),
            scores: tables::scores(study, summary),
            pi_header: tables::pi_header(study),
            pi: tables::pi_rows(study),
            maps: maps.iter().map(Map::of).collect(),
            cases: tables::cases(study),
        },
    )
}
