//! The checks checked: faults that people make must be caught, and where there is none, nothing
//! may be.

use std::fmt::Write;

use carom::case::Library;
use carom::engine::{EngineSpec, engine};
use carom::study::check::{
    Against, Candidate, CaseCheck, CheckReport, Comparison, Held, check, suite,
};

use crate::faulty::{Fault, Faulty};

/// As the engine `lecture` itself, which its own baseline judges also where truth is silent.
fn checked(fault: Fault) -> CheckReport {
    suite("lecture", "lecture", |scene, grid| {
        Faulty::new(fault, scene, grid)
    })
    .unwrap()
}

/// The case of the fewest bodies that fails against truth, else against the baseline, else
/// against Rapier.
fn caught_by(report: &CheckReport) -> Option<(&CaseCheck, &Comparison)> {
    let library = Library::Embedded;
    let bodies = |check: &CaseCheck| library.case(&check.case).unwrap().scene.bodies.len();
    let failing = |against: Against| {
        let checks = report.checks.iter().filter_map(|check| {
            let mut comparisons = check.comparisons.iter();
            let failed = |it: &&Comparison| it.against == against && it.held == Held::Fails;
            Some((check, comparisons.find(failed)?))
        });
        checks.min_by_key(|(check, _)| bodies(check))
    };
    let mut all = [Against::Truth, Against::Baseline, Against::Rapier].into_iter();
    all.find_map(failing)
}

/// The plain solver of these tests is the engine `lecture`, so its faults are faults of that.
#[test]
fn without_a_fault_the_plain_solver_has_the_lectures_bits_and_holds() {
    let report = checked(Fault::None);
    let other: Vec<_> = report
        .checks
        .iter()
        .filter(|check| !check.same_bits)
        .collect();
    assert!(other.is_empty(), "{other:#?}");
    assert!(report.holds);
}

/// The table of `docs/faults.md`, made anew.
fn table() -> String {
    let mut table = String::from(
        "# Faults that the check catches\n\n\
         Each is planted into the lecture's steps (`tests/it/faulty.rs`), and `carom check` must \
         notice. The table is\nmade by the test `every_fault_is_caught`; \
         `CAROM_BLESS=1 cargo test every_fault_is_caught` writes it anew.\n\n\
         | fault | caught by | on | how soon | cases that fail |\n|---|---|---|---|---|\n",
    );
    for fault in Fault::ALL {
        let report = checked(fault);
        let failed = report.checks.iter().filter(|check| !check.holds()).count();
        let (by, case, when) = match caught_by(&report) {
            None => ("nothing".to_owned(), "", String::new()),
            Some((check, comparison)) => {
                let row = comparison.rows.iter().find(|row| row.held == Held::Fails);
                let metric = row.map_or("", |row| row.metric.name());
                let when = comparison.first_at.map(|time| format!("t = {time} s"));
                (
                    format!("{}: {metric}", comparison.against.word()),
                    check.case.as_str(),
                    when.unwrap_or_default(),
                )
            }
        };
        writeln!(
            table,
            "| {} | {by} | `{case}` | {when} | {failed} of {} |",
            fault.name(),
            report.checks.len()
        )
        .unwrap();
    }
    table
}

/// Every fault fails, and the page says by what.
#[test]
fn every_fault_is_caught() {
    let table = table();
    println!("{table}");
    assert!(!table.contains("| nothing |"), "{table}");
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/faults.md");
    if std::env::var_os("CAROM_BLESS").is_some() {
        std::fs::write(page, &table).unwrap();
    }
    let stored = std::fs::read_to_string(page).unwrap();
    assert_eq!(stored, table, "docs/faults.md is out of date");
}

fn hand_written() -> Vec<EngineSpec> {
    let names = ["lecture", "exact-drag", "verlet", "swept", "swept-4"];
    names.map(|name| engine(name).unwrap()).to_vec()
}

/// Fifty times, with one thread to eight: the same report every time, and no alarm.
#[test]
fn fifty_runs_with_any_number_of_threads_raise_no_false_alarm() {
    let library = Library::Embedded;
    let names = [
        "shot-2-61",
        "cluster-8",
        "kepler-e06",
        "spring-chain",
        "rack-break",
    ];
    let cases: Vec<_> = names.map(|name| library.case(name).unwrap()).into();
    let specs = hand_written();
    let candidates: Vec<_> = specs.iter().map(|spec| Candidate::own(spec)).collect();
    let mut first = None;
    for run in 0..50 {
        // Fibonacci hashing: thread counts in no order.
        let threads = 1 + ((run * 2_654_435_769_usize) >> 7) % 8;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let report = pool
            .build()
            .unwrap()
            .install(|| check(&cases, &library, &candidates, &|_| {}).unwrap());
        assert!(report.holds, "run {run} with {threads} threads");
        assert!(report.checks.iter().all(|check| check.same_bits));
        assert_eq!(*first.get_or_insert_with(|| report.clone()), report);
    }
}

/// Who is nearer to truth than the lecture is not asked to be like it.
#[test]
fn a_better_solver_judged_as_the_lecture_never_fails() {
    let library = Library::Embedded;
    let cases: Vec<_> = library.names().unwrap();
    let cases: Vec<_> = cases
        .iter()
        .map(|name| library.case(name).unwrap())
        .collect();
    for name in ["swept", "swept-4", "adaptive"] {
        let spec = engine(name).unwrap();
        let candidate = Candidate::like(&spec, "lecture");
        let report = check(&cases, &library, &[candidate], &|_| {}).unwrap();
        let failed: Vec<_> = report
            .checks
            .iter()
            .filter(|check| !check.holds())
            .collect();
        assert!(failed.is_empty(), "{name}: {failed:#?}");
        assert!(
            report
                .checks
                .iter()
                .any(|check| { check.comparisons.iter().any(|it| it.held == Held::Excused) })
        );
    }
}
