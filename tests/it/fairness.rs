//! The tables of `docs/fairness.md` are those that the engines make of themselves.

use std::fs;
use std::path::Path;

use carom::case::Library;
use carom::engine::engine;
use carom::report::{handling_table, support_table};
use carom::study::stability::Bounded;

/// The page with the table between these marks replaced.
fn with_table(page: &str, mark: &str, table: &str) -> String {
    let begin = format!("<!-- {mark} -->\n");
    let (before, rest) = page.split_once(&begin).expect(mark);
    let (_, after) = rest.split_once("<!-- end -->").expect(mark);
    format!("{before}{begin}\n{table}\n<!-- end -->{after}")
}

/// How often each number of runs is told follows from the cases: "48 cases at three steps each" was
/// not so.
#[test]
fn the_readme_tells_the_true_number_of_hard_runs() {
    let names = Library::EmbeddedHard.names().unwrap();
    let cases: Vec<Bounded> = names
        .iter()
        .map(|name| Bounded::of(Library::EmbeddedHard.case(name).unwrap()).unwrap())
        .collect();
    let runs: usize = cases.iter().map(|case| case.expected.dt.len()).sum();
    let said = format!(
        "{} hard cases, {runs} runs of each engine that takes steps",
        cases.len()
    );
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md"));
    assert!(page.unwrap().contains(&said), "README.md must say: {said}");
}

#[test]
fn the_tables_of_fairness_are_those_of_the_engines() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/fairness.md");
    let stored = fs::read_to_string(&file).unwrap();
    let page = with_table(&stored, "support", &support_table());
    let page = with_table(&page, "handling", &handling_table());
    if std::env::var_os("CAROM_BLESS").is_some() {
        fs::write(&file, &page).unwrap();
        return;
    }
    assert!(
        stored == page,
        "docs/fairness.md is not up to date; it must be:\n{page}"
    );
}

/// Where the motion is along the spring both dampers are the same.
#[test]
fn dampers_differ_where_the_ends_move_across_the_spring() {
    let scene = |name: &str| Library::Embedded.case(name).unwrap().scene;
    let differs = |engine_name: &str, case: &str| {
        let spec = engine(engine_name).unwrap();
        spec.another_model(&scene(case)).is_some()
    };
    assert!(differs("rapier", "spring-under"));
    assert!(differs("rapier-tuned", "spring-under"));
    assert!(!differs("rapier", "spring-under-line"));
    assert!(!differs("rapier", "spring-under-simple"));
    assert!(!differs("rapier", "headon-equal"));
    for name in ["rapier-matched", "lecture", "exact", "robust"] {
        assert!(!differs(name, "spring-under"), "{name}");
    }
}
