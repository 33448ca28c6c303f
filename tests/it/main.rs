//! All integration tests, in one binary.
#![allow(missing_docs, clippy::float_cmp, clippy::pedantic)]

mod bad_input;
mod bits;
#[cfg(unix)]
mod bounded;
mod budget;
mod cases;
mod check;
mod closed_forms;
mod command;
mod command_line;
mod controls;
mod departures;
#[cfg(feature = "drift")]
mod drift;
mod effects;
mod exact_flight;
mod exact_forces;
mod exact_lies;
mod exact_ties;
mod example_solvers;
#[cfg(unix)]
mod external;
mod fairness;
mod faults;
mod faulty;
#[cfg(feature = "rapier")]
mod geometry;
mod hard;
mod hostile;
mod invariants;
mod layers;
mod ledger;
mod limits;
mod mutants;
mod options;
mod oracle;
mod orders;
mod outputs;
mod own_truth;
mod pages;
mod plain_loop;
mod plan;
#[cfg(feature = "rapier")]
mod rapier;
mod robust;
mod robust_matrix;
mod robust_safeguards;
mod scenes;
mod shown;
mod slips;
mod stability;
mod studies;
#[cfg(feature = "rapier")]
mod swept_times;
mod taylor_faults;
mod tuning;
