//! What must hold on a scene, whatever computes it, and why: bounds as data (`expected.toml`).

use std::collections::BTreeMap;

use serde::Deserialize;

use super::Profile;
use crate::engine::StepGrid;
use crate::error::{Error, number, quoted};
use crate::physics::{BodyState, Vector3};
use crate::recording::initial_states;
use crate::scene::check::check_text;
use crate::scene::fault::{fault, finite, finite_vector, not_negative, positive};
use crate::scene::{Fault, FieldPath, Scene, exactly, parse_checked};

/// The steps to run at where a case asks for no others, s.
const LADDER: [f64; 3] = [0.1, 0.01, 0.001];

/// Ulps of the largest coordinate by which spheres may overlap where a case says nothing else.
const ULPS: f64 = 4.0;

/// What must hold on a scene. Each bound is there or not; all that are there hold together with
/// a run that ends at the scene's end.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expected {
    /// The steps to run at, s, the largest first.
    #[serde(default = "ladder")]
    pub dt: Vec<f64>,
    /// What the total energy may do.
    pub energy: Option<EnergyBound>,
    /// What the total momentum may do.
    pub momentum: Option<MomentumBound>,
    /// How deep bodies may stand in each other and in walls.
    pub penetration: Option<PenetrationBound>,
    /// How many impacts there are.
    pub impacts: Option<ImpactCounts>,
    /// A plane in which the motion stays its own mirror image.
    pub mirror: Option<Mirror>,
    /// How fast bodies may be.
    pub speed: Option<SpeedBound>,
    /// Where bodies are at the end.
    pub end: Option<End>,
    /// What the case tests, in a word or two; checks are summed up by it.
    pub topic: Option<String>,
    /// What each engine is known to do on the case, by its name.
    #[serde(default)]
    pub profile: BTreeMap<String, Profile>,
}

/// Bounds of the total energy, as shares of a scale.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnergyBound {
    /// How far it may rise above that of the start.
    pub gain_max: f64,
    /// How far it may fall below it; without, as far as it likes.
    pub loss_max: Option<f64>,
    /// The scale, kg length²/s²; without, the kinetic energy of the start and the
    /// sizes of the energies of attraction and springs there. A scene that starts with none of
    /// these, as bodies that fall in uniform gravity do, must state it.
    pub scale: Option<f64>,
    /// Why it must hold.
    pub why: String,
}

/// A bound of the total momentum, as a share of a scale.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MomentumBound {
    /// How far it may be from that of the start.
    pub change_max: f64,
    /// The scale, kg length/s; without, the sum of m |v| of the start.
    pub scale: Option<f64>,
    /// Why it must hold.
    pub why: String,
}

/// How deep bodies may stand in each other and in walls, at samples.
///
/// Equation: depth <= `depth_max` r + `ulps` ulp(x), r the smallest radius and x the largest
/// coordinate.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PenetrationBound {
    /// Share of the smallest radius.
    pub depth_max: f64,
    /// Ulps of the largest coordinate, for the rounding of doubles.
    #[serde(default = "ulps")]
    pub ulps: f64,
    /// From when on, s.
    #[serde(default)]
    pub after: f64,
    /// Why it must hold.
    pub why: String,
}

/// How many impacts there are from the start to the end.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImpactCounts {
    /// Between spheres.
    pub contacts: Option<u64>,
    /// Between spheres, at least.
    pub contacts_min: Option<u64>,
    /// On walls.
    pub cushions: Option<u64>,
    /// Why it must hold.
    pub why: String,
}

/// A coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// The first.
    X,
    /// The second, upwards.
    Y,
    /// The third.
    Z,
}

/// A plane across an axis in which the motion stays its own mirror image.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mirror {
    /// The axis that is turned round.
    pub axis: Axis,
    /// Where on it the plane is, scene length unit.
    #[serde(default)]
    pub at: f64,
    /// How far a body may be from its image, scene length unit.
    pub within: f64,
    /// Why it must hold.
    pub why: String,
}

/// How fast bodies may be, at samples.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpeedBound {
    /// The largest speed, scene length unit per second.
    pub max: f64,
    /// From when on, s.
    #[serde(default)]
    pub after: f64,
    /// Why it must hold.
    pub why: String,
}

/// Where bodies are at the end, by a closed form.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct End {
    /// How far a position may be off, scene length unit.
    pub within: f64,
    /// How far a velocity may be off, scene length unit per second; needed where one is given.
    pub within_velocity: Option<f64>,
    /// Why it must hold.
    pub why: String,
    /// The bodies of which it is known.
    pub bodies: Vec<EndState>,
}

/// The state of one body at the end.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EndState {
    /// The body.
    pub name: String,
    /// Position of its centre, scene length unit.
    #[serde(deserialize_with = "exactly")]
    pub position: [f64; 3],
    /// Its velocity, where that is known, scene length unit per second.
    #[serde(default, deserialize_with = "known_vector")]
    pub velocity: Option<[f64; 3]>,
}

