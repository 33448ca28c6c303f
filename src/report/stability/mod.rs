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
use crate::error::Result;
use crate::study::stability::{MapKind, StabilityMap, StabilityStudy, StabilitySummary};

/// The heat map of the matrix.
const MATRIX: &str = "stability.png";

/// The table of a map.
const fn map_table(kind: MapKind) -> &'static str {
    match kind {
        MapKind::Spring => "springs.csv",
        MapKind::Orbit => "orbits.csv",
    }
}

/// The picture of a map.
const fn map_picture(kind: MapKind) -> &'static str {
    match kind {
        MapKind::Spring => "springs.png",
        MapKind::Orbit => "orbits.png",
    }
}

/// The files of a study of stability, with all its maps.
pub const STABILITY_FILES: [&str; 9] = [
    "stability.csv",
    "failures.csv",
    map_table(MapKind::Spring),
    map_table(MapKind::Orbit),
    MATRIX,
    map_picture(MapKind::Spring),
    map_picture(MapKind::Orbit),
    "README.md",
    "summary.json",
];

/// Writes `stability.csv`, `failures.csv`, a table for each map, the pictures, the summary and the
/// page; gives the summary.
///
/// # Errors
/// A file that cannot be written, with its name.
pub fn write_stability(
    folder: &Folder,
    study: &StabilityStudy,
    maps: &[StabilityMap],
) -> Result<StabilitySummary> {
    let summary = StabilitySummary::of(study);
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
    let page = page::page(study, &summary, maps)?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))?;
    folder.write_summary(&summary)?;
    Ok(summary)
}
