//! The command of a user's solver: its words, and the placeholders in them.

use std::ffi::OsString;

use crate::error::{Error, Result};

/// What an argument may ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Placeholder {
    /// Path of the scene file.
    Scene,
    /// Path of the table of bodies.
    Bodies,
    /// Path of the table of effects.
    Effects,
    /// The step, s.
    Dt,
    /// Path where the trajectory is to be written.
    Out,
}

impl Placeholder {
    const ALL: [Self; 5] = [
        Self::Scene,
        Self::Bodies,
        Self::Effects,
        Self::Dt,
        Self::Out,
    ];

    /// How it is written.
    pub fn text(self) -> &'static str {
        match self {
            Self::Scene => "{scene}",
            Self::Bodies => "{bodies}",
            Self::Effects => "{effects}",
            Self::Dt => "{dt}",
            Self::Out => "{out}",
        }
    }
}

/// A piece of an argument.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Piece {
    Text(String),
    Place(Placeholder),
}

/// A program with its arguments.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SolverCommand {
    pub program: String,
    /// Shape: `[argument][piece]`.
    arguments: Vec<Vec<Piece>>,
}

impl SolverCommand {
    /// Splits a command as a shell does; placeholders are looked for afterwards, so that what is
    /// put in their place is never split.
    pub fn parse(command: &str) -> Result<Self> {
        let wrong = |remedy: &str| Error::Argument {
            argument: "solver",
            found: format!("'{command}'"),
            remedy: remedy.to_owned(),
        };
        let Some(words) = shlex::split(command) else {
            return Err(wrong(
                "a quote stays open, or nothing follows the last `\\`",
            ));
        };
        let mut words = words.into_iter();
        let Some(program) = words.next().filter(|program| !program.is_empty()) else {
            return Err(wrong(
                "no program is named; give a command such as 'python3 solver.py {bodies} {effects} {out}'",
            ));
        };
        let arguments = words.map(|word| pieces(&word)).collect();
        Ok(Self { program, arguments })
    }

    /// Whether any argument holds this placeholder.
    pub fn asks_for(&self, placeholder: Placeholder) -> bool {
        let is_asked = |piece: &Piece| *piece == Piece::Place(placeholder);
        self.arguments.iter().flatten().any(is_asked)
    }

    /// The arguments with something in place of the placeholders.
    pub fn arguments(&self, fill: impl Fn(Placeholder) -> OsString) -> Vec<OsString> {
        let piece = |piece: &Piece| match piece {
            Piece::Text(text) => text.into(),
            Piece::Place(placeholder) => fill(*placeholder),
        };
        let arguments = self.arguments.iter();
        arguments
            .map(|pieces| pieces.iter().map(piece).collect())
            .collect()
    }
}

/// The pieces of an argument, in order. Braces that are no placeholder are text.
fn pieces(mut argument: &str) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let next = |argument: &str| {
        let found = Placeholder::ALL.map(|it| argument.find(it.text()).map(|at| (at, it)));
        found.into_iter().flatten().min_by_key(|(at, _)| *at)
    };
    while let Some((at, placeholder)) = next(argument) {
        if at > 0 {
            pieces.push(Piece::Text(argument[..at].to_owned()));
        }
        pieces.push(Piece::Place(placeholder));
        argument = &argument[at + placeholder.text().len()..];
    }
    if !argument.is_empty() {
        pieces.push(Piece::Text(argument.to_owned()));
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(command: &str) -> Vec<String> {
        let fill = |placeholder| match placeholder {
            Placeholder::Dt => "0.01".into(),
            Placeholder::Out => "/tmp/a b/{dt}".into(),
            Placeholder::Scene | Placeholder::Bodies | Placeholder::Effects => "x".into(),
        };
        let command = SolverCommand::parse(command).unwrap();
        let arguments = command.arguments(fill).into_iter();
        arguments.map(|it| it.into_string().unwrap()).collect()
    }

    #[test]
    fn placeholders_stand_anywhere_in_an_argument_and_are_filled_once() {
        assert_eq!(
            filled("p --dt={dt} '{out}:{dt}:' {}x{y} \"\""),
            ["--dt=0.01", "/tmp/a b/{dt}:0.01:", "{}x{y}", ""]
        );
    }

    #[test]
    fn quotes_keep_words_together() {
        let command = SolverCommand::parse("'my solver' a\\ b \"c d\"").unwrap();
        assert_eq!(command.program, "my solver");
        assert_eq!(filled("p a\\ b \"c d\""), ["a b", "c d"]);
    }

    #[test]
    fn what_is_asked_for_is_known() {
        let command = SolverCommand::parse("p --out={out}").unwrap();
        assert!(command.asks_for(Placeholder::Out));
        assert!(!command.asks_for(Placeholder::Scene));
    }

    #[test]
    fn a_command_that_is_none_is_told() {
        let table = [
            ("", "no program is named"),
            (" \t", "no program is named"),
            ("''", "no program is named"),
            ("python3 'solver.py {out}", "a quote stays open"),
            ("python3 \"solver.py", "a quote stays open"),
        ];
        for (command, said) in table {
            let wrong = SolverCommand::parse(command).unwrap_err().to_string();
            assert!(
                wrong.starts_with("--solver '") && wrong.contains(said),
                "{wrong}"
            );
        }
    }
}
