//! Mutants of scene files: whatever stands in one, it is a scene or it is refused in one line
//! that names file, line and column.

use std::fs;
use std::path::Path;

use carom::engine::{EngineSpec, engine, plan, record_within};
use carom::error::Error;
use carom::scene::{Scene, parse, read, to_toml};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

use crate::hostile::in_short;

/// Counted work that a mutant may take on an engine.
const WORK: u64 = 20_000;

/// Steps that a mutant may take on an engine, its bodies and its samples.
const STEPS: f64 = 2000.0;
const BODIES: usize = 20;
const SAMPLES: usize = 200;

/// Bytes of a message, and of the longest mutant that repeats a part.
const MESSAGE_MAX: usize = 2000;
const REPEATED_MAX: usize = 100_000;

/// What a number is replaced by.
const NUMBERS: [&str; 36] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "nan",
    "-nan",
    "inf",
    "-inf",
    "1e308",
    "1e309",
    "-1e308",
    "5e-324",
    "1e-400",
    "9223372036854775807",
    "9223372036854775808",
    "-9223372036854775809",
    "18446744073709551616",
    "170141183460469231731687303715884105728",
    "0x10",
    "0xffffffffffffffff",
    "0o17",
    "0b101",
    "1_000",
    "1__0",
    "_1",
    "1_",
    "1.",
    ".5",
    "1e",
    "+1",
    "++1",
    "1979-05-27",
    "1979-05-27T07:32:00Z",
    "07:32:00",
    "\"1\"",
    "true",
];

/// What is put in anywhere.
const PIECES: [&str; 40] = [
    "[",
    "]",
    "{",
    "}",
    "[[",
    "]]",
    "=",
    ".",
    ",",
    "\"",
    "'",
    "\"\"\"",
    "'''",
    "#",
    "\n",
    "\r\n",
    "\r",
    "\t",
    " ",
    "\u{feff}",
    "\u{0}",
    "\u{1b}[31m",
    "\u{7f}",
    "\u{85}",
    "\u{202e}",
    "\u{200b}",
    "\u{fffe}",
    "\u{10ffff}",
    "공",
    "\\",
    "\\u0000",
    "\\u001b",
    "\\U00110000",
    "effects.contact.restitution = 1\n",
    "[effects]\n",
    "[effects.contact]\n",
    "[[bodies]]\n",
    "[bodies]\n",
    "a.b.c.d = 1\n",
    "x = {a = {b = [1, {c = 2}]}}\n",
];

/// Keys and values in whose stead others are put.
const WORDS: [&str; 14] = [
    "name",
    "mass",
    "radius",
    "position",
    "velocity",
    "effects",
    "bodies",
    "duration",
    "sample_every",
    "springs",
    "between",
    "restitution",
    "[0, 0, 0]",
    "\"a\"",
];

struct Dice(Pcg64);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        (self.0.next_u64() % count.max(1) as u64) as usize
    }

    fn of<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }
}

/// All scene files there are.
fn seeds() -> Vec<Vec<u8>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![root.join("templates/starter.toml")];
    for library in ["reference", "hard"] {
        for case in fs::read_dir(root.join(library)).unwrap() {
            files.push(case.unwrap().path().join("scene.toml"));
        }
    }
    files.retain(|file| file.is_file());
    files.sort();
    let texts = files.iter().map(|file| fs::read(file).unwrap());
    let small: Vec<_> = texts.filter(|text| text.len() < 20_000).collect();
    assert!(small.len() > 20, "{} scene files", small.len());
    small
}

/// Where the words of a text lie that are numbers.
fn numbers(text: &[u8]) -> Vec<(usize, usize)> {
    let of_number = |c: u8| c.is_ascii_digit() || b"+-._eE".contains(&c);
    let mut found = Vec::new();
    let mut start = 0;
    while start < text.len() {
        let length = text[start..].iter().take_while(|c| of_number(**c)).count();
        if text[start..start + length].iter().any(u8::is_ascii_digit) {
            found.push((start, start + length));
        }
        start += length.max(1);
    }
    found
}

