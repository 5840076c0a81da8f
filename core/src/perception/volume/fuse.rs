//! Projective fusion: every voxel takes over what the pixel that it falls on says of it.

use super::VolumeSettings;
use super::blocks::{BLOCK, BLOCK_VOXELS, Key, VOXEL_RANGE};
use super::settings::Extent;
use super::voxel::{Voxel, weight};
use crate::geometry::{Point, Vector};
use crate::perception::depth::{DepthImage, Mask, NOTHING};

/// Radius around a voxel's pixel within which a jump in depth counts as near, voxels: enough for the straight outline of
/// an object at any angle to cross one of the four probes before it reaches a neighbouring voxel.
const OUTLINE: f32 = 1.5;
/// Mean distance from an outline of the voxels that are nearer than [`OUTLINE`], voxels.
const BESIDE: f32 = OUTLINE / 2.0;
/// Distance between the pixels with a depth on both sides of pixels without, up to which those between them are taken for
/// lost, pixels. Measurements fail in narrower stretches: at edges, and where a curved surface turns away.
const LOST: i32 = 8;
/// Difference in depth up to which a pixel supports its neighbour, parts of the depth, besides the truncation: the noise of
/// depth cameras.
const SUPPORT: f32 = 0.01;
/// Number of the eight pixels around one that must support it. A pixel with fewer is a flying pixel between two surfaces.
const SUPPORTING: usize = 2;
/// Distance behind a surface up to which an observation has more than the least weight, truncations. Farther behind, the image shows
/// only that something is in front of it, and an image from the other side of a thin wall knows better. With 1, walls of 0.75 voxels
/// became 2.3 times as thick, with this 1.3 times; of 130 scanned pairs each (`tables --scan 24+3,3+1 --pairs 130 --seed 504`) 116 and
/// 82 hung, with this 122 and 90. Smaller: noise in front of a surface outweighs noise behind it, and bars become thinner.
const TRUSTED: f32 = 0.5;
/// The least such distance, over the square of the depth, 1/m: eight standard deviations of the noise of structured light, 1.4 mm at a
/// metre (Khoshelham and Elberink 2012). Smaller: noise and errors of poses move far surfaces away from the camera. Of the vertices
/// of a room 71 and 65 % are within half a voxel of Open3D's (`bench/fusion.py`), without this 55 and 52 %.
const TRUSTED_NOISE: f32 = 0.0112;
/// Weight of a pixel that sees nothing against one with a depth. It decides only where no image shows a surface: a surface
/// that other images show may return nothing at a grazing angle.
const NOTHING_SEEN: f32 = 1.0 / 32.0;
const ROW: usize = BLOCK as usize;

/// One image against the blocks of a volume.
pub(super) struct Fusion<'a> {
    image: &'a DepthImage<'a>,
    mask: Option<Mask<'a>>,
    extent: &'a Extent,
    /// In camera coordinates, metres: the world's origin, and the ways to the next voxel along each axis.
    origin: Vector,
    steps: [Vector; 3],
    voxel: f32,
    truncation: f32,
    max_depth: f32,
    missing_is_free: bool,
    /// Difference of raw depths that is a jump.
    jump: f32,
    /// [`OUTLINE`] in pixels across and down, at a depth of a metre.
    outline: [f32; 2],
}

impl<'a> Fusion<'a> {
    pub(super) fn new(
        settings: &VolumeSettings,
        extent: &'a Extent,
        image: &'a DepthImage<'a>,
        mask: Option<Mask<'a>>,
    ) -> Self {
        let inverse = image.pose().inverse();
        let rotation = inverse.rotation.to_rotation_matrix();
        Self {
            image,
            mask,
            extent,
            origin: inverse.translation.vector,
            steps: [Vector::x(), Vector::y(), Vector::z()].map(|axis| rotation * axis * settings.voxel),
            voxel: settings.voxel,
            truncation: settings.truncation,
            max_depth: settings.max_depth,
            missing_is_free: settings.missing_is_free,
            jump: settings.truncation / image.scale(),
            outline: image.camera().focal().map(|focal| OUTLINE * settings.voxel * focal),
        }
    }

