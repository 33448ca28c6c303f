//! What makes a scene a scene: every rule of meaning, in one place, for files and for code.

use std::collections::HashMap;
use std::fmt;

use super::bounds::{BODIES_MAX, LOOKS_MAX, SAMPLES_MAX, STATES_MAX};
use super::fault::{
    Fault, FieldPath, fault, finite, finite_vector, fraction, not_negative, positive,
};
use super::overlap::survey;
use super::{Effects, Scene, Spring};
use crate::error::{Error, Result, code, is_invisible, number, quoted};

/// Characters in a name, at most.
const NAME_MAX: usize = 200;

/// Something allowed that the user should know of.
#[derive(Debug, Clone, PartialEq)]
pub enum SceneWarning {
    /// Two spheres overlap at the start.
    OverlapAtStart {
        /// The first body.
        body_a: String,
        /// The second body.
        body_b: String,
        /// Depth of the overlap, scene length unit.
        depth: f64,
        /// How many pairs overlap, as far as was looked.
        pairs: u64,
        /// Whether all pairs were looked at; else there may be more, and deeper ones.
        all: bool,
    },
    /// A sphere starts beyond a cushion.
    OutsideAtStart {
        /// The body.
        body: String,
    },
}

impl fmt::Display for SceneWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OverlapAtStart {
                body_a,
                body_b,
                depth,
                pairs,
                all,
            } => write!(
                f,
                "{}{pairs} pair(s) overlap at the start, deepest {} and {} by {depth:.3e} (scene units): \
                 engines push them apart, each in its own way; move them apart for a comparison of motion",
                if *all { "" } else { "more than " },
                code(body_a),
                code(body_b)
            ),
            Self::OutsideAtStart { body } => write!(
                f,
                "{} starts beyond a cushion: engines put it back, each in its own way; \
                 start it inside for a comparison of motion",
                code(body)
            ),
        }
    }
}

impl Scene {
    /// Checks every rule of meaning.
    ///
    /// # Errors
    /// The first [`Fault`], in the order of the scene file.
    pub fn check(&self) -> std::result::Result<(), Fault> {
        let root = FieldPath::default;
        check_scene_name(&self.name)?;
        let texts = [
            ("title", &self.title),
            ("source", &self.source),
            ("watch", &self.watch),
        ];
        for (key, text) in texts {
            if let Some(text) = text {
                check_text(&root().key(key), text)?;
            }
        }
        positive(&root().key("duration"), self.duration)?;
        positive(&root().key("sample_every"), self.sample_every)?;
        self.check_grid()?;
        if self.bodies.is_empty() {
            return Err(fault(
                root().key("bodies"),
                "empty",
                "add at least one [[bodies]] table",
            ));
        }
        if self.bodies.len() > BODIES_MAX {
            return Err(fault(
                root().key("bodies"),
                format!("{} bodies", self.bodies.len()),
                format!("a scene has at most {BODIES_MAX}; take fewer"),
            ));
        }
        let mut names = HashMap::new();
        for (index, body) in self.bodies.iter().enumerate() {
            let path = root().key("bodies").index(index);
            check_body_name(&path.clone().key("name"), &body.name)?;
            if let Some(first) = names.insert(body.name.as_str(), index) {
                return Err(fault(
                    path.key("name"),
                    format!("`{}`, the name of bodies[{first}] too", quoted(&body.name)),
                    "give every body a name of its own",
                ));
            }
            positive(&path.clone().key("mass"), body.mass)?;
            positive(&path.clone().key("radius"), body.radius)?;
            finite_vector(&path.clone().key("position"), &body.position)?;
            finite_vector(&path.key("velocity"), &body.velocity)?;
        }
        self.effects.check(&names)
    }

    /// The same check, with the scene's name in the error instead of a place in a file.
    ///
    /// # Errors
    /// [`Error::Scene`] with the first fault.
    pub fn checked(&self) -> Result<()> {
        self.check().map_err(|fault| Error::Scene {
            scene: self.name.clone(),
            message: fault.to_string(),
        })
    }

    fn check_grid(&self) -> std::result::Result<(), Fault> {
        let samples = (self.duration / self.sample_every).round();
        #[allow(clippy::cast_precision_loss, reason = "a bound, not a result")]
        let states = samples * self.bodies.len().max(1) as f64;
        if samples > SAMPLES_MAX {
            return Err(fault(
                FieldPath::default().key("sample_every"),
                format!("{} s", self.sample_every),
                format!(
                    "that makes {samples:.3e} samples, more than {SAMPLES_MAX:.0e}; sample less \
                     often or shorten `duration`"
                ),
            ));
        }
        if states > STATES_MAX {
            return Err(fault(
                FieldPath::default().key("sample_every"),
                format!("{} s", number(self.sample_every)),
                format!(
                    "that makes {states:.3e} states to keep (samples x bodies), more than {STATES_MAX:.0e}; \
                     sample less often or shorten `duration`"
                ),
            ));
        }
        let path = FieldPath::default().key("duration");
        let nearest = samples * self.sample_every;
        if (nearest - self.duration).abs() > 1e-9 * self.duration {
            return Err(fault(
                path,
                format!("{} s", number(self.duration)),
                format!(
                    "make it a multiple of sample_every = {} s, such as {} s",
                    number(self.sample_every),
                    number(samples.max(1.0) * self.sample_every)
                ),
            ));
        }
        Ok(())
    }

