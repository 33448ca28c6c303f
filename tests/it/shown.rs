//! What carom shows of foreign text: one line, nothing that a terminal obeys or hides, not all of
//! it where it is long; and exit code 2 with the remedy where carom could not run.

use std::fs;
use std::path::Path;

use crate::command::carom;

/// What a terminal would obey or not show: colours, a bell, marks of direction and of width 0, a
/// tag, a control character of two bytes, and lines of its own.
const HOSTILE: &str =
    "a\u{1b}[31m\u{7}\u{202e}\u{200b}\u{feff}\u{e0041}\u{9b}2J\nerror: b\r\u{2028}c";

/// The same as a string of TOML.
const ESCAPED: &str =
    "a\\u001b[31m\\u0007\\u202e\\u200b\\ufeff\\U000e0041\\u009b2J\\nerror: b\\r\\u2028c";

fn is_hostile(c: char) -> bool {
    let marks = [
        '\u{200b}',
        '\u{202e}',
        '\u{feff}',
        '\u{2028}',
        '\u{e0041}',
        '\u{fffe}',
        '\u{ffff}',
    ];
    marks.contains(&c) || (c.is_control() && c != '\n')
}

fn assert_clean(text: &str) {
    assert!(!text.chars().any(is_hostile), "{text:?}");
}

/// Runs a command that cannot run: exit 2, one clean line of a stated length.
fn complaint(folder: &Path, arguments: &[&str]) -> String {
    let (code, out, said) = carom(folder, arguments);
    let short = |text: &String| text.chars().take(300).collect::<String>();
    assert_eq!(
        (code, out.as_str()),
        (2, ""),
        "{arguments:?}: {}",
        short(&said)
    );
    assert!(
        said.starts_with("error: ") && said.ends_with('\n'),
        "{}",
        short(&said)
    );
    assert_eq!(said.lines().count(), 1, "{arguments:?}: {}", short(&said));
    assert!(said.chars().count() < 2100, "{}", said.len());
    assert_clean(&said);
    said
}

const BODY: &str = "[[bodies]]\nname = \"a\"\nmass = 1.0\nradius = 1.0\nposition = [0.0, 0.0, 0.0]\nvelocity = [0.0, 0.0, 0.0]\n";

fn scene(name: &str) -> String {
    format!(
        "name = \"{name}\"\nduration = 1.0\nsample_every = 0.5\n{BODY}[effects.contact]\nrestitution = 1.0\n"
    )
}

/// A library with one case, some of its files replaced.
fn library(folder: &Path, replaced: &[(&str, &str)]) {
    let case = folder.join("lib/headon-equal");
    fs::create_dir_all(&case).unwrap();
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/headon-equal");
    for entry in fs::read_dir(stored).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), case.join(entry.file_name())).unwrap();
    }
    for (file, text) in replaced {
        fs::write(case.join(file), text).unwrap();
    }
}

#[test]
fn words_of_the_command_line_are_shown_clean() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    for arguments in [
        &["run", HOSTILE][..],
        &["run", "headon-equal", "--engine", HOSTILE],
        &["run", "headon-equal", "--dt", HOSTILE],
        &["run", "headon-equal", HOSTILE],
        &[HOSTILE],
        &["run", "headon-equal", "--reference", HOSTILE],
        &["report", "--studies", HOSTILE],
        &["cost", "headon-equal", "--tune-on", HOSTILE],
        &["cost", "--bodies", HOSTILE],
        &["cost", "--bodies", "4", "--join", HOSTILE],
        &["stability", HOSTILE],
        &["stability", "--hard", HOSTILE],
        &["check", HOSTILE],
        &["check", "headon-equal", "--like", HOSTILE],
        &["check", "headon-equal", "--like", ""],
        &["check", "headon-equal", "--solver", HOSTILE],
        &["check", "headon-equal", "--trajectory", HOSTILE],
        &["check", "headon-equal", "--replay", HOSTILE],
        &["check", "headon-equal", "--format", HOSTILE],
        &["scenes", "new", HOSTILE],
        &["scenes", "new", "a\" #"],
        &["scenes", "show", HOSTILE],
        &["scenes", "generate", "gas", "--cells", HOSTILE],
    ] {
        complaint(folder, arguments);
        let long = "x".repeat(100_000);
        let long: Vec<&str> = arguments
            .iter()
            .map(|word| {
                if *word == HOSTILE {
                    long.as_str()
                } else {
                    word
                }
            })
            .collect();
        if arguments.contains(&HOSTILE) {
            complaint(folder, &long);
        }
    }
    assert_eq!(fs::read_dir(folder).unwrap().count(), 0);
}

