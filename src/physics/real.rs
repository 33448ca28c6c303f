//! The scalar of `exact`: doubles for speed, a wider number for the digits that are published.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use nalgebra::{Scalar, Vector3};
use num_traits::{One, Zero};

/// A real number to compute with.
///
/// Vectors are nalgebra's, whose arithmetic and dot product need no more than these operators.
/// Valid for: functions are good to a few units of [`EPSILON`](Self::EPSILON), relative.
pub trait Real:
    Scalar
    + Copy
    + Debug
    + PartialOrd
    + Zero
    + One
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + Send
    + Sync
{
    /// Distance from 1 to the next number, as a double: the unit that errors of several
    /// operations are counted in.
    const EPSILON: f64;

    /// Bound of the relative error that one operation (`+ - * /`, root) makes. Of doubles half of
    /// [`EPSILON`](Self::EPSILON), as they round to nearest; of wider numbers above it, as they
    /// do not.
    const ROUNDING: f64;

    /// Time of an operation, that of doubles being 1.
    const COST: f64;

    /// The same number; every double is one.
    fn from_f64(value: f64) -> Self;

    /// The nearest double.
    fn to_f64(self) -> f64;

    /// Times a double, cheaper than times a number of this precision.
    #[must_use]
    fn times(self, factor: f64) -> Self;

    /// Square root; not a number below 0.
    #[must_use]
    fn sqrt(self) -> Self;

    /// `exp(x) - 1`, accurate near 0 too.
    #[must_use]
    fn exp_m1(self) -> Self;

    /// `ln(1 + x)`, accurate near 0 too. Valid for: x above -1.
    #[must_use]
    fn ln_1p(self) -> Self;

    /// `a b - c d`, as accurate as its inputs allow even where the products nearly cancel.
    #[must_use]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self;

    /// `sum + carry += delta`: what rounding takes from `sum` stays in `carry`.
    fn accumulate(sum: &mut Self, carry: &mut Self, delta: Self);

    /// Whether it is a finite number.
    fn is_finite(self) -> bool {
        self.to_f64().is_finite()
    }

    /// Size without sign.
    #[must_use]
    fn abs(self) -> Self {
        if self < Self::zero() { -self } else { self }
    }

    /// The larger of two.
    #[must_use]
    fn larger(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    /// `exp(x)`. Valid for: any x, with relative accuracy.
    #[must_use]
    fn exp(self) -> Self;

    /// `ln(x)`. Valid for: x above 0.
    #[must_use]
    fn ln(self) -> Self;

    /// Half of it.
    #[must_use]
    fn half(self) -> Self {
        self.times(0.5)
    }

    /// Twice of it.
    #[must_use]
    fn twice(self) -> Self {
        self + self
    }
}

impl Real for f64 {
    const EPSILON: f64 = f64::EPSILON;
    const ROUNDING: f64 = f64::EPSILON / 2.0;
    const COST: f64 = 1.0;

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
        self.sqrt()
    }

    #[inline]
    fn exp_m1(self) -> Self {
        self.exp_m1()
    }

    #[inline]
    fn ln_1p(self) -> Self {
        self.ln_1p()
    }

    /// Kahan's: the error of the second product is put back.
    #[inline]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        let second = c * d;
        let error = c.mul_add(d, -second);
        a.mul_add(b, -second) - error
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

    #[inline]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline]
    fn exp(self) -> Self {
        self.exp()
    }

    #[inline]
    fn ln(self) -> Self {
        self.ln()
    }
}

/// A vector of that scalar with these components.
#[must_use]
pub fn vector<R: Real>(components: [f64; 3]) -> Vector3<R> {
    Vector3::from(components.map(R::from_f64))
}

/// Euclidean length.
#[must_use]
#[inline]
pub fn length<R: Real>(v: &Vector3<R>) -> R {
    v.dot(v).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compensation_keeps_what_rounding_takes() {
        let (mut sum, mut carry) = (1.0, 0.0);
        for _ in 0..1000 {
            f64::accumulate(&mut sum, &mut carry, 1e-17);
        }
        assert!((sum - 1.0 + carry - 1e-14).abs() < 1e-17);
    }

    /// Each function of the scalar is that of the standard library, near 0 with all digits.
    #[test]
    fn functions_of_doubles_are_those_of_the_library() {
        let small = 1e-10_f64;
        assert_eq!(Real::exp_m1(small), small.exp_m1());
        assert_eq!(Real::ln_1p(small), small.ln_1p());
        assert_eq!(Real::exp(2.0), 2.0_f64.exp());
        assert_eq!(Real::ln(2.0), 2.0_f64.ln());
        assert_eq!(Real::abs(-2.0), 2.0);
        assert_eq!(Real::sqrt(2.0), 2.0_f64.sqrt());
        assert_eq!([Real::half(3.0), Real::twice(3.0)], [1.5, 6.0]);
        assert_eq!([2.0.larger(3.0), 3.0.larger(2.0)], [3.0, 3.0]);
        assert_eq!(1.0 + f64::ROUNDING, 1.0);
        assert!(1.0 + f64::ROUNDING.next_up() > 1.0);
        assert!(Real::is_finite(1.0) && !Real::is_finite(f64::INFINITY));
    }

    /// Products whose difference is below their rounding: (1 + u)² - (1 + 2u) 1 = u².
    #[test]
    fn a_difference_of_products_keeps_what_rounding_takes() {
        let u = 2.0_f64.powi(-30);
        let left = f64::difference_of_products(1.0 + u, 1.0 + u, 1.0 + 2.0 * u, 1.0);
        assert_eq!(left, u * u);
        let left = f64::difference_of_products(1.0 + 2.0 * u, 1.0, 1.0 + u, 1.0 + u);
        assert_eq!(left, -u * u);
    }

    #[test]
    fn a_vector_has_its_components_and_length() {
        let v: Vector3<f64> = vector([2.0, 3.0, 6.0]);
        assert_eq!([v.x, v.y, v.z], [2.0, 3.0, 6.0]);
        assert_eq!(length(&v), 7.0);
    }
}
