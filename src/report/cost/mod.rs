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

use std::collections::BTreeSet;

use super::Folder;
use crate::error::Result;
use crate::scene::Scene;
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

/// The pictures of a study that are there.
pub(super) fn cost_pictures(folder: &Folder, study: &CostSummary) -> BTreeSet<String> {
    let names = study.scenes.iter().map(|found| &found.scene);
    names
        .flat_map(|scene| [work_picture(scene), prices_picture(scene)])
        .filter(|name| folder.current(name).is_file())
        .collect()
}

/// The tables of a study; the last one only of a study that tunes.
const TABLES: [&str; 7] = [
    "cost.csv",
    "work.csv",
    "orders.csv",
    "phases.csv",
    "limits.csv",
    "push-out.csv",
    "tuning.csv",
];

/// Sees before a study of these scenes that its files may be written, those of an unfinished one
/// too.
///
/// # Errors
/// Those of [`Folder::claim`].
pub fn claim_cost(folder: &Folder, scenes: &[&Scene]) -> Result<()> {
    let pictures = scenes.iter().map(|scene| scene.name.as_str());
    let pictures: Vec<String> = pictures
        .flat_map(|name| [work_picture(name), prices_picture(name)])
        .collect();
    let names = TABLES.into_iter().chain(["README.md", "summary.json"]);
    let names = names.chain(pictures.iter().map(String::as_str));
    folder.claim(names.clone())?;
    folder.unfinished().claim(names)
}

/// A study of cost in the making: what it has found.
#[derive(Debug)]
pub struct CostReport {
    summary: CostSummary,
    /// What was tuned beforehand on other scenes, if anything was.
    tuning: Option<Tuning>,
    costs: Vec<SceneCost>,
    parts: Vec<ScenePart>,
    /// Pictures by their file names.
    pictures: Vec<(String, Vec<u8>)>,
}

impl CostReport {
    /// A study with nothing found yet.
    #[must_use]
    pub fn begin(options: CostOptions, tuning: Option<Tuning>) -> Self {
        Self {
            summary: CostSummary::begin(options),
            tuning,
            costs: Vec::new(),
            parts: Vec::new(),
            pictures: Vec::new(),
        }
    }

    /// Adds what was found on a scene.
    ///
    /// # Errors
    /// A picture that cannot be drawn.
    pub fn add(&mut self, cost: SceneCost) -> Result<()> {
        let scene = SceneCostSummary::of(&cost, self.seed())?;
        #[cfg(feature = "plots")]
        {
            let name = &scene.scene;
            let work = picture::work_precision_png(&cost, &scene)?;
            let prices = prices_picture::prices_png(&scene)?;
            self.pictures.push((work_picture(name), work));
            self.pictures.push((prices_picture(name), prices));
        }
        let options = &self.summary.options;
        self.parts.push(ScenePart::of(&cost, &scene, options));
        self.summary.scenes.push(scene);
        self.costs.push(cost);
        Ok(())
    }

    /// Seed of the intervals.
    fn seed(&self) -> u64 {
        self.summary.options.timing.seed
    }

    /// Writes what was found so far.
    ///
    /// # Errors
    /// A file that cannot be written, with its name.
    pub fn write(&self, folder: &Folder) -> Result<()> {
        for (name, png) in &self.pictures {
            folder.write(name, |out| out.write_all(png))?;
        }
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
        folder.write_summary(&self.summary)
    }
}
