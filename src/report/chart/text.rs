//! Text that fits: measured, wrapped at words, shortened with an ellipsis.

use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};

use super::ChartError;

/// The family under which the carried font is known to plotters and to resvg.
pub(super) const FAMILY: &str = "DejaVu Sans";
/// plotters' font size for letters of one pixel; its SVG backend divides by it.
pub(super) const SIZE_PER_PX: f64 = 1.24;
/// No text in a picture is longer; spares measuring what cannot fit.
const LONGEST: usize = 300;

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
    let (width, _) = font.box_size(text).map_err(|_| ChartError::Font)?;
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

/// The text without characters that SVG forbids or that have no width, and not endless.
fn clean(text: &str) -> String {
    let allowed = |c: char| !c.is_control() && !matches!(c, '\u{FFFE}' | '\u{FFFF}');
    let mut cleaned: String = text
        .chars()
        .take(LONGEST)
        .map(|c| if allowed(c) { c } else { ' ' })
        .collect();
    if text.chars().nth(LONGEST).is_some() {
        cleaned.push('…');
    }
    cleaned.trim().to_owned()
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
    fn control_characters_become_spaces() {
        assert_eq!(clean("a\u{0}b\n\u{FFFF}"), "a b");
        assert_eq!(clean(&"x".repeat(1000)).chars().count(), LONGEST + 1);
    }
}