/// Where the lines of a text lie, their ends with them.
fn lines(text: &[u8]) -> Vec<(usize, usize)> {
    let mut start = 0;
    let line = |line: &[u8]| {
        let here = (start, start + line.len());
        start = here.1;
        here
    };
    text.split_inclusive(|c| *c == b'\n').map(line).collect()
}

fn replace(text: &mut Vec<u8>, (from, to): (usize, usize), by: &[u8]) {
    text.splice(from..to, by.iter().copied());
}

/// Changes a text in one of many ways.
fn mutate(text: &mut Vec<u8>, dice: &mut Dice) {
    let place = dice.below(text.len() + 1);
    match dice.below(16) {
        0 if !text.is_empty() => {
            let place = dice.below(text.len());
            text[place] = dice.below(256) as u8;
        }
        1 => text.insert(place, dice.below(256) as u8),
        2 if place < text.len() => drop(text.remove(place)),
        3 => replace(text, (place, place), dice.of(&PIECES).as_bytes()),
        4..=6 => {
            let all = numbers(text);
            if !all.is_empty() {
                replace(text, *dice.of(&all), dice.of(&NUMBERS).as_bytes());
            }
        }
        7 | 8 => {
            let all = lines(text);
            if !all.is_empty() {
                let (from, to) = *dice.of(&all);
                let line = text[from..to].to_vec();
                let (into, _) = *dice.of(&all);
                replace(text, (into, into), &line);
            }
        }
        9 => {
            let all = lines(text);
            if !all.is_empty() {
                replace(text, *dice.of(&all), b"");
            }
        }
        10 => {
            let all = lines(text);
            let end = (place + dice.below(200)).min(text.len());
            let part = text[place..end].to_vec();
            let times = [2, 3, 100, 1000][dice.below(4)].min(REPEATED_MAX / part.len().max(1));
            let (into, _) = all.first().copied().unwrap_or((0, 0));
            replace(text, (into, into), &part.repeat(times.max(1)));
        }
        11 => {
            let all = numbers(text);
            if !all.is_empty() {
                let depth = [2, 10, 81, 200, 50_000][dice.below(5)];
                let (open, close) = *dice.of(&[("[", "]"), ("{a=", "}"), ("[{a=", "}]")]);
                let nested = format!("{}1{}", open.repeat(depth), close.repeat(depth));
                replace(text, *dice.of(&all), nested.as_bytes());
            }
        }
        12 => {
            let word = dice.of(&WORDS).as_bytes();
            let found: Vec<usize> = text
                .windows(word.len())
                .enumerate()
                .filter_map(|(place, here)| (here == word).then_some(place))
                .collect();
            if !found.is_empty() {
                let from = *dice.of(&found);
                replace(text, (from, from + word.len()), dice.of(&WORDS).as_bytes());
            }
        }
        13 => {
            let key = [&b"k"[..], b"k.", b"\"\\n\"", b"'\x1b'"][dice.below(4)];
            let key = key.repeat([1, 10, 5000][dice.below(3)]);
            let line = [key.as_slice(), b" = 1\n"].concat();
            let all = lines(text);
            let (into, _) = all.get(dice.below(all.len())).copied().unwrap_or((0, 0));
            replace(text, (into, into), &line);
        }
        14 => match dice.below(3) {
            0 => replace(text, (0, 0), b"\xef\xbb\xbf"),
            1 => {
                *text = String::from_utf8_lossy(text)
                    .replace('\n', "\r\n")
                    .into_bytes()
            }
            _ => {
                *text = String::from_utf8_lossy(text)
                    .replace('\n', "\r")
                    .into_bytes()
            }
        },
        _ => text.truncate(place),
    }
}

/// What has become of mutants.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
struct Tally {
    parsed: u64,
    refused: u64,
    not_text: u64,
    planned: u64,
    recorded: u64,
}

impl std::ops::Add for Tally {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            parsed: self.parsed + other.parsed,
            refused: self.refused + other.refused,
            not_text: self.not_text + other.not_text,
            planned: self.planned + other.planned,
            recorded: self.recorded + other.recorded,
        }
    }
}

