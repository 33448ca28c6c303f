//! The names of the effects, for what is said of each.

use serde::Serialize;

use super::Scene;

/// One physical ingredient of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Effect {
    /// Spheres collide; it has no neutral value.
    Contact,
    /// A box of walls; it has no neutral value.
    Cushions,
    /// Resistance; neutral at coefficient 0.
    Drag,
    /// Slow balls stop; neutral at speed 0.
    Rest,
    /// Every pair attracts; neutral at constant 0.
    Attraction,
    /// Uniform gravity; neutral at acceleration 0.
    Gravity,
    /// All spring-dampers together; neutral without stiffness and damping.
    Springs,
}

impl Effect {
    /// Every effect, in the order in which scenes declare them.
    pub const ALL: [Self; 7] = [
        Self::Contact,
        Self::Cushions,
        Self::Drag,
        Self::Rest,
        Self::Attraction,
        Self::Gravity,
        Self::Springs,
    ];

    /// The name that scene files, tables and plans share.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::Cushions => "cushions",
            Self::Drag => "drag",
            Self::Rest => "rest",
            Self::Attraction => "attraction",
            Self::Gravity => "gravity",
            Self::Springs => "springs",
        }
    }

    /// Whether a scene declares it.
    #[must_use]
    pub fn is_declared(self, scene: &Scene) -> bool {
        let effects = &scene.effects;
        match self {
            Self::Contact => effects.contact.is_some(),
            Self::Cushions => effects.cushions.is_some(),
            Self::Drag => effects.drag.is_some(),
            Self::Rest => effects.rest.is_some(),
            Self::Attraction => effects.attraction.is_some(),
            Self::Gravity => effects.gravity.is_some(),
            Self::Springs => !effects.springs.is_empty(),
        }
    }
}
