//! Orders of convergence and verdicts of a study: each engine as it comes.

use super::{
    CostPoint, Errors, Limit, OrderFit, Remainder, SceneCost, Sensitivity, Window, fit_order, limit,
};
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

/// What is left of an engine's position error as the step goes to 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// The engine.
    pub engine: String,
    /// The limit; none if there are too few points.
    pub limit: Option<Limit>,
    /// Below this, an error is rounding, scene length unit.
    pub floor: f64,
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

/// Rounding of this many operations adds up before an error counts as more than rounding.
const ROUNDINGS: f64 = 64.0;
/// Errors above this share of the size are those of steps that are not small.
const SMALL: f64 = 0.02;

/// Large errors count as shrinking only if they fall at least about so steeply.
const STEEP: f64 = 0.7;

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
        let stepping = self
            .engines
            .iter()
            .filter(|engine| engine.spec.takes_steps());
        let rows = stepping.flat_map(|engine| {
            MEASURES.iter().map(|(error, unit, value)| OrderRow {
                engine: engine.spec.name.clone(),
                error,
                fit: fit_order(
                    &self.series(&engine.spec.name, *value),
                    self.window(&engine.spec, *unit),
                ),
            })
        });
        rows.collect()
    }

    /// The verdict on every engine that takes steps: model, discretisation or rounding.
    #[must_use]
    pub fn verdicts(&self) -> Vec<Verdict> {
        let stepping = self
            .engines
            .iter()
            .filter(|engine| engine.spec.takes_steps());
        let verdict = |spec: &EngineSpec| {
            let floor = self.window(spec, Unit::Length).floor;
            let series = self.series(&spec.name, |errors| errors.position_max);
            let limit = limit(&series, floor).map(|limit| self.sober(limit));
            Verdict {
                engine: spec.name.clone(),
                limit,
                floor,
            }
        };
        stepping.map(|engine| verdict(&engine.spec)).collect()
    }

    /// Errors that are not small tell nothing of the limit unless they fall from step to step:
    /// the engine does not yet tell the same story as the reference.
    fn sober(&self, limit: Limit) -> Limit {
        let is_small = limit.finest <= SMALL * self.size;
        let is_steady = limit.falls && limit.slope > Some(STEEP);
        let kind = match limit.kind {
            Remainder::Model if !is_small => Remainder::Unsettled,
            Remainder::Discretisation if !is_small && !is_steady => Remainder::Unsettled,
            kind => kind,
        };
        Limit { kind, ..limit }
    }

    /// (dt, error) of an engine as it comes.
    fn series(&self, engine: &str, value: fn(&Errors) -> Option<f64>) -> Vec<[f64; 2]> {
        let point = |point: &CostPoint| Some([point.dt?, value(&point.errors)?]);
        self.stock(engine).filter_map(point).collect()
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
    use super::super::testing::study;
    use super::*;

    #[test]
    fn each_engine_has_its_order_and_its_word() {
        let ladder = |error: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
            (0..9).map(|k| (error(0.5_f64.powi(k)), 1.0)).collect()
        };
        let first = ladder(&|dt| 10.0 * dt);
        let other = ladder(&|dt| 3.0 + dt);
        let wild = ladder(&|_| 900.0);
        let study = study(&[
            ("first", "stock", &first),
            ("other", "stock", &other),
            ("wild", "stock", &wild),
        ]);
        let kinds: Vec<_> = study
            .verdicts()
            .iter()
            .map(|v| v.limit.unwrap().kind)
            .collect();
        assert_eq!(
            kinds,
            [
                Remainder::Discretisation,
                Remainder::Model,
                Remainder::Unsettled
            ]
        );
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
