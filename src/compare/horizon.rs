//! The horizon: how long positions stay comparable.

use super::Divergence;
use crate::recording::Recording;
use crate::scene::Scene;

/// The time from which on perturbed twins of a recording differ from it by more than a
/// tolerance, s; none if they never do.
///
/// A twin is the same scene on the same engine with inputs moved by less than anyone could
/// measure. Past the horizon a distance between two engines says nothing about either.
/// Units: `tolerance` in scene length units. The earliest twin decides.
#[must_use]
pub fn horizon(
    scene: &Scene,
    recording: &Recording,
    twins: &[Recording],
    tolerance: f64,
) -> Option<f64> {
    twins
        .iter()
        .filter_map(|twin| Divergence::between(scene, recording, twin).first_beyond(tolerance))
        .min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{DEFAULT_DT, engine, record};

    /// Free flight: a twin with a velocity larger by d is apart by d t, so beyond 1 mm at
    /// t = 1 mm / d, at the next sample.
    #[test]
    fn the_earliest_twin_beyond_the_tolerance_decides() {
        let text = "name='x'\nduration=4\nsample_every=0.5\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[1,0,0]\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let lecture = engine("lecture").unwrap();
        let run = |scene: &Scene| record(scene, &lecture, DEFAULT_DT).unwrap();
        let twin = |d: f64| {
            let mut moved = scene.clone();
            moved.bodies[0].velocity[0] += d;
            run(&moved)
        };
        let (truth, twins) = (run(&scene), [twin(0.0004), twin(0.0006)]);
        assert_eq!(horizon(&scene, &truth, &twins, 1e-3), Some(2.0));
        assert_eq!(horizon(&scene, &truth, &twins[..1], 1e-3), Some(3.0));
        assert_eq!(horizon(&scene, &truth, &twins, 1.0), None);
    }
}
