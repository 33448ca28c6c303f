//! Spheres that overlap, moved apart.

use super::super::Particle;
use super::super::contacts::line_of_action;
use super::super::phases::Phases;
use crate::physics::Vector3;
use crate::scene::overlap::for_each_overlap;

/// Rounds of pushing, after which what still overlaps is left so: a box too small for its balls.
const ROUNDS_MAX: u32 = 5000;
/// Spheres are moved apart by this share of their reach more than they must, so that the rounds
/// end.
const MORE: f64 = 1e-7;
/// Over-relaxation of the mean push of each body.
const RELAXATION: f64 = 1.5;

/// Moves overlapping spheres apart and back into the box, velocities untouched; whether nothing
/// overlaps any more.
///
/// In rounds: every overlap asks its two spheres for half of it each, in the inverse ratio of the
/// masses so that the centre of mass stays; every sphere follows the mean of what it is asked for,
/// all at once, so that no order of bodies decides.
/// Source: the projection of position-based dynamics, Jacobi form: Macklin et al. 2014, "Unified
/// particle physics for real-time applications", section 4.
pub(super) fn separate(phases: &Phases, particles: &mut [Particle]) -> bool {
    let mut asked: Vec<(Vector3, f64)> = Vec::new();
    for _ in 0..ROUNDS_MAX {
        asked.clear();
        asked.resize(particles.len(), (Vector3::zeros(), 0.0));
        ask_pairs(phases, particles, &mut asked);
        let apart = asked.iter().all(|(_, count)| *count == 0.0);
        for (particle, (push, count)) in particles.iter_mut().zip(&asked) {
            if *count > 0.0 {
                particle.position += push * (RELAXATION / count).min(1.0);
            }
        }
        if into_box(phases, particles) && apart {
            return true;
        }
    }
    false
}

fn ask_pairs(phases: &Phases, particles: &[Particle], asked: &mut [(Vector3, f64)]) {
    if phases.contact.is_none() {
        return;
    }
    let spheres: Vec<_> = particles.iter().map(|p| (p.position, p.radius)).collect();
    for_each_overlap(&spheres, |overlap| {
        let (a, b) = (&particles[overlap.a], &particles[overlap.b]);
        let apart = a.position - b.position;
        let distance = apart.norm();
        let mut normal = line_of_action(&apart, distance, &a.velocity, &b.velocity);
        if distance == 0.0 {
            normal = fanned_out(normal, overlap.a, overlap.b);
        }
        let push = overlap.depth + MORE * (a.radius + b.radius);
        let share = b.mass / (a.mass + b.mass);
        asked[overlap.a].0 += normal * (push * share);
        asked[overlap.b].0 -= normal * (push * (1.0 - share));
        asked[overlap.a].1 += 1.0;
        asked[overlap.b].1 += 1.0;
    });
}

/// A direction for two of several coincident spheres, so that a heap of them does not stay on one
/// line: turned about z by the golden angle for each body.
fn fanned_out(normal: Vector3, a: usize, b: usize) -> Vector3 {
    if b == a + 1 && a == 0 {
        return normal;
    }
    #[allow(clippy::cast_precision_loss, reason = "a body's number")]
    let turn = 2.399_963_229_728_653 * (a + b) as f64;
    let (sin, cos) = turn.sin_cos();
    #[allow(clippy::cast_precision_loss, reason = "a body's number")]
    let rise = ((b - a) as f64 * 0.618_033_988_749_895).fract() - 0.5;
    let turned = Vector3::new(
        normal.x * cos - normal.z * sin,
        normal.y + rise,
        normal.x * sin + normal.z * cos,
    );
    let length = turned.norm();
    if length > 0.0 {
        turned / length
    } else {
        normal
    }
}

/// Moves spheres out of the walls; whether none was in one.
fn into_box(phases: &Phases, particles: &mut [Particle]) -> bool {
    let Some(cushions) = &phases.cushions else {
        return true;
    };
    let mut inside = true;
    let half = cushions.half_extents();
    for particle in particles {
        for axis in 0..3 {
            let room = half[axis] - particle.radius;
            let coordinate = particle.position[axis];
            if coordinate.abs() > room {
                // A sphere wider than the box stays in its middle.
                particle.position[axis] = coordinate.signum() * room.max(0.0);
                inside &= room < 0.0;
            }
        }
    }
    inside
}
