//! Scene files: TOML in, with line and column for every complaint, and TOML out.

use std::path::Path;

use serde::de::{DeserializeOwned, Error as _};
use serde::{Deserialize, Deserializer};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::bounds::{TEXT_BYTES_MAX, past_bounds};
use super::words::in_plain_words;
use super::{Fault, FieldPath, PathStep, Scene};
use crate::error::{Error, Result};
use crate::input;

/// Reads and checks a scene file.
///
/// # Errors
/// [`Error::Read`], [`Error::NotUtf8`], or [`Error::DataFile`] with line, column and remedy.
pub fn read(path: &Path) -> Result<Scene> {
    let text = input::text(path, TEXT_BYTES_MAX)?;
    parse(&text, &path.display().to_string())
}

/// Parses and checks the text of a scene file; `file` is its name in messages.
///
/// # Errors
/// [`Error::DataFile`] with line, column and remedy, for meaning as for syntax.
pub fn parse(text: &str, file: &str) -> Result<Scene> {
    parse_checked(text, file, Scene::check)
}

/// Parses the text of a file of data and checks what it means.
///
/// # Errors
/// As [`parse`].
pub(crate) fn parse_checked<T: DeserializeOwned>(
    text: &str,
    file: &str,
    check: impl FnOnce(&T) -> std::result::Result<(), Fault>,
) -> Result<T> {
    let complaint = |byte: usize, message: String| {
        let (line, column) = line_and_column(text, byte);
        Error::DataFile {
            file: file.to_owned(),
            line,
            column,
            message,
        }
    };
    if let Some((byte, message)) = past_bounds(text) {
        return Err(complaint(byte, message));
    }
    let data: T = toml::from_str(text).map_err(|wrong| {
        let byte = wrong.span().map_or(0, |span| span.start);
        let source = text.get(byte..).unwrap_or_default();
        complaint(byte, in_plain_words(wrong.message(), source))
    })?;
    check(&data).map_err(|fault| complaint(locate(text, &fault.path), fault.to_string()))?;
    Ok(data)
}

/// Writes a scene as the text of a scene file; [`parse`] gives the same scene back.
///
/// # Errors
/// [`Error::Scene`] if the scene is not one, [`Error::SceneWrite`] if TOML cannot hold it.
pub fn to_toml(scene: &Scene) -> Result<String> {
    scene.checked()?;
    let text = toml::to_string(scene).map_err(|source| Error::SceneWrite {
        scene: scene.name.clone(),
        source,
    })?;
    match past_bounds(&text) {
        None => Ok(text),
        Some((_, message)) => Err(Error::Scene {
            scene: scene.name.clone(),
            message: format!("its file would have {message}"),
        }),
    }
}

/// Reads an array that has exactly so many values; serde itself drops what is too much.
///
/// # Errors
/// Those of the deserializer, or another number of values.
pub(crate) fn exactly<'de, D, T, const N: usize>(
    deserializer: D,
) -> std::result::Result<[T; N], D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    let values = Vec::<T>::deserialize(deserializer)?;
    let found = values.len();
    let wrong = |_| D::Error::custom(format!("{found} values where {N} are due"));
    <[T; N]>::try_from(values).map_err(wrong)
}

/// Byte offset of a field, or of the innermost table round it that the text has.
fn locate(text: &str, path: &FieldPath) -> usize {
    let Ok(root) = DeTable::parse(text) else {
        return 0;
    };
    let mut start = root.span().start;
    let root = Spanned::new(root.span(), DeValue::Table(root.into_inner()));
    let mut value = &root;
    for step in &path.0 {
        let found = match (step, value.get_ref()) {
            (PathStep::Key(key), DeValue::Table(table)) => table.get(key.as_ref()),
            (PathStep::Index(index), DeValue::Array(array)) => array.get(*index),
            (PathStep::Key(_) | PathStep::Index(_), _) => None,
        };
        let Some(found) = found else { break };
        value = found;
        start = value.span().start;
    }
    start
}

/// Line and column, both counted from 1, the column in characters.
fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before = text.get(..byte).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
    (line, column)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "name = \"x\"\nduration = 1\nsample_every = 0.5\n";

    fn complaint(text: &str) -> String {
        parse(text, "x.toml")
            .expect_err("the scene is wrong")
            .to_string()
    }

    #[test]
    fn meaning_is_located_like_syntax() {
        let text = format!(
            "{HEAD}[[bodies]]\nname = \"a\"\nmass = -2\nradius = 1\nposition = [0,0,0]\nvelocity = [0,0,0]\n"
        );
        assert_eq!(
            complaint(&text),
            "x.toml:6:8: `bodies[0].mass` is -2: give a number above 0"
        );
    }

    #[test]
    fn an_unknown_key_names_the_known_ones() {
        let text = format!("{HEAD}colour = 3\n");
        let said = complaint(&text);
        assert!(
            said.starts_with("x.toml:4:1: unknown field `colour`"),
            "{said}"
        );
        assert!(said.contains("`sample_every`"), "{said}");
    }

    #[test]
    fn a_missing_table_is_placed_in_what_is_there() {
        assert_eq!(
            complaint(HEAD),
            "x.toml:1:1: `bodies` is empty: add at least one [[bodies]] table"
        );
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(
            line_and_column("공 = 1\n당구 = x", "공 = 1\n당구 = ".len()),
            (2, 6)
        );
    }
}
