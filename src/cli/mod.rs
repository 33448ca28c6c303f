//! The command line: clap types, one file a subcommand.

mod args;
mod bodies;
mod check;
mod cost;
#[cfg(feature = "drift")]
mod drift;
mod effects;
mod output;
mod plan;
mod refusals;
mod report;
mod run;
mod scenes;
mod stability;
mod studies;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::error::{Error, Result};

/// Runs a lecture's impulse solver and Rapier side by side on the same scenes: how far do they
/// part, why, and at what price?
#[derive(Debug, Parser)]
#[command(name = "carom", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run every case on every engine and write the comparison: tables, pictures, pages
    Report(report::Args),
    /// Run one scene on some engines and write what they did
    Run(run::Args),
    /// Run scenes on every engine over a ladder of steps, or a gas of more and more bodies: what
    /// does accuracy cost in time?
    Cost(cost::Args),
    /// Run hard cases on every engine and step: which engine survives what?
    Stability(stability::Args),
    /// Hold solvers against truth, their own stored recordings and Rapier's: exit code 1 if one no
    /// longer agrees
    Check(check::Args),
    /// Measure published versions of Rapier side by side: exit code 1 if one gives other results
    /// than are known of it
    #[cfg(feature = "drift")]
    Drift(drift::Args),
    /// Print what each engine does in a step of a scene, and nothing else does it
    Plan(plan::Args),
    /// Switch each effect of a scene, one at a time: what it costs, and what it changes
    Effects(effects::Args),
    /// List, show, start or generate scenes
    Scenes(scenes::Args),
}

/// Parses the arguments and does what they say; gives the exit code.
///
/// Exit 0: done (a blow-up is a result, with a warning). Exit 1: a check failed. Exit 2: could not
/// run, with one line.
#[must_use]
pub fn main() -> std::process::ExitCode {
    let done = parsed().and_then(|cli| {
        output::tidy_up_on_interrupt()?;
        dispatch(cli.command)
    });
    match done {
        Ok(true) => std::process::ExitCode::SUCCESS,
        Ok(false) => std::process::ExitCode::from(1),
        Err(error) => {
            output::complain(&error);
            std::process::ExitCode::from(2)
        }
    }
}

/// What the command line says; help and version are printed here, and end the program.
fn parsed() -> Result<Cli> {
    let mut command = Cli::command();
    command.build();
    let matches = command
        .clone()
        .try_get_matches()
        .map_err(|wrong| refused(&wrong))?;
    refusals::refuse_idle(&matches, &command)?;
    Cli::from_arg_matches(&matches).map_err(|wrong| refused(&wrong))
}

/// What clap says of a command line that it does not take, in one line.
fn refused(wrong: &clap::Error) -> Error {
    use clap::error::ErrorKind::{
        DisplayHelp, DisplayHelpOnMissingArgumentOrSubcommand, DisplayVersion,
    };
    let kind = wrong.kind();
    if [
        DisplayHelp,
        DisplayHelpOnMissingArgumentOrSubcommand,
        DisplayVersion,
    ]
    .contains(&kind)
    {
        // Nothing of the user's stands in it.
        wrong.exit();
    }
    let text = wrong.render().to_string();
    let (what, rest) = text.split_once("\n\nUsage: ").unwrap_or((&text, ""));
    let what = what.strip_prefix("error: ").unwrap_or(what);
    let what = what
        .split_once("\n\nFor more information")
        .map_or(what, |(what, _)| what);
    let words: Vec<&str> = what.split_whitespace().collect();
    let what = words.join(" ").replace(" tip: ", "; ");
    let usage = rest.lines().next().unwrap_or_default();
    let message = match usage {
        "" => format!("{what}; --help shows what there is"),
        usage => format!("{what}; usage: {usage}"),
    };
    Error::Usage { message }
}

/// Whether all that was to be checked holds.
fn dispatch(command: Command) -> Result<bool> {
    match command {
        Command::Report(args) => report::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Cost(args) => cost::run(&args),
        Command::Stability(args) => stability::run(&args),
        Command::Check(args) => return check::run(&args),
        #[cfg(feature = "drift")]
        Command::Drift(args) => return drift::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Effects(args) => effects::run(&args),
        Command::Scenes(args) => scenes::run(&args),
    }
    .map(|()| true)
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        super::Cli::command().debug_assert();
    }
}
