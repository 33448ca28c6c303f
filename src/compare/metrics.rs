//! Conserved quantities of a recording, sample by sample.

use serde::Serialize;

use super::Sizes;
use crate::physics::{
    BodyState, SpringDamper, Vector3, angular_momentum, attraction_energy, centre_of_mass,
    gravity_energy, kinetic_energy, momentum,
};
use crate::recording::Recording;
use crate::scene::Scene;
use crate::scene::overlap::for_each_overlap;

/// What is conserved, or not, at one sample. Units: those of the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metrics {
    /// Time, s.
    pub time: f64,
    /// Sum of m v²/2.
    pub kinetic_energy: f64,
    /// Potential energy of the attraction.
    pub attraction_energy: f64,
    /// Potential energy of the springs.
    pub spring_energy: f64,
    /// Potential energy in uniform gravity, zero at the origin.
    pub gravity_energy: f64,
    /// Sum of m v.
    pub momentum: Vector3,
    /// About the origin.
    pub angular_momentum: Vector3,
    /// Centre of mass.
    pub centre_of_mass: Vector3,
    /// Sum of m |v|: the scale of the momentum.
    pub momentum_scale: f64,
    /// Angular momentum about the centre of mass.
    pub spin: Vector3,
    /// Sum of m |x - c| |v - w|, c and w being place and velocity of the centre of mass: the scale
    /// of the angular momentum.
    pub spin_scale: f64,
    /// Deepest overlap of two spheres that collide, or of a sphere and a wall; 0 without.
    pub max_penetration: f64,
}

impl Metrics {
    /// Attraction, springs and gravity together.
    #[must_use]
    pub fn potential_energy(&self) -> f64 {
        self.attraction_energy + self.spring_energy + self.gravity_energy
    }

    /// Kinetic and potential energy together.
    #[must_use]
    pub fn total_energy(&self) -> f64 {
        self.kinetic_energy + self.potential_energy()
    }

    /// The size of the terms whose sum is the total energy: what its rounding is a share of. It
    /// depends on the origin where gravity acts, so it is no yardstick for physics; see
    /// [`Sizes::energy`].
    #[must_use]
    pub fn energy_scale(&self) -> f64 {
        self.start_energy() + self.gravity_energy.abs()
    }

    /// The energy that a scene starts with as far as it depends on no choice of a zero: kinetic
    /// energy, |energy of attraction| (zero at infinity) and energy of springs (zero when relaxed).
    #[must_use]
    pub fn start_energy(&self) -> f64 {
        self.kinetic_energy + self.attraction_energy.abs() + self.spring_energy.abs()
    }
}

/// The metrics of every sample of a recording.
#[must_use]
pub fn metrics(scene: &Scene, recording: &Recording) -> Vec<Metrics> {
    let masses: Vec<f64> = scene.bodies.iter().map(|body| body.mass).collect();
    let springs = SpringDamper::all(scene);
    let of_sample = |(sample, states): (usize, &[BodyState])| {
        let around = about_centre(&masses, states);
        Metrics {
            time: scene.sample_time(sample),
            kinetic_energy: masses
                .iter()
                .zip(states)
                .map(|(m, s)| kinetic_energy(*m, &s.velocity))
                .sum(),
            attraction_energy: total_attraction(scene, &masses, states),
            spring_energy: springs
                .iter()
                .map(|spring| spring.energy(spring.ends.map(|end| &states[end].position)))
                .fold(0.0, |sum, energy| sum + energy),
            gravity_energy: total_gravity(scene, &masses, states),
            momentum: momentum(&masses, states),
            angular_momentum: angular_momentum(&masses, states),
            centre_of_mass: centre_of_mass(&masses, states),
            momentum_scale: masses
                .iter()
                .zip(states)
                .map(|(m, s)| m * s.velocity.norm())
                .sum(),
            max_penetration: max_penetration(scene, states),
            spin: angular_momentum(&masses, &around),
            spin_scale: masses
                .iter()
                .zip(&around)
                .map(|(m, s)| m * s.position.norm() * s.velocity.norm())
                .sum(),
        }
    };
    recording.samples().enumerate().map(of_sample).collect()
}