fn ladder() -> Vec<f64> {
    LADDER.to_vec()
}

fn ulps() -> f64 {
    ULPS
}

fn known_vector<'de, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> std::result::Result<Option<[f64; 3]>, D::Error> {
    exactly(deserializer).map(Some)
}

impl Mirror {
    /// The mirror image of a state.
    #[must_use]
    pub fn image(&self, state: &BodyState) -> BodyState {
        let axis = self.axis as usize;
        let mut image = *state;
        image.position[axis] = 2.0 * self.at - image.position[axis];
        image.velocity[axis] = -image.velocity[axis];
        image
    }

    /// For each body the one that starts as its image, or the first body that has none.
    ///
    /// # Errors
    /// The index of that body.
    pub fn partners(&self, scene: &Scene) -> std::result::Result<Vec<usize>, usize> {
        let starts = initial_states(scene);
        let partner = |body: usize| {
            let image = self.image(&starts[body]);
            let (own, bodies) = (&scene.bodies[body], &scene.bodies);
            let is_image = |other: &usize| {
                starts[*other] == image
                    && bodies[*other].mass == own.mass
                    && bodies[*other].radius == own.radius
            };
            (0..bodies.len()).find(is_image).ok_or(body)
        };
        (0..scene.bodies.len()).map(partner).collect()
    }
}

impl Expected {
    /// Parses the text of an `expected.toml` and checks it against its scene; `file` is its name
    /// in messages.
    ///
    /// # Errors
    /// [`Error::DataFile`](crate::error::Error::DataFile) with line, column and remedy.
    pub fn parse(text: &str, file: &str, scene: &Scene) -> crate::error::Result<Self> {
        parse_checked(text, file, |expected: &Self| expected.check(scene))
    }

    /// Checks every rule of meaning.
    ///
    /// # Errors
    /// The first [`Fault`].
    pub fn check(&self, scene: &Scene) -> std::result::Result<(), Fault> {
        self.check_ladder(scene)?;
        if let Some(topic) = &self.topic {
            check_text(&root("topic"), topic)?;
        }
        let effects = &scene.effects;
        let starts = initial_states(scene);
        let at_rest = starts.iter().all(|it| it.velocity == Vector3::zeros());
        let conservative = effects.attraction.is_some()
            || effects.gravity.is_some()
            || !effects.springs.is_empty();
        if let Some(bound) = &self.energy {
            let path = root("energy");
            not_negative(&path.clone().key("gain_max"), bound.gain_max)?;
            if let Some(loss) = bound.loss_max {
                not_negative(&path.clone().key("loss_max"), loss)?;
            }
            check_scale(&path, bound.scale, at_rest && !conservative)?;
            check_reason(&path, &bound.why)?;
        }
        if let Some(bound) = &self.momentum {
            let path = root("momentum");
            not_negative(&path.clone().key("change_max"), bound.change_max)?;
            check_scale(&path, bound.scale, at_rest)?;
            check_reason(&path, &bound.why)?;
        }
        if let Some(bound) = &self.penetration {
            let path = root("penetration");
            not_negative(&path.clone().key("depth_max"), bound.depth_max)?;
            not_negative(&path.clone().key("ulps"), bound.ulps)?;
            check_after(&path, bound.after, scene)?;
            check_reason(&path, &bound.why)?;
            if effects.contact.is_none() && effects.cushions.is_none() {
                let remedy = "declare contact or cushions in the scene, or leave this out";
                return Err(fault(path, "a bound of nothing", remedy));
            }
        }
        if let Some(bound) = &self.speed {
            let path = root("speed");
            not_negative(&path.clone().key("max"), bound.max)?;
            check_after(&path, bound.after, scene)?;
            check_reason(&path, &bound.why)?;
        }
        self.check_impacts(scene)?;
        self.check_mirror(scene)?;
        self.check_end(scene)?;
        let mut profiles = self.profile.iter();
        profiles.try_for_each(|(name, profile)| {
            profile.check(&root("profile").key(name.clone()), scene)
        })
    }

    /// Whether it bounds anything, whatever computes the scene.
    #[must_use]
    pub fn has_bounds(&self) -> bool {
        let Self {
            dt: _,
            energy,
            momentum,
            penetration,
            impacts,
            mirror,
            speed,
            end,
            topic: _,
            profile: _,
        } = self;
        energy.is_some()
            || momentum.is_some()
            || penetration.is_some()
            || impacts.is_some()
            || mirror.is_some()
            || speed.is_some()
            || end.is_some()
    }

    fn check_ladder(&self, scene: &Scene) -> std::result::Result<(), Fault> {
        let path = root("dt");
        if self.dt.is_empty() {
            return Err(fault(path, "empty", "give one step at least, in s"));
        }
        for (place, dt) in self.dt.iter().enumerate() {
            let here = path.clone().index(place);
            positive(&here, *dt)?;
            // The steps that stand for none in the file are no fault of the file.
            if self.dt != LADDER {
                check_step(&here, *dt, scene)?;
            }
            if place > 0 && *dt >= self.dt[place - 1] {
                let remedy = "give the steps from the largest to the smallest, each once";
                return Err(fault(here, number(*dt), remedy));
            }
        }
        Ok(())
    }

