//! Cells: which spheres are near enough to meet before one of them changes its cell.

use nalgebra::Vector3;

use crate::physics::real::Real;

/// No body.
const NONE: u32 = u32::MAX;

/// Cells are this much wider than the largest sphere, so that rounding in the place of a face
/// cannot hide a contact across two of them.
const MARGIN: f64 = 1.0 + 1e-6;

/// The face of a cell through which a sphere leaves it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Face {
    /// The axis that it is normal to.
    pub axis: usize,
    /// Whether it is the one towards larger coordinates.
    pub upper: bool,
}

/// Where a body is: its cell in endless space, and the one that stands for it in the table.
#[derive(Debug, Clone, Copy, Default)]
struct Place {
    cell: [i32; 3],
    folded: [u32; 3],
}

/// The bodies of a cell: the first few side by side in memory, more of them as a chain.
#[derive(Debug, Clone, Copy)]
struct Cell {
    /// From the front; `NONE` where there is no more.
    few: [u32; 3],
    /// First of the chain.
    more: u32,
}

const EMPTY: Cell = Cell {
    few: [NONE; 3],
    more: NONE,
};

/// Cubic cells at least as wide as the largest sphere, in a table that repeats in space.
///
/// Spheres in contact are in the same cell or in neighbours. As the table repeats, space may be
/// endless; cells far apart that share a place in the table cost time but hide nothing.
/// Source: Alder and Wainwright 1959; Smallenburg 2022, section 2.
#[derive(Debug, Clone)]
pub(super) struct Grid<R: Real> {
    side: R,
    origin: Vector3<R>,
    counts: [u32; 3],
    cells: Vec<Cell>,
    /// The next of a chain. Shape: `[body]`.
    next: Vec<u32>,
    places: Vec<Place>,
}

impl<R: Real> Grid<R> {
    /// Cells for spheres at these places, at most about one a sphere.
    pub fn new(positions: &[Vector3<R>], radius_max: R) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for position in positions {
            for axis in 0..3 {
                low[axis] = low[axis].min(position[axis].to_f64());
                high[axis] = high[axis].max(position[axis].to_f64());
            }
        }
        let diameter = 2.0 * MARGIN * radius_max.to_f64();
        let extent = [0, 1, 2].map(|axis| high[axis] - low[axis] + diameter);
        let side = side_of(&extent, diameter, positions.len());
        #[allow(clippy::cast_precision_loss, reason = "a bound")]
        let most = (4.0 * positions.len() as f64).min(1e6);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "side_of keeps the count of cells near the count of bodies"
        )]
        let counts = extent.map(|length| (length / side).ceil().clamp(1.0, most) as u32);
        let total = counts.iter().map(|n| *n as usize).product();
        let mut grid = Self {
            side: R::from_f64(side),
            origin: Vector3::from(low.map(|x| R::from_f64(x - 0.5 * diameter))),
            counts,
            cells: vec![EMPTY; total],
            next: vec![NONE; positions.len()],
            places: vec![Place::default(); positions.len()],
        };
        for (body, position) in positions.iter().enumerate() {
            grid.place(body, position);
        }
        grid
    }

    fn place(&mut self, body: usize, position: &Vector3<R>) {
        let mut place = Place::default();
        for axis in 0..3 {
            let cells = ((position[axis] - self.origin[axis]) / self.side).to_f64();
            #[allow(clippy::cast_possible_truncation, reason = "saturates far outside")]
            let cell = cells.floor() as i32;
            place.cell[axis] = cell;
            #[allow(
                clippy::cast_possible_wrap,
                clippy::cast_sign_loss,
                reason = "1e6 at most"
            )]
            let folded = cell.rem_euclid(self.counts[axis] as i32) as u32;
            place.folded[axis] = folded;
        }
        self.places[body] = place;
        self.link(body);
    }

    /// Whether an axis has cells to cross at all.
    pub fn is_divided(&self, axis: usize) -> bool {
        self.counts[axis] > 1
    }

    /// Coordinate of a face of a body's present cell.
    #[inline]
    pub fn coordinate(&self, body: usize, face: Face) -> R {
        let cell = self.places[body].cell[face.axis].saturating_add(i32::from(face.upper));
        self.origin[face.axis] + self.side * R::from_f64(f64::from(cell))
    }

    /// Puts a body into the cell beyond that face.
    pub fn cross(&mut self, body: usize, face: Face) {
        self.unlink(body);
        let (place, count) = (&mut self.places[body], self.counts[face.axis]);
        let (cell, folded) = (&mut place.cell[face.axis], &mut place.folded[face.axis]);
        if face.upper {
            *cell = cell.saturating_add(1);
            *folded = up(*folded, count);
        } else {
            *cell = cell.saturating_sub(1);
            *folded = down(*folded, count);
        }
        self.link(body);
    }

    /// Visits every other body in the cells around that of `body`; with a face, only those
    /// that came into reach by crossing it.
    #[inline]
    pub fn for_each_near(&self, body: usize, entered: Option<Face>, mut visit: impl FnMut(usize)) {
        let folded = self.places[body].folded;
        let mut columns = [0, 1, 2].map(|axis| around(folded[axis], self.counts[axis]));
        if let Some(Face { axis, upper }) = entered
            && self.counts[axis] > 2
        {
            let column = columns[axis].0[if upper { 2 } else { 1 }];
            columns[axis] = ([column; 3], 1);
        }
        let [xs, ys, zs] = &columns;
        for z in &zs.0[..zs.1] {
            for y in &ys.0[..ys.1] {
                let row = (z * self.counts[1] + y) as usize * self.counts[0] as usize;
                for x in &xs.0[..xs.1] {
                    let cell = &self.cells[row + *x as usize];
                    for other in cell.few.iter().take_while(|other| **other != NONE) {
                        if *other as usize != body {
                            visit(*other as usize);
                        }
                    }
                    let mut other = cell.more;
                    while other != NONE {
                        if other as usize != body {
                            visit(other as usize);
                        }
                        other = self.next[other as usize];
                    }
                }
            }
        }
    }

    fn slot(&self, body: usize) -> usize {
        let [x, y, z] = self.places[body].folded;
        (z * self.counts[1] + y) as usize * self.counts[0] as usize + x as usize
    }

    #[allow(clippy::cast_possible_truncation, reason = "fewer bodies than 2^32")]
    fn link(&mut self, body: usize) {
        let slot = self.slot(body);
        let cell = &mut self.cells[slot];
        if let Some(free) = cell.few.iter_mut().find(|place| **place == NONE) {
            *free = body as u32;
        } else {
            self.next[body] = cell.more;
            cell.more = body as u32;
        }
    }

    fn unlink(&mut self, body: usize) {
        let slot = self.slot(body);
        let cell = &mut self.cells[slot];
        if let Some(place) = cell.few.iter().position(|other| *other as usize == body) {
            // The gap is closed from the chain, else from behind.
            if cell.more != NONE {
                cell.few[place] = cell.more;
                cell.more = self.next[cell.more as usize];
                return;
            }
            let last = cell.few.iter().rposition(|other| *other != NONE);
            let last = last.unwrap_or(place);
            cell.few[place] = cell.few[last];
            cell.few[last] = NONE;
            return;
        }
        if cell.more as usize == body {
            cell.more = self.next[body];
            return;
        }
        let mut other = cell.more as usize;
        while self.next[other] as usize != body {
            other = self.next[other] as usize;
        }
        self.next[other] = self.next[body];
    }
}

