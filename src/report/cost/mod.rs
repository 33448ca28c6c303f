//! What a study of cost leaves in its folder: tables, two pictures a scene, a page, a summary;
//! and what a report tells of it later.

#[cfg(feature = "plots")]
mod colors;
mod effort;
mod findings;
mod page;
mod phase_tables;
#[cfg(feature = "plots")]
mod picture;
mod price_table;
#[cfg(feature = "plots")]
mod prices_picture;
mod push_out;
mod section;
mod tables;
mod tuning;

pub(super) use findings::headline;
pub(super) use section::CostSection;

use super::Folder;
use super::output::write_json;
use crate::error::Result;
use crate::study::cost::{CostOptions, CostSummary, SceneCost, SceneCostSummary, Tuning};
use page::ScenePart;

/// The name of a scene's picture of price over error.
fn work_picture(scene: &str) -> String {
    format!("work-precision-{scene}.png")
}

/// The name of a scene's picture of the price tag.
fn prices_picture(scene: &str) -> String {
    format!("prices-{scene}.png")
}

/// Whether a file is one of an earlier study.
fn is_stale(name: &str) -> bool {
    let picture = name.strip_suffix(".png").unwrap_or_default();
    ["work-precision-", "prices-"]
        .iter()
        .any(|kind| picture.starts_with(kind))
        || [
            "README.md",
            "cost.csv",
            "work.csv",
            "orders.csv",
            "phases.csv",
            "limits.csv",
            "push-out.csv",
            "tuning.csv",
            "summary.json",
        ]
        .contains(&name)
}

/// A study of cost in the making: what it has found, and the folder that tells of it.
#[derive(Debug)]
pub struct CostReport {
    folder: Folder,
    summary: CostSummary,
    /// What was tuned beforehand on other scenes, if anything was.
    tuning: Option<Tuning>,
    costs: Vec<SceneCost>,
    parts: Vec<ScenePart>,
}

impl CostReport {
    /// A study with nothing found yet; the folder is left alone until there is.
    #[must_use]
    pub fn begin(folder: Folder, options: CostOptions, tuning: Option<Tuning>) -> Self {
        Self {
            folder,
            summary: CostSummary::begin(options),
            tuning,
            costs: Vec::new(),
            parts: Vec::new(),
        }
    }

    /// Adds what was found on a scene and writes the whole again, so that a study that is
    /// interrupted leaves what it has.
    ///
    /// # Errors
    /// A file that cannot be written, with its name; each file is whole or not there.
    pub fn add(&mut self, cost: SceneCost) -> Result<()> {
        if self.costs.is_empty() {
            self.folder.remove(is_stale)?;
        }
        let scene = SceneCostSummary::of(&cost, self.seed())?;
        #[cfg(feature = "plots")]
        {
            let name = &scene.scene;
            let work = picture::work_precision_png(&cost, &scene)?;
            let prices = prices_picture::prices_png(&scene)?;
            for (name, png) in [(work_picture(name), work), (prices_picture(name), prices)] {
                self.folder.write(&name, |out| out.write_all(&png))?;
            }
        }
        let options = &self.summary.options;
        self.parts.push(ScenePart::of(&cost, &scene, options));
        self.summary.scenes.push(scene);
        self.costs.push(cost);
        self.write()
    }

    /// Seed of the intervals.
    fn seed(&self) -> u64 {
        self.summary.options.timing.seed
    }

    fn write(&self) -> Result<()> {
        let folder = &self.folder;
        folder.write("cost.csv", |out| tables::write_points(&self.costs, out))?;
        folder.write("work.csv", |out| tables::write_work(&self.costs, out))?;
        folder.write("orders.csv", |out| tables::write_orders(&self.costs, out))?;
        folder.write("phases.csv", |out| {
            phase_tables::write_phases(&self.costs, out)
        })?;
        folder.write("limits.csv", |out| {
            phase_tables::write_limits(&self.costs, self.seed(), out)
        })?;
        folder.write("push-out.csv", |out| {
            push_out::write_push_out(&self.costs, out)
        })?;
        let mut tuned = None;
        if let Some(tuning) = &self.tuning {
            folder.write("tuning.csv", |out| tuning::write_trials(tuning, out))?;
            tuned = Some(tuning::section(tuning, &self.summary)?);
        }
        let page = page::page(&self.summary, &self.parts, tuned)?;
        folder.write("README.md", |out| out.write_all(page.as_bytes()))?;
        folder.write("summary.json", |out| write_json(out, &self.summary))
    }
}
