//! The two tables of a scene, as docs/your-own-solver.md describes them.

use std::path::Path;

/// A sphere at time 0.
#[derive(Debug)]
pub struct Body {
    pub name: String,
    /// kg.
    pub mass: f64,
    /// Scene length unit, as all lengths here.
    pub radius: f64,
    pub position: [f64; 3],
    pub velocity: [f64; 3],
}

/// A scene: the time grid, the bodies, and the effects that it declares.
#[derive(Debug, Default)]
pub struct Scene {
    pub bodies: Vec<Body>,
    /// s.
    pub step: f64,
    pub steps_per_sample: f64,
    pub samples: f64,
    /// s.
    pub sample_every: f64,
    /// Restitution of two balls.
    pub contact: Option<f64>,
    /// Restitution of the walls.
    pub cushions: Option<f64>,
    /// Distances of the walls in x, y and z from the origin.
    pub half: [Option<f64>; 3],
    /// The force is -k v: k, kg/s.
    pub drag: f64,
    /// A ball slower than this stops.
    pub rest: f64,
    pub gravity: [f64; 3],
}

/// A row of the table of bodies.
type BodyRow = (String, f64, f64, f64, f64, f64, f64, f64, f64);

impl Scene {
    /// Reads both tables; an effect that this worker does not know is an error.
    pub fn read(bodies: &Path, effects: &Path) -> Result<Self, String> {
        let table = |path: &Path| {
            csv::Reader::from_path(path).map_err(|wrong| format!("{}: {wrong}", path.display()))
        };
        let mut scene = Self::default();
        for row in table(effects)?.deserialize() {
            let (effect, _, parameter, value): (String, usize, String, f64) =
                row.map_err(|wrong| format!("{}: {wrong}", effects.display()))?;
            scene.set(&effect, &parameter, value)?;
        }
        for row in table(bodies)?.deserialize() {
            let (name, mass, radius, x, y, z, vx, vy, vz): BodyRow =
                row.map_err(|wrong| format!("{}: {wrong}", bodies.display()))?;
            scene.bodies.push(Body {
                name,
                mass,
                radius,
                position: [x, y, z],
                velocity: [vx, vy, vz],
            });
        }
        Ok(scene)
    }

    fn set(&mut self, effect: &str, parameter: &str, value: f64) -> Result<(), String> {
        match (effect, parameter) {
            ("scene", "duration") => {}
            ("scene", "sample_every") => self.sample_every = value,
            ("scene", "step") => self.step = value,
            ("scene", "steps_per_sample") => self.steps_per_sample = value,
            ("scene", "samples") => self.samples = value,
            ("contact", "restitution") => self.contact = Some(value),
            ("cushions", "restitution") => self.cushions = Some(value),
            ("cushions", "half_width") => self.half[0] = Some(value),
            ("cushions", "half_height") => self.half[1] = Some(value),
            ("cushions", "half_length") => self.half[2] = Some(value),
            ("drag", "coefficient") => self.drag = value,
            ("rest", "speed") => self.rest = value,
            ("gravity", "acceleration_x") => self.gravity[0] = value,
            ("gravity", "acceleration_y") => self.gravity[1] = value,
            ("gravity", "acceleration_z") => self.gravity[2] = value,
            _ => return Err(format!("this worker knows no {parameter} of {effect}")),
        }
        Ok(())
    }
}
