//! Spheres that overlap, moved apart.

use super::super::Particle;
use super::super::contacts::line_of_action;
use super::super::phases::Phases;
use crate::physics::{Meter, Vector3};
use crate::scene::overlap::{Overlap, overlaps};

/// Rounds of pushing, after which what still overlaps is left so: a box too small for its balls …
const ROUNDS_MAX: usize = 500;
/// … and so many more for each ball.
const ROUNDS_A_BALL: usize = 5;
/// Spheres are moved apart by this share of their reach more than they must, so that the rounds
/// end.
const MORE: f64 = 1e-7;
/// Over-relaxation of the mean push of each body.
const RELAXATION: f64 = 1.5;
/// Share of the last move that is made again: a heap grows outwards in as many rounds as it has
/// layers, not in their square.
const MOMENTUM: f64 = 0.9;

/// Operations of a round for a body, …
const OPERATIONS_A_BODY: u64 = 60;
/// … for a pair that a sweep looks at, of so many a body, …
const OPERATIONS_A_PAIR: u64 = 2;
const SWEPT: u64 = 30;
/// … and for an overlap.
const OPERATIONS_AN_OVERLAP: u64 = 60;

/// Moves overlapping spheres apart and back into the box, velocities untouched; whether nothing
/// overlaps any more.
///
/// In rounds: every overlap asks its two spheres to part, in the inverse ratio of the masses and
/// by a share that both can follow, so that the centre of mass stays; all move at once, so that
/// no order of bodies decides. Moves go on with momentum, also where overlaps grow for a while: a
/// light ball between heavy ones that is stopped whenever it swings back takes far more rounds.
/// Source: the projection of position-based dynamics, Jacobi form: Macklin et al. 2014, "Unified
/// particle physics for real-time applications", section 4; momentum: Polyak 1964, "Some methods
/// of speeding up the convergence of iteration methods".
pub(super) fn separate(phases: &Phases, particles: &mut [Particle], meter: &mut Meter) -> bool {
    let mut moves = vec![Vector3::zeros(); particles.len()];
    for _ in 0..ROUNDS_MAX + ROUNDS_A_BALL * particles.len() {
        let found = overlapping(phases, particles);
        let bodies = particles.len() as u64;
        // A sweep looks at no more than all pairs.
        let looks = OPERATIONS_A_PAIR * bodies * bodies.min(SWEPT) + OPERATIONS_A_BODY * bodies;
        meter.add(looks + OPERATIONS_AN_OVERLAP * found.len() as u64);
        if meter.is_spent() {
            return false;
        }
        for own in &mut moves {
            *own *= MOMENTUM;
        }
        part(particles, &found, &mut moves);
        if !found.is_empty() {
            for (particle, own) in particles.iter_mut().zip(&moves) {
                particle.position += own;
            }
        }
        if into_box(phases, particles) && found.is_empty() {
            return true;
        }
    }
    false
}

fn overlapping(phases: &Phases, particles: &[Particle]) -> Vec<Overlap> {
    if phases.contact.is_none() {
        return Vec::new();
    }
    let spheres: Vec<_> = particles.iter().map(|p| (p.position, p.radius)).collect();
    overlaps(&spheres)
}

/// Adds what the overlaps ask for to the moves.
fn part(particles: &[Particle], overlaps: &[Overlap], moves: &mut [Vector3]) {
    let mut counts = vec![0_u32; particles.len()];
    for overlap in overlaps {
        counts[overlap.a] += 1;
        counts[overlap.b] += 1;
    }
    for overlap in overlaps {
        let (a, b) = (&particles[overlap.a], &particles[overlap.b]);
        let apart = a.position - b.position;
        let distance = apart.norm();
        let mut normal = line_of_action(&apart, distance, &a.velocity, &b.velocity);
        if distance == 0.0 {
            normal = fanned_out(normal, overlap.a, overlap.b);
        }
        let most = counts[overlap.a].max(counts[overlap.b]);
        let relaxed = (RELAXATION / f64::from(most)).min(1.0);
        let push = (overlap.depth + MORE * (a.radius + b.radius)) * relaxed;
        let share = b.mass / (a.mass + b.mass);
        moves[overlap.a] += normal * (push * share);
        moves[overlap.b] -= normal * (push * (1.0 - share));
    }
}

