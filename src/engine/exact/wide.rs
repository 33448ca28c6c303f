//! Twice the digits of a double: an unevaluated sum of two.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};
use twofloat::TwoFloat;

use crate::physics::real::Real;

/// A double-double number, about 31 digits, with the exponents of a double.
///
/// Sums and products are those of the crate `twofloat` (Joldes, Muller, Popescu 2017: relative
/// errors 3u² and 5u² at most, u = 2^-53; 4.2e-32 measured). Its quotient is good to 1e-16 only
/// (version 0.8.4 takes the residual of the reciprocal without a fused product) and so are its
/// exponential and logarithm; its square root errs by 1.0e-31. These four are made here from
/// sums and products.
#[derive(Debug, Clone, Copy)]
pub struct Wide(TwoFloat);

/// The natural logarithm of 2, to twice the digits.
const LN_2: [f64; 2] = [std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17];

impl Wide {
    /// The sum of two doubles, exactly.
    #[must_use]
    pub fn sum(a: f64, b: f64) -> Self {
        Self(TwoFloat::new_add(a, b))
    }

    /// `exp(x) - 1` by its series. Valid for: `|x| <= 1/40`, where 12 terms leave 1e-30 of x.
    fn exp_m1_series(self) -> Self {
        // Horner's scheme: x (1 + x/2 (1 + x/3 (1 + ...))).
        let mut sum = Self::one();
        for term in (2..=17_i32).rev() {
            sum = Self::one() + self * sum.divided_by(f64::from(term));
        }
        self * sum
    }

    fn divided_by(self, divisor: f64) -> Self {
        Self(self.0 / divisor)
    }
}

impl Real for Wide {
    const EPSILON: f64 = 4.930_380_657_631_324e-32;
    const ROUNDING: f64 = 1e-31;
    const COST: f64 = 20.0;

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

    /// One Newton step from the double's root: its error, about u²/8, is below that of the
    /// arithmetic. Of two million roots the worst was off by 3.6e-32.
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.0.hi().sqrt();
        if root == 0.0 || !root.is_finite() {
            return Self::from_f64(root);
        }
        let rest = self.0 - TwoFloat::new_mul(root, root);
        Self(TwoFloat::new_add(root, rest.hi() / (2.0 * root)))
    }

    /// Reduction by powers of 2, the series, and four doublings `e(2x) = e(x) (e(x) + 2)`.
    fn exp_m1(self) -> Self {
        let size = self.0.hi();
        if !(-745.0..=709.0).contains(&size) {
            return Self::from_f64(size.exp_m1());
        }
        let power = (size / LN_2[0]).round();
        let rest = self - Self::sum(LN_2[0], LN_2[1]).times(power);
        let mut result = rest.times(1.0 / 16.0).exp_m1_series();
        for _ in 0..4 {
            result *= result + Self::from_f64(2.0);
        }
        if power == 0.0 {
            return result;
        }
        // Two factors, as 2^-745 is no double but the result may be one.
        let [first, second] = [(power / 2.0).floor(), power - (power / 2.0).floor()];
        let whole = (result + Self::one())
            .times(first.exp2())
            .times(second.exp2());
        whole - Self::one()
    }

    /// One Newton step on [`exp_m1`](Self::exp_m1) from the double's logarithm.
    fn ln_1p(self) -> Self {
        let start = self.to_f64().ln_1p();
        if !start.is_finite() || start == 0.0 {
            return if start == 0.0 {
                self
            } else {
                Self::from_f64(start)
            };
        }
        let start = Self::from_f64(start);
        let reached = start.exp_m1();
        start + (self - reached) / (reached + Self::one())
    }

    #[inline]
    fn difference_of_products(a: Self, b: Self, c: Self, d: Self) -> Self {
        a * b - c * d
    }

    /// The arithmetic is wide enough as it is.
    #[inline]
    fn accumulate(sum: &mut Self, _carry: &mut Self, delta: Self) {
        *sum += delta;
    }

    /// Without the detour over `exp(x) - 1`, which would lose the digits of a small result.
    fn exp(self) -> Self {
        let size = self.0.hi();
        // Neither the reciprocal of what is infinite nor a sum with it is a number.
        if !(-1490.0..=709.0).contains(&size) {
            return Self::from_f64(size.exp());
        }
        if size < -700.0 {
            let root = self.times(0.5).exp();
            return root * root;
        }
        if size < -0.5 {
            return Self::one() / ((-self).exp_m1() + Self::one());
        }
        self.exp_m1() + Self::one()
    }

    /// One Newton step on [`exp`](Self::exp) from the double's logarithm.
    fn ln(self) -> Self {
        let start = self.to_f64().ln();
        if !start.is_finite() {
            return Self::from_f64(start);
        }
        let start = Self::from_f64(start);
        start + (self * (-start).exp() - Self::one())
    }
}

/// As [`partial_cmp`](PartialOrd::partial_cmp) has it; `twofloat` takes all infinities for one
/// number, and above every finite one.
impl PartialEq for Wide {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Wide {
    /// By the upper parts, and by the lower ones where those are equal.
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.0.hi().partial_cmp(&other.0.hi()) {
            Some(Ordering::Equal) => self.0.lo().partial_cmp(&other.0.lo()),
            decided => decided,
        }
    }
}

