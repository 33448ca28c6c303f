//! An elastic gas of hard spheres that starts on a lattice.

use super::Random;
use crate::error::{Error, Result, number};
use crate::scene::{BODIES_MAX, Body, Contact, Cushions, Effects, LengthUnit, Scene, Units};

/// Equal spheres on a face-centred cubic lattice in a closed cubic box, with random velocities.
///
/// Four spheres a cell, `4 cells³` in all. The edge of the box follows from the filling
/// fraction f: `L³ = 16 pi r³ cells³ / (3 f)`. The lattice stands in the middle, with half as
/// much room to a wall as between neighbours: `a = L/(cells - 1/2 + 2^(-1/2))`, which leaves
/// less room the fewer cells there are. Velocities are normal with unit variance, with
/// the mean taken out, so that the gas as a whole is at rest.
/// Source: Alder and Wainwright 1959, the start of most hard-sphere studies.
#[derive(Debug, Clone, PartialEq)]
pub struct Gas {
    /// Lattice cells along each edge of the box.
    pub cells: usize,
    /// Filling fraction of the box, below 0.7404 (close packing).
    pub filling: f64,
    /// Seed of the velocities.
    pub seed: u64,
}

impl Default for Gas {
    fn default() -> Self {
        Self {
            cells: 6,
            filling: 0.49,
            seed: 1,
        }
    }
}

const RADIUS: f64 = 0.5;

/// Cells an edge: as many bodies as a scene may have.
const CELLS_MAX: usize = 20;
const _: () = assert!(4 * CELLS_MAX.pow(3) == BODIES_MAX);

/// The four places in a cell, in lattice constants.
const BASIS: [[f64; 3]; 4] = [
    [0.25, 0.25, 0.25],
    [0.75, 0.75, 0.25],
    [0.75, 0.25, 0.75],
    [0.25, 0.75, 0.75],
];

impl Gas {
    /// Makes the scene, in natural units: radius 0.5, mass 1, one unit of speed a degree of freedom.
    ///
    /// # Errors
    /// [`Error::Argument`] if there is no cell, too many of them, or no room between the spheres.
    pub fn scene(&self) -> Result<Scene> {
        check_filling(self.filling)?;
        if !(1..=CELLS_MAX).contains(&self.cells) {
            return Err(Error::Argument {
                argument: "cells",
                found: self.cells.to_string(),
                remedy: format!("give 1 to {CELLS_MAX} cells an edge (4 to {BODIES_MAX} spheres)"),
            });
        }
        #[allow(clippy::cast_precision_loss, reason = "20 cells at most")]
        let cells = self.cells as f64;
        let volume = 16.0 * std::f64::consts::PI * (RADIUS * cells).powi(3) / (3.0 * self.filling);
        let half = 0.5 * volume.cbrt();
        if !half.is_finite() {
            return Err(Error::Argument {
                argument: "filling",
                found: number(self.filling),
                remedy: "the box is too large for a number; give a larger fraction".into(),
            });
        }
        let constant = 2.0 * half / (cells - 0.5 + 0.5_f64.sqrt());
        if constant * 0.5_f64.sqrt() <= 2.0 * RADIUS {
            return Err(Error::Argument {
                argument: "filling",
                found: number(self.filling),
                remedy: format!(
                    "{} cells an edge do not fit between the walls; give a smaller fraction or more cells",
                    self.cells
                ),
            });
        }
        let scene = Scene {
            name: format!("gas-{}", 4 * self.cells.pow(3)),
            title: Some(format!("elastic gas of {} spheres", 4 * self.cells.pow(3))),
            source: Some(format!(
                "carom scenes generate gas --cells {} --filling {} --seed {}",
                self.cells,
                number(self.filling),
                self.seed
            )),
            watch: None,
            duration: 1.0,
            sample_every: 0.0625,
            units: Units {
                length: LengthUnit::None,
            },
            bodies: self.bodies(constant),
            effects: Effects {
                contact: Some(Contact { restitution: 1.0 }),
                cushions: Some(Cushions {
                    half_width: half,
                    half_length: half,
                    half_height: Some(half),
                    restitution: 1.0,
                }),
                ..Effects::default()
            },
        };
        scene.checked()?;
        Ok(scene)
    }

    /// Any number of spheres at a filling fraction of the box: the smallest lattice with so many
    /// places, evenly thinned.
    ///
    /// # Errors
    /// [`Error::Argument`] as for [`scene`](Self::scene), if the lattice has no room in the box.
    pub fn thinned(count: usize, filling: f64, seed: u64) -> Result<Scene> {
        check_filling(filling)?;
        let places = |cells: &usize| BASIS.len() * cells.pow(3);
        let cells = (1..=CELLS_MAX).find(|cells| count <= places(cells));
        let wrong = |remedy: String| Error::Argument {
            argument: "count",
            found: count.to_string(),
            remedy,
        };
        let cells = cells
            .filter(|_| count > 0)
            .ok_or_else(|| wrong(format!("give 1 to {} spheres", places(&CELLS_MAX))))?;
        let places = places(&cells);
        #[allow(clippy::cast_precision_loss, reason = "some ten thousand spheres")]
        let full = Self {
            cells,
            filling: filling * places as f64 / count as f64,
            seed,
        };
        let mut scene = full.scene().map_err(|_| {
            wrong(format!(
                "its lattice of {places} places does not fit into the box; give another number \
                 or another filling fraction than {filling}"
            ))
        })?;
        let mut place = 0;
        scene.bodies.retain(|_| {
            place += 1;
            place * count / places > (place - 1) * count / places
        });
        for (place, body) in scene.bodies.iter_mut().enumerate() {
            body.name = format!("s{place}");
        }
        put_at_rest(&mut scene.bodies);
        scene.name = format!("gas-{count}");
        scene.title = Some(format!("elastic gas of {count} spheres"));
        scene.source = Some(format!(
            "carom scenes generate gas --count {count} --filling {} --seed {seed}",
            number(filling)
        ));
        scene.checked()?;
        Ok(scene)
    }

