//! Pages from templates: the markup stands in `templates/`, the figures come from here.

use minijinja::Environment;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::Serde;
use serde::Serialize;

use crate::error::Result;

/// Fills in a template. Tags may stand on lines of their own without leaving a trace.
pub(super) fn fill(template: &str, page: impl Serialize) -> Result<String> {
    fill_as("page", template, page)
}

/// The same for XML: every value is escaped.
pub(super) fn fill_xml(template: &str, page: impl Serialize) -> Result<String> {
    fill_as("page.xml", template, page)
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
    environment.add_template(name, template)?;
    Ok(environment.get_template(name)?.render(Serde(page))?)
}

/// Text made safe for a cell of a Markdown table: names are free text.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}
