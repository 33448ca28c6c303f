//! Vectors of the numbers that the integrator computes with: plain triples.

pub use crate::engine::exact::{Real, Wide};

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
        a[axis] += factor * b[axis];
    }
}

/// Length in doubles, for bounds and step sizes.
#[inline]
pub(super) fn size<T: Real>(a: &Triple<T>) -> f64 {
    let [x, y, z] = [a[0].to_f64(), a[1].to_f64(), a[2].to_f64()];
    (x * x + y * y + z * z).sqrt()
}
