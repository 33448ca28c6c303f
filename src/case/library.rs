//! Where cases come from, and how one is read.

use std::io::Read;
use std::path::{Path, PathBuf};

use include_dir::{Dir, include_dir};

use super::{Case, Evidence, Expected, OWN_ORIGIN, TRUTH, baseline_file, thinning};
use crate::error::{Error, Result};
use crate::input;
use crate::recording::{
    EVENTS_BYTES_MAX, Recording, Undetermined, check_start, read_events, read_trajectory,
    read_trajectory_start, trajectory_bytes_max,
};
use crate::scene::{self, Scene, TEXT_BYTES_MAX};

static EMBEDDED: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/reference");
static EMBEDDED_HARD: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/hard");

/// More names than this are no hint any more.
const HINTS_MAX: usize = 6;

/// The folder that is looked into when none is named.
pub const REFERENCE: &str = "reference";

/// The folder of the hard cases.
pub const HARD: &str = "hard";

/// Where cases come from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Library {
    /// A folder with a folder a case.
    Folder(PathBuf),
    /// The reference cases compiled in.
    Embedded,
    /// The hard cases compiled in.
    EmbeddedHard,
}

impl Library {
    /// The folder asked for; else `reference/` here if there is one; else the embedded cases.
    #[must_use]
    pub fn choose(folder: Option<&Path>) -> Self {
        match folder {
            Some(folder) => Self::Folder(folder.to_owned()),
            None if Path::new(REFERENCE).is_dir() => Self::Folder(REFERENCE.into()),
            None => Self::Embedded,
        }
    }

    /// The hard cases: those of `hard/` here if there is one; else the embedded ones.
    #[must_use]
    pub fn hard() -> Self {
        if Path::new(HARD).is_dir() {
            Self::Folder(HARD.into())
        } else {
            Self::EmbeddedHard
        }
    }

    /// The names of all cases, sorted.
    ///
    /// # Errors
    /// [`Error::Read`] if the folder cannot be listed.
    pub fn names(&self) -> Result<Vec<String>> {
        let mut names = match self {
            Self::Folder(folder) => {
                is_there(folder)?;
                let unreadable = |source| Error::read(folder, source);
                let mut names = Vec::new();
                for entry in std::fs::read_dir(folder).map_err(unreadable)? {
                    let entry = entry.map_err(unreadable)?;
                    let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
                    if !is_hidden && entry.path().join("scene.toml").is_file() {
                        names.push(entry.file_name().to_string_lossy().into_owned());
                    }
                }
                names
            }
            Self::Embedded => names_in(&EMBEDDED),
            Self::EmbeddedHard => names_in(&EMBEDDED_HARD),
        };
        names.sort();
        Ok(names)
    }

    /// Reads a case with its evidence.
    ///
    /// # Errors
    /// [`Error::UnknownCase`] with the nearest name, or what is wrong with one of its files.
    pub fn case(&self, name: &str) -> Result<Case> {
        let Some(scene) = self.file(name, "scene.toml")? else {
            return Err(self.unknown(name));
        };
        let file = scene.path.clone();
        let scene = scene::parse(&scene.text()?, &file)?;
        if scene.name != name {
            let scene = scene.name;
            return Err(Error::CaseName { file, scene });
        }
        let origin = self
            .file(name, "ORIGIN.md")?
            .map(|file| file.text())
            .transpose()?;
        let is_own = |text: &String| text.starts_with(OWN_ORIGIN);
        let evidence = if origin.as_ref().is_some_and(is_own) {
            Evidence::Own
        } else {
            Evidence::Independent
        };
        let truth = self.truth(name, &scene, evidence)?;
        let expected = self.expected(name, &scene)?;
        Ok(Case {
            scene,
            expected,
            evidence: truth.is_some().then_some(evidence),
            truth,
            origin: origin.map(|text| without_heading(&text).to_owned()),
        })
    }

    fn truth(&self, name: &str, scene: &Scene, evidence: Evidence) -> Result<Option<Recording>> {
        let Some(table) = self.file(name, "truth.csv")? else {
            return Ok(None);
        };
        let (rows, path) = (table.table(trajectory_bytes_max(scene))?, &*table.path);
        let mut recording = match evidence {
            Evidence::Independent => read_trajectory(TRUTH, scene, rows, path)?,
            Evidence::Own => up_to_its_end(read_trajectory_start(TRUTH, scene, rows, path)?, scene),
        };
        if let Some(events) = self.file(name, "events.csv")? {
            recording.events = read_events(scene, events.table(EVENTS_BYTES_MAX)?, &events.path)?;
        }
        check_start(scene, &recording, path)?;
        Ok(Some(recording))
    }

    fn expected(&self, name: &str, scene: &Scene) -> Result<Option<Expected>> {
        self.file(name, "expected.toml")?
            .map(|file| Expected::parse(&file.text()?, &file.path, scene))
            .transpose()
    }

