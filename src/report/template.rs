//! Pages from templates: the markup stands in `templates/`, the figures come from here.

use minijinja::Environment;
use minijinja::Value;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use serde::Serialize;

use crate::error::{Result, harmless, is_invisible};

/// Fills in a template. Tags may stand on lines of their own without leaving a trace.
pub(super) fn fill(template: &str, page: impl Serialize) -> Result<String> {
    fill_as("page", template, page)
}

/// The same for XML: every value is escaped, and characters that XML has no way to hold, escaped
/// or not, are replaced, as are those that only a terminal would obey.
pub(super) fn fill_xml(template: &str, page: impl Serialize) -> Result<String> {
    let text = fill_as("page.xml", template, page)?;
    let is_kept = |c: char| matches!(c, '\n' | '\t') || !is_invisible(c);
    let kept = |c| if is_kept(c) { c } else { '\u{fffd}' };
    Ok(text.chars().map(kept).collect())
}

/// The ending of the name decides how values are escaped.
fn fill_as(name: &str, template: &str, page: impl Serialize) -> Result<String> {
    let mut environment = Environment::new();
    let mut syntax = SyntaxConfig::builder();
    syntax
        .trim_blocks(true)
        .lstrip_blocks(true)
        .keep_trailing_newline(true);
    environment.set_syntax(syntax.build()?);
    environment.add_filter("cell", cell);
    environment.add_filter("plain", |text: &Value| plain_text(&text.to_string()));
    environment.add_template(name, template)?;
    Ok(environment.get_template(name)?.render(Serde(page))?)
}

/// Markdown made safe for a cell of a table: it stays one line and one cell.
fn cell(text: &Value) -> String {
    let text = text.to_string();
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}

/// Free text made safe for Markdown: it stays in its line, and begins no link, tag, table or code.
pub(super) fn plain_text(text: &str) -> String {
    let mut safe = String::new();
    for c in harmless(text).chars() {
        if r"\`*[]<>|".contains(c) {
            safe.push('\\');
        }
        safe.push(c);
    }
    safe
}