#[test]
fn words_of_files_are_shown_clean() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let long = "x".repeat(2_000_000);
    for text in [ESCAPED, long.as_str()] {
        for toml in [
            format!("\"{text}\" = 1\n{}", scene("x")),
            scene(text),
            scene("x").replace("\"a\"", &format!("\"{text}\"")),
            scene("x").replace("mass = 1.0", &format!("mass = \"{text}\"")),
            scene("x").replace("[effects.contact]", &format!("[effects.\"{text}\"]")),
            format!("units = {{ length = \"{text}\" }}\n{}", scene("x")),
            format!(
                "{}[[effects.springs]]\nbetween = [\"a\", \"{text}\"]\nstiffness = 1\nrest_length = 1\ndamping = 0\n",
                scene("x")
            ),
        ] {
            fs::write(folder.join("s.toml"), toml).unwrap();
            let said = complaint(folder, &["plan", "s.toml"]);
            assert!(said.starts_with("error: s.toml:"), "{said}");
        }
        let title = format!("title = \"{ESCAPED}\"\n{}", scene("x"));
        fs::write(folder.join("s.toml"), title).unwrap();
        complaint(folder, &["plan", "s.toml"]);
        let raw = if text == ESCAPED {
            HOSTILE.replace(['\n', '\r'], "")
        } else {
            long.clone()
        };
        for events in [
            format!("time,kind,a,b,impulse\n0.5,{raw},a,b,1\n"),
            format!("time,kind,a,b,impulse\n0.5,contact,{raw},b,1\n"),
            format!("time,kind,a,b,impulse\n0.5,cushion,a,{raw},1\n"),
            format!("time,kind,a,b,impulse\n{raw},contact,a,b,1\n"),
            format!("{raw}\n"),
        ] {
            library(folder, &[("events.csv", &events)]);
            let said = complaint(folder, &["run", "headon-equal", "--reference", "lib"]);
            // A row of two million letters is too long to be one.
            let place = [
                "events.csv, line ",
                "events.csv: cannot be read: no row ends",
            ];
            assert!(place.iter().any(|place| said.contains(place)), "{said}");
        }
        for expected in [
            format!("topic = \"{ESCAPED}\"\n"),
            format!("\"{text}\" = 1\n"),
            format!("[profile.\"{text}\"]\nmade = \"x\"\ndt = -1\ndigest = \"x\"\n"),
            format!(
                "[end]\nwithin = 1\nwhy = \"x\"\n[[end.bodies]]\nname = \"{text}\"\nposition = [0, 0, 0]\n"
            ),
        ] {
            library(
                folder,
                &[
                    ("events.csv", "time,kind,a,b,impulse\n"),
                    ("expected.toml", &expected),
                ],
            );
            let said = complaint(folder, &["check", "headon-equal", "--reference", "lib"]);
            assert!(said.contains("expected.toml:"), "{said}");
        }
    }
}

/// Once, a path was taken for a word of carom's: it could begin lines of its own.
#[cfg(unix)]
#[test]
fn names_of_files_are_shown_clean_in_every_form() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let file = format!("{HOSTILE}\u{fffe}\u{ffff}<&\"'].csv").replace('/', "");
    fs::write(folder.join(&file), "no trajectory").unwrap();
    let check = ["check", "headon-equal", "--trajectory", &file];
    let (code, text, _) = carom(folder, &check);
    assert_eq!(code, 1);
    assert_clean(&text);
    assert!(
        !text.lines().any(|line| line.starts_with("error")),
        "{text}"
    );
    let (code, json, _) = carom(folder, &[&check[..], &["--format", "json"]].concat());
    assert_eq!(code, 1);
    assert_clean(&json);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["checks"][0]["solver"], file.as_str());
    let (code, xml, _) = carom(folder, &[&check[..], &["--format", "junit"]].concat());
    assert_eq!(code, 1);
    assert_clean(&xml);
    assert!(xml.contains("&lt;") && !xml.contains("<&"), "{xml}");
    let scene = format!("{HOSTILE}.toml");
    fs::write(folder.join(&scene), "name = 3").unwrap();
    complaint(folder, &["run", &scene]);
    let (code, out, said) = carom(
        folder,
        &[
            "run",
            "headon-equal",
            "--engine",
            "lecture",
            "--out",
            HOSTILE,
        ],
    );
    assert_eq!(code, 0, "{said}");
    assert_clean(&out);
    assert_clean(&said);
    assert!(!out.lines().any(|line| line.starts_with("error")), "{out}");
}

