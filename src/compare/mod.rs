//! Two or more recordings of one scene: conserved quantities, divergence, events in order.

mod cluster;
mod divergence;
mod events;
mod horizon;
mod limit;
mod metrics;
mod sizes;
mod verdict;

pub use cluster::{ClusterFacts, TOUCHING, cluster_facts};
pub use divergence::{Divergence, DivergenceSample};
pub use events::{Disagreement, EventAgreement, compare_events};
pub use horizon::horizon;
pub use limit::{Estimate, Limit, Remainder};
pub use metrics::{Drift, Metrics, metrics};
pub use sizes::Sizes;
pub use verdict::{RIGHT_WITHIN, Verdict};
