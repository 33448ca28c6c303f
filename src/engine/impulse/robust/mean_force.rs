//! Forces between bodies that keep the energy whatever the step.

use super::super::Particle;
use super::super::phases::Phases;
use crate::physics::Vector3;

/// Sets on `particles`, which are at the end of a step from `start`, the forces of which each,
/// constant over the step, does exactly the work that its potential energy loses.
///
/// Equation: with q the separation, `F = -(V1 - V0)/(|q1|² - |q0|²) (q0 + q1)`, since then
/// `F . (q1 - q0) = -(V1 - V0)`; written so that nothing cancels. It is even in the exchange of
/// both ends, so of order 2, and along the mean separation, so that angular momentum stays too.
/// Source: `LaBudde` and Greenspan 1976, "Energy and momentum conserving methods of arbitrary
/// order"; Gonzalez 1996, "Time integration and discrete Hamiltonian systems".
pub(super) fn set(
    phases: &Phases,
    start: &[Particle],
    particles: &mut [Particle],
    pushes: &[Vector3],
) {
    for (particle, push) in particles.iter_mut().zip(pushes) {
        particle.force = *push;
    }
    if let Some(acceleration) = &phases.gravity {
        for particle in particles.iter_mut() {
            particle.force += acceleration * particle.mass;
        }
    }
    if let Some(effect) = phases.attraction {
        let softening = effect.softening * effect.softening;
        for a in 0..start.len() {
            for b in a + 1..start.len() {
                let (before, after) = separations(start, particles, [a, b]);
                let reach = [before, after].map(|q| (q.norm_squared() + softening).sqrt());
                let size = reach[0] * reach[1] * (reach[0] + reach[1]);
                if size > 0.0 {
                    let masses = start[a].mass * start[b].mass;
                    let pull = (before + after) * (effect.constant * masses / size);
                    exchange(particles, [a, b], &pull);
                }
            }
        }
    }
    for spring in &phases.springs {
        let (before, after) = separations(start, particles, spring.ends);
        let lengths = before.norm() + after.norm();
        if lengths > 0.0 {
            let stretch = 0.5 * lengths - spring.rest_length;
            let pull = (before + after) * (spring.stiffness * stretch / lengths);
            exchange(particles, spring.ends, &pull);
        }
    }
}

/// From a to b, at both ends of the step.
fn separations(start: &[Particle], end: &[Particle], [a, b]: [usize; 2]) -> (Vector3, Vector3) {
    let between = |particles: &[Particle]| particles[b].position - particles[a].position;
    (between(start), between(end))
}

fn exchange(particles: &mut [Particle], [a, b]: [usize; 2], pull: &Vector3) {
    particles[a].force += pull;
    particles[b].force -= pull;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::spec::DragRule;
    use crate::physics::{attraction_energy, spring_energy};

    /// Any two places: the work is the loss of potential energy, to rounding.
    #[test]
    fn the_work_is_the_loss_of_potential_energy() {
        let text = "name='x'\nduration=1\nsample_every=1\n\
            [[bodies]]\nname='a'\nmass=2\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
            [[bodies]]\nname='b'\nmass=3\nradius=1\nposition=[4,1,0]\nvelocity=[0,0,0]\n\
            [effects.attraction]\nconstant=5.5\nsoftening=0.3\n\
            [[effects.springs]]\nbetween=['a','b']\nstiffness=7\nrest_length=1\ndamping=0\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let phases = Phases::of(&scene, DragRule::Exponential);
        let start = super::super::super::particles(&scene);
        let mut end = start.clone();
        end[0].position += Vector3::new(0.7, -0.2, 1.0);
        end[1].position += Vector3::new(-2.0, 0.5, 0.1);
        set(&phases, &start, &mut end, &[Vector3::zeros(); 2]);
        let energy = |at: &[Particle]| {
            let ends = [&at[0].position, &at[1].position];
            let distance = (ends[1] - ends[0]).norm();
            attraction_energy(5.5, 0.3, [2.0, 3.0], distance) + spring_energy(7.0, 1.0, ends)
        };
        let work: f64 = (0..2)
            .map(|body| {
                end[body]
                    .force
                    .dot(&(end[body].position - start[body].position))
            })
            .sum();
        let lost = energy(&start) - energy(&end);
        assert!(
            (work - lost).abs() < 1e-13 * energy(&start).abs(),
            "{work} {lost}"
        );
        assert!((end[0].force + end[1].force).norm() < 1e-14);
    }
}
