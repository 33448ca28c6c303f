//! What the reader of TOML says, in the words of TOML: tables, arrays, strings and numbers, and no
//! type of Rust.

use crate::error::{one_line, quoted};

/// The reader's message in one line; `source` is the text that it complains of.
pub(super) fn in_plain_words(message: &str, source: &str) -> String {
    let message = match message.trim() {
        "integer number overflowed" => {
            return "integer beyond those of TOML; write it with a decimal point".to_owned();
        }
        "floating-point number overflowed" => {
            return "number beyond those of a computer, which end at 1.8e308".to_owned();
        }
        "wanted string or table" => return "invalid type, expected a string".to_owned(),
        message => message,
    };
    for wrong in ["invalid type: ", "invalid value: ", "invalid length "] {
        let rest = message.strip_prefix(wrong);
        // What is due is never foreign text, so the last comma is the one between the two.
        if let Some((found, due)) = rest.and_then(|rest| rest.rsplit_once(", expected ")) {
            return match too_large(found) {
                Some(told) => told,
                // The reader of dates shows them as tables.
                None if found == "map" && source.starts_with(|c: char| c.is_ascii_digit()) => {
                    format!("{wrong}date or time, expected {}", due_in_words(due))
                }
                None => format!(
                    "{wrong}{}, expected {}",
                    found_in_words(found),
                    due_in_words(due)
                ),
            };
        }
    }
    for wrong in ["unknown field `", "unknown variant `", "duplicate field `"] {
        if let Some(rest) = message.strip_prefix(wrong) {
            let (name, known) = rest.rsplit_once("`, ").unwrap_or((rest, ""));
            let (name, known) = match rest.rsplit_once("`, expected ") {
                Some((name, known)) => (name, format!(", expected {known}")),
                None if known.is_empty() => (name.trim_end_matches('`'), String::new()),
                None => (name, format!(", {known}")),
            };
            return format!("{wrong}{}`{known}", quoted(name));
        }
    }
    let words: Vec<&str> = message.split_whitespace().collect();
    one_line(&words.join(" "))
}

/// Integers of TOML have 64 bits; a number has a point or an exponent.
fn too_large(found: &str) -> Option<String> {
    let digits = found.strip_prefix("integer `")?;
    let digits = ["` as i128", "` as u128", "`"]
        .iter()
        .find_map(|end| digits.strip_suffix(end))?;
    let fits = digits.parse::<i64>().is_ok();
    (!fits).then(|| {
        let digits = quoted(digits);
        format!(
            "integer `{digits}` is beyond the integers of TOML, which end at 2^63; write it with a \
             decimal point, {digits}.0"
        )
    })
}

/// What was found: its kind in the words of TOML, and its value shortened.
fn found_in_words(found: &str) -> String {
    let kinds = [
        ("map", "table"),
        ("sequence", "array"),
        ("floating point ", "number "),
        ("unit value", "nothing"),
        ("byte array", "string"),
    ];
    for (theirs, toml) in kinds {
        if let Some(value) = found.strip_prefix(theirs) {
            return format!("{toml}{}", shortened(value));
        }
    }
    shortened(found)
}

/// A value as it was found, with its closing quote also where it is cut.
fn shortened(value: &str) -> String {
    let mut shown = quoted(value);
    if shown.ends_with('…') {
        shown.extend(value.chars().next_back().filter(|c| "`\"".contains(*c)));
    }
    shown
}

/// What would be right. None of this is foreign text.
fn due_in_words(due: &str) -> String {
    let words: Vec<&str> = due.split_whitespace().collect();
    match words[..] {
        ["f64" | "f32"] => "a number".to_owned(),
        ["i8" | "i16" | "i32" | "i64" | "i128" | "isize"] => "a whole number".to_owned(),
        ["u8" | "u16" | "u32" | "u64" | "u128" | "usize"] => {
            "a whole number, 0 or above".to_owned()
        }
        ["a", "sequence"] => "an array".to_owned(),
        ["a", "map"] | ["struct", ..] => "a table".to_owned(),
        ["enum" | "variant", ..] => "one of the known words".to_owned(),
        ["string", "or", "table"] => "a string".to_owned(),
        ["bool"] | ["a", "boolean"] => "true or false".to_owned(),
        _ => words.join(" "),
    }
}

#[cfg(test)]
mod tests {
    use super::in_plain_words;

    #[test]
    fn no_word_of_rust_is_left() {
        let table = [
            (
                "invalid type: map, expected a sequence",
                "invalid type: table, expected an array",
            ),
            (
                "invalid type: sequence, expected struct Body",
                "invalid type: array, expected a table",
            ),
            (
                "invalid type: integer `1`, expected struct Body",
                "invalid type: integer `1`, expected a table",
            ),
            (
                "invalid type: floating point `1.5`, expected u64",
                "invalid type: number `1.5`, expected a whole number, 0 or above",
            ),
            (
                "invalid type: string \"a, expected b\", expected f64",
                "invalid type: string \"a, expected b\", expected a number",
            ),
            (
                "invalid value: integer `-1`, expected u64",
                "invalid value: integer `-1`, expected a whole number, 0 or above",
            ),
            (
                "unknown field `a`, expected `b`, expected one of `c`",
                "unknown field `a`, expected `b`, expected one of `c`",
            ),
            ("missing field `name`", "missing field `name`"),
            ("unclosed\n  array", "unclosed array"),
        ];
        for (theirs, ours) in table {
            assert_eq!(in_plain_words(theirs, "x"), ours);
        }
        let far = in_plain_words(
            "invalid type: integer `9223372036854775808` as i128, expected f64",
            "",
        );
        assert!(
            far.ends_with("decimal point, 9223372036854775808.0"),
            "{far}"
        );
    }

    #[test]
    fn what_is_long_is_cut_and_what_is_due_is_kept() {
        let long = "x".repeat(1_000_000);
        for (message, end) in [
            (
                format!("invalid type: string \"{long}\", expected f64"),
                "…\", expected a number",
            ),
            (
                format!("unknown field `{long}`, expected `b`"),
                "…`, expected `b`",
            ),
            (
                format!("unknown field `{long}`, there are no fields"),
                "…`, there are no fields",
            ),
            (format!("duplicate field `{long}`"), "…`"),
        ] {
            let said = in_plain_words(&message, "");
            assert!(said.len() < 200 && said.ends_with(end), "{said}");
        }
    }
}
