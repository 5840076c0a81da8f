//! PNG: depth images of 16 bits, and masks.

use std::path::{Path, PathBuf};

use png::{BitDepth, ColorType, Decoder, Transformations};

use super::super::source;
use super::super::{FileError, Place};

/// Most bytes that a byte of compressed data stands for, so that a broken header does not reserve the memory.
const MOST_COMPRESSION: usize = 1032;

/// Content of a depth image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DepthFile {
    /// The file.
    pub path: PathBuf,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Depths row by row, in the unit of the file.
    pub depths: Vec<u16>,
}

/// Content of a mask.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaskFile {
    /// The file.
    pub path: PathBuf,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Labels row by row. Those of 16 bits must fit into eight.
    pub labels: Vec<u8>,
}

/// Reads a depth image: a PNG with one channel of 16 bits.
pub fn read_depth(path: &Path) -> Result<DepthFile, FileError> {
    let remedy = "give the depth as PNG with one channel of 16 bits, as in millimetres; colour and 8-bit images do not hold it";
    let image = decode(path, remedy)?;
    match (image.colour, image.bits) {
        (ColorType::Grayscale, BitDepth::Sixteen) => {}
        (colour, bits) => {
            let reason = format!(
                "is a {} PNG of {} bits, but depth has 16 bits in one channel",
                name(colour),
                bits as u8
            );
            return Err(malformed(path, reason, remedy));
        }
    }
    let depths = image.bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect();
    Ok(DepthFile { path: path.into(), size: image.size, depths })
}

/// Reads a mask: a PNG of labels in one channel, or a palette.
pub fn read_mask(path: &Path) -> Result<MaskFile, FileError> {
    let remedy = "give the mask as PNG with one channel of 8 bits, the label of each pixel";
    let image = decode(path, remedy)?;
    let labels = match (image.colour, image.bits) {
        (ColorType::Grayscale | ColorType::Indexed, BitDepth::Eight) => image.bytes,
        (ColorType::Grayscale, BitDepth::Sixteen) => {
            let wide = image.bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]]));
            wide.map(u8::try_from)
                .collect::<Result<_, _>>()
                .map_err(|_| malformed(path, "has labels above 255, or is a depth image".into(), remedy))?
        }
        (ColorType::Grayscale | ColorType::Indexed, bits) => unpack(&image.bytes, image.size, bits as usize),
        (colour, bits) => {
            let reason =
                format!("is a {} PNG of {} bits, but a mask has one channel", name(colour), bits as u8);
            return Err(malformed(path, reason, remedy));
        }
    };
    Ok(MaskFile { path: path.into(), size: image.size, labels })
}

struct Decoded {
    size: [u32; 2],
    colour: ColorType,
    bits: BitDepth,
    bytes: Vec<u8>,
}

fn decode(path: &Path, remedy: &'static str) -> Result<Decoded, FileError> {
    let bytes = source::read(path)?;
    if bytes.is_empty() {
        return Err(FileError::Empty { path: path.into() });
    }
    let broken =
        |error: png::DecodingError| malformed(path, format!("is not a readable PNG: {error}"), remedy);
    let mut decoder = Decoder::new(std::io::Cursor::new(&bytes));
    decoder.set_transformations(Transformations::IDENTITY);
    // Nothing in them is used, and a few of their bytes unpack to a lot.
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let mut reader = decoder.read_info().map_err(broken)?;
    let (width, height) = (reader.info().width, reader.info().height);
    let length = reader
        .output_buffer_size()
        .filter(|length| length / MOST_COMPRESSION <= bytes.len())
        .ok_or_else(|| malformed(path, format!("is too short for {width} x {height} pixels"), remedy))?;
    let mut pixels = vec![0; length];
    let info = reader.next_frame(&mut pixels).map_err(broken)?;
    pixels.truncate(info.buffer_size());
    Ok(Decoded { size: [width, height], colour: info.color_type, bits: info.bit_depth, bytes: pixels })
}

/// Labels of fewer than eight bits, which are packed into the bytes of each row.
fn unpack(bytes: &[u8], [width, height]: [u32; 2], bits: usize) -> Vec<u8> {
    let (width, height) = (width as usize, height as usize);
    let row_bytes = (width * bits).div_ceil(8);
    let label = |row: usize, column: usize| {
        let first = column * bits;
        bytes[row * row_bytes + first / 8] >> (8 - bits - first % 8) & ((1 << bits) - 1) as u8
    };
    (0..height).flat_map(|row| (0..width).map(move |column| label(row, column))).collect()
}

fn name(colour: ColorType) -> &'static str {
    match colour {
        ColorType::Grayscale => "greyscale",
        ColorType::Rgb => "colour",
        ColorType::Indexed => "palette",
        ColorType::GrayscaleAlpha => "greyscale and alpha",
        ColorType::Rgba => "colour and alpha",
    }
}

fn malformed(path: &Path, reason: String, remedy: &'static str) -> FileError {
    FileError::Malformed { path: path.into(), place: Place::Whole, reason, remedy }
}
