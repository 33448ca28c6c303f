//! Forces, kick, drift and rest. What a body does by itself is a function of that body; what
//! joins bodies, one of all of them.

use super::observer::Observer;
use super::{Particle, books};
use crate::physics::{SpringDamper, Vector3, attraction, length};
use crate::recording::{Account, EventKind};
use crate::scene::{Attraction, Drag, Rest};

/// Slides' `resetForce()`.
#[inline]
pub(super) fn clear(particle: &mut Particle) {
    particle.force = Vector3::zeros();
}

/// Slides' loop over `computeAttraction(i, j)`, i < j.
#[inline]
pub(super) fn attract(particles: &mut [Particle], effect: Attraction) {
    for i in 0..particles.len() {
        let (head, tail) = particles.split_at_mut(i + 1);
        let a = &mut head[i];
        for b in tail {
            let masses = [a.mass, b.mass];
            let force = attraction(
                effect.constant,
                effect.softening,
                masses,
                &a.position,
                &b.position,
            );
            a.force += force;
            b.force += -force;
        }
    }
}

/// Slides' `floorDrag()`.
#[inline]
pub(super) fn drag(particle: &mut Particle, effect: Drag) {
    particle.force += particle.velocity * -effect.coefficient;
}

/// Slides' final model of the spring-damper, spring by spring.
#[inline]
pub(super) fn springs(particles: &mut [Particle], springs: &[SpringDamper]) {
    for spring in springs {
        let [a, b] = spring.ends.map(|end| &particles[end]);
        let force = spring.force([&a.position, &b.position], [&a.velocity, &b.velocity]);
        particles[spring.ends[0]].force += force;
        particles[spring.ends[1]].force += -force;
    }
}

/// Uniform gravity, which the slides' particle has a field for and never uses.
#[inline]
pub(super) fn gravity(particle: &mut Particle, acceleration: &Vector3) {
    particle.force += acceleration * particle.mass;
}

/// First line of slides' `forceIntegration()`: `vel = vel + dt*((1.0/mass) * force)`.
#[inline]
pub(super) fn kick(particle: &mut Particle, dt: f64) {
    particle.velocity += particle.force * (1.0 / particle.mass) * dt;
}

/// Second line of slides' `forceIntegration()`: `loc = loc + dt*vel`.
#[inline]
pub(super) fn drift(particle: &mut Particle, dt: f64) {
    particle.position += particle.velocity * dt;
}

/// Last line of slides' `simulate()`: slower than the rest speed is standing.
#[inline]
pub(super) fn rest<O: Observer>(particles: &mut [Particle], effect: Rest, observer: &mut O) {
    for (body, particle) in particles.iter_mut().enumerate() {
        let speed = length(&particle.velocity);
        if speed < effect.speed {
            if speed > 0.0 {
                observer.note(EventKind::Rest { body }, particle.mass * speed);
                if O::BOOKS {
                    let entry = books::rest(particle.mass, &particle.velocity);
                    observer.book(Account::Rest, entry);
                }
            }
            particle.velocity = Vector3::zeros();
        }
    }
}
