//! What a study of cost leaves in its folder: tables, a picture a scene, a page.

mod effort;
mod page;
mod phase_tables;
#[cfg(feature = "plots")]
mod picture;
mod push_out;
mod tables;

use super::Folder;
use crate::error::Result;
use crate::study::cost::{CostOptions, Machine, SceneCost};

/// A study of cost over some scenes.
#[derive(Debug)]
pub struct CostReport {
    /// How it was made.
    pub options: CostOptions,
    /// Where it was made.
    pub machine: Machine,
    /// What was found.
    pub scenes: Vec<SceneCost>,
}

/// Whether a file is one of an earlier study.
fn is_stale(name: &str) -> bool {
    let picture = name.strip_suffix(".png").unwrap_or_default();
    picture.starts_with("work-precision-")
        || [
            "README.md",
            "cost.csv",
            "work.csv",
            "orders.csv",
            "phases.csv",
            "limits.csv",
            "push-out.csv",
        ]
        .contains(&name)
}

/// Writes `cost.csv`, `work.csv`, `orders.csv`, `phases.csv`, `limits.csv`, `push-out.csv`, the pictures and
/// the page.
///
/// # Errors
/// A file that cannot be written, with its name; each file is whole or not there.
pub fn write_cost(folder: &Folder, report: &CostReport) -> Result<()> {
    folder.remove(is_stale)?;
    folder.write("cost.csv", |out| tables::write_points(&report.scenes, out))?;
    folder.write("work.csv", |out| tables::write_work(&report.scenes, out))?;
    folder.write("orders.csv", |out| {
        tables::write_orders(&report.scenes, out)
    })?;
    folder.write("phases.csv", |out| {
        phase_tables::write_phases(&report.scenes, out)
    })?;
    folder.write("limits.csv", |out| {
        phase_tables::write_limits(&report.scenes, report.options.timing.seed, out)
    })?;
    folder.write("push-out.csv", |out| {
        push_out::write_push_out(&report.scenes, out)
    })?;
    #[cfg(feature = "plots")]
    for scene in &report.scenes {
        let picture = picture::work_precision_png(scene)?;
        let name = format!("work-precision-{}.png", scene.scene.name);
        folder.write(&name, |out| out.write_all(&picture))?;
    }
    let page = page::page(report, cfg!(feature = "plots"))?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))
}
