//! The unit of length of a scene.

use serde::{Deserialize, Serialize};

/// Unit of every length in a scene file; times are in seconds, masses in kilograms.
///
/// carom never converts: the unit labels axes and tables, and sets Rapier's `length_unit`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum LengthUnit {
    /// Millimetres, as on the lecture's billiards table.
    #[serde(rename = "mm")]
    Millimetre,
    /// Centimetres.
    #[serde(rename = "cm")]
    Centimetre,
    /// Metres.
    #[default]
    #[serde(rename = "m")]
    Metre,
    /// No unit: a scene in natural units. Rapier is told that one unit is a metre.
    #[serde(rename = "none")]
    None,
}

impl LengthUnit {
    /// How many of these units make a metre.
    ///
    /// ```
    /// use carom::scene::LengthUnit;
    /// assert_eq!(LengthUnit::Millimetre.per_metre(), 1000.0);
    /// ```
    #[must_use]
    pub fn per_metre(self) -> f64 {
        match self {
            Self::Millimetre => 1000.0,
            Self::Centimetre => 100.0,
            Self::Metre | Self::None => 1.0,
        }
    }

    /// The symbol of a length, empty without a unit.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::None => "",
        }
    }

    /// The symbol of an energy in scene units, `kg mm²/s²` for example; joules in metres.
    #[must_use]
    pub fn energy_symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "kg mm²/s²",
            Self::Centimetre => "kg cm²/s²",
            Self::Metre => "J",
            Self::None => "",
        }
    }

    /// The symbol of a momentum in scene units.
    #[must_use]
    pub fn momentum_symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "kg mm/s",
            Self::Centimetre => "kg cm/s",
            Self::Metre => "kg m/s",
            Self::None => "",
        }
    }
}

/// The table `[units]` of a scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// Unit of length.
    #[serde(default)]
    pub length: LengthUnit,
}
