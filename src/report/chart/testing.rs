//! What the tests of the pictures share.

use super::theme::SIZE;

/// A decoded picture.
pub(super) struct Image {
    /// Colours, row by row.
    pub(super) pixels: Vec<[u8; 3]>,
    /// How many rows there are.
    pub(super) height: usize,
}

impl Image {
    /// The colour at a column and a row.
    pub(super) fn at(&self, x: usize, y: usize) -> [u8; 3] {
        self.pixels[y * SIZE[0] as usize + x]
    }

    /// How many pixels are not white.
    pub(super) fn ink(&self) -> usize {
        self.pixels
            .iter()
            .filter(|pixel| **pixel != [255; 3])
            .count()
    }
}

/// Decodes a PNG and checks its size.
pub(super) fn decode(bytes: &[u8]) -> Image {
    let image = decode_high(bytes);
    assert_eq!(image.height, SIZE[1] as usize);
    image
}

/// Decodes a PNG of any height and checks its width.
pub(super) fn decode_high(bytes: &[u8]) -> Image {
    let mut decoder = ::png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(::png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut buffer).unwrap();
    assert_eq!(info.width, SIZE[0]);
    assert_eq!(info.color_type, ::png::ColorType::Rgb);
    let pixels = buffer[..info.buffer_size()]
        .chunks_exact(3)
        .map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect();
    let height = info.height as usize;
    Image { pixels, height }
}
