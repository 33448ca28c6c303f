//! Which pens and colours the paths of a picture get, and the legend that explains them.

use plotters::style::RGBColor;

use super::legend::{Entry, Key};
use super::paths_figure::{PathBody, PathsFigure};
use super::theme::{COLOR_COUNT, LineStyle, PAPER, Pen, QUIET, color, mix};
use super::window::Window;

/// More bodies than this are not told apart by colour; the colour tells the voice.
const MOST_NAMED: usize = 12;
/// More bodies than this are drawn with plain thin lines.
pub(super) const MOST_DASHED: usize = 200;
/// Rings of a smaller radius in pixels have no pattern.
const SMALL_RING: f64 = 12.0;
/// Radius and pen of the ring at the end of a path, for a body of this radius in pixels
/// whose path `above` other voices may cover. On a small ring no pattern can be read, so
/// there each voice gets a larger ring than the next: at the same place they are nested.
pub(super) fn end_ring(radius: f64, pen: Pen, above: usize) -> (f64, Pen) {
    let share = match pen.style {
        LineStyle::Solid | LineStyle::Dashed => 0.6,
        // Enough dots for a ring.
        LineStyle::Dotted => 0.4,
    };
    let width = (pen.width * share).min(radius / 3.0);
    if radius >= SMALL_RING {
        return (radius - width / 2.0, Pen { width, ..pen });
    }
    let nested = (0..above).fold(0.0, |sum, _| sum + 1.4 * width);
    (radius - width / 2.0 + nested, Pen::solid(pen.color, width))
}

/// How many voices there are.
pub(super) fn voice_count(figure: &PathsFigure) -> usize {
    figure
        .bodies
        .iter()
        .map(|body| body.tracks.len())
        .max()
        .unwrap_or(0)
}

fn is_crowd(figure: &PathsFigure) -> bool {
    figure.bodies.len() > MOST_NAMED
}

/// The colour of a start disc: pale, so that what lies on it can be seen.
pub(super) fn start_color(figure: &PathsFigure, body: usize) -> RGBColor {
    if is_crowd(figure) {
        mix(QUIET, PAPER, 0.7)
    } else {
        mix(color(body), PAPER, 0.65)
    }
}

/// The pen of one body's track in one voice.
pub(super) fn pen(figure: &PathsFigure, body: usize, voice: usize) -> Pen {
    match figure.bodies.len() {
        0..=MOST_NAMED => Pen::of_voice(voice, color(body), 1.0),
        // Too many to be told apart: the colour tells the voice.
        13..=MOST_DASHED => Pen::of_voice(voice, color(voice), 0.65),
        _ => Pen::solid(color(voice), if voice == 0 { 3.0 } else { 1.5 }),
    }
}

/// The legend: bodies by colour, voices by line style, what the discs mean, and remarks.
pub(super) fn entries(figure: &PathsFigure, window: &Window) -> Vec<Vec<Entry>> {
    let crowd = is_crowd(figure);
    let bodies = if crowd {
        let count = format!("{} bodies", figure.bodies.len());
        vec![Entry::new(Key::Remark, count)]
    } else {
        let entry = |(i, body): (usize, &PathBody)| Entry::new(Key::Disc(color(i)), &*body.name);
        figure.bodies.iter().enumerate().map(entry).collect()
    };
    let voice_pen = |voice: usize| {
        if crowd {
            pen(figure, 0, voice)
        } else {
            Pen::of_voice(voice, QUIET, 1.0)
        }
    };
    let voices = figure.voices.iter().enumerate();
    let voices = voices.map(|(i, name)| Entry::new(Key::Line(voice_pen(i)), &**name));
    let mut discs = vec![
        Entry::new(Key::Disc(mix(QUIET, PAPER, 0.65)), "start"),
        Entry::new(Key::Ring(Pen::solid(QUIET, 4.0)), "end"),
    ];
    if figure.bodies.is_empty() {
        discs = vec![Entry::new(Key::Remark, "no bodies")];
    }
    if !crowd && figure.bodies.len() > COLOR_COUNT {
        discs.push(Entry::new(Key::Remark, "colours repeat"));
    }
    if window.leaving > 0 {
        let count = format!("{} of {}", window.leaving, figure.bodies.len());
        discs.push(Entry::new(
            Key::Remark,
            format!("{count} leave the picture"),
        ));
    }
    vec![bodies, voices.chain(discs).collect()]
}

#[cfg(test)]
mod tests {
    use super::super::paths_figure::{AxisLabel, View};
    use super::super::theme::INK;
    use super::super::window::window;
    use super::*;

    #[test]
    fn small_rings_at_the_same_place_are_nested() {
        let ring = |voice: usize| {
            let (radius, pen) = end_ring(7.0, Pen::of_voice(voice, INK, 1.0), 2 - voice);
            [radius - pen.width / 2.0, radius + pen.width / 2.0]
        };
        assert!(ring(0)[0] > ring(1)[1] && ring(1)[0] > ring(2)[1]);
        assert!(ring(2)[0] > 0.0);
    }

    #[test]
    fn a_crowd_is_counted_and_not_named() {
        let body = PathBody {
            name: "p0".to_owned(),
            radius: 1.0,
            tracks: vec![vec![[0.0, 0.0], [9.0, 3.0]]],
        };
        let crowd = PathsFigure {
            title: String::new(),
            subtitle: String::new(),
            axes: [AxisLabel::new("x", "mm"), AxisLabel::new("z", "mm")],
            view: View::Above,
            cushions: None,
            bodies: vec![body; 30],
            voices: vec!["lecture".to_owned()],
        };
        let groups = entries(&crowd, &window(&crowd));
        assert_eq!(groups[0], [Entry::new(Key::Remark, "30 bodies")]);
    }
}
