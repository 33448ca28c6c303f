//! Colours, line styles and sizes shared by all pictures.

use plotters::style::RGBColor;

/// Width and height of every picture, in pixels.
pub(super) const SIZE: [u32; 2] = [1440, 900];
/// The same as lengths on the canvas.
pub(super) const CANVAS: [f64; 2] = [1440.0, 900.0];
/// Free space along the edges of the picture, in pixels.
pub(super) const MARGIN: f64 = 40.0;

/// Height of the letters of the title, in pixels.
pub(super) const TITLE_PX: f64 = 38.0;
/// Height of the letters of axis names and legends, in pixels.
pub(super) const LABEL_PX: f64 = 27.0;
/// Height of the smallest letters: subtitle, tick labels and notes, in pixels. At this
/// height the digits of the font are 16 pixels wide, so that equal digits of tick
/// labels become equal pixels, which compress well.
pub(super) const SMALL_PX: f64 = 16.0 * 2048.0 / 1303.0;

/// Text that names something.
pub(super) const INK: RGBColor = RGBColor(0x1F, 0x1F, 0x1F);
/// Text that explains something.
pub(super) const QUIET: RGBColor = RGBColor(0x55, 0x55, 0x55);
/// Lines of the grid.
pub(super) const GRID: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);
/// The frame around a plot.
pub(super) const FRAME: RGBColor = RGBColor(0x9C, 0x9C, 0x9C);
/// The paper.
pub(super) const PAPER: RGBColor = RGBColor(0xFF, 0xFF, 0xFF);
/// The cushions of a table.
pub(super) const CUSHION: RGBColor = RGBColor(0x4F, 0x4F, 0x4F);

/// The colours of Okabe and Ito, told apart by colour-blind readers too; the pale
/// yellow comes last because it is the weakest on white.
const COLORS: [RGBColor; 8] = [
    RGBColor(0x00, 0x72, 0xB2),
    RGBColor(0xD5, 0x5E, 0x00),
    RGBColor(0x00, 0x9E, 0x73),
    RGBColor(0xCC, 0x79, 0xA7),
    RGBColor(0xE6, 0x9F, 0x00),
    RGBColor(0x56, 0xB4, 0xE9),
    RGBColor(0x30, 0x30, 0x30),
    RGBColor(0xD8, 0xCB, 0x20),
];

/// How many colours there are before they repeat.
pub const COLOR_COUNT: usize = COLORS.len();

/// The colour with this index; they repeat after [`COLOR_COUNT`].
pub(super) fn color(index: usize) -> RGBColor {
    COLORS[index % COLORS.len()]
}

/// `color` moved towards `target` by `share` (0: unchanged, 1: `target`).
pub(super) fn mix(color: RGBColor, target: RGBColor, share: f64) -> RGBColor {
    let channel = |from: u8, to: u8| {
        let value = f64::from(from) + (f64::from(to) - f64::from(from)) * share;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between two bytes, so a byte"
        )]
        let byte = value.round() as u8;
        byte
    };
    RGBColor(
        channel(color.0, target.0),
        channel(color.1, target.1),
        channel(color.2, target.2),
    )
}

/// Width of a dashed line in pixels.
pub(super) const DASHED_PX: f64 = 4.5;
/// Length of a dash, without its round ends, in widths of the line.
const DASH: f64 = 2.0;
/// Length of the gap between two dashes, with their round ends, in widths of the line.
const GAP: f64 = 2.8;
/// A dot is this many times as wide as the dashed line whose gaps it fits.
pub(super) const DOT: f64 = 1.5;

/// How a line is broken, which is what tells the engines ("voices") apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineStyle {
    /// Unbroken.
    Solid,
    /// Long pieces.
    Dashed,
    /// Dots.
    Dotted,
}

impl LineStyle {
    /// The style of the voice with this index: solid, dashed, dotted, and again.
    #[must_use]
    pub fn of_voice(voice: usize) -> Self {
        [Self::Solid, Self::Dashed, Self::Dotted][voice % 3]
    }
}

/// What a line is drawn with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pen {
    /// Colour.
    pub(super) color: RGBColor,
    /// Width in pixels.
    pub(super) width: f64,
    /// How the line is broken.
    pub(super) style: LineStyle,
}

