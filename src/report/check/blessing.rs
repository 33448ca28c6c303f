//! What a blessing changes, shown before it is written.

use std::path::Path;

use crate::case::{baseline_file, thinning, with_profile};
use crate::error::{Error, Result, harmless};
use crate::recording::write_trajectory;
use crate::report::{Output, Replace};
use crate::scene::Scene;
use crate::study::check::Blessing;

/// What changes, case by case; what would notice less is marked.
#[must_use]
pub fn blessing_text(blessings: &[Blessing]) -> String {
    let mut text = String::new();
    for blessing in blessings {
        for change in &blessing.changes {
            let mark = if change.widens { "  WIDER" } else { "" };
            let line = format!("{} {}: {}{mark}", blessing.like, blessing.case, change.what);
            text.push_str(&harmless(&line));
            text.push('\n');
        }
    }
    text
}

/// Writes what a blessing changes into the folder of its case: the profile into `expected.toml`,
/// whose `text` this is, and the stored recording. Gives the new text.
///
/// # Errors
/// A file that cannot be written, or an `expected.toml` that is not TOML.
pub fn write_blessing(
    library: &Path,
    scene: &Scene,
    text: Option<&str>,
    blessing: &Blessing,
) -> Result<String> {
    let output = Output::open(&library.join(&scene.name), Replace::Named)?;
    let folder = output.folder();
    let (like, derived) = (&blessing.like, &blessing.derived);
    let text = with_profile(text, like, &derived.profile).map_err(|wrong| Error::Profile {
        case: scene.name.clone(),
        message: format!("its expected.toml is not TOML: {wrong}"),
    })?;
    let thinned = scene.every(thinning(scene));
    folder.write(&baseline_file(like), |out| {
        Ok(write_trajectory(&derived.baseline, &thinned, out)?)
    })?;
    folder.write("expected.toml", |out| out.write_all(text.as_bytes()))?;
    output.commit()?;
    Ok(text)
}
