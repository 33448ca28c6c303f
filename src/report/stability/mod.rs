//! What a study of stability leaves in its folder: tables, a heat map, maps, a page, a summary;
//! and what the index of a report tells of it later.

mod findings;
mod page;
#[cfg(feature = "plots")]
mod picture;
mod tables;

pub(super) use findings::headline;
pub use findings::stability_findings;
pub use tables::stability_table;

use super::Folder;
use super::output::write_json;
use crate::error::Result;
use crate::study::stability::{MapKind, StabilityMap, StabilityStudy, StabilitySummary};

/// The heat map of the matrix.
const MATRIX: &str = "stability.png";

/// The table of a map.
fn map_table(kind: MapKind) -> &'static str {
    match kind {
        MapKind::Spring => "springs.csv",
        MapKind::Orbit => "orbits.csv",
    }
}

/// The picture of a map.
fn map_picture(kind: MapKind) -> &'static str {
    match kind {
        MapKind::Spring => "springs.png",
        MapKind::Orbit => "orbits.png",
    }
}

/// Whether a file is one of an earlier study.
fn is_stale(name: &str) -> bool {
    let maps = [MapKind::Spring, MapKind::Orbit];
    let of_map = |kind: &MapKind| [map_table(*kind), map_picture(*kind)].contains(&name);
    maps.iter().any(of_map)
        || [
            "README.md",
            "stability.csv",
            "failures.csv",
            MATRIX,
            "summary.json",
        ]
        .contains(&name)
}

/// Writes `stability.csv`, `failures.csv`, a table for each map, the pictures, the summary and the
/// page; gives the summary.
///
/// # Errors
/// A file that cannot be written, with its name; each file is whole or not there.
pub fn write_stability(
    folder: &Folder,
    study: &StabilityStudy,
    maps: &[StabilityMap],
) -> Result<StabilitySummary> {
    let summary = StabilitySummary::of(study);
    folder.remove(is_stale)?;
    folder.write("stability.csv", |out| tables::write_cells(study, out))?;
    folder.write("failures.csv", |out| tables::write_failures(study, out))?;
    for map in maps {
        folder.write(map_table(map.kind), |out| tables::write_map(map, out))?;
    }
    #[cfg(feature = "plots")]
    {
        let mut pictures = vec![(MATRIX, picture::matrix_png(study, &summary)?)];
        for map in maps {
            pictures.push((map_picture(map.kind), picture::map_png(map)?));
        }
        for (name, png) in pictures {
            folder.write(name, |out| out.write_all(&png))?;
        }
    }
    folder.write("summary.json", |out| write_json(out, &summary))?;
    let page = page::page(study, &summary, maps)?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))?;
    Ok(summary)
}