impl Pen {
    /// An unbroken line.
    pub(super) fn solid(color: RGBColor, width: f64) -> Self {
        Self {
            color,
            width,
            style: LineStyle::Solid,
        }
    }

    /// Length of the ink of one piece of the pattern in pixels; 0 for a dot.
    pub(super) fn dash(&self) -> f64 {
        match self.style {
            LineStyle::Solid => f64::INFINITY,
            LineStyle::Dashed => DASH * self.width,
            LineStyle::Dotted => 0.0,
        }
    }

    /// Length of the gap between two pieces, between the centres of two dots, in pixels.
    pub(super) fn gap(&self) -> f64 {
        match self.style {
            LineStyle::Solid => 0.0,
            LineStyle::Dashed => GAP * self.width,
            LineStyle::Dotted => (DASH + GAP) * self.width / DOT,
        }
    }

    /// How far from the start of a line its first dot is, in pixels: on a line that is
    /// dashed too, the dots fall into the gaps.
    pub(super) fn lead(&self) -> f64 {
        (DASH + GAP / 2.0) * self.width / DOT
    }

    /// Width of the white rim around a dot in pixels.
    pub(super) fn halo(&self) -> f64 {
        0.18 * self.width
    }

    /// The pen of a voice drawn in a colour it shares with other voices: the first is
    /// wide and pale and lies beneath, the others are narrower and in the full colour on
    /// top, so that voices which coincide all stay visible. `share` scales the width.
    pub(super) fn of_voice(voice: usize, color: RGBColor, share: f64) -> Self {
        let style = LineStyle::of_voice(voice);
        let (color, width) = match style {
            LineStyle::Solid => (mix(color, PAPER, 0.55), 11.0),
            LineStyle::Dashed => (color, DASHED_PX),
            LineStyle::Dotted => (color, DASHED_PX * DOT),
        };
        Self {
            color,
            width: width * share,
            style,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_differ_and_then_repeat() {
        for a in 0..COLOR_COUNT {
            for b in 0..a {
                assert_ne!(color(a), color(b), "{a} and {b}");
            }
        }
        assert_eq!(color(COLOR_COUNT), color(0));
    }

    #[test]
    fn mix_moves_from_one_color_to_the_other() {
        assert_eq!(mix(INK, PAPER, 0.0), INK);
        assert_eq!(mix(INK, PAPER, 1.0), PAPER);
        assert_eq!(
            mix(RGBColor(0, 100, 200), RGBColor(100, 100, 100), 0.5),
            RGBColor(50, 100, 150)
        );
    }

    #[test]
    fn first_voice_is_the_widest_and_palest() {
        let pens: Vec<Pen> = (0..3).map(|i| Pen::of_voice(i, color(0), 1.0)).collect();
        assert!(pens[0].width > pens[1].width);
        assert!(pens[0].color.0 > pens[1].color.0);
        assert_eq!(pens[1].style, LineStyle::Dashed);
        assert_eq!(pens[2].style, LineStyle::Dotted);
    }

    #[test]
    fn every_voice_keeps_the_hue_of_its_body() {
        for i in 0..COLOR_COUNT {
            let RGBColor(r, g, b) = color(i);
            for voice in 0..3 {
                let ink = Pen::of_voice(voice, color(i), 1.0).color;
                // Differences of the channels make the hue: paler by at most 60 %.
                for (own, ink) in [((r, g), (ink.0, ink.1)), ((g, b), (ink.1, ink.2))] {
                    let own = f64::from(own.0) - f64::from(own.1);
                    let ink = f64::from(ink.0) - f64::from(ink.1);
                    let (most, least) = (own.abs() + 1.0, 0.4 * own.abs() - 1.0);
                    assert!(
                        (least..=most).contains(&(ink * own.signum())),
                        "{i} {voice}"
                    );
                }
            }
        }
    }

    #[test]
    fn dots_fit_into_the_gaps_of_dashes() {
        let [dashed, dotted] = [1, 2].map(|voice| Pen::of_voice(voice, INK, 0.65));
        let period = dashed.dash() + dashed.gap();
        assert!((dotted.gap() - period).abs() < 1e-9);
        let free = dashed.gap() - dashed.width;
        assert!(dotted.width <= free, "{} in {free}", dotted.width);
        assert!((dotted.lead() - dashed.dash() - dashed.gap() / 2.0).abs() < 1e-9);
    }
}
