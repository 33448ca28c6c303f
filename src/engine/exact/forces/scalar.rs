//! The numbers that the integrator computes with: `f64`, or double-double for certification.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use twofloat::TwoFloat;

/// A real number of some precision.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + 'static
{
    /// Relative rounding error of one operation.
    const EPSILON: f64;

    /// The number of this value.
    fn from_f64(value: f64) -> Self;

    /// The nearest double.
    fn to_f64(self) -> f64;

    /// Times a double, cheaper than times a number of this precision.
    #[must_use]
    fn times(self, factor: f64) -> Self;

    /// Square root; of a negative number, not a number.
    #[must_use]
    fn sqrt(self) -> Self;

    /// `sum + carry += delta`: what rounding takes from `sum` stays in `carry`.
    fn accumulate(sum: &mut Self, carry: &mut Self, delta: Self);

    /// Zero.
    #[must_use]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    /// Whether it is a finite number.
    #[must_use]
    fn is_finite(self) -> bool {
        self.to_f64().is_finite()
    }
}

impl Real for f64 {
    const EPSILON: f64 = f64::EPSILON / 2.0;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline]
    fn times(self, factor: f64) -> Self {
        self * factor
    }

    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    /// Knuth's two-sum: the rounding error of the sum, exactly.
    #[inline]
    fn accumulate(sum: &mut Self, carry: &mut Self, delta: Self) {
        let delta = delta + *carry;
        let total = *sum + delta;
        let seen = total - *sum;
        *carry = (*sum - (total - seen)) + (delta - seen);
        *sum = total;
    }
}

/// A double-double number: 31 digits, with the exponents of a double.
///
/// Sums and products are those of the crate `twofloat` (Joldes, Muller, Popescu 2017: relative
/// errors 3u² and 5u², u = 2^-53). Its quotient (0.8.4) is good to 1e-16 only and its root
/// unmeasured, so these two are made here.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Wide(TwoFloat);

impl Add for Wide {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Wide {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for Wide {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Neg for Wide {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Div for Wide {
    type Output = Self;
    /// Long division: three quotients of doubles, each from what the ones before leave.
    #[inline]
    fn div(self, other: Self) -> Self {
        let divisor = other.0.hi();
        let first = self.0.hi() / divisor;
        if first == 0.0 || !first.is_finite() {
            return Self(TwoFloat::from(first));
        }
        let rest = self.0 - other.0 * first;
        let second = rest.hi() / divisor;
        let rest = rest - other.0 * second;
        Self(TwoFloat::new_add(first, second) + rest.hi() / divisor)
    }
}

impl Real for Wide {
    const EPSILON: f64 = 1e-31;

    #[inline]
    fn from_f64(value: f64) -> Self {
        Self(TwoFloat::from(value))
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self.0.hi() + self.0.lo()
    }

    #[inline]
    fn times(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }

    /// One Newton step from the double's root: its error, about u²/8, is that of the arithmetic.
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.0.hi().sqrt();
        if root == 0.0 || !root.is_finite() {
            return Self::from_f64(root);
        }
        let rest = self.0 - TwoFloat::new_mul(root, root);
        Self(TwoFloat::new_add(root, rest.hi() / (2.0 * root)))
    }

    /// The arithmetic is wide enough as it is.
    #[inline]
    fn accumulate(sum: &mut Self, _carry: &mut Self, delta: Self) {
        *sum = *sum + delta;
    }
}

/// Three components, in the order x, y, z.
pub type Triple<T> = [T; 3];

/// `a . b`.
#[inline]
pub(super) fn dot<T: Real>(a: &Triple<T>, b: &Triple<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a - b`.
#[inline]
pub(super) fn minus<T: Real>(a: &Triple<T>, b: &Triple<T>) -> Triple<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a += factor * b`.
#[inline]
pub(super) fn add_scaled<T: Real>(a: &mut Triple<T>, factor: T, b: &Triple<T>) {
    for axis in 0..3 {
        a[axis] = a[axis] + factor * b[axis];
    }
}

/// Length in doubles, for bounds and step sizes.
#[inline]
pub(super) fn size<T: Real>(a: &Triple<T>) -> f64 {
    let [x, y, z] = [a[0].to_f64(), a[1].to_f64(), a[2].to_f64()];
    (x * x + y * y + z * z).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (sqrt 2)² - 2 and 3 (1/3) - 1: a few 1e-32, where doubles leave 1e-16.
    #[test]
    fn root_and_quotient_are_wide() {
        let number = |value: f64| Wide::from_f64(value);
        let root = number(2.0).sqrt();
        let rest = (root * root - number(2.0)).to_f64().abs();
        assert!(rest < 2e-31, "{rest:e}");
        let third = number(1.0) / number(3.0);
        let seventh = third / (number(7.0) * third * number(3.0));
        for rest in [third.times(3.0), seventh.times(21.0)] {
            let rest = (rest - number(1.0)).to_f64().abs();
            assert!(rest < 2e-31, "{rest:e}");
        }
    }

    #[test]
    fn compensation_keeps_what_rounding_takes() {
        let (mut sum, mut carry) = (1.0, 0.0);
        for _ in 0..1000 {
            f64::accumulate(&mut sum, &mut carry, 1e-17);
        }
        assert!((sum - 1.0 + carry - 1e-14).abs() < 1e-17);
    }
}
