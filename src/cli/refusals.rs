//! Options that would do nothing where they stand are refused: what clap cannot tell, since it
//! knows neither values nor which engines take steps, and names only half of it.

use std::collections::BTreeMap;

use clap::ArgMatches;
use clap::parser::ValueSource;

use crate::case::is_scene_file;
use crate::engine::{EngineSpec, engine};
use crate::error::{Error, Result};

/// An option that does nothing under a condition.
struct Rule {
    /// Words of the command, without `carom`.
    command: &'static str,
    option: &'static str,
    idle: Idle,
}

/// When an option does nothing.
#[derive(Clone, Copy)]
enum Idle {
    /// Without this other option.
    Without(&'static str),
    /// Beside this other option.
    With(&'static str),
    /// Beside this other option of this value.
    WithValue(&'static str, &'static str),
    /// If nobody whom the line names would heed it; the words say why, and what would be right.
    If(fn(&Given) -> bool, &'static str, &'static str),
}

/// What stands on the command line itself, by the long names of options and the names of values;
/// defaults are not in it.
struct Given {
    command: String,
    values: BTreeMap<String, Vec<String>>,
}

const fn without(command: &'static str, option: &'static str, other: &'static str) -> Rule {
    rule(command, option, Idle::Without(other))
}

const fn with(command: &'static str, option: &'static str, other: &'static str) -> Rule {
    rule(command, option, Idle::With(other))
}

const fn with_value(
    command: &'static str,
    option: &'static str,
    other: &'static str,
    value: &'static str,
) -> Rule {
    rule(command, option, Idle::WithValue(other, value))
}

const fn rule(command: &'static str, option: &'static str, idle: Idle) -> Rule {
    Rule {
        command,
        option,
        idle,
    }
}

const NO_STEPS: Idle = Idle::If(
    nobody_takes_steps,
    "for engines that take no steps",
    "leave it out, or name an engine that takes steps",
);

const SCENE_FILES: Idle = Idle::If(
    no_case_is_named,
    "beside scene files alone",
    "leave it out, or name a case of the folder",
);

const NO_SEARCH: Idle = Idle::If(
    nobody_is_searched,
    "for engines whose settings are not searched",
    "leave it out, name an engine of Rapier, or add --tune-on",
);

const NO_JITTER: Idle = Idle::If(
    no_ball_is_moved,
    "where no ball is moved",
    "leave it out, or give a --jitter above 0",
);

const RULES: [Rule; 43] = [
    rule("report", "dt", NO_STEPS),
    rule("run", "dt", NO_STEPS),
    rule("plan", "dt", NO_STEPS),
    rule("effects", "dt", NO_STEPS),
    rule("cost", "dt", NO_STEPS),
    rule("run", "reference", SCENE_FILES),
    rule("plan", "reference", SCENE_FILES),
    rule("effects", "reference", SCENE_FILES),
    rule("cost", "reference", SCENE_FILES),
    without("cost", "dt", "bodies"),
    without("cost", "filling", "bodies"),
    without("cost", "open", "bodies"),
    without("cost", "join", "bodies"),
    with("cost", "tune-on", "bodies"),
    with("cost", "runs", "bodies"),
    with("cost", "phases", "bodies"),
    with("cost", "reference", "bodies"),
    rule("cost", "runs", NO_SEARCH),
    rule("cost", "phases", NO_STEPS),
    without("check", "limit", "solver"),
    without("check", "widen", "bless"),
    with("check", "verbose", "quiet"),
    with_value("check", "verbose", "format", "json"),
    with_value("check", "verbose", "format", "junit"),
    with("check", "verbose", "replay"),
    with("check", "verbose", "digests"),
    with("check", "verbose", "bless"),
    with_value("check", "quiet", "format", "json"),
    with_value("check", "quiet", "format", "junit"),
    with("check", "quiet", "replay"),
    with("check", "quiet", "digests"),
    with("check", "quiet", "bless"),
    with("check", "like", "replay"),
    with("check", "like", "digests"),
    with("check", "format", "digests"),
    with("check", "format", "bless"),
    rule(
        "check",
        "format",
        Idle::If(
            is_junit_of_a_replay,
            "with --replay, which has no such form",
            "leave it out, or ask for text or json",
        ),
    ),
    with("check", "limit", "replay"),
    with("check", "limit", "trajectory"),
    with("check", "solver", "replay"),
    with("check", "trajectory", "replay"),
    rule("scenes generate rack", "seed", NO_JITTER),
    without("scenes generate", "force", "out"),
];

fn engines(given: &Given) -> Option<Vec<EngineSpec>> {
    let names = given.values.get("engine")?.iter();
    let names = names.flat_map(|names| names.split(','));
    // A name that is none is told where the engines are made.
    names.map(|name| engine(name.trim()).ok()).collect()
}

fn nobody_takes_steps(given: &Given) -> bool {
    let tunes = given.values.contains_key("tune-on");
    !tunes && engines(given).is_some_and(|specs| !specs.iter().any(EngineSpec::takes_steps))
}

fn nobody_is_searched(given: &Given) -> bool {
    let tunes = given.values.contains_key("tune-on");
    let searched = crate::study::cost::is_searched;
    !tunes && engines(given).is_some_and(|specs| !specs.iter().any(searched))
}

fn no_case_is_named(given: &Given) -> bool {
    let mut named = ["scene", "scenes", "tune-on"]
        .iter()
        .filter_map(|key| given.values.get(*key))
        .flatten()
        .flat_map(|names| names.split(','))
        .peekable();
    named.peek().is_some() && named.all(is_scene_file)
}

fn no_ball_is_moved(given: &Given) -> bool {
    let jitter = given.values.get("jitter").and_then(|values| values.last());
    jitter.is_none_or(|jitter| jitter.parse() == Ok(0.0))
}

fn is_junit_of_a_replay(given: &Given) -> bool {
    given.values.contains_key("replay") && given.is("format", "junit")
}

impl Given {
    fn of(matches: &ArgMatches, command: &clap::Command) -> Self {
        let (mut matches, mut command) = (matches, command);
        let mut words = Vec::new();
        while let Some((word, below)) = matches.subcommand() {
            let Some(found) = command.find_subcommand(word) else {
                break;
            };
            words.push(word);
            (matches, command) = (below, found);
        }
        let mut values = BTreeMap::new();
        for argument in command.get_arguments() {
            let id = argument.get_id().as_str();
            if matches.value_source(id) == Some(ValueSource::CommandLine) {
                let raw = matches.get_raw(id).into_iter().flatten();
                let raw = raw.map(|value| value.to_string_lossy().into_owned());
                let name = argument.get_long().unwrap_or(id);
                values.insert(name.to_owned(), raw.collect());
            }
        }
        Self {
            command: words.join(" "),
            values,
        }
    }

    fn is(&self, option: &str, value: &str) -> bool {
        let values = self.values.get(option);
        values.is_some_and(|values| values.iter().any(|given| given == value))
    }
}

impl Rule {
    fn refusal(&self, given: &Given) -> Option<Error> {
        let option = self.option;
        let is_of_command = given.command == self.command
            || given
                .command
                .strip_prefix(self.command)
                .is_some_and(|below| below.starts_with(' '));
        if !is_of_command || !given.values.contains_key(option) {
            return None;
        }
        let (place, remedy) = match self.idle {
            Idle::Without(other) if !given.values.contains_key(other) => (
                format!("without --{other}"),
                format!("add --{other}, or leave --{option} out"),
            ),
            Idle::With(other) if given.values.contains_key(other) => (
                format!("with --{other}"),
                format!("leave --{option} or --{other} out"),
            ),
            Idle::WithValue(other, value) if given.is(other, value) => (
                format!("with --{other} {value}"),
                format!("leave --{option} or --{other} out"),
            ),
            Idle::If(holds, place, remedy) if holds(given) => (place.to_owned(), remedy.to_owned()),
            Idle::Without(_) | Idle::With(_) | Idle::WithValue(..) | Idle::If(..) => return None,
        };
        Some(Error::Idle {
            option,
            place,
            remedy,
        })
    }
}

/// Refuses the first option that would do nothing.
///
/// # Errors
/// [`Error::Idle`], which names it and what would be right.
pub(super) fn refuse_idle(matches: &ArgMatches, command: &clap::Command) -> Result<()> {
    let given = Given::of(matches, command);
    let refused = RULES.iter().find_map(|rule| rule.refusal(&given));
    refused.map_or(Ok(()), Err)
}
