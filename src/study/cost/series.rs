//! An error over a ladder of steps, at several phases of the steps.

/// Errors of one engine: at each step of the ladder, one for each phase.
///
/// Shape of the errors: `[rung][phase]`, rungs from fine to coarse.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    rungs: Vec<(f64, Vec<f64>)>,
    phases: usize,
}

impl Series {
    /// From the (dt, error) of every phase, in any order.
    ///
    /// A phase in which nothing has this error (no impact, say) is left out, and then every rung
    /// at which one of the others has none: all rungs average over the same phases.
    #[must_use]
    pub fn new(phases: &[Vec<(f64, Option<f64>)>]) -> Self {
        let has_some = |phase: &&Vec<(f64, Option<f64>)>| phase.iter().any(|(_, e)| e.is_some());
        let kept: Vec<_> = phases.iter().filter(has_some).collect();
        let mut steps: Vec<f64> = kept
            .iter()
            .flat_map(|p| p.iter().map(|(dt, _)| *dt))
            .collect();
        steps.sort_by(f64::total_cmp);
        steps.dedup();
        let at = |dt: f64| {
            let of_phase = |phase: &&Vec<(f64, Option<f64>)>| {
                let found = phase.iter().find(|(step, _)| *step == dt)?;
                found.1
            };
            let errors: Option<Vec<f64>> = kept.iter().map(of_phase).collect();
            Some((dt, errors?))
        };
        Self {
            rungs: steps.into_iter().filter_map(at).collect(),
            phases: kept.len(),
        }
    }

    /// How many phases have the error.
    #[must_use]
    pub fn phases(&self) -> usize {
        self.phases
    }

    /// (dt, error) from fine to coarse, the error being the root mean square over the phases.
    ///
    /// Why not the geometric mean: what is found by overlap is found late by a share u of the
    /// step, uniform over the phases, and errs by c u dt. The mean of ln u is off by 1 (the
    /// standard deviation of ln u) over the root of the number of phases, the root mean square
    /// by 0.45 of itself, (4/45)^(1/2) / (2/3), over the same root: a lucky phase near u = 0 has
    /// no weight of its own. Both have the order of the error, since u does not depend on dt.
    #[must_use]
    pub fn rms(&self) -> Vec<[f64; 2]> {
        self.drawn(&(0..self.phases).collect::<Vec<_>>())
    }

    /// The same over these phases, some of them perhaps more than once.
    pub(super) fn drawn(&self, phases: &[usize]) -> Vec<[f64; 2]> {
        let mean = |errors: &Vec<f64>| {
            // Not the square of errors below 1e-154, which would vanish.
            let largest = phases.iter().map(|at| errors[*at]).fold(0.0, f64::max);
            if largest == 0.0 {
                return 0.0;
            }
            let (mut squares, mut count) = (0.0, 0.0);
            for at in phases {
                squares += (errors[*at] / largest).powi(2);
                count += 1.0;
            }
            largest * (squares / f64::max(count, 1.0)).sqrt()
        };
        let rungs = self.rungs.iter();
        rungs.map(|(dt, errors)| [*dt, mean(errors)]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_rungs_average_over_the_same_phases() {
        let phases = [
            vec![(1.0, None), (0.5, Some(3.0)), (0.25, Some(1.0))],
            vec![(1.0, Some(9.0)), (0.5, Some(4.0)), (0.25, Some(7.0))],
            vec![(1.0, None), (0.5, None), (0.25, None)],
        ];
        let series = Series::new(&phases);
        assert_eq!(series.phases(), 2);
        assert_eq!(series.rms(), [[0.25, 5.0], [0.5, 12.5_f64.sqrt()]]);
        assert_eq!(series.drawn(&[1, 1]), [[0.25, 7.0], [0.5, 4.0]]);
        assert_eq!(Series::new(&[]).rms(), [[0.0; 2]; 0]);
    }

    #[test]
    fn tiny_errors_do_not_vanish() {
        let series = Series::new(&[vec![(1.0, Some(3e-200))], vec![(1.0, Some(4e-200))]]);
        assert!((series.rms()[0][1] / 12.5_f64.sqrt() / 1e-200 - 1.0).abs() < 1e-14);
    }

    /// The two standard deviations of the documentation, by the midpoint rule over u.
    #[test]
    fn the_root_mean_square_scatters_less_than_the_geometric_mean() {
        let count = 100_000;
        let mean = |value: &dyn Fn(f64) -> f64| {
            let at = |place: u32| value((f64::from(place) + 0.5) / f64::from(count));
            (0..count).map(at).sum::<f64>() / f64::from(count)
        };
        let spread = |value: &dyn Fn(f64) -> f64| {
            let middle = mean(value);
            mean(&|u| (value(u) - middle).powi(2)).sqrt()
        };
        // The relative error of a root is half that of what is under it.
        let of_rms = 0.5 * spread(&|u| u * u) / mean(&|u| u * u);
        // Midpoints of a logarithmic singularity err by about 1/count.
        assert!((of_rms - 0.447_213_595).abs() < 1e-6, "{of_rms}");
        assert!((spread(&f64::ln) - 1.0).abs() < 1e-3);
    }
}