/// A direction for two of several coincident spheres, so that a heap of them does not stay on one
/// line: turned about y by the golden angle for each body.
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
        for (axis, half) in half.iter().enumerate() {
            let room = half - particle.radius;
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

#[cfg(test)]
mod tests {
    use super::super::touch::tests::{Sphere, start};
    use super::*;

    /// Spheres of radius 1 after they were moved apart; whether nothing overlaps any more.
    fn separated(spheres: &[Sphere], half: Option<[f64; 3]>) -> (Vec<Particle>, bool) {
        let walls = half.map_or_else(String::new, |[x, y, z]| {
            format!(
                "[effects.cushions]\nhalf_width={x:?}\nhalf_height={y:?}\nhalf_length={z:?}\n\
                 restitution=1\n"
            )
        });
        let effects = format!("[effects.contact]\nrestitution=1\n{walls}");
        let (phases, mut particles, _) = start(spheres, &effects);
        let apart = separate(&phases, &mut particles, &mut Meter::default());
        (particles, apart)
    }

    fn at(position: [f64; 3]) -> Sphere {
        (1.0, position, [0.0; 3])
    }

    /// So many in a row along x about the middle, each half in the next.
    fn row(count: u8) -> Vec<Sphere> {
        let place = |n: u8| f64::from(n) - 0.5 * f64::from(count);
        (0..count).map(|n| at([place(n), 0.0, 0.0])).collect()
    }

    /// Two part by their depth and a hair, which keeps them from touching; the centre of mass
    /// stays.
    #[test]
    fn a_pair_parts_in_the_inverse_ratio_of_the_masses() {
        let pair = [at([0.0; 3]), (3.0, [1.0, 0.0, 0.0], [0.0; 3])];
        let (particles, apart) = separated(&pair, None);
        assert!(apart);
        let [one, other] = [0, 1].map(|body| particles[body].position.x);
        let push = 1.0 + 2.0 * MORE;
        // Roundings of places near 1.
        assert!((one + 0.75 * push).abs() < 1e-15, "{one}");
        assert!((other - (1.0 + 0.25 * push)).abs() < 1e-15, "{other}");
    }

    /// Two hundred centres in one place leave it in all directions. On one line they would be
    /// left.
    #[test]
    fn a_heap_of_coincident_centres_comes_apart() {
        assert!(separated(&vec![at([0.0; 3]); 200], None).1);
    }

    /// Pushes are shared among the overlaps of a body: 125 balls in a box that is a tenth wider
    /// than they need would else be thrown about for good.
    #[test]
    fn a_crowd_in_a_box_with_some_room_comes_apart() {
        let place = |n: u8| [n % 5, n / 5 % 5, n / 25].map(|n| f64::from(n) - 2.0);
        let crowd: Vec<Sphere> = (0..125).map(|n| at(place(n))).collect();
        assert!(separated(&crowd, Some([5.5; 3])).1);
    }

    /// Forty in a row must spread over twice its length, which takes momentum; ten between walls
    /// with a hundredth of room need some hundred rounds.
    #[test]
    fn rows_are_pulled_apart_as_long_as_there_is_room() {
        assert!(separated(&row(40), None).1);
        assert!(separated(&row(10), Some([10.1, 1.0, 1.0])).1);
        assert!(!separated(&row(10), Some([9.9, 1.0, 1.0])).1);
    }

    /// A light ball between heavy ones swings; were the momentum of its swing taken from it, the
    /// rounds that there are would not do.
    #[test]
    fn rows_of_unequal_masses_are_pulled_apart() {
        let mut uneven = row(11);
        for (place, sphere) in (0_i32..).zip(&mut uneven) {
            sphere.0 = 100.0_f64.powi(place % 3);
        }
        assert!(separated(&uneven, None).1);
    }

    /// Directions of coincident centres: of length 1, turned about y by the golden angle a body,
    /// and risen by less than half.
    #[test]
    fn coincident_centres_are_fanned_out_about_y() {
        let normal = Vector3::new(0.6, 0.0, 0.8);
        assert_eq!(fanned_out(normal, 0, 1), normal);
        // Angles up to 30, each rounded by half an ulp of 2^-48.
        for (a, b) in [(0, 2), (1, 2), (3, 8)] {
            let fanned = fanned_out(normal, a, b);
            assert!((fanned.norm() - 1.0).abs() < 1e-15);
            let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
            let angle = 0.8_f64.atan2(0.6) + golden * f64::from(u8::try_from(a + b).unwrap());
            let flat = fanned.x.hypot(fanned.z);
            assert!((fanned.x / flat - angle.cos()).abs() < 1e-14, "{a} {b}");
            assert!((fanned.z / flat - angle.sin()).abs() < 1e-14, "{a} {b}");
            let share = 0.5 * (5.0_f64.sqrt() - 1.0);
            let rise = (share * f64::from(u8::try_from(b - a).unwrap())).fract() - 0.5;
            assert!((fanned.y / flat - rise).abs() < 1e-14, "{a} {b}");
        }
    }
}
