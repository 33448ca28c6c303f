//! The classical Runge-Kutta method, for forces of any kind.

use super::Particle;
use super::motion::Motion;
use super::phases::Phases;
use crate::physics::Vector3;

/// Runge-Kutta of order 4 in places and velocities together, drag and dampers included.
///
/// Source: Kutta 1901; Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I",
/// table 1.2.
#[derive(Debug, Clone, Default)]
pub struct RungeKutta {
    start: Vec<[Vector3; 2]>,
    sum: Vec<[Vector3; 2]>,
}

/// Share of the step at which a stage looks, and its weight in sixths.
const STAGES: [(f64, f64); 4] = [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)];

impl Motion for RungeKutta {
    fn advance(&mut self, phases: &Phases, particles: &mut [Particle], dt: f64) -> u64 {
        let state = |particle: &Particle| [particle.position, particle.velocity];
        self.start.clear();
        self.start.extend(particles.iter().map(state));
        self.sum.clear();
        self.sum.resize(particles.len(), [Vector3::zeros(); 2]);
        for (next, weight) in STAGES {
            phases.sum_forces(particles);
            let places = self.start.iter().zip(&mut self.sum);
            for (particle, (start, sum)) in particles.iter_mut().zip(places) {
                let slope = [particle.velocity, particle.force / particle.mass];
                for (sum, slope) in sum.iter_mut().zip(&slope) {
                    *sum += slope * weight;
                }
                particle.position = start[0] + slope[0] * (next * dt);
                particle.velocity = start[1] + slope[1] * (next * dt);
            }
        }
        let places = self.start.iter().zip(&self.sum);
        for (particle, (start, sum)) in particles.iter_mut().zip(places) {
            particle.position = start[0] + sum[0] * (dt / 6.0);
            particle.velocity = start[1] + sum[1] * (dt / 6.0);
        }
        4
    }
}
