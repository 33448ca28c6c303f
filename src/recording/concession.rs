//! What an engine gave up to go on where others would have failed.

use std::fmt;

use serde::Serialize;

/// Something given up, and how often.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Concession {
    /// What.
    pub kind: ConcessionKind,
    /// How often.
    pub count: u64,
}

/// What can be given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ConcessionKind {
    /// A step was longer than a force asks for: the places are less accurate than stated.
    LongStep,
    /// The forces of a step found no end that they lead to, and velocities were turned back.
    TurnedBack,
    /// Endless impacts of one instant were cut short: their restitution was taken as 0.
    CutShort,
    /// Spheres overlap that there is no room for.
    Jammed,
    /// No pushes were found that keep surfaces in touch: they part or sink in by more than what
    /// counts as touching.
    Loose,
    /// A sample breaks a law of the model by more than the digits that were certified allow: from
    /// there on none are claimed.
    BrokenLaw,
}

impl fmt::Display for Concession {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.kind {
            ConcessionKind::LongStep => "steps longer than the forces ask for",
            ConcessionKind::TurnedBack => "steps whose forces lead nowhere, turned back",
            ConcessionKind::CutShort => "instants of endless impacts cut short",
            ConcessionKind::Jammed => "overlaps that there is no room to resolve",
            ConcessionKind::BrokenLaw => {
                "samples at the end without a digit, the first of which breaks a law of the model \
                 (no overlap, energy, momentum)"
            }
            ConcessionKind::Loose => "steps in which surfaces in touch were not kept so",
        };
        write!(f, "{} {what}", self.count)
    }
}