    fn check_impacts(&self, scene: &Scene) -> std::result::Result<(), Fault> {
        let Some(counts) = &self.impacts else {
            return Ok(());
        };
        let path = root("impacts");
        check_reason(&path, &counts.why)?;
        let effects = &scene.effects;
        let counted = [
            ("contacts", counts.contacts, effects.contact.is_some()),
            (
                "contacts_min",
                counts.contacts_min,
                effects.contact.is_some(),
            ),
            ("cushions", counts.cushions, effects.cushions.is_some()),
        ];
        if counted.iter().all(|(_, count, _)| count.is_none()) {
            let remedy = "give contacts, contacts_min or cushions";
            return Err(fault(path, "without a number", remedy));
        }
        for (key, count, declared) in counted {
            if let (Some(count), false) = (count, declared) {
                let remedy = "the scene declares no such effect; leave this out";
                return Err(fault(path.key(key), count.to_string(), remedy));
            }
        }
        Ok(())
    }

    fn check_mirror(&self, scene: &Scene) -> std::result::Result<(), Fault> {
        let Some(mirror) = &self.mirror else {
            return Ok(());
        };
        let path = root("mirror");
        finite(&path.clone().key("at"), mirror.at)?;
        not_negative(&path.clone().key("within"), mirror.within)?;
        check_reason(&path, &mirror.why)?;
        mirror.partners(scene).map(drop).map_err(|body| {
            let found = format!(
                "a plane in which `{}` has no image",
                scene.bodies[body].name
            );
            fault(path, found, "start the scene as its own mirror image")
        })
    }

    fn check_end(&self, scene: &Scene) -> std::result::Result<(), Fault> {
        let Some(end) = &self.end else {
            return Ok(());
        };
        let path = root("end");
        not_negative(&path.clone().key("within"), end.within)?;
        if let Some(within) = end.within_velocity {
            not_negative(&path.clone().key("within_velocity"), within)?;
        }
        check_reason(&path, &end.why)?;
        if end.bodies.is_empty() {
            return Err(fault(path.key("bodies"), "empty", "name a body at least"));
        }
        for (place, state) in end.bodies.iter().enumerate() {
            let here = path.clone().key("bodies").index(place);
            let name = here.clone().key("name");
            if scene.body_index(&state.name).is_none() {
                let found = format!("`{}`, and no body has that name", quoted(&state.name));
                return Err(fault(name, found, "name a body of the scene"));
            }
            if end.bodies[..place].iter().any(|it| it.name == state.name) {
                let found = format!("`{}` again", quoted(&state.name));
                return Err(fault(name, found, "name each body once"));
            }
            finite_vector(&here.clone().key("position"), &state.position)?;
            let Some(velocity) = &state.velocity else {
                continue;
            };
            finite_vector(&here.clone().key("velocity"), velocity)?;
            if end.within_velocity.is_none() {
                let remedy = "say in end.within_velocity how far it may be off";
                return Err(fault(here.key("velocity"), "without a bound", remedy));
            }
        }
        Ok(())
    }
}

fn root(key: &'static str) -> FieldPath {
    FieldPath::default().key(key)
}

/// A scale is needed where the start has none of its own.
fn check_scale(
    path: &FieldPath,
    scale: Option<f64>,
    needed: bool,
) -> std::result::Result<(), Fault> {
    match scale {
        Some(scale) => positive(&path.clone().key("scale"), scale),
        None if needed => {
            let remedy = "the scene starts at zero: give the scale that the shares are of";
            Err(fault(path.clone().key("scale"), "missing", remedy))
        }
        None => Ok(()),
    }
}

/// A step that the scene can be run at.
pub(super) fn check_step(
    path: &FieldPath,
    dt: f64,
    scene: &Scene,
) -> std::result::Result<(), Fault> {
    positive(path, dt)?;
    StepGrid::new(scene, dt).map(drop).map_err(|wrong| {
        let remedy = match wrong {
            Error::Step { message, .. } => message,
            other => other.to_string(),
        };
        fault(path.clone(), format!("{} s", number(dt)), remedy)
    })
}

fn check_after(path: &FieldPath, after: f64, scene: &Scene) -> std::result::Result<(), Fault> {
    let path = path.clone().key("after");
    not_negative(&path, after)?;
    if after > scene.duration {
        let end = number(scene.duration);
        let remedy = format!("the scene ends at {end} s; give a time in it");
        return Err(fault(path, format!("{} s", number(after)), remedy));
    }
    Ok(())
}

fn check_reason(path: &FieldPath, why: &str) -> std::result::Result<(), Fault> {
    if why.trim().is_empty() {
        let remedy = "say where the bound comes from";
        return Err(fault(path.clone().key("why"), "empty", remedy));
    }
    check_text(&path.clone().key("why"), why)
}