    /// Updates a block; returns the number of voxels that were seen.
    pub(super) fn update(&self, key: Key, voxels: &mut [Voxel]) -> usize {
        let first = key.first_voxel();
        let offset = first.map(|x| x as f32 - VOXEL_RANGE as f32);
        let [x, y, z] = self.steps;
        let corner = self.origin + x * offset[0] + y * offset[1] + z * offset[2];
        if !self.may_see(&corner) {
            return 0;
        }
        let mut seen = 0;
        // The part of the block that is in the extent.
        let from = [0, 1, 2].map(|i| self.extent.first[i].saturating_sub(first[i]) as usize);
        let to = [0, 1, 2].map(|i| ((self.extent.last[i] + 1).saturating_sub(first[i]) as usize).min(ROW));
        for k in from[2]..to[2] {
            for j in from[1]..to[1] {
                let start = corner + y * j as f32 + z * k as f32;
                let row = &mut voxels[ROW * (j + ROW * k)..][..ROW];
                seen += self.update_row(&start, &mut row[..to[0]], from[0]);
            }
        }
        seen
    }

    /// Whether some voxel of the block whose first voxel is at `corner` may be in the image.
    fn may_see(&self, corner: &Vector) -> bool {
        let [x, y, z] = self.steps;
        let half = (ROW - 1) as f32 / 2.0;
        let centre = corner + (x + y + z) * half;
        // The sphere around the block.
        let radius = 1.75 * half * self.voxel;
        let near = centre.z - radius;
        if near <= 0.0 {
            return centre.z + radius > 0.0;
        }
        let camera = self.image.camera();
        if camera.is_distorted() {
            return true;
        }
        let (focal, middle, size) = (camera.focal(), camera.centre(), camera.size());
        (0..2).all(|i| {
            // Bounds of the sphere's image: those of the box around it.
            let [low, high] = [centre[i] - radius, centre[i] + radius];
            let far = centre.z + radius;
            let low = low / if low < 0.0 { near } else { far };
            let high = high / if high < 0.0 { far } else { near };
            focal[i] * high + middle[i] > -0.5 && focal[i] * low + middle[i] < size[i] as f32 - 0.5
        })
    }

    /// Updates the voxels of a row from the index `from` on. The first voxel of the row is at `start` in camera
    /// coordinates.
    #[inline]
    fn update_row(&self, start: &Vector, row: &mut [Voxel], from: usize) -> usize {
        let camera = self.image.camera();
        let (focal, centre, [width, height]) = (camera.focal(), camera.centre(), camera.size());
        let step = self.steps[0];
        // Apart from the look-ups, so that the compiler makes vector instructions of it.
        let (mut depths, mut inverses) = ([0.0_f32; ROW], [0.0_f32; ROW]);
        let (mut columns, mut lines) = ([0.0_f32; ROW], [0.0_f32; ROW]);
        for i in 0..ROW {
            let along = i as f32;
            depths[i] = start.z + step.z * along;
            inverses[i] = 1.0 / depths[i];
            columns[i] = (start.x + step.x * along) * inverses[i] * focal[0] + (centre[0] + 0.5);
            lines[i] = (start.y + step.y * along) * inverses[i] * focal[1] + (centre[1] + 0.5);
        }
        if camera.is_distorted() {
            for i in 0..ROW {
                let at = Point::from(start + step * i as f32);
                let pixel = camera.project(at.into()).unwrap_or([-1.0; 2]);
                (columns[i], lines[i]) = (pixel[0] + 0.5, pixel[1] + 0.5);
            }
        }
        let (last_column, last_line) = (width as f32, height as f32);
        let mut seen = 0;
        for (i, voxel) in row.iter_mut().enumerate().skip(from) {
            let is_inside = depths[i] > 0.0
                && (0.0..last_column).contains(&columns[i])
                && (0.0..last_line).contains(&lines[i]);
            if is_inside {
                let [u, v] = [columns[i] as u32, lines[i] as u32];
                seen += usize::from(self.observe(voxel, [u, v], depths[i], inverses[i]));
            }
        }
        seen
    }

    /// Takes what a pixel says into a voxel at the given depth; false if it says nothing of it.
    #[inline]
    fn observe(&self, voxel: &mut Voxel, [u, v]: [u32; 2], depth: f32, inverse_depth: f32) -> bool {
        let pixel = v as usize * self.image.camera().size()[0] as usize + u as usize;
        let raw = self.image.depths()[pixel];
        let surface = match raw {
            0 | NOTHING if self.is_seen_through([u, v]) => f32::INFINITY,
            0 | NOTHING => return false,
            raw => f32::from(raw) * self.image.scale(),
        };
        let distance = surface - depth;
        let weight = match surface {
            f32::INFINITY => (NOTHING_SEEN * weight(inverse_depth)).max(1.0),
            _ => weight(inverse_depth),
        };
        if distance >= self.truncation {
            // Free, whatever the pixel shows. Beside an outline, the surface is nearer than along the ray.
            let is_beside = self.is_beside_surface([u, v], depth, inverse_depth);
            voxel.observe(if is_beside { BESIDE * self.voxel / self.truncation } else { 1.0 }, weight);
            return true;
        }
        if distance <= -self.truncation
            || surface > self.max_depth
            || self.mask.is_some_and(|mask| !mask.holds(pixel))
            || !self.is_supported([u, v], raw)
            || (distance < -self.voxel && self.is_near_outline([u, v], raw, inverse_depth))
        {
            return false;
        }
        let part = distance / self.truncation;
        let trusted = (TRUSTED * self.truncation).max(TRUSTED_NOISE * depth * depth).min(self.truncation);
        let trust = 1.0 + (distance / trusted).clamp(-1.0, 0.0);
        voxel.observe(part, (weight * trust).max(1.0));
        true
    }

