//! The rungs: which integrator and which way to deal with impacts a row of settings means.

use super::dormand_prince::DormandPrince;
use super::handling::Overlap;
use super::motion::{Euler, Verlet};
use super::phases::Phases;
use super::robust::{self, Robust};
use super::runge_kutta::RungeKutta;
use super::scheme::Stepped;
use super::simulation::ImpulseSimulation;
use super::sweep::Sweep;
use crate::engine::spec::{DragRule, Impacts, ImpulseSettings, Integrator};
use crate::engine::{Phase, Simulation, StepGrid};
use crate::scene::Scene;

/// Puts a checked scene at its start on that rung.
#[must_use]
pub fn simulation(
    scene: &Scene,
    grid: StepGrid,
    settings: ImpulseSettings,
) -> Box<dyn Simulation + Send> {
    let ImpulseSettings {
        integrator,
        drag,
        impacts,
    } = settings;
    macro_rules! rung {
        ($motion:ty) => {
            match impacts {
                Impacts::Overlap => Box::new(
                    ImpulseSimulation::<Stepped<$motion, Overlap<true>>>::with(scene, grid, drag),
                ),
                Impacts::OverlapInPlace => Box::new(ImpulseSimulation::<
                    Stepped<$motion, Overlap<false>>,
                >::with(scene, grid, drag)),
                Impacts::Swept | Impacts::Together => Box::new(ImpulseSimulation::<
                    Stepped<$motion, Sweep>,
                >::with(scene, grid, drag)),
            }
        };
    }
    match (integrator, drag) {
        (Integrator::SymplecticEuler, DragRule::Force) => rung!(Euler<false>),
        (Integrator::SymplecticEuler, DragRule::Exponential) => rung!(Euler<true>),
        (Integrator::VelocityVerlet, _) => rung!(Verlet),
        (Integrator::RungeKutta4, _) => rung!(RungeKutta),
        (Integrator::EnergyMomentum, _) => {
            Box::new(ImpulseSimulation::<Robust>::with(scene, grid, drag))
        }
        // Only the sweep takes steps of an integrator's own choice.
        (Integrator::DormandPrince, _) => Box::new(ImpulseSimulation::<
            Stepped<DormandPrince, Sweep>,
        >::with(scene, grid, drag)),
    }
}

/// The phases of a step, in order.
#[must_use]
pub fn phases(scene: &Scene, settings: ImpulseSettings) -> Vec<Phase> {
    let phases = Phases::of(scene, settings.drag);
    if settings.integrator == Integrator::EnergyMomentum {
        return robust::plan::plan(&phases);
    }
    let swept = matches!(settings.impacts, Impacts::Swept | Impacts::Together);
    let forces = [
        present(phases.forces, "clear", "forces to zero".to_owned()),
        present(
            phases.attraction.is_some(),
            "attraction",
            "every pair i < j".to_owned(),
        ),
        present(
            phases.drag.is_some(),
            "drag",
            "force -k v, explicit".to_owned(),
        ),
        present(
            !phases.springs.is_empty(),
            "springs",
            format!("{} spring-dampers, explicit", phases.springs.len()),
        ),
        present(phases.gravity.is_some(), "gravity", "force m g".to_owned()),
    ];
    let motion = motion_phases(&phases, settings.integrator);
    let push = match settings.impacts {
        Impacts::Overlap => true,
        Impacts::OverlapInPlace | Impacts::Swept | Impacts::Together => false,
    };
    let walls = |half_height: Option<f64>| if half_height.is_some() { 6 } else { 4 };
    let cushions = phases.cushions.map(|cushions| match (swept, push) {
        (true, _) => format!(
            "{} walls, mirror at the time of impact",
            walls(cushions.half_height)
        ),
        (false, true) => format!(
            "{} walls, one a ball and step: mirror, push (1+e) x overlap",
            walls(cushions.half_height)
        ),
        (false, false) => {
            format!(
                "{} walls, one a ball and step: mirror",
                walls(cushions.half_height)
            )
        }
    });
    let contacts = phases.contact.map(|_| match (swept, push) {
        (true, _) => "every pair i < j: impulse at the time of impact",
        (false, true) => "every pair i < j: impulse if approaching, push (1+e)/2 x overlap each",
        (false, false) => "every pair i < j: impulse if approaching",
    });
    let rest = if swept {
        "slower than the rest speed: stop, at that time"
    } else {
        "slower than the rest speed: stop"
    };
    let met = [
        present(phases.rest.is_some(), "rest", rest.to_owned()),
        cushions.map(|method| Phase::new("cushions", method)),
        contacts.map(|method| Phase::new("contacts", method)),
    ];
    let all = forces.into_iter().chain(motion).chain(met);
    all.flatten().collect()
}

fn present(present: bool, name: &'static str, method: String) -> Option<Phase> {
    present.then(|| Phase::new(name, method))
}

fn motion_phases(phases: &Phases, integrator: Integrator) -> [Option<Phase>; 3] {
    let drift = if phases.decay.is_some() {
        "x += v (1 - exp(-c dt))/c, v *= exp(-c dt), c = k/m"
    } else {
        "x += dt v"
    };
    match integrator {
        Integrator::SymplecticEuler => [
            present(phases.forces, "kick", "v += dt F/m".to_owned()),
            present(true, "drift", format!("{drift} (symplectic Euler)")),
            None,
        ],
        Integrator::VelocityVerlet => [
            present(
                phases.forces,
                "kick",
                "v += dt/2 F/m, by the midpoint rule with dampers".to_owned(),
            ),
            present(true, "drift", drift.to_owned()),
            present(
                phases.forces,
                "kick",
                "the other half (velocity Verlet)".to_owned(),
            ),
        ],
        Integrator::RungeKutta4 => [
            present(
                true,
                "motion",
                "four stages of all forces (Runge-Kutta)".to_owned(),
            ),
            None,
            None,
        ],
        // `robust` has a plan of its own.
        Integrator::DormandPrince | Integrator::EnergyMomentum => [
            present(
                true,
                "motion",
                "seven stages of all forces, steps by their own error".to_owned(),
            ),
            None,
            None,
        ],
    }
}
