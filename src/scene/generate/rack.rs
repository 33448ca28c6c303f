//! A rack of balls and a cue ball that breaks it.

use super::Random;
use crate::error::{Error, Result, number};
use crate::scene::overlap::survey;
use crate::scene::{Body, Contact, Cushions, Drag, Effects, LengthUnit, Rest, Scene, Units};

/// A triangle of balls on the lecture's table, and a cue ball shot at its head.
///
/// Table, ball, drag and rest are those of the lecture's `init()` and `floorDrag()`.
#[derive(Debug, Clone, PartialEq)]
pub struct Rack {
    /// Rows of the triangle; 5 rows are 15 balls.
    pub rows: usize,
    /// Free distance between neighbouring balls, mm; 0 lets them touch.
    pub gap: f64,
    /// Each ball is moved by up to this much in x and z, mm, so that no two racks are equal.
    pub jitter: f64,
    /// Seed of the jitter.
    pub seed: u64,
    /// Speed of the cue ball, mm/s.
    pub speed: f64,
}

impl Default for Rack {
    fn default() -> Self {
        Self {
            rows: 5,
            gap: 1.0,
            jitter: 0.0,
            seed: 1,
            speed: 5000.0,
        }
    }
}

const RADIUS: f64 = 40.75;
const MASS: f64 = 0.16;
const HALF_WIDTH: f64 = 710.0;
const HALF_LENGTH: f64 = 1420.0;

/// Share of a radius by which rounding may make balls overlap that touch.
const ROUNDING: f64 = 1e-12;

impl Rack {
    /// Makes the scene.
    ///
    /// # Errors
    /// [`Error::Argument`] if the rack does not fit on the table.
    pub fn scene(&self) -> Result<Scene> {
        if self.rows == 0 {
            return Err(Error::Argument {
                argument: "rows",
                found: "0".into(),
                remedy: "give 1 or more".into(),
            });
        }
        check_length("gap", self.gap)?;
        check_length("jitter", self.jitter)?;
        #[allow(clippy::cast_precision_loss, reason = "a handful of rows")]
        let rows = self.rows as f64;
        let pitch = 2.0 * RADIUS + self.gap;
        if rows * pitch + self.jitter >= 2.0 * HALF_WIDTH {
            return Err(Error::Argument {
                argument: "rows",
                found: self.rows.to_string(),
                remedy: "the rack is wider than the table; take fewer rows or a smaller gap".into(),
            });
        }
        let mut random = Random::new(self.seed);
        let mut bodies = vec![ball(
            "cue".into(),
            [0.0, RADIUS, 900.0],
            [0.0, 0.0, -self.speed],
        )];
        for row in 0..self.rows {
            for place in 0..=row {
                #[allow(clippy::cast_precision_loss, reason = "a handful of rows")]
                let (down, across) = (row as f64, place as f64 - row as f64 / 2.0);
                let x = across * pitch + random.between(-self.jitter, self.jitter);
                let z = -300.0 - down * pitch * 0.75_f64.sqrt()
                    + random.between(-self.jitter, self.jitter);
                bodies.push(ball(
                    format!("ball{}", bodies.len()),
                    [x, RADIUS, z],
                    [0.0; 3],
                ));
            }
        }
        let scene = Scene {
            name: format!("rack-{}", bodies.len() - 1),
            title: Some(format!("break of a rack of {} balls", bodies.len() - 1)),
            source: Some(self.command()),
            watch: None,
            duration: 4.0,
            sample_every: 0.0625,
            units: Units {
                length: LengthUnit::Millimetre,
            },
            bodies,
            effects: Effects {
                contact: Some(Contact { restitution: 0.9 }),
                cushions: Some(Cushions {
                    half_width: HALF_WIDTH,
                    half_length: HALF_LENGTH,
                    half_height: None,
                    restitution: 1.0,
                }),
                drag: Some(Drag { coefficient: 0.05 }),
                rest: Some(Rest { speed: 10.0 }),
                ..Effects::default()
            },
        };
        scene.checked()?;
        if let Some(what) = not_free(&scene) {
            return Err(Error::Argument {
                argument: "rows",
                found: self.rows.to_string(),
                remedy: format!(
                    "{what}; take fewer rows, another gap or a jitter below half the gap"
                ),
            });
        }
        Ok(scene)
    }

    /// The command that makes it again; a seed says nothing where no ball is moved.
    fn command(&self) -> String {
        let gap = number(self.gap);
        let rack = format!(
            "carom scenes generate rack --rows {} --gap {gap}",
            self.rows
        );
        if self.jitter == 0.0 {
            return rack;
        }
        format!(
            "{rack} --jitter {} --seed {}",
            number(self.jitter),
            self.seed
        )
    }
}

fn check_length(argument: &'static str, length: f64) -> Result<()> {
    if length.is_finite() && length >= 0.0 {
        return Ok(());
    }
    Err(Error::Argument {
        argument,
        found: number(length),
        remedy: "give a length of 0 or more, mm".into(),
    })
}

/// Which ball stands in another or in a cushion. Balls without a gap touch to rounding.
fn not_free(scene: &Scene) -> Option<String> {
    let spheres: Vec<_> = scene
        .bodies
        .iter()
        .map(|body| (body.position.into(), body.radius))
        .collect();
    let deepest = survey(&spheres, u64::MAX).deepest;
    let overlap = deepest.filter(|found| found.depth > ROUNDING * RADIUS);
    let half = [HALF_WIDTH, f64::INFINITY, HALF_LENGTH];
    let is_outside =
        |body: &&Body| (0..3).any(|axis| body.position[axis].abs() + RADIUS > half[axis]);
    let name = |body: usize| &scene.bodies[body].name;
    match (overlap, scene.bodies.iter().find(is_outside)) {
        (Some(pair), _) => Some(format!("`{}` and `{}` overlap", name(pair.a), name(pair.b))),
        (None, Some(body)) => Some(format!("`{}` stands in a cushion", body.name)),
        (None, None) => None,
    }
}

fn ball(name: String, position: [f64; 3], velocity: [f64; 3]) -> Body {
    Body {
        name,
        mass: MASS,
        radius: RADIUS,
        position,
        velocity,
    }
}
