//! The work-precision picture of a scene.

use super::colors::{Look, looks};
use super::findings::{placed_off, way};
use crate::error::{Error, Result};
use crate::report::chart::{Answer, Goal, Weight, WorkCurve, WorkFigure, WorkPoint, work};
use crate::report::engineering;
use crate::study::cost::{
    CostPoint, EngineFamily, Offer, SceneCost, SceneCostSummary, TagSummary, pareto_front,
};

/// Errors below this share of the finest accuracy asked for are all alike in the picture: what
/// is left of them is rounding, and it would squeeze all others to the side.
const LEAST_SHARE: f64 = 1e-3;

/// Draws price over error of every engine.
pub(super) fn work_precision_png(cost: &SceneCost, summary: &SceneCostSummary) -> Result<Vec<u8>> {
    work(&figure(cost, summary)).map_err(|wrong| Error::Picture {
        name: "work-precision",
        message: wrong.to_string(),
    })
}

/// Error and price of a point that has both.
fn pair(point: &CostPoint) -> Option<[f64; 2]> {
    Some([point.error()?, point.cost()?])
}

/// The cheapest way with steps to an accuracy: the place of the engine, and how.
fn answer(tag: &TagSummary, looks: &[Look]) -> Option<Answer> {
    let (offer, bid) = tag.cheapest(|offer| offer.family.takes_steps())?;
    let place = tag.offers.iter().position(|other| other == offer)?;
    Some(Answer {
        who: offer.engine.clone(),
        color: looks.get(place)?.color,
        how: way(bid),
        at: [bid.position_error_max, bid.cost_ms_per_sim_s],
    })
}

fn figure(cost: &SceneCost, summary: &SceneCostSummary) -> WorkFigure {
    let unit = summary.length_unit.symbol();
    let offers = summary.tags.first().map_or(&[][..], |tag| &tag.offers);
    let families: Vec<EngineFamily> = offers.iter().map(|offer| offer.family).collect();
    let looks = looks(&families);
    let goals = summary.tags.iter().rev().map(|tag| Goal {
        error: tag.position_error_max,
        name: tag.name.clone(),
        answer: answer(tag, &looks),
    });
    let goals: Vec<Goal> = goals.collect();
    let is_named = |engine: &str| {
        let mut answers = goals.iter().filter_map(|goal| goal.answer.as_ref());
        answers.any(|answer| answer.who == engine)
    };
    let first = offers
        .iter()
        .find(|offer| offer.family == EngineFamily::Impulse);
    let weight = |offer: &Offer| match offer.family {
        EngineFamily::Rapier | EngineFamily::Exact => Weight::Main,
        EngineFamily::Impulse if Some(offer) == first || is_named(&offer.engine) => Weight::Main,
        EngineFamily::Impulse => Weight::Aside,
    };
    let curves = offers.iter().zip(&looks);
    let curves = curves.map(|(offer, look)| curve(cost, &offer.engine, *look, weight(offer)));
    let pairs: Vec<[f64; 2]> = cost.points.iter().filter_map(pair).collect();
    let until = summary.compared_until_s.map_or_else(
        || "against each one's own finest step".to_owned(),
        |until| format!("until {} s", engineering(until)),
    );
    let sensitivity = summary.sensitivity.as_ref();
    WorkFigure {
        title: summary.title.clone(),
        subtitle: format!("what accuracy costs; errors {until}; steps beside the ends of curves"),
        x_label: if unit.is_empty() {
            "largest position error".to_owned()
        } else {
            format!("largest position error [{unit}]")
        },
        y_label: "ms per simulated second".to_owned(),
        least: goals.first().map_or(0.0, |goal| LEAST_SHARE * goal.error),
        curves: curves.collect(),
        front: pareto_front(&pairs)
            .into_iter()
            .map(|place| pairs[place])
            .collect(),
        enough: sensitivity.map(|off| {
            let moved = placed_off(off, summary.length_unit);
            (off.distance, format!("a ball {moved} off"))
        }),
        goals,
    }
}

fn curve(cost: &SceneCost, engine: &str, look: Look, weight: Weight) -> WorkCurve {
    let label = |dt: f64| format!("{} s", engineering(dt));
    let point = |point: &CostPoint| {
        let [error, price] = pair(point)?;
        Some(WorkPoint {
            error,
            price,
            label: point.dt.map_or_else(String::new, label),
        })
    };
    let others = cost.points.iter();
    let others = others.filter(|point| point.engine == engine && !point.is_stock());
    WorkCurve {
        label: engine.to_owned(),
        color: look.color,
        line: look.line,
        weight,
        points: cost.stock(engine).filter_map(point).collect(),
        others: others.filter_map(pair).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::cost::testing::study;

    /// The answers stand from small errors to large ones, and who gives one is drawn strongly.
    #[test]
    fn the_picture_names_the_cheapest_for_each_accuracy() {
        let cost = study(&[
            ("a", "stock", &[(5.0, 3.0), (0.5, 4.0)]),
            ("b", "stock", &[(5.0, 2.0), (2.0, 3.0)]),
            ("c", "stock", &[(50.0, 9.0)]),
        ]);
        let summary = SceneCostSummary::of(&cost, 1).unwrap();
        let figure = figure(&cost, &summary);
        let said = figure.goals.iter().map(|goal| {
            let answer = goal.answer.as_ref();
            (&*goal.name, answer.map(|answer| (&*answer.who, answer.at)))
        });
        assert_eq!(
            said.collect::<Vec<_>>(),
            [
                ("0.001 mm", None),
                ("0.1 mm", None),
                ("1 mm", Some(("a", [0.5, 4.0]))),
                ("10 mm", Some(("b", [5.0, 2.0])))
            ]
        );
        let weights: Vec<_> = figure.curves.iter().map(|curve| curve.weight).collect();
        assert_eq!(weights, [Weight::Main, Weight::Main, Weight::Aside]);
        assert_eq!(figure.front, [[0.5, 4.0], [2.0, 3.0], [5.0, 2.0]]);
        assert!((figure.least - 1e-6).abs() < 1e-18);
    }
}
