//! Motion under drag and dampers, exactly, while all other forces are constant.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::super::Particle;
use super::super::path::{Path, Way};
use crate::physics::{SpringDamper, Vector3};
use crate::scene::Scene;

/// Below this, the series is more accurate than the closed form.
const SERIES_BELOW: f64 = 0.1;

/// `exp(-z)`, `(1 - exp(-z))/z` and `(z - 1 + exp(-z))/z²`: what becomes of a velocity, how far
/// it carries, and how far a constant acceleration does; for z >= 0.
pub(super) fn decay(z: f64) -> [f64; 3] {
    if z == 0.0 {
        return [1.0, 1.0, 0.5];
    }
    if z < SERIES_BELOW {
        // Terms (-z)^n/(n+1)! and (-z)^n/(n+2)!; the twelfth is below 1e-19.
        let (mut term, mut first, mut second) = (1.0, 0.0, 0.0);
        for n in 1..12 {
            let n = f64::from(n);
            first += term / n;
            second += term / (n * (n + 1.0));
            term *= -z / n;
        }
        return [(-z).exp(), first, second];
    }
    let first = -(-z).exp_m1() / z;
    [(-z).exp(), first, (1.0 - first) / z]
}

/// What a step of one length makes of velocities and accelerations.
///
/// Equation: `v1 = E v0 + P a`, `x1 = x0 + P v0 + Q a` with `E = exp(-D h)`, `P` and `Q` its first
/// and second integral over the step, D the rates of dissipation and `a = F/m` constant.
#[derive(Debug, Clone)]
pub(super) struct Flow {
    /// c = k/m of drag. Shape: `[body]`.
    rates: Vec<f64>,
    clusters: Vec<Cluster>,
    /// Which bodies are in a cluster. Shape: `[body]`.
    is_clustered: Vec<bool>,
    length: f64,
    /// E, P, Q of bodies on their own. Shape: `[body]`.
    factors: Vec<[f64; 3]>,
}

/// Bodies whose dampers tie them together.
///
/// D = M⁻¹ (L + k), L the dampers' Laplacian; `M^(1/2) D M^(-1/2)` is symmetric.
#[derive(Debug, Clone)]
struct Cluster {
    bodies: Vec<usize>,
    masses: DVector<f64>,
    /// Whether nothing outside takes momentum: no drag.
    is_free: bool,
    eigen: SymmetricEigen<f64, nalgebra::Dyn>,
    /// E, P, Q of the present length.
    factors: [DMatrix<f64>; 3],
}

impl Flow {
    pub(super) fn of(scene: &Scene, springs: &[SpringDamper]) -> Self {
        let drag = scene.effects.drag.map_or(0.0, |drag| drag.coefficient);
        let rates: Vec<f64> = scene.bodies.iter().map(|body| drag / body.mass).collect();
        let clusters = clusters(scene, springs, drag);
        let mut is_clustered = vec![false; rates.len()];
        for body in clusters.iter().flat_map(|cluster| &cluster.bodies) {
            is_clustered[*body] = true;
        }
        Self {
            rates,
            clusters,
            is_clustered,
            length: f64::NAN,
            factors: Vec::new(),
        }
    }

    /// The factors of a step of this length, computed anew only when it changes.
    fn set_length(&mut self, h: f64) {
        if h.to_bits() == self.length.to_bits() {
            return;
        }
        self.length = h;
        let factors = |rate: &f64| {
            let [e, p, q] = decay(rate * h);
            [e, h * p, h * h * q]
        };
        self.factors.clear();
        if let Some(first) = self.rates.first()
            && self.rates.iter().all(|rate| rate == first)
        {
            self.factors.resize(self.rates.len(), factors(first));
        } else {
            self.factors.extend(self.rates.iter().map(factors));
        }
        for cluster in &mut self.clusters {
            cluster.set_length(h);
        }
    }