#[test]
fn what_keeps_carom_from_running_is_told_with_the_remedy() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    fs::create_dir(folder.join("folder")).unwrap();
    for (arguments, parts) in [
        (
            &["check", "headon-equal", "--trajectory", "folder"][..],
            &["folder: cannot be read"][..],
        ),
        (
            &["check", "headon-equal", "--replay", "folder"],
            &["folder: cannot be read"],
        ),
        (
            &["cost", "--bodies", "4", "--join", "folder"],
            &["folder: cannot be read"],
        ),
        (
            &["check", "--solver", "x", "--limit", "inf"],
            &["--limit inf", "finite", "at most 1000000"],
        ),
        (
            &["check", "--solver", "x", "--limit", "1e300"],
            &["--limit 1e300", "at most 1000000"],
        ),
        (&["check", "--solver", "x", "--limit", "0"], &["above 0"]),
        (
            &["plan", "headon-equal", "--reference", "/nonexistent"],
            &["/nonexistent", "no such folder"],
        ),
        (
            &["plan", "pi-2", "--reference", "/nonexistent"],
            &["/nonexistent", "no such folder"],
        ),
        (
            &["scenes", "list", "--reference", "/nonexistent"],
            &["/nonexistent", "no such folder"],
        ),
        (
            &["stability", "--hard", "/nonexistent"],
            &["/nonexistent", "no such folder"],
        ),
        (
            &["run", "headon-equal", "--dt", "1e300", "--dt", "1"],
            &["--dt", "usage: carom run"],
        ),
        (&["check", "--like", "a b"], &["--like `a b`", "a-z"]),
        (&["scenes", "new", "A"], &["`A`", "a-z, 0-9"]),
    ] {
        let said = complaint(folder, arguments);
        for part in parts {
            assert!(said.contains(part), "{part}: {said}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_name_that_is_not_utf8_is_the_name_of_a_file() {
    use std::os::unix::ffi::OsStrExt;

    let scratch = tempfile::tempdir().unwrap();
    let output = assert_cmd::Command::cargo_bin("carom")
        .unwrap()
        .current_dir(scratch.path())
        .args(["scenes", "new", "x", "--out"])
        .arg(std::ffi::OsStr::from_bytes(b"x\xff.toml"))
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    let name = std::ffi::OsStr::from_bytes(b"x\xff.toml");
    assert!(scratch.path().join(name).is_file());
}

#[test]
fn files_of_data_are_told_in_the_words_of_toml() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let body = |from: &str, to: &str| scene("x").replace(from, to);
    for (toml, part) in [
        (body("mass = 1.0", "mass = -1e300"), "is -1e300: "),
        (
            body("mass = 1.0", "mass = 18446744073709551616"),
            "decimal point, 18446744073709551616.0",
        ),
        (
            body("mass = 1.0", &format!("mass = 1{}", "0".repeat(60))),
            "with a decimal point",
        ),
        (body("mass = 1.0", "mass = 1e999"), "1.8e308"),
        (
            body("mass = 1.0", "mass = 2026-01-01"),
            "date or time, expected a number",
        ),
        (body("mass = 1.0", "mass = [1]"), "array, expected a number"),
        (body("mass = 1.0", "mass = {}"), "table, expected a number"),
        (
            body(BODY, "bodies = [1]\n"),
            "integer `1`, expected a table",
        ),
        (body(BODY, "bodies = 1\n"), "integer `1`, expected an array"),
        (body(BODY, "[bodies]\n"), "table, expected an array"),
        (
            format!("effects = 1\nname = \"x\"\nduration = 1.0\nsample_every = 0.5\n{BODY}"),
            "integer `1`, expected a table",
        ),
        (
            format!("units = true\n{}", scene("x")),
            "boolean `true`, expected a table",
        ),
        (
            format!("units.length = 1\n{}", scene("x")),
            "expected a string",
        ),
    ] {
        fs::write(folder.join("s.toml"), toml).unwrap();
        let said = complaint(folder, &["plan", "s.toml"]);
        assert!(said.contains(part), "{part}: {said}");
        for leak in ["struct", "sequence", "map", "f64", "i128", "u64"] {
            assert!(!said.contains(leak), "{leak}: {said}");
        }
    }
    let accepted = body("mass = 1.0", "mass = 9223372036854775808");
    fs::write(folder.join("s.toml"), accepted).unwrap();
    assert_eq!(carom(folder, &["plan", "s.toml"]).0, 0);
    for (expected, part) in [
        (
            "dt = [1e-12]\n",
            "expected.toml:1:7: `dt[0]` is 1e-12 s: makes ",
        ),
        (
            "[profile.lecture]\nmade = \"x\"\ndigest = \"x\"\ndt = 1e-12\n",
            "`profile.lecture.dt` is 1e-12 s: makes ",
        ),
        ("dt = 1\n", "integer `1`, expected an array"),
        ("end = 1\n", "integer `1`, expected a table"),
        (
            "[impacts]\ncontacts = 1.5\nwhy = \"x\"\n",
            "expected a whole number, 0 or above",
        ),
        ("profile = [1]\n", "array, expected a table"),
    ] {
        library(folder, &[("expected.toml", expected)]);
        let said = complaint(folder, &["check", "headon-equal", "--reference", "lib"]);
        assert!(said.contains(part), "{part}: {said}");
    }
}

/// Once, the command in a generated scene's `source` left out all but the seed.
#[test]
fn the_command_in_a_generated_scene_makes_it_again() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    for recipe in [
        &["cluster"][..],
        &[
            "cluster",
            "--count",
            "7",
            "--extent",
            "12.345678901234567",
            "--seed",
            "18446744073709551615",
        ],
        &["rack"],
        &["rack", "--rows", "3", "--gap", "0.1"],
        &[
            "rack", "--rows", "4", "--gap", "1e-7", "--jitter", "1e-9", "--seed", "9",
        ],
        &["gas"],
        &[
            "gas",
            "--cells",
            "2",
            "--filling",
            "0.3333333333333333",
            "--seed",
            "3",
        ],
        &["gas", "--count", "100", "--filling", "1e-6", "--seed", "3"],
    ] {
        let (code, made, said) = carom(folder, &[&["scenes", "generate"], recipe].concat());
        assert_eq!(code, 0, "{said}");
        let scene = carom::scene::parse(&made, "made").unwrap();
        let source = scene.source.unwrap();
        let command = &source[source.find("carom ").unwrap()..];
        let words: Vec<&str> = command.split(' ').skip(1).collect();
        assert_eq!(carom(folder, &words).1, made, "{command}");
    }
}

