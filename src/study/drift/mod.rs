//! The drift sentinel: published versions of Rapier side by side on the same measures.
//!
//! Each version stands in a small worker of its own, a crate below `drift/` that is no part of
//! carom's package and speaks the protocol of a user's own solver. So a version is compiled only
//! when it is asked for, and carom treats it as a guest: with a limit of time and of bytes.
//! `workers` reads which versions there are and what is known of them, `build` compiles them,
//! `sweep` measures the restitution of two balls, and cases are judged as `carom check` judges
//! the engine `rapier`.

mod build;
mod sweep;
mod worker;
mod workers;

pub use build::build;
pub use sweep::{ROUNDINGS, Restitution, effective_restitution, phases, restitution, two_balls};
pub use worker::Worker;
pub use workers::{Version, Workers};

use std::path::Path;

use serde::Serialize;

use super::Made;
use super::check::{Against, Candidate, CaseCheck, Held, RAPIER, check};
use crate::case::{Case, Library};
use crate::error::Result;

/// Restitutions of the sweep.
const RESTITUTIONS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Speeds of approach of the sweep, m/s.
const SPEEDS: [f64; 2] = [0.5, 4.0];

/// The cases: equal masses, half the speed back, a cushion, and all of the billiards table.
const CASES: [&str; 4] = ["headon-equal", "inelastic-e05", "cushion-one", "shot-2-61"];

/// What is measured of a version.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measure {
    /// The effective restitution of two balls of restitution e (0 to 1) that meet head-on.
    Restitution {
        /// The restitution of the scene.
        restitution: f64,
        /// The speed of approach, m/s.
        speed: f64,
    },
    /// The verdict on a reference case.
    Case(&'static str),
}

impl Measure {
    /// All of them, in the order of reports.
    pub fn all() -> impl Iterator<Item = Self> {
        let sweep = SPEEDS.into_iter().flat_map(|speed| {
            RESTITUTIONS
                .into_iter()
                .map(move |restitution| Self::Restitution { restitution, speed })
        });
        sweep.chain(CASES.into_iter().map(Self::Case))
    }

    /// The name in `workers.toml` and in reports.
    ///
    /// ```
    /// use carom::study::drift::Measure;
    /// let measure = Measure::Restitution { restitution: 0.25, speed: 4.0 };
    /// assert_eq!(measure.name(), "e 0.25 at 4 m/s");
    /// assert_eq!(Measure::Case("shot-2-61").name(), "shot-2-61");
    /// ```
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Restitution { restitution, speed } => format!("e {restitution} at {speed} m/s"),
            Self::Case(name) => name.to_owned(),
        }
    }
}

/// What a measure came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Every bound holds.
    Within,
    /// The bounds against truth hold, but the recording left the stored one of carom's own Rapier
    /// by more than rounding: other numbers, not wrong ones.
    Moved,
    /// A bound against truth, or of the restitution, does not hold; or there is no recording.
    Red,
}

impl Verdict {
    /// The word in reports.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Within => "within",
            Self::Moved => "moved",
            Self::Red => "red",
        }
    }
}

/// What was found by a measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Found {
    /// Of two balls.
    Restitution(Restitution),
    /// Of a case, as `carom check --like rapier` judges it.
    Case(CaseCheck),
    /// What kept the worker from a recording.
    Nothing(String),
}

impl Found {
    /// Whether its bounds hold.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match self {
            Self::Restitution(restitution) if restitution.holds() => Verdict::Within,
            Self::Restitution(_) | Self::Nothing(_) => Verdict::Red,
            Self::Case(check) => case_verdict(check),
        }
    }
}

fn case_verdict(check: &CaseCheck) -> Verdict {
    let fails = |against: Against| {
        let mut of = check.comparisons.iter();
        of.any(|it| it.against == against && it.held == Held::Fails)
    };
    if check.fault.is_some() || fails(Against::Truth) {
        Verdict::Red
    } else if check.holds() {
        Verdict::Within
    } else {
        Verdict::Moved
    }
}

