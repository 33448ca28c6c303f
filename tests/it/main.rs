//! All integration tests, in one binary.
#![allow(missing_docs, clippy::float_cmp)]

mod oracle;
