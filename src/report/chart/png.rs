//! From SVG to PNG, with the font that the crate carries and a palette of 256 colours.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use super::ChartError;

/// The letters. Loaded once: the database only points to the bytes in the program.
static FONTS: LazyLock<Arc<fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = fontdb::Database::new();
    let bytes: &'static [u8] = dejavu::sans::regular();
    fonts.load_font_source(fontdb::Source::Binary(Arc::new(bytes)));
    Arc::new(fonts)
});

/// Most colours that an indexed PNG can hold.
const PALETTE_SIZE: usize = 256;
/// A shade this near to a colour of the palette (distance in RGB) is drawn as that one. White to black then takes 10 shades: edges stay smooth, and the file is a quarter
/// smaller.
const SAME: u32 = 48;

/// The picture of an SVG document, of `size` pixels and drawn `scale` times the size it has. The colours it was
/// drawn with, `inks`, are kept exactly.
pub(super) fn from_svg(
    svg: &str,
    size: [u32; 2],
    scale: f32,
    inks: &BTreeSet<[u8; 3]>,
) -> Result<Vec<u8>, ChartError> {
    let options = Options {
        fontdb: FONTS.clone(),
        // plotters has no word for round joints, without which a sharp turn grows a spike.
        style_sheet: Some("polyline { stroke-linejoin: round; stroke-linecap: round }".to_owned()),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options)?;
    let mut pixmap = Pixmap::new(size[0], size[1]).ok_or(ChartError::Canvas)?;
    let transform = Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut pixmap.as_mut());
    let pixels: Vec<[u8; 3]> = pixmap
        .pixels()
        .iter()
        .map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
        .collect();
    indexed_png(&pixels, size, inks)
}

/// Encodes opaque pixels with a palette of the inks and of the most frequent other colours
/// (shades of smoothed edges) that differ from each other; the rest become the nearest.
fn indexed_png(
    pixels: &[[u8; 3]],
    size: [u32; 2],
    inks: &BTreeSet<[u8; 3]>,
) -> Result<Vec<u8>, ChartError> {
    let mut counts: BTreeMap<[u8; 3], usize> = BTreeMap::new();
    for pixel in pixels {
        *counts.entry(*pixel).or_default() += 1;
    }
    // The sort is stable and the map is ordered: the same pixels give the same palette.
    let mut colors: Vec<([u8; 3], usize)> = counts.into_iter().collect();
    colors.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let mut palette: Vec<[u8; 3]> = inks.iter().copied().take(PALETTE_SIZE).collect();
    for (color, _) in &colors {
        let differs = |kept: &[u8; 3]| distance(*kept, *color) >= SAME * SAME;
        if palette.len() < PALETTE_SIZE && palette.iter().all(differs) {
            palette.push(*color);
        }
    }
    let index: BTreeMap<[u8; 3], u8> = colors
        .iter()
        .map(|(color, _)| (*color, nearest(&palette, *color)))
        .collect();
    let indices: Vec<u8> = pixels.iter().map(|pixel| index[pixel]).collect();

    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(::png::ColorType::Indexed);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_palette(palette.concat());
    // One level above `Compression::High`: 5 to 15 % smaller for some milliseconds more.
    encoder.set_deflate_compression(::png::DeflateCompression::Level(10));
    // Neighbouring indices are unrelated colours, so differences of them compress worse.
    encoder.set_filter(::png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&indices)?;
    writer.finish()?;
    Ok(bytes)
}

/// Where the colour nearest to `color` stands in the palette.
fn nearest(palette: &[[u8; 3]], color: [u8; 3]) -> u8 {
    (0..=u8::MAX)
        .zip(palette)
        .min_by_key(|(_, other)| distance(**other, color))
        .map_or(0, |(index, _)| index)
}

/// The square of the distance in RGB.
fn distance(a: [u8; 3], b: [u8; 3]) -> u32 {
    (0..3).map(|i| u32::from(a[i].abs_diff(b[i])).pow(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::super::testing::decode;
    use super::super::theme::SIZE;
    use super::*;

    #[test]
    fn inks_are_kept_exactly_and_shades_nearly() {
        let count = (SIZE[0] * SIZE[1]) as usize;
        let mut pixels = vec![[255; 3]; count];
        // Two inks hardly different from the paper and each other, and a ramp of shades.
        let inks = BTreeSet::from([[255; 3], [250; 3], [249, 250, 250]]);
        pixels[10_000..20_000].fill([250; 3]);
        pixels[20_000..30_000].fill([249, 250, 250]);
        for (shade, pixel) in (0..=255).zip(&mut pixels[..256]) {
            *pixel = [shade, shade / 2, 255 - shade];
        }
        let image = decode(&indexed_png(&pixels, SIZE, &inks).unwrap());
        assert_eq!(image.pixels[256..], pixels[256..]);
        for (found, wanted) in image.pixels.iter().zip(&pixels) {
            assert!(
                distance(*found, *wanted) < SAME * SAME,
                "{wanted:?}: {found:?}"
            );
        }
    }

    #[test]
    fn more_colors_than_a_palette_holds_still_make_a_picture() {
        let count = (SIZE[0] * SIZE[1]) as usize;
        let byte = |i: usize| u8::try_from(i % 12 * 23).unwrap();
        let cube = |i: usize| [byte(i), byte(i / 12), byte(i / 144)];
        let pixels: Vec<[u8; 3]> = (0..count).map(cube).collect();
        let image = decode(&indexed_png(&pixels, SIZE, &BTreeSet::new()).unwrap());
        for (found, wanted) in image.pixels.iter().zip(&pixels) {
            assert!(
                distance(*found, *wanted) <= 4 * SAME * SAME,
                "{wanted:?}: {found:?}"
            );
        }
    }

    #[test]
    fn text_is_drawn_without_any_font_of_the_system() {
        let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="1440" height="900">
            <rect width="1440" height="900" fill="white"/>
            <text x="100" y="500" font-size="200" font-family="DejaVu Sans">Wm</text></svg>"#;
        let image = decode(&from_svg(svg, SIZE, 1.0, &BTreeSet::new()).unwrap());
        let dark = image.pixels.iter().filter(|p| p[0] < 64).count();
        assert!(dark > 5_000, "{dark}");
    }
}
