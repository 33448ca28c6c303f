//! What Rapier up to 0.31 is called like: vectors of nalgebra, and no bundle of a world's parts.

use rapier3d::prelude::*;

pub fn vector([x, y, z]: [f64; 3]) -> Vector<Real> {
    Vector::new(x as Real, y as Real, z as Real)
}

fn array(vector: &Vector<Real>) -> [f64; 3] {
    [vector.x, vector.y, vector.z].map(f64::from)
}

/// Position and velocity.
pub fn state(body: &RigidBody) -> ([f64; 3], [f64; 3]) {
    (array(body.translation()), array(body.linvel()))
}

pub fn point_mass(mass: f64) -> MassProperties {
    MassProperties::new(Point::origin(), mass as Real, Vector::zeros())
}

pub fn groups(member: Group, meets: Group) -> InteractionGroups {
    InteractionGroups::new(member, meets)
}

/// The parts of a world.
pub struct World {
    gravity: Vector<Real>,
    parameters: IntegrationParameters,
    pipeline: PhysicsPipeline,
    islands: IslandManager,
    broad_phase: DefaultBroadPhase,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    impulse_joints: ImpulseJointSet,
    multibody_joints: MultibodyJointSet,
    ccd_solver: CCDSolver,
}

impl World {
    pub fn new(gravity: [f64; 3], step: f64, length_unit: f64) -> Self {
        Self {
            gravity: vector(gravity),
            parameters: IntegrationParameters {
                dt: step as Real,
                length_unit: length_unit as Real,
                ..IntegrationParameters::default()
            },
            pipeline: PhysicsPipeline::new(),
            islands: IslandManager::new(),
            broad_phase: DefaultBroadPhase::new(),
            narrow_phase: NarrowPhase::new(),
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            impulse_joints: ImpulseJointSet::new(),
            multibody_joints: MultibodyJointSet::new(),
            ccd_solver: CCDSolver::new(),
        }
    }

    pub fn insert(
        &mut self,
        body: RigidBodyBuilder,
        ball: Option<ColliderBuilder>,
    ) -> RigidBodyHandle {
        let body = self.bodies.insert(body);
        if let Some(ball) = ball {
            self.colliders
                .insert_with_parent(ball, body, &mut self.bodies);
        }
        body
    }

    pub fn insert_wall(&mut self, wall: ColliderBuilder) {
        self.colliders.insert(wall);
    }

    pub fn bodies(&self) -> &RigidBodySet {
        &self.bodies
    }

    pub fn bodies_mut(&mut self) -> &mut RigidBodySet {
        &mut self.bodies
    }

    pub fn step(&mut self) {
        self.pipeline.step(
            &self.gravity,
            &self.parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            &mut self.impulse_joints,
            &mut self.multibody_joints,
            &mut self.ccd_solver,
            #[cfg(feature = "query-pipeline")]
            None,
            &(),
            &(),
        );
    }
}