/// Names are free text: they begin no cell, no code and no tag of a page.
#[test]
fn names_stay_text_in_pages_and_tables() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let name = "a|b`<img src=x>`,\\\"*[c](d)";
    let text = scene("x").replace("\"a\"", &format!("'{name}'"))
        + &BODY
            .replace("\"a\"", "\"b\"")
            .replace("position = [0.0", "position = [0.5")
        + "[effects.attraction]\nconstant = 1e300\n";
    let text = format!("title = '{name}'\nwatch = '{name}'\nsource = '{name}'\n{text}");
    fs::write(folder.join("s.toml"), text).unwrap();
    let (code, _, said) = carom(
        folder,
        &["run", "s.toml", "--engine", "lecture,verlet", "--out", "o"],
    );
    assert_eq!(code, 0, "{said}");
    let page = fs::read_to_string(folder.join("o/README.md")).unwrap();
    // Where a name stands outside of code, its tag is escaped; in code, no backtick ends it.
    for line in page.lines() {
        let outside: String = line.split('`').step_by(2).collect();
        assert!(!outside.replace("\\<", "").contains('<'), "{line}");
    }
    let rows = page.lines().filter(|line| line.starts_with('|'));
    let cells = |line: &str| line.replace("\\|", "").matches('|').count();
    let tables: Vec<Vec<usize>> = rows.map(cells).fold(Vec::new(), |mut tables, count| {
        match tables.last_mut() {
            Some(table) if table.first() == Some(&count) => table.push(count),
            _ => tables.push(vec![count]),
        }
        tables
    });
    assert!(
        tables.iter().all(|table| table.len() >= 3),
        "{tables:?}\n{page}"
    );
    let table = fs::File::open(folder.join("o/trajectory-lecture.csv")).unwrap();
    let stored =
        carom::scene::parse(&fs::read_to_string(folder.join("s.toml")).unwrap(), "s").unwrap();
    carom::recording::read_trajectory_start("lecture", &stored, table, "t").unwrap();
}
