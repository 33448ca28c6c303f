//! Engines that compute another model than the scene's, in words.

use super::format::code;
use crate::study::Summary;

/// Who computes another model than the scene's on purpose, a sentence for each way of it.
pub(super) fn other_models(summary: &Summary) -> Vec<String> {
    let mut ways: Vec<(&str, Vec<String>)> = Vec::new();
    for voice in &summary.voices {
        let Some(way) = voice.another_model else {
            continue;
        };
        let name = code(&voice.voice);
        match ways.iter_mut().find(|(known, _)| *known == way) {
            Some((_, names)) => names.push(name),
            None => ways.push((way, vec![name])),
        }
    }
    let told = |(way, names): &(&str, Vec<String>)| {
        let computes = if names.len() == 1 {
            "computes"
        } else {
            "compute"
        };
        format!(
            "**On purpose, {} {computes} another model here: {way}.** How far that leads from the \
             others is a difference between models, and no error.",
            names.join(", ")
        )
    };
    ways.iter().map(told).collect()
}
