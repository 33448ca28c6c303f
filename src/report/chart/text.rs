//! Text that fits: in letters that the font has, measured, wrapped at words, shortened
//! with an ellipsis.

use std::borrow::Cow;
use std::sync::LazyLock;

use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};

use super::ChartError;

/// The family under which the carried font is known to plotters and to resvg.
pub(super) const FAMILY: &str = "DejaVu Sans";
/// plotters' font size for letters of one pixel; its SVG backend divides by it.
pub(super) const SIZE_PER_PX: f64 = 1.24;
/// No text in a picture is longer; spares measuring what cannot fit.
const LONGEST: usize = 300;

/// The font, to be asked for letters.
static FACE: LazyLock<Option<ttf_parser::Face>> =
    LazyLock::new(|| ttf_parser::Face::parse(dejavu::sans::regular(), 0).ok());

/// Makes the font known to plotters, which measures with it.
pub(super) fn register() -> Result<(), ChartError> {
    register_font(FAMILY, FontStyle::Normal, dejavu::sans::regular()).map_err(|_| ChartError::Font)
}

/// Width of the text in pixels. Errs by 6 % to the safe side, because plotters takes
/// the size as the height from the deepest to the highest point of the letters.
pub(super) fn width(text: &str, px: f64) -> Result<f64, ChartError> {
    // Measured large, because plotters rounds to whole pixels.
    const MEASURED_PX: f64 = 1000.0;
    let size = MEASURED_PX * SIZE_PER_PX;
    let font = FontDesc::new(FontFamily::Name(FAMILY), size, FontStyle::Normal);
    let (width, _) = font
        .box_size(&drawable(text))
        .map_err(|_| ChartError::Font)?;
    Ok(f64::from(width) * px / MEASURED_PX)
}

/// The text, or as much of it as fits followed by an ellipsis.
pub(super) fn shortened(text: &str, px: f64, room: f64) -> Result<String, ChartError> {
    let text = clean(text);
    if width(&text, px)? <= room {
        return Ok(text);
    }
    let mut letters: Vec<char> = text.chars().collect();
    while letters.pop().is_some() {
        let kept: String = letters.iter().collect();
        let candidate = format!("{}…", kept.trim_end());
        if width(&candidate, px)? <= room {
            return Ok(candidate);
        }
    }
    Ok("…".to_owned())
}

/// The text in at most `most` lines, broken at spaces; what does not fit is shortened.
pub(super) fn wrapped(
    text: &str,
    px: f64,
    room: f64,
    most: usize,
) -> Result<Vec<String>, ChartError> {
    let text = clean(text);
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut lines = Vec::new();
    let mut start = 0;
    while start < words.len() {
        if lines.len() + 1 == most {
            lines.push(shortened(&words[start..].join(" "), px, room)?);
            break;
        }
        let mut end = start + 1;
        while end < words.len() && width(&words[start..=end].join(" "), px)? <= room {
            end += 1;
        }
        lines.push(shortened(&words[start..end].join(" "), px, room)?);
        start = end;
    }
    Ok(lines)
}

/// The text in letters that the font has: others are spelled in Latin ones (Korean,
/// Chinese, emoji by their names), or are "?" where nobody knows how.
pub(super) fn drawable(text: &str) -> Cow<'_, str> {
    let has = |c: char| {
        let known = |face: &ttf_parser::Face| face.glyph_index(c).is_some();
        c.is_ascii() || FACE.as_ref().is_none_or(known)
    };
    if text.chars().all(has) {
        return Cow::Borrowed(text);
    }
    let mut drawn = String::new();
    for c in text.chars() {
        if has(c) {
            drawn.push(c);
        } else {
            drawn.push_str(deunicode::deunicode_char(c).unwrap_or("?"));
        }
    }
    Cow::Owned(drawn)
}

/// The text without characters that SVG forbids or that have no width, and not endless.
fn clean(text: &str) -> String {
    let allowed = |c: char| !c.is_control() && !matches!(c, '\u{FFFE}' | '\u{FFFF}');
    let kept: String = text
        .chars()
        .take(LONGEST)
        .map(|c| if allowed(c) { c } else { ' ' })
        .collect();
    let mut cleaned = drawable(&kept).trim().to_owned();
    if text.chars().nth(LONGEST).is_some() {
        cleaned.push('…');
    }
    cleaned
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn width_follows_the_letters() {
        register().unwrap();
        let narrow = width("iiii", 20.0).unwrap();
        let wide = width("WWWW", 20.0).unwrap();
        assert!(narrow > 10.0 && wide > 2.0 * narrow, "{narrow} {wide}");
        let double = width("WWWW", 40.0).unwrap();
        assert!((double - 2.0 * wide).abs() < 0.2);
    }

    #[test]
    fn what_is_too_long_is_shortened_to_fit() {
        register().unwrap();
        let short = shortened("a rather long name of a body", 20.0, 120.0).unwrap();
        assert!(
            short.ends_with('…') && short.starts_with("a rath"),
            "{short}"
        );
        assert!(width(&short, 20.0).unwrap() <= 120.0);
        assert_eq!(shortened("cue", 20.0, 120.0).unwrap(), "cue");
    }

    #[test]
    fn wrapping_breaks_at_words_and_loses_none() {
        register().unwrap();
        let text = "one two three four five six seven";
        let lines = wrapped(text, 20.0, 150.0, 9).unwrap();
        assert!(lines.len() > 1);
        assert_eq!(lines.join(" "), text);
        let two = wrapped(text, 20.0, 150.0, 2).unwrap();
        assert_eq!(two.len(), 2);
        assert!(two[1].ends_with('…'), "{two:?}");
        assert!(wrapped("", 20.0, 150.0, 2).unwrap().is_empty());
    }

    #[test]
    fn letters_that_the_font_lacks_are_spelled_in_latin() {
        let cases = [
            ("당구공 1", "danggugong 1"),
            ("cue é Ω μ ° − … 10⁻⁵", "cue é Ω μ ° − … 10⁻⁵"),
            ("белый", "белый"),
            ("\u{E000}\u{10FFFD}", "??"),
        ];
        for (text, wanted) in cases {
            assert_eq!(drawable(text), wanted);
        }
        for text in [
            "台球 赤",
            "ビリヤード",
            "🎱 ⚽🏳️‍🌈",
            "한글",
            "\u{1112}\u{1161}\u{11AB}",
        ] {
            let drawn = drawable(text);
            let has = |c| FACE.as_ref().unwrap().glyph_index(c).is_some();
            assert!(drawn.chars().all(has), "{text}: {drawn}");
            assert!(drawn.trim().len() > 2, "{text}: {drawn}");
            assert_eq!(drawable(&drawn), drawn);
        }
        assert!(!clean("台球").contains('?'));
    }

    #[test]
    fn what_is_measured_and_kept_is_what_is_drawn() {
        register().unwrap();
        let (korean, latin) = (width("당구공", 20.0), width("danggugong", 20.0));
        assert_eq!(korean.unwrap(), latin.unwrap());
        let short = shortened(&"당구공 ".repeat(50), 20.0, 200.0).unwrap();
        assert!(short.starts_with("danggugong da"), "{short}");
    }

    #[test]
    fn control_characters_become_spaces() {
        assert_eq!(clean("a\u{0}b\n\u{FFFF}"), "a b");
        assert_eq!(clean(&"x".repeat(1000)).chars().count(), LONGEST + 1);
    }
}
