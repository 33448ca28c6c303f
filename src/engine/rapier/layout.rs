//! What a scene calls for in a Rapier world, in plain numbers: only what it declares.

use super::range::Range;
use crate::engine::{CcdBody, Forces, LengthScale, RapierSettings};
use crate::error::Result;
use crate::physics::SpringDamper;
use crate::recording::Wall;
use crate::scene::{Cushions, Scene};

/// How the restitutions of two colliders combine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Combine {
    /// The smaller value.
    Min,
    /// The larger value; outranks `Min`.
    Max,
}

/// A body: a sphere that does not turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BodyPlan {
    pub mass: f64,
    pub radius: f64,
    /// Linear damping c = k/m, 1/s.
    pub damping: f64,
}

/// A wall: a fixed half-space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WallPlan {
    pub wall: Wall,
    /// Distance from the origin.
    pub distance: f64,
}

/// Everything that a world is built from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    pub settings: RapierSettings,
    /// The step, s.
    pub step: f64,
    /// The length of normalised parameters, scene length unit.
    pub length_unit: f64,
    pub bodies: Vec<BodyPlan>,
    /// The body that is swept against the others; none where nothing collides with it.
    pub ccd_body: Option<usize>,
    /// Whether balls collide with each other.
    pub balls_collide: bool,
    pub ball_restitution: f64,
    pub walls: Vec<WallPlan>,
    pub wall_restitution: f64,
    pub wall_rule: Combine,
    /// Rapier's own gravity.
    pub gravity: Option<[f64; 3]>,
    /// Rapier's own springs.
    pub springs: Vec<SpringDamper>,
}

impl Layout {
    /// Lays out a checked scene.
    ///
    /// # Errors
    /// [`Error::EngineCannot`](crate::error::Error::EngineCannot) if a number means nothing in the precision asked for.
    pub fn new(scene: &Scene, settings: &RapierSettings, step: f64) -> Result<Self> {
        let effects = &scene.effects;
        let native = settings.forces == Forces::Native;
        let drag = effects
            .drag
            .filter(|_| native)
            .map_or(0.0, |drag| drag.coefficient);
        let gravity = effects.gravity.filter(|_| native);
        let bodies = scene.bodies.iter().map(|body| BodyPlan {
            mass: body.mass,
            radius: body.radius,
            damping: drag / body.mass,
        });
        let wall_restitution = effects
            .cushions
            .map_or(0.0, |cushions| cushions.restitution);
        let ball_restitution = effects
            .contact
            .map_or(wall_restitution, |contact| contact.restitution);
        let layout = Self {
            settings: settings.clone(),
            step,
            length_unit: length_unit(scene, settings.length_scale),
            bodies: bodies.collect(),
            ccd_body: match settings.ccd_body {
                CcdBody::None => None,
                CcdBody::Fastest => effects.contact.map(|_| scene.fastest_body()),
            },
            balls_collide: effects.contact.is_some(),
            ball_restitution,
            walls: effects.cushions.iter().flat_map(walls).collect(),
            wall_restitution,
            wall_rule: wall_rule(ball_restitution, wall_restitution),
            gravity: gravity.map(|gravity| gravity.acceleration),
            springs: if native { joints(scene) } else { Vec::new() },
        };
        layout.check(scene)?;
        Ok(layout)
    }

    /// Whether anything collides: without, there are no colliders at all.
    pub fn has_colliders(&self) -> bool {
        self.balls_collide || !self.walls.is_empty()
    }

    /// Refuses numbers that the precision cannot hold, where that would change the scene
    /// without a word: a radius of zero, a mass that nothing moves. States are not refused;
    /// they may run out of range later as well, and then end the run.
    fn check(&self, scene: &Scene) -> Result<()> {
        let range = Range::of(self.settings.precision);
        range.positive("step", self.step)?;
        range.positive("length_unit", self.length_unit)?;
        for (index, plan) in self.bodies.iter().enumerate() {
            let field =
                |name: &str| format!("bodies[{index}].{name} (`{}`)", scene.bodies[index].name);
            range.positive(&field("radius"), plan.radius)?;
            range.mass(&field("mass"), plan.mass, self.needs_inverse_mass())?;
            range.at_most(&field("drag rate k/m"), plan.damping)?;
        }
        for plan in &self.walls {
            range.positive(
                &format!("distance of the wall {}", plan.wall),
                plan.distance,
            )?;
        }
        for (axis, value) in self.gravity.iter().flatten().enumerate() {
            range.at_most(&format!("effects.gravity.acceleration[{axis}]"), *value)?;
        }
        for (index, plan) in self.springs.iter().enumerate() {
            let field = |name: &str| format!("effects.springs[{index}].{name}");
            range.at_most(&field("stiffness"), plan.stiffness)?;
            range.at_most(&field("rest_length"), plan.rest_length)?;
            range.at_most(&field("damping"), plan.damping)?;
        }
        Ok(())
    }

    /// Refuses springs so weak that Rapier makes rigid bars of them; see [`joints`].
    ///
    /// # Errors
    /// [`Error::EngineCannot`](crate::error::Error::EngineCannot).
    pub fn check_joints(&self, scene: &Scene, substeps: usize) -> Result<()> {
        #[allow(clippy::cast_precision_loss, reason = "a handful of substeps")]
        let h = self.step / substeps as f64;
        let range = Range::of(self.settings.precision);
        let joined = scene.effects.springs.iter().enumerate();
        let joined = joined.filter(|(_, spring)| spring.stiffness > 0.0 || spring.damping > 0.0);
        for ((index, _), plan) in joined.zip(&self.springs) {
            range.spring(index, h * (h * plan.stiffness + plan.damping))?;
        }
        Ok(())
    }

    /// Whether the world does anything that divides by a sum of inverse masses.
    fn needs_inverse_mass(&self) -> bool {
        self.has_colliders() || self.gravity.is_some() || !self.springs.is_empty()
    }
}

/// Rapier's `length_unit` on a scene, scene length unit.
pub(super) fn length_unit(scene: &Scene, scale: LengthScale) -> f64 {
    let radii = scene.bodies.iter().map(|body| body.radius);
    match scale {
        LengthScale::Metre => scene.units.length.per_metre(),
        LengthScale::SmallestRadius(times) => times * radii.fold(f64::INFINITY, f64::min),
    }
}

/// The rule of the walls, so that a wall's own restitution holds against the balls' `Min`.
fn wall_rule(ball_restitution: f64, wall_restitution: f64) -> Combine {
    if wall_restitution > ball_restitution {
        Combine::Max
    } else {
        Combine::Min
    }
}

fn walls(cushions: &Cushions) -> impl Iterator<Item = WallPlan> {
    let distance = [
        Some(cushions.half_width),
        cushions.half_height,
        Some(cushions.half_length),
    ];
    Wall::ALL.into_iter().filter_map(move |wall| {
        Some(WallPlan {
            wall,
            distance: distance[wall.axis_and_side().0]?,
        })
    })
}

/// The springs that become joints.
///
/// A spring without stiffness and damping is left out: Rapier divides 1 by
/// `h (h k + kd)` and takes the inverse of nothing for zero, so that such a joint is a rigid
/// bar instead of no spring.
fn joints(scene: &Scene) -> Vec<SpringDamper> {
    let mut joints = SpringDamper::all(scene);
    joints.retain(|spring| spring.stiffness > 0.0 || spring.damping > 0.0);
    joints
}
