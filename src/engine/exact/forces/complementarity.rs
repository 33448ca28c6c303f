//! Which of several contacts press: a linear complementarity problem.

use super::cholesky::Cholesky;

/// Finds the pressing ones: forces `f >= 0`, rates `A f + b >= 0`, one of the two zero for each.
///
/// `matrix(i, j)` symmetric and positive semi-definite. `warm` is a guess of the answer. It is
/// the minimum of `f.A f/2 + b.f` over `f >= 0`, found by the active-set method for
/// non-negative least squares: finite, since each round lowers the minimum. A contact that joins
/// costs the square of their number, one that leaves at most the cube.
/// Source: Lawson and Hanson 1974, "Solving Least Squares Problems", chapter 23.
///
/// # Errors
/// The index of a contact that would have to press and depends on those that do.
pub(super) fn pressing(
    matrix: &dyn Fn(usize, usize) -> f64,
    rates: &[f64],
    warm: &[bool],
) -> Result<Vec<bool>, usize> {
    let count = rates.len();
    let scale = rates
        .iter()
        .fold(0.0_f64, |most, rate| most.max(rate.abs()));
    let tolerance = 1e-13 * scale;
    let mut active = Active {
        matrix,
        rates,
        forces: vec![0.0; count],
        pressed: Vec::new(),
        factor: Cholesky::empty(),
    };
    for index in (0..count).filter(|index| warm[*index]) {
        // One that depends on the others is no loss to a guess.
        active.add(index).ok();
    }
    // The method is finite; the bound only guards against rounding that makes it cycle.
    for _ in 0..20 * count + 20 {
        active.relax()?;
        let free = (0..count).filter(|i| !active.pressed.contains(i));
        let worst = free
            .map(|i| (i, active.rate(i)))
            .min_by(|one, other| one.1.total_cmp(&other.1));
        match worst {
            Some((index, rate)) if rate < -tolerance => active.add(index)?,
            Some(_) | None => break,
        }
    }
    let mut answer = vec![false; count];
    for index in active.pressed {
        answer[index] = active.forces[index] > 0.0;
    }
    Ok(answer)
}

/// The contacts taken to press, with the factor of their matrix.
struct Active<'a> {
    matrix: &'a dyn Fn(usize, usize) -> f64,
    rates: &'a [f64],
    forces: Vec<f64>,
    pressed: Vec<usize>,
    factor: Cholesky<f64>,
}

impl Active<'_> {
    fn add(&mut self, index: usize) -> Result<(), usize> {
        let (matrix, pressed) = (self.matrix, &self.pressed);
        let entry = |j: usize| matrix(index, *pressed.get(j).unwrap_or(&index));
        self.factor.grow(entry).map_err(|()| index)?;
        self.pressed.push(index);
        Ok(())
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
    fn relax(&mut self) -> Result<(), usize> {
        loop {
            let mut wanted: Vec<f64> = self.pressed.iter().map(|i| -self.rates[*i]).collect();
            self.factor.solve(&mut wanted);
            // How far towards the wanted forces before the first of them vanishes.
            let mut share = 1.0_f64;
            for (index, wanted) in self.pressed.iter().zip(&wanted) {
                if *wanted <= 0.0 {
                    let now = self.forces[*index];
                    share = share.min(if now > 0.0 { now / (now - wanted) } else { 0.0 });
                }
            }
            let complete = wanted.iter().all(|wanted| *wanted > 0.0);
            for (index, wanted) in self.pressed.iter().zip(&wanted) {
                self.forces[*index] += share * (wanted - self.forces[*index]);
            }
            if complete {
                return Ok(());
            }
            let pulls = |(index, wanted): (&usize, &f64)| {
                *wanted <= 0.0 && self.forces[*index] <= 1e-15 * wanted.abs()
            };
            let pulls: Vec<bool> = self.pressed.iter().zip(&wanted).map(pulls).collect();
            if !pulls.contains(&true) {
                // Numbers beyond those of doubles: no answer comes of going on.
                return Err(self.pressed[0]);
            }
            self.let_go(&pulls)?;
        }
    }

    /// Takes out the marked ones.
    fn let_go(&mut self, marked: &[bool]) -> Result<(), usize> {
        let first = marked.iter().position(|marked| *marked);
        let first = first.unwrap_or(self.pressed.len());
        self.factor.truncate(first);
        let later = self.pressed.split_off(first);
        for (index, marked) in later.into_iter().zip(&marked[first..]) {
            if *marked {
                self.forces[index] = 0.0;
            } else {
                self.add(index)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_that_would_pull_is_let_go() {
        let a = [[2.0, -1.0], [-1.0, 2.0]];
        let matrix = |i: usize, j: usize| a[i][j];
        assert_eq!(
            pressing(&matrix, &[-1.0, 3.0], &[true, true]),
            Ok(vec![true, false])
        );
        assert_eq!(
            pressing(&matrix, &[-1.0, 0.4], &[false, false]),
            Ok(vec![true, true])
        );
        assert_eq!(
            pressing(&matrix, &[1.0, 1.0], &[true, false]),
            Ok(vec![false, false])
        );
    }
}
