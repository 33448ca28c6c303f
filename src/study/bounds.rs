//! How much a study may be asked to do. More is a slip of the pen: it would take days, and the
//! memory for it is taken at the start.

/// States of all recordings that a comparison holds, 48 bytes each: 580 MB. The recordings are
/// those of its voices and two more, by which `exact` certifies one.
pub(super) const STATES_COMPARED_MAX: usize = 12_000_000;

/// Samples of a comparison. Each costs, beside its states, up to 250 bytes a voice and 50 bytes a
/// pair of voices in metrics and in distances, and as much again while they are written.
pub(super) const SAMPLES_COMPARED_MAX: usize = 200_000;

/// Rounds of timing. Each keeps 8 bytes a job: 80 kB a job.
pub const REPETITIONS_MAX: usize = 10_000;

/// Later starts. Each keeps 300 bytes an engine and step of its ladder: 100 MB with all engines.
/// References are held for as many as there are threads.
pub const PHASES_MAX: usize = 1_000;

/// Runs of a search of settings. Each keeps some 300 bytes: 30 MB.
pub const RUNS_MAX: usize = 100_000;

/// Counted work of a run: an hour and more of computing. It takes no memory.
pub const BUDGET_MAX: u64 = 1_000_000_000_000;
