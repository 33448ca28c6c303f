//! Which of several contacts press: a linear complementarity problem.

use super::Meter;
use super::cholesky::Cholesky;

/// Below this share of the largest rate, a rate is that of a contact that stays closed.
const CLOSED: f64 = 1e-9;

/// What becomes of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// It opens, or could do so.
    Free,
    /// It presses.
    Pressed,
    /// The pressing ones keep it closed: its direction depends on theirs, so that which of them
    /// bear the load is not determined, but the motion is.
    Redundant,
}

/// Finds the roles: forces `f >= 0`, rates `A f + b >= 0`, one of the two zero for each.
///
/// `matrix(i, j)` symmetric and positive semi-definite. `warm` is a guess of the answer. It is
/// the minimum of `f.A f/2 + b.f` over `f >= 0`, found by the active-set method for
/// non-negative least squares: finite, since each round lowers the minimum. A contact that joins
/// costs the square of their number, one that leaves at most the cube; `meter` counts that, and
/// once it is spent the search ends with forces that solve nothing yet.
/// Source: Lawson and Hanson 1974, "Solving Least Squares Problems", chapter 23.
#[must_use]
pub fn pressing(
    matrix: &impl Fn(usize, usize) -> f64,
    rates: &[f64],
    warm: &[bool],
    meter: &mut Meter,
) -> Vec<Role> {
    let mut active = Active::solved(matrix, rates, warm, meter);
    let closed = CLOSED * scale(rates);
    let role = |index: usize| {
        if active.pressed.contains(&index) {
            Role::Pressed
        } else if active.rate(index) > closed || active.is_independent(index) {
            Role::Free
        } else {
            Role::Redundant
        }
    };
    (0..rates.len()).map(role).collect()
}

/// The forces of the same problem; where they are not unique, some that solve it: the rates that
/// come of them are unique.
#[must_use]
pub fn pushes(
    matrix: &impl Fn(usize, usize) -> f64,
    rates: &[f64],
    warm: &[bool],
    meter: &mut Meter,
) -> Vec<f64> {
    Active::solved(matrix, rates, warm, meter).forces
}

fn scale(rates: &[f64]) -> f64 {
    let sizes = rates.iter().map(|rate| rate.abs());
    sizes.fold(0.0, f64::max)
}

/// The contacts taken to press, with the factor of their matrix.
struct Active<'a, M> {
    matrix: &'a M,
    rates: &'a [f64],
    forces: Vec<f64>,
    pressed: Vec<usize>,
    factor: Cholesky<f64>,
    meter: &'a mut Meter,
}

impl<'a, M: Fn(usize, usize) -> f64> Active<'a, M> {
    /// Adds the worst that would close, until none would.
    fn solved(matrix: &'a M, rates: &'a [f64], warm: &[bool], meter: &'a mut Meter) -> Self {
        let count = rates.len();
        let tolerance = 1e-13 * scale(rates);
        let mut active = Self {
            matrix,
            rates,
            forces: vec![0.0; count],
            pressed: Vec::new(),
            factor: Cholesky::empty(),
            meter,
        };
        for index in (0..count).filter(|index| warm[*index]) {
            // One that depends on the others is no loss to a guess.
            active.add(index);
        }
        let mut dependent = vec![false; count];
        // The method is finite; the bound only guards against rounding that makes it cycle.
        for _ in 0..20 * count + 20 {
            active.relax();
            if active.meter.is_spent() {
                break;
            }
            let rates = count.saturating_sub(active.pressed.len());
            active.count(3 * rates * active.pressed.len() + count);
            let free = |i: &usize| !dependent[*i] && !active.pressed.contains(i);
            let worst = (0..count)
                .filter(free)
                .map(|i| (i, active.rate(i)))
                .min_by(|one, other| one.1.total_cmp(&other.1));
            match worst {
                Some((index, rate)) if rate < -tolerance => {
                    dependent[index] = !active.add(index);
                }
                Some(_) | None => break,
            }
        }
        let idle: Vec<bool> = active
            .pressed
            .iter()
            .map(|i| active.forces[*i] <= 0.0)
            .collect();
        active.let_go(&idle);
        active
    }

    fn count(&mut self, operations: usize) {
        self.meter.add(operations as u64);
    }

    /// Takes it to press; whether it is independent of the others, else it is not taken.
    fn add(&mut self, index: usize) -> bool {
        let size = self.pressed.len();
        self.count(size * size / 2 + 8 * size + 50);
        let (matrix, pressed) = (self.matrix, &self.pressed);
        let entry = |j: usize| matrix(index, *pressed.get(j).unwrap_or(&index));
        let grown = self.factor.grow(entry).is_ok();
        if grown {
            self.pressed.push(index);
        }
        grown
    }

