//! The worlds of both precisions, from one source: all that depends on Rapier's crates.

use super::layout::{Combine, Layout};
use super::range::Range;
use super::world::{Parameters, Sleep, World};
use crate::engine::RapierSettings;
use crate::physics::{BodyState, Vector3};

pub(super) use double::PhysicsWorldDouble as Double;
pub(super) use single::PhysicsWorldSingle as Single;

/// Defines the module `$module` with the world `$World` on the crate `$rapier`.
macro_rules! rapier_world {
    ($module:ident, $World:ident, $rapier:ident, $real:ident, $range:ident) => {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::unnecessary_cast,
            clippy::useless_conversion,
            reason = "one source for both precisions: rounding to the crate's own is its purpose"
        )]
        mod $module {
            use super::{
                BodyState, Combine, Layout, Parameters, Range, RapierSettings, Sleep, Vector3,
                World,
            };
            use $rapier::prelude::*;

            /// A world of this crate, and its bodies in the scene's order.
            pub struct $World {
                world: PhysicsWorld,
                bodies: Vec<RigidBodyHandle>,
                /// Whether bodies may sleep, and so must be awakened.
                sleeping: bool,
            }

            fn vector(v: &Vector3) -> Vector {
                Vector::new(v.x as $real, v.y as $real, v.z as $real)
            }

            fn vector3(v: Vector) -> Vector3 {
                Vector3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
            }

            fn integration_parameters(
                settings: &RapierSettings,
                length_unit: f64,
                step: f64,
            ) -> IntegrationParameters {
                let mut p = IntegrationParameters {
                    dt: step as $real,
                    length_unit: length_unit as $real,
                    ..IntegrationParameters::default()
                };
                if let Some(iterations) = settings.solver_iterations {
                    p.num_solver_iterations = iterations;
                }
                if let Some(distance) = settings.prediction_distance {
                    p.normalized_prediction_distance = distance as $real;
                }
                if let Some(recycling) = settings.contact_recycling {
                    p.contact_recycling = recycling;
                }
                if let Some(passes) = settings.max_ccd_substeps {
                    p.max_ccd_substeps = passes;
                }
                if !settings.speed_cap {
                    p.normalized_max_linear_velocity = $real::MAX;
                }
                p
            }

            fn sleep(length_unit: f64) -> Sleep {
                let defaults = RigidBodyActivation::default();
                // Rapier 0.36 compares half of a body's motion in a step with the threshold
                // (`RigidBodyActivation::update_energy`).
                Sleep {
                    speed: 2.0 * f64::from(defaults.normalized_linear_threshold) * length_unit,
                    after: f64::from(defaults.time_until_sleep),
                }
            }

            fn collider(layout: &Layout, shape: ColliderBuilder) -> ColliderBuilder {
                // Balls in group 1, walls in group 2; without a contact effect balls meet
                // walls alone. No mass: the body has the scene's own.
                let meets = if layout.balls_collide {
                    Group::ALL
                } else {
                    Group::GROUP_2
                };
                shape
                    .friction(0.0)
                    .friction_combine_rule(CoefficientCombineRule::Min)
                    .mass_properties(MassProperties::default())
                    .restitution(layout.ball_restitution as $real)
                    .restitution_combine_rule(CoefficientCombineRule::Min)
                    .collision_groups(InteractionGroups::new(
                        Group::GROUP_1,
                        meets,
                        InteractionTestMode::And,
                    ))
            }

            impl $World {
                fn insert_ball(&mut self, layout: &Layout, index: usize, state: &BodyState) {
                    let plan = &layout.bodies[index];
                    let body = RigidBodyBuilder::dynamic()
                        .translation(vector(&state.position))
                        .linvel(vector(&state.velocity))
                        .linear_damping(plan.damping as $real)
                        .additional_mass_properties(MassProperties::new(
                            Vector::ZERO,
                            plan.mass as $real,
                            Vector::ZERO,
                        ))
                        .lock_rotations()
                        .can_sleep(layout.settings.sleeping)
                        .ccd_enabled(layout.ccd_body == Some(index))
                        .user_data(index as u128);
                    let handle = self.world.insert_body(body);
                    self.bodies.push(handle);
                    if layout.has_colliders() {
                        let ball = ColliderBuilder::ball(plan.radius as $real);
                        let ball = collider(layout, ball).user_data(index as u128);
                        self.world.insert_collider(ball, Some(handle));
                    }
                }

                fn insert_walls(&mut self, layout: &Layout) {
                    let rule = match layout.wall_rule {
                        Combine::Min => CoefficientCombineRule::Min,
                        Combine::Max => CoefficientCombineRule::Max,
                    };
                    for (index, plan) in layout.walls.iter().enumerate() {
                        let (axis, side) = plan.wall.axis_and_side();
                        let mut outward = Vector3::zeros();
                        outward[axis] = side;
                        let inward = $rapier::na::Unit::new_unchecked(vector(&-outward));
                        let wall = collider(layout, ColliderBuilder::halfspace(inward))
                            .translation(vector(&(outward * plan.distance)))
                            .restitution(layout.wall_restitution as $real)
                            .restitution_combine_rule(rule)
                            .collision_groups(InteractionGroups::new(
                                Group::GROUP_2,
                                Group::GROUP_1,
                                InteractionTestMode::And,
                            ))
                            .user_data((layout.bodies.len() + index) as u128);
                        self.world.insert_collider(wall, None);
                    }
                }

                fn insert_springs(&mut self, layout: &Layout) {
                    for plan in &layout.springs {
                        let [a, b] = plan.ends.map(|end| self.bodies[end]);
                        let spring = SpringJointBuilder::new(
                            plan.rest_length as $real,
                            plan.stiffness as $real,
                            plan.damping as $real,
                        )
                        .contacts_enabled(true);
                        self.world.insert_impulse_joint(a, b, spring);
                    }
                }

                /// What the world holds beyond bodies, by name; none of it is there unasked.
                #[cfg(test)]
                pub fn extras(&self) -> super::Extras {
                    let world = &self.world;
                    let no_events = |collider: &Collider| {
                        collider.active_events().is_empty()
                            && collider.active_hooks().is_empty()
                            && collider.contact_skin() == 0.0
                    };
                    super::Extras {
                        joints: world.impulse_joints.len(),
                        multibody_joints: world.multibody_joints.iter().count(),
                        colliders: world.colliders.len(),
                        listening: world
                            .colliders
                            .iter()
                            .filter(|(_, collider)| !no_events(collider))
                            .count(),
                        swept: world
                            .bodies
                            .iter()
                            .filter(|(_, body)| {
                                body.is_ccd_enabled() || body.soft_ccd_prediction() != 0.0
                            })
                            .count(),
                        falls: world.gravity != Vector::ZERO,
                    }
                }

                fn party(&self, collider: ColliderHandle) -> usize {
                    self.world.colliders[collider].user_data as usize
                }
            }

            impl World for $World {
                const RANGE: Range = Range::$range;

                fn build(layout: &Layout, states: &[BodyState]) -> Self {
                    let world = PhysicsWorld {
                        gravity: layout.gravity.map_or(Vector::ZERO, |g| vector(&g.into())),
                        integration_parameters: integration_parameters(
                            &layout.settings,
                            layout.length_unit,
                            layout.step,
                        ),
                        ..PhysicsWorld::default()
                    };
                    let mut this = Self {
                        world,
                        bodies: Vec::with_capacity(states.len()),
                        sleeping: layout.settings.sleeping,
                    };
                    for (index, state) in states.iter().enumerate() {
                        this.insert_ball(layout, index, state);
                    }
                    this.insert_walls(layout);
                    this.insert_springs(layout);
                    this
                }

                fn parameters(
                    settings: &RapierSettings,
                    length_unit: f64,
                    step: f64,
                ) -> Parameters {
                    let p = integration_parameters(settings, length_unit, step);
                    let cap = p.max_linear_velocity();
                    Parameters {
                        substeps: p.num_solver_iterations,
                        prediction_distance: f64::from(p.prediction_distance()),
                        recycle_distance: p
                            .contact_recycling
                            .then(|| f64::from(p.contact_recycle_distance())),
                        ccd_passes: p.max_ccd_substeps,
                        speed_cap: (cap < $real::MAX).then_some(f64::from(cap)),
                        push_out_speed: f64::from(p.max_corrective_velocity()),
                        sleep: settings.sleeping.then(|| sleep(length_unit)),
                    }
                }

                #[inline]
                fn step(&mut self) {
                    self.world.step();
                }

                #[inline]
                fn lost(&self) -> Option<usize> {
                    let quarantine = self.world.quarantine();
                    if quarantine.is_empty() {
                        return None;
                    }
                    let bodies = quarantine.bodies().iter();
                    let bodies = bodies.map(|body| self.world.bodies[*body].user_data as usize);
                    let colliders = quarantine.colliders().iter().map(|lost| self.party(*lost));
                    // A wall that is lost is lost to every ball: the last stands for all.
                    let last = self.bodies.len().saturating_sub(1);
                    Some(
                        bodies
                            .chain(colliders)
                            .min()
                            .map_or(last, |party| party.min(last)),
                    )
                }

                #[inline]
                fn pair_count(&self) -> u64 {
                    self.world.physics_pipeline.counters.cd.ncontact_pairs as u64
                }

                #[inline]
                fn state(&self, body: usize) -> BodyState {
                    let body = &self.world.bodies[self.bodies[body]];
                    BodyState {
                        position: vector3(body.translation()),
                        velocity: vector3(body.linvel()),
                    }
                }

                #[inline]
                fn velocity(&self, body: usize) -> Vector3 {
                    vector3(self.world.bodies[self.bodies[body]].linvel())
                }

                fn stop(&mut self, body: usize) {
                    self.world.bodies[self.bodies[body]].set_linvel(Vector::ZERO, self.sleeping);
                }

                #[inline]
                fn set_force(&mut self, body: usize, force: &Vector3) {
                    let body = &mut self.world.bodies[self.bodies[body]];
                    body.reset_forces(false);
                    body.add_force(vector(force), self.sleeping);
                }

                fn each_impulse(&self, mut visit: impl FnMut(usize, usize, f64)) {
                    for pair in self.world.narrow_phase.contact_pairs() {
                        let impulse = pair.total_impulse_magnitude();
                        if impulse != 0.0 {
                            let (a, b) = (self.party(pair.collider1), self.party(pair.collider2));
                            visit(a, b, f64::from(impulse));
                        }
                    }
                }
            }
        }
    };
}

