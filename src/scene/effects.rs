//! The physical ingredients of a scene. An effect that is not declared does not exist.

use serde::{Deserialize, Serialize};

use super::file::exactly;

/// The effects that a scene declares; each is absent unless the scene names it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Effects {
    /// Spheres collide.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<Contact>,
    /// A box of walls round the origin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cushions: Option<Cushions>,
    /// Resistance proportional to velocity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drag: Option<Drag>,
    /// Slow balls stop.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rest: Option<Rest>,
    /// Every pair attracts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attraction: Option<Attraction>,
    /// Uniform gravity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity: Option<Gravity>,
    /// Spring-dampers between pairs of bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub springs: Vec<Spring>,
}

/// Impacts between spheres.
///
/// Equation: `v_n' = -e v_n` along the line of centres. Valid for 0 <= e <= 1.
/// Source: lecture, "비탄성 충돌" (inelastic collision).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Coefficient of restitution e, 0..1.
    pub restitution: f64,
}

/// Walls at `|x| = half_width` and `|z| = half_length`; y is free unless `half_height` closes it.
///
/// Source: lecture, "당구게임" (billiards game), `cushion()`; the walls in y are carom's own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cushions {
    /// Distance of the walls -x and +x from the origin, scene length unit.
    pub half_width: f64,
    /// Distance of the walls -z and +z from the origin, scene length unit.
    pub half_length: f64,
    /// Distance of the walls -y and +y from the origin, scene length unit; open without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub half_height: Option<f64>,
    /// Coefficient of restitution, 0..1.
    pub restitution: f64,
}

impl Cushions {
    /// Distances of the walls from the origin along x, y and z; infinite where the box is open.
    #[must_use]
    pub fn half_extents(&self) -> [f64; 3] {
        let half_height = self.half_height.unwrap_or(f64::INFINITY);
        [self.half_width, half_height, self.half_length]
    }
}

/// Drag `F = -k v`.
///
/// Source: lecture, "당구게임", `floorDrag()`; also the first, simple damper of
/// "스프링과 댐퍼" (springs and dampers).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// k, kg/s.
    pub coefficient: f64,
}

/// A ball slower than `speed` stops.
///
/// Source: lecture, "당구게임", `CParticle::simulate()`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rest {
    /// Speed below which a ball stops, scene length unit per second.
    pub speed: f64,
}

/// Mutual attraction `F = G m_a m_b d / (d² + s²)^(3/2)`.
///
/// Source: lecture, "충돌" (collisions), `computeAttraction()`; the softening s is carom's own,
/// and s = 0 is the slides' expression.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attraction {
    /// G, length³/(kg s²).
    pub constant: f64,
    /// s, scene length unit.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub softening: f64,
}

/// Uniform gravity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gravity {
    /// Acceleration, scene length unit per second squared.
    #[serde(deserialize_with = "exactly")]
    pub acceleration: [f64; 3],
}

/// A spring with a damper on the relative velocity of its ends.
///
/// Equation: on body a, `k (l - l0) (x_b - x_a)/l + kd (v_b - v_a)`; the opposite on b. The
/// damper takes the full relative velocity, not only its part along the spring.
/// Source: lecture, "스프링과 댐퍼", "최종 모델" (final model).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spring {
    /// Names of bodies a and b.
    #[serde(deserialize_with = "exactly")]
    pub between: [String; 2],
    /// k, kg/s².
    pub stiffness: f64,
    /// l0, scene length unit.
    pub rest_length: f64,
    /// kd, kg/s.
    pub damping: f64,
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "the signature serde asks for"
)]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Effects {
    /// Whether the model keeps the total energy: nothing dissipates and nothing drives.
    #[must_use]
    pub fn conserve_energy(&self) -> bool {
        self.contact
            .is_none_or(|contact| contact.restitution == 1.0)
            && self
                .cushions
                .is_none_or(|cushions| cushions.restitution == 1.0)
            && self.drag.is_none_or(|drag| drag.coefficient == 0.0)
            && self.rest.is_none_or(|rest| rest.speed == 0.0)
            && self.springs.iter().all(|spring| spring.damping == 0.0)
    }

    /// Whether the model keeps the total momentum: no wall, drag, rest or uniform gravity.
    #[must_use]
    pub fn conserve_momentum(&self) -> bool {
        self.cushions.is_none()
            && self.drag.is_none_or(|drag| drag.coefficient == 0.0)
            && self.rest.is_none_or(|rest| rest.speed == 0.0)
            && self
                .gravity
                .is_none_or(|gravity| gravity.acceleration == [0.0; 3])
    }

    /// Whether the model keeps the total angular momentum: what keeps the momentum, and no
    /// damper, whose force on the full relative velocity does not point along its spring.
    #[must_use]
    pub fn conserve_angular_momentum(&self) -> bool {
        self.conserve_momentum() && self.springs.iter().all(|spring| spring.damping == 0.0)
    }
}
