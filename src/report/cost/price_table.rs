//! The price tag of a scene as a table: on the page of the study and on that of the case.

use serde::Serialize;

use super::findings::way;
use crate::report::engineering;
use crate::study::cost::{Bid, Offer, SceneCostSummary, TagSummary};

/// A row of a table: who, and a cell for each column.
#[derive(Debug, Serialize)]
pub(super) struct Row {
    pub(super) engine: String,
    pub(super) cells: Vec<String>,
}

/// What stands where there is nothing to say.
pub(super) const NOTHING: &str = "–";

/// A column for each accuracy, the cheapest engine of each in bold, and one for what is left of
/// the error as the step goes to 0.
#[derive(Debug, Serialize)]
pub(crate) struct PriceTable {
    header: Vec<String>,
    rows: Vec<Row>,
}

impl PriceTable {
    pub(super) fn of(scene: &SceneCostSummary) -> Self {
        let mut header: Vec<String> = scene.tags.iter().map(|tag| tag.name.clone()).collect();
        header.push("left as dt → 0".to_owned());
        let best: Vec<Option<&str>> = scene.tags.iter().map(winner).collect();
        let engines = scene.tags.first().map_or(&[][..], |tag| &tag.offers);
        let row = |(place, offer): (usize, &Offer)| {
            let tags = scene.tags.iter().zip(&best);
            let prices = tags.map(|(tag, best)| {
                let offer = tag.offers.get(place)?;
                let text = price(offer.bid.as_ref()?);
                let is_best = *best == Some(offer.engine.as_str());
                Some(if is_best { format!("**{text}**") } else { text })
            });
            let limit = scene.limits.iter().find(|row| row.engine == offer.engine);
            let word = limit.and_then(|row| Some(row.limit?.kind.word().to_owned()));
            let cells = prices.chain([word]);
            Row {
                engine: offer.engine.clone(),
                cells: cells.map(|cell| cell.unwrap_or(NOTHING.into())).collect(),
            }
        };
        Self {
            header,
            rows: engines.iter().enumerate().map(row).collect(),
        }
    }
}

fn winner(tag: &TagSummary) -> Option<&str> {
    let (offer, _) = tag.cheapest(|_| true)?;
    Some(&offer.engine)
}

/// A price with how it is had.
fn price(bid: &Bid) -> String {
    format!("{} ({})", engineering(bid.cost_ms_per_sim_s), way(bid))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::cost::EngineFamily;
    use crate::study::cost::testing::summary;

    #[test]
    fn each_accuracy_has_its_column_and_its_winner() {
        let summary = summary(&[
            ("lecture", EngineFamily::Impulse, &[0.5]),
            ("rapier", EngineFamily::Rapier, &[4.0, 5.0]),
        ]);
        let table = PriceTable::of(&summary.scenes[0]);
        assert_eq!(
            table.header,
            ["10 mm", "1 mm", "0.1 mm", "0.001 mm", "left as dt → 0"]
        );
        let cells = |row: usize| table.rows[row].cells.clone();
        assert_eq!(
            cells(0),
            [
                "**0.500 (dt 0.0100 s)**",
                NOTHING,
                NOTHING,
                NOTHING,
                NOTHING
            ]
        );
        assert_eq!(
            cells(1)[..2],
            ["4.00 (dt 0.0100 s)", "**5.00 (dt 0.0100 s)**"]
        );
    }
}
