//! One run of a user's solver: what it reads is laid out, it is watched, what it wrote is read.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::command::{Placeholder, SolverCommand};
use super::last_words::last_words;
use super::running::Running;
use super::{Limits, tables, trajectory};
use crate::engine::StepGrid;
use crate::error::{Error, Result};
use crate::recording::{Recording, trajectory_bytes, trajectory_room};
use crate::scene::{self, Scene};

/// The first pause between two looks at the solver; each later one is twice as long.
const PAUSE_FIRST: Duration = Duration::from_millis(5);

/// The longest pause.
const PAUSE_MAX: Duration = Duration::from_millis(20);

/// What messages call standard output.
const STDOUT: &str = "standard output";

/// What messages call standard error.
const STDERR: &str = "standard error";

/// Runs a solver on a checked scene and reads its trajectory.
pub(super) fn run(
    command: &SolverCommand,
    limits: Limits,
    voice: &str,
    scene: &Scene,
    grid: StepGrid,
) -> Result<Recording> {
    let unready = |wrong: io::Error| Error::SolverStart {
        program: command.program.clone(),
        message: format!(
            "{wrong}; a solver needs a temporary folder with room, which TMPDIR names"
        ),
    };
    let mut running = Running::open().map_err(unready)?;
    let files = Files::of(running.folder());
    lay_out(command, scene, grid, &files).map_err(|wrong| match wrong {
        Wrong::Scene(wrong) => wrong,
        Wrong::File(wrong) => unready(wrong),
    })?;
    let mut started = prepared(command, grid, &files).map_err(unready)?;
    running
        .start(&mut started)
        .map_err(|wrong| cannot_start(&command.program, &wrong))?;
    let did_wrong = |message: String| {
        let said = last_words(&files.stderr);
        let said = said.map_or_else(String::new, |said| format!("; {STDERR} ends: {said}"));
        Error::Solver {
            scene: scene.name.clone(),
            message: format!("{message}{said}"),
        }
    };
    let has_ended = watch(&mut running, &files, limits, scene);
    let status = running.end();
    has_ended.map_err(did_wrong)?;
    let status = status.map_err(|wrong| cannot_start(&command.program, &wrong))?;
    if let Some(failure) = status.and_then(failure) {
        return Err(did_wrong(failure));
    }
    let (name, path) = if command.asks_for(Placeholder::Out) {
        (Placeholder::Out.text(), &files.out)
    } else {
        (STDOUT, &files.stdout)
    };
    read(voice, scene, name, path).map_err(did_wrong)
}

/// The files of a run, in its folder.
#[derive(Debug)]
struct Files {
    scene: PathBuf,
    bodies: PathBuf,
    effects: PathBuf,
    out: PathBuf,
    stdout: PathBuf,
    stderr: PathBuf,
}

impl Files {
    fn of(folder: &Path) -> Self {
        Self {
            scene: folder.join("scene.toml"),
            bodies: folder.join("bodies.csv"),
            effects: folder.join("effects.csv"),
            out: folder.join("trajectory.csv"),
            stdout: folder.join("stdout"),
            stderr: folder.join("stderr"),
        }
    }
}

/// Why the files could not be laid out.
enum Wrong {
    Scene(Error),
    File(io::Error),
}

/// Writes the files that the command asks for.
fn lay_out(
    command: &SolverCommand,
    scene: &Scene,
    grid: StepGrid,
    files: &Files,
) -> std::result::Result<(), Wrong> {
    let create = |path: &Path| File::create(path).map(BufWriter::new).map_err(Wrong::File);
    let unwritten = |wrong: csv::Error| Wrong::File(wrong.into());
    if command.asks_for(Placeholder::Scene) {
        let text = scene::to_toml(scene).map_err(Wrong::Scene)?;
        let mut out = create(&files.scene)?;
        let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
        written.map_err(Wrong::File)?;
    }
    if command.asks_for(Placeholder::Bodies) {
        tables::write_bodies(scene, create(&files.bodies)?).map_err(unwritten)?;
    }
    if command.asks_for(Placeholder::Effects) {
        tables::write_effects(scene, grid, create(&files.effects)?).map_err(unwritten)?;
    }
    Ok(())
}

