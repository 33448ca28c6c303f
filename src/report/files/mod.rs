//! The manager of files: the result in a folder is the old one or the new one, never a mix.
//!
//! A run opens its [`Output`], which locks the folder and stages every file in a hidden folder
//! inside it. [`Output::commit`] puts all of them in place by renaming. Each summary lists the
//! files beside it with their digests; only files that are listed and unchanged are replaced or
//! removed by a later run.

mod journal;
mod listing;
mod output;
mod single;
mod stage;

pub use output::{Folder, Output, Replace};
pub use single::write_file;
pub use stage::remove_unfinished;

/// The file of a result that lists the others; it is put in place last.
const SUMMARY: &str = "summary.json";

/// The folder of a result that is not complete yet; the complete result removes it.
const UNFINISHED: &str = "unfinished";