    /// Takes the particles over a step of that length from where they are, under their forces.
    #[inline]
    pub(super) fn advance(&mut self, particles: &mut [Particle], h: f64) {
        self.set_length(h);
        if self.clusters.is_empty() {
            for (particle, [e, p, q]) in particles.iter_mut().zip(&self.factors) {
                let acceleration = particle.force / particle.mass;
                particle.position += particle.velocity * *p + acceleration * *q;
                particle.velocity = particle.velocity * *e + acceleration * *p;
            }
            return;
        }
        for (body, particle) in particles.iter_mut().enumerate() {
            if !self.is_clustered[body] {
                let [e, p, q] = self.factors[body];
                let acceleration = particle.force / particle.mass;
                particle.position += particle.velocity * p + acceleration * q;
                particle.velocity = particle.velocity * e + acceleration * p;
            }
        }
        for cluster in &self.clusters {
            cluster.advance(particles, h);
        }
    }

    /// The same without forces, where all bodies are on their own.
    #[inline]
    pub(super) fn coast(&mut self, particles: &mut [Particle], h: f64) {
        self.set_length(h);
        for (particle, [e, p, _]) in particles.iter_mut().zip(&self.factors) {
            particle.position += particle.velocity * *p;
            particle.velocity *= *e;
        }
    }

    /// Operations of a motion beside those of bodies on their own.
    pub(super) fn operations(&self) -> u64 {
        let square = |cluster: &Cluster| (cluster.bodies.len() as u64).pow(2);
        self.clusters
            .iter()
            .map(|cluster| 12 * square(cluster) + 200)
            .sum()
    }

    /// c = k/m of drag. Shape: `[body]`.
    pub(super) fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Whether dampers tie bodies together.
    pub(super) fn is_coupled(&self) -> bool {
        !self.clusters.is_empty()
    }

    /// The way of a body over a step that led it from `start` to `end`.
    pub(super) fn way(&self, body: usize, start: &Particle, end: &Particle, h: f64) -> Flight {
        if self.is_clustered[body] {
            return Flight::Bent(Path::between(start, end, h));
        }
        Flight::Dragged {
            position: start.position,
            velocity: start.velocity,
            acceleration: end.force / end.mass,
            rate: self.rates[body],
        }
    }

    /// How far a unit push over the step on one body moves another: `Q/m`. Zero for two bodies that
    /// no damper ties.
    pub(super) fn mobility(&self, one: usize, other: usize, particles: &[Particle]) -> f64 {
        if one == other && !self.is_clustered[one] {
            return self.factors[one][2] / particles[one].mass;
        }
        let place = |cluster: &Cluster, body| cluster.bodies.iter().position(|b| *b == body);
        let shared = self.clusters.iter().find_map(|cluster| {
            let at = (place(cluster, one)?, place(cluster, other)?);
            Some(cluster.factors[2][at] / cluster.masses[at.1])
        });
        shared.unwrap_or(0.0)
    }
}

impl Cluster {
    fn set_length(&mut self, h: f64) {
        let parts: Vec<[f64; 3]> = self
            .eigen
            .eigenvalues
            .iter()
            .map(|rate| decay(rate.max(0.0) * h))
            .collect();
        let vectors = &self.eigen.eigenvectors;
        for (which, scale) in [1.0, h, h * h].into_iter().enumerate() {
            let middle = DMatrix::from_diagonal(&DVector::from_iterator(
                parts.len(),
                parts.iter().map(|part| scale * part[which]),
            ));
            let symmetric = vectors * middle * vectors.transpose();
            let roots = self.masses.map(f64::sqrt);
            self.factors[which] = DMatrix::from_fn(parts.len(), parts.len(), |i, j| {
                symmetric[(i, j)] * roots[j] / roots[i]
            });
        }
    }

