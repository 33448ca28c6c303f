//! What Rapier from 0.34 on is called like: vectors of glam, and a `PhysicsWorld`.

use rapier3d::prelude::*;

pub fn vector([x, y, z]: [f64; 3]) -> Vector {
    Vector::new(x as Real, y as Real, z as Real)
}

fn array(vector: Vector) -> [f64; 3] {
    [vector.x, vector.y, vector.z].map(f64::from)
}

/// Position and velocity.
pub fn state(body: &RigidBody) -> ([f64; 3], [f64; 3]) {
    (array(body.translation()), array(body.linvel()))
}

pub fn point_mass(mass: f64) -> MassProperties {
    MassProperties::new(Vector::ZERO, mass as Real, Vector::ZERO)
}

pub fn groups(member: Group, meets: Group) -> InteractionGroups {
    InteractionGroups::new(member, meets, InteractionTestMode::And)
}

/// A world.
pub struct World(PhysicsWorld);

impl World {
    pub fn new(gravity: [f64; 3], step: f64, length_unit: f64) -> Self {
        Self(PhysicsWorld {
            gravity: vector(gravity),
            integration_parameters: IntegrationParameters {
                dt: step as Real,
                length_unit: length_unit as Real,
                ..IntegrationParameters::default()
            },
            ..PhysicsWorld::default()
        })
    }

    pub fn insert(
        &mut self,
        body: RigidBodyBuilder,
        ball: Option<ColliderBuilder>,
    ) -> RigidBodyHandle {
        let body = self.0.insert_body(body);
        if let Some(ball) = ball {
            self.0.insert_collider(ball, Some(body));
        }
        body
    }

    pub fn insert_wall(&mut self, wall: ColliderBuilder) {
        self.0.insert_collider(wall, None);
    }

    pub fn bodies(&self) -> &RigidBodySet {
        &self.0.bodies
    }

    pub fn bodies_mut(&mut self) -> &mut RigidBodySet {
        &mut self.0.bodies
    }

    pub fn step(&mut self) {
        self.0.step();
    }
}
