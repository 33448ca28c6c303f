//! Orders of convergence and limits for dt -> 0 of a study: each engine as it comes.

use serde::{Deserialize, Serialize};

use super::limit::ROUNDINGS;
use super::{
    CostPoint, Errors, OrderFit, SceneCost, Sensitivity, Series, Window, fit_order, limit,
};
use crate::compare::Limit;
use crate::engine::{EngineKind, EngineSpec, Precision};

/// A fitted error, a row of `orders.csv`.
#[derive(Debug, Clone, PartialEq)]
pub struct OrderRow {
    /// The engine.
    pub engine: String,
    /// Which error, as the column of `cost.csv` is called.
    pub error: &'static str,
    /// What the fit found.
    pub fit: OrderFit,
}

/// The limit of an engine's position error as the step goes to 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EngineLimit {
    /// The engine.
    pub engine: String,
    /// The limit; none if there are too few steps, or no later starts.
    pub limit: Option<Limit>,
}

/// An error by the name of its column, whether it is a length, and how it is found.
type Measure = (&'static str, Unit, fn(&Errors) -> Option<f64>);

/// What an error is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Unit {
    Length,
    Time,
    Share,
}

const MEASURES: [Measure; 5] = [
    ("position_error_rms", Unit::Length, |e| e.position_rms),
    ("position_error_max", Unit::Length, |e| e.position_max),
    ("event_time_error", Unit::Time, |e| e.event_time),
    ("energy_error", Unit::Share, |e| e.energy),
    ("local_error", Unit::Length, |e| e.local),
];

/// Errors above this share of the size are those of steps that are not small.
const SMALL: f64 = 0.02;

/// Rounding of one operation in the numbers that an engine computes with.
fn epsilon(spec: &EngineSpec) -> f64 {
    match &spec.kind {
        EngineKind::Rapier(settings) if settings.precision == Precision::Single => {
            f64::from(f32::EPSILON)
        }
        _ => f64::EPSILON,
    }
}

impl SceneCost {
    /// The order of every error of every engine that takes steps.
    #[must_use]
    pub fn orders(&self) -> Vec<OrderRow> {
        let rows = self.stepping().flat_map(|spec| {
            MEASURES.iter().map(|(error, unit, value)| OrderRow {
                engine: spec.name.clone(),
                error,
                fit: fit_order(
                    &self.series(&spec.name, *value).rms(),
                    self.window(spec, *unit),
                ),
            })
        });
        rows.collect()
    }

    /// What is left of the largest position error of every engine that takes steps: model,
    /// discretisation or rounding. The seed is that of the intervals.
    #[must_use]
    pub fn limits(&self, seed: u64) -> Vec<EngineLimit> {
        let of_engine = |spec: &EngineSpec| {
            let series = self.series(&spec.name, |errors| errors.position_max);
            EngineLimit {
                engine: spec.name.clone(),
                limit: limit(
                    &series,
                    self.window(spec, Unit::Length),
                    self.scene.duration,
                    seed,
                ),
            }
        };
        self.stepping().map(of_engine).collect()
    }

    fn stepping(&self) -> impl Iterator<Item = &EngineSpec> {
        let specs = self.engines.iter().map(|engine| &engine.spec);
        specs.filter(|spec| spec.takes_steps())
    }

    /// The errors of an engine as it comes, over all phases; of its one run where no later start
    /// could be had.
    fn series(&self, engine: &str, value: fn(&Errors) -> Option<f64>) -> Series {
        if self.phases.is_empty() {
            let point = |point: &CostPoint| Some((point.dt?, value(&point.errors)));
            return Series::new(&[self.stock(engine).filter_map(point).collect()]);
        }
        let phases = self.phases.iter();
        Series::new(
            &phases
                .map(|phase| phase.errors(engine, value))
                .collect::<Vec<_>>(),
        )
    }

    /// Rounding of the scene's size, carried along and made larger as a misplaced ball is.
    fn window(&self, spec: &EngineSpec, unit: Unit) -> Window {
        let amplified = self
            .sensitivity
            .as_ref()
            .map_or(1.0, Sensitivity::amplification);
        let floor = ROUNDINGS * epsilon(spec) * amplified;
        match unit {
            Unit::Length => Window {
                floor: floor * self.size,
                ceiling: SMALL * self.size,
            },
            Unit::Time => Window {
                floor: floor * self.priced_until,
                ceiling: SMALL * self.priced_until,
            },
            Unit::Share => Window {
                floor,
                ceiling: SMALL,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Phase;
    use super::super::testing::study;
    use super::*;
    use crate::compare::Remainder;

    /// Seven phases at which an engine's error is larger and larger.
    fn with_phases(mut study: SceneCost) -> SceneCost {
        study.phases = (0..7)
            .map(|place| {
                let later = |point: &CostPoint| {
                    let mut point = point.clone();
                    let factor = 1.0 + 0.01 * f64::from(place);
                    point.errors.position_max = point.errors.position_max.map(|e| e * factor);
                    point
                };
                Phase {
                    shift: f64::from(place),
                    points: study.points.iter().map(later).collect(),
                }
            })
            .collect();
        study
    }

    #[test]
    fn each_engine_has_its_order_and_its_word() {
        let ladder = |error: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
            (0..9).map(|k| (error(0.5_f64.powi(k)), 1.0)).collect()
        };
        let first = ladder(&|dt| 10.0 * dt);
        let other = ladder(&|dt| 3.0 + dt);
        let wild = ladder(&|dt| 500.0 + 400.0 * (1.0 / dt).sin());
        let alone = study(&[
            ("first", "stock", &first),
            ("other", "stock", &other),
            ("wild", "stock", &wild),
        ]);
        assert!(alone.limits(1).iter().all(|row| row.limit.is_none()));
        let study = with_phases(alone.clone());
        let limits = study.limits(1);
        let kinds: Vec<_> = limits.iter().map(|row| row.limit.unwrap().kind).collect();
        assert_eq!(
            kinds,
            [
                Remainder::Discretisation,
                Remainder::Model,
                Remainder::Unsettled
            ]
        );
        for study in [&alone, &study] {
            let orders = study.orders();
            let of = |engine: &str| {
                let row = orders
                    .iter()
                    .find(|row| row.engine == engine && row.error == "position_error_max");
                row.unwrap().fit.order
            };
            assert!((of("first").unwrap().order - 1.0).abs() < 1e-9);
            assert_eq!((of("other"), of("wild")), (None, None));
            assert_eq!(orders.len(), 15);
        }
    }
}
