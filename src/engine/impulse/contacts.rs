//! Contacts between spheres: overlap, impulse, push apart.

use super::observer::Observer;
use super::{Particle, books};
use crate::physics::{Vector3, contact_impulse, length};
use crate::recording::{Account, EventKind};
use crate::scene::Contact;

/// Slides' loop over `collisionHandler(i, j)`, i < j.
#[inline]
pub(super) fn collide<const PUSH_OUT: bool, O: Observer>(
    particles: &mut [Particle],
    effect: Contact,
    observer: &mut O,
) {
    for i in 0..particles.len() {
        let (head, tail) = particles.split_at_mut(i + 1);
        let a = &mut head[i];
        for (offset, b) in tail.iter_mut().enumerate() {
            let apart = a.position - b.position;
            let distance = length(&apart);
            if distance < a.radius + b.radius {
                let impulse = separate::<PUSH_OUT>(a, b, &apart, distance, effect.restitution);
                if let Some(impulse) = impulse {
                    observer.note(
                        EventKind::Contact {
                            a: i,
                            b: i + 1 + offset,
                        },
                        impulse,
                    );
                    if O::BOOKS {
                        let entry = books::contact(effect.restitution, [a.mass, b.mass], impulse);
                        observer.book(Account::Contacts, entry);
                    }
                }
            }
        }
    }
}

/// Slides' `collisionHandler` once a collision is detected: the impulse if the spheres
/// approach, and the push-out whether they do or not.
///
/// Kept out of the loop: overlapping is rare, and the loop over pairs stays small.
#[inline(never)]
fn separate<const PUSH_OUT: bool>(
    a: &mut Particle,
    b: &mut Particle,
    apart: &Vector3,
    distance: f64,
    restitution: f64,
) -> Option<f64> {
    let penetration = a.radius + b.radius - distance;
    let normal = line_of_action(apart, distance, &a.velocity, &b.velocity);
    let impulse = strike(a, b, &normal, restitution);
    if PUSH_OUT {
        let push_out = normal * (0.5 * (1.0 + restitution) * penetration);
        a.position += push_out;
        b.position -= push_out;
    }
    impulse
}

/// The impulse of two touching spheres that approach; none if they do not.
pub(super) fn hit(a: &mut Particle, b: &mut Particle, restitution: f64) -> Option<f64> {
    let apart = a.position - b.position;
    let normal = line_of_action(&apart, length(&apart), &a.velocity, &b.velocity);
    strike(a, b, &normal, restitution)
}

/// Rate of the distance of two spheres, `apart` being from b to a.
pub(super) fn approach(apart: &Vector3, distance: f64, va: &Vector3, vb: &Vector3) -> f64 {
    (va - vb).dot(&line_of_action(apart, distance, va, vb))
}

#[inline]
pub(super) fn line_of_action(
    apart: &Vector3,
    distance: f64,
    va: &Vector3,
    vb: &Vector3,
) -> Vector3 {
    if distance > 0.0 {
        apart / distance
    } else {
        coincident_normal(va, vb)
    }
}

/// Slides' impulse along the line of action, from b to a.
#[inline]
fn strike(a: &mut Particle, b: &mut Particle, normal: &Vector3, restitution: f64) -> Option<f64> {
    let (v1n, v2n) = (a.velocity.dot(normal), b.velocity.dot(normal));
    let approach_velocity = v1n - v2n;
    let mut impulse = None;
    if approach_velocity < 0.0 {
        let j = contact_impulse(restitution, a.mass, b.mass, approach_velocity);
        let (v1_new, v2_new) = (v1n + j / a.mass, v2n - j / b.mass);
        a.velocity = a.velocity - normal * v1n + normal * v1_new;
        b.velocity = b.velocity - normal * v2n + normal * v2_new;
        impulse = Some(j);
    }
    impulse
}

/// The line of action where there is none.
///
/// DEVIATES: at coincident centres the slides divide 0 by 0. Here the spheres are taken to
/// have come head-on: the normal is against their relative velocity, or +x if that is zero.
fn coincident_normal(velocity_a: &Vector3, velocity_b: &Vector3) -> Vector3 {
    let relative = velocity_b - velocity_a;
    let speed = length(&relative);
    if speed > 0.0 && speed.is_finite() {
        relative / speed
    } else {
        Vector3::x()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::impulse::observer::Nobody;

    fn particle(position: Vector3, velocity: Vector3) -> Particle {
        Particle {
            position,
            velocity,
            force: Vector3::zeros(),
            mass: 2.0,
            radius: 1.0,
        }
    }

    #[test]
    fn the_normal_points_from_b_to_a() {
        let mut pair = [
            particle(Vector3::new(1.9, 0.0, 0.0), Vector3::new(-1.0, 0.0, 0.0)),
            particle(Vector3::zeros(), Vector3::zeros()),
        ];
        collide::<true, _>(&mut pair, Contact { restitution: 1.0 }, &mut Nobody);
        assert_eq!(pair[0].velocity, Vector3::zeros());
        assert_eq!(pair[1].velocity, Vector3::new(-1.0, 0.0, 0.0));
        assert!(
            pair[0].position.x > 1.9 && pair[1].position.x < 0.0,
            "pushed apart, not together"
        );
    }

    #[test]
    fn coincident_centres_used_to_be_nan_and_now_part() {
        let still = Vector3::zeros();
        let mut pair = [
            particle(still, still),
            particle(still, Vector3::new(0.0, 3.0, 0.0)),
        ];
        collide::<true, _>(&mut pair, Contact { restitution: 0.5 }, &mut Nobody);
        let apart = pair[0].position - pair[1].position;
        assert_eq!(
            apart,
            Vector3::new(0.0, 3.0, 0.0),
            "(1 + e) times the overlap of 2, along y"
        );
        let mut resting = [particle(still, still), particle(still, still)];
        collide::<true, _>(&mut resting, Contact { restitution: 0.5 }, &mut Nobody);
        assert_eq!(
            resting[0].position - resting[1].position,
            Vector3::new(3.0, 0.0, 0.0)
        );
    }
}
