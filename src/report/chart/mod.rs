//! Pictures: plain data in, PNG bytes out. Nothing here knows scenes or engines.
//!
//! plotters draws SVG with a font carried by a crate, resvg makes the PNG. The same data
//! give the same bytes. No data make it fail: what cannot be drawn (NaN, infinities) is
//! a gap in a curve, and a picture without data says so.

mod axis;
mod bars;
mod canvas;
mod curves;
mod legend;
mod matrix;
mod paths;
mod paths_figure;
mod paths_look;
mod png;
mod polyline;
mod regions;
mod room;
mod scaling;
mod text;
mod theme;
mod ticks;
mod window;
mod work;
mod work_figure;
mod work_look;
mod work_plot;

#[cfg(test)]
mod testing;

pub use axis::Scale;
pub use bars::{Bar, BarGroup, BarsFigure, bars};
pub use curves::{Curve, CurvesFigure, Marks, Panel, Weight, curves};
pub use matrix::{MatrixColumn, MatrixFigure, MatrixRow, Tone, matrix};
pub use paths::paths;
pub use paths_figure::{AxisLabel, PathBody, PathsFigure, View};
pub use regions::{Region, RegionPanel, RegionsFigure, regions};
pub use scaling::{Crossing, ScalingFigure, Spent, scaling};
pub use theme::{COLOR_COUNT, LineStyle};
pub use work::work;
pub use work_figure::{Answer, Goal, WorkCurve, WorkFigure, WorkPoint};

/// Why a picture could not be made. None of these depends on the data.
#[derive(Debug, thiserror::Error)]
pub enum ChartError {
    /// The font that the program carries is not readable.
    #[error("the built-in font cannot be read")]
    Font,
    /// There is no memory for the pixels.
    #[error("no canvas of the picture's size")]
    Canvas,
    /// plotters refused to draw.
    #[error("drawing failed: {0}")]
    Draw(#[from] plotters::drawing::DrawingAreaErrorKind<std::io::Error>),
    /// resvg does not accept the drawing.
    #[error("the drawing is not valid SVG: {0}")]
    Svg(#[from] resvg::usvg::Error),
    /// The PNG could not be encoded.
    #[error("the PNG could not be encoded: {0}")]
    Png(#[from] ::png::EncodingError),
}
