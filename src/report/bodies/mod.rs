//! What a study of cost against the number of bodies leaves: a table, a picture, a page.

mod findings;
mod page;
#[cfg(feature = "plots")]
mod picture;
mod tables;

pub use findings::bodies_findings;
pub use tables::bodies_table;

use std::io::{self, Write};

use serde::Serialize;

use super::Folder;
use crate::error::Result;
use crate::study::bodies::{BodiesPoint, BodiesStudy};

/// The files of a study of cost against the number of bodies.
pub const BODIES_FILES: [&str; 4] = ["bodies.csv", "cost-bodies.png", "README.md", "summary.json"];

/// The summary, for programs.
#[derive(Debug, Serialize)]
struct BodiesSummary<'a> {
    build: &'a str,
    points: &'a [BodiesPoint],
}

/// Writes `bodies.csv`, the picture, the page and the summary.
///
/// # Errors
/// A file that cannot be written, with its name.
pub fn write_bodies(folder: &Folder, study: &BodiesStudy) -> Result<()> {
    folder.write("bodies.csv", |out| write_points(study, out))?;
    #[cfg(feature = "plots")]
    {
        let picture = picture::cost_bodies_png(study)?;
        folder.write("cost-bodies.png", |out| out.write_all(&picture))?;
    }
    let page = page::page(study, cfg!(feature = "plots"))?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))?;
    folder.write_summary(&BodiesSummary {
        build: &study.build,
        points: &study.points,
    })
}

/// Writes `bodies.csv`: a row for every engine at every size, those over their budget included.
fn write_points(study: &BodiesStudy, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for point in &study.points {
        table.serialize(point)?;
    }
    table.flush()
}
