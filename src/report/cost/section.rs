//! What the page of a case tells of a study of cost.

use serde::Serialize;

use super::findings::of_scene;
use super::price_table::PriceTable;
use super::{prices_picture, work_picture};
use crate::scene::Scene;
use crate::study::cost::CostSummary;

/// The results on one case, as its page shows them.
#[derive(Debug, Serialize)]
pub(crate) struct CostSection {
    scene: String,
    /// Whether the scene has been changed since; then nothing of it is shown.
    changed: bool,
    findings: Vec<String>,
    /// File names of the pictures that are there, in the study's folder.
    pictures: Vec<String>,
    tags: PriceTable,
}

impl CostSection {
    /// The results on a scene, if it has been measured; `is_there` knows the study's files.
    pub(crate) fn of(
        study: &CostSummary,
        scene: &Scene,
        is_there: impl Fn(&str) -> bool,
    ) -> Option<Self> {
        let found = study.scene(&scene.name)?;
        let mut pictures = vec![work_picture(&found.scene), prices_picture(&found.scene)];
        pictures.retain(|name| is_there(name));
        Some(Self {
            scene: found.scene.clone(),
            changed: !found.is_of(scene),
            findings: of_scene(found),
            pictures,
            tags: PriceTable::of(found),
        })
    }
}
