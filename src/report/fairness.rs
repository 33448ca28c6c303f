//! The tables of `docs/fairness.md`, from what the engines say of themselves.

use super::format::code;
use crate::engine::{EngineSpec, RAPIER_HANDLING, engines};
use crate::scene::Effect;

/// A table in Markdown.
fn table(header: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule = format!("|{}\n", "---|".repeat(header.len()));
    let rows: String = rows.iter().map(|row| line(row)).collect();
    format!("{}{rule}{rows}", line(header))
}

fn supports(spec: &EngineSpec) -> Vec<String> {
    let cell = |effect: &Effect| match spec.support(*effect) {
        (support, "") => support.words().to_owned(),
        (support, note) => format!("{}: {note}", support.words()),
    };
    Effect::ALL.iter().map(cell).collect()
}

/// Who computes each effect, a column for engines that do all in the same way.
#[must_use]
pub fn support_table() -> String {
    let mut columns: Vec<(Vec<String>, Vec<String>)> = Vec::new();
    for spec in engines() {
        let own = supports(&spec);
        let name = code(&spec.name);
        match columns.iter_mut().find(|(_, cells)| *cells == own) {
            Some((names, _)) => names.push(name),
            None => columns.push((vec![name], own)),
        }
    }
    let names = columns.iter().map(|(names, _)| names.join(", "));
    let header: Vec<_> = ["effect".to_owned()].into_iter().chain(names).collect();
    let row = |(place, effect): (usize, &Effect)| {
        let cells = columns.iter().map(|(_, cells)| cells[place].clone());
        [effect.name().to_owned()]
            .into_iter()
            .chain(cells)
            .collect()
    };
    let rows: Vec<Vec<String>> = Effect::ALL.iter().enumerate().map(row).collect();
    table(&header, &rows)
}

/// What carom does to Rapier and for it.
#[must_use]
pub fn handling_table() -> String {
    let header = ["what carom does", "why", "how to change it"].map(str::to_owned);
    let row = |handling: &crate::engine::Handling| {
        [handling.what, handling.why, handling.change]
            .map(str::to_owned)
            .to_vec()
    };
    table(
        &header,
        &RAPIER_HANDLING.iter().map(row).collect::<Vec<_>>(),
    )
}
