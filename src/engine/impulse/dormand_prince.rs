//! Steps by their own error: an embedded pair of Runge-Kutta methods.

use super::Particle;
use super::motion::Motion;
use super::phases::Phases;
use crate::physics::Vector3;

/// The pair of Dormand and Prince, orders 5 and 4, in places and velocities together.
///
/// The step asked for is the longest; shorter ones are taken so that the difference of the two
/// orders stays below `(dt/duration)^5` of the scene's size, but for its rounding. So the error
/// falls with the fifth power of the step asked for, wherever the short steps fall.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Conditions of order: the weights of a stage add up to its instant c, the step integrates
    /// powers of the time up to the fourth exactly, and the two orders differ by none of them up
    /// to the third. Source: Hairer, Nørsett, Wanner, section II.1.
    #[test]
    fn the_tableau_has_the_order_that_it_says() {
        let instants = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
        for (row, instant) in ROWS.iter().zip(&instants[1..]) {
            let sum: f64 = row.iter().sum();
            // A dozen terms of up to 12.
            assert!((sum - instant).abs() < 1e-14, "{sum} for {instant}");
        }
        let moment = |weights: &[f64], power: i32| -> f64 {
            let terms = weights.iter().zip(&instants);
            terms.map(|(weight, c)| weight * c.powi(power)).sum()
        };
        // Terms below 1 and, of the difference, below 1/16: some roundings of each.
        for power in 0..5 {
            let exact = 1.0 / f64::from(power + 1);
            assert!((moment(&ROWS[5], power) - exact).abs() < 1e-15, "{power}");
        }
        for power in 0..4 {
            assert!(moment(&DIFFERENCE, power).abs() < 1e-16, "{power}");
        }
        assert!(moment(&DIFFERENCE, 4).abs() > 1e-4);
    }

    /// A step of this length whose two orders differ by so much in place, and in velocity times
    /// the step.
    fn after(dt: f64, [place, velocity]: [f64; 2], duration: f64) -> DormandPrince {
        let mut method = DormandPrince::default();
        method.prepare(2.0, duration, 1.0);
        let mut slopes = [[Vector3::zeros(); 2]; STAGES];
        slopes[6] = [place / dt, velocity / (dt * dt)].map(|slope| Vector3::y() * (-40.0 * slope));
        method.slopes = vec![slopes];
        method.choose(dt);
        method
    }

    /// Errors of 1/32, 1 and 32 of what is allowed ask for steps of 2, 1 and 1/2, and a tenth less.
    #[test]
    fn the_next_step_follows_the_fifth_root_of_the_error() {
        let allowed = 2.0 * 0.1_f64.powi(5);
        for (times, rejected, factor) in [(1.0 / 32.0, false, 1.8), (32.0, true, 0.45)] {
            let error = times * allowed;
            for errors in [[error, 0.0], [0.0, error], [error, 0.5 * error]] {
                let method = after(0.25, errors, 10.0);
                assert_eq!(method.is_rejected(), rejected, "{errors:?}");
                let next = method.length(1.0);
                assert!((next / (0.25 * factor) - 1.0).abs() < 1e-12, "{next}");
                assert_eq!(method.length(0.01), 0.01);
            }
        }
        // Just above and just below what is allowed.
        assert!(after(0.25, [1.001 * allowed, 0.0], 10.0).is_rejected());
        assert!(!after(0.25, [0.999 * allowed, 0.0], 10.0).is_rejected());
    }

    /// Steps grow and shrink by a factor of five at most, between the longest and a thousandth of
    /// it, which is taken whatever its error.
    #[test]
    fn steps_stay_within_their_bounds() {
        for (dt, error, rejected, next) in [
            (0.1, 1e-30, false, 0.5),
            (0.1, 0.0, false, 0.5),
            (0.5, 1e-30, false, 1.0),
            (0.1, 1e30, true, 0.02),
            (0.002, 1e30, true, 0.001),
            (0.001, 1e30, false, 0.001),
            // Its square is beyond doubles: no shorter step is known to help.
            (0.1, 1e200, false, 0.02),
        ] {
            let method = after(dt, [error, 0.0], 10.0);
            assert_eq!(method.is_rejected(), rejected, "{dt} {error}");
            assert!((method.length(1.0) - next).abs() < 1e-15, "{dt} {error}");
        }
    }

    /// Where the step asked for is so short that rounding is more than it allows, rounding is
    /// allowed.
    #[test]
    fn no_step_is_asked_to_be_better_than_rounding() {
        let allowed = 2.0 * f64::EPSILON;
        assert!(!after(0.25, [0.9 * allowed, 0.0], 1e5).is_rejected());
        assert!(after(0.25, [1.1 * allowed, 0.0], 1e5).is_rejected());
    }
}
