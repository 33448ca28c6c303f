//! Paths in the tokens of a source file, as far as they leave the file's own room.

use super::tokens::Token;

/// What a path outside its file's module comes to.
#[derive(Debug, Clone, PartialEq)]
pub enum Import {
    /// A module at the root of the crate, by name.
    Root(String),
    /// The root itself, by another name or with all that is in it: nobody can tell which rooms.
    WholeCrate,
    /// Source brought in past the module tree.
    PastTheTree,
}

/// Every import of a file that is the module `module` of the crate, with its line.
///
/// `crate::x`, `carom::x`, `$crate::x`, and `super::x` and `self::x` as soon as they reach the
/// root; alone, in a list, in a list in a list, in a signature or an expression.
pub fn imports(tokens: &[Token], module: &[String]) -> Vec<(usize, Import)> {
    let mut scanner = Scanner {
        tokens,
        found: Vec::new(),
    };
    let mut scope = Scope::of(module);
    let mut at = 0;
    while at < tokens.len() {
        scope.follow(tokens, at);
        scanner.look_past_the_tree(at);
        at = scanner.path_at(at, &scope.module);
    }
    scanner.found
}

/// The module that a token stands in: the file's, then those written inline.
struct Scope {
    module: Vec<String>,
    /// Open braces; whether each opened a module.
    braces: Vec<bool>,
}

impl Scope {
    fn of(module: &[String]) -> Self {
        Self {
            module: module.to_vec(),
            braces: Vec::new(),
        }
    }

    fn follow(&mut self, tokens: &[Token], at: usize) {
        match tokens[at].text.as_str() {
            "{" => {
                let opens_module = at >= 2 && tokens[at - 2].text == "mod";
                if opens_module {
                    self.module.push(tokens[at - 1].text.clone());
                }
                self.braces.push(opens_module);
            }
            "}" => {
                let closes_module = self.braces.pop() == Some(true);
                if closes_module {
                    self.module.pop();
                }
            }
            _ => {}
        }
    }
}

struct Scanner<'a> {
    tokens: &'a [Token],
    found: Vec<(usize, Import)>,
}

impl Scanner<'_> {
    fn text(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |token| token.text.as_str())
    }

    /// `#[path = …]`, `include!(…)` and `extern crate …`.
    fn look_past_the_tree(&mut self, at: usize) {
        let next = [self.text(at), self.text(at + 1), self.text(at + 2)];
        if matches!(
            next,
            ["[", "path", "="] | ["include", "!", _] | ["extern", "crate", _]
        ) {
            self.found.push((self.tokens[at].line, Import::PastTheTree));
        }
    }

    /// Reads the path that starts here, if one does; gives where to read on.
    fn path_at(&mut self, at: usize, module: &[String]) -> usize {
        let is_use = self.text(at) == "use";
        let start = at + usize::from(is_use);
        // `use ::carom::x`: a leading `::` names a crate.
        let start = start + usize::from(is_use && self.text(start) == "::");
        let begins = ["crate", "super", "self", "carom"].contains(&self.text(start));
        let continues = self.text(start.wrapping_sub(1)) == "::" && !is_use;
        let goes_on = is_use || self.text(start + 1) == "::";
        let opens_list = is_use && self.text(start) == "{";
        if (begins && goes_on && !continues) || opens_list {
            // Braces of a list come in pairs, so the scope may miss them.
            return self.tree(start, None, module).max(at + 1);
        }
        at + 1
    }

    /// Reads a path or list of paths; `base` is the module reached so far, none before the
    /// first word. Gives where to read on.
    fn tree(&mut self, mut at: usize, mut base: Option<Vec<String>>, module: &[String]) -> usize {
        loop {
            let line = self.tokens.get(at).map_or(0, |token| token.line);
            match self.text(at) {
                "{" => return self.list(at, base.as_ref(), module),
                "*" => {
                    if base.as_ref().is_some_and(Vec::is_empty) {
                        self.found.push((line, Import::WholeCrate));
                    }
                    return at + 1;
                }
                "crate" | "carom" if base.is_none() => base = Some(Vec::new()),
                "self" => base = base.or_else(|| Some(module.to_vec())),
                "super" => {
                    let mut reached = base.unwrap_or_else(|| module.to_vec());
                    reached.pop();
                    base = Some(reached);
                }
                word => {
                    // A name of some other crate or of this module: not our business.
                    if let Some(reached) = &base
                        && reached.is_empty()
                        && !word.is_empty()
                    {
                        self.found.push((line, Import::Root(word.to_owned())));
                    }
                    return at + usize::from(self.text(at + 1) == "::") + 1;
                }
            }
            if self.text(at + 1) != "::" {
                if base.is_some_and(|reached| reached.is_empty()) {
                    self.found.push((line, Import::WholeCrate));
                }
                return at + 1;
            }
            at += 2;
        }
    }

    /// Reads a list in braces.
    fn list(&mut self, at: usize, base: Option<&Vec<String>>, module: &[String]) -> usize {
        let mut at = at + 1;
        while !["}", ""].contains(&self.text(at)) {
            at = self.tree(at, base.cloned(), module);
            // The rest of an item below its first module: its own lists, and `as` names.
            let mut depth = 0;
            while !(depth == 0 && [",", "}"].contains(&self.text(at))) && at < self.tokens.len() {
                depth += i32::from(self.text(at) == "{") - i32::from(self.text(at) == "}");
                at += 1;
            }
            at += usize::from(self.text(at) == ",");
        }
        at + 1
    }
}
