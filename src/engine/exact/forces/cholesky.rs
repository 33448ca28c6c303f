//! Solving with a small symmetric positive matrix.

use super::scalar::Real;

/// The lower triangle L of `A = L Lᵀ`, rows laid flat.
#[derive(Debug, Clone)]
pub(super) struct Cholesky<T> {
    lower: Vec<T>,
    size: usize,
}

impl<T: Real> Cholesky<T> {
    /// Of no rows.
    pub(super) fn empty() -> Self {
        Self {
            lower: Vec::new(),
            size: 0,
        }
    }

    /// Factors the matrix `entry(i, j)`, of which it reads `j <= i`.
    ///
    /// # Errors
    /// The first row that depends on the rows before it: its pivot falls below `1e-11` of its
    /// diagonal, where two thirds of a double's digits are gone.
    pub(super) fn of(size: usize, entry: impl Fn(usize, usize) -> T) -> Result<Self, usize> {
        let mut lower = vec![T::zero(); size * size];
        for i in 0..size {
            for j in 0..=i {
                let mut sum = entry(i, j);
                let diagonal = sum.to_f64();
                for k in 0..j {
                    sum -= lower[i * size + k] * lower[j * size + k];
                }
                lower[i * size + j] = if i == j {
                    if !(sum.to_f64() > 1e-11 * diagonal && diagonal > 0.0) {
                        return Err(i);
                    }
                    sum.sqrt()
                } else {
                    sum / lower[j * size + j]
                };
            }
        }
        Ok(Self { lower, size })
    }

    /// Solves `A x = right` in place.
    pub(super) fn solve(&self, right: &mut [T]) {
        let size = self.size;
        for i in 0..size {
            let mut sum = right[i];
            let row = &self.lower[i * size..];
            for (entry, known) in row.iter().zip(&right[..i]) {
                sum -= *entry * *known;
            }
            right[i] = sum / row[i];
        }
        for i in (0..size).rev() {
            let mut sum = right[i];
            for (k, known) in right.iter().enumerate().skip(i + 1) {
                sum -= self.lower[k * size + i] * *known;
            }
            right[i] = sum / self.lower[i * size + i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_and_names_a_dependent_row() {
        let a: [[f64; 2]; 2] = [[4.0, 2.0], [2.0, 3.0]];
        let factor = Cholesky::of(2, |i, j| a[i][j]).unwrap();
        let mut x = [8.0, 8.0];
        factor.solve(&mut x);
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
        let dependent: [[f64; 2]; 2] = [[4.0, 2.0], [2.0, 1.0]];
        assert_eq!(Cholesky::of(2, |i, j| dependent[i][j]).unwrap_err(), 1);
    }
}