    /// Whether the pixels around one show the same surface.
    #[inline]
    fn is_supported(&self, [u, v]: [u32; 2], raw: u16) -> bool {
        let [width, height] = self.image.camera().size();
        let raw = f32::from(raw);
        let limit = self.jump + SUPPORT * raw;
        let mut supporting = 0;
        for v in v.saturating_sub(1)..=v.saturating_add(1).min(height - 1) {
            for u in u.saturating_sub(1)..=u.saturating_add(1).min(width - 1) {
                let other = f32::from(self.image.depths()[v as usize * width as usize + u as usize]);
                supporting += usize::from((other - raw).abs() <= limit);
                // The pixel itself is among them.
                if supporting > SUPPORTING {
                    return true;
                }
            }
        }
        false
    }

    /// Whether the depth jumps back close to a pixel. What is behind such a pixel borders on what is seen free beside it;
    /// there is no surface between them.
    #[inline]
    fn is_near_outline(&self, pixel: [u32; 2], raw: u16, inverse_depth: f32) -> bool {
        let limit = f32::from(raw) + self.jump;
        let width = self.image.camera().size()[0].max(1);
        self.probes(pixel, inverse_depth).into_iter().any(|probe| match self.image.depths()[probe] {
            0 | NOTHING => self.is_seen_through([probe as u32 % width, probe as u32 / width]),
            other => f32::from(other) > limit,
        })
    }

    /// Whether the camera sees past everything at a pixel without a depth: the pixel is not lost between pixels with a
    /// depth.
    #[inline]
    fn is_seen_through(&self, [u, v]: [u32; 2]) -> bool {
        let [width, height] = self.image.camera().size();
        let has_depth = |across: i32, down: i32| {
            let (u, v) = (u.wrapping_add_signed(across), v.wrapping_add_signed(down));
            let is_inside = u < width && v < height;
            is_inside && !matches!(self.image.depths()[v as usize * width as usize + u as usize], 0 | NOTHING)
        };
        self.missing_is_free
            && [[1, 0], [0, 1], [1, 1], [1, -1]].iter().all(|[across, down]| {
                let first = |sign: i32| {
                    (1..LOST).find(|n| has_depth(sign * n * across, sign * n * down)).unwrap_or(LOST)
                };
                let before = first(-1);
                before == LOST || before + first(1) > LOST
            })
    }

    /// Whether a pixel that sees past a depth, metres, has a surface close beside it: one at this
    /// depth, or up to the truncation before it, which may reach as far.
    #[inline]
    fn is_beside_surface(&self, pixel: [u32; 2], depth: f32, inverse_depth: f32) -> bool {
        let raw = depth / self.image.scale();
        let (nearest, farthest) = (raw - self.jump, raw + OUTLINE * self.voxel / self.image.scale());
        self.probes(pixel, inverse_depth).into_iter().any(|probe| {
            let other = self.image.depths()[probe];
            // No surface is at the depth of pixels that saw nothing.
            !matches!(other, 0 | NOTHING)
                && (nearest..farthest).contains(&f32::from(other))
                && self.mask.is_none_or(|mask| mask.holds(probe))
        })
    }

    /// Four pixels around one, [`OUTLINE`] away at the depth of a voxel.
    #[inline]
    fn probes(&self, [u, v]: [u32; 2], inverse_depth: f32) -> [usize; 4] {
        let [width, height] = self.image.camera().size().map(|x| x as usize);
        let radius = |axis: usize| (self.outline[axis] * inverse_depth + 1.0) as usize;
        let (across, down, u, v) = (radius(0), radius(1), u as usize, v as usize);
        [
            v * width + u.saturating_sub(across),
            v * width + u.saturating_add(across).min(width - 1),
            v.saturating_sub(down) * width + u,
            v.saturating_add(down).min(height - 1) * width + u,
        ]
    }
}

const _: () = assert!(ROW * ROW * ROW == BLOCK_VOXELS);
