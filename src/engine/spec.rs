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
    /// The hand-written impulse solver, or a rung of its ladder.
    Impulse(ImpulseSettings),
    /// The event-driven exact engine.
    Exact(ExactSettings),
    /// A Rapier world.
    Rapier(RapierSettings),
}

/// How bodies move between impacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// Kick by all forces, then drift: the lecture's. Order 1.
    SymplecticEuler,
    /// Half a kick, drift, half a kick. Order 2.
    VelocityVerlet,
    /// Four stages. Order 4.
    RungeKutta4,
    /// Seven stages and steps by their own error, swept impacts. Order 5 in the longest step.
    DormandPrince,
    /// Closed forms under drag and dampers, forces that keep the energy in any step. Order 2.
    EnergyMomentum,
}

/// How drag acts in the hand-written solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DragRule {
    /// A force, explicit.
    Force,
    /// The exact decay of the velocity, with the path that goes with it.
    Exponential,
}

/// How impacts, cushions and rests are found in the hand-written solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Impacts {
    /// By overlap at the end of a step, which is pushed apart: the lecture's.
    Overlap,
    /// By overlap at the end of a step, which stays.
    OverlapInPlace,
    /// At the time of impact within the step.
    Swept,
    /// The same, with all of one instant and all that stay in touch solved together.
    Together,
}

/// Numerical choices of the hand-written solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ImpulseSettings {
    /// How bodies move between impacts.
    pub integrator: Integrator,
    /// How drag acts.
    pub drag: DragRule,
    /// How impacts are found.
    pub impacts: Impacts,
}

impl ImpulseSettings {
    /// The slides' choices.
    pub const LECTURE: Self = Self {
        integrator: Integrator::SymplecticEuler,
        drag: DragRule::Force,
        impacts: Impacts::Overlap,
    };

    /// Order in the step of the motion without impacts, for forces of any kind.
    #[must_use]
    pub fn order(self) -> u8 {
        match self.integrator {
            Integrator::SymplecticEuler => 1,
            Integrator::VelocityVerlet | Integrator::EnergyMomentum => 2,
            Integrator::RungeKutta4 => 4,
            Integrator::DormandPrince => 5,
        }
    }

    /// Order in the step through impacts: overlaps are found up to a step late, and the paths on
    /// which impacts are swept are cubics.
    #[must_use]
    pub fn order_through_impacts(self) -> u8 {
        match self.impacts {
            Impacts::Overlap | Impacts::OverlapInPlace => 1,
            Impacts::Swept | Impacts::Together => self.order().min(4),
        }
    }

    fn describe(self) -> String {
        let motion = match self.integrator {
            Integrator::SymplecticEuler => "Symplectic Euler",
            Integrator::VelocityVerlet => "Velocity Verlet",
            Integrator::RungeKutta4 => "Runge-Kutta of order 4",
            Integrator::DormandPrince => "Dormand-Prince 5(4) with steps by their own error",
            Integrator::EnergyMomentum => {
                "Closed forms and energy-momentum steps, as short as each effect asks for"
            }
        };
        let drag = match self.drag {
            DragRule::Force => "",
            DragRule::Exponential => ", exact drag",
        };
        let impacts = match self.impacts {
            Impacts::Overlap => {
                "impulses at the first overlap, push-out by (1 + e)/2 of it on each side"
            }
            Impacts::OverlapInPlace => "impulses at the first overlap, no push-out",
            Impacts::Swept => "impulses at the time of impact",
            Impacts::Together => {
                "impulses at the time of impact, those of one instant and pushes that last solved \
                 together"
            }
        };
        format!("{motion}{drag}, {impacts}.")
    }
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
            EngineKind::Impulse(_) | EngineKind::Rapier(_) => true,
            EngineKind::Exact(_) => false,
        }
    }

    /// The order in the step that the engine states for errors of position, with impacts on the
    /// way or without; none where it states none.
    #[must_use]
    pub fn stated_order(&self, through_impacts: bool) -> Option<u8> {
        match self.kind {
            EngineKind::Impulse(settings) if through_impacts => {
                Some(settings.order_through_impacts())
            }
            EngineKind::Impulse(settings) => Some(settings.order()),
            EngineKind::Exact(_) | EngineKind::Rapier(_) => None,
        }
    }

    /// Whether this build has the engine.
    #[must_use]
    pub fn is_built(&self) -> bool {
        match self.kind {
            EngineKind::Impulse(_) | EngineKind::Exact(_) => true,
            EngineKind::Rapier(_) => cfg!(feature = "rapier"),
        }
    }

    /// The settings in a sentence.
    #[must_use]
    pub fn describe(&self) -> String {
        match &self.kind {
            EngineKind::Impulse(settings) => settings.describe(),
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
            EngineKind::Impulse(ImpulseSettings::LECTURE),
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
        row(
            "lecture-in-place",
            "the lecture without its push-out",
            rung(
                Integrator::SymplecticEuler,
                DragRule::Force,
                Impacts::OverlapInPlace,
            ),
        ),
        row(
            "exact-drag",
            "the lecture with the exact decay under drag",
            rung(
                Integrator::SymplecticEuler,
                DragRule::Exponential,
                Impacts::Overlap,
            ),
        ),
        row(
            "verlet",
            "the same with velocity Verlet",
            rung(
                Integrator::VelocityVerlet,
                DragRule::Exponential,
                Impacts::Overlap,
            ),
        ),
        row(
            "swept",
            "the same with impacts at their time",
            rung(
                Integrator::VelocityVerlet,
                DragRule::Exponential,
                Impacts::Swept,
            ),
        ),
        row(
            "swept-4",
            "Runge-Kutta of order 4 with impacts at their time",
            rung(Integrator::RungeKutta4, DragRule::Force, Impacts::Swept),
        ),
        row(
            "adaptive",
            "Dormand-Prince 5(4), steps by their own error, impacts at their time",
            rung(Integrator::DormandPrince, DragRule::Force, Impacts::Swept),
        ),
        row(
            "robust",
            "survives everything: steps by each effect's limit, contacts solved together",
            rung(
                Integrator::EnergyMomentum,
                DragRule::Exponential,
                Impacts::Together,
            ),
        ),
    ]
}

fn rung(integrator: Integrator, drag: DragRule, impacts: Impacts) -> EngineKind {
    EngineKind::Impulse(ImpulseSettings {
        integrator,
        drag,
        impacts,
    })
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
