//! The hand-written impulse solver, phase by phase from the slides.
//!
//! One step, in the slides' order: clear forces; attraction, drag, springs, gravity; kick
//! `v += dt F/m`; drift `x += dt v`; rest; cushions; contacts. A phase that the scene does not
//! call for is not there.
//!
//! The other rungs of the ladder change one numerical choice at a time: `motion`,
//! `runge_kutta` and `dormand_prince` move the bodies, `handling` and `sweep` deal with what they
//! meet, `ladder` says which of them a name means.

mod books;
mod contacts;
mod cushions;
mod dormand_prince;
mod forces;
mod handling;
mod ladder;
mod meeting;
mod motion;
mod notes;
mod observer;
mod path;
mod phases;
mod robust;
mod runge_kutta;
mod scheme;
mod simulation;
mod sweep;

pub use ladder::{phases, simulation};
pub use notes::notes;
pub use simulation::ImpulseSimulation;

use crate::physics::Vector3;
use crate::scene::Scene;

/// A sphere as the solver keeps it, with what it needs of it side by side in memory.
#[derive(Debug, Clone)]
struct Particle {
    position: Vector3,
    velocity: Vector3,
    force: Vector3,
    mass: f64,
    radius: f64,
}

/// The particles of a scene at its start.
fn particles(scene: &Scene) -> Vec<Particle> {
    let states = crate::recording::initial_states(scene);
    let particle = |(body, state): (&crate::scene::Body, crate::physics::BodyState)| Particle {
        position: state.position,
        velocity: state.velocity,
        force: Vector3::zeros(),
        mass: body.mass,
        radius: body.radius,
    };
    scene.bodies.iter().zip(states).map(particle).collect()
}
