//! How large a scene may be. Every bound is checked before memory is taken, and keeps the peak
//! of a program under 1 GB.

/// Bodies: a lattice of 20 cells an edge. A body takes some 200 bytes in a file and 9 signs of
/// structure, so that the file of a scene of so many has 7 MB and 288,000 signs, below both bounds
/// of files; parsing it takes 160 MB, and each engine some kB a body.
pub const BODIES_MAX: usize = 32_000;

/// Bytes of a scene file, or of another of TOML. The parser takes up to 78 bytes a byte outside of
/// tables (measured on `1,1,1,`), which makes 650 MB.
pub(crate) const TEXT_BYTES_MAX: u64 = 8 << 20;

/// Signs that can open a table in TOML: `[`, `{`, `=` and the dots of keys. The parser takes up to
/// 1.2 kB for each (measured on `{a.a.a=1},`), which makes 350 MB.
const SIGNS_MAX: usize = 300_000;

/// Samples: each costs 250 bytes in metrics, beside its states, on a single engine. A comparison
/// of several allows fewer.
pub(crate) const SAMPLES_MAX: f64 = 1e6;

/// Samples times bodies. A recording holds 48 bytes of each: 150 MB.
pub(crate) const STATES_MAX: f64 = 3e6;

/// Pairs of spheres that are looked at for overlaps at the start: each takes some ns, so that
/// this is a fifth of a second. Up to 6,000 bodies all pairs are fewer.
pub(crate) const LOOKS_MAX: u64 = 20_000_000;

/// Overlaps in a list: 100 MB.
pub(super) const OVERLAPS_MAX: usize = 4_000_000;

/// Where a text goes past what is parsed, and how.
pub(super) fn past_bounds(text: &str) -> Option<(usize, String)> {
    if text.len() as u64 > TEXT_BYTES_MAX {
        let message = format!(
            "{} bytes, more than the {TEXT_BYTES_MAX} that are read of such a file",
            text.len()
        );
        return Some((0, message));
    }
    let byte = signs(text.as_bytes()).nth(SIGNS_MAX)?;
    let message = format!(
        "more than {SIGNS_MAX} of the signs [ {{ = and dots in keys; a scene has {BODIES_MAX} \
         bodies at most"
    );
    Some((byte, message))
}

/// Where the signs stand that can open a table. A dot between digits is that of a number, unless
/// its word has had one.
fn signs(text: &[u8]) -> impl Iterator<Item = usize> + '_ {
    let is_digit = |place: Option<usize>| {
        place.is_some_and(|place| text.get(place).is_some_and(u8::is_ascii_digit))
    };
    let mut had_dot = false;
    (0..text.len()).filter(move |&place| match text[place] {
        b'[' | b'{' | b'=' => {
            had_dot = false;
            true
        }
        b'.' => {
            let between = is_digit(place.checked_sub(1)) && is_digit(place.checked_add(1));
            let of_number = between && !had_dot;
            had_dot = true;
            !of_number
        }
        b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' | b'_' | b'-' | b'+' => false,
        0..=b'*' | b',' | b'/' | b':'..=b'@' | b'\\'..=b'^' | b'`' | b'|'..=u8::MAX => {
            had_dot = false;
            false
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_of_numbers_open_no_table() {
        let count = |text: &str| signs(text.as_bytes()).count();
        assert_eq!(count("[1.0, -2.5e-3, 1_0.0]"), 1);
        assert_eq!(count("a = 1.5"), 1);
        assert_eq!(count("a.b.c = 1.5"), 3);
        assert_eq!(count("1.1.1.1 = 1"), 3);
        assert_eq!(count("1 . 1 = 1"), 2);
        assert_eq!(count("[[a.b]]\n"), 3);
    }

    #[test]
    fn the_file_of_a_scene_of_the_most_bodies_is_within_the_bounds() {
        let recipe = crate::scene::generate::Gas::thinned(BODIES_MAX, 0.1, 1);
        let text = crate::scene::to_toml(&recipe.unwrap()).unwrap();
        assert!(past_bounds(&text).is_none());
        assert_eq!(signs(text.as_bytes()).count() / BODIES_MAX, 9);
    }

    #[test]
    fn a_text_past_a_bound_is_told_with_the_place() {
        let line = "a.b.c=1\n";
        let text = line.repeat(SIGNS_MAX / 3);
        assert!(past_bounds(&text).is_none());
        let (byte, _) = past_bounds(&format!("{text}[")).unwrap();
        assert_eq!(byte, text.len());
        let long = "#".repeat(usize::try_from(TEXT_BYTES_MAX).unwrap() + 1);
        assert!(past_bounds(&long).unwrap().1.contains("bytes, more than"));
    }
}
