//! Which engine stays within bounds, at which step: hard cases on every engine, judged by bounds.

mod cell;
mod map;
mod summary;

pub use cell::{Cell, Judged, judge};
pub use map::{MapKind, MapPoint, StabilityMap, stability_map};
pub use summary::{Score, StabilitySummary};

use crate::case::{Case, Expected};
use crate::engine::EngineSpec;
use crate::error::Result;
use crate::scene::Scene;

/// The matrix of hard cases, engines and steps.
#[derive(Debug, Clone)]
pub struct StabilityStudy {
    /// Name and title of each case, in order.
    pub cases: Vec<(String, String)>,
    /// The engines, in order.
    pub engines: Vec<EngineSpec>,
    /// A cell for each case, engine and step of the case, in that order; an engine without steps
    /// has one.
    pub cells: Vec<Judged>,
    /// Work that one run may count: steps, looks at pairs, evaluations of forces.
    pub budget: u64,
}

impl StabilityStudy {
    /// The cells of a case on an engine, from the coarsest step to the finest.
    pub fn of<'a>(&'a self, case: &'a str, engine: &'a str) -> impl Iterator<Item = &'a Judged> {
        let cells = self.cells.iter();
        cells.filter(move |judged| judged.cell.case == case && judged.cell.engine == engine)
    }
}

/// A case with what must hold on it.
#[derive(Debug, Clone)]
pub struct Bounded {
    /// The scene.
    pub scene: Scene,
    /// What must hold on it.
    pub expected: Expected,
}

impl Bounded {
    /// The case, if it says what must hold.
    #[must_use]
    pub fn of(case: Case) -> Option<Self> {
        let expected = case.expected.filter(Expected::has_bounds)?;
        Some(Self {
            scene: case.scene,
            expected,
        })
    }
}

/// Runs every case on every engine with every step of the case, one run after the other, so that
/// each has the machine to itself.
///
/// `watch` is told the case at hand, how many cells are done and of how many.
///
/// # Errors
/// As [`judge`].
pub fn stability(
    cases: &[Bounded],
    engines: &[EngineSpec],
    budget: u64,
    watch: &dyn Fn(&str, usize, usize),
) -> Result<StabilityStudy> {
    let all: Vec<(&Bounded, &EngineSpec, f64)> = cases
        .iter()
        .flat_map(|case| engines.iter().flat_map(move |spec| runs(case, spec)))
        .collect();
    let mut cells = Vec::new();
    for (case, spec, dt) in &all {
        watch(&case.scene.name, cells.len(), all.len());
        cells.push(judge(&case.scene, &case.expected, spec, *dt, budget)?);
    }
    let named = |case: &Bounded| {
        let name = case.scene.name.clone();
        (name.clone(), case.scene.title.clone().unwrap_or(name))
    };
    Ok(StabilityStudy {
        cases: cases.iter().map(named).collect(),
        engines: engines.to_vec(),
        cells,
        budget,
    })
}

/// The runs of a case on an engine: at every step, once for an engine without steps.
fn runs<'a>(
    case: &'a Bounded,
    spec: &'a EngineSpec,
) -> impl Iterator<Item = (&'a Bounded, &'a EngineSpec, f64)> {
    let steps = case.expected.dt.iter();
    let taken = if spec.takes_steps() { usize::MAX } else { 1 };
    steps.take(taken).map(move |dt| (case, spec, *dt))
}
