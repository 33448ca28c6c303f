//! Solving with a small symmetric positive matrix.

use super::real::Real;

/// The lower triangle L of `A = L Lᵀ`, grown row by row.
#[derive(Debug, Clone)]
pub struct Cholesky<T> {
    /// Row i holds i + 1 entries.
    rows: Vec<Vec<T>>,
}

impl<T: Real> Cholesky<T> {
    /// Of no rows.
    #[must_use]
    pub fn empty() -> Self {
        Self { rows: Vec::new() }
    }

    /// Factors the matrix `entry(i, j)`, of which it reads `j <= i`, without the rows that
    /// depend on rows before them; with the rows that it kept.
    pub fn of(size: usize, entry: impl Fn(usize, usize) -> T) -> (Self, Vec<usize>) {
        let mut factor = Self::empty();
        let mut kept = Vec::with_capacity(size);
        for i in 0..size {
            let own = |j: usize| entry(i, *kept.get(j).unwrap_or(&i));
            if factor.grow(own).is_ok() {
                kept.push(i);
            }
        }
        (factor, kept)
    }

    /// Adds a row and its column; the order of `size` squared. Reads `entry(j)` up to the
    /// diagonal.
    ///
    /// # Errors
    /// The row depends on the rows before it, and nothing is added: its pivot falls below
    /// `1e-11` of its diagonal, where two thirds of a double's digits are gone.
    #[allow(
        clippy::result_unit_err,
        reason = "there is one thing that can be wrong"
    )]
    pub fn grow(&mut self, entry: impl Fn(usize) -> T) -> Result<(), ()> {
        let size = self.rows.len();
        let mut own: Vec<T> = Vec::with_capacity(size + 1);
        for (j, row) in self.rows.iter().enumerate() {
            let sum = subtract_products(entry(j), &own, row);
            own.push(sum / row[j]);
        }
        let diagonal = entry(size);
        let pivot = subtract_products(diagonal, &own, &own);
        if !(pivot.to_f64() > 1e-11 * diagonal.to_f64() && diagonal.to_f64() > 0.0) {
            return Err(());
        }
        own.push(pivot.sqrt());
        self.rows.push(own);
        Ok(())
    }

    /// Forgets all rows from that one on.
    pub fn truncate(&mut self, size: usize) {
        self.rows.truncate(size);
    }

    /// Solves `A x = right` in place.
    pub fn solve(&self, right: &mut [T]) {
        for (i, row) in self.rows.iter().enumerate() {
            right[i] = subtract_products(right[i], row, &right[..i]) / row[i];
        }
        for (i, row) in self.rows.iter().enumerate().rev() {
            let known = right[i] / row[i];
            right[i] = known;
            for (left, entry) in right[..i].iter_mut().zip(row) {
                *left -= *entry * known;
            }
        }
    }
}

/// `sum - a . b`, as far as the shorter reaches.
#[inline]
fn subtract_products<T: Real>(sum: T, a: &[T], b: &[T]) -> T {
    let products = a.iter().zip(b);
    products.fold(sum, |sum, (a, b)| sum - *a * *b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_and_leaves_out_a_dependent_row() {
        let a: [[f64; 2]; 2] = [[4.0, 2.0], [2.0, 3.0]];
        let (factor, kept) = Cholesky::of(2, |i, j| a[i][j]);
        assert_eq!(kept, [0, 1]);
        let mut x = [8.0, 8.0];
        factor.solve(&mut x);
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
        let (mut grown, _) = Cholesky::of(2, |i, j| a[i][j]);
        grown.truncate(1);
        grown.grow(|j| a[1][j]).unwrap();
        assert_eq!(grown.rows, factor.rows);
        let dependent = [[4.0, 2.0, 2.0], [2.0, 1.0, 1.0], [2.0, 1.0, 3.0]];
        let (factor, kept) = Cholesky::of(3, |i, j| dependent[i][j]);
        assert_eq!(kept, [0, 2]);
        let mut x = [6.0, 5.0];
        factor.solve(&mut x);
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 1.0).abs() < 1e-15);
    }
}
