//! The numbers that a Rapier world of one precision computes with.

use crate::engine::Precision;
use crate::error::{Error, Result};

/// Rapier takes the inverse of a number up to this for zero.
///
/// Rapier 0.36: `INV_EPSILON` in `utils/mod.rs`, in both precisions.
const INVERTIBLE_MIN: f64 = 1e-20;

/// Masses from here on cannot be inverted back: a contact of two of them transfers nothing and
/// gravity does not act on one, without a word.
const MASS_MAX: f64 = 1.0 / INVERTIBLE_MIN;

/// Bounds of a precision: numbers whose squares neither vanish nor overflow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    precision: Precision,
    /// Below, a square is no longer a normal number.
    smallest: f64,
    /// Above, a square is infinite.
    largest: f64,
    /// Smallest mass whose inverse is finite.
    mass_min: f64,
    /// Spacing of numbers at 1.
    pub epsilon: f64,
}

impl Range {
    /// 32 bits.
    pub const SINGLE: Self = Self {
        precision: Precision::Single,
        smallest: 1.1e-19,
        largest: 1.8e19,
        mass_min: f32::MIN_POSITIVE as f64,
        epsilon: f32::EPSILON as f64,
    };
    /// 64 bits.
    pub const DOUBLE: Self = Self {
        precision: Precision::Double,
        smallest: 1.5e-154,
        largest: 1.3e154,
        mass_min: f64::MIN_POSITIVE,
        epsilon: f64::EPSILON,
    };

    /// The range of a precision.
    pub fn of(precision: Precision) -> Self {
        match precision {
            Precision::Single => Self::SINGLE,
            Precision::Double => Self::DOUBLE,
        }
    }

    /// Whether the square of a length or speed is finite; not for what is not a number.
    pub fn holds(&self, length: f64) -> bool {
        length <= self.largest
    }

    /// Refuses a number whose square vanishes or overflows.
    pub fn positive(&self, field: &str, value: f64) -> Result<()> {
        if value < self.smallest {
            return Err(self.cannot(field, value, &format!("at least {:.1e}", self.smallest)));
        }
        self.at_most(field, value)
    }

    /// Refuses a number whose square overflows.
    pub fn at_most(&self, field: &str, value: f64) -> Result<()> {
        // A quotient such as k/m may have overflowed to infinity: that is refused too.
        if self.holds(value.abs()) {
            return Ok(());
        }
        Err(self.cannot(field, value, &format!("at most {:.1e}", self.largest)))
    }

    /// Refuses a mass without a usable inverse.
    pub fn mass(&self, field: &str, value: f64, inverse_matters: bool) -> Result<()> {
        if value < self.mass_min {
            return Err(self.cannot(field, value, &format!("at least {:.1e}", self.mass_min)));
        }
        if inverse_matters && value >= MASS_MAX {
            return Err(self.cannot(field, value, &format!("below {MASS_MAX:.0e}")));
        }
        self.at_most(field, value)
    }

    /// Refuses a spring that is too weak to be inverted. `softness` is `h (h k + kd)`, kg.
    pub fn spring(&self, index: usize, softness: f64) -> Result<()> {
        if softness > 2.0 * INVERTIBLE_MIN {
            return Ok(());
        }
        let field = format!("h (h k + kd) of effects.springs[{index}]");
        Err(self.cannot(&field, softness, &format!("above {INVERTIBLE_MIN:e}")))
    }

    fn cannot(&self, field: &str, value: f64, bound: &str) -> Error {
        let (engine, other) = match self.precision {
            Precision::Single => (
                "rapier3d (32-bit numbers)",
                ", or take the engine `rapier-f64`",
            ),
            Precision::Double => ("rapier3d-f64", ""),
        };
        Error::EngineCannot {
            engine,
            what: format!("{field} is {value:e}"),
            remedy: format!("make it {bound}, by other units for example{other}"),
        }
    }
}
