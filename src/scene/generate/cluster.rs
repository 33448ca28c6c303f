//! The lecture's random cluster: spheres at random that attract each other.

use nalgebra::Vector3;

use super::Random;
use crate::error::{Error, Result, number};
use crate::scene::{Attraction, Body, Contact, Effects, LengthUnit, Scene, Units};

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

impl Cluster {
    /// Makes the scene.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no body, or the spheres do not fit without overlap.
    pub fn scene(&self) -> Result<Scene> {
        if self.count == 0 {
            return Err(Error::Argument {
                argument: "count",
                found: "0".into(),
                remedy: "give 1 or more".into(),
            });
        }
        let mut random = Random::new(self.seed);
        let mut placed: Vec<(Vector3<f64>, f64)> = Vec::new();
        let mut bodies = Vec::new();
        for number in 0..self.count {
            let mass = random.between(self.mass[0], self.mass[1]);
            let radius = (3.0 * mass / (4.0 * std::f64::consts::PI * self.density)).cbrt();
            let position = self.place(&mut random, &placed, radius)?;
            placed.push((position.into(), radius));
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

    fn place(
        &self,
        random: &mut Random,
        placed: &[(Vector3<f64>, f64)],
        radius: f64,
    ) -> Result<[f64; 3]> {
        let free = |position: &[f64; 3]| {
            let centre = Vector3::from(*position);
            placed
                .iter()
                .all(|(other, r)| (centre - other).norm() > radius + r)
        };
        (0..TRIES)
            .map(|_| random.in_ball(self.extent))
            .find(free)
            .ok_or_else(|| Error::Argument {
                argument: "extent",
                found: number(self.extent),
                remedy: format!(
                    "sphere {} finds no free place; make the extent larger",
                    placed.len()
                ),
            })
    }
}
