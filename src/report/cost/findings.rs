//! What a study of cost found, in sentences: of one scene, and of all.

use std::collections::BTreeMap;

use crate::report::case_page::with_unit;
use crate::report::engineering;
use crate::report::format::code;
use crate::scene::LengthUnit;
use crate::study::cost::{
    Bid, CostSummary, EngineFamily, MAIN_TARGET, Offer, SceneCostSummary, Sensitivity,
};
use crate::study::median;

/// The engine that everything is held against.
const LECTURE: &str = "lecture";

fn takes_steps(offer: &Offer) -> bool {
    offer.family.takes_steps()
}

fn is_lecture(offer: &Offer) -> bool {
    offer.engine == LECTURE
}

fn is_rapier(offer: &Offer) -> bool {
    offer.family == EngineFamily::Rapier
}

/// The answers on one scene: who is cheapest at each accuracy, the lecture beside Rapier, and
/// where accuracy stops mattering.
pub(super) fn of_scene(scene: &SceneCostSummary) -> Vec<String> {
    let mut found = vec![cheapest(scene)];
    found.extend(lecture_and_rapier(scene));
    if let Some(off) = &scene.sensitivity {
        let unit = scene.length_unit.symbol();
        found.push(format!(
            "A better answer than {} is for nobody: {} placed {} off moves the result by as much.",
            with_unit(off.distance, unit),
            code(&off.body),
            placed_off(off, scene.length_unit)
        ));
    }
    found
}

/// How far off a ball was placed; what hands do is told in millimetres in any scene.
pub(super) fn placed_off(off: &Sensitivity, unit: LengthUnit) -> String {
    match unit {
        LengthUnit::None => engineering(off.moved),
        LengthUnit::Millimetre | LengthUnit::Centimetre | LengthUnit::Metre => {
            format!("{} mm", engineering(1e3 * off.moved / unit.per_metre()))
        }
    }
}

/// Step and setting of a bid.
pub(super) fn way(bid: &Bid) -> String {
    let step = bid.dt_s.map_or("no step".to_owned(), |dt| {
        format!("dt {} s", engineering(dt))
    });
    if bid.is_stock() {
        step
    } else {
        format!("{step}, {}", bid.setting)
    }
}

/// Who is cheapest of the engines that take steps; accuracies that cost the same are said once.
fn cheapest(scene: &SceneCostSummary) -> String {
    let best = |tag: &crate::study::cost::TagSummary| {
        let (offer, bid) = tag.cheapest(takes_steps)?;
        let price = engineering(bid.cost_ms_per_sim_s);
        Some(format!("{} ({}, {price})", code(&offer.engine), way(bid)))
    };
    let answers: Vec<_> = scene
        .tags
        .iter()
        .map(|tag| (&tag.name, best(tag)))
        .collect();
    let told = answers.chunk_by(|a, b| a.1 == b.1).map(|same| {
        let names: Vec<&str> = same.iter().map(|(name, _)| name.as_str()).collect();
        let answer = same[0].1.as_deref().unwrap_or("none within the budget");
        format!("for {} {answer}", listed(&names))
    });
    let told: Vec<_> = told.collect();
    format!(
        "Cheapest of the engines that take steps, in ms per simulated second: {}.",
        told.join("; ")
    )
}

/// The lecture's solver against the cheapest Rapier world, where both took part.
fn lecture_and_rapier(scene: &SceneCostSummary) -> Option<String> {
    let tag = scene.tags.get(MAIN_TARGET)?;
    let took_part = |asked: fn(&Offer) -> bool| tag.offers.iter().any(asked);
    if !took_part(is_lecture) || !took_part(is_rapier) {
        return None;
    }
    let name = &tag.name;
    let told = |bid: &Bid| format!("{} ({})", engineering(bid.cost_ms_per_sim_s), way(bid));
    let own = tag.cheapest(is_lecture);
    let world = tag.cheapest(is_rapier);
    Some(match (own, world) {
        (Some((_, own)), Some((offer, world))) => format!(
            "For {name} the lecture's solver takes {}, the cheapest Rapier world, {}, {}: {} times \
             as much, on this scene and at these steps.",
            told(own),
            code(&offer.engine),
            told(world),
            engineering(world.cost_ms_per_sim_s / own.cost_ms_per_sim_s)
        ),
        (Some((_, own)), None) => format!(
            "For {name} the lecture's solver takes {}; no Rapier world keeps it within the budget.",
            told(own)
        ),
        (None, Some((offer, world))) => format!(
            "For {name} the cheapest Rapier world, {}, takes {}; the lecture's solver does not \
             keep it within the budget.",
            code(&offer.engine),
            told(world)
        ),
        (None, None) => format!(
            "Neither the lecture's solver nor a Rapier world keeps {name} within the budget."
        ),
    })
}

