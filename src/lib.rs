//! carom runs a lecture's hand-written impulse solver and an equivalent Rapier world side by
//! side on the same billiards and gravity scenes: how far do they part, why, and at what price?
//!
//! The way of the data, one direction only:
//!
//! ```text
//! scene file --> Scene --> plan --> engine --> Recording --> comparison --> study --> CSV, PNG, pages
//! ```
//!
//! Each module imports only from those above it in this list: [`error`], `input`, [`scene`],
//! [`physics`], [`recording`], [`engine`], [`case`], [`compare`], [`study`],
//! [`report`], [`cli`].

pub mod case;
pub mod cli;
pub mod compare;
pub mod engine;
pub mod error;
mod input;
pub mod physics;
pub mod recording;
pub mod report;
pub mod scene;
pub mod study;
