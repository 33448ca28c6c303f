//! The numerical choices of the integrator.

/// How accurately the motion is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Highest power of time in a step's series; at least 4.
    pub order: usize,
    /// Order of the series that is tried first after an event; at least 4.
    pub short_order: usize,
    /// Share of the step that the tolerance allows.
    pub step: f64,
    /// Truncation of a step, relative to what changes in it.
    pub tolerance: f64,
    /// A bounce that would rise less than this share of the sum of the radii is none: the pair
    /// stays in contact. In approach speed: `sqrt(2 bounce_height (r_a + r_b) a)/e`, a being the
    /// acceleration that presses the pair together.
    pub bounce_height: f64,
}

impl Accuracy {
    /// For doubles: truncation below their rounding.
    ///
    /// Measured on a hundred revolutions of e = 0.9 (`benches/exact_forces.rs`), energy error
    /// and passes over the force law: order 24 at 1e-18, 3.0e-14 and 123 thousand; 26 at 1e-19,
    /// 1.2e-14 and 128; 28 at 1e-19, 9.5e-15 and 123; 28 at 1e-20, 9.3e-15 and 134. Bounces
    /// lower than 1e-13 drown in the rounding of positions.
    pub const FAST: Self = Self {
        order: 28,
        short_order: 8,
        step: 1.0,
        tolerance: 1e-19,
        bounce_height: 1e-13,
    };

    /// For double-double numbers: not all their digits are needed, twenty-four leave eight to
    /// lose to chaos. The order is high because passes over the force law fall with it.
    pub const WIDE: Self = Self {
        order: 48,
        short_order: 8,
        step: 1.0,
        tolerance: 1e-24,
        bounce_height: 1e-24,
    };

    /// The second computation that certifies [`FAST`](Self::FAST): other orders, another tolerance,
    /// shorter steps, half the threshold of speed.
    ///
    /// The steps differ so that a step too long for one order's last terms is too long by another
    /// factor in the other: a truncation that both shared could not be seen. 0.85 to the power of
    /// the order is 0.02 and less.
    pub const FAST_AGAIN: Self = Self {
        order: 24,
        short_order: 11,
        step: 0.85,
        tolerance: 1e-18,
        bounce_height: 0.25e-13,
    };

    /// The second computation that certifies [`WIDE`](Self::WIDE): as
    /// [`FAST_AGAIN`](Self::FAST_AGAIN).
    pub const WIDE_AGAIN: Self = Self {
        order: 37,
        short_order: 11,
        step: 0.85,
        tolerance: 1e-23,
        bounce_height: 0.25e-24,
    };
}

/// The least bounce once another order of simultaneous impacts would have given another answer.
///
/// The model has no single answer there, so that nothing is lost by ending bounces sooner, as
/// long as their height stays far below what the other orders lead to: centimetres to metres in
/// the clusters of eight and thirty. The latter settles in 4 s of doubles (1e-6: 6 s; 1e-13:
/// minutes).
pub(super) const UNDETERMINED_BOUNCE_HEIGHT: f64 = 1e-5;
