//! The mesh of an object from depth images.

use hangpose::Monitor;
use hangpose::perception::completion::{Completion, CompletionSettings, room};
use hangpose::perception::depth::DepthImage;
use hangpose::perception::isosurface::Isosurface;
use hangpose::perception::volume::{Volume, VolumeLimits, VolumeSettings};

/// Depth up to which the images show the object, m: beyond it, nothing is.
const MAX_DEPTH: f32 = 5.0;
/// Size of the voxels in largest extents of what the images show, and its bounds, m: finer than a wire, and at most about
/// 200,000 triangles.
const VOXEL: f32 = 0.01;
const VOXELS: [f32; 2] = [0.0015, 0.003];
/// Truncation of the distances, voxels.
const TRUNCATION: f32 = 4.0;

/// A triangle mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Vertices in world coordinates, m.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex indices of the triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// For each vertex 1 if an image shows the surface there, 0 if it was guessed.
    pub seen: Vec<u8>,
    /// Positions of the cameras in world coordinates, m; none with the exact shape.
    pub viewpoints: Vec<[f32; 3]>,
}

impl Surface {
    /// The triangles that images show, without those that were guessed.
    pub fn shown(&self) -> Vec<[u32; 3]> {
        let is_shown = |triangle: &&[u32; 3]| triangle.iter().all(|&vertex| self.seen[vertex as usize] == 1);
        self.triangles.iter().filter(is_shown).copied().collect()
    }
}

/// The surface that the images show of an object that is held alone. What they do not show is guessed as far as `guess`
/// says; without, the mesh is open there.
pub fn fuse(images: &[DepthImage], guess: Option<&CompletionSettings>) -> Surface {
    let room_for = guess.copied().unwrap_or_default();
    let shown = || images.iter().map(|image| (*image, None));
    let Some(shown_box) = room(shown(), &room_for, MAX_DEPTH, 0.0) else { return Surface::default() };
    let voxel = (VOXEL * shown_box.extents().max()).clamp(VOXELS[0], VOXELS[1]);
    let crop = room(shown(), &room_for, MAX_DEPTH, (TRUNCATION + 2.0) * voxel);
    let settings = VolumeSettings {
        crop,
        dense: true,
        missing_is_free: true,
        truncation: TRUNCATION * voxel,
        ..VolumeSettings::new(voxel)
    };
    let limits = VolumeLimits { blocks: settings.dense_blocks().unwrap_or_default() };
    let mut memory = vec![0; Volume::bytes(&limits)];
    let monitor = Monitor::new();
    let mut volume = Volume::new(&settings, &limits, &mut memory).expect("the box is near the origin");
    for image in images {
        volume.integrate(image, None, &monitor).expect("a dense volume has all blocks");
    }
    if let Some(guess) = guess {
        let mut scratch = vec![0; Completion::bytes(volume.blocks())];
        volume.complete(guess, &mut scratch, &monitor).expect("the volume is dense");
    }
    let mut scratch = vec![0; Isosurface::bytes(volume.blocks())];
    let found = Isosurface::find(&volume, &mut scratch, &monitor).expect("an object is not that large");
    let mut surface = Surface {
        vertices: vec![[0.0; 3]; found.vertices()],
        triangles: vec![[0; 3]; found.triangles()],
        seen: vec![0; found.vertices()],
        viewpoints: images.iter().map(|image| image.viewpoint().into()).collect(),
    };
    let written = found.write(&mut surface.vertices, &mut surface.triangles);
    written.and_then(|()| found.write_seen(&mut surface.seen)).expect("the lists are as long as needed");
    surface
}
