//! The `exact` engine: the continuous-time model of DESIGN.md, solved event by event.
//!
//! [`forces`] computes scenes with attraction or springs.

pub mod forces;
