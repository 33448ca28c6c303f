//! Everything that one comparison leaves in its folder.

use super::case_page::case_page;
use super::tables::{write_divergence, write_metrics};
use super::{Folder, Studies};
use crate::case::TRUTH;
use crate::engine::EngineSpec;
use crate::error::Result;
use crate::recording::{write_events, write_trajectory};
use crate::study::{SideBySide, Summary, Voice};

/// Engines that a picture shows, in the order in which they were asked for; with a reference
/// that makes three voices, and more would show nothing clearly.
const PICTURED: usize = 2;

/// The pictures of a comparison.
pub(super) const PICTURES: [&str; 4] =
    ["paths.png", "divergence.png", "energy.png", "momentum.png"];

/// The voices of the pictures: the engines first named, then what they are held against.
fn pictured(comparison: &SideBySide) -> Vec<&Voice> {
    let engines = comparison.voices.iter().filter(|voice| voice.takes_steps());
    let engines: Vec<_> = engines.take(PICTURED).collect();
    if engines.is_empty() {
        return comparison.voices.iter().take(PICTURED).collect();
    }
    engines.into_iter().chain(comparison.reference()).collect()
}

/// Where a comparison's page stands.
#[derive(Debug, Clone, Copy)]
pub enum Place<'a> {
    /// In a folder of its own.
    Alone,
    /// In a report, with the index one folder up and these studies beside it.
    InReport(&'a Studies),
}

fn trajectory_file(voice: &str) -> String {
    format!("trajectory-{voice}.csv")
}

fn events_file(voice: &str) -> String {
    format!("events-{voice}.csv")
}

/// Sees before a comparison on these engines that its files may be written.
///
/// # Errors
/// Those of [`Folder::claim`].
pub fn claim_comparison(folder: &Folder, engines: &[EngineSpec]) -> Result<()> {
    let voices = engines.iter().map(|spec| spec.name.as_str());
    let names: Vec<String> = voices
        .chain([TRUTH])
        .flat_map(|voice| [trajectory_file(voice), events_file(voice)])
        .collect();
    let tables = ["metrics.csv", "divergence.csv", "README.md", "summary.json"];
    let names = names.iter().map(String::as_str).chain(tables);
    folder.claim(names.chain(PICTURES))
}

/// Writes tables, pictures, page and summary of a comparison; gives the summary.
///
/// # Errors
/// A file that cannot be written, with its name.
pub fn write_comparison(folder: &Folder, comparison: &SideBySide, place: Place) -> Result<Summary> {
    let scene = &comparison.scene;
    let mut summary = Summary::of(comparison);
    if let Place::InReport(studies) = place {
        summary.tell_limits(studies.limits(scene));
    }
    for voice in &comparison.voices {
        let name = voice.name();
        folder.write(&trajectory_file(name), |out| {
            Ok(write_trajectory(&voice.recording, scene, out)?)
        })?;
        folder.write(&events_file(name), |out| {
            Ok(write_events(&voice.recording.events, scene, out)?)
        })?;
    }
    folder.write("metrics.csv", |out| write_metrics(comparison, out))?;
    folder.write("divergence.csv", |out| write_divergence(comparison, out))?;
    let voices = pictured(comparison);
    #[cfg(feature = "plots")]
    let pictures = super::pictures::pictures(comparison, &voices)?;
    #[cfg(not(feature = "plots"))]
    let pictures: Vec<(&str, Vec<u8>)> = Vec::new();
    for (name, bytes) in &pictures {
        folder.write(name, |out| out.write_all(bytes))?;
    }
    let names: Vec<_> = pictures.iter().map(|(name, _)| *name).collect();
    let shown: Vec<_> = voices.iter().map(|voice| voice.name()).collect();
    let studies = match place {
        Place::Alone => None,
        Place::InReport(studies) => Some(studies.of_case(scene)),
    };
    let page = case_page(&summary, &names, &shown, studies)?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))?;
    folder.write_summary(&summary)?;
    Ok(summary)
}
