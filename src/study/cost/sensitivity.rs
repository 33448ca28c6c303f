//! Where accuracy stops mattering: what a ball placed a little off does to the answer.

use serde::{Deserialize, Serialize};

use super::reference::Reference;
use crate::engine::{engine, record};
use crate::scene::{LengthUnit, Scene};

/// A ball is placed off by this many metres: nobody places one better by hand.
const MISPLACED_M: f64 = 1e-4;
/// Without a unit of length, by this share of the scene's size.
const MISPLACED_SHARE: f64 = 1e-4;

/// What moving one ball at the start does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sensitivity {
    /// Name of the ball.
    pub body: String,
    /// How far it was moved, scene length unit.
    pub moved: f64,
    /// Largest distance of any ball before the horizon, scene length unit.
    pub distance: f64,
}

impl Sensitivity {
    /// How much larger the consequence is than the cause, at least 1.
    #[must_use]
    pub fn amplification(&self) -> f64 {
        (self.distance / self.moved).max(1.0)
    }
}

/// Positions are compared until a misplaced ball changes them by more than this share of the
/// size: past that, they say nothing about an engine.
const HORIZON_SHARE: f64 = 0.02;

/// Moves the fastest ball (the first of equals) across its way, in the table's plane, computes
/// the scene again with `exact-fast` and cuts the reference at the horizon that this shows;
/// none if the moved scene is refused.
#[must_use]
pub fn sensitivity(scene: &Scene, reference: &mut Reference) -> Option<Sensitivity> {
    let units = scene.units.length;
    let size = reference.sizes.length;
    let moved = match units {
        LengthUnit::None => MISPLACED_SHARE * size,
        LengthUnit::Millimetre | LengthUnit::Centimetre | LengthUnit::Metre => {
            MISPLACED_M * units.per_metre()
        }
    };
    let body = scene.fastest_body();
    let mut twin = scene.clone();
    let [vx, _, vz] = twin.bodies[body].velocity.map(f64::abs);
    let across = if vx <= vz { 0 } else { 2 };
    twin.bodies[body].position[across] += moved;
    let fast = engine("exact-fast").ok()?;
    let run = record(&twin, &fast, scene.sample_every).ok()?;
    reference.cut_where(scene, &run, (HORIZON_SHARE * size).max(2.0 * moved));
    let distance = reference.distance(&run)?;
    Some(Sensitivity {
        body: scene.bodies[body].name.clone(),
        moved,
        distance,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Free flight carries the shift along and makes nothing of it.
    #[test]
    fn in_free_flight_a_ball_stays_as_far_off_as_it_was_placed() {
        let text = "name='x'\nduration=2\nsample_every=1\n[units]\nlength='mm'\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
            [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[9,0,0]\nvelocity=[0,0,3]\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let mut reference = Reference::exact(&scene).unwrap().unwrap();
        let found = sensitivity(&scene, &mut reference).unwrap();
        assert_eq!((found.body.as_str(), found.moved), ("b", 0.1));
        assert!((found.distance - 0.1).abs() < 1e-12);
        assert!((found.amplification() - 1.0).abs() < 1e-9);
    }

    /// A glancing hit turns 0.1 mm into many times as much: compared only until then.
    #[test]
    fn positions_are_compared_until_a_misplaced_ball_matters() {
        let text = "name='x'\nduration=40\nsample_every=1\n[units]\nlength='mm'\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,9]\n\
            [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[1.8,0,50]\nvelocity=[0,0,0]\n\
            [effects.contact]\nrestitution=1\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let mut reference = Reference::exact(&scene).unwrap().unwrap();
        let before = reference.comparable;
        let found = sensitivity(&scene, &mut reference).unwrap();
        assert_eq!(before, 41);
        assert!(
            (7..40).contains(&reference.comparable),
            "{}",
            reference.comparable
        );
        assert!(found.distance <= HORIZON_SHARE * reference.sizes.length);
        assert!(found.amplification() > 2.0);
    }
}
