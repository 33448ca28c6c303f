//! Holds solvers against truth, against their own stored recordings, and against Rapier's.

mod bless;
mod derive;
mod judge;
mod measure;
mod replay;
mod subject;

pub use bless::{Blessing, Change, bless};
pub use derive::{Derived, derive};
pub use judge::{Against, Comparison, Held, Row};
pub use replay::{Replay, replay};
pub use subject::{Own, Program, Subject, TrajectoryFile};

use rayon::prelude::*;
use serde::Serialize;

use crate::case::{Case, Library, Profile, baseline_file, thinning};
use crate::engine::{DEFAULT_DT, Simulation, StepGrid, engine};
use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::scene::Scene;
use judge::{Trial, judge};

/// The engine whose stored recordings stand for Rapier.
pub const RAPIER: &str = "rapier";

/// A solver to be checked, and the engine whose profile it is judged by.
pub struct Candidate<'a> {
    /// What computes.
    pub subject: &'a dyn Subject,
    /// The name of the profile in `expected.toml`.
    pub like: String,
}

impl<'a> Candidate<'a> {
    /// Judged by the profile of its own name, as an engine is unless another is named.
    #[must_use]
    pub fn own(subject: &'a dyn Subject) -> Self {
        Self::like(subject, subject.name())
    }

    /// Judged by the profile of that name.
    #[must_use]
    pub fn like(subject: &'a dyn Subject, like: &str) -> Self {
        Self {
            subject,
            like: like.to_owned(),
        }
    }
}

/// One case on one solver, checked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseCheck {
    /// The case.
    pub case: String,
    /// What it tests, in a word or two.
    pub topic: Option<String>,
    /// The solver.
    pub solver: String,
    /// Whose profile it was judged by.
    pub like: String,
    /// The largest step, s.
    pub dt: f64,
    /// The digest of its recording; none where there is no recording.
    pub digest: Option<String>,
    /// Whether that is the digest of the profile: the same bits.
    pub same_bits: bool,
    /// What kept the solver from computing the case, or its recording from the end.
    pub fault: Option<String>,
    /// With truth, baseline and Rapier, as far as there are any.
    pub comparisons: Vec<Comparison>,
}

impl CaseCheck {
    /// Whether nothing failed.
    #[must_use]
    pub fn holds(&self) -> bool {
        let failed = |comparison: &Comparison| comparison.held == Held::Fails;
        self.fault.is_none() && !self.comparisons.iter().any(failed)
    }
}

/// Every case on every solver, checked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CheckReport {
    /// Whether nothing failed.
    pub holds: bool,
    /// Solver by solver, case by case.
    pub checks: Vec<CaseCheck>,
}

/// Checks every candidate on every case, several at a time; the order of the report is that of
/// the candidates and cases, whatever ran first.
///
/// # Errors
/// A case that cannot be read, or of which no profile is stored. A solver that fails is a result.
pub fn check(
    cases: &[Case],
    library: &Library,
    candidates: &[Candidate],
    watch: &(dyn Fn(&str) + Sync),
) -> Result<CheckReport> {
    let mut jobs: Vec<(usize, &Candidate, &Case)> = candidates
        .iter()
        .flat_map(|candidate| cases.iter().map(move |case| (candidate, case)))
        .enumerate()
        .map(|(place, (candidate, case))| (place, candidate, case))
        .collect();
    // The longest first, so that none is left over for the end.
    jobs.sort_by_key(|(place, _, case)| (std::cmp::Reverse(weight(&case.scene)), *place));
    let mut checks = jobs
        .into_iter()
        .par_bridge()
        .map(|(place, candidate, case)| {
            let checked = check_case(case, library, candidate)?;
            watch(&checked.case);
            Ok((place, checked))
        })
        .collect::<Result<Vec<_>>>()?;
    checks.sort_by_key(|(place, _)| *place);
    let checks: Vec<CaseCheck> = checks.into_iter().map(|(_, check)| check).collect();
    Ok(CheckReport {
        holds: checks.iter().all(CaseCheck::holds),
        checks,
    })
}

/// Rough work of a scene: pairs and samples.
fn weight(scene: &Scene) -> usize {
    scene.sample_count() * scene.bodies.len() * scene.bodies.len()
}

/// What is known of an engine on a case.
///
/// # Errors
/// [`Error::Profile`] if nothing is.
pub fn profile<'a>(case: &'a Case, like: &str) -> Result<&'a Profile> {
    let profiles = case.expected.as_ref().map(|expected| &expected.profile);
    let profile = profiles.and_then(|profiles| profiles.get(like));
    profile.ok_or_else(|| Error::Profile {
        case: case.scene.name.clone(),
        message: format!(
            "nothing is stored of `{like}`; `carom check --bless` stores what a solver does"
        ),
    })
}

