//! The yardsticks of a comparison: what a length, an energy or a momentum is measured against.

use serde::Serialize;

use super::Metrics;
use crate::recording::Recording;

/// Sizes of a scene in motion. A share of zero is taken as zero, see [`Sizes::share`].
///
/// None of them depends on the origin of the coordinates or on the zero of a potential: a scene
/// that is moved as a whole has the same sizes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Sizes {
    /// Diagonal of the box of all positions, scene length unit.
    pub length: f64,
    /// The energy that the motion can turn over: the largest kinetic energy, and for each kind of
    /// potential energy (attraction, springs, gravity) its largest value less its smallest.
    pub energy: f64,
    /// Largest sum of m |v|.
    pub momentum: f64,
    /// Largest sum of m |x - c| |v - w|, c and w being place and velocity of the centre of mass.
    pub angular_momentum: f64,
}

impl Sizes {
    /// The sizes of one recording.
    #[must_use]
    pub fn of(recording: &Recording, metrics: &[Metrics]) -> Self {
        let corners = recording.samples().flatten().map(|s| s.position);
        let corners = corners.fold(None, |corners, position| match corners {
            None => Some((position, position)),
            Some((low, high)) => Some((position.inf(&low), position.sup(&high))),
        });
        // `hypot` does not overflow where squares would.
        let length = corners.map_or(0.0, |(low, high)| {
            (high.x - low.x).hypot(high.y - low.y).hypot(high.z - low.z)
        });
        let largest = |value: fn(&Metrics) -> f64| metrics.iter().map(value).fold(0.0, f64::max);
        Self {
            length,
            energy: energy(metrics),
            momentum: largest(|at| at.momentum_scale),
            angular_momentum: largest(|at| at.spin_scale),
        }
    }

    /// The smaller of each size: a recording that flies apart must not make the errors of the
    /// others look small, nor its own.
    #[must_use]
    pub fn smaller(self, other: Self) -> Self {
        Self {
            length: self.length.min(other.length),
            energy: self.energy.min(other.energy),
            momentum: self.momentum.min(other.momentum),
            angular_momentum: self.angular_momentum.min(other.angular_momentum),
        }
    }

    /// A part as a share of a size; 0 where the size is 0.
    #[must_use]
    pub fn share(part: f64, size: f64) -> f64 {
        if size == 0.0 { 0.0 } else { part / size }
    }
}

/// The energy that a motion can turn over, see [`Sizes::energy`].
fn energy(metrics: &[Metrics]) -> f64 {
    let potentials: [fn(&Metrics) -> f64; 3] = [
        |at| at.attraction_energy,
        |at| at.spring_energy,
        |at| at.gravity_energy,
    ];
    let range = |value: fn(&Metrics) -> f64| {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let values = metrics.iter().map(value);
        let (low, high) = values.fold(ends, |(low, high), at| (low.min(at), high.max(at)));
        (high - low).max(0.0)
    };
    let kinetic = metrics.iter().map(|at| at.kinetic_energy);
    kinetic.fold(0.0, f64::max) + potentials.map(range).iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::metrics;
    use crate::engine::{DEFAULT_DT, engine, record};

    /// A ball bounces in a box; the same scene lies 500 m higher. The sizes are those of the
    /// motion: 9.81 J a metre of fall, and as much kinetic energy.
    #[test]
    fn sizes_do_not_depend_on_the_origin() {
        let sizes = |base: f64| {
            let text = format!(
                "name='x'\nduration=1\nsample_every=0.0625\n\
                 [[bodies]]\nname='a'\nmass=1\nradius=0.1\nposition=[0,{},0]\nvelocity=[0,0,0]\n\
                 [[bodies]]\nname='b'\nmass=2\nradius=0.1\nposition=[1,{base},0]\nvelocity=[1,0,0]\n\
                 [effects.gravity]\nacceleration=[0,-9.81,0]\n",
                base + 2.0
            );
            let scene = crate::scene::parse(&text, "x").unwrap();
            let recording = record(&scene, &engine("exact-fast").unwrap(), DEFAULT_DT).unwrap();
            Sizes::of(&recording, &metrics(&scene, &recording))
        };
        let (here, there) = (sizes(0.0), sizes(512.0));
        // The fall of a second in gravity turns 3 kg (9.81 m/s)^2 / 2 twice over, and b moves at
        // 1 m/s beside it.
        let turned = 3.0 * 9.81 * 9.81;
        assert!(
            (here.energy - turned - 1.0).abs() < 1e-9 * turned,
            "{here:?}"
        );
        for (one, other) in [
            (here.length, there.length),
            (here.energy, there.energy),
            (here.momentum, there.momentum),
            (here.angular_momentum, there.angular_momentum),
        ] {
            // Heights of 512 m are rounded to 2^-44 m of the 5 m that are fallen.
            assert!(
                (one - other).abs() <= 1e-12 * one.abs(),
                "{one} and {other}"
            );
        }
    }
}
