//! Steps by their own error: an embedded pair of Runge-Kutta methods.

use super::Particle;
use super::motion::Motion;
use super::phases::Phases;
use crate::physics::Vector3;

/// The pair of Dormand and Prince, orders 5 and 4, in places and velocities together.
///
/// The step asked for is the longest; shorter ones are taken so that the difference of the two
/// orders stays below `(dt/duration)^5` of the scene's size, but for its rounding. So the error falls with the fifth
/// power of the step asked for, wherever the short steps fall.
/// Source: Dormand and Prince 1980; Hairer, Nørsett, Wanner, "Solving Ordinary Differential
/// Equations I", table 5.2 and section II.4 for the choice of steps.
#[derive(Debug, Clone, Default)]
pub struct DormandPrince {
    size: f64,
    duration: f64,
    longest: f64,
    next: f64,
    rejected: bool,
    start: Vec<[Vector3; 2]>,
    slopes: Vec<[[Vector3; 2]; STAGES]>,
}

const STAGES: usize = 7;

/// Weights of the earlier slopes in each stage; the last row is the step of order 5.
const ROWS: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
        0.0,
        0.0,
    ],
    [
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
        0.0,
    ],
    [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];

/// What the two orders differ by.
const DIFFERENCE: [f64; STAGES] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Steps shorter than this share of the longest are taken whatever their error, so that the work
/// stays bounded.
const SHORTEST: f64 = 1e-3;

impl Motion for DormandPrince {
    fn prepare(&mut self, size: f64, duration: f64, longest: f64) {
        (self.size, self.duration) = (size, duration);
        (self.longest, self.next) = (longest, longest);
    }

    fn length(&self, left: f64) -> f64 {
        self.next.min(left)
    }

    fn is_rejected(&self) -> bool {
        self.rejected
    }

    fn advance(&mut self, phases: &Phases, particles: &mut [Particle], dt: f64) -> u64 {
        let state = |particle: &Particle| [particle.position, particle.velocity];
        self.start.clear();
        self.start.extend(particles.iter().map(state));
        self.slopes.clear();
        self.slopes
            .resize(particles.len(), [[Vector3::zeros(); 2]; STAGES]);
        for stage in 0..STAGES {
            phases.sum_forces(particles);
            let places = self.start.iter().zip(&mut self.slopes);
            for (particle, (start, slopes)) in particles.iter_mut().zip(places) {
                slopes[stage] = [particle.velocity, particle.force / particle.mass];
                if let Some(row) = ROWS.get(stage) {
                    let moved = combined(&slopes[..=stage], row);
                    particle.position = start[0] + moved[0] * dt;
                    particle.velocity = start[1] + moved[1] * dt;
                }
            }
        }
        self.choose(dt);
        STAGES as u64
    }
}

impl DormandPrince {
    /// Judges the step just taken and chooses the next.
    fn choose(&mut self, dt: f64) {
        let error = self.slopes.iter().fold(0.0_f64, |most, slopes| {
            let [position, velocity] = combined(slopes, &DIFFERENCE);
            most.max((position * dt).norm())
                .max((velocity * (dt * dt)).norm())
        });
        // Below rounding no step is short enough: it would take a thousand for one.
        let asked = (self.longest / self.duration).powi(5);
        let tolerance = asked.max(f64::EPSILON) * self.size;
        let share = (error / tolerance).powf(-0.2);
        let is_short = dt <= SHORTEST * self.longest;
        self.rejected = error.is_finite() && error > tolerance && !is_short;
        let factor = if share.is_finite() {
            (0.9 * share).clamp(0.2, 5.0)
        } else {
            5.0
        };
        self.next = (dt * factor).clamp(SHORTEST * self.longest, self.longest);
    }
}

fn combined(slopes: &[[Vector3; 2]], weights: &[f64]) -> [Vector3; 2] {
    let mut sum = [Vector3::zeros(); 2];
    for (slope, weight) in slopes.iter().zip(weights) {
        sum[0] += slope[0] * *weight;
        sum[1] += slope[1] * *weight;
    }
    sum
}