    fn is_independent(&mut self, index: usize) -> bool {
        let independent = self.add(index);
        if independent {
            self.pressed.pop();
            self.factor.truncate(self.pressed.len());
        }
        independent
    }

    /// Rate of a contact under the present forces.
    fn rate(&self, index: usize) -> f64 {
        let pushes = self.pressed.iter();
        let pushed: f64 = pushes
            .map(|j| (self.matrix)(index, *j) * self.forces[*j])
            .sum();
        self.rates[index] + pushed
    }

    /// Forces that stop the pressed ones; those that would have to pull are let go, one by one.
    fn relax(&mut self) {
        while !self.meter.is_spent() {
            let size = self.pressed.len();
            self.count(size * size + 12 * size + 100);
            let mut wanted: Vec<f64> = self.pressed.iter().map(|i| -self.rates[*i]).collect();
            self.factor.solve(&mut wanted);
            // How far towards the wanted forces before each of them vanishes.
            let before_zero = |(index, wanted): (&usize, &f64)| {
                let now = self.forces[*index];
                match (*wanted <= 0.0, now > 0.0) {
                    (true, true) => now / (now - wanted),
                    (true, false) => 0.0,
                    (false, _) => f64::INFINITY,
                }
            };
            let shares: Vec<f64> = self.pressed.iter().zip(&wanted).map(before_zero).collect();
            let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
            for (index, wanted) in self.pressed.iter().zip(&wanted) {
                self.forces[*index] += least.min(1.0) * (wanted - self.forces[*index]);
            }
            if least > 1.0 {
                return;
            }
            let pulls: Vec<bool> = shares.iter().map(|share| *share <= least).collect();
            self.let_go(&pulls);
        }
    }

