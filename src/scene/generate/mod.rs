//! Scenes from a recipe and a seed: the lecture's random cluster, a rack, a gas.
//!
//! Each recipe is plain data; the same recipe gives the same scene on every platform.

mod cluster;
mod gas;
mod rack;

pub use cluster::Cluster;
pub use gas::Gas;
pub use rack::Rack;

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// A seeded stream of uniform numbers.
struct Random(Pcg64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// Uniform in 0..1, with all 53 bits of a double.
    fn unit(&mut self) -> f64 {
        #[allow(clippy::cast_precision_loss, reason = "53 bits fit")]
        let share = (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        share
    }

    /// Uniform in `low..high`.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in the ball of that radius.
    fn in_ball(&mut self, radius: f64) -> [f64; 3] {
        loop {
            let point = [(); 3].map(|()| self.between(-1.0, 1.0));
            if point.iter().map(|x| x * x).sum::<f64>() <= 1.0 {
                return point.map(|x| radius * x);
            }
        }
    }

    /// Standard normal number, by Marsaglia's polar method.
    fn normal(&mut self) -> f64 {
        loop {
            let (x, y) = (self.between(-1.0, 1.0), self.between(-1.0, 1.0));
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                return x * (-2.0 * square.ln() / square).sqrt();
            }
        }
    }
}
