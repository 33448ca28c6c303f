//! The house's floors: a room imports only from rooms above it in the list of DESIGN.

mod paths;
mod tokens;

use std::fs;
use std::path::{Path, PathBuf};

use paths::{Import, imports};
use tokens::tokens;

/// The rooms from the ground up.
const ROOMS: [&str; 12] = [
    "error",
    "input",
    "scene",
    "physics",
    "recording",
    "engine",
    "case",
    "compare",
    "study",
    "report",
    "play",
    "cli",
];

/// Files that stand above all rooms.
const ROOF: [&str; 2] = ["lib", "main"];

/// Crates that are named in one folder alone.
const CONFINED: [(&str, &str); 7] = [
    ("rapier3d", "src/engine/rapier/"),
    ("rapier3d_f64", "src/engine/rapier/"),
    ("parry3d", "src/engine/rapier/"),
    ("parry3d_f64", "src/engine/rapier/"),
    ("plotters", "src/report/chart/"),
    ("resvg", "src/report/chart/"),
    ("clap", "src/cli/"),
];

/// Every source file with its text, in order of its path.
pub fn sources() -> Vec<(PathBuf, String)> {
    fn walk(folder: &Path, found: &mut Vec<(PathBuf, String)>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                found.push((path, text));
            }
        }
    }
    let mut found = Vec::new();
    walk(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("src"),
        &mut found,
    );
    found.sort();
    found
}

/// The sources by their path below the project, `/` between folders.
fn files() -> Vec<(String, String)> {
    let below = |path: PathBuf| {
        let below = path.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap();
        below.to_string_lossy().replace('\\', "/")
    };
    let files = sources().into_iter();
    files.map(|(path, text)| (below(path), text)).collect()
}

/// The module that a file is: `src/a/b.rs` and `src/a/b/mod.rs` are a::b.
fn module(file: &str) -> Vec<String> {
    let stem = file.trim_start_matches("src/").trim_end_matches(".rs");
    let mut module: Vec<String> = stem.split('/').map(str::to_owned).collect();
    let last = module.last().map_or("", String::as_str);
    if last == "mod" || module.len() == 1 && ROOF.contains(&last) {
        module.pop();
    }
    module
}

/// What is wrong with the imports of a file, and how many were seen.
fn faults(file: &str, text: &str) -> (usize, Vec<String>) {
    let module = module(file);
    let room = match module.first() {
        None => return (0, Vec::new()),
        Some(room) => room,
    };
    let Some(floor) = ROOMS.iter().position(|name| name == room) else {
        return (0, vec![format!("{file}: `{room}` is no room of the list")]);
    };
    let imports = imports(&tokens(text), &module);
    let fault = |(line, import): &(usize, Import)| {
        let wrong = match import {
            Import::WholeCrate => "imports the whole crate".to_owned(),
            Import::PastTheTree => "brings in source past the module tree".to_owned(),
            Import::Root(name) => match ROOMS.iter().position(|room| room == name) {
                None => format!("imports `{name}`, no room of the list"),
                Some(imported) if imported > floor => {
                    format!("`{room}` imports from `{name}`, a room above it")
                }
                Some(_) => return None,
            },
        };
        Some(format!("{file}:{line}: {wrong}"))
    };
    (imports.len(), imports.iter().filter_map(fault).collect())
}

/// Where a file names a library that belongs in another folder. Any use of the name counts,
/// under whatever other name it goes on.
fn strays(file: &str, text: &str) -> Vec<String> {
    let stray = |token: &tokens::Token| {
        let (library, folder) = CONFINED.iter().find(|(name, _)| *name == token.text)?;
        let line = token.line;
        let is_stray = !file.starts_with(folder);
        is_stray.then(|| format!("{file}:{line}: `{library}` belongs in {folder}"))
    };
    tokens(text).iter().filter_map(stray).collect()
}

#[test]
fn imports_point_down() {
    let mut seen = 0;
    for (file, text) in files() {
        let (count, faults) = faults(&file, &text);
        assert_eq!(faults, [""; 0]);
        seen += count;
    }
    assert!(
        seen > 150,
        "only {seen} imports found: the test no longer reads them"
    );
}

#[test]
fn each_library_stays_in_its_folder() {
    for (file, text) in files() {
        assert_eq!(strays(&file, &text), [""; 0]);
    }
}

