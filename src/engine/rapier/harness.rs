//! What carom itself adds to a Rapier world before each step: forces that Rapier has no
//! feature for, or that are wanted as the lecture computes them.

use super::layout::Layout;
use super::world::World;
use crate::engine::Forces;
use crate::physics::{BodyState, SpringDamper, Vector3, attraction, length};
use crate::recording::initial_states;
use crate::scene::{Attraction, Drag, Scene};

/// Forces by the lecture's formulas, in 64 bits, in the lecture's order.
///
/// A force stays on a Rapier body until it is replaced; so each step replaces it.
#[derive(Debug)]
pub(super) struct Harness {
    attraction: Option<Attraction>,
    drag: Option<Drag>,
    springs: Vec<SpringDamper>,
    gravity: Option<Vector3>,
    step: f64,
    masses: Vec<f64>,
    states: Vec<BodyState>,
    forces: Vec<Vector3>,
}

impl Harness {
    /// The forces that this scene needs from outside; none for most scenes.
    pub fn new(scene: &Scene, layout: &Layout) -> Option<Self> {
        let effects = &scene.effects;
        let lecture = layout.settings.forces == Forces::Lecture;
        let harness = Self {
            attraction: effects.attraction,
            drag: effects.drag.filter(|_| lecture),
            springs: if lecture {
                SpringDamper::all(scene)
            } else {
                Vec::new()
            },
            gravity: effects
                .gravity
                .filter(|_| lecture)
                .map(|g| g.acceleration.into()),
            step: layout.step,
            masses: layout.bodies.iter().map(|body| body.mass).collect(),
            states: initial_states(scene),
            forces: vec![Vector3::zeros(); scene.bodies.len()],
        };
        (harness.evaluations() > 0).then_some(harness)
    }

    /// Pair and body forces evaluated a step.
    pub fn evaluations(&self) -> u64 {
        let bodies = self.masses.len() as u64;
        let pairs = bodies * bodies.saturating_sub(1) / 2;
        let each = u64::from(self.drag.is_some()) + u64::from(self.gravity.is_some());
        u64::from(self.attraction.is_some()) * pairs + each * bodies + self.springs.len() as u64
    }

    /// Puts the forces of the present states on the bodies.
    ///
    /// Gives the first body that they would make too fast for the squares of its velocity.
    pub fn apply<W: World>(&mut self, world: &mut W) -> Option<usize> {
        for (body, state) in self.states.iter_mut().enumerate() {
            *state = world.state(body);
        }
        self.evaluate();
        let mut out_of_range = None;
        for (body, force) in self.forces.iter().enumerate() {
            let kick = force * (1.0 / self.masses[body]) * self.step;
            let speed = length(&(self.states[body].velocity + kick));
            if !W::RANGE.holds(speed) {
                out_of_range = out_of_range.or(Some(body));
            }
            world.set_force(body, force);
        }
        out_of_range
    }

    fn evaluate(&mut self) {
        let Self {
            states,
            forces,
            masses,
            ..
        } = self;
        forces.fill(Vector3::zeros());
        if let Some(effect) = self.attraction {
            attract(effect, masses, states, forces);
        }
        if let Some(effect) = self.drag {
            for (force, state) in forces.iter_mut().zip(&*states) {
                *force += state.velocity * -effect.coefficient;
            }
        }
        for spring in &self.springs {
            let [a, b] = spring.ends.map(|end| &states[end]);
            let force = spring.force([&a.position, &b.position], [&a.velocity, &b.velocity]);
            forces[spring.ends[0]] += force;
            forces[spring.ends[1]] += -force;
        }
        if let Some(acceleration) = self.gravity {
            for (force, mass) in forces.iter_mut().zip(&*masses) {
                *force += acceleration * *mass;
            }
        }
    }
}

/// Every pair i < j, as the lecture's loop.
fn attract(effect: Attraction, masses: &[f64], states: &[BodyState], forces: &mut [Vector3]) {
    for i in 0..states.len() {
        for j in i + 1..states.len() {
            let force = attraction(
                effect.constant,
                effect.softening,
                [masses[i], masses[j]],
                &states[i].position,
                &states[j].position,
            );
            forces[i] += force;
            forces[j] += -force;
        }
    }
}
