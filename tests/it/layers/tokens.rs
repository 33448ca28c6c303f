//! Rust source as tokens: without comments, strings and characters, which may name anything.

/// A word, `::`, or any other single character that is not white space.
#[derive(Debug, Clone, PartialEq)]
pub struct Token {
    pub text: String,
    pub line: usize,
}

impl Token {
    /// Whether it is a name or keyword.
    pub fn is_word(&self) -> bool {
        self.text.starts_with(is_word_start)
    }
}

fn is_word_start(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn is_word_part(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Reads a source file.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut reader = Reader {
        rest: text,
        line: 1,
    };
    let mut found = Vec::new();
    while let Some(first) = reader.rest.chars().next() {
        let line = reader.line;
        let length = reader.length();
        let taken = reader.take(length);
        let is_code = is_word_start(first) && !taken.contains(['"', '\'', '#'])
            || taken.len() == first.len_utf8() && !first.is_whitespace()
            || taken == "::";
        if is_code {
            found.push(Token {
                text: taken.to_owned(),
                line,
            });
        } else if let Some(name) = taken.strip_prefix("r#")
            && name.starts_with(is_word_start)
        {
            found.push(Token {
                text: name.to_owned(),
                line,
            });
        }
    }
    found
}

struct Reader<'a> {
    rest: &'a str,
    line: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, length: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at(length);
        self.line += taken.matches('\n').count();
        self.rest = rest;
        taken
    }

    /// Bytes of the token, comment, string or white space that comes next.
    fn length(&self) -> usize {
        let rest = self.rest;
        let first = rest.chars().next().unwrap();
        if rest.starts_with("//") {
            return rest.find('\n').unwrap_or(rest.len());
        }
        if rest.starts_with("/*") {
            return block_comment(rest);
        }
        if rest.starts_with("::") {
            return 2;
        }
        if first == '"' {
            return 1 + quoted(&rest[1..], '"');
        }
        if first == '\'' {
            return character_or_lifetime(rest);
        }
        if first.is_numeric() || is_word_start(first) {
            let end = rest.find(|c| !is_word_part(c)).unwrap_or(rest.len());
            return end + after_prefix(&rest[..end], &rest[end..]);
        }
        first.len_utf8()
    }
}

/// Block comments nest.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < text.len() {
        let rest = &text[at..];
        if rest.starts_with("/*") {
            (depth, at) = (depth + 1, at + 2);
        } else if rest.starts_with("*/") {
            (depth, at) = (depth - 1, at + 2);
            if depth == 0 {
                return at;
            }
        } else {
            at += rest.chars().next().unwrap().len_utf8();
        }
    }
    at
}

/// Up to and with the closing quote that no backslash escapes.
fn quoted(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices() {
        if c == quote && !escaped {
            return at + c.len_utf8();
        }
        escaped = c == '\\' && !escaped;
    }
    text.len()
}

/// `'x'` and `'\n'` are characters, `'a` is a lifetime.
fn character_or_lifetime(text: &str) -> usize {
    let mut after = text.chars().skip(1);
    let (first, second) = (after.next(), after.next());
    if first == Some('\\') || second == Some('\'') {
        return 1 + quoted(&text[1..], '\'');
    }
    let name = &text[1..];
    1 + name.find(|c| !is_word_part(c)).unwrap_or(name.len())
}

/// What belongs to a word before it: the rest of `b"x"`, `r#"x"#`, `b'x'` or of `r#word`.
fn after_prefix(word: &str, rest: &str) -> usize {
    let is_raw = ["r", "br", "cr"].contains(&word);
    if is_raw {
        let hashes = rest.len() - rest.trim_start_matches('#').len();
        let body = &rest[hashes..];
        if let Some(body) = body.strip_prefix('"') {
            let end = format!("\"{}", "#".repeat(hashes));
            let length = body.find(&end).map_or(body.len(), |at| at + end.len());
            return hashes + 1 + length;
        }
        if hashes == 1 && word == "r" && body.starts_with(is_word_start) {
            return 1 + body.find(|c| !is_word_part(c)).unwrap_or(body.len());
        }
        return 0;
    }
    match (word, rest.chars().next()) {
        ("b" | "c", Some('"')) => 1 + quoted(&rest[1..], '"'),
        ("b", Some('\'')) => 1 + quoted(&rest[1..], '\''),
        _ => 0,
    }
}

#[test]
fn only_code_is_left() {
    let words = |text: &str| -> Vec<String> {
        let words = tokens(text).into_iter().filter(Token::is_word);
        words.map(|token| token.text).collect()
    };
    let table: [(&str, &[&str]); 12] = [
        ("a // b\nc", &["a", "c"]),
        ("a /* b /* c */ d */ e", &["a", "e"]),
        ("a \"b // c\" d", &["a", "d"]),
        (r#"a "b \" c" d"#, &["a", "d"]),
        (r##"a r#"b " c"# d"##, &["a", "d"]),
        (r#"a r"\" b"#, &["a", "b"]),
        ("a b\"c\" d", &["a", "d"]),
        ("a '\"' b '\\'' c", &["a", "b", "c"]),
        ("fn f<'a>(x: &'a str)", &["fn", "f", "x", "str"]),
        ("a b'\"' c \"// d\" e", &["a", "c", "e"]),
        ("r#type crate", &["type", "crate"]),
        ("0..n 1e3", &["n"]),
    ];
    for (text, expected) in table {
        assert_eq!(words(text), expected, "{text}");
    }
    let lines: Vec<_> = tokens("a\n\"b\nc\" /*\n*/ d ::e")
        .iter()
        .map(|t| t.line)
        .collect();
    assert_eq!(lines, [1, 4, 4, 4]);
}
