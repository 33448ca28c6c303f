//! The studies that `carom report --studies` can make beside the cases, a row each.

use super::{cost, stability};
use crate::engine::EngineSpec;
use crate::error::{Error, Result};
use crate::report::{COST, Folder, STABILITY, STABILITY_FILES, claim_cost};
use crate::scene::Scene;
use crate::study::Timing;
use crate::study::cost::CostOptions;

/// What a study is made of.
pub(super) struct Order<'a> {
    /// The scenes of the report.
    pub scenes: &'a [&'a Scene],
    /// The engines asked for by name; none for those that the study takes by itself.
    pub engines: Option<&'a [EngineSpec]>,
    /// Where the report goes.
    pub report: &'a Folder<'a>,
    /// Whether no progress is shown.
    pub quiet: bool,
}

/// A study that a report can hold: its name is that of its folder.
pub(super) struct Study {
    name: &'static str,
    /// Sees that its files may be written, before anything runs.
    claim: fn(&Folder, &[&Scene]) -> Result<()>,
    make: fn(&Order, &Folder) -> Result<()>,
}

const STUDIES: [Study; 2] = [
    Study {
        name: COST,
        claim: claim_cost,
        make: cost::beside_report,
    },
    Study {
        name: STABILITY,
        claim: |folder, _| folder.claim(STABILITY_FILES),
        make: stability::beside_report,
    },
];

/// Small enough that all cases take about five minutes, and large enough that shots reach steps
/// below the lecture's own, 0.01 s; long orbits and crowds do not, which `carom cost` is for.
pub(super) const COST_OPTIONS: CostOptions = CostOptions {
    timing: Timing {
        seed: 1,
        repetitions: 3,
    },
    budget: 30_000,
    phases: 5,
    runs: 40,
};

/// The studies of these names, each once, beside cases of these scenes.
pub(super) fn asked(names: &[String], scenes: &[&Scene]) -> Result<Vec<&'static Study>> {
    let mut asked: Vec<&Study> = Vec::new();
    for name in names {
        let name = name.trim();
        let study = STUDIES.iter().find(|study| study.name == name);
        let study = study.ok_or_else(|| Error::UnknownStudy {
            name: name.to_owned(),
            known: STUDIES.each_ref().map(|study| study.name).join(", "),
        })?;
        if scenes.iter().any(|scene| scene.name == study.name) {
            return Err(Error::Argument {
                argument: "studies",
                found: name.to_owned(),
                remedy: "a case is called so too, and its folder would be taken; rename it".into(),
            });
        }
        if asked.iter().all(|known| known.name != study.name) {
            asked.push(study);
        }
    }
    Ok(asked)
}

impl Study {
    /// Sees that the study's files may be written into its folder within the report.
    pub fn claim(&self, report: &Folder, scenes: &[&Scene]) -> Result<()> {
        (self.claim)(&report.folder(self.name), scenes)
    }

    /// Makes the study and leaves its files in a folder of its own within the report.
    pub fn make(&self, order: &Order) -> Result<()> {
        (self.make)(order, &order.report.folder(self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Library;

    #[test]
    fn a_study_is_made_once_and_never_in_the_folder_of_a_case() {
        let names = |names: &[&str]| -> Vec<String> {
            names.iter().map(|name| (*name).to_owned()).collect()
        };
        let mut scene = Library::Embedded.case("headon-equal").unwrap().scene;
        let twice = asked(&names(&["cost", " cost"]), &[&scene]).unwrap();
        assert_eq!(twice.len(), 1);
        assert!(asked(&names(&["Cost"]), &[&scene]).is_err());
        scene.name = "cost".to_owned();
        let Err(said) = asked(&names(&["cost"]), &[&scene]) else {
            panic!("the folder of the case would be taken");
        };
        assert!(said.to_string().contains("rename it"), "{said}");
        assert!(asked(&[], &[&scene]).unwrap().is_empty());
    }
}
