//! *What* happens: bodies, units and effects, as a scene file says it or a generator makes it.

mod bounds;
pub(crate) mod check;
mod effects;
pub(crate) mod fault;
mod file;
pub mod generate;
pub mod overlap;
mod units;
mod words;

pub use bounds::BODIES_MAX;
pub(crate) use bounds::{LOOKS_MAX, TEXT_BYTES_MAX};
pub use check::SceneWarning;
pub use effects::{Attraction, Contact, Cushions, Drag, Effects, Gravity, Rest, Spring};
pub use fault::{Fault, FieldPath, PathStep};
pub(crate) use file::{exactly, parse_checked};
pub use file::{parse, read, to_toml};
pub use units::{LengthUnit, Units};

use serde::{Deserialize, Serialize};

/// One scene: the whole input of a simulation, and nothing about how to compute it.
///
/// A scene read from a file has been checked; one built by code is checked by
/// [`Scene::check`], which every engine calls before it starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Name, `[a-z0-9-]`: also a folder name.
    pub name: String,
    /// One line for people.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Where the scene comes from: the lecture's slide, a paper, a generator with its seed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// What to look for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub watch: Option<String>,
    /// Length of the simulation, s; a multiple of `sample_every`.
    pub duration: f64,
    /// Time between two samples, s.
    pub sample_every: f64,
    /// Unit of length.
    #[serde(default)]
    pub units: Units,
    /// The bodies, in the order in which every engine and file lists them.
    #[serde(default)]
    pub bodies: Vec<Body>,
    /// The declared effects.
    #[serde(default)]
    pub effects: Effects,
}

/// A sphere: mass, radius, and its state at time 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Unique name, free text without control characters.
    pub name: String,
    /// Mass, kg.
    pub mass: f64,
    /// Radius, scene length unit.
    pub radius: f64,
    /// Position of the centre at time 0, scene length unit.
    #[serde(deserialize_with = "file::exactly")]
    pub position: [f64; 3],
    /// Velocity at time 0, scene length unit per second.
    #[serde(deserialize_with = "file::exactly")]
    pub velocity: [f64; 3],
}

impl Scene {
    /// How many samples follow the one at time 0.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "check() bounds it"
    )]
    pub fn sample_count(&self) -> usize {
        (self.duration / self.sample_every).round() as usize
    }

    /// Time of a sample, s: `sample * sample_every`, without accumulated rounding.
    #[must_use]
    pub fn sample_time(&self, sample: usize) -> f64 {
        #[allow(
            clippy::cast_precision_loss,
            reason = "check() keeps samples far below 2^53"
        )]
        let count = sample as f64;
        count * self.sample_every
    }

    /// The same scene with every n-th sample; n divides the count of its samples.
    #[must_use]
    #[allow(
        clippy::cast_precision_loss,
        reason = "check() keeps samples far below 2^53"
    )]
    pub fn every(&self, n: usize) -> Self {
        Self {
            sample_every: self.sample_every * n as f64,
            ..self.clone()
        }
    }

    /// Index of the body of that name.
    #[must_use]
    pub fn body_index(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| body.name == name)
    }

    /// Index of the body that is fastest at time 0, the first of equals. Valid for a scene with
    /// bodies.
    #[must_use]
    pub fn fastest_body(&self) -> usize {
        let speed = |body: usize| {
            let [x, y, z] = self.bodies[body].velocity;
            x.hypot(y).hypot(z)
        };
        let faster = |best, body| {
            if speed(body) > speed(best) {
                body
            } else {
                best
            }
        };
        (1..self.bodies.len()).fold(0, faster)
    }

    /// The title, or the name where there is none.
    #[must_use]
    pub fn heading(&self) -> &str {
        self.title.as_deref().unwrap_or(&self.name)
    }

    /// The ends of each spring as body indices. Valid for a checked scene.
    #[must_use]
    pub fn spring_ends(&self) -> Vec<[usize; 2]> {
        let index: std::collections::HashMap<&str, usize> = self
            .bodies
            .iter()
            .enumerate()
            .map(|(i, body)| (body.name.as_str(), i))
            .collect();
        let ends = |spring: &Spring| {
            Some([
                *index.get(spring.between[0].as_str())?,
                *index.get(spring.between[1].as_str())?,
            ])
        };
        self.effects.springs.iter().filter_map(ends).collect()
    }
}
