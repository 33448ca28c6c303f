//! The lecture's random cluster: spheres at random that attract each other.

use std::collections::HashMap;

use nalgebra::Vector3;

use super::Random;
use crate::error::{Error, Result, number};
use crate::scene::{Attraction, BODIES_MAX, Body, Contact, Effects, LengthUnit, Scene, Units};

/// Spheres placed at random in a ball, none overlapping, that attract and collide.
///
/// Radius = (3 m / (4 pi density))^(1/3). Source: lecture, "다수의 입자 만유인력" (many particles
/// under gravitation), where G = 5.5 and e = 0.1.
#[derive(Debug, Clone, PartialEq)]
pub struct Cluster {
    /// Number of spheres.
    pub count: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Radius of the ball that holds the centres, m.
    pub extent: f64,
    /// Masses are uniform between these, kg.
    pub mass: [f64; 2],
    /// Density, kg/m³.
    pub density: f64,
    /// Largest initial speed, m/s.
    pub speed: f64,
}

impl Default for Cluster {
    fn default() -> Self {
        Self {
            count: 30,
            seed: 1,
            extent: 30.0,
            mass: [10.0, 90.0],
            density: 2.0,
            speed: 2.0,
        }
    }
}

/// Tries to place one sphere before the recipe is called too dense.
const TRIES: usize = 10_000;

/// Tries to place all of them: half a second.
const TRIES_IN_ALL: usize = 500_000;

impl Cluster {
    /// Makes the scene.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no body, or the spheres do not fit without overlap.
    pub fn scene(&self) -> Result<Scene> {
        self.check()?;
        let mut random = Random::new(self.seed);
        let mut placed = Placed::new(self.radius(self.mass[0].max(self.mass[1])));
        let mut bodies = Vec::new();
        for number in 0..self.count {
            let mass = random.between(self.mass[0], self.mass[1]);
            let radius = self.radius(mass);
            let position = self.place(&mut random, &mut placed, radius)?;
            let velocity = random.in_ball(self.speed);
            bodies.push(Body {
                name: format!("ball{number}"),
                mass,
                radius,
                position,
                velocity,
            });
        }
        let scene = Scene {
            name: format!("cluster-{}-seed-{}", self.count, self.seed),
            title: Some(format!("{} attracting spheres at random", self.count)),
            source: Some(format!(
                "lecture, collisions: many particles under gravitation; carom scenes generate cluster --count {} --extent {} --seed {}",
                self.count,
                number(self.extent),
                self.seed
            )),
            watch: None,
            duration: 3.0,
            sample_every: 0.0625,
            units: Units {
                length: LengthUnit::Metre,
            },
            bodies,
            effects: Effects {
                contact: Some(Contact { restitution: 0.1 }),
                attraction: Some(Attraction {
                    constant: 5.5,
                    softening: 0.0,
                }),
                ..Effects::default()
            },
        };
        scene.checked()?;
        Ok(scene)
    }

    fn radius(&self, mass: f64) -> f64 {
        (3.0 * mass / (4.0 * std::f64::consts::PI * self.density)).cbrt()
    }

    /// Sees that the spheres may fit, before any is placed.
    fn check(&self) -> Result<()> {
        let wrong = |argument, found: String, remedy: String| {
            Err(Error::Argument {
                argument,
                found,
                remedy,
            })
        };
        if !(1..=BODIES_MAX).contains(&self.count) {
            let remedy = format!("give 1 to {BODIES_MAX}");
            return wrong("count", self.count.to_string(), remedy);
        }
        let above_zero = [
            ("extent", self.extent),
            ("mass", self.mass[0]),
            ("mass", self.mass[1]),
            ("density", self.density),
        ];
        for (argument, value) in above_zero {
            if !(value.is_finite() && value > 0.0) {
                let remedy = "give a finite number above 0".to_owned();
                return wrong(argument, number(value), remedy);
            }
        }
        #[allow(clippy::cast_precision_loss, reason = "some ten thousand")]
        let least = self.count as f64 * self.radius(self.mass[0].min(self.mass[1])).powi(3);
        let room = (self.extent + self.radius(self.mass[0].max(self.mass[1]))).powi(3);
        if least > room {
            let remedy = format!(
                "{} spheres have more volume than the ball that is to hold them; make the extent \
                 larger",
                self.count
            );
            return wrong("extent", number(self.extent), remedy);
        }
        Ok(())
    }

    fn place(&self, random: &mut Random, placed: &mut Placed, radius: f64) -> Result<[f64; 3]> {
        let tries = TRIES.min(placed.tries_left);
        for _ in 0..tries {
            placed.tries_left -= 1;
            let position = random.in_ball(self.extent);
            if placed.is_free(&position, radius) {
                placed.add(position, radius);
                return Ok(position);
            }
        }
        Err(Error::Argument {
            argument: "extent",
            found: number(self.extent),
            remedy: format!(
                "sphere {} finds no free place in {tries} tries; make the extent larger",
                placed.spheres.len()
            ),
        })
    }
}

/// The spheres placed, in cells as wide as the largest: only those of the cells around can
/// overlap a new one.
struct Placed {
    spheres: Vec<(Vector3<f64>, f64)>,
    cells: HashMap<[i64; 3], Vec<usize>>,
    edge: f64,
    tries_left: usize,
}

impl Placed {
    fn new(radius_max: f64) -> Self {
        Self {
            spheres: Vec::new(),
            cells: HashMap::new(),
            edge: 2.0 * radius_max,
            tries_left: TRIES_IN_ALL,
        }
    }

    #[allow(
        clippy::cast_possible_truncation,
        reason = "far out, where it saturates, spheres share a cell"
    )]
    fn cell(&self, position: &[f64; 3]) -> [i64; 3] {
        position.map(|x| (x / self.edge).floor() as i64)
    }

    fn is_free(&self, position: &[f64; 3], radius: f64) -> bool {
        let centre = Vector3::from(*position);
        let own = self.cell(position);
        let around = (0_i64..27).map(|n| {
            let steps = [n % 3, n / 3 % 3, n / 9];
            [0, 1, 2].map(|axis| own[axis].saturating_add(steps[axis] - 1))
        });
        let near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        near.map(|place| self.spheres[*place])
            .all(|(other, r)| (centre - other).norm() > radius + r)
    }

    fn add(&mut self, position: [f64; 3], radius: f64) {
        let cell = self.cell(&position);
        self.cells.entry(cell).or_default().push(self.spheres.len());
        self.spheres.push((position.into(), radius));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looking at the cells around gives what looking at all gave.
    #[test]
    fn spheres_of_a_dense_cluster_stand_free() {
        let dense = Cluster {
            count: 2000,
            extent: 40.0,
            ..Cluster::default()
        };
        let scene = dense.scene().unwrap();
        assert_eq!(scene.bodies.len(), 2000);
        assert!(scene.warnings().is_empty());
    }

    #[test]
    fn what_cannot_fit_is_refused_before_any_is_placed() {
        let said = |count: usize, extent: f64| {
            let recipe = Cluster {
                count,
                extent,
                ..Cluster::default()
            };
            recipe.scene().unwrap_err().to_string()
        };
        assert!(said(0, 30.0).contains("--count 0: give 1 to 32000"));
        assert!(said(usize::MAX, 30.0).contains("give 1 to 32000"));
        for extent in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(said(3, extent).contains("above 0"), "{extent}");
        }
        assert!(said(32_000, 30.0).contains("more volume"));
        assert!(said(10_000, 50.0).contains("no free place"));
    }
}
