//! What a study of cost against the number of bodies leaves: a table, a picture, a page.

mod findings;
mod page;
#[cfg(feature = "plots")]
mod picture;
mod tables;

pub use findings::bodies_findings;
pub use tables::bodies_table;

use std::io::{self, Write};

use super::Folder;
use crate::error::Result;
use crate::study::bodies::BodiesStudy;

/// Whether a file is one of an earlier study.
fn is_stale(name: &str) -> bool {
    ["README.md", "bodies.csv", "cost-bodies.png"].contains(&name)
}

/// Writes `bodies.csv`, the picture and the page.
///
/// # Errors
/// A file that cannot be written, with its name; each file is whole or not there.
pub fn write_bodies(folder: &Folder, study: &BodiesStudy) -> Result<()> {
    folder.remove(is_stale)?;
    folder.write("bodies.csv", |out| write_points(study, out))?;
    #[cfg(feature = "plots")]
    {
        let picture = picture::cost_bodies_png(study)?;
        folder.write("cost-bodies.png", |out| out.write_all(&picture))?;
    }
    let page = page::page(study, cfg!(feature = "plots"))?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))
}

/// Writes `bodies.csv`: a row for every engine at every size, those over their budget included.
fn write_points(study: &BodiesStudy, out: &mut dyn Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for point in &study.points {
        table.serialize(point)?;
    }
    table.flush()
}
