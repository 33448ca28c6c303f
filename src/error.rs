//! The one error type of carom.
//!
//! An error means that carom could not run; it is one line that names the place and the
//! remedy. A simulation that blows up is no error but a result: see
//! [`Outcome`](crate::recording::Outcome).

mod shown;

use std::path::{Path, PathBuf};

use thiserror::Error;

pub(crate) use shown::is_invisible;
pub use shown::{LINE_MAX, QUOTED_MAX, code, harmless, number, one_line, quoted};

/// Shorthand for results of carom.
pub type Result<T> = std::result::Result<T, Error>;

/// Everything that can keep carom from running.
#[derive(Debug, Error)]
pub enum Error {
    /// A file of data, a scene or what must hold on it, says something that makes no sense.
    #[error("{file}:{line}:{column}: {message}")]
    DataFile {
        /// The file.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// Column in characters, counted from 1.
        column: usize,
        /// What was found, and what would be right.
        message: String,
    },
    /// A scene built by code is not a scene.
    #[error("scene `{}`: {message}", quoted(.scene))]
    Scene {
        /// Name of the scene.
        scene: String,
        /// The field, what was found, and what would be right.
        message: String,
    },
    /// A scene cannot be written as a file.
    #[error("scene `{scene}` cannot be written as TOML: {source}")]
    SceneWrite {
        /// Name of the scene.
        scene: String,
        /// What the writer said.
        source: toml::ser::Error,
    },
    /// A file is not text.
    #[error("{file}: not UTF-8 from byte {byte} on; save the file as UTF-8 text")]
    NotUtf8 {
        /// The file.
        file: String,
        /// Offset of the first wrong byte.
        byte: usize,
    },
    /// A file or folder could not be read.
    #[error("{path}: cannot be read: {source}")]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file or folder could not be written.
    #[error(
        "{path}: cannot be written: {source}; what stood there before is unchanged, choose another place with --out or make room"
    )]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Standard output cannot be written.
    #[error(
        "standard output cannot be written: {source}; what the command was to write into files is there"
    )]
    Stdout {
        /// What the system said.
        source: std::io::Error,
    },
    /// A table (CSV) does not hold what it should.
    #[error("{file}, line {line}: {message}")]
    Table {
        /// The file.
        file: String,
        /// Line, counted from 1; the header is line 1.
        line: u64,
        /// What was found, and what would be right.
        message: String,
    },
    /// Points of another build that cannot stand beside those measured now.
    #[error(
        "{path}: has {what} {}; join files of other builds, measured with the same --dt, \
         --filling, --open and --seed",
        quoted(.found)
    )]
    Join {
        /// The file.
        path: PathBuf,
        /// What is in the way.
        what: &'static str,
        /// What the file says.
        found: String,
    },
    /// No engine of that name.
    #[error("no engine is called `{}`; there are: {known}", quoted(.name))]
    UnknownEngine {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// An engine that this build leaves out.
    #[error(
        "engine `{name}` is not in this build; build carom with the feature `{feature}` (it is on by default)"
    )]
    EngineNotBuilt {
        /// The engine.
        name: String,
        /// The cargo feature that brings it.
        feature: &'static str,
    },
    /// A scene that an engine cannot compute.
    #[error("{engine} cannot compute this scene: {what}; {remedy}")]
    EngineCannot {
        /// The engine.
        engine: &'static str,
        /// What it cannot do, or what is wrong for it.
        what: String,
        /// What would be right.
        remedy: String,
    },
    /// A user's solver that cannot be started at all: carom could not run.
    #[error("solver `{}` cannot be started: {message}", quoted(.program))]
    SolverStart {
        /// The program.
        program: String,
        /// What the system said, and what would be right.
        message: String,
    },
    /// What a user's solver did wrong on one scene: a failed check.
    #[error("solver on `{scene}`: {message}")]
    Solver {
        /// Name of the scene.
        scene: String,
        /// What it did.
        message: String,
    },
    /// A worker of the drift sentinel that cannot be built: carom could not run.
    #[error("worker of {worker}: {message}")]
    DriftWorker {
        /// The crate and its version.
        worker: String,
        /// What was wrong, and what would be right.
        message: String,
    },
    /// The same engine twice.
    #[error("engine `{name}` is asked for twice; name each engine once")]
    EngineTwice {
        /// The engine.
        name: String,
    },
    /// No study of that name.
    #[error("no study is called `{}`; there are: {known}", quoted(.name))]
    UnknownStudy {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// What a study has left cannot be read back.
    #[error("{path}: {message}; left out, `carom report --studies {study}` makes it anew")]
    StoredStudy {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
        /// The study.
        study: &'static str,
    },
    /// No scene file and no case of that name.
    #[error(
        "`{}` is neither a scene file nor a case; `carom scenes list` shows the cases, with --hard the hard ones{hint}",
        quoted(.name)
    )]
    UnknownCase {
        /// The name asked for.
        name: String,
        /// The nearest names, as a suggestion, or nothing.
        hint: String,
    },
    /// A case whose scene has another name than its folder.
    #[error("{file}: the scene is called `{}`; a case's scene has the name of its folder", quoted(.scene))]
    CaseName {
        /// The scene file.
        file: String,
        /// The name in it.
        scene: String,
    },
    /// What a solver is known to do on a case is missing, or cannot be derived.
    #[error("case `{case}`: {message}")]
    Profile {
        /// The case.
        case: String,
        /// What is wrong, and what would be right.
        message: String,
    },
    /// A time step that cannot be taken.
    #[error("time step {} s: {message}", number(*.dt))]
    Step {
        /// The step asked for.
        dt: f64,
        /// What is wrong, and what would be right.
        message: String,
    },
    /// A report of nothing.
    #[error("there is no case to report on: the folder holds no <case>/scene.toml")]
    NoCases,
    /// The handler of Ctrl-C could not be set.
    #[error("Ctrl-C cannot be handled: {message}")]
    Interrupt {
        /// What the system said.
        message: String,
    },
    /// A file would be lost.
    #[error("{path}: exists already; choose another name, or say --force to replace it")]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// A file that carom must not replace.
    #[error("{path}: {reason}; nothing was written, {remedy}")]
    Foreign {
        /// The file or folder.
        path: PathBuf,
        /// What it is.
        reason: &'static str,
        /// What would be right.
        remedy: &'static str,
    },
    /// Another run writes into the folder.
    #[error(
        "{path}: another carom is writing there; wait until it has ended, or choose another folder with --out"
    )]
    InUse {
        /// The folder.
        path: PathBuf,
    },
    /// The system refused to put a complete result in place.
    #[error(
        "{path}: cannot be put in place: {source}; the result is in {stage}; allow it and run again into the same folder, or remove that folder to give the result up"
    )]
    Commit {
        /// The file that could not be renamed or removed.
        path: PathBuf,
        /// Where the result is.
        stage: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A number that an argument does not allow.
    #[error("--{argument} {}: {remedy}", quoted(.found))]
    Argument {
        /// Name of the argument, without dashes.
        argument: &'static str,
        /// What was given.
        found: String,
        /// What would be right.
        remedy: String,
    },
    /// An option that would have no effect where it stands.
    #[error("--{option} does nothing {place}; {remedy}")]
    Idle {
        /// Name of the option, without dashes.
        option: &'static str,
        /// Beside which others it stands, or which are missing.
        place: String,
        /// What would be right.
        remedy: String,
    },
    /// Words on the command line that carom does not understand.
    #[error("{message}")]
    Usage {
        /// What is wrong, and what would be right.
        message: String,
    },
    /// A page could not be filled in: a fault of carom's own templates.
    #[error("page template: {0}")]
    Template(#[from] minijinja::Error),
    /// A summary could not be written as JSON.
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// A picture could not be drawn.
    #[error("picture {name}: {message}")]
    Picture {
        /// The file that it would have been.
        name: &'static str,
        /// What was wrong.
        message: String,
    },
}

impl Error {
    /// An unreadable file or folder.
    #[must_use]
    pub fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Read {
            path: path.to_owned(),
            source,
        }
    }

    /// A file whose bytes are no text.
    #[must_use]
    pub fn not_utf8(file: &str, wrong: &std::string::FromUtf8Error) -> Self {
        Self::NotUtf8 {
            file: file.to_owned(),
            byte: wrong.utf8_error().valid_up_to(),
        }
    }

    /// Something that stands in the way of a result, whatever options are given.
    #[must_use]
    pub fn foreign(path: &Path, reason: &'static str) -> Self {
        Self::Foreign {
            path: path.to_owned(),
            reason,
            remedy: "choose another folder with --out, or move it away",
        }
    }

    /// An unwritable file or folder.
    #[must_use]
    pub fn write(path: &Path, source: std::io::Error) -> Self {
        Self::Write {
            path: path.to_owned(),
            source,
        }
    }
}
