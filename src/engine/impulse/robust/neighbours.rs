//! Which pairs are near enough to meet: the others need not be looked at.

use super::super::Particle;
use crate::engine::impulse::handling::pairs;
use crate::physics::{Meter, Vector3};

/// Operations to see how far a body moved …
const OPERATIONS_A_BODY: u64 = 5;
/// … and whether a pair is near.
const OPERATIONS_A_PAIR: u64 = 4;

/// Pairs near each other, with room for motion: kept as long as nobody left that room.
///
/// Source: Verlet 1967, "Computer experiments on classical fluids", section II.
#[derive(Debug, Clone, Default)]
pub(super) struct Neighbours {
    /// In lexical order.
    pairs: Vec<[usize; 2]>,
    /// Where the bodies were when the pairs were found.
    places: Vec<Vector3>,
    /// Pairs had their surfaces nearer than this.
    margin: f64,
}

impl Neighbours {
    /// Every pair with surfaces nearer than `gap`, in lexical order; and some more.
    pub(super) fn within(
        &mut self,
        particles: &[Particle],
        gap: f64,
        meter: &mut Meter,
    ) -> &[[usize; 2]] {
        let bodies = particles.len() as u64;
        meter.add(OPERATIONS_A_BODY * bodies);
        let reach = 2.0 * self.moved(particles) + gap;
        if reach.is_nan() || reach > self.margin {
            meter.add(OPERATIONS_A_PAIR * pairs(bodies));
            self.find(particles, (2.0 * gap).max(0.5 * self.margin));
        }
        &self.pairs
    }

    /// How far a body is at most from where it was.
    fn moved(&self, particles: &[Particle]) -> f64 {
        if self.places.len() != particles.len() {
            return f64::INFINITY;
        }
        let moved = particles.iter().zip(&self.places);
        let squared = moved.map(|(particle, place)| (particle.position - place).norm_squared());
        // `max` would pass over NaN.
        let most = squared.fold(0.0_f64, |most, one| {
            if one > most || one.is_nan() {
                one
            } else {
                most
            }
        });
        most.sqrt()
    }

    fn find(&mut self, particles: &[Particle], margin: f64) {
        self.margin = margin;
        self.places.clear();
        self.places.extend(particles.iter().map(|p| p.position));
        self.pairs.clear();
        for (a, one) in particles.iter().enumerate() {
            for (b, other) in particles.iter().enumerate().skip(a + 1) {
                let reach = one.radius + other.radius + margin;
                let is_far = (one.position - other.position).norm_squared() > reach * reach;
                if !is_far {
                    self.pairs.push([a, b]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(places: &[f64]) -> Vec<Particle> {
        let particle = |x: &f64| Particle {
            position: Vector3::new(*x, 0.0, 0.0),
            velocity: Vector3::zeros(),
            force: Vector3::zeros(),
            mass: 1.0,
            radius: 0.5,
        };
        places.iter().map(particle).collect()
    }

    /// The list outlives small motions, and is found anew before it misses a pair.
    #[test]
    fn no_pair_within_the_gap_is_missed() {
        let mut neighbours = Neighbours::default();
        let mut meter = Meter::default();
        assert_eq!(
            neighbours.within(&at(&[0.0, 2.0, 9.0]), 1.5, &mut meter),
            [[0, 1]]
        );
        assert_eq!(
            neighbours.within(&at(&[0.0, 2.0, 8.5]), 1.5, &mut meter),
            [[0, 1]]
        );
        assert_eq!(
            neighbours.within(&at(&[0.0, 2.0, 4.4]), 1.5, &mut meter),
            [[0, 1], [1, 2]]
        );
        let grown = at(&[0.0, 2.0, 4.4, 6.0]);
        assert!(neighbours.within(&grown, 1.5, &mut meter).contains(&[2, 3]));
        assert_eq!(
            neighbours.within(&at(&[0.0, f64::NAN]), 1.5, &mut meter),
            [[0, 1]]
        );
        assert_eq!(
            neighbours.within(&at(&[0.0, 9.0]), 1.5, &mut meter).len(),
            0
        );
        assert_eq!(
            neighbours.within(&at(&[0.0, f64::NAN]), 1.5, &mut meter),
            [[0, 1]]
        );
    }
}
