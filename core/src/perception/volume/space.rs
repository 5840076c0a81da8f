//! What is known of a place in space.

use super::Volume;
use super::blocks::VOXEL_RANGE;
use super::voxel::Voxel;
use crate::geometry::Point;

/// Part of the truncation from which on a distance counts as cut off. Means of cut-off distances round by less.
const FREE: f32 = 0.99;

/// What the cameras know of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Space {
    /// A camera saw through it, and no surface is within the truncation.
    Free,
    /// A surface is within the truncation: the signed distance to it, metres, positive in front of it. It is measured along
    /// the cameras' axes, so it overstates the distance to surfaces that they saw at grazing angles.
    Surface(f32),
    /// No camera saw it: it is behind a surface, in no image, or outside of what the volume stores.
    Unknown,
}

impl Volume<'_> {
    /// What is known of a point in world coordinates, metres: interpolated between the eight voxels around it. It is
    /// unknown where one of them was not seen.
    pub fn space(&self, point: &Point) -> Space {
        let position = point.coords / self.settings.voxel;
        let limit = VOXEL_RANGE as f32 - 1.0;
        if !position.iter().all(|x| x.abs() < limit) {
            return Space::Unknown;
        }
        let floor = position.map(libm::floorf);
        let first = [0, 1, 2].map(|i| (floor[i] + VOXEL_RANGE as f32) as u32);
        let t = position - floor;
        let mut distance = 0.0;
        for corner in 0..8_u32 {
            let steps = [corner & 1, corner >> 1 & 1, corner >> 2];
            let voxel = self.voxel([0, 1, 2].map(|i| first[i] + steps[i]));
            if !voxel.is_seen() {
                return Space::Unknown;
            }
            let parts = [0, 1, 2].map(|i| if steps[i] == 1 { t[i] } else { 1.0 - t[i] });
            distance += f32::from(voxel.distance) * parts[0] * parts[1] * parts[2];
        }
        let part = distance / f32::from(Voxel::FREE);
        if part >= FREE { Space::Free } else { Space::Surface(part * self.settings.truncation) }
    }
}
