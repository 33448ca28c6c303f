//! What a check found: for people, and for machines that read the XML of `JUnit`.

mod blessing;
mod junit;
pub(super) mod text;

pub use blessing::{blessing_text, write_blessing};
pub use junit::check_junit;
pub use text::{check_text, replay_text};