    fn advance(&self, particles: &mut [Particle], h: f64) {
        let column = |value: &dyn Fn(&Particle) -> Vector3| {
            let rows: Vec<Vector3> = self
                .bodies
                .iter()
                .map(|body| value(&particles[*body]))
                .collect();
            DMatrix::from_fn(rows.len(), 3, |i, axis| rows[i][axis])
        };
        let velocity = column(&|particle| particle.velocity);
        let acceleration = column(&|particle| particle.force / particle.mass);
        let [e, p, q] = &self.factors;
        let mut moved = p * &velocity + q * &acceleration;
        let mut left = e * &velocity + p * &acceleration;
        if self.is_free {
            // The centre of mass moves as if there were no dampers; the products of matrices
            // keep that to their rounding only, which would add up.
            let mean = |rows: &DMatrix<f64>| self.masses.tr_mul(rows) / self.masses.sum();
            let [speed, pull] = [mean(&velocity), mean(&acceleration)];
            let off = [
                &speed * h + &pull * (0.5 * h * h) - mean(&moved),
                &speed + &pull * h - mean(&left),
            ];
            for row in 0..self.bodies.len() {
                for axis in 0..3 {
                    moved[(row, axis)] += off[0][axis];
                    left[(row, axis)] += off[1][axis];
                }
            }
        }
        for (row, body) in self.bodies.iter().enumerate() {
            let of = |rows: &DMatrix<f64>| Vector3::from_fn(|axis, _| rows[(row, axis)]);
            particles[*body].position += of(&moved);
            particles[*body].velocity = of(&left);
        }
    }
}

/// The bodies that dampers tie together, one cluster for each connected part.
fn clusters(scene: &Scene, springs: &[SpringDamper], drag: f64) -> Vec<Cluster> {
    let damped: Vec<&SpringDamper> = springs.iter().filter(|it| it.damping != 0.0).collect();
    let mut part: Vec<usize> = (0..scene.bodies.len()).collect();
    for spring in &damped {
        let [keep, drop] = spring.ends.map(|end| part[end]);
        for own in &mut part {
            if *own == drop {
                *own = keep;
            }
        }
    }
    let members = |root: usize| -> Vec<usize> {
        (0..part.len()).filter(|body| part[*body] == root).collect()
    };
    let parts = (0..part.len())
        .map(members)
        .filter(|bodies| bodies.len() > 1);
    parts
        .map(|bodies| cluster(scene, &damped, drag, bodies))
        .collect()
}

fn cluster(scene: &Scene, damped: &[&SpringDamper], drag: f64, bodies: Vec<usize>) -> Cluster {
    let count = bodies.len();
    let mut laplacian = DMatrix::from_diagonal_element(count, count, drag);
    for spring in damped {
        let [a, b] = spring
            .ends
            .map(|end| bodies.iter().position(|body| *body == end));
        if let (Some(a), Some(b)) = (a, b) {
            laplacian[(a, a)] += spring.damping;
            laplacian[(b, b)] += spring.damping;
            laplacian[(a, b)] -= spring.damping;
            laplacian[(b, a)] -= spring.damping;
        }
    }
    let masses = DVector::from_iterator(count, bodies.iter().map(|body| scene.bodies[*body].mass));
    let roots = masses.map(f64::sqrt);
    let symmetric = DMatrix::from_fn(count, count, |i, j| {
        laplacian[(i, j)] / (roots[i] * roots[j])
    });
    let none = DMatrix::zeros(count, count);
    Cluster {
        bodies,
        masses,
        is_free: drag == 0.0,
        eigen: SymmetricEigen::new(symmetric),
        factors: [none.clone(), none.clone(), none],
    }
}

/// The way of a body through a step.
#[derive(Debug, Clone, Copy)]
pub(super) enum Flight {
    /// `v' = a - c v`, in closed form.
    Dragged {
        position: Vector3,
        velocity: Vector3,
        acceleration: Vector3,
        rate: f64,
    },
    /// A cubic between both ends, where dampers tie bodies together.
    Bent(Path),
}

