//! Bounces too low to be seen, ended.

use super::super::Particle;
use super::together::{OPERATIONS_AN_ENTRY, account, coupling, square, work};
use super::touch::Touch;
use crate::physics::Meter;
use crate::recording::{Account, Entry};

/// Brings to rest the rates of these touches, all together.
///
/// Equation: `A l = -u`, l of any sign, by conjugate gradients. That is the projection of the
/// velocities on those that neither part nor approach: it takes energy and keeps momentum. A may
/// be singular, where touches depend on each other; the velocities are unique all the same, and
/// no order of touches decides.
/// Source: Hestenes and Stiefel 1952.
pub(super) fn bring_to_rest(
    particles: &mut [Particle],
    touches: &[Touch],
    meter: &mut Meter,
    mut book: impl FnMut(Account, Entry),
) {
    let count = touches.len();
    let squared = (count * count) as u64;
    meter.add(OPERATIONS_AN_ENTRY * squared);
    let inverse = |body: usize| 1.0 / particles[body].mass;
    let matrix = square(touches, |one, other| coupling(one, other, &inverse));
    let product =
        |vector: &[f64]| -> Vec<f64> { matrix.chunks(count).map(|row| dot(row, vector)).collect() };
    let rates: Vec<f64> = touches.iter().map(|touch| touch.rate(particles)).collect();
    let mut residual: Vec<f64> = rates.iter().map(|rate| -rate).collect();
    let mut impulses = vec![0.0; count];
    let mut direction = residual.clone();
    let mut size = dot(&residual, &residual);
    let enough = 1e-30 * size;
    for _ in 0..2 * count {
        meter.add(squared + 10 * count as u64);
        let pushed = product(&direction);
        let curvature = dot(&direction, &pushed);
        if size <= enough || curvature.is_nan() || curvature <= 0.0 || meter.is_spent() {
            break;
        }
        let step = size / curvature;
        add(&mut impulses, step, &direction);
        add(&mut residual, -step, &pushed);
        let smaller = dot(&residual, &residual);
        let turned = smaller / size;
        size = smaller;
        for (own, rest) in direction.iter_mut().zip(&residual) {
            *own = rest + turned * *own;
        }
    }
    for (touch, impulse) in touches.iter().zip(&impulses) {
        for (body, arm) in touch.arms() {
            let change = arm * (impulse / particles[body].mass);
            particles[body].velocity += change;
        }
    }
    for ((touch, impulse), rate) in touches.iter().zip(impulses).zip(rates) {
        book(account(touch.kind), work(touch, impulse, rate, particles));
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(into: &mut [f64], factor: f64, other: &[f64]) {
    for (own, other) in into.iter_mut().zip(other) {
        *own += factor * other;
    }
}

#[cfg(test)]
mod tests {
    use super::super::touch::tests::{Sphere, start};
    use super::*;
    use crate::physics::Vector3;

    /// Three spheres in a ring: three touches.
    fn ring(masses: [f64; 3], speed: f64) -> (Vec<Particle>, Vec<Touch>) {
        let spheres = [
            (masses[0], [0.0; 3], [-speed, 0.0, 0.0]),
            (masses[1], [2.0, 0.0, 0.0], [2.0 * speed, speed, 0.0]),
            (
                masses[2],
                [1.0, 0.0, 3.0_f64.sqrt()],
                [0.0, 0.0, 3.0 * speed],
            ),
        ];
        let (_, particles, touches) = start(&spheres, "[effects.contact]\nrestitution=0.5\n");
        assert_eq!(touches.len(), 3);
        (particles, touches)
    }

    /// All kept closed; the momentum stays, the energy falls.
    #[test]
    fn slow_touches_come_to_rest_together() {
        let (mut all, touches) = ring([1.0, 2.0, 3.0], 1e-7);
        let momentum = |all: &[Particle]| all.iter().map(|p| p.velocity * p.mass).sum::<Vector3>();
        let energy = |all: &[Particle]| {
            all.iter()
                .map(|p| p.mass * p.velocity.norm_squared())
                .sum::<f64>()
        };
        let before = (momentum(&all), energy(&all));
        bring_to_rest(&mut all, &touches, &mut Meter::default(), |_, _| {});
        for touch in &touches {
            assert!(touch.rate(&all).abs() < 1e-21, "{}", touch.rate(&all));
        }
        assert!((momentum(&all) - before.0).norm() < 1e-21);
        assert!(energy(&all) < before.1);
    }

    /// Squares below those of doubles, 1e-160² / 1e9, and inverse masses whose products are
    /// beyond them: velocities stay as they are, and numbers.
    #[test]
    fn numbers_beyond_those_of_doubles_change_no_velocity() {
        for (masses, speed) in [([1e9; 3], 1e-160), ([1e-300; 3], 1e10)] {
            let (mut all, touches) = ring(masses, speed);
            bring_to_rest(&mut all, &touches, &mut Meter::default(), |_, _| {});
            let most = all.iter().map(|p| p.velocity.norm()).sum::<f64>();
            assert!(most <= 7.0 * speed, "{masses:?}: {most}");
        }
    }

    /// A row of twelve with masses of 1, 10 and 100. Without rounding as many rounds as touches
    /// would do; they leave 1e-7 of the rates, and twice as many no more than rounding.
    #[test]
    fn rows_of_unequal_masses_take_more_rounds_than_touches() {
        let sphere = |place: u8| {
            let speed = 1e-7 * (1.7 * f64::from(place)).sin();
            let mass = 10.0_f64.powi(i32::from(place % 3));
            (mass, [2.0 * f64::from(place), 0.0, 0.0], [speed, 0.0, 0.0])
        };
        let row: Vec<Sphere> = (0..12).map(sphere).collect();
        let (_, mut all, touches) = start(&row, "[effects.contact]\nrestitution=0.5\n");
        bring_to_rest(&mut all, &touches, &mut Meter::default(), |_, _| {});
        for touch in &touches {
            // A dozen roundings, enlarged by the ratio of the masses.
            assert!(touch.rate(&all).abs() < 1e-20, "{}", touch.rate(&all));
        }
    }

    /// A row between two walls: one touch more than there are directions, so A is singular. Once
    /// no more than rounding is left, further rounds find curvature in rounding alone and throw
    /// the rates back by many powers of ten, also at equal masses. With masses of 1 to 1e6 the
    /// residual does not get that small in time, and rounds beyond twice the touches do the same.
    #[test]
    fn rows_between_walls_end_before_rounding_is_enlarged() {
        for (count, ratio) in [(5_u8, 1.0), (30, 100.0)] {
            let end = f64::from(count) - 1.0;
            let mass = |place: u8| f64::powi(ratio, i32::from(place % 4));
            let sphere = |place: u8| {
                let (place, mass) = (f64::from(place), mass(place));
                let speed = 1e-7 * (1.7 * place).sin();
                (mass, [2.0 * place - end, 0.0, 0.0], [speed, 0.0, 0.0])
            };
            let row: Vec<Sphere> = (0..count).map(sphere).collect();
            let effects = format!(
                "[effects.contact]\nrestitution=0.5\n[effects.cushions]\nhalf_width={count}.0\n\
                 half_height=2.0\nhalf_length=2.0\nrestitution=0.5\n"
            );
            let (_, mut all, touches) = start(&row, &effects);
            assert_eq!(touches.len(), usize::from(count) + 1);
            bring_to_rest(&mut all, &touches, &mut Meter::default(), |_, _| {});
            // A rounding of rates below 2e-7 for each sphere, enlarged by the ratio of the masses.
            let left = f64::EPSILON * 2e-7 * f64::from(count) * mass(3);
            for touch in &touches {
                assert!(touch.rate(&all).abs() < left, "{}", touch.rate(&all));
            }
        }
    }
}
