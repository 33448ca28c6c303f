//! All integration tests, in one binary.
#![allow(missing_docs, clippy::float_cmp)]

#[cfg(feature = "rapier")]
mod geometry;
mod oracle;
#[cfg(feature = "rapier")]
mod rapier;
