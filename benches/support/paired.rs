//! Two candidates timed in turn, A B A B …, so that a drifting machine slows both alike.

use std::time::Instant;

/// What came of a paired timing.
#[derive(Debug, Clone, Copy)]
pub struct Paired {
    /// Least time of a unit of work of A, ns.
    pub min_a_ns: f64,
    /// Least time of a unit of work of B, ns.
    pub min_b_ns: f64,
    /// Median over the rounds of time A over time B.
    pub ratio: f64,
    /// The middle half of these ratios.
    pub quartiles: [f64; 2],
}

/// Times both for so many rounds after one that is not counted; `units` is the work a round.
pub fn paired(rounds: usize, units: f64, mut a: impl FnMut(), mut b: impl FnMut()) -> Paired {
    let time = |work: &mut dyn FnMut()| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e9 / units
    };
    a();
    b();
    let (mut min_a_ns, mut min_b_ns) = (f64::INFINITY, f64::INFINITY);
    let mut ratios: Vec<f64> = (0..rounds)
        .map(|round| {
            // Which of the two goes first changes with every round.
            let (time_a, time_b) = if round % 2 == 0 {
                (time(&mut a), time(&mut b))
            } else {
                let time_b = time(&mut b);
                (time(&mut a), time_b)
            };
            min_a_ns = min_a_ns.min(time_a);
            min_b_ns = min_b_ns.min(time_b);
            time_a / time_b
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    let at = |share: usize| ratios[(ratios.len() - 1) * share / 4];
    Paired {
        min_a_ns,
        min_b_ns,
        ratio: at(2),
        quartiles: [at(1), at(3)],
    }
}

impl std::fmt::Display for Paired {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "A {:.1} ns, B {:.1} ns (minima); A/B {:.3}, middle half {:.3} to {:.3}",
            self.min_a_ns, self.min_b_ns, self.ratio, self.quartiles[0], self.quartiles[1]
        )
    }
}
