//! The picture of the price tag: a group for each accuracy, a bar for each engine.

use super::colors::family_color;
use crate::error::{Error, Result};
use crate::report::chart::{Bar, BarGroup, BarsFigure, bars};
use crate::report::engineering;
use crate::study::cost::{Bid, SceneCostSummary, TagSummary};

/// Draws what each accuracy costs on each engine.
pub(super) fn prices_png(scene: &SceneCostSummary) -> Result<Vec<u8>> {
    bars(&figure(scene)).map_err(|wrong| Error::Picture {
        name: "prices",
        message: wrong.to_string(),
    })
}

fn figure(scene: &SceneCostSummary) -> BarsFigure {
    let offers = scene.tags.first().map_or(&[][..], |tag| &tag.offers);
    BarsFigure {
        title: scene.title.clone(),
        subtitle: "cheapest step for an accuracy; outlined: cheapest of all; *: not the stock \
                   settings"
            .to_owned(),
        x_label: "ms per simulated second".to_owned(),
        rows: offers
            .iter()
            .map(|offer| (offer.engine.clone(), family_color(offer.family)))
            .collect(),
        groups: scene.tags.iter().map(group).collect(),
    }
}

fn group(tag: &TagSummary) -> BarGroup {
    let best = tag.cheapest(|_| true).map(|(offer, _)| &offer.engine);
    let bars = tag.offers.iter().map(|offer| {
        let bid = offer.bid.as_ref().ok_or("not reached")?;
        Ok(Bar {
            value: bid.cost_ms_per_sim_s,
            label: way(bid),
            is_best: best == Some(&offer.engine),
        })
    });
    BarGroup {
        name: tag.name.clone(),
        bars: bars.collect(),
    }
}

/// The step, with a mark if anything else was set too.
fn way(bid: &Bid) -> String {
    let step = bid.dt_s.map_or("no step".to_owned(), |dt| {
        format!("dt {} s", engineering(dt))
    });
    if bid.is_stock() {
        step
    } else {
        format!("{step} *")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::cost::EngineFamily;
    use crate::study::cost::testing::summary;

    #[test]
    fn who_does_not_get_there_says_so_and_the_cheapest_stands_out() {
        let mut summary = summary(&[
            ("lecture", EngineFamily::Impulse, &[0.5]),
            ("rapier", EngineFamily::Rapier, &[4.0, 5.0]),
        ]);
        let scene = &mut summary.scenes[0];
        if let Some(bid) = &mut scene.tags[0].offers[1].bid {
            "max_ccd_substeps=4".clone_into(&mut bid.setting);
        }
        let figure = figure(scene);
        let told = |group: usize| -> Vec<_> {
            let bars = figure.groups[group].bars.iter();
            bars.map(|bar| bar.as_ref().map(|bar| (&*bar.label, bar.is_best)))
                .map(|bar| bar.map_err(|reason| &**reason))
                .collect()
        };
        assert_eq!(
            told(0),
            [Ok(("dt 0.0100 s", true)), Ok(("dt 0.0100 s *", false))]
        );
        assert_eq!(told(1), [Err("not reached"), Ok(("dt 0.0100 s", true))]);
        assert_eq!(told(3), [Err("not reached"); 2]);
        assert_eq!(figure.rows.len(), 2);
    }
}
