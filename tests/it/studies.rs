//! Studies beside a report: made on request, kept and told of with their date afterwards.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

use crate::command_line::{assert_links, carom, files};

const CASES: [&str; 2] = ["headon-equal", "kepler-circle"];

/// Makes the report of [`CASES`] on the lecture's engine and gives what it warns of.
fn report(folder: &Path, more: &[&str]) -> String {
    let mut command = Command::cargo_bin("carom").unwrap();
    let output = command
        .current_dir(folder)
        .arg("report")
        .args(CASES)
        .args(["--engine", "lecture", "--quiet"])
        .args(more)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    said
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join("reports").join(name)).unwrap()
}

/// Says that the stored study was made on a day and with a version.
fn backdate(folder: &Path, day: &str, version: &str) {
    let path = folder.join("reports/cost/summary.json");
    let text = fs::read_to_string(&path).unwrap();
    let mut summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    summary["date"] = day.into();
    summary["versions"]["carom"] = version.into();
    fs::write(&path, summary.to_string()).unwrap();
}

#[test]
fn a_study_is_linked_kept_and_told_with_its_date() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    report(folder, &[]);
    assert!(!read(folder, "README.md").contains("## Studies"));
    report(folder, &["--studies", "cost"]);
    let stored = |name: &str| folder.join("reports/cost").join(name).exists();
    for name in ["README.md", "cost.csv", "orders.csv", "summary.json"] {
        assert!(stored(name), "{name}");
    }
    let told = |day: &str, remark: bool| {
        let pages = ["README.md"].map(str::to_owned).into_iter();
        let pages = pages.chain(CASES.map(|case| format!("{case}/README.md")));
        for name in pages {
            let page = read(folder, &name);
            assert!(page.contains(&format!("Measured on {day}")), "{name}");
            assert!(page.contains("cost/README.md"), "{name}");
            assert_eq!(page.contains("with carom 0.0.1"), remark, "{name}");
        }
        assert_links(&files(&folder.join("reports")));
    };
    let summary: serde_json::Value =
        serde_json::from_str(&read(folder, "cost/summary.json")).unwrap();
    told(summary["date"].as_str().unwrap(), false);
    for case in CASES {
        let page = read(folder, &format!("{case}/README.md"));
        assert!(page.contains("## What accuracy costs in time"), "{case}");
        for picture in ["work-precision", "prices"] {
            let name = format!("{picture}-{case}.png");
            assert_eq!(stored(&name), cfg!(feature = "plots"), "{name}");
            assert_eq!(page.contains(&name), cfg!(feature = "plots"), "{name}");
        }
    }
    backdate(folder, "2001-02-03", "0.0.1");
    let before = files(&folder.join("reports/cost"));
    assert_eq!(report(folder, &[]), "");
    told("2001-02-03", true);
    assert!(
        before == files(&folder.join("reports/cost")),
        "it was touched"
    );
}

#[test]
fn a_damaged_study_is_one_line_of_warning_and_left_out() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    carom(
        folder,
        &[
            "cost",
            "headon-equal",
            "--engine",
            "lecture",
            "--budget",
            "1000",
            "--repetitions",
            "1",
            "--quiet",
            "--out",
            "reports/cost",
        ],
    );
    assert_eq!(report(folder, &[]), "");
    assert!(read(folder, "README.md").contains("cost/README.md"));
    let other = read(folder, "kepler-circle/README.md");
    assert!(!other.contains("cost/README.md"), "it was not measured");
    fs::write(folder.join("reports/cost/summary.json"), "{\"date\": 1").unwrap();
    let said = report(folder, &[]);
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.starts_with("warning: "), "{said}");
    assert!(
        said.contains("summary.json") && said.contains("--studies cost"),
        "{said}"
    );
    for page in ["README.md", "headon-equal/README.md"] {
        assert!(!read(folder, page).contains("cost/README.md"), "{page}");
    }
}

#[test]
fn an_unknown_study_is_one_line_that_names_those_there_are() {
    let scratch = tempfile::tempdir().unwrap();
    let mut command = Command::cargo_bin("carom").unwrap();
    let output = command
        .current_dir(scratch.path())
        .args(["report", "headon-equal", "--studies", "cost,price"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert_eq!(
        said,
        "error: no study is called `price`; there are: cost, stability\n"
    );
    assert!(!scratch.path().join("reports").exists());
}
