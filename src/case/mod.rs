//! A case: a scene with what independent evidence there is about it and what must hold on it.
//!
//! Names resolve in the folder `reference/` (or another one), else among the cases that are
//! compiled in; then among the hard cases of `hard/`, likewise.

mod baseline;
mod expected;
mod library;
mod profile;
mod profile_toml;

pub use baseline::{baseline_file, thinning};
pub use expected::{
    Axis, End, EndState, EnergyBound, Expected, ImpactCounts, Mirror, MomentumBound,
    PenetrationBound, SpeedBound,
};
pub use library::{HARD, Library, REFERENCE};
pub use profile::{Metric, Profile, Tolerance, Tolerances};
pub use profile_toml::with_profile;

use std::path::Path;

use serde::Serialize;

use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::scene::{self, Scene};

/// The name of the voice of independent truth.
pub const TRUTH: &str = "truth";

/// The heading of `ORIGIN.md` where carom made the truth itself.
pub const OWN_ORIGIN: &str = "# Origin of the truth: carom's own engine `exact`";

/// Who made the truth of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Evidence {
    /// Closed forms or programs that share nothing with carom.
    Independent,
    /// The engine `exact`, as far as it certifies; it says nothing about that engine.
    Own,
}

/// A scene, the truth about it where there is one, and what must hold where that is said.
#[derive(Debug, Clone)]
pub struct Case {
    /// The scene.
    pub scene: Scene,
    /// A recording with the voice `truth`.
    pub truth: Option<Recording>,
    /// Who made it.
    pub evidence: Option<Evidence>,
    /// Where the evidence comes from.
    pub origin: Option<String>,
    /// What must hold, whatever computes the scene.
    pub expected: Option<Expected>,
}

/// A scene by the path of its file, or a case by its name.
///
/// # Errors
/// Those of reading it, or [`Error::UnknownCase`].
pub fn scene_or_case(name: &str, library: &Library) -> Result<Case> {
    if is_scene_file(name) {
        return Ok(Case {
            scene: scene::read(Path::new(name))?,
            truth: None,
            evidence: None,
            origin: None,
            expected: None,
        });
    }
    case(name, library)
}

/// Whether a name means a scene file, and no case of a library.
#[must_use]
pub fn is_scene_file(name: &str) -> bool {
    let path = Path::new(name);
    let is_toml = |extension: &std::ffi::OsStr| extension == "toml";
    path.is_file() || path.extension().is_some_and(is_toml)
}

/// A case by its name, of the library or else a hard one.
///
/// # Errors
/// As [`Library::case`].
pub fn case(name: &str, library: &Library) -> Result<Case> {
    or_hard(library, |library| library.case(name))
}

/// The text of a case's scene file, of the library or else of a hard one.
///
/// # Errors
/// As [`Library::scene_text`].
pub fn scene_text(name: &str, library: &Library) -> Result<String> {
    or_hard(library, |library| library.scene_text(name))
}

/// What a library says, or the hard cases where it has no case of that name.
fn or_hard<T>(library: &Library, ask: impl Fn(&Library) -> Result<T>) -> Result<T> {
    let unknown = match ask(library) {
        Err(unknown @ Error::UnknownCase { .. }) => unknown,
        said => return said,
    };
    match ask(&Library::hard()) {
        Err(Error::UnknownCase { hint, .. }) if hint.is_empty() => Err(unknown),
        said => said,
    }
}
