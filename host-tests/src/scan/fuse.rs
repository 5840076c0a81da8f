//! The mesh of an object from depth images.

use super::frames;
use hangpose::perception::completion::CompletionSettings;
use hangpose::perception::depth::DepthImage;
use hangpose::perception::volume::VolumeSettings;
use hangpose::{Monitor, ScannedMesh, complete_scan, scan, suggested_voxel};

/// Depth up to which the images show the object, m: beyond it, nothing is.
const MAX_DEPTH: f32 = 5.0;

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

/// The surface that the images show of an object that is held alone, as the command makes it; empty if that is an error. What
/// they do not show is guessed as far as `guess` says; without, the mesh is open there.
pub fn fuse(images: &[DepthImage], guess: Option<&CompletionSettings>) -> Surface {
    let (frames, monitor) = (frames(images), Monitor::new());
    let settings = VolumeSettings {
        max_depth: MAX_DEPTH,
        ..VolumeSettings::new(suggested_voxel(&frames, MAX_DEPTH, None))
    };
    let mesh = match guess {
        Some(guess) => complete_scan(&frames, &settings, guess, &monitor),
        None => scan(&frames, &settings, &monitor),
    };
    mesh.map(|mesh| {
        let ScannedMesh { vertices, triangles, seen, viewpoints, .. } = mesh;
        Surface { vertices, triangles, seen, viewpoints }
    })
    .unwrap_or_default()
}
