//! Our own geometry against Parry's: depths of overlap.

use carom::scene::overlap::overlaps;
use nalgebra::Vector3;
use proptest::prelude::*;

/// Centres and radii that lean towards trouble: on a coarse grid, so that many touch or coincide.
fn spheres() -> impl Strategy<Value = Vec<(Vector3<f64>, f64)>> {
    let coordinate = prop_oneof![(-4..=4_i8).prop_map(|n| f64::from(n) * 0.5), -2.0..2.0];
    let centre = [coordinate.clone(), coordinate.clone(), coordinate];
    let radius = prop_oneof![Just(0.5), Just(0.25), 0.01..1.0];
    prop::collection::vec((centre.prop_map(Vector3::from), radius), 2..12)
}

/// Depth by Parry in the precision of the crate; none where it sees no contact.
macro_rules! depth_by {
    ($parry:ident, $real:ident) => {
        |a: &(Vector3<f64>, f64), b: &(Vector3<f64>, f64)| {
            use $parry::math::{Pose, Vector};
            let pose = |v: &Vector3<f64>| {
                Pose::from_translation(Vector::new(v.x as $real, v.y as $real, v.z as $real))
            };
            let ball = |r: f64| $parry::shape::Ball::new(r as $real);
            let (pose_a, pose_b) = (pose(&a.0), pose(&b.0));
            $parry::query::contact(&pose_a, &ball(a.1), &pose_b, &ball(b.1), 0.0)
                .unwrap()
                .map(|contact| -f64::from(contact.dist))
        }
    };
}

proptest! {
    /// Lengths up to 8, a handful of operations: 16 roundings of the precision.
    #[test]
    #[allow(clippy::cast_possible_truncation, clippy::unnecessary_cast, clippy::useless_conversion)]
    fn overlap_depths_agree_with_parry(spheres in spheres()) {
        let found = overlaps(&spheres);
        let double = depth_by!(parry3d_f64, f64);
        let single = depth_by!(parry3d, f32);
        for a in 0..spheres.len() {
            for b in a + 1..spheres.len() {
                let ours = found.iter().find(|o| (o.a, o.b) == (a, b)).map_or(0.0, |o| o.depth);
                let theirs = double(&spheres[a], &spheres[b]).unwrap_or(0.0);
                prop_assert!((ours - theirs).abs() <= 16.0 * 8.0 * f64::EPSILON, "{ours} {theirs}");
                let coarse = single(&spheres[a], &spheres[b]).unwrap_or(0.0);
                let epsilon = f64::from(f32::EPSILON);
                prop_assert!((ours - coarse).abs() <= 16.0 * 8.0 * epsilon, "{ours} {coarse}");
            }
        }
    }
}