/// One measure of one version.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// The name of the measure.
    pub measure: String,
    /// What it came to.
    pub verdict: Verdict,
    /// What it was known to come to.
    pub expected: Verdict,
    /// What was found.
    pub found: Found,
}

impl Measured {
    /// Whether it came to what is known.
    #[must_use]
    pub fn is_expected(&self) -> bool {
        self.verdict == self.expected
    }
}

/// All measures of one version.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VersionDrift {
    /// The version of Rapier.
    pub version: String,
    /// Why what is expected of it is expected.
    pub why: String,
    /// In the order of [`Measure::all`].
    pub measures: Vec<Measured>,
}

impl VersionDrift {
    /// How many measures came to that.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        let of = |it: &&Measured| it.verdict == verdict;
        self.measures.iter().filter(of).count()
    }
}

/// Every version on every measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriftStudy {
    /// When, where and with what; its version of Rapier is the one that cases are stored of.
    #[serde(flatten)]
    pub made: Made,
    /// Version by version, in the order of `workers.toml`.
    pub versions: Vec<VersionDrift>,
}

impl DriftStudy {
    /// Whether every measure came to what is known.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.surprises().next().is_none()
    }

    /// What came to something else, with its version.
    pub fn surprises(&self) -> impl Iterator<Item = (&str, &Measured)> {
        let all = self.versions.iter().flat_map(|of| {
            let version = of.version.as_str();
            of.measures.iter().map(move |measured| (version, measured))
        });
        all.filter(|(_, measured)| !measured.is_expected())
    }
}

/// Builds the workers and takes every measure. `watch` is told what is done next, and how many of
/// the two steps a version are done.
///
/// # Errors
/// A worker that cannot be built or started; a case that cannot be read, or of which nothing is
/// stored of `rapier`. A worker that fails on a scene is a result.
pub fn drift(
    folder: &Path,
    versions: &[&Version],
    library: &Library,
    watch: &dyn Fn(&str, usize),
) -> Result<DriftStudy> {
    let made = Made::now();
    let cases = CASES.iter().map(|name| library.case(name));
    let cases = cases.collect::<Result<Vec<_>>>()?;
    let mut found = Vec::new();
    // All builds first: whoever has no compiler is told before anything is measured.
    let mut workers = Vec::new();
    for (done, version) in versions.iter().enumerate() {
        watch(&format!("building {}", version.crate_and_version()), done);
        workers.push(build(folder, version)?);
    }
    for (done, (version, worker)) in versions.iter().zip(&workers).enumerate() {
        let done = versions.len() + done;
        watch(&format!("measuring {}", version.crate_and_version()), done);
        found.push(measured(version, worker, &cases, library)?);
    }
    Ok(DriftStudy {
        made,
        versions: found,
    })
}

/// Takes every measure of a worker.
fn measured(
    version: &Version,
    worker: &Worker,
    cases: &[Case],
    library: &Library,
) -> Result<VersionDrift> {
    let candidate = Candidate::like(worker, RAPIER);
    let checks = check(cases, library, &[candidate], &|_| {})?.checks;
    let measure = |measure: Measure| {
        let name = measure.name();
        let found = match measure {
            Measure::Restitution { restitution, speed } => {
                sweep::found(worker, restitution, speed)?
            }
            Measure::Case(case) => {
                let of = checks.iter().find(|check| check.case == case);
                of.map_or_else(
                    || Found::Nothing("not run".into()),
                    |it| Found::Case(it.clone()),
                )
            }
        };
        Ok(Measured {
            verdict: found.verdict(),
            expected: version.expected(&name),
            measure: name,
            found,
        })
    };
    Ok(VersionDrift {
        version: version.version.clone(),
        why: version.why.clone(),
        measures: Measure::all().map(measure).collect::<Result<Vec<_>>>()?,
    })
}
