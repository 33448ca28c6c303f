//! A loop of fixed work, to see how fast this machine is at the moment.

use std::hint::black_box;

/// So many rounds of 100 dependent multiply-adds and one square root.
pub fn work(rounds: u64) {
    let mut x = black_box(1.000_001_f64);
    for _ in 0..rounds {
        for _ in 0..100 {
            x = x * 0.999_999 + 1e-6;
        }
        x = x.sqrt();
    }
    black_box(x);
}
