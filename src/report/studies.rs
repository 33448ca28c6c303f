//! The studies beside a report, each in a folder of its own: read back as they stand there, so
//! that a later report still tells of them, with their date.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::Folder;
use super::cost::{CostSection, cost_pictures, headline};
use super::stability;
use crate::error::{Error, Result};
use crate::input::{self, STORED_BYTES_MAX};
use crate::scene::Scene;
use crate::study::Made;
use crate::study::cost::{CostSummary, EngineLimit};
use crate::study::stability::StabilitySummary;

/// The folder of the study of cost.
pub const COST: &str = "cost";
/// The folder of the study of stability.
pub const STABILITY: &str = "stability";

/// What the studies beside a report have found; nothing of those that were never made.
#[derive(Debug, Default)]
pub struct Studies {
    /// The pictures of the study of cost that are there.
    cost_pictures: BTreeSet<String>,
    cost: Option<CostSummary>,
    stability: Option<StabilitySummary>,
}

/// What the index tells of a study.
#[derive(Debug, Serialize)]
pub(super) struct StudyNote {
    title: &'static str,
    folder: &'static str,
    finding: String,
    origin: Origin,
}

/// When and with what a study was made.
#[derive(Debug, Serialize)]
pub(super) struct Origin {
    date: String,
    /// That other versions were measured than those of this report, if so.
    remark: Option<String>,
    optimised: bool,
}

/// What the page of a case tells of the studies that have measured it.
#[derive(Debug, Serialize)]
pub(super) struct CaseStudies {
    cost: Option<CostSection>,
    cost_origin: Option<Origin>,
}

impl Studies {
    /// Reads what studies have left in the folder of a report; what is damaged is left out, with
    /// a complaint.
    #[must_use]
    pub fn read(report: &Folder) -> (Self, Vec<Error>) {
        let mut complaints = Vec::new();
        let cost = kept(stored(report, COST), &mut complaints);
        let stability = kept(stored(report, STABILITY), &mut complaints);
        let studies = Self {
            cost_pictures: cost.as_ref().map_or_else(BTreeSet::new, |study| {
                cost_pictures(&report.folder(COST), study)
            }),
            cost,
            stability,
        };
        (studies, complaints)
    }

    /// A line for each study that was made.
    pub(super) fn notes(&self) -> Vec<StudyNote> {
        let cost = self.cost.iter().map(|study| StudyNote {
            title: "What accuracy costs in time",
            folder: COST,
            finding: headline(study),
            origin: Origin::of(&study.made),
        });
        let stability = self.stability.iter().map(|study| StudyNote {
            title: "Which engine survives what, at which step",
            folder: STABILITY,
            finding: stability::headline(study),
            origin: Origin::of(&study.made),
        });
        cost.chain(stability).collect()
    }

    /// What is left of each engine's error on a case as the step goes to 0; nothing where that was
    /// not measured, or on another scene of that name.
    pub(super) fn limits(&self, scene: &Scene) -> &[EngineLimit] {
        let found = self
            .cost
            .as_ref()
            .and_then(|study| study.scene(&scene.name));
        let found = found.filter(|found| found.is_of(scene));
        found.map_or(&[], |found| &found.limits)
    }

    /// What they have found on a case.
    pub(super) fn of_case(&self, scene: &Scene) -> CaseStudies {
        let study = self.cost.as_ref();
        CaseStudies {
            cost: study.and_then(|study| {
                CostSection::of(study, scene, |name| self.cost_pictures.contains(name))
            }),
            cost_origin: study.map(|study| Origin::of(&study.made)),
        }
    }
}

impl Origin {
    fn of(study: &Made) -> Self {
        let now: BTreeMap<String, String> = crate::engine::versions()
            .into_iter()
            .map(|(name, version)| (name.to_owned(), version.to_owned()))
            .collect();
        let listed = |versions: &BTreeMap<String, String>| {
            let all = versions
                .iter()
                .map(|(name, version)| format!("{name} {version}"));
            all.collect::<Vec<_>>().join(", ")
        };
        let remark = (study.versions != now).then(|| {
            format!(
                "with {}, while this report is of {}",
                listed(&study.versions),
                listed(&now)
            )
        });
        Self {
            date: study.date.clone(),
            remark,
            optimised: study.optimised,
        }
    }
}

/// What was read, or nothing and a complaint.
fn kept<T>(read: Result<Option<T>>, complaints: &mut Vec<Error>) -> Option<T> {
    read.unwrap_or_else(|wrong| {
        complaints.push(wrong);
        None
    })
}

