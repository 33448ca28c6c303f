//! What a study of cost leaves in its folder: tables, a picture a scene, a page.

mod page;
#[cfg(feature = "plots")]
mod picture;
mod tables;
mod tuning;

use super::Folder;
use crate::error::Result;
use crate::study::cost::{CostOptions, Machine, SceneCost, Tuning};

/// A study of cost over some scenes.
#[derive(Debug)]
pub struct CostReport {
    /// How it was made.
    pub options: CostOptions,
    /// Where it was made.
    pub machine: Machine,
    /// What was tuned beforehand on other scenes, if anything was.
    pub tuning: Option<Tuning>,
    /// What was found.
    pub scenes: Vec<SceneCost>,
}

/// Whether a file is one of an earlier study.
fn is_stale(name: &str) -> bool {
    let picture = name.strip_suffix(".png").unwrap_or_default();
    picture.starts_with("work-precision-")
        || ["README.md", "cost.csv", "orders.csv", "tuning.csv"].contains(&name)
}

/// Writes `cost.csv`, `orders.csv`, `tuning.csv` if anything was tuned, the pictures and the page.
///
/// # Errors
/// A file that cannot be written, with its name; each file is whole or not there.
pub fn write_cost(folder: &Folder, report: &CostReport) -> Result<()> {
    folder.remove(is_stale)?;
    folder.write("cost.csv", |out| tables::write_points(&report.scenes, out))?;
    folder.write("orders.csv", |out| {
        tables::write_orders(&report.scenes, out)
    })?;
    if let Some(tuning) = &report.tuning {
        folder.write("tuning.csv", |out| tuning::write_trials(tuning, out))?;
    }
    #[cfg(feature = "plots")]
    for scene in &report.scenes {
        let picture = picture::work_precision_png(scene)?;
        let name = format!("work-precision-{}.png", scene.scene.name);
        folder.write(&name, |out| out.write_all(&picture))?;
    }
    let page = page::page(report, cfg!(feature = "plots"))?;
    folder.write("README.md", |out| out.write_all(page.as_bytes()))
}