    /// Takes out the marked ones.
    fn let_go(&mut self, marked: &[bool]) {
        let first = marked.iter().position(|marked| *marked);
        let first = first.unwrap_or(self.pressed.len());
        self.factor.truncate(first);
        let later = self.pressed.split_off(first);
        for (index, marked) in later.into_iter().zip(&marked[first..]) {
            if *marked || !self.add(index) {
                self.forces[index] = 0.0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_that_would_pull_is_let_go() {
        let a = [[2.0, -1.0], [-1.0, 2.0]];
        let matrix = |i: usize, j: usize| a[i][j];
        let (free, pressed) = (Role::Free, Role::Pressed);
        for (rates, warm, roles) in [
            ([-1.0, 3.0], [true, true], [pressed, free]),
            ([-1.0, 0.4], [false, false], [pressed, pressed]),
            ([1.0, 1.0], [true, false], [free, free]),
        ] {
            assert_eq!(
                pressing(&matrix, &rates, &warm, &mut Meter::default()),
                roles.to_vec()
            );
        }
    }

    /// A table on four legs: two or three bear it, and the others are closed by them.
    #[test]
    fn what_the_others_keep_closed_is_redundant() {
        let legs: [[f64; 3]; 4] = [
            [1.0, 1.0, 1.0],
            [1.0, -1.0, 1.0],
            [1.0, -1.0, -1.0],
            [1.0, 1.0, -1.0],
        ];
        let product = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let matrix = |i: usize, j: usize| product(legs[i], legs[j]);
        for warm in [[false; 4], [true; 4]] {
            let roles = pressing(&matrix, &[-1.0; 4], &warm, &mut Meter::default());
            let pressed = roles.iter().filter(|role| **role == Role::Pressed).count();
            assert!((2..4).contains(&pressed), "{roles:?}");
        }
    }

    /// Two contacts of one direction: the second rests on the first, or opens above it.
    #[test]
    fn only_what_is_closed_is_redundant() {
        let matrix = |_: usize, _: usize| 1.0;
        for (second, role) in [
            (-0.5, Role::Free),
            (-1.0, Role::Redundant),
            (-1.0 + 1e-12, Role::Redundant),
            (-1.0 + 1e-10, Role::Redundant),
            (-1.0 + 1e-8, Role::Free),
        ] {
            for (warm, scale) in [([false; 2], 1.0), ([true, false], 1.0), ([false; 2], 1e3)] {
                let roles = pressing(
                    &matrix,
                    &[-scale, second * scale],
                    &warm,
                    &mut Meter::default(),
                );
                assert_eq!(roles, [Role::Pressed, role], "{second} {scale}");
            }
        }
        // One of its own rests on nothing, however slow.
        let beside = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        let roles = pressing(&beside, &[-1.0, 0.0], &[false; 2], &mut Meter::default());
        assert_eq!(roles, [Role::Pressed, Role::Free]);
    }

    /// A warm guess from far off, a row that depends on others, forces that vanish on the way:
    /// the forces are never negative, no rate is, and where one is there is not the other.
    #[test]
    fn forces_and_rates_complement_each_other() {
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1_u32 << 24) - 0.5
        };
        let (mut pressed, mut opened) = (0, 0);
        for round in 0..500 {
            let count = 2 + round % 7;
            // In three dimensions, so that more than three depend on each other.
            let arms: Vec<[f64; 3]> = (0..count)
                .map(|_| [random() + 0.5, random(), random()])
                .collect();
            let product = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
            let matrix = |i: usize, j: usize| product(arms[i], arms[j]);
            let velocity = [random() - 0.3, random(), random()];
            let rates: Vec<f64> = arms.iter().map(|arm| product(*arm, velocity)).collect();
            let warm: Vec<bool> = (0..count).map(|_| random() > 0.0).collect();
            let forces = pushes(&matrix, &rates, &warm, &mut Meter::default());
            for i in 0..count {
                let rate = rates[i] + (0..count).map(|j| matrix(i, j) * forces[j]).sum::<f64>();
                // Pivots down to 1e-11 of a diagonal near 1: the forces lose that many digits.
                assert!(forces[i] >= 0.0 && rate > -1e-5, "{forces:?} {rate}");
                assert!(forces[i] * rate < 1e-5, "{} {rate}", forces[i]);
                pressed += usize::from(forces[i] > 0.0);
                opened += usize::from(rate > 1e-5);
            }
        }
        assert!(pressed > 500 && opened > 500, "{pressed} {opened}");
    }

    /// The meter counts what the search costs: every entry that is read enters one product, the
    /// factor takes about as many products again. It ends the search soon after it is spent.
    #[test]
    fn what_the_search_costs_is_counted_and_bounds_it() {
        let mut seed = 7_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1_u32 << 24) - 0.5
        };
        for count in [4_usize, 16, 48] {
            let arms: Vec<Vec<f64>> = (0..count)
                .map(|_| (0..count / 2).map(|_| random()).collect())
                .collect();
            let rates: Vec<f64> = (0..count).map(|_| random() - 0.2).collect();
            let search = |meter: &mut Meter| {
                let reads = std::cell::Cell::new(0_u64);
                let matrix = |i: usize, j: usize| {
                    reads.set(reads.get() + 1);
                    arms[i]
                        .iter()
                        .zip(&arms[j])
                        .map(|(a, b)| a * b)
                        .sum::<f64>()
                };
                let forces = pushes(&matrix, &rates, &vec![true; count], meter);
                assert!(forces.iter().all(|force| *force >= 0.0));
                reads.get()
            };
            let mut meter = Meter::default();
            let reads = search(&mut meter);
            let done = meter.done();
            // Overheads of some fifty operations a row are most of a small one.
            assert!(
                reads <= done && done <= 60 * reads,
                "{count}: {reads} {done}"
            );
            let mut bounded = Meter::limited(done / 3);
            assert!(search(&mut bounded) < reads, "{count}");
            // One row, one solution or one look at all rates past the bound, at the most.
            let square = (count * count) as u64;
            assert!(bounded.done() <= done / 3 + 4 * square + 500, "{count}");
        }
    }

    /// Once nothing closes the search ends, whatever rests, opens or depends on the others: it
    /// looks at each entry a few times, not in all the rounds that there may be.
    #[test]
    fn the_search_ends_when_nothing_closes() {
        let calls = std::cell::Cell::new(0);
        let counted = |value: f64| {
            calls.set(calls.get() + 1);
            value
        };
        // One that presses; one that opens, rests, or depends on it and would still close.
        let beside = |i: usize, j: usize| counted(if i == j { 1.0 } else { 0.0 });
        let same = |i: usize, j: usize| counted([1.0, 2.0][i] * [1.0, 2.0][j]);
        for (matrix, rates, expected) in [
            (
                &beside as &dyn Fn(usize, usize) -> f64,
                [-1.0, 0.5],
                [1.0, 0.0],
            ),
            (&beside, [-1.0, 0.0], [1.0, 0.0]),
            (&same, [-1.0, -1.9], [0.0, 0.475]),
        ] {
            calls.set(0);
            assert_eq!(
                pushes(&matrix, &rates, &[false; 2], &mut Meter::default()),
                expected
            );
            assert!(calls.get() < 20, "{} for {rates:?}", calls.get());
        }
    }
}
