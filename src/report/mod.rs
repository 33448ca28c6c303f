//! Results in, bytes out: tables, pictures, pages. One manager owns the files.

mod bodies;
mod case_page;
#[cfg(feature = "plots")]
pub mod chart;
mod check;
mod cost;
#[cfg(feature = "drift")]
mod drift;
mod effects_page;
mod files;
mod format;
mod index_page;
mod limits;
mod output;
mod overhead;
#[cfg(feature = "plots")]
mod pictures;
mod stability;
mod studies;
mod tables;
mod template;

pub use bodies::{BODIES_FILES, bodies_findings, bodies_table, write_bodies};
pub use case_page::findings;
pub use check::{blessing_text, check_junit, check_text, replay_text, write_blessing};
pub use cost::{CostReport, claim_cost};
#[cfg(feature = "drift")]
pub use drift::{DRIFT_FILES, drift_findings, drift_table, write_drift};
pub use effects_page::{EFFECTS_FILES, effects_findings, effects_table, write_effects};
pub use files::{Folder, Output, Replace, remove_unfinished, write_file};
pub use format::{engineering, percent};
pub use index_page::{INDEX_FILES, index_page, write_index};
pub use output::{Place, claim_comparison, write_comparison};
pub use stability::{STABILITY_FILES, stability_findings, stability_table, write_stability};
pub use studies::{COST, STABILITY, Studies};