/// The answer over all scenes in a sentence or two.
#[must_use]
pub(crate) fn headline(summary: &CostSummary) -> String {
    let tags: Vec<_> = summary
        .scenes
        .iter()
        .filter_map(|scene| scene.tags.get(MAIN_TARGET))
        .collect();
    let mut wins: BTreeMap<&str, usize> = BTreeMap::new();
    for (offer, _) in tags.iter().filter_map(|tag| tag.cheapest(takes_steps)) {
        *wins.entry(&offer.engine).or_default() += 1;
    }
    let mut ranked: Vec<_> = wins.iter().collect();
    // The sort is stable and the map is ordered: ties go by name.
    ranked.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let ranked: Vec<_> = ranked
        .iter()
        .map(|(engine, count)| format!("{} in {count}", code(engine)))
        .collect();
    let ranked = if ranked.is_empty() {
        "none in any".to_owned()
    } else {
        ranked.join(", ")
    };
    let kept = |asked: fn(&Offer) -> bool| {
        let kept = tags.iter().filter(|tag| tag.cheapest(asked).is_some());
        kept.count()
    };
    let mut names: Vec<&str> = tags.iter().map(|tag| tag.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let ratios: Vec<Compared> = summary.scenes.iter().filter_map(Compared::of).collect();
    let ratio = if ratios.is_empty() {
        String::new()
    } else {
        format!(" {}", ratio_told(summary, &ratios))
    };
    let plural = if tags.len() == 1 { "" } else { "s" };
    format!(
        "Of the engines that take steps, the cheapest to keep {} is {ranked} of {} scene{plural}. \
         The lecture's solver keeps it in {}, a Rapier world at its best setting in {}.{ratio}",
        names.join(" or "),
        tags.len(),
        kept(is_lecture),
        kept(is_rapier)
    )
}

/// A scene on which both the lecture's solver and a Rapier world keep the main accuracy.
struct Compared {
    ratio: f64,
    bodies: usize,
    /// The steps of both, s.
    steps: [Option<f64>; 2],
}

impl Compared {
    fn of(scene: &SceneCostSummary) -> Option<Self> {
        let tag = scene.tags.get(MAIN_TARGET)?;
        let (_, world) = tag.cheapest(is_rapier)?;
        let (_, own) = tag.cheapest(is_lecture)?;
        Some(Self {
            ratio: world.cost_ms_per_sim_s / own.cost_ms_per_sim_s,
            bodies: scene.body_count(),
            steps: [own.dt_s, world.dt_s],
        })
    }
}

/// How many times as long a Rapier world takes: on which scenes, at which steps, in which build.
fn ratio_told(summary: &CostSummary, compared: &[Compared]) -> String {
    let ratios: Vec<f64> = compared.iter().map(|scene| scene.ratio).collect();
    let [least, most] = extremes(ratios.iter().copied()).map(engineering);
    let bodies = compared.iter().map(|scene| scene.bodies);
    let few = bodies.clone().min().unwrap_or(0);
    let many = bodies.max().unwrap_or(0);
    let steps = |place: usize| {
        let steps = compared.iter().filter_map(|scene| scene.steps[place]);
        let [fine, coarse] = extremes(steps).map(engineering);
        if fine == coarse {
            format!("{fine} s")
        } else {
            format!("{fine} to {coarse} s")
        }
    };
    let version = |name: &str| {
        let versions = &summary.made.versions;
        versions.get(name).map_or("", String::as_str).to_owned()
    };
    let plural = if compared.len() == 1 { "" } else { "s" };
    format!(
        "On the {} scene{plural} of {few} to {many} bodies on which both keep it, each at its \
         cheapest setting and step for it (the lecture's solver {}, Rapier {}), the cheapest \
         Rapier world (rapier3d {}, one thread{}) took {} times ({least} to {most}) the time of a \
         solver that knows only spheres and walls.",
        compared.len(),
        steps(0),
        steps(1),
        version("rapier3d"),
        if summary.made.optimised {
            ""
        } else {
            ", not optimised"
        },
        engineering(median(&ratios)),
    )
}

/// The least and the most; infinite where there is none.
fn extremes(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    values.fold(none, |[least, most], value| {
        [least.min(value), most.max(value)]
    })
}

/// Names as people list them.
fn listed(names: &[&str]) -> String {
    match names {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        names => names.join(""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::cost::testing::summary;

    #[test]
    fn accuracies_of_one_price_are_said_once_and_the_factor_is_theirs() {
        let summary = summary(&[
            ("lecture", EngineFamily::Impulse, &[0.5, 0.5, 2.0]),
            ("swept", EngineFamily::Impulse, &[0.25, 0.25, 0.25]),
            ("rapier", EngineFamily::Rapier, &[4.0, 5.0]),
        ]);
        let found = of_scene(&summary.scenes[0]);
        assert_eq!(
            found[0],
            "Cheapest of the engines that take steps, in ms per simulated second: for 10 mm, 1 mm \
             and 0.1 mm `swept` (dt 0.0100 s, 0.250); for 0.001 mm none within the budget."
        );
        assert!(
            found[1].contains("10.0 times as much, on this scene"),
            "{}",
            found[1]
        );
        assert_eq!(found.len(), 2);
        let all = headline(&summary);
        assert!(
            all.contains("to keep 1 mm is `swept` in 1 of 1 scene."),
            "{all}"
        );
        assert!(
            all.contains("took 10.0 times (10.0 to 10.0) the time of a solver"),
            "{all}"
        );
    }

    #[test]
    fn nobody_keeps_an_accuracy_and_nothing_is_compared_with_who_is_absent() {
        let none = summary(&[
            ("lecture", EngineFamily::Impulse, &[]),
            ("rapier", EngineFamily::Rapier, &[]),
        ]);
        let found = of_scene(&none.scenes[0]);
        assert!(found[1].starts_with("Neither"), "{}", found[1]);
        assert!(headline(&none).contains("to keep 1 mm is none in any of 1 scene."));
        let alone = summary(&[("lecture", EngineFamily::Impulse, &[1.0])]);
        assert_eq!(of_scene(&alone.scenes[0]).len(), 1);
    }
}
