//! The table of engines: an engine's name is a preset of plain data, printed in every report.

use serde::Serialize;

use crate::error::{Error, Result};

/// One way to compute a scene: a name for a kind of engine and its settings.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EngineSpec {
    /// The name on the command line and in files.
    pub name: String,
    /// One line for people.
    pub summary: &'static str,
    /// What computes, and with which settings.
    pub kind: EngineKind,
}

/// The kinds of engines.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum EngineKind {
    /// The hand-written impulse solver.
    Impulse,
    /// The event-driven exact engine.
    Exact(ExactSettings),
    /// A Rapier world.
    Rapier(RapierSettings),
}

/// Settings of the exact engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ExactSettings {
    /// Whether a second computation certifies the digits of the first.
    pub certify: bool,
    /// Bound on the work of each computation, in elementary operations, about one a nanosecond.
    pub operations: u64,
}

impl ExactSettings {
    /// The published settings, with or without certification: some ten seconds a computation.
    fn bounded(certify: bool) -> Self {
        Self {
            certify,
            operations: 20_000_000_000,
        }
    }
}

/// Floating-point numbers inside Rapier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// 32 bits: the crate `rapier3d`.
    Single,
    /// 64 bits: the crate `rapier3d-f64`.
    Double,
}

/// How drag, springs and gravity act in a Rapier world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Forces {
    /// Rapier's own features: linear damping, spring joints, gravity.
    Native,
    /// The lecture's formulas, added as forces before each step.
    Lecture,
}

/// Settings of a Rapier world; `None` leaves Rapier's own default.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RapierSettings {
    /// Which of the two crates computes.
    pub precision: Precision,
    /// How drag, springs and gravity act.
    pub forces: Forces,
    /// `num_solver_iterations`: since Rapier 0.30 these are substeps of the step.
    pub solver_iterations: Option<usize>,
    /// `normalized_prediction_distance`: contacts are made this far ahead, in `length_unit`s.
    pub prediction_distance: Option<f64>,
    /// `contact_recycling`: keep a pair's old contact while it moved little.
    pub contact_recycling: Option<bool>,
    /// `max_ccd_substeps`; 0 switches all continuous collision detection off.
    pub max_ccd_substeps: Option<usize>,
    /// `false` lifts the cap of speeds (`normalized_max_linear_velocity`).
    pub speed_cap: bool,
}

impl RapierSettings {
    /// Stock parameters.
    #[must_use]
    pub fn stock(precision: Precision) -> Self {
        Self {
            precision,
            forces: Forces::Native,
            solver_iterations: None,
            prediction_distance: None,
            contact_recycling: None,
            max_ccd_substeps: None,
            speed_cap: true,
        }
    }

    /// As near to the lecture as Rapier's interface allows.
    #[must_use]
    pub fn matched() -> Self {
        Self {
            precision: Precision::Double,
            forces: Forces::Lecture,
            solver_iterations: Some(1),
            prediction_distance: Some(1e-9),
            contact_recycling: Some(false),
            max_ccd_substeps: Some(0),
            speed_cap: false,
        }
    }
}

impl EngineSpec {
    /// Whether it computes step by step, with an error that depends on the step.
    #[must_use]
    pub fn takes_steps(&self) -> bool {
        match self.kind {
            EngineKind::Impulse | EngineKind::Rapier(_) => true,
            EngineKind::Exact(_) => false,
        }
    }

    /// Whether this build has the engine.
    #[must_use]
    pub fn is_built(&self) -> bool {
        match self.kind {
            EngineKind::Impulse | EngineKind::Exact(_) => true,
            EngineKind::Rapier(_) => cfg!(feature = "rapier"),
        }
    }

    /// The settings in a sentence.
    #[must_use]
    pub fn describe(&self) -> String {
        match &self.kind {
            EngineKind::Impulse => "Symplectic Euler, impulses at the first overlap, push-out by \
                                    (1 + e)/2 of it on each side."
                .to_owned(),
            EngineKind::Exact(settings) if settings.certify => {
                "From event to event without a time step, computed more than once to certify its \
                 own digits."
                    .to_owned()
            }
            EngineKind::Exact(_) => {
                "From event to event without a time step, in doubles, nothing certified.".to_owned()
            }
            EngineKind::Rapier(settings) => settings.describe(),
        }
    }
}

impl RapierSettings {
    fn describe(&self) -> String {
        let krate = match self.precision {
            Precision::Single => "rapier3d (f32)",
            Precision::Double => "rapier3d-f64",
        };
        let forces = match self.forces {
            Forces::Native => "drag, springs and gravity by Rapier's own features",
            Forces::Lecture => "drag, springs and gravity as the lecture's forces",
        };
        let mut changed = Vec::new();
        changed.extend(
            self.solver_iterations
                .map(|n| format!("num_solver_iterations {n}")),
        );
        changed.extend(
            self.prediction_distance
                .map(|d| format!("normalized_prediction_distance {d:e}")),
        );
        changed.extend(
            self.contact_recycling
                .map(|on| format!("contact_recycling {on}")),
        );
        changed.extend(
            self.max_ccd_substeps
                .map(|n| format!("max_ccd_substeps {n}")),
        );
        if !self.speed_cap {
            changed.push("no cap of speeds".to_owned());
        }
        let changed = if changed.is_empty() {
            "stock parameters".to_owned()
        } else {
            changed.join(", ")
        };
        format!("{krate}: {forces}; {changed}; friction 0, rotations locked, no sleeping.")
    }
}

/// Every engine, in the order in which reports list them.
#[must_use]
pub fn engines() -> Vec<EngineSpec> {
    let row = |name: &str, summary, kind| EngineSpec {
        name: name.to_owned(),
        summary,
        kind,
    };
    vec![
        row(
            "lecture",
            "the slides' impulse solver, bit for bit",
            EngineKind::Impulse,
        ),
        row(
            "rapier",
            "rapier3d (f32) as its manual would have it, stock parameters",
            EngineKind::Rapier(RapierSettings::stock(Precision::Single)),
        ),
        row(
            "rapier-f64",
            "rapier3d-f64, otherwise as `rapier`",
            EngineKind::Rapier(RapierSettings::stock(Precision::Double)),
        ),
        row(
            "rapier-matched",
            "rapier3d-f64 made to compute what the lecture computes",
            EngineKind::Rapier(RapierSettings::matched()),
        ),
        row(
            "exact",
            "event-driven, with certified digits",
            EngineKind::Exact(ExactSettings::bounded(true)),
        ),
        row(
            "exact-fast",
            "event-driven, without certification: for speed",
            EngineKind::Exact(ExactSettings::bounded(false)),
        ),
    ]
}

/// The engine of that name.
///
/// # Errors
/// [`Error::UnknownEngine`], which lists the names there are.
pub fn engine(name: &str) -> Result<EngineSpec> {
    let known = engines();
    let names: Vec<_> = known.iter().map(|spec| spec.name.clone()).collect();
    known
        .into_iter()
        .find(|spec| spec.name == name)
        .ok_or_else(|| Error::UnknownEngine {
            name: name.to_owned(),
            known: names.join(", "),
        })
}
