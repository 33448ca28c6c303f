//! From errors to the digits that are claimed.

use super::parting::Parting;
use crate::recording::{Digits, Recording};

/// No more digits are claimed: the published numbers are doubles.
const DIGITS_MAX: f64 = 15.0;

/// Half an ulp of a double, relative.
const ROUNDING: f64 = 0.5 * f64::EPSILON;

/// The lengths and speeds against which digits count.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// Diagonal of the box of all positions.
    pub diagonal: f64,
    /// Largest speed.
    pub speed: f64,
    /// Largest distance from the origin.
    pub coordinate: f64,
}

impl Scale {
    pub fn of(recording: &Recording) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (mut speed, mut coordinate) = (0.0_f64, 0.0_f64);
        for state in recording.samples().flatten() {
            for axis in 0..3 {
                low[axis] = low[axis].min(state.position[axis]);
                high[axis] = high[axis].max(state.position[axis]);
            }
            speed = speed.max(state.velocity.norm());
            coordinate = coordinate.max(state.position.norm());
        }
        let sides = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        Self {
            diagonal: sides.iter().map(|side| side * side).sum::<f64>().sqrt(),
            speed,
            coordinate,
        }
    }

    /// Digits of a sample whose computed states are known up to these errors; the rounding to
    /// doubles is added.
    pub fn digits(&self, position: f64, velocity: f64) -> Digits {
        Digits {
            position: count(position, ROUNDING * self.coordinate, self.diagonal),
            velocity: count(velocity, ROUNDING * self.speed, self.speed),
        }
    }
}

/// Digits of every sample from its own errors; once a digit of a position is lost it does not come
/// back.
///
/// A velocity may differ at one sample alone, when an impact falls on it: the sample claims
/// nothing then, but its neighbours do. Shape: `[sample]`.
pub(super) fn claims(errors: &[Parting], scale: &Scale) -> Vec<Digits> {
    let (mut position, mut velocity) = (0.0_f64, 0.0_f64);
    let mut digits = Vec::with_capacity(errors.len());
    for (sample, own) in errors.iter().enumerate() {
        position = position.max(own.position);
        let around = &errors[sample.saturating_sub(1)..errors.len().min(sample + 2)];
        let lasting = around
            .iter()
            .fold(f64::INFINITY, |least, near| least.min(near.velocity));
        velocity = velocity.max(lasting);
        digits.push(scale.digits(position, velocity.max(own.velocity)));
    }
    digits
}

/// Whole digits of something of that size; what has no size and no error is known for good.
fn count(error: f64, rounding: f64, size: f64) -> u8 {
    let digits = if size == 0.0 && error == 0.0 {
        DIGITS_MAX
    } else {
        -((error + rounding) / size).log10()
    };
    if digits.is_nan() {
        return 0;
    }
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 15"
    )]
    let whole = digits.floor().clamp(0.0, DIGITS_MAX) as u8;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_count_from_the_size_and_nothing_unknown_has_any() {
        assert_eq!(count(1e-5, 0.0, 10.0), 6);
        assert_eq!(count(1.0, 0.0, 0.5), 0);
        assert_eq!(count(0.0, 1e-30, 1.0), 15);
        assert_eq!(count(f64::INFINITY, 0.0, 1.0), 0);
        assert_eq!(count(f64::NAN, 0.0, 1.0), 0);
        assert_eq!(count(0.0, 1e-16, 0.0), 15);
        assert_eq!(count(1e-20, 0.0, 0.0), 0);
    }
}