    /// What is allowed but worth saying.
    #[must_use]
    pub fn warnings(&self) -> Vec<SceneWarning> {
        let mut warnings = Vec::new();
        if let Some(cushions) = &self.effects.cushions {
            let half = cushions.half_extents();
            let outside = self.bodies.iter().find(|body| {
                (0..3).any(|axis| body.position[axis].abs() + body.radius > half[axis])
            });
            warnings.extend(outside.map(|body| SceneWarning::OutsideAtStart {
                body: body.name.clone(),
            }));
        }
        if self.effects.contact.is_some() {
            let spheres: Vec<_> = self
                .bodies
                .iter()
                .map(|body| (body.position.into(), body.radius))
                .collect();
            let found = survey(&spheres, LOOKS_MAX);
            warnings.extend(found.deepest.map(|deepest| SceneWarning::OverlapAtStart {
                body_a: self.bodies[deepest.a].name.clone(),
                body_b: self.bodies[deepest.b].name.clone(),
                depth: deepest.depth,
                pairs: found.pairs,
                all: found.all,
            }));
        }
        warnings
    }
}

impl Effects {
    fn check(&self, names: &HashMap<&str, usize>) -> std::result::Result<(), Fault> {
        let effect = |name| FieldPath::default().key("effects").key(name);
        if let Some(contact) = &self.contact {
            fraction(&effect("contact").key("restitution"), contact.restitution)?;
        }
        if let Some(cushions) = &self.cushions {
            positive(&effect("cushions").key("half_width"), cushions.half_width)?;
            positive(&effect("cushions").key("half_length"), cushions.half_length)?;
            if let Some(half_height) = cushions.half_height {
                positive(&effect("cushions").key("half_height"), half_height)?;
            }
            fraction(&effect("cushions").key("restitution"), cushions.restitution)?;
        }
        if let Some(drag) = &self.drag {
            not_negative(&effect("drag").key("coefficient"), drag.coefficient)?;
        }
        if let Some(rest) = &self.rest {
            not_negative(&effect("rest").key("speed"), rest.speed)?;
        }
        if let Some(attraction) = &self.attraction {
            finite(&effect("attraction").key("constant"), attraction.constant)?;
            not_negative(&effect("attraction").key("softening"), attraction.softening)?;
        }
        if let Some(gravity) = &self.gravity {
            finite_vector(
                &effect("gravity").key("acceleration"),
                &gravity.acceleration,
            )?;
        }
        for (index, spring) in self.springs.iter().enumerate() {
            check_spring(&effect("springs").index(index), spring, names)?;
        }
        Ok(())
    }
}

fn check_spring(
    path: &FieldPath,
    spring: &Spring,
    names: &HashMap<&str, usize>,
) -> std::result::Result<(), Fault> {
    for (end, name) in spring.between.iter().enumerate() {
        if !names.contains_key(name.as_str()) {
            return Err(fault(
                path.clone().key("between").index(end),
                format!("`{}`, and no body has that name", quoted(name)),
                "name two bodies of this scene",
            ));
        }
    }
    if spring.between[0] == spring.between[1] {
        return Err(fault(
            path.clone().key("between"),
            format!("`{}` twice", quoted(&spring.between[0])),
            "a spring joins two different bodies",
        ));
    }
    not_negative(&path.clone().key("stiffness"), spring.stiffness)?;
    not_negative(&path.clone().key("rest_length"), spring.rest_length)?;
    not_negative(&path.clone().key("damping"), spring.damping)
}

/// Text of one line for people, wherever a file of data has some.
pub(crate) fn check_text(path: &FieldPath, text: &str) -> std::result::Result<(), Fault> {
    if !text.chars().any(is_invisible) {
        return Ok(());
    }
    Err(fault(
        path.clone(),
        "text with control characters",
        "write it in one line, without control characters",
    ))
}

/// A name is a folder name too.
pub(crate) fn check_scene_name(name: &str) -> std::result::Result<(), Fault> {
    let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if !name.is_empty() && name.len() <= 100 && name.chars().all(allowed) {
        return Ok(());
    }
    Err(fault(
        FieldPath::default().key("name"),
        format!("`{}`", quoted(name)),
        "use 1 to 100 of the characters a-z, 0-9 and `-`; it is a folder name too",
    ))
}

fn check_body_name(path: &FieldPath, name: &str) -> std::result::Result<(), Fault> {
    if name.trim().is_empty() {
        return Err(fault(path.clone(), "empty", "give the body a name"));
    }
    if name.chars().any(is_invisible) {
        return Err(fault(
            path.clone(),
            format!("`{}`", quoted(name)),
            "leave out control characters such as tabs, line ends and marks of direction",
        ));
    }
    if name.chars().count() > NAME_MAX {
        return Err(fault(
            path.clone(),
            format!("{} characters long", name.chars().count()),
            format!("give a name of at most {NAME_MAX} characters"),
        ));
    }
    Ok(())
}
