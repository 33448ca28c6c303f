//! What would change in what is stored of a solver, before it does.

use serde::Serialize;

use super::derive::{Derived, derive};
use super::{Candidate, rapier};
use crate::case::{Case, Library, Profile};
use crate::error::Result;

/// Two derivations whose numbers are this near each other, relative, are the same.
const SAME: f64 = 1e-9;

/// One change of what is stored.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// What, and from what to what.
    pub what: String,
    /// Whether less would be noticed than before.
    pub widens: bool,
}

/// A case on a solver derived anew, and what changes with it.
#[derive(Debug, Clone)]
pub struct Blessing {
    /// The case.
    pub case: String,
    /// The profile.
    pub like: String,
    /// What was derived.
    pub derived: Derived,
    /// What differs from what is stored; empty if nothing does.
    pub changes: Vec<Change>,
}

impl Blessing {
    /// Whether a tolerance would be wider than it is.
    #[must_use]
    pub fn widens(&self) -> bool {
        self.changes.iter().any(|change| change.widens)
    }
}

/// Derives a solver's profile on a case anew and compares it with what is stored.
///
/// # Errors
/// As [`derive()`].
pub fn bless(case: &Case, library: &Library, candidate: &Candidate, dt: f64) -> Result<Blessing> {
    let like = &candidate.like;
    let rapier = rapier(library, &case.scene, like)?;
    let derived = derive(case, candidate.subject, dt, rapier.as_ref())?;
    let stored = case.expected.as_ref();
    let stored = stored.and_then(|expected| expected.profile.get(like));
    let changes = match stored {
        Some(stored) => changes(stored, &derived.profile),
        None => vec![Change {
            what: "new".to_owned(),
            widens: false,
        }],
    };
    Ok(Blessing {
        case: case.scene.name.clone(),
        like: like.clone(),
        derived,
        changes,
    })
}

fn changes(old: &Profile, new: &Profile) -> Vec<Change> {
    let mut changes = Vec::new();
    let mut note = |what: String, widens: bool| changes.push(Change { what, widens });
    if old.digest != new.digest {
        note("the recording itself, in its bits".to_owned(), false);
    }
    if old.dt != new.dt {
        note(format!("dt {} -> {} s", old.dt, new.dt), new.dt > old.dt);
    }
    for ((against, old), (_, new)) in old.comparisons().into_iter().zip(new.comparisons()) {
        let (old, new) = match (old, new) {
            (Some(old), Some(new)) => (old, new),
            (None, None) => continue,
            (None, Some(_)) => {
                note(format!("{against}: new"), false);
                continue;
            }
            (Some(_), None) => {
                note(format!("{against}: no longer compared"), true);
                continue;
            }
        };
        if is_other(old.until, new.until) {
            let what = format!("{against}: until {} -> {} s", old.until, new.until);
            note(what, new.until < old.until);
        }
        for (metric, known) in old.all() {
            let name = metric.name();
            let Some(found) = new.of(metric) else {
                note(format!("{against}: {name} no longer measured"), true);
                continue;
            };
            if is_other(known.tolerance, found.tolerance) {
                let what = format!(
                    "{against}: {name} tolerance {:.3e} -> {:.3e}",
                    known.tolerance, found.tolerance
                );
                note(what, found.tolerance > known.tolerance);
            }
            if is_other(known.value, found.value) {
                let what = format!(
                    "{against}: {name} value {:.3e} -> {:.3e}",
                    known.value, found.value
                );
                note(what, false);
            }
        }
        for (metric, _) in new.all().filter(|(metric, _)| old.of(*metric).is_none()) {
            note(format!("{against}: {} new", metric.name()), false);
        }
    }
    if old.made != new.made && !changes.is_empty() {
        let what = format!("made with {} -> {}", old.made, new.made);
        changes.push(Change {
            what,
            widens: false,
        });
    }
    changes
}

fn is_other(old: f64, new: f64) -> bool {
    (old - new).abs() > SAME * old.abs().max(new.abs())
}
