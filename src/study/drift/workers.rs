//! `drift/workers.toml`: which versions of Rapier there are workers of, and what is known of them.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::{Measure, Verdict};
use crate::error::{Error, Result, quoted};
use crate::input;
use crate::scene::fault::fault;
use crate::scene::{Fault, FieldPath, TEXT_BYTES_MAX, parse_checked};

/// The file in the folder of workers.
const FILE: &str = "workers.toml";

/// A version of Rapier that has a worker.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Version {
    /// As crates.io has it; the folder of the worker is `rapier-<version>`.
    pub version: String,
    /// Why what is expected is expected.
    pub why: String,
    /// Measures known to be red.
    #[serde(default)]
    pub red: Vec<String>,
    /// Measures known to be moved.
    #[serde(default)]
    pub moved: Vec<String>,
}

impl Version {
    /// What a measure of that name is known to come to.
    #[must_use]
    pub fn expected(&self, measure: &str) -> Verdict {
        let holds = |names: &[String]| names.iter().any(|name| name == measure);
        if holds(&self.red) {
            Verdict::Red
        } else if holds(&self.moved) {
            Verdict::Moved
        } else {
            Verdict::Within
        }
    }

    /// The crate with its version, for people.
    #[must_use]
    pub fn crate_and_version(&self) -> String {
        format!("rapier3d {}", self.version)
    }

    /// The manifest of the worker, below the folder of workers.
    #[must_use]
    pub fn manifest(&self, folder: &Path) -> PathBuf {
        folder
            .join(format!("rapier-{}", self.version))
            .join("Cargo.toml")
    }
}

/// All versions, in the order of the file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Workers {
    /// Version by version.
    #[serde(rename = "worker")]
    pub versions: Vec<Version>,
}

impl Workers {
    /// Reads `workers.toml` in a folder, and sees that there is a worker of every version.
    ///
    /// # Errors
    /// [`Error::Argument`] if the folder holds no such file, [`Error::Read`] or
    /// [`Error::NotUtf8`] if it is no text; otherwise as [`parse`](Self::parse).
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join(FILE);
        if !path.is_file() {
            return Err(Error::Argument {
                argument: "workers",
                found: folder.display().to_string(),
                remedy: format!(
                    "there is no {FILE}; give the folder `drift` of a checkout of carom"
                ),
            });
        }
        let text = input::text(&path, TEXT_BYTES_MAX)?;
        Self::parse(&text, &path.display().to_string(), folder)
    }

    /// Parses the text of `workers.toml`; `file` is its name in messages, `folder` holds the
    /// workers.
    ///
    /// # Errors
    /// [`Error::DataFile`] with line, column and remedy: no TOML, an unknown key, a version twice
    /// or without a worker, a measure that there is not.
    pub fn parse(text: &str, file: &str, folder: &Path) -> Result<Self> {
        parse_checked(text, file, |workers: &Self| workers.check(folder))
    }

    fn check(&self, folder: &Path) -> std::result::Result<(), Fault> {
        if self.versions.is_empty() {
            let path = FieldPath::default().key("worker");
            return Err(fault(path, "empty", "give a version at least"));
        }
        for (index, version) in self.versions.iter().enumerate() {
            let path = FieldPath::default().key("worker").index(index);
            let at = path.clone().key("version");
            let shown = format!("`{}`", quoted(&version.version));
            let is_plain = |c: char| c.is_ascii_alphanumeric() || ".-+".contains(c);
            if version.version.is_empty() || !version.version.chars().all(is_plain) {
                return Err(fault(at, shown, "give a version such as 0.36.1"));
            }
            let mut earlier = self.versions[..index].iter();
            if earlier.any(|other| other.version == version.version) {
                return Err(fault(
                    at,
                    format!("{shown} again"),
                    "name each version once",
                ));
            }
            if !version.manifest(folder).is_file() {
                let remedy = format!(
                    "there is no worker {}; copy that of the nearest version and change the \
                     number in it, or leave this version out",
                    version.manifest(folder).display()
                );
                return Err(fault(at, shown, remedy));
            }
            version.check(&path)?;
        }
        Ok(())
    }

    /// The versions of these names, in the order of the file; without names, all.
    ///
    /// # Errors
    /// [`Error::Argument`] for a version that there is no worker of.
    pub fn chosen(&self, names: &[String]) -> Result<Vec<&Version>> {
        let names: Vec<&str> = names.iter().map(|name| name.trim()).collect();
        let is_known = |name: &&str| self.versions.iter().any(|of| of.version == *name);
        if let Some(unknown) = names.iter().find(|name| !is_known(name)) {
            let known = self.versions.iter().map(|of| of.version.as_str());
            return Err(Error::Argument {
                argument: "versions",
                found: (*unknown).to_owned(),
                remedy: format!("there are {}", known.collect::<Vec<_>>().join(", ")),
            });
        }
        let is_asked = |of: &&Version| names.is_empty() || names.contains(&of.version.as_str());
        Ok(self.versions.iter().filter(is_asked).collect())
    }
}

impl Version {
    fn check(&self, path: &FieldPath) -> std::result::Result<(), Fault> {
        let known: Vec<String> = Measure::all().map(Measure::name).collect();
        for (key, names) in [("red", &self.red), ("moved", &self.moved)] {
            for (index, name) in names.iter().enumerate() {
                let at = path.clone().key(key).index(index);
                if !known.contains(name) {
                    let remedy =
                        format!("there is no such measure; there are: {}", known.join(", "));
                    return Err(fault(at, format!("`{}`", quoted(name)), remedy));
                }
                let of_sweep = !super::CASES.contains(&name.as_str());
                if key == "moved" && (of_sweep || self.red.contains(name)) {
                    let remedy = "only a case moves, and one that is red is not in this list too";
                    return Err(fault(at, format!("`{}`", quoted(name)), remedy));
                }
            }
        }
        Ok(())
    }
}
