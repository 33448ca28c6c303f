//! The first time at which a polynomial falls through zero, without skipping a root.
//!
//! In Bernstein form on [0, 1] the coefficients enclose the polynomial and have at least as
//! many sign changes as it has roots, and of equal parity (variation diminishing): no sign
//! change, no root; one, exactly one root. Anything else is halved (de Casteljau) and asked
//! again, the left half first.

use super::scalar::Real;
use super::series::as_real;

/// Halvings before a graze counts as no crossing: its depth is then below 2^-100 of the
/// polynomial's range, beyond any approach.
const DEPTH_MAX: u32 = 50;

/// Where a polynomial first goes from positive to negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fall {
    /// Nowhere on [0, 1].
    Never,
    /// Once between these two.
    Within(f64, f64),
    /// Numbers drown in the noise.
    Unclear,
}

/// A bracket of the first root at which the polynomial goes from positive to negative.
///
/// `coefficients` of powers of u; the search is on 0 <= u <= 1. A polynomial that starts below
/// zero is followed from where it has come up. `noise` is the error of a value of the polynomial:
/// with one, a decision that hangs on less is none.
pub(super) fn first_fall<T: Real>(coefficients: &[T], noise: f64) -> Fall {
    let Some((first, rest)) = coefficients.split_first() else {
        return Fall::Never;
    };
    let fall: f64 = rest.iter().map(|c| c.to_f64().min(0.0)).sum();
    if first.to_f64() + fall > noise || !fall.is_finite() {
        return Fall::Never;
    }
    let mut stack = vec![(bernstein(coefficients), 0.0, 1.0, 0)];
    while let Some((b, low, high, depth)) = stack.pop() {
        if noise > 0.0 && b.iter().any(|b| b.to_f64().abs() <= noise) {
            return Fall::Unclear;
        }
        match changes(&b) {
            (0, _) | (1, false) => {}
            (1, true) => return Fall::Within(low, high),
            _ if depth == DEPTH_MAX => {}
            _ => {
                let (left, right) = halves(b);
                let middle = 0.5 * (low + high);
                stack.push((right, middle, high, depth + 1));
                stack.push((left, low, middle, depth + 1));
            }
        }
    }
    Fall::Never
}

/// Equation: `b_i = sum_k C(i,k)/C(n,k) a_k`; all weights are positive, so nothing cancels.
fn bernstein<T: Real>(a: &[T]) -> Vec<T> {
    let n = a.len() - 1;
    let coefficient = |i: usize| {
        let (mut weight, mut sum) = (T::one(), T::zero());
        for (k, a) in a.iter().take(i + 1).enumerate() {
            sum += weight * *a;
            weight = weight.times(as_real(i - k)) / T::from_f64(as_real((n - k).max(1)));
        }
        sum
    };
    (0..=n).map(coefficient).collect()
}

/// How often the sign changes, zeros passed over, and whether it is positive at first.
fn changes<T: Real>(b: &[T]) -> (usize, bool) {
    let zero = T::zero();
    let mut signs = b.iter().filter(|b| **b != zero).map(|b| *b > zero);
    let Some(first) = signs.next() else {
        return (0, true);
    };
    let mut last = first;
    let mut count = 0;
    for sign in signs {
        count += usize::from(sign != last);
        last = sign;
    }
    (count, first)
}

fn halves<T: Real>(mut b: Vec<T>) -> (Vec<T>, Vec<T>) {
    let n = b.len();
    let mut left = Vec::with_capacity(n);
    for level in 0..n {
        left.push(b[0]);
        for i in 0..n - level - 1 {
            b[i] = (b[i] + b[i + 1]).times(0.5);
        }
    }
    // What remains in place is the right half.
    (left, b)
}

/// The root inside a bracket to the last bit: Newton, or a halving where Newton leaves it.
pub(super) fn polish<T: Real>(coefficients: &[T], (low, high): (f64, f64)) -> T {
    let (mut low, mut high) = (T::from_f64(low), T::from_f64(high));
    let mut u = (low + high).times(0.5);
    for _ in 0..120 {
        let (value, slope) = value_and_slope(coefficients, u);
        if value > T::zero() {
            low = u;
        } else {
            high = u;
        }
        let newton = u - value / slope;
        let next = if newton > low && newton < high {
            newton
        } else if newton == u {
            return u;
        } else {
            (low + high).times(0.5)
        };
        let moved = (next - u).to_f64().abs();
        u = next;
        if moved <= 2.0 * T::ROUNDING * u.to_f64() {
            break;
        }
    }
    u
}

fn value_and_slope<T: Real>(coefficients: &[T], u: T) -> (T, T) {
    let mut value = T::zero();
    let mut slope = T::zero();
    for c in coefficients.iter().rev() {
        slope = slope * u + value;
        value = value * u + *c;
    }
    (value, slope)
}

#[cfg(test)]
mod tests {
    use super::super::scalar::Wide;
    use super::*;
    use num_traits::One;

    fn root(coefficients: &[f64]) -> Option<f64> {
        match first_fall(coefficients, 0.0) {
            Fall::Within(low, high) => Some(polish(coefficients, (low, high))),
            Fall::Never | Fall::Unclear => None,
        }
    }

    /// (u - a)(u - b) with roots 1e-10 apart: their square is lost in doubles.
    #[test]
    fn what_doubles_cannot_tell_is_unclear() {
        let (a, b) = (0.5 - 2.0_f64.powi(-34), 0.5 + 2.0_f64.powi(-34));
        let wide = [
            Wide::from_f64(a) * Wide::from_f64(b),
            Wide::from_f64(-1.0),
            Wide::one(),
        ];
        let doubles = wide.map(Real::to_f64);
        assert_eq!(first_fall(&doubles, 64.0 * f64::ROUNDING), Fall::Unclear);
        let Fall::Within(low, high) = first_fall(&wide, 0.0) else {
            panic!("not found");
        };
        let found = polish(&wide, (low, high));
        assert!((found - Wide::from_f64(a)).to_f64().abs() < 1e-20);
    }

    #[test]
    fn the_first_of_two_near_roots_is_found() {
        // (u - 0.3)(u - 0.3000001): down, then up again.
        let found = root(&[0.3 * 0.300_000_1, -0.600_000_1, 1.0]).unwrap();
        assert!((found - 0.3).abs() < 1e-9, "{found}");
    }

    #[test]
    fn a_graze_and_a_rise_are_no_fall() {
        assert_eq!(root(&[0.25, -1.0, 1.000_001]), None);
        assert_eq!(root(&[-0.5, 1.0]), None);
    }

    #[test]
    fn the_fall_after_a_rise_is_found() {
        // -(u - 0.2)(u - 0.7) starts below zero, is above between the roots.
        let found = root(&[-0.14, 0.9, -1.0]).unwrap();
        assert!((found - 0.7).abs() < 1e-15, "{found}");
    }

    #[test]
    fn a_root_at_the_very_end_counts() {
        let found = root(&[1.0, -1.000_000_000_000_1]).unwrap();
        assert!(found > 0.999 && found <= 1.0, "{found}");
    }
}
