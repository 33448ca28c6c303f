//! Settings of the hand-written impulse solver.

use serde::Serialize;

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

impl Integrator {
    /// Those that a search may combine with others; the one of `robust` comes with all of it.
    pub const ALL: [Self; 4] = [
        Self::SymplecticEuler,
        Self::VelocityVerlet,
        Self::RungeKutta4,
        Self::DormandPrince,
    ];
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

impl DragRule {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Force, Self::Exponential];
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

impl Impacts {
    /// Those that a search may combine with others; the one of `robust` comes with all of it.
    pub const ALL: [Self; 3] = [Self::Overlap, Self::OverlapInPlace, Self::Swept];
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

    /// The same with what its integrator leaves no choice of: Runge-Kutta methods take drag as
    /// one of the forces, and steps of an integrator's own are taken by the sweep alone.
    #[must_use]
    pub fn sound(self) -> Self {
        match self.integrator {
            Integrator::SymplecticEuler | Integrator::VelocityVerlet => self,
            Integrator::RungeKutta4 => Self {
                drag: DragRule::Force,
                ..self
            },
            Integrator::DormandPrince => Self {
                drag: DragRule::Force,
                impacts: Impacts::Swept,
                ..self
            },
            Integrator::EnergyMomentum => Self {
                drag: DragRule::Exponential,
                impacts: Impacts::Together,
                ..self
            },
        }
    }

    /// Every setting by its name and its value.
    #[must_use]
    pub fn parameters(self) -> Vec<(&'static str, String)> {
        let integrator = match self.integrator {
            Integrator::SymplecticEuler => "symplectic-euler",
            Integrator::VelocityVerlet => "velocity-verlet",
            Integrator::RungeKutta4 => "runge-kutta-4",
            Integrator::DormandPrince => "dormand-prince",
            Integrator::EnergyMomentum => "energy-momentum",
        };
        let drag = match self.drag {
            DragRule::Force => "force",
            DragRule::Exponential => "exponential",
        };
        let impacts = match self.impacts {
            Impacts::Overlap => "overlap",
            Impacts::OverlapInPlace => "overlap-in-place",
            Impacts::Swept => "swept",
            Impacts::Together => "together",
        };
        vec![
            ("integrator", integrator.to_owned()),
            ("drag", drag.to_owned()),
            ("impacts", impacts.to_owned()),
        ]
    }

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

    pub(super) fn describe(self) -> String {
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