/// An arrow that points up, however it is written, is one fault.
#[test]
fn an_arrow_that_points_up_is_seen_however_it_is_written() {
    let table = [
        ("src/scene/x.rs", "use crate::report::Folder;"),
        ("src/scene/x.rs", "use crate::{\n    cli,\n    error,\n};"),
        (
            "src/scene/x.rs",
            "use crate::{error::{A, B}, physics::{c::{D}, E}, error::F};",
        ),
        (
            "src/scene/x.rs",
            "use crate::{scene::{self, y::{z}}, error, cli::{main}};",
        ),
        ("src/scene/x.rs", "use {crate::{error}, crate::cli};"),
        (
            "src/scene/x.rs",
            "use crate :: // why\n  /* not */ cli::main;",
        ),
        ("src/scene/x.rs", "pub(in crate::cli) fn f() {}"),
        (
            "src/scene/x.rs",
            "fn f() { let x = 1; crate::cli::main(x, crate::error::E) }",
        ),
        (
            "src/scene/x.rs",
            "fn f<'a>(x: &'a crate::cli::Args) -> char { '\"' }",
        ),
        ("src/scene/x.rs", "use super::super::cli;"),
        ("src/scene/x.rs", "use super::{super::cli, y};"),
        ("src/scene/x.rs", "use super::{super::{error, cli}, y};"),
        (
            "src/scene/x.rs",
            "mod tests { use super::super::super::cli::main; }",
        ),
        (
            "src/scene/x.rs",
            "mod a { mod b {} use self::super::super::super::cli; }",
        ),
        ("src/scene/mod.rs", "use super::cli;"),
        ("src/scene/mod.rs", "use self::super::cli;"),
        ("src/case.rs", "use super::cli::main;"),
        ("src/case.rs", "use super::*;"),
        ("src/case.rs", "use crate::*;"),
        ("src/case.rs", "use crate as root;"),
        ("src/case.rs", "use crate::{self as root};"),
        ("src/case.rs", "use carom::cli;"),
        ("src/case.rs", "use ::carom::cli;"),
        ("src/case.rs", "extern crate carom;"),
        (
            "src/case.rs",
            "macro_rules! m { () => { $crate::cli::main() } }",
        ),
        ("src/case.rs", "use crate::r#cli;"),
        ("src/case.rs", "#[path = \"cli/x.rs\"] mod x;"),
        ("src/case.rs", "include!(\"cli/x.rs\");"),
        ("src/case.rs", "use crate::gadgets;"),
        ("src/engine/exact/x.rs", "use crate::case::Case;"),
        (
            "src/engine/exact/x.rs",
            "use super::super::super::case::Case;",
        ),
        ("src/gadgets.rs", ""),
        ("src/gadgets/mod.rs", "use crate::error;"),
        ("src/gadgets/x.rs", ""),
    ];
    for (file, text) in table {
        let (_, faults) = faults(file, text);
        assert_eq!(faults.len(), 1, "{file}: {text}: {faults:?}");
    }
}

/// What is allowed, or no import at all, is no fault.
#[test]
fn what_points_down_is_left_alone() {
    let table = [
        (
            "src/report/x.rs",
            "use crate::{error, study::{a::{b}, c}, report::chart};",
            3,
        ),
        (
            "src/report/x.rs",
            "// use crate::cli;\n/* crate::cli */ use crate::error;",
            1,
        ),
        (
            "src/report/x.rs",
            "/// See [`crate::cli`].\nfn f() { g(\"crate::cli\") }",
            0,
        ),
        (
            "src/report/x.rs",
            "const A: &str = r#\"\"crate::cli\"#; const B: char = '\"';",
            0,
        ),
        ("src/report/x.rs", "use super::cli;", 0),
        ("src/report/x.rs", "use super::{self, *};", 0),
        (
            "src/report/x.rs",
            "mod tests { use super::super::cli; use super::*; }",
            0,
        ),
        (
            "src/report/x.rs",
            "fn f(self) { self.cli } pub(crate) fn g() {}",
            0,
        ),
        (
            "src/report/x.rs",
            "pub(super) fn f() -> Vec<crate::error::E> { a::cli::x() }",
            1,
        ),
        ("src/report/chart/x.rs", "use super::super::cli;", 0),
        (
            "src/lib.rs",
            "pub mod cli; use crate::cli::main; use self::cli;",
            0,
        ),
        ("src/main.rs", "fn main() { carom::cli::main() }", 0),
        ("src/play.rs", "use crate::report; use crate::play;", 2),
    ];
    for (file, text, count) in table {
        assert_eq!(faults(file, text), (count, Vec::new()), "{file}: {text}");
    }
}

#[test]
fn a_stray_library_is_seen_under_any_name() {
    let table = [
        ("src/report/x.rs", "use plotters::prelude::*;", 1),
        ("src/report/x.rs", "use plotters as p;", 1),
        ("src/report/x.rs", "use {std::fmt, plotters as p};", 1),
        ("src/report/x.rs", "use ::plotters;", 1),
        ("src/report/x.rs", "extern crate plotters as p;", 1),
        ("src/report/x.rs", "use\n    plotters\n    ::prelude;", 1),
        ("src/report/charts.rs", "use resvg::render;", 1),
        (
            "src/engine/rapier/x.rs",
            "use rapier3d_f64::prelude as p; use clap;",
            1,
        ),
        (
            "src/engine/mod.rs",
            "rapier3d_f64::x(parry3d_f64::y, parry3d::z)",
            3,
        ),
        (
            "src/engine/mod.rs",
            "// rapier3d\n(\"rapier3d\", rapier::VERSION)",
            0,
        ),
        ("src/report/chart/x.rs", "use plotters as p;", 0),
    ];
    for (file, text, count) in table {
        assert_eq!(strays(file, text).len(), count, "{file}: {text}");
    }
}
