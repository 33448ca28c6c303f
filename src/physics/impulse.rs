//! The impulse law of a frictionless impact.

/// Impulse along the line of centres that an impact of two spheres transfers, on a along the
/// normal, on b against it.
///
/// Equation: `J = -(1 + e) v_r / (1/m_a + 1/m_b)` with `v_r = (v_a - v_b) . n`, negative when
/// the spheres approach; the normal n points from b to a.
/// Units: kg times scene length unit per second.
/// Valid for: strict approach, `approach_velocity < 0`; the caller decides.
/// Source: lecture, "비탄성 충돌" (inelastic collision), "충격량" (impulse).
///
/// ```
/// // Equal masses, elastic: each takes over the other's velocity.
/// let impulse = carom::physics::contact_impulse(1.0, 2.0, 2.0, -3.0);
/// assert_eq!(impulse, 6.0);
/// ```
#[must_use]
#[inline]
pub fn contact_impulse(restitution: f64, mass_a: f64, mass_b: f64, approach_velocity: f64) -> f64 {
    let (e, vr) = (restitution, approach_velocity);
    -vr * (e + 1.0) / (1.0 / mass_a + 1.0 / mass_b)
}

/// Impulse that a wall gives a body, along the wall's inward normal.
///
/// Equation: `J = m (1 + e) |v_n|`.
/// Units: kg times scene length unit per second.
/// Source: lecture, "당구게임" (billiards game), `cushion()`, where e = 1.
#[must_use]
#[inline]
pub fn cushion_impulse(restitution: f64, mass: f64, normal_velocity: f64) -> f64 {
    mass * (1.0 + restitution) * normal_velocity.abs()
}