/// The stored recording of Rapier on a case, if it is what this profile was held against.
fn rapier(library: &Library, scene: &Scene, like: &str) -> Result<Option<Recording>> {
    if like == RAPIER {
        return Ok(None);
    }
    library.baseline(scene, RAPIER)
}

fn check_case(case: &Case, library: &Library, candidate: &Candidate) -> Result<CaseCheck> {
    let (scene, subject, like) = (&case.scene, candidate.subject, &candidate.like);
    let profile = profile(case, like)?;
    let mut check = CaseCheck {
        case: scene.name.clone(),
        topic: case.expected.as_ref().and_then(|it| it.topic.clone()),
        solver: subject.name().to_owned(),
        like: like.clone(),
        dt: profile.dt,
        digest: None,
        same_bits: false,
        fault: None,
        comparisons: Vec::new(),
    };
    let run = match subject.record(scene, profile.dt) {
        Ok(run) => run,
        Err(start @ (Error::SolverStart { .. } | Error::Read { .. })) => return Err(start),
        Err(fault) => {
            check.fault = Some(match fault {
                Error::Solver { message, .. } => message,
                other => other.to_string(),
            });
            return Ok(check);
        }
    };
    check.digest = Some(run.digest());
    check.same_bits = check.digest.as_ref() == Some(&profile.digest);
    if !run.outcome.is_finished() || run.sample_count() <= scene.sample_count() {
        check.fault = Some(run.outcome.describe(scene).to_string());
    }
    let baseline = library.baseline(scene, like)?;
    if check.same_bits
        && baseline
            .as_ref()
            .is_some_and(|stored| !is_part_of(scene, stored, &run))
    {
        return Err(Error::Profile {
            case: scene.name.clone(),
            message: format!(
                "{} is not the recording whose digest stands in expected.toml; restore it, or \
                 store it anew with `carom check --bless`",
                baseline_file(like)
            ),
        });
    }
    let rapier = rapier(library, scene, like)?;
    let is_engine = engine(like).is_ok();
    check.comparisons = judge(&Trial {
        case,
        profile,
        baseline: baseline.as_ref(),
        rapier: rapier.as_ref(),
        run: &run,
        is_own: !is_engine || subject.name() == like,
    });
    Ok(check)
}

/// Whether a stored recording has the bits of a run, as far as it goes.
fn is_part_of(scene: &Scene, stored: &Recording, run: &Recording) -> bool {
    let every = thinning(scene);
    let run = run
        .every(every)
        .up_to(stored.sample_count(), &scene.every(every));
    stored.digest() == run.digest()
}

/// The whole suite on a simulation of your own, for your own `cargo test`: every reference case
/// that is compiled in, judged as the engine `like`.
///
/// ```
/// use carom::engine::ImpulseSimulation;
/// use carom::study::check::suite;
///
/// let report = suite("mine", "lecture", |scene, grid| ImpulseSimulation::new(scene, grid))?;
/// assert!(report.holds);
/// # Ok::<(), carom::error::Error>(())
/// ```
///
/// # Errors
/// No such profile. A solver that fails is a result: see [`CheckReport::holds`].
pub fn suite<S: Simulation>(
    name: &str,
    like: &str,
    make: impl Fn(&Scene, StepGrid) -> S + Sync,
) -> Result<CheckReport> {
    let library = Library::Embedded;
    let names = library.names()?;
    let cases = names.iter().map(|name| library.case(name));
    let cases = cases.collect::<Result<Vec<_>>>()?;
    let subject = Own::new(name, make);
    check(
        &cases,
        &library,
        &[Candidate::like(&subject, like)],
        &|_| {},
    )
}

/// The digest of every case on every solver, without judging.
///
/// # Errors
/// As [`Subject::record`].
pub fn digests(cases: &[Case], candidates: &[Candidate]) -> Result<Vec<(String, String, String)>> {
    let jobs: Vec<(&Candidate, &Case)> = candidates
        .iter()
        .flat_map(|candidate| cases.iter().map(move |case| (candidate, case)))
        .collect();
    let digest = |(candidate, case): (&Candidate, &Case)| {
        let run = candidate.subject.record(&case.scene, DEFAULT_DT)?;
        let subject = candidate.subject.name().to_owned();
        Ok((run.digest(), case.scene.name.clone(), subject))
    };
    jobs.into_par_iter().map(digest).collect()
}
