//! `docs/departures.md` is made from the lines `DEVIATES:` in the sources.

use std::fmt::Write;
use std::fs;
use std::path::Path;

const HEAD: &str = "# Where carom departs from the lecture\n\n\
Made from the lines `DEVIATES:` in the sources, which stand where the departure is; \
`CAROM_BLESS=1 cargo test departures` writes this page anew.\n";

/// The paragraph that starts with `DEVIATES:` in a file's comments, for each of them.
fn departures(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut lines = text.lines().map(str::trim);
    while let Some(line) = lines.next() {
        let Some((_, first)) = line.split_once("/ DEVIATES: ") else {
            continue;
        };
        let mut paragraph = first.to_owned();
        for line in lines.by_ref() {
            let rest = line.trim_start_matches(['/', '!']);
            let ends = !line.starts_with("//") || rest.trim().is_empty();
            if ends {
                break;
            }
            paragraph = format!("{paragraph} {}", rest.trim());
        }
        found.push(paragraph);
    }
    found
}

fn page() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut page = HEAD.to_owned();
    for (path, text) in crate::layers::sources() {
        let below = path.strip_prefix(root).unwrap().display().to_string();
        for departure in departures(&text) {
            writeln!(page, "\n- `{below}`: {departure}").unwrap();
        }
    }
    page
}

#[test]
fn departures_are_listed() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/departures.md");
    let page = page();
    assert!(
        page.matches("\n- ").count() >= 5,
        "the lines are no longer found:\n{page}"
    );
    if std::env::var_os("CAROM_BLESS").is_some() {
        fs::write(&file, &page).unwrap();
    }
    let listed = fs::read_to_string(&file).unwrap_or_default();
    assert!(
        listed == page,
        "docs/departures.md is not up to date; it must be:\n{page}"
    );
}