    fn bodies(&self, constant: f64) -> Vec<Body> {
        let mut random = Random::new(self.seed);
        #[allow(clippy::cast_precision_loss, reason = "20 cells at most")]
        let middle = 0.5 * self.cells as f64;
        let mut bodies = Vec::new();
        for cell in 0..self.cells.pow(3) {
            let corner = [
                cell % self.cells,
                cell / self.cells % self.cells,
                cell / self.cells.pow(2),
            ];
            for place in BASIS {
                #[allow(clippy::cast_precision_loss, reason = "20 cells at most")]
                let position =
                    [0, 1, 2].map(|axis| constant * (corner[axis] as f64 + place[axis] - middle));
                bodies.push(Body {
                    name: format!("s{}", bodies.len()),
                    mass: 1.0,
                    radius: RADIUS,
                    position,
                    velocity: [(); 3].map(|()| random.normal()),
                });
            }
        }
        put_at_rest(&mut bodies);
        bodies
    }
}

/// Close packing is the most that a filling fraction can be.
fn check_filling(filling: f64) -> Result<()> {
    let packed = std::f64::consts::PI / 18.0_f64.sqrt();
    if filling > 0.0 && filling < packed {
        return Ok(());
    }
    Err(Error::Argument {
        argument: "filling",
        found: number(filling),
        remedy: format!("give a fraction above 0 and below {packed:.4}, close packing"),
    })
}

/// Takes the mean out of the velocities.
fn put_at_rest(bodies: &mut [Body]) {
    #[allow(clippy::cast_precision_loss, reason = "some ten thousand spheres")]
    let count = bodies.len() as f64;
    let mean = [0, 1, 2].map(|axis| bodies.iter().map(|b| b.velocity[axis]).sum::<f64>() / count);
    for body in bodies {
        body.velocity = [0, 1, 2].map(|axis| body.velocity[axis] - mean[axis]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lattice used to fill the whole box, so that the outer spheres stood in the walls.
    #[test]
    fn every_sphere_starts_free_of_walls_and_neighbours() {
        for (cells, filling) in [(1, 0.2), (2, 0.4), (6, 0.49), (14, 0.6)] {
            let recipe = Gas {
                cells,
                filling,
                seed: 1,
            };
            let scene = recipe.scene().unwrap();
            assert!(
                scene.warnings().is_empty(),
                "{cells}: {:?}",
                scene.warnings()
            );
            let half = scene.effects.cushions.unwrap().half_width;
            #[allow(clippy::cast_precision_loss, reason = "some ten thousand")]
            let spheres = scene.bodies.len() as f64 * std::f64::consts::PI / 6.0;
            assert!((spheres / (2.0 * half).powi(3) - filling).abs() < 1e-12);
        }
        let tight = Gas {
            cells: 2,
            filling: 0.6,
            seed: 1,
        };
        assert!(
            tight
                .scene()
                .unwrap_err()
                .to_string()
                .contains("between the walls")
        );
    }

    /// The filling is that of the spheres that are left, and they are left everywhere: each half
    /// of the box holds half of them, give or take those of a layer of the lattice.
    #[test]
    fn a_thinned_gas_has_its_number_and_its_filling_everywhere() {
        for count in [1, 4, 10, 30, 100, 300, 1000] {
            let scene = Gas::thinned(count, 0.1, 3).unwrap();
            assert_eq!(scene.bodies.len(), count);
            assert!(scene.warnings().is_empty(), "{count}");
            let half = scene.effects.cushions.unwrap().half_width;
            #[allow(clippy::cast_precision_loss, reason = "a thousand")]
            let spheres = count as f64;
            let volume = spheres * std::f64::consts::PI / 6.0;
            assert!((volume / (2.0 * half).powi(3) - 0.1).abs() < 1e-12);
            for axis in 0..3 {
                let sum: f64 = scene.bodies.iter().map(|body| body.velocity[axis]).sum();
                assert!(sum.abs() < 1e-12 * spheres, "{count}: {sum}");
                let above = scene.bodies.iter().filter(|b| b.position[axis] > 0.0);
                #[allow(clippy::cast_precision_loss, reason = "a thousand")]
                let off = (above.count() as f64 - 0.5 * spheres).abs();
                assert!(off <= 1.0 + spheres.powf(2.0 / 3.0), "{count}: {off}");
            }
        }
        let full = Gas {
            cells: 3,
            filling: 0.1,
            seed: 3,
        };
        let same = Gas::thinned(108, 0.1, 3).unwrap();
        assert_eq!(full.scene().unwrap().effects, same.effects);
        assert!(Gas::thinned(0, 0.1, 1).is_err() && Gas::thinned(5, 0.1, 1).is_err());
    }
}