rapier_world!(single, PhysicsWorldSingle, rapier3d, f32, SINGLE);
rapier_world!(double, PhysicsWorldDouble, rapier3d_f64, f64, DOUBLE);

/// What a world holds beyond bodies.
#[cfg(test)]
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Extras {
    joints: usize,
    multibody_joints: usize,
    colliders: usize,
    /// Colliders with events, hooks, or a margin that predicts contacts.
    listening: usize,
    /// Bodies with continuous collision detection of their own, or its soft prediction.
    swept: usize,
    falls: bool,
}

#[cfg(test)]
mod tests {
    use super::super::world::World;
    use super::{Double, Extras, Layout, Single};
    use crate::engine::{EngineKind, engine};
    use crate::recording::initial_states;

    /// Two balls; contact, walls, springs and gravity by the bits.
    fn extras(name: &str, declared: usize) -> Extras {
        let has = |bit: usize| declared & (1 << bit) != 0;
        let effects = [
            "[effects.contact]\nrestitution=0.5\n",
            "[effects.cushions]\nhalf_width=9\nhalf_length=9\nrestitution=1\n",
            "[[effects.springs]]\nbetween=['a','b']\nstiffness=9\nrest_length=1\ndamping=1\n",
            "[effects.gravity]\nacceleration=[0,-9.81,0]\n",
        ];
        let effects = effects.iter().enumerate().filter(|(bit, _)| has(*bit));
        let effects: String = effects.map(|(_, text)| *text).collect();
        let text = format!(
            "name='x'\nduration=1\nsample_every=0.5\n\
             [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[1,0,0]\n\
             [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[5,0,0]\nvelocity=[0,0,0]\n\
             {effects}"
        );
        let scene = crate::scene::parse(&text, "x").unwrap();
        let EngineKind::Rapier(settings) = engine(name).unwrap().kind else {
            panic!("{name} is no Rapier world")
        };
        let layout = Layout::new(&scene, &settings, 0.01).unwrap();
        let states = initial_states(&scene);
        if name == "rapier" {
            Single::build(&layout, &states).extras()
        } else {
            Double::build(&layout, &states).extras()
        }
    }

    /// No joints, events, hooks, continuous detection or margins where nothing calls for them;
    /// no colliders at all where nothing touches, so that nothing is predicted either.
    #[test]
    fn a_world_holds_what_its_scene_calls_for_and_nothing_else() {
        for name in ["rapier", "rapier-f64", "rapier-matched", "rapier-tuned"] {
            let native = name != "rapier-matched";
            for declared in 0..16 {
                let [contact, walls, springs, gravity] =
                    [1, 2, 4, 8].map(|bit: usize| declared & bit != 0);
                let balls = if contact || walls { 2 } else { 0 };
                let expected = Extras {
                    joints: usize::from(springs && native),
                    multibody_joints: 0,
                    colliders: balls + if walls { 4 } else { 0 },
                    listening: 0,
                    swept: 0,
                    falls: gravity && native,
                };
                assert_eq!(extras(name, declared), expected, "{name} {declared:04b}");
            }
        }
    }
}
