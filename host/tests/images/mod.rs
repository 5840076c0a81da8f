//! Depth images, masks and poses as files have them.

use hangpose::geometry::Pose;
use nalgebra::Matrix4;
use png::{BitDepth, ColorType};

/// A row-major 4 x 4 matrix.
pub(crate) fn rows(pose: &Pose) -> [[f64; 4]; 4] {
    let matrix: Matrix4<f64> = pose.to_homogeneous().cast();
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]))
}

/// Four lines of four numbers.
pub(crate) fn matrix(pose: &Pose) -> String {
    rows(pose).map(|row| row.map(|x| format!("{x:.9}")).join(" ") + "\n").concat()
}

pub(crate) fn png(size: [u32; 2], colour: ColorType, bits: BitDepth, bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, size[0], size[1]);
    encoder.set_color(colour);
    encoder.set_depth(bits);
    if colour == ColorType::Indexed {
        encoder.set_palette(vec![0; 768]);
    }
    encoder.write_header().unwrap().write_image_data(bytes).unwrap();
    out
}

pub(crate) fn depth_png(size: [u32; 2], depths: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = depths.iter().flat_map(|depth| depth.to_be_bytes()).collect();
    png(size, ColorType::Grayscale, BitDepth::Sixteen, &bytes)
}