/// Width of a cell: that of a sphere, or more where so many cells would be mostly empty.
fn side_of(extent: &[f64; 3], diameter: f64, bodies: usize) -> f64 {
    // Axes along which nothing spreads hold one cell; the others share the count of bodies.
    let spread: Vec<f64> = extent
        .iter()
        .copied()
        .filter(|x| *x > 2.0 * diameter)
        .collect();
    #[allow(clippy::cast_precision_loss, reason = "a size, not a result")]
    let (volume, count, axes) = (
        spread.iter().map(|x| x.log2()).sum::<f64>(),
        (bodies as f64).log2(),
        spread.len().max(1) as f64,
    );
    diameter.max(((volume - count) / axes).exp2())
}

#[inline]
fn up(folded: u32, count: u32) -> u32 {
    if folded + 1 == count { 0 } else { folded + 1 }
}

#[inline]
fn down(folded: u32, count: u32) -> u32 {
    if folded == 0 { count - 1 } else { folded - 1 }
}

/// The distinct places of a row within one cell of a place: itself, below, above.
#[inline]
fn around(folded: u32, count: u32) -> ([u32; 3], usize) {
    let places = [folded, down(folded, count), up(folded, count)];
    (places, count.min(3) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(grid: &Grid<f64>, body: usize) -> Vec<usize> {
        let mut found = Vec::new();
        grid.for_each_near(body, None, |other| found.push(other));
        found.sort_unstable();
        found
    }

    #[test]
    fn neighbours_are_found_across_cells_and_once_each() {
        let places: Vec<_> = (0..64)
            .map(|i| Vector3::new(f64::from(i % 8) * 2.0, f64::from(i / 8) * 2.0, 0.0))
            .collect();
        let grid = Grid::new(&places, 1.0);
        for (body, place) in places.iter().enumerate() {
            let found = near(&grid, body);
            assert!(found.windows(2).all(|pair| pair[0] < pair[1]));
            for (other, at) in places.iter().enumerate() {
                let touching = other != body && (place - at).norm() < 2.01;
                assert!(!touching || found.contains(&other), "{body} {other}");
            }
        }
    }

    /// Many spheres in few cells, in and out at random, against the places that they report.
    #[test]
    fn crowded_cells_lose_nobody() {
        let places: Vec<_> = (0..60)
            .map(|i| Vector3::new(f64::from(i) * 1e-3, 0.0, 0.0))
            .chain([Vector3::new(9.0, 0.0, 0.0)])
            .collect();
        let mut grid = Grid::new(&places, 1.0);
        let mut lot = 7_u64;
        for _ in 0..3000 {
            lot = lot.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let (body, upper) = ((lot >> 33) as usize % 61, lot >> 63 == 0);
            grid.cross(body, Face { axis: 0, upper });
            let at = |other: usize| i64::from(grid.places[other].folded[0]);
            let count = i64::from(grid.counts[0]);
            let expected: Vec<_> = (0..61)
                .filter(|other| {
                    let apart = (at(*other) - at(body)).rem_euclid(count);
                    *other != body && (apart <= 1 || apart == count - 1)
                })
                .collect();
            assert_eq!(near(&grid, body), expected);
        }
    }

    #[test]
    fn a_body_that_leaves_is_found_in_its_new_cell() {
        let places: Vec<_> = (0..60)
            .map(|i| Vector3::new(f64::from(i) * 9.0, 0.0, 0.0))
            .collect();
        let mut grid = Grid::new(&places, 1.0);
        let face = Face {
            axis: 0,
            upper: true,
        };
        assert!(!near(&grid, 0).contains(&30));
        while !near(&grid, 0).contains(&30) {
            grid.cross(0, face);
            assert!(grid.coordinate(0, face) < 270.0, "passed it by");
        }
        let mut entered = Vec::new();
        grid.for_each_near(0, Some(face), |other| entered.push(other));
        assert_eq!(entered, [30]);
    }
}
