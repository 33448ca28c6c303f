//! Slips of the pen in a good text: each must be told with its place.

/// What to replace in the good text, by what, the line to be named, and what must be said.
pub type Slip = (&'static str, &'static str, usize, &'static str);

/// Makes each slip, and holds what is `said` of it to place and part; messages begin with
/// `before` and the line.
pub fn assert_named(good: &str, before: &str, slips: &[Slip], said: impl Fn(&str) -> String) {
    for (from, to, line, part) in slips {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from} is not there");
        let said = said(&text);
        assert!(
            said.starts_with(&format!("{before}:{line}:")),
            "{to}: line {line}, not: {said}"
        );
        assert!(said.contains(part), "{to}: `{part}` is missing in: {said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{said}");
    }
}