impl Flight {
    /// Acceleration at the start, which under drag is the largest.
    fn bend(&self) -> Option<Vector3> {
        match self {
            Self::Dragged {
                velocity,
                acceleration,
                rate,
                ..
            } => Some(acceleration - velocity * *rate),
            Self::Bent(_) => None,
        }
    }

    /// A bound on the size of the acceleration.
    fn bend_most(&self) -> f64 {
        match self {
            Self::Dragged { .. } => self.bend().map_or(0.0, |bend| bend.norm()),
            Self::Bent(path) => (0..3).map(|axis| path.bend_along(axis)).sum(),
        }
    }
}

impl Way for Flight {
    fn start(&self) -> &Vector3 {
        match self {
            Self::Dragged { position, .. } => position,
            Self::Bent(path) => path.start(),
        }
    }

    fn at(&self, t: f64) -> (Vector3, Vector3) {
        match self {
            Self::Dragged {
                position,
                velocity,
                acceleration,
                rate,
            } => {
                let [e, p, q] = decay(rate * t);
                (
                    position + (velocity * p + acceleration * (q * t)) * t,
                    velocity * e + acceleration * (p * t),
                )
            }
            Self::Bent(path) => path.at(t),
        }
    }

    fn bend_against(&self, other: &Self) -> f64 {
        if let (Self::Dragged { rate: own, .. }, Self::Dragged { rate: others, .. }) = (self, other)
            && own == others
            && let (Some(own), Some(others)) = (self.bend(), other.bend())
        {
            return (own - others).norm();
        }
        self.bend_most() + other.bend_most()
    }

    fn bend_along(&self, axis: usize) -> f64 {
        match self {
            Self::Dragged { .. } => self.bend().map_or(0.0, |bend| bend[axis].abs()),
            Self::Bent(path) => path.bend_along(axis),
        }
    }

    fn travel(&self, time: f64) -> f64 {
        match self {
            Self::Dragged { velocity, .. } => {
                (velocity.norm() + 0.5 * self.bend_most() * time) * time
            }
            Self::Bent(path) => path.travel(time),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both forms where they meet: the closed one loses about eps/z.
    #[test]
    fn the_series_joins_the_closed_form() {
        let (below, above) = (decay(SERIES_BELOW * (1.0 - 1e-15)), decay(SERIES_BELOW));
        for (one, other) in below.into_iter().zip(above) {
            assert!((one - other).abs() < 1e-14, "{one} {other}");
        }
        assert_eq!(decay(0.0), [1.0, 1.0, 0.5]);
        assert_eq!(decay(f64::INFINITY), [0.0, 0.0, 0.0]);
    }

    /// Two bodies and a damper: the relative velocity decays with `kd (1/m_a + 1/m_b)`, the
    /// momentum stays.
    #[test]
    fn a_damper_decays_the_relative_velocity_and_keeps_the_momentum() {
        let text = "name='x'\nduration=1\nsample_every=1\n\
            [[bodies]]\nname='a'\nmass=2\nradius=1\nposition=[0,0,0]\nvelocity=[3,0,0]\n\
            [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[9,0,0]\nvelocity=[0,1,0]\n\
            [[effects.springs]]\nbetween=['a','b']\nstiffness=0\nrest_length=1\ndamping=4e4\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        for (damping, h) in [(0.8, 0.5), (4e4, 0.5)] {
            let mut springs = SpringDamper::all(&scene);
            springs[0].damping = damping;
            let mut flow = Flow::of(&scene, &springs);
            let mut particles = super::super::super::particles(&scene);
            flow.advance(&mut particles, h);
            let left = (-damping * 1.5 * h).exp();
            let relative = particles[0].velocity - particles[1].velocity;
            let wanted = Vector3::new(3.0, -1.0, 0.0) * left;
            assert!((relative - wanted).norm() < 1e-14, "{relative}");
            let momentum = particles[0].velocity * 2.0 + particles[1].velocity;
            assert!((momentum - Vector3::new(6.0, 1.0, 0.0)).norm() < 4e-15);
        }
    }
}
