//! Compiles a worker with the user's own cargo.

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde::Deserialize;

use super::{Version, Worker};
use crate::error::{Error, Result, harmless};

/// Lines of a failed build that are told: the last ones, where cargo says what was wrong.
const LAST_LINES: usize = 3;

/// A message of cargo; of most of them nothing is of interest.
#[derive(Deserialize)]
struct Message {
    executable: Option<PathBuf>,
}

/// Builds the worker of a version in `target/drift` beside the folder of workers, which all of
/// them share; what is built already is not built again.
///
/// # Errors
/// [`Error::DriftWorker`] if there is no cargo, or with the last lines of a build that failed.
pub fn build(folder: &Path, version: &Version) -> Result<Worker> {
    let name = version.crate_and_version();
    let manifest = version.manifest(folder);
    let failed = |message: String| Error::DriftWorker {
        worker: name.clone(),
        message,
    };
    let target = folder
        .parent()
        .unwrap_or(folder)
        .join("target")
        .join("drift");
    let built = Command::new("cargo")
        .args(["build", "--release", "--locked", "--quiet"])
        .args(["--message-format", "json-render-diagnostics"])
        .arg("--manifest-path")
        .arg(&manifest)
        .arg("--target-dir")
        .arg(&target)
        .stdin(Stdio::null())
        .output()
        .map_err(|wrong| failed(cannot_start(&wrong)))?;
    if !built.status.success() {
        return Err(failed(why(&built, &manifest)));
    }
    let program = executable(&built.stdout);
    let program = program.ok_or_else(|| failed("cargo built no program of it".to_owned()))?;
    Worker::new(&name, &program)
}

fn cannot_start(wrong: &io::Error) -> String {
    match wrong.kind() {
        io::ErrorKind::NotFound => "cargo is not found; workers are compiled on this machine, so \
                                    install Rust, or add cargo to PATH"
            .to_owned(),
        _ => format!("cargo cannot be started: {wrong}"),
    }
}

/// The last lines of a build that failed, in one.
fn why(built: &Output, manifest: &Path) -> String {
    let said = String::from_utf8_lossy(&built.stderr);
    let lines: Vec<&str> = said
        .lines()
        .map(str::trim)
        .filter(|it| !it.is_empty())
        .collect();
    let last = lines[lines.len().saturating_sub(LAST_LINES)..].join("; ");
    format!(
        "cannot be built: {}; the first build needs the network, and `cargo build --release \
         --locked --manifest-path {}` shows all of it",
        harmless(&last),
        manifest.display()
    )
}

/// The program that cargo says it made.
fn executable(messages: &[u8]) -> Option<PathBuf> {
    let lines = messages.split(|byte| *byte == b'\n');
    let told = lines.filter_map(|line| serde_json::from_slice::<Message>(line).ok());
    told.filter_map(|message| message.executable).next_back()
}

#[cfg(test)]
mod tests {
    use super::executable;

    #[test]
    fn the_program_is_the_one_that_cargo_names() {
        let messages = b"{\"reason\":\"compiler-artifact\",\"executable\":null}\n\
            {\"reason\":\"compiler-artifact\",\"executable\":\"/t/a b/rapier\"}\n\
            {\"reason\":\"build-finished\",\"success\":true}\nnot json\n";
        let found = executable(messages).unwrap();
        assert_eq!(found.to_str(), Some("/t/a b/rapier"));
        assert_eq!(executable(b"{\"executable\":null}"), None);
    }
}
