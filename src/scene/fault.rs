//! What is wrong with a file of data, where, and what would be right; and the rules that numbers
//! go by.

use std::borrow::Cow;
use std::fmt;

use crate::error::{number, quoted};

/// One step from the root of a file to a field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PathStep {
    /// A key of a table.
    Key(Cow<'static, str>),
    /// A place in an array, counted from 0.
    Index(usize),
}

/// Where in a file a field stands, such as `bodies[2].mass`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FieldPath(pub Vec<PathStep>);

impl FieldPath {
    /// The field of that key in it.
    #[must_use]
    pub fn key(mut self, key: impl Into<Cow<'static, str>>) -> Self {
        self.0.push(PathStep::Key(key.into()));
        self
    }

    /// The element at that place in it.
    #[must_use]
    pub fn index(mut self, index: usize) -> Self {
        self.0.push(PathStep::Index(index));
        self
    }
}

impl fmt::Display for FieldPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, step) in self.0.iter().enumerate() {
            match step {
                PathStep::Key(key) if place == 0 => write!(f, "{}", quoted(key))?,
                PathStep::Key(key) => write!(f, ".{}", quoted(key))?,
                PathStep::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

/// What is wrong with a file: the field, what was found, and what would be right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The field.
    pub path: FieldPath,
    /// What was found there.
    pub found: String,
    /// What would be right.
    pub remedy: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` is {}: {}", self.path, self.found, self.remedy)
    }
}

pub(crate) fn fault(path: FieldPath, found: impl Into<String>, remedy: impl Into<String>) -> Fault {
    Fault {
        path,
        found: found.into(),
        remedy: remedy.into(),
    }
}

pub(crate) fn finite(path: &FieldPath, value: f64) -> std::result::Result<(), Fault> {
    if value.is_finite() {
        return Ok(());
    }
    Err(fault(path.clone(), number(value), "give a finite number"))
}

pub(crate) fn positive(path: &FieldPath, value: f64) -> std::result::Result<(), Fault> {
    finite(path, value)?;
    if value > 0.0 {
        return Ok(());
    }
    Err(fault(path.clone(), number(value), "give a number above 0"))
}

pub(crate) fn not_negative(path: &FieldPath, value: f64) -> std::result::Result<(), Fault> {
    finite(path, value)?;
    if value >= 0.0 {
        return Ok(());
    }
    Err(fault(
        path.clone(),
        number(value),
        "give 0 or a number above it",
    ))
}

pub(crate) fn fraction(path: &FieldPath, value: f64) -> std::result::Result<(), Fault> {
    finite(path, value)?;
    if (0.0..=1.0).contains(&value) {
        return Ok(());
    }
    Err(fault(
        path.clone(),
        number(value),
        "give a number from 0 to 1",
    ))
}

pub(crate) fn finite_vector(path: &FieldPath, vector: &[f64; 3]) -> std::result::Result<(), Fault> {
    for (axis, value) in vector.iter().enumerate() {
        finite(&path.clone().index(axis), *value)?;
    }
    Ok(())
}
