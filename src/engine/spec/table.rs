//! The table of engines: a name for each preset.

use super::{
    DragRule, EngineKind, EngineSpec, ExactSettings, Impacts, ImpulseSettings, Integrator,
    Precision, RapierSettings,
};
use crate::error::{Error, Result};

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
            "rapier-tuned",
            "rapier3d-f64 tuned on shot-0-41, shot-2-96 and shot-minus-0-94 by `carom cost --tune-on`",
            EngineKind::Rapier(RapierSettings::tuned()),
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
            "steps by each effect's limit, contacts solved together; its constants were set on the hard cases",
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
