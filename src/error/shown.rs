//! How messages show text and numbers of foreign origin: on one line, without anything that a
//! terminal would obey or that would not be seen, and not all of it where it is long.

/// Characters of one foreign text that a message quotes, at most.
pub const QUOTED_MAX: usize = 80;

/// Characters of a message of one line, at most; of a longer one start and end are shown, which
/// name the place and the remedy.
pub const LINE_MAX: usize = 2000;

/// Characters of the end of a long message that are shown.
const LINE_END: usize = 500;

/// Control characters, and characters of Unicode that show as nothing, change how text is laid
/// out, or are no characters at all.
pub(crate) fn is_invisible(c: char) -> bool {
    let code = u32::from(c);
    let is_no_character = code & 0xfffe == 0xfffe || (0xfdd0..=0xfdef).contains(&code);
    c.is_control() || is_no_character || is_blank_mark(c)
}

/// Marks of direction, of joining and of width 0, fillers, tags, and separators of lines.
fn is_blank_mark(c: char) -> bool {
    matches!(c,
        '\u{ad}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{180e}' | '\u{3164}' | '\u{feff}'
        | '\u{ffa0}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}'
        | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e0fff}')
}

/// Text of foreign origin as a message of one line shows it: what a terminal would obey, or would
/// not show, is escaped.
///
/// ```
/// assert_eq!(carom::error::harmless("a\u{1b}[31m\nb"), "a\\u{1b}[31m\\nb");
/// ```
#[must_use]
pub fn harmless(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\t' => shown.push(' '),
            c if c.is_control() => shown.extend(c.escape_debug()),
            c if is_invisible(c) => shown.extend(c.escape_unicode()),
            c => shown.push(c),
        }
    }
    shown
}

/// Foreign text within a message: [`harmless`], and its start alone where it is long.
///
/// ```
/// assert_eq!(carom::error::quoted("a\nb"), "a\\nb");
/// let long = carom::error::quoted(&"x".repeat(1000));
/// assert!(long.ends_with('…') && long.chars().count() == 1 + carom::error::QUOTED_MAX);
/// ```
#[must_use]
pub fn quoted(text: &str) -> String {
    let end = text.char_indices().nth(QUOTED_MAX).map(|(end, _)| end);
    match end {
        Some(end) => harmless(&text[..end]) + "…",
        None => harmless(text),
    }
}

/// A name as code in a message or a page; names are free text, and end no code.
#[must_use]
pub fn code(name: &str) -> String {
    format!("`{}`", name.replace('`', "'"))
}

/// A whole message: [`harmless`], and without its middle where it is long.
#[must_use]
pub fn one_line(text: &str) -> String {
    let length = text.chars().count();
    if length <= LINE_MAX {
        return harmless(text);
    }
    let place = |nth: usize| {
        text.char_indices()
            .nth(nth)
            .map_or(text.len(), |(at, _)| at)
    };
    let (start, end) = (place(LINE_MAX - LINE_END), place(length - LINE_END));
    format!("{} … {}", harmless(&text[..start]), harmless(&text[end..]))
}

/// A number as a message shows it: the shortest digits that give the same double, with an exponent
/// where it is very large or small.
///
/// ```
/// use carom::error::number;
/// assert_eq!([number(-2.0), number(0.1), number(1e300)], ["-2", "0.1", "1e300"]);
/// ```
#[must_use]
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() || (1e-5..1e16).contains(&size) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_a_terminal_obeys_or_hides_is_left() {
        for c in (0..=0x0010_ffff).filter_map(char::from_u32) {
            let shown = harmless(&format!("a{c}b"));
            assert!(!shown.chars().any(is_invisible), "{c:?}: {shown:?}");
        }
        let kept = "당구 공 \"a\" 'b' \\ `c` é e\u{301} 🎱 µ\u{3000}|";
        assert_eq!(harmless(kept), kept);
    }

    #[test]
    fn a_long_message_keeps_its_place_and_its_remedy() {
        let line = one_line(&format!(
            "file:1:2: `{}`: say less",
            "\n".repeat(50_000_000)
        ));
        assert!(line.starts_with("file:1:2: `\\n") && line.ends_with("`: say less"));
        assert!(line.len() <= 2 * LINE_MAX + 10, "{}", line.len());
    }
}
