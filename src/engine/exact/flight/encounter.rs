//! When two spheres meet that fly straight past each other.

use nalgebra::Vector3;

use crate::physics::real::Real;

/// Spheres this many radius sums apart (squared) get the impact parameter by products without
/// rounding: nearer, plain rounding is small beside the radii anyway.
const FAR: f64 = 16.0;

/// Clock time until two spheres touch while they approach; none if they pass, or if that is
/// surely later than `before`.
///
/// Equation: the smaller root of `|d + w u| = s`. With the impact parameter p from the cross
/// product, `p = |d × w|/|w|`, the discriminant is `w² (s² - p²)`; and
/// `u = (d² - s²)/(-d.w + |w| (s² - p²)^(1/2))` has no difference of large numbers in it, so
/// that a small target far away and a grazing hit keep their digits.
/// Units: those of `d/w`. Valid for: any d and w; spheres that overlap and approach meet at once.
#[inline]
pub(super) fn clock_to_contact<R: Real>(
    d: &Vector3<R>,
    w: &Vector3<R>,
    sum: R,
    before: R,
) -> Option<R> {
    let approach = d.dot(w);
    if approach >= R::zero() {
        return None;
    }
    let (apart, reach) = (d.dot(d), sum * sum);
    let gap = apart - reach;
    if gap <= R::zero() {
        return Some(R::zero());
    }
    // The root is at most -d.w, so that u > gap/(-2 d.w).
    if gap > -approach.twice() * before {
        return None;
    }
    let pace = w.dot(w);
    // (d.w)² >= w² (d² - s²), the textbook's discriminant, with room for its rounding.
    let room = R::from_f64(16.0 * R::EPSILON) * apart * pace;
    if approach * approach - pace * gap < -room {
        return None;
    }
    let moment = if apart > R::from_f64(FAR) * reach {
        careful_cross(d, w)
    } else {
        d.cross(w)
    };
    let chord = pace * reach - moment.dot(&moment);
    if chord < R::zero() {
        return None;
    }
    Some(gap / (chord.sqrt() - approach))
}

/// The cross product with each component to full relative accuracy.
fn careful_cross<R: Real>(d: &Vector3<R>, w: &Vector3<R>) -> Vector3<R> {
    let component = |i: usize, j: usize| R::difference_of_products(d[i], w[j], d[j], w[i]);
    Vector3::new(component(1, 2), component(2, 0), component(0, 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::exact::wide::Wide;
    use crate::physics::real::vector;

    #[test]
    fn a_head_on_meeting_is_the_gap_over_the_speed() {
        let meet = clock_to_contact(
            &Vector3::new(5.0, 0.0, 0.0),
            &Vector3::new(-2.0, 0.0, 0.0),
            1.0,
            f64::INFINITY,
        );
        assert_eq!(meet, Some(2.0));
        let away = clock_to_contact(
            &Vector3::new(5.0, 0.0, 0.0),
            &Vector3::new(2.0, 0.0, 0.0),
            1.0,
            f64::INFINITY,
        );
        assert_eq!(away, None);
        let late = clock_to_contact(
            &Vector3::new(5.0, 0.0, 0.0),
            &Vector3::new(-2.0, 0.0, 0.0),
            1.0,
            1.0,
        );
        assert_eq!(late, None);
    }

    /// Target of 1 mm at 1 km, hit off centre: the double must stay within a few ulps of the
    /// wide number. The textbook's b² - 4ac is off by 1e-9 here.
    #[test]
    fn a_small_far_target_keeps_its_digits() {
        for offset in [0.0, 0.3e-3, 0.999e-3, 0.999_999e-3] {
            let (d, w) = ([-800.0, 600.0 + offset, 0.1], [1e6 * 0.8, -1e6 * 0.6, 0.0]);
            let shifted = [d[0], d[1], 0.0];
            let double = clock_to_contact(&vector::<f64>(shifted), &vector(w), 1e-3, 1.0).unwrap();
            let (sum, before) = (Wide::from_f64(1e-3), Wide::from_f64(1.0));
            let wide = clock_to_contact(&vector::<Wide>(shifted), &vector(w), sum, before);
            let off = (double / wide.unwrap().to_f64() - 1.0).abs();
            assert!(off < 4.0 * f64::EPSILON, "{offset}: {off:e}");
        }
    }
}
