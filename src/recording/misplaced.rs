//! Which row should have stood where another one does: missing, doubled, out of order, of no
//! body, of no sample, or past the end.

use std::io::Read;

use super::bounds::ROWS_AHEAD_MAX;
use super::table::Table;
use super::trajectory_csv::{body, is_at, time};
use crate::error::{Error, Result, number, quoted};
use crate::scene::Scene;

/// Names that a message lists, at most.
const NAMES_MAX: usize = 8;

/// The row that is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Due {
    pub sample: usize,
    pub body: usize,
}

/// What is wrong with the present row, which is not the one that is due. Reads on: whether the
/// row that is due still comes tells a missing one from another order.
pub(super) fn misplaced<R: Read>(
    table: &mut Table<'_, R>,
    scene: &Scene,
    due: Due,
) -> Result<Error> {
    let here = table.place();
    if due.sample > scene.sample_count() {
        let message = format!("goes on past the end, t = {} s", number(scene.duration));
        return Ok(here.wrong(message));
    }
    let found = time(table)?;
    let due_name = &scene.bodies[due.body].name;
    let (found_time, due_time) = (number(found), number(scene.sample_time(due.sample)));
    let Some(found_body) = scene.body_index(body(table)) else {
        let message = format!(
            "body `{}` where `{due_name}` of t = {due_time} s is due: no body is called so; \
             the scene has {}",
            quoted(body(table)),
            names(scene)
        );
        return Ok(here.wrong(message));
    };
    let name = &scene.bodies[found_body].name;
    let Some(found_sample) = sample_at(scene, found) else {
        let message = format!(
            "time {} s where {due_time} s is due: off the scene's grid, a sample every {} s up to {} s",
            quoted(table.text(0)),
            number(scene.sample_every),
            number(scene.duration)
        );
        return Ok(here.wrong(message));
    };
    // Every row before the one that is due has been read.
    let message = if found_sample < due.sample {
        format!(
            "time {found_time} s where {due_time} s is due: body `{name}` of t = {found_time} s comes a second time"
        )
    } else if found_sample == due.sample && found_body < due.body {
        format!(
            "body `{name}` of t = {found_time} s comes a second time, where `{due_name}` of t = {due_time} s is due"
        )
    } else if comes_later(table, scene, due) {
        format!(
            "out of order: body `{name}` of t = {found_time} s comes before `{due_name}` of t = {due_time} s; \
             samples in order of time, and in each a row a body, in the scene's order"
        )
    } else {
        format!(
            "a row is missing: body `{due_name}` of t = {due_time} s is due, and `{name}` of t = {found_time} s follows"
        )
    };
    Ok(here.wrong(message))
}

/// Whether a row stands in what follows in a table. A row that cannot be read ends the search.
fn comes_later<R: Read>(table: &mut Table<'_, R>, scene: &Scene, due: Due) -> bool {
    for _ in 0..ROWS_AHEAD_MAX {
        if !table.advance().unwrap_or(false) {
            return false;
        }
        let is_due = body(table) == scene.bodies[due.body].name
            && time(table).is_ok_and(|time| is_at(scene, due.sample, time));
        if is_due {
            return true;
        }
    }
    false
}

/// The sample that stands at a time, if one does.
fn sample_at(scene: &Scene, time: f64) -> Option<usize> {
    let nearest = (time / scene.sample_every).round();
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a cast past the ends of usize saturates, and no sample is there"
    )]
    let sample = nearest as usize;
    (sample <= scene.sample_count() && is_at(scene, sample, time)).then_some(sample)
}

fn names(scene: &Scene) -> String {
    let quoted = scene.bodies.iter().map(|body| format!("`{}`", body.name));
    let first: Vec<_> = quoted.take(NAMES_MAX).collect();
    let count = scene.bodies.len();
    if count > NAMES_MAX {
        format!("{} … ({count} in all)", first.join(", "))
    } else {
        first.join(", ")
    }
}