/// The states relative to place and velocity of the centre of mass.
fn about_centre(masses: &[f64], states: &[BodyState]) -> Vec<BodyState> {
    let mass: f64 = masses.iter().sum();
    let velocity = momentum(masses, states) / mass;
    let centre = centre_of_mass(masses, states);
    let relative = |state: &BodyState| BodyState {
        position: state.position - centre,
        velocity: state.velocity - velocity,
    };
    states.iter().map(relative).collect()
}

fn total_attraction(scene: &Scene, masses: &[f64], states: &[BodyState]) -> f64 {
    let Some(effect) = scene.effects.attraction else {
        return 0.0;
    };
    let pair = |a: usize, b: usize| {
        let distance = (states[a].position - states[b].position).norm();
        attraction_energy(
            effect.constant,
            effect.softening,
            [masses[a], masses[b]],
            distance,
        )
    };
    (0..states.len())
        .map(|a| (a + 1..states.len()).map(|b| pair(a, b)).sum::<f64>())
        .sum()
}

fn total_gravity(scene: &Scene, masses: &[f64], states: &[BodyState]) -> f64 {
    let Some(gravity) = scene.effects.gravity else {
        return 0.0;
    };
    let acceleration = gravity.acceleration.into();
    masses
        .iter()
        .zip(states)
        .map(|(m, s)| gravity_energy(*m, &acceleration, &s.position))
        .sum()
}

fn max_penetration(scene: &Scene, states: &[BodyState]) -> f64 {
    let mut deepest: f64 = 0.0;
    if scene.effects.contact.is_some() {
        let spheres: Vec<_> = states
            .iter()
            .zip(&scene.bodies)
            .map(|(s, body)| (s.position, body.radius))
            .collect();
        for_each_overlap(&spheres, |overlap| deepest = deepest.max(overlap.depth));
    }
    if let Some(cushions) = scene.effects.cushions {
        let half = cushions.half_extents();
        for (state, body) in states.iter().zip(&scene.bodies) {
            for (coordinate, half) in state.position.iter().zip(half) {
                deepest = deepest.max(coordinate.abs() + body.radius - half);
            }
        }
    }
    deepest
}

/// How far energy and momentum go from where they started.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Drift {
    /// Largest |E(t) - E(0)|, as a share of the scale.
    pub energy_drift_max: f64,
    /// E(end) - E(0) as a share of the scale, with its sign.
    pub energy_change: f64,
    /// Largest |p(t) - p(0)|, as a share of the scale.
    pub momentum_drift_max: f64,
    /// Largest change of the angular momentum about the centre of mass, as a share of the scale.
    pub angular_momentum_drift_max: f64,
    /// Largest penetration over all samples, scene length unit.
    pub max_penetration: f64,
}

impl Drift {
    /// The drift over a recording's metrics; at least one sample.
    #[must_use]
    pub fn of(metrics: &[Metrics], scale: &Sizes) -> Self {
        let start = &metrics[0];
        let largest =
            |value: &dyn Fn(&Metrics) -> f64| metrics.iter().map(value).fold(0.0, f64::max);
        let energy = |at: &Metrics| at.total_energy() - start.total_energy();
        let momentum = |at: &Metrics| (at.momentum - start.momentum).norm();
        let spin = |at: &Metrics| (at.spin - start.spin).norm();
        let last = metrics.last().unwrap_or(start);
        Self {
            energy_drift_max: Sizes::share(largest(&|at| energy(at).abs()), scale.energy),
            energy_change: Sizes::share(energy(last), scale.energy),
            momentum_drift_max: Sizes::share(largest(&momentum), scale.momentum),
            angular_momentum_drift_max: Sizes::share(largest(&spin), scale.angular_momentum),
            max_penetration: largest(&|at| at.max_penetration),
        }
    }
}
