//! Which of several contacts press: a linear complementarity problem.

use super::cholesky::Cholesky;

/// Finds the pressing ones: forces `f >= 0`, rates `A f + b >= 0`, one of the two zero for each.
///
/// `matrix(i, j)` symmetric and positive semi-definite. `warm` is a guess of the answer. It is
/// the minimum of `f.A f/2 + b.f` over `f >= 0`, found by the active-set method for
/// non-negative least squares: finite, since each round lowers the minimum.
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
    let mut forces = vec![0.0; count];
    let mut pressed: Vec<usize> = Vec::new();
    for index in (0..count).filter(|index| warm[*index]) {
        pressed.push(index);
        if factor(matrix, &pressed).is_err() {
            pressed.pop();
        }
    }
    // The method is finite; the bound only guards against rounding that makes it cycle.
    for _ in 0..20 * count + 20 {
        relax(matrix, rates, &mut forces, &mut pressed)?;
        let rate = |i: usize| -> f64 {
            rates[i]
                + pressed
                    .iter()
                    .map(|j| matrix(i, *j) * forces[*j])
                    .sum::<f64>()
        };
        let free = (0..count).filter(|i| !pressed.contains(i));
        let worst = free
            .map(|i| (i, rate(i)))
            .min_by(|one, other| one.1.total_cmp(&other.1));
        match worst {
            Some((index, rate)) if rate < -tolerance => pressed.push(index),
            Some(_) | None => break,
        }
    }
    let mut answer = vec![false; count];
    for index in pressed {
        answer[index] = forces[index] > 0.0;
    }
    Ok(answer)
}

/// Forces that stop the pressed ones; those that would have to pull are let go, one by one.
fn relax(
    matrix: &dyn Fn(usize, usize) -> f64,
    rates: &[f64],
    forces: &mut [f64],
    pressed: &mut Vec<usize>,
) -> Result<(), usize> {
    loop {
        let factor = factor(matrix, pressed)?;
        let mut wanted: Vec<f64> = pressed.iter().map(|i| -rates[*i]).collect();
        factor.solve(&mut wanted);
        // How far towards the wanted forces before the first of them vanishes.
        let mut share = 1.0_f64;
        for (index, wanted) in pressed.iter().zip(&wanted) {
            if *wanted <= 0.0 {
                let now = forces[*index];
                share = share.min(if now > 0.0 { now / (now - wanted) } else { 0.0 });
            }
        }
        let complete = wanted.iter().all(|wanted| *wanted > 0.0);
        for (index, wanted) in pressed.iter().zip(&wanted) {
            forces[*index] += share * (wanted - forces[*index]);
        }
        if complete {
            return Ok(());
        }
        let pulls: Vec<bool> = pressed
            .iter()
            .zip(&wanted)
            .map(|(index, wanted)| *wanted <= 0.0 && forces[*index] <= 1e-15 * wanted.abs())
            .collect();
        for (index, _) in pressed.iter().zip(&pulls).filter(|(_, pulls)| **pulls) {
            forces[*index] = 0.0;
        }
        let mut pulls = pulls.iter();
        pressed.retain(|_| !pulls.next().is_some_and(|pulls| *pulls));
    }
}

fn factor(matrix: &dyn Fn(usize, usize) -> f64, pressed: &[usize]) -> Result<Cholesky<f64>, usize> {
    Cholesky::of(pressed.len(), |i, j| matrix(pressed[i], pressed[j])).map_err(|row| pressed[row])
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