    /// The stored recording of an engine on a case's scene, on every n-th sample (see
    /// [`thinning`]); it may end before the scene does.
    ///
    /// # Errors
    /// Something wrong with its file.
    pub fn baseline(&self, scene: &Scene, engine: &str) -> Result<Option<Recording>> {
        let Some(table) = self.file(&scene.name, &baseline_file(engine))? else {
            return Ok(None);
        };
        let thinned = scene.every(thinning(scene));
        let rows = table.table(trajectory_bytes_max(&thinned))?;
        read_trajectory_start(engine, &thinned, rows, &table.path).map(Some)
    }

    /// The text of a case's `expected.toml`, as it stands.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn expected_text(&self, name: &str) -> Result<Option<String>> {
        self.file(name, "expected.toml")?
            .map(|file| file.text())
            .transpose()
    }

    /// The text of a case's scene file, as it stands.
    ///
    /// # Errors
    /// As [`case`](Self::case).
    pub fn scene_text(&self, name: &str) -> Result<String> {
        self.file(name, "scene.toml")?
            .ok_or_else(|| self.unknown(name))?
            .text()
    }

    fn file(&self, case: &str, file: &str) -> Result<Option<CaseFile>> {
        let plain = !case.is_empty() && !case.contains(['/', '\\']) && !case.starts_with('.');
        if !plain {
            return Ok(None);
        }
        match self {
            Self::Folder(folder) => {
                let path = folder.join(case).join(file);
                match path.try_exists() {
                    Ok(true) => Ok(Some(CaseFile {
                        path: path.display().to_string(),
                        place: Place::OnDisk(path),
                    })),
                    Ok(false) => is_there(folder).map(|()| None),
                    Err(wrong) => {
                        is_there(folder)?;
                        Err(Error::read(&path, wrong))
                    }
                }
            }
            Self::Embedded => Ok(file_in(&EMBEDDED, case, file)),
            Self::EmbeddedHard => Ok(file_in(&EMBEDDED_HARD, case, file)),
        }
    }

    fn unknown(&self, name: &str) -> Error {
        let names = self.names().unwrap_or_default();
        let near: Vec<_> = names
            .iter()
            .filter(|known| known.contains(name) || name.contains(known.as_str()))
            .map(String::as_str)
            .collect();
        let hint = if near.is_empty() || near.len() > HINTS_MAX {
            String::new()
        } else {
            format!("; did you mean {}?", near.join(" or "))
        };
        Error::UnknownCase {
            name: name.to_owned(),
            hint,
        }
    }
}

/// A folder that is not there holds no case, but that is not what is wrong.
fn is_there(folder: &Path) -> Result<()> {
    let what = match std::fs::metadata(folder) {
        Ok(found) if found.is_dir() => return Ok(()),
        Ok(_) => "it is no folder; name a folder of cases",
        Err(wrong) if wrong.kind() == std::io::ErrorKind::NotFound => {
            "there is no such folder; name a folder of cases"
        }
        Err(wrong) => return Err(Error::read(folder, wrong)),
    };
    let source = std::io::Error::new(std::io::ErrorKind::NotFound, what);
    Err(Error::read(folder, source))
}

/// The names of the cases compiled in.
fn names_in(embedded: &Dir<'_>) -> Vec<String> {
    let is_case = |dir: &&Dir<'_>| dir.get_file(dir.path().join("scene.toml")).is_some();
    let cases = embedded.dirs().filter(is_case);
    cases.map(|dir| dir.path().display().to_string()).collect()
}

/// A file of a case compiled in.
fn file_in(embedded: &'static Dir<'static>, case: &str, file: &str) -> Option<CaseFile> {
    let found = embedded.get_file(format!("{case}/{file}"))?;
    Some(CaseFile {
        path: format!("{case}/{file} (compiled in)"),
        place: Place::CompiledIn(found.contents()),
    })
}

/// Marks that a truth of carom's own ends where the model has no single answer any more.
fn up_to_its_end(mut recording: Recording, scene: &Scene) -> Recording {
    let count = recording.sample_count();
    recording.undetermined = (count <= scene.sample_count()).then(|| Undetermined {
        time: scene.sample_time(count),
        bodies: Vec::new(),
        spread: None,
    });
    recording
}

/// A text without a Markdown heading in its first line.
fn without_heading(text: &str) -> &str {
    match text.split_once('\n') {
        Some((first, rest)) if first.starts_with('#') => rest.trim(),
        Some(_) | None => text.trim(),
    }
}

struct CaseFile {
    path: String,
    place: Place,
}

enum Place {
    OnDisk(PathBuf),
    CompiledIn(&'static [u8]),
}

impl CaseFile {
    fn text(&self) -> Result<String> {
        match &self.place {
            Place::OnDisk(path) => input::text(path, TEXT_BYTES_MAX),
            Place::CompiledIn(bytes) => String::from_utf8(bytes.to_vec())
                .map_err(|wrong| Error::not_utf8(&self.path, &wrong)),
        }
    }

    /// The rows of a table of at most so many bytes.
    fn table(&self, bytes_max: u64) -> Result<Box<dyn Read>> {
        match &self.place {
            Place::OnDisk(path) => Ok(Box::new(input::open(path, bytes_max)?)),
            Place::CompiledIn(bytes) => Ok(Box::new(*bytes)),
        }
    }
}