impl Add for Wide {
    type Output = Self;

    /// Valid for: finite numbers; with an infinite one the sum is not a number.
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

impl Div for Wide {
    type Output = Self;

    /// Long division in three digits of 53 bits. A quotient that doubles take for zero or infinite
    /// is that: its rest would be not a number.
    #[inline]
    fn div(self, other: Self) -> Self {
        let leading = other.0.hi();
        let first = self.0.hi() / leading;
        if first == 0.0 || !first.is_finite() {
            return Self::from_f64(first);
        }
        let rest = self.0 - other.0 * first;
        let second = rest.hi() / leading;
        let rest = rest - other.0 * second;
        let third = rest.hi() / leading;
        Self(TwoFloat::new_add(first, second) + third)
    }
}

impl Neg for Wide {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl AddAssign for Wide {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Wide {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Wide {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl DivAssign for Wide {
    #[inline]
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl Zero for Wide {
    #[inline]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    #[inline]
    fn is_zero(&self) -> bool {
        self.0.hi() == 0.0
    }
}

impl One for Wide {
    #[inline]
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the size of the value, in units of the last place.
    fn off(found: Wide, expected: [f64; 2]) -> f64 {
        let error = found - Wide::sum(expected[0], expected[1]);
        error.to_f64().abs() / (expected[0].abs() * Wide::EPSILON)
    }

    /// Values by mpmath at 60 digits, as the two doubles nearest to them.
    #[test]
    fn functions_are_good_to_thirty_digits() {
        let wide = Wide::from_f64;
        let values = [
            (
                wide(1.0) / wide(3.0),
                [0.333_333_333_333_333_3, 1.850_371_707_708_594e-17],
            ),
            (
                wide(2.0).sqrt(),
                [std::f64::consts::SQRT_2, -9.667_293_313_452_913e-17],
            ),
            (
                wide(1.0).exp(),
                [std::f64::consts::E, 1.445_646_891_729_250_2e-16],
            ),
            (
                wide(3.0).ln(),
                [1.098_612_288_668_109_8, -9.071_297_235_001_53e-17],
            ),
        ];
        for (found, expected) in values {
            assert!(
                off(found, expected) < 16.0,
                "{expected:?}: {}",
                off(found, expected)
            );
        }
    }

    #[test]
    fn exponential_and_logarithm_undo_each_other() {
        for x in [
            -300.0, -7.3, -0.51, -0.49, -1e-3, 1e-25, 0.2, 0.7, 3.0, 250.0,
        ] {
            let x = Wide::from_f64(x);
            let back = x.exp().ln();
            let room = 32.0 * Wide::EPSILON * (1.0 + x.to_f64().abs());
            assert!((back - x).to_f64().abs() < room, "{x:?} {back:?}");
            if x.to_f64() > -40.0 && x.to_f64() < 40.0 {
                let back = x.exp_m1().ln_1p();
                // Below -1 exp(x) - 1 forgets x: an ulp of it is exp(-x) ulps of x.
                let room = 32.0 * Wide::EPSILON * x.to_f64().abs() * (-x.to_f64()).exp().max(1.0);
                assert!((back - x).to_f64().abs() <= room, "{x:?} {back:?}");
            }
        }
    }

    /// Used to be not a number: a ball under a drag of 1e6 per second was lost within a sample.
    #[test]
    fn an_exponential_beyond_doubles_is_nothing_or_infinite() {
        let exp = |x: f64| Wide::from_f64(x).exp().to_f64();
        assert_eq!([exp(-2.5e5), exp(-1480.0)], [0.0, 0.0]);
        assert_eq!(exp(2.5e5), f64::INFINITY);
        let small = exp(-720.0);
        assert!(
            (small / (-720.0_f64).exp() - 1.0).abs() < 1e-12,
            "{small:e}"
        );
    }

    #[test]
    fn quotients_multiply_back() {
        for (a, b) in [(1.0, 3.0), (7.0, 1e-9), (1e20, -0.3), (-2.0, 1.0 + 1e-15)] {
            let (a, b) = (Wide::from_f64(a), Wide::from_f64(b) + Wide::from_f64(1e-20));
            let error = (a / b * b - a).to_f64().abs();
            assert!(
                error < 8.0 * Wide::EPSILON * a.to_f64().abs(),
                "{a:?} {b:?}"
            );
        }
    }

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

    /// Quotients by zero used to be not a number, so that they compared with nothing.
    #[test]
    fn what_is_infinite_compares_as_doubles_do() {
        let number = |value: f64| Wide::from_f64(value);
        let infinite = number(1.0) / number(0.0);
        assert!(infinite > number(f64::MAX) && -infinite < number(f64::MIN));
        assert!(infinite != -infinite);
        assert_eq!(infinite.sqrt(), infinite);
        assert_eq!(number(1.0) / infinite, Wide::zero());
        assert_eq!(number(0.0).sqrt() / number(3.0), Wide::zero());
        let undefined = number(-1.0).sqrt();
        assert!(undefined != undefined && undefined.partial_cmp(&Wide::zero()).is_none());
    }
}
