//! What a prediction is given: read by embedded/pairs.c as little-endian words of 32 bits.

/// Longest name of a pair, bytes, with the NUL at its end.
const NAME_BYTES: usize = 64;

/// The camera of all images: width and height, and the focal lengths, the principal point and the distortion, pixels.
pub(crate) const SIZE: [u32; 2] = [160, 120];
pub(crate) const FOCAL: [f32; 2] = [220.0, 221.0];
pub(crate) const CENTRE: [f32; 2] = [79.3, 60.1];
pub(crate) const DISTORTION: [f32; 5] = [-0.05, 0.01, 1e-3, 0.0, 0.0];
/// Metres for each unit of depth.
pub(crate) const UNIT: f32 = 1e-4;
/// Voxels of the scan of an object, metres.
pub(crate) const VOXEL: f32 = 0.004;

/// A pair of an object and a supporter, each as arrays or as depth images.
pub(crate) struct Given {
    pub name: String,
    /// 1 for the paper's profile.
    pub profile: u32,
    pub seed: u32,
    pub samples: u32,
    pub voxels: u32,
    /// 1 to plan a path to the best pose.
    pub plan: u32,
    pub object: Shape,
    pub supporter: Shape,
}

/// An object or a supporter. Where there are images, nothing else is given.
#[derive(Default)]
pub(crate) struct Shape {
    /// Vertices or points.
    pub points: Vec<[f32; 3]>,
    /// Of a supporter, or none.
    pub normals: Vec<[f32; 3]>,
    /// Of an object.
    pub triangles: Vec<[u32; 3]>,
    /// Views from which the points of the supporter were seen.
    pub viewpoints: Vec<[f32; 3]>,
    pub images: Vec<Image>,
}

/// A depth image and the pose of its camera.
pub(crate) struct Image {
    pub position: [f32; 3],
    pub quaternion: [f32; 4],
    pub depths: Vec<u16>,
}

impl Given {
    /// The pair as words, with their number first.
    pub(crate) fn words(&self) -> Vec<u32> {
        let mut name = [0; NAME_BYTES];
        assert!(self.name.len() < NAME_BYTES, "{} is too long a name", self.name);
        name[..self.name.len()].copy_from_slice(self.name.as_bytes());
        let (four, _) = name.as_chunks::<4>();
        let mut words: Vec<u32> = four.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect();
        words.extend([self.profile, self.seed, self.samples, self.voxels, self.plan]);
        for shape in [&self.object, &self.supporter] {
            let counts = [&shape.points, &shape.normals, &shape.viewpoints].map(|rows| rows.len() as u32);
            words.extend(counts);
            words.extend([shape.triangles.len() as u32, shape.images.len() as u32]);
        }
        for shape in [&self.object, &self.supporter] {
            for rows in [&shape.points, &shape.normals, &shape.viewpoints] {
                words.extend(rows.as_flattened().iter().map(|x| x.to_bits()));
            }
            words.extend(shape.triangles.as_flattened());
            for image in &shape.images {
                words.extend(SIZE);
                let camera = [&FOCAL[..], &CENTRE, &DISTORTION, &[UNIT], &image.position, &image.quaternion];
                words.extend(camera.concat().iter().map(|x| x.to_bits()));
                let (two, rest) = image.depths.as_chunks::<2>();
                assert!(rest.is_empty());
                words.extend(two.iter().map(|&[low, high]| u32::from(low) | u32::from(high) << 16));
            }
        }
        words.insert(0, words.len() as u32);
        words
    }
}