/// The summary that a study has left; none where no study was made, or none that found anything.
fn stored<T: DeserializeOwned>(report: &Folder, study: &'static str) -> Result<Option<T>> {
    let folder = report.folder(study);
    let [page, figures] = ["README.md", "summary.json"].map(|name| folder.current(name));
    let damaged = |path: PathBuf, message: String| Error::StoredStudy {
        path,
        message,
        study,
    };
    match (page.is_file(), figures.is_file()) {
        (false, false) => Ok(None),
        (false, true) => Err(damaged(page, "is missing".to_owned())),
        (true, false) => Err(damaged(figures, "is missing".to_owned())),
        (true, true) => {
            let bytes = input::bytes(&figures, STORED_BYTES_MAX)?;
            let read = serde_json::from_slice(&bytes);
            read.map_err(|wrong| damaged(figures, format!("not what a study leaves: {wrong}")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Output, Replace};
    use crate::study::cost::EngineFamily;
    use crate::study::cost::testing::{study, summary};

    fn output(scratch: &tempfile::TempDir) -> Output {
        Output::open(scratch.path(), Replace::All).unwrap()
    }

    fn leave(folder: &Folder, summary: &CostSummary) {
        let own = folder.folder(COST);
        own.write("README.md", |out| out.write_all(b"page"))
            .unwrap();
        let text = serde_json::to_vec(summary).unwrap();
        own.write("summary.json", |out| out.write_all(&text))
            .unwrap();
    }

    #[test]
    fn a_stored_study_is_told_with_its_date_and_its_versions_if_they_differ() {
        let scratch = tempfile::tempdir().unwrap();
        let output = output(&scratch);
        let folder = output.folder();
        let mut made = summary(&[("lecture", EngineFamily::Impulse, &[0.5])]);
        made.made.date = "2001-02-03".to_owned();
        leave(&folder, &made);
        let (studies, complaints) = Studies::read(&folder);
        assert!(complaints.is_empty());
        let [note] = &studies.notes()[..] else {
            panic!("one study");
        };
        assert_eq!(note.origin.date, "2001-02-03");
        assert_eq!(note.origin.remark, None);
        made.made
            .versions
            .insert("carom".to_owned(), "0.0.1".to_owned());
        leave(&folder, &made);
        let note = &Studies::read(&folder).0.notes()[0];
        let remark = note.origin.remark.as_deref().unwrap();
        assert!(remark.starts_with("with carom 0.0.1"), "{remark}");
        let mine = concat!("carom ", env!("CARGO_PKG_VERSION"));
        assert!(remark.contains(mine), "{remark}");
    }

    #[test]
    fn a_case_finds_its_own_results_unless_the_scene_has_changed() {
        let scratch = tempfile::tempdir().unwrap();
        let output = output(&scratch);
        let folder = output.folder();
        leave(
            &folder,
            &summary(&[("lecture", EngineFamily::Impulse, &[0.5])]),
        );
        let (studies, _) = Studies::read(&folder);
        let changed = |scene: &Scene| {
            let section = serde_json::to_value(studies.of_case(scene)).unwrap();
            section["cost"]["changed"].as_bool()
        };
        let mut scene = study(&[]).scene;
        assert_eq!(changed(&scene), Some(false));
        scene.bodies[0].radius = 2.0;
        assert_eq!(changed(&scene), Some(true));
        scene.name = "another".to_owned();
        assert_eq!(changed(&scene), None);
    }

    #[test]
    fn what_is_damaged_is_a_complaint_and_what_is_absent_is_none() {
        let scratch = tempfile::tempdir().unwrap();
        let output = output(&scratch);
        let folder = output.folder();
        let complaint = || {
            let (studies, complaints) = Studies::read(&folder);
            assert!(studies.notes().is_empty());
            complaints
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
        };
        assert_eq!(complaint(), [""; 0]);
        let own = folder.folder(COST);
        assert_eq!(complaint(), [""; 0], "an empty folder is no study");
        own.write("README.md", |out| out.write_all(b"page"))
            .unwrap();
        assert!(complaint()[0].contains("is missing"), "{:?}", complaint());
        for bytes in [&b"{"[..], b"{}", b"\xff\xfe", b"[1, 2]"] {
            own.write("summary.json", |out| out.write_all(bytes))
                .unwrap();
            let [said] = &complaint()[..] else {
                panic!("one complaint");
            };
            assert!(said.contains("--studies cost"), "{said}");
            assert!(!said.contains('\n'), "{said}");
        }
    }
}