/// A refusal is a short line that starts with file, line and column.
fn assert_refusal(said: &str) {
    assert!(
        said.len() <= MESSAGE_MAX,
        "{} bytes: {said:.200}",
        said.len()
    );
    assert!(!said.chars().any(char::is_control), "{said:?}");
    let place = said
        .strip_prefix("m.toml:")
        .unwrap_or_else(|| panic!("{said}"));
    let mut parts = place.splitn(3, ':');
    for _ in 0..2 {
        let number: usize = parts.next().unwrap().parse().unwrap();
        assert!(number > 0, "{said}");
    }
    assert!(parts.next().is_some_and(|rest| rest.len() > 10), "{said}");
}

/// Plans a scene that was read, runs it if it is small, writes it and reads it back.
fn use_it(scene: &Scene, engines: &[EngineSpec]) -> Tally {
    let mut tally = Tally {
        parsed: 1,
        ..Tally::default()
    };
    let again = parse(&to_toml(scene).unwrap(), "again.toml").unwrap();
    assert!(*scene == again);
    let _ = scene.warnings();
    let dt = scene.sample_every;
    let few = scene.bodies.len() <= BODIES && scene.sample_count() <= SAMPLES;
    let is_small = few && scene.duration / dt <= STEPS;
    for spec in engines {
        match plan(scene, spec, dt) {
            Ok(_) => tally.planned += 1,
            Err(Error::EngineCannot { .. }) => continue,
            Err(wrong) => panic!("{wrong}"),
        }
        if !is_small {
            continue;
        }
        match record_within(scene, spec, dt, WORK) {
            Ok(_) => tally.recorded += 1,
            Err(Error::EngineCannot { .. }) => {}
            Err(wrong) => panic!("{wrong}"),
        }
    }
    tally
}

/// One mutant, in memory or as a file if it is no text.
fn survive(text: Vec<u8>, engines: &[EngineSpec]) -> Tally {
    let found = match String::from_utf8(text) {
        Ok(text) => parse(&text, "m.toml"),
        Err(wrong) => {
            let scratch = tempfile::NamedTempFile::new().unwrap();
            fs::write(scratch.path(), wrong.as_bytes()).unwrap();
            let said = read(scratch.path()).unwrap_err();
            assert!(matches!(said, Error::NotUtf8 { .. }), "{said}");
            return Tally {
                not_text: 1,
                ..Tally::default()
            };
        }
    };
    match found {
        Ok(scene) => use_it(&scene, engines),
        Err(wrong) => {
            assert_refusal(&wrong.to_string());
            Tally {
                refused: 1,
                ..Tally::default()
            }
        }
    }
}

fn try_mutants(count: u64) -> Tally {
    let seeds = seeds();
    let engines = ["lecture", "exact-fast"].map(|name| in_short(engine(name).unwrap()));
    let tally = (0..count)
        .into_par_iter()
        .map(|number| {
            let mut dice = Dice(Pcg64::seed_from_u64(number));
            let mut text = dice.of(&seeds).clone();
            for _ in 0..=dice.below(4) {
                mutate(&mut text, &mut dice);
            }
            let shown = String::from_utf8_lossy(&text)
                .chars()
                .take(4000)
                .collect::<String>();
            let survived = std::panic::catch_unwind(|| survive(text, &engines));
            survived.unwrap_or_else(|_| panic!("mutant {number}:\n{shown}"))
        })
        .reduce(Tally::default, std::ops::Add::add);
    println!("{count} mutants of {} scene files: {tally:?}", seeds.len());
    assert_eq!(tally.parsed + tally.refused + tally.not_text, count);
    tally
}

#[test]
fn some_hundred_mutants_of_scene_files_are_scenes_or_refused_in_a_line() {
    let tally = try_mutants(600);
    // Half of what this many gave when the test was written: it tests something.
    assert!(tally.parsed > 22, "{tally:?}");
    assert!(tally.refused > 230, "{tally:?}");
    assert!(tally.recorded > 40, "{tally:?}");
}

/// `CAROM_MUTANTS=1000000` tries as many.
#[test]
#[ignore = "a minute or two: .ci/run runs it"]
fn twenty_thousand_mutants_of_scene_files_are_scenes_or_refused_in_a_line() {
    let asked = std::env::var("CAROM_MUTANTS").map(|count| count.parse().unwrap());
    try_mutants(asked.unwrap_or(20_000));
}
