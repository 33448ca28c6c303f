//! Numbers in files.

use serde::Serializer;

/// Writes a number, or nothing where it is not finite: no file of carom holds a NaN.
///
/// For `#[serde(serialize_with = "finite_or_blank")]`; JSON gets `null`, CSV an empty field.
///
/// # Errors
/// Those of the serializer.
#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "the signature serde asks for"
)]
pub fn finite_or_blank<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if value.is_finite() {
        serializer.serialize_f64(*value)
    } else {
        serializer.serialize_none()
    }
}
