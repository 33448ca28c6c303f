//! Every option of every command acts, or is refused where it cannot: `options.txt` states for each
//! which it is, context by context, and an option that does not stand there fails.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use rayon::prelude::*;

use crate::command::carom;
use crate::command_line::files;

const TABLE: &str = include_str!("options.txt");

/// An option of a command in a context.
struct Cell<'a> {
    command: &'a [String],
    context: &'a [String],
    option: &'a str,
    arguments: &'a [String],
    state: char,
}

/// A command with its contexts, and the options with their cells and arguments.
#[derive(Default)]
struct Listed {
    command: Vec<String>,
    contexts: Vec<Vec<String>>,
    options: Vec<(String, String, Vec<String>)>,
}

fn listed() -> Vec<Listed> {
    let mut all: Vec<Listed> = Vec::new();
    for line in TABLE.lines().filter(|line| !line.starts_with('#')) {
        let words = shlex::split(line).unwrap();
        match words.first().map(String::as_str) {
            None => {}
            Some("command") => all.push(Listed {
                command: words[1..].to_vec(),
                ..Listed::default()
            }),
            Some("context") => all.last_mut().unwrap().contexts.push(words[2..].to_vec()),
            Some("option") => all.last_mut().unwrap().options.push((
                words[1].clone(),
                words[2].clone(),
                words[3..].to_vec(),
            )),
            Some(other) => panic!("{other}: {line}"),
        }
    }
    all
}

/// A folder with a scene file, a library of other scenes than those compiled in, one with
/// tolerances that are too narrow, a recording, and a folder with a file of somebody else.
fn scratch() -> tempfile::TempDir {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let sources = Path::new(env!("CARGO_MANIFEST_DIR"));
    for case in [
        "reference/headon-equal",
        "reference/shot-2-96",
        "reference/shot-2-61",
        "hard/pi-2",
    ] {
        let text = fs::read_to_string(sources.join(case).join("scene.toml")).unwrap();
        let mut text = text.replacen("title = \"", "title = \"other ", 1);
        if !text.contains("[effects.drag]") {
            text.push_str("\n[effects.drag]\ncoefficient = 0.1\n");
        }
        let other = folder
            .join("lib")
            .join(case.split('/').next_back().unwrap());
        fs::create_dir_all(&other).unwrap();
        fs::write(other.join("scene.toml"), text).unwrap();
    }
    fs::create_dir(folder.join("taken")).unwrap();
    fs::write(folder.join("taken/README.md"), "of somebody else").unwrap();
    let own = folder.join("own/headon-equal");
    fs::create_dir_all(&own).unwrap();
    for entry in fs::read_dir(sources.join("reference/headon-equal")).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), own.join(entry.file_name())).unwrap();
    }
    let expected = fs::read_to_string(own.join("expected.toml")).unwrap();
    let narrow = expected
        .split("tolerance = ")
        .enumerate()
        .map(|(place, rest)| {
            let rest = if place == 0 {
                rest
            } else {
                &rest[rest.find(',').unwrap()..]
            };
            rest.to_owned()
        });
    let narrow: Vec<String> = narrow.collect();
    fs::write(own.join("expected.toml"), narrow.join("tolerance = 1e-30")).unwrap();
    fs::copy(
        sources.join("templates/starter.toml"),
        folder.join("mine.toml"),
    )
    .unwrap();
    scratch
}

/// What a command leaves: exit code, standard output, and every file by its path.
type Left = BTreeMap<String, String>;

fn run(command: &[String], arguments: &[String], recording: &[u8]) -> (Left, String) {
    let scratch = scratch();
    fs::write(scratch.path().join("own.csv"), recording).unwrap();
    let words: Vec<&str> = command
        .iter()
        .chain(arguments)
        .map(String::as_str)
        .collect();
    let (code, out, said) = carom(scratch.path(), &words);
    let root = scratch.path().to_string_lossy().into_owned();
    let written = files(scratch.path()).into_iter();
    let mut left: Left = written
        .map(|(path, bytes)| {
            let text = String::from_utf8_lossy(&bytes).into_owned();
            (path.replace(&root, ""), text)
        })
        .collect();
    left.insert("exit code".to_owned(), code.to_string());
    left.insert("standard output".to_owned(), out);
    (left, said)
}

/// Whether a run left something else than two equal runs did, times and prices apart: what both
/// left alike must be there.
fn differs(base: &[Left; 2], found: &Left) -> bool {
    let [first, second] = base;
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<BTreeSet<_>>();
    let is_new = |path: &String| !first.contains_key(path);
    found.keys().any(is_new)
        || first.iter().any(|(path, text)| {
            let (Some(found), again) = (found.get(path), &second[path]) else {
                return true;
            };
            let count = |text: &str| text.lines().count();
            let alike: BTreeSet<_> = lines(text).intersection(&lines(again)).cloned().collect();
            (text == again && text != found)
                || (count(text) == count(again) && count(text) != count(found))
                || !alike.is_subset(&lines(found))
        })
}

