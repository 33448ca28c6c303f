//! The house's floors: a room imports only from rooms above it in the list of DESIGN.

use std::fs;
use std::path::{Path, PathBuf};

/// The rooms from the ground up.
const ROOMS: [&str; 10] = [
    "error",
    "scene",
    "physics",
    "recording",
    "engine",
    "case",
    "compare",
    "study",
    "report",
    "cli",
];

/// Crates that are named in one folder alone.
const CONFINED: [(&str, &str); 5] = [
    ("rapier3d", "src/engine/rapier"),
    ("parry3d", "src/engine/rapier"),
    ("plotters", "src/report/chart"),
    ("resvg", "src/report/chart"),
    ("clap", "src/cli"),
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

/// The path below the project, and the room that a file belongs to.
fn room(path: &Path) -> (String, Option<usize>) {
    let below = path.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap();
    let name = below.to_string_lossy().replace('\\', "/");
    let first = name
        .trim_start_matches("src/")
        .split(['/', '.'])
        .next()
        .unwrap_or("")
        .to_owned();
    (name, ROOMS.iter().position(|room| *room == first))
}

/// Lines of code: without comments, which may name anything.
fn code(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text
        .lines()
        .enumerate()
        .map(|(number, line)| (number + 1, line.trim()));
    lines.filter(|(_, line)| !line.starts_with("//"))
}

/// Every room named after `crate::` in a line.
fn rooms_named(line: &str) -> impl Iterator<Item = usize> {
    line.match_indices("crate::").flat_map(move |(at, _)| {
        let rest = &line[at + "crate::".len()..];
        let names: Vec<&str> = match rest.strip_prefix('{') {
            Some(list) => list.split([',', '}']).collect(),
            None => vec![rest],
        };
        names
            .into_iter()
            .filter_map(|name| {
                let end = name.trim().find(|c: char| !c.is_alphanumeric() && c != '_');
                let name = &name.trim()[..end.unwrap_or(name.trim().len())];
                ROOMS.iter().position(|room| *room == name)
            })
            .collect::<Vec<_>>()
    })
}

#[test]
fn imports_point_down() {
    let mut seen = 0;
    for (path, text) in sources() {
        let (name, Some(floor)) = room(&path) else {
            continue;
        };
        for (number, line) in code(&text) {
            for imported in rooms_named(line) {
                seen += 1;
                assert!(
                    imported <= floor,
                    "{name}:{number}: `{}` imports from `{}`, a room above it",
                    ROOMS[floor],
                    ROOMS[imported]
                );
            }
        }
    }
    assert!(
        seen > 50,
        "only {seen} imports found: the test no longer reads them"
    );
}

#[test]
fn an_arrow_that_points_up_would_be_seen() {
    let named: Vec<_> = rooms_named("use crate::{report::Folder, scene};").collect();
    assert_eq!(named, [8, 1]);
    assert_eq!(
        rooms_named("crate::study::track(x, crate::cli::main())").collect::<Vec<_>>(),
        [7, 9]
    );
}

#[test]
fn each_library_stays_in_its_folder() {
    for (path, text) in sources() {
        let (name, _) = room(&path);
        for (library, folder) in CONFINED {
            let used = format!("{library}::");
            let double = format!("{library}_f64::");
            for (number, line) in code(&text) {
                let names_it = line.contains(&used) || line.contains(&double);
                assert!(
                    !names_it || name.starts_with(folder),
                    "{name}:{number}: `{library}` belongs in {folder}"
                );
            }
        }
    }
}
