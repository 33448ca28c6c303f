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

/// A bracket of the first root at which the polynomial goes from positive to negative.
///
/// `coefficients` of powers of u; the search is on 0 <= u <= 1. A polynomial that starts below
/// zero is followed from where it has come up.
pub(super) fn first_fall(coefficients: &[f64]) -> Option<(f64, f64)> {
    let (first, rest) = coefficients.split_first()?;
    let fall: f64 = rest.iter().map(|c| c.min(0.0)).sum();
    if *first + fall > 0.0 || !fall.is_finite() {
        return None;
    }
    let mut stack = vec![(bernstein(coefficients), 0.0, 1.0, 0)];
    while let Some((b, low, high, depth)) = stack.pop() {
        match changes(&b) {
            (0, _) | (1, false) => {}
            (1, true) => return Some((low, high)),
            _ if depth == DEPTH_MAX => {}
            _ => {
                let (left, right) = halves(b);
                let middle = 0.5 * (low + high);
                stack.push((right, middle, high, depth + 1));
                stack.push((left, low, middle, depth + 1));
            }
        }
    }
    None
}

/// Equation: `b_i = sum_k C(i,k)/C(n,k) a_k`; all weights are positive, so nothing cancels.
fn bernstein(a: &[f64]) -> Vec<f64> {
    let n = a.len() - 1;
    let coefficient = |i: usize| {
        let (mut weight, mut sum) = (1.0, 0.0);
        for (k, a) in a.iter().take(i + 1).enumerate() {
            sum += weight * a;
            weight *= as_real(i - k) / as_real((n - k).max(1));
        }
        sum
    };
    (0..=n).map(coefficient).collect()
}

/// How often the sign changes, zeros passed over, and whether it is positive at first.
fn changes(b: &[f64]) -> (usize, bool) {
    let mut signs = b.iter().filter(|b| **b != 0.0).map(|b| *b > 0.0);
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

fn halves(mut b: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    let n = b.len();
    let mut left = Vec::with_capacity(n);
    for level in 0..n {
        left.push(b[0]);
        for i in 0..n - level - 1 {
            b[i] = 0.5 * (b[i] + b[i + 1]);
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
    use super::*;

    fn root(coefficients: &[f64]) -> Option<f64> {
        first_fall(coefficients).map(|bracket| polish(coefficients, bracket))
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