/// The process to start. Its output goes into files: nobody has to read them while it runs, and
/// a child that keeps them open keeps nobody waiting.
fn prepared(command: &SolverCommand, grid: StepGrid, files: &Files) -> io::Result<Command> {
    let fill = |placeholder| match placeholder {
        Placeholder::Scene => files.scene.clone().into_os_string(),
        Placeholder::Bodies => files.bodies.clone().into_os_string(),
        Placeholder::Effects => files.effects.clone().into_os_string(),
        Placeholder::Out => files.out.clone().into_os_string(),
        // The shortest that reads back as the same double.
        Placeholder::Dt => format!("{:?}", grid.step).into(),
    };
    let appended = |path: &Path| OpenOptions::new().append(true).create_new(true).open(path);
    let mut prepared = Command::new(&command.program);
    prepared
        .args(command.arguments(fill))
        .stdin(Stdio::null())
        .stdout(appended(&files.stdout)?)
        .stderr(appended(&files.stderr)?);
    Ok(prepared)
}

/// A program that is not there, or is none.
fn cannot_start(program: &str, wrong: &io::Error) -> Error {
    let message = match wrong.kind() {
        io::ErrorKind::NotFound => {
            "not found; give the path of a program that is there, or its name if it is installed"
                .to_owned()
        }
        io::ErrorKind::PermissionDenied => {
            "not executable; allow it with `chmod +x`, or name the program that runs it first, \
             such as python3"
                .to_owned()
        }
        _ => wrong.to_string(),
    };
    let program = program.to_owned();
    Error::SolverStart { program, message }
}

/// Looks at the solver until it has ended, or has taken or written too much.
fn watch(
    running: &mut Running,
    files: &Files,
    limits: Limits,
    scene: &Scene,
) -> std::result::Result<(), String> {
    let allowed = limits.output_bytes.max(trajectory_room(scene));
    let watched = [
        (STDOUT, &files.stdout),
        (STDERR, &files.stderr),
        (Placeholder::Out.text(), &files.out),
    ];
    let start = Instant::now();
    let mut pause = PAUSE_FIRST;
    loop {
        // In this order: what it has written when it has ended is all that it will write.
        let has_ended = running.has_ended().map_err(|wrong| wrong.to_string())?;
        let length = |path: &Path| fs::metadata(path).map_or(0, |found| found.len());
        if let Some((name, _)) = watched.iter().find(|(_, path)| length(path) > allowed) {
            return Err(format!(
                "wrote more than {allowed} bytes to {name}, where the whole trajectory takes \
                 {} at most; write a row a body and sample, and nothing else",
                trajectory_bytes(scene)
            ));
        }
        if has_ended {
            return Ok(());
        }
        let left = limits.time.saturating_sub(start.elapsed());
        if left.is_zero() {
            let limit = limits.time.as_secs_f64();
            return Err(format!("took longer than {limit} s (--limit)"));
        }
        thread::sleep(pause.min(left));
        pause = PAUSE_MAX.min(2 * pause);
    }
}

/// Why a status is not that of success.
fn failure(status: ExitStatus) -> Option<String> {
    if status.success() {
        return None;
    }
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let name = signal_hook::low_level::signal_name(signal).unwrap_or("no name");
        return Some(format!("was killed by signal {signal} ({name})"));
    }
    Some(format!(
        "failed with exit code {}",
        status.code().unwrap_or(-1)
    ))
}

/// Reads the trajectory; `name` is what messages call its file.
fn read(
    voice: &str,
    scene: &Scene,
    name: &str,
    path: &Path,
) -> std::result::Result<Recording, String> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() => {}
        Ok(_) => return Err(format!("left something else than a file at {name}")),
        Err(_) => return Err(format!("ended well, but wrote no file {name}")),
    }
    let file = File::open(path).map_err(|wrong| format!("{name} cannot be read: {wrong}"))?;
    trajectory(voice, scene, file, name).map_err(|wrong| wrong.to_string())
}