/// A context without an option and its value.
fn taken_away(context: &[String], option: &str) -> Vec<String> {
    let mut left = context.to_vec();
    let place = left.iter().position(|word| word == &format!("--{option}"));
    let place = place.expect("the option stands in the context");
    left.remove(place);
    if left.get(place).is_some_and(|word| !word.starts_with('-')) {
        left.remove(place);
    }
    left
}

/// What is wrong with a cell, if anything is.
fn fault(
    cell: &Cell,
    bases: &BTreeMap<(&[String], &[String]), [Left; 2]>,
    recording: &[u8],
) -> Option<String> {
    let with: Vec<String> = cell.context.iter().chain(cell.arguments).cloned().collect();
    let place = format!(
        "{:?} --{} ({})",
        [cell.command, &with].concat(),
        cell.option,
        cell.state
    );
    let (arguments, named) = match cell.state {
        'a' => (with, false),
        '.' => (taken_away(cell.context, cell.option), false),
        'r' => (with, true),
        other => panic!("{place}: no such state: {other}"),
    };
    let (left, said) = run(cell.command, &arguments, recording);
    if !named {
        let base = &bases[&(cell.command, cell.context)];
        return (!differs(base, &left)).then(|| format!("{place}: nothing changes\n{said}"));
    }
    let is_refused = left["exit code"] == "2"
        && left["standard output"].is_empty()
        && said.trim_end().lines().count() == 1
        && said.starts_with("error: ")
        && said.contains(&format!("--{}", cell.option));
    (!is_refused).then(|| format!("{place}: exit {}\n{said}", left["exit code"]))
}

#[test]
fn every_option_acts_or_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    carom(
        folder.path(),
        &["run", "headon-equal", "--engine", "lecture", "--out", "o"],
    );
    let recording = fs::read(folder.path().join("o/trajectory-lecture.csv")).unwrap();
    let all = listed();
    let mut cells = Vec::new();
    for of in &all {
        for (option, states, arguments) in &of.options {
            assert_eq!(states.len(), of.contexts.len(), "{:?} {option}", of.command);
            assert!(
                states.contains(['a', '.']),
                "{:?} {option} never acts",
                of.command
            );
            let states = states
                .chars()
                .zip(&of.contexts)
                .filter(|(state, _)| *state != '-');
            cells.extend(states.map(|(state, context)| Cell {
                command: &of.command,
                context,
                option,
                arguments,
                state,
            }));
        }
    }
    let contexts: BTreeSet<(&[String], &[String])> = cells
        .iter()
        .map(|cell| (cell.command, cell.context))
        .collect();
    let bases = contexts
        .into_par_iter()
        .map(|(command, context)| {
            let once = || run(command, context, &recording).0;
            ((command, context), [once(), once()])
        })
        .collect();
    let faults: Vec<String> = cells
        .par_iter()
        .filter_map(|cell| fault(cell, &bases, &recording))
        .collect();
    println!("{} cells of {} commands", cells.len(), all.len());
    assert!(
        faults.is_empty(),
        "{} faults:\n{}",
        faults.len(),
        faults.join("\n")
    );
}

/// The commands and options that `--help` shows, of the command and all below it.
fn shown(command: &[String], found: &mut BTreeSet<(String, String)>) {
    let folder = tempfile::tempdir().unwrap();
    let mut words: Vec<&str> = command.iter().map(String::as_str).collect();
    words.push("--help");
    let (code, help, _) = carom(folder.path(), &words);
    assert_eq!(code, 0, "{words:?}");
    let mut below = false;
    for line in help.lines() {
        if !line.starts_with(' ') {
            below = line == "Commands:";
            continue;
        }
        let text = line.trim_start();
        if below && line.starts_with("  ") && !line.starts_with("   ") {
            let word = text.split(' ').next().unwrap();
            if word != "help" {
                shown(&[command, &[word.to_owned()]].concat(), found);
            }
        } else if text.starts_with('-') && !text.starts_with("- ") {
            let long = text.split("--").nth(1).unwrap_or_else(|| panic!("{line}"));
            let long: String = long
                .chars()
                .take_while(|c| c.is_ascii_alphanumeric() || *c == '-')
                .collect();
            if !["help", "version"].contains(&long.as_str()) {
                found.insert((command.join(" "), long));
            }
        }
    }
}

/// `carom drift` takes minutes: what its options do is shown in `drift.rs`.
#[test]
fn every_option_is_listed() {
    let mut found = BTreeSet::new();
    shown(&[], &mut found);
    found.retain(|(command, _)| command != "drift");
    let listed: BTreeSet<(String, String)> = listed()
        .iter()
        .flat_map(|of| {
            of.options
                .iter()
                .map(|(option, ..)| (of.command.join(" "), option.clone()))
        })
        .collect();
    let missing: Vec<_> = found.symmetric_difference(&listed).collect();
    assert!(
        missing.is_empty(),
        "not in options.txt, or not there: {missing:?}"
    );
    println!("{} options", listed.len());
}
