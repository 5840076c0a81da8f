//! Calls about depth images.

use super::given::{self, Sized};
use super::{HANDLE, Model, Program};
use crate::images::DrawnImage;
use hangpose_ffi::*;
use std::ffi::c_void;
use std::ptr::{null, null_mut};

/// Most blocks of a volume here, 0.4 MB.
const MOST_BLOCKS: u32 = 200;

fn image(drawn: &DrawnImage) -> hangpose_depth_image {
    hangpose_depth_image {
        depth_count: drawn.depths.len() as u32,
        label_count: drawn.labels.as_ref().map_or(0, |labels| labels.len() as u32),
        scale: drawn.scale,
        camera: hangpose_camera {
            width: drawn.size[0],
            height: drawn.size[1],
            focal: drawn.focal,
            centre: drawn.centre,
            distortion: drawn.distortion,
        },
        position: drawn.position,
        quaternion: drawn.quaternion,
        depths: drawn.depths.as_ptr(),
        labels: drawn.labels.as_ref().map_or(null(), |labels| labels.as_ptr()),
        label: drawn.label,
        ..hangpose_depth_image::sized()
    }
}

impl Program<'_> {
    fn settings(&mut self, crop: *const f32) -> hangpose_volume_settings {
        let mut settings = hangpose_volume_settings::sized();
        let voxel = self.draw.pick(&[0.02, 0.01, 0.05, 0.005]);
        let voxel = self.draw.or_number(voxel);
        // SAFETY: the pointer leads to settings.
        self.call("volume_settings_init", |_, detail| unsafe {
            hangpose_volume_settings_init(&mut settings, size_of::<hangpose_volume_settings>(), voxel, detail)
        });
        (settings.dense, settings.missing_is_free) = (self.draw.below(2) as u32, self.draw.below(2) as u32);
        given::spoil(&mut settings, core::mem::offset_of!(hangpose_volume_settings, crop), &mut self.draw);
        settings.crop = if self.draw.one_in(3) { null() } else { crop };
        settings
    }

    fn images(&mut self) -> Vec<DrawnImage> {
        (0..1 + self.draw.below(2)).map(|_| DrawnImage::draw(&mut self.draw)).collect()
    }

    pub(super) fn create_volume(&mut self) {
        let drawn = self.images();
        let images: Vec<_> = drawn.iter().map(image).collect();
        let mut crop = [[-0.1_f32; 3], [0.1; 3]];
        let mut settings = self.settings(crop.as_ptr().cast());
        if self.draw.one_in(2) {
            let outside = hangpose_volume_settings { crop: null(), ..settings };
            let mut room = crop;
            let count = self.draw.below(images.len() + 1) as u32;
            // SAFETY: the pointers lead to valid values.
            let status = self.call("volume_room", |_, detail| unsafe {
                hangpose_volume_room(images.as_ptr(), count, &outside, room.as_mut_ptr().cast(), detail)
            });
            if status == HANGPOSE_OK {
                assert!(room.as_flattened().iter().all(|x| x.is_finite()), "the room is {room:?}");
                crop = room;
                settings.crop = crop.as_ptr().cast();
            }
        }
        // SAFETY: the pointers lead to settings or are null.
        let dense = unsafe {
            assert_eq!(hangpose_volume_blocks(null()), 0);
            hangpose_volume_blocks(&settings)
        };
        let blocks = if self.draw.one_in(16) { self.draw.word() } else { dense.clamp(1, MOST_BLOCKS) };
        assert!(hangpose_volume_bytes(blocks) <= hangpose_volume_bytes(blocks.saturating_add(1)));
        let (mut block, is_enough) = self.memory(hangpose_volume_bytes(blocks));
        let (memory, size) = (block.memory().as_mut_ptr().cast::<c_void>(), block.size());
        let mut volume = null_mut();
        // SAFETY: the pointers lead to valid values, and the memory is that of the block.
        let status = self.call("volume_create", |_, detail| unsafe {
            hangpose_volume_create(memory, size, &settings, blocks, &mut volume, detail)
        });
        assert!(is_enough || status != HANGPOSE_OK, "a volume was made in too little memory");
        assert_eq!(volume.is_null(), status != HANGPOSE_OK);
        block.check();
        if status == HANGPOSE_OK {
            self.volumes.truncate(1);
            self.volumes.insert(0, Model { block, handle: volume, count: blocks });
        }
        // The settings and their box are needed during the call only.
        crop.fill([f32::NAN; 3]);
    }

    pub(super) fn integrate(&mut self) {
        let drawn = self.images();
        let mut copy = Vec::new();
        let (volume, _) = Self::choose(&mut self.draw, &self.volumes, HANDLE, &mut copy);
        let monitor = self.monitor();
        for one in &drawn {
            let (image, mut pixels) = (image(one), 0);
            // SAFETY: the pointers lead to valid values or are null.
            let status = self.call("volume_integrate", |_, detail| unsafe {
                hangpose_volume_integrate(volume, &image, monitor, &mut pixels, detail)
            });
            assert!(status == HANGPOSE_OK || pixels == 0);
            assert!(pixels <= image.depth_count);
        }
    }

    pub(super) fn complete(&mut self) {
        let mut copy = Vec::new();
        let (volume, blocks) = Self::choose(&mut self.draw, &self.volumes, HANDLE, &mut copy);
        let (mut work, _) = self.memory(hangpose_complete_bytes(blocks));
        let (memory, size) = (work.memory().as_mut_ptr().cast(), work.size());
        let monitor = self.monitor();
        // SAFETY: the pointers lead to valid values or are null.
        self.call("volume_complete", |_, detail| unsafe {
            hangpose_volume_complete(volume, memory, size, monitor, detail)
        });
        work.check();
    }

    pub(super) fn find_surface(&mut self) {
        let mut copy = Vec::new();
        let (volume, blocks) = Self::choose(&mut self.draw, &self.volumes, HANDLE, &mut copy);
        let (mut work, _) = self.memory(hangpose_surface_bytes(blocks));
        let (memory, size) = (work.memory().as_mut_ptr().cast(), work.size());
        let monitor = self.monitor();
        let mut mesh = hangpose_mesh::sized();
        // SAFETY: the pointers lead to valid values or are null.
        let status = self.call("volume_surface", |_, detail| unsafe {
            hangpose_volume_surface(
                volume,
                memory,
                size,
                monitor,
                null_mut(),
                0,
                null_mut(),
                0,
                null_mut(),
                &mut mesh,
                detail,
            )
        });
        work.check();
        if status != HANGPOSE_OK {
            return;
        }
        let less = if self.draw.one_in(4) { 1 } else { 0 };
        let [vertices, triangles] =
            [mesh.vertex_count, mesh.triangle_count].map(|count| count.saturating_sub(less));
        let (mut rows, mut corners) =
            (vec![[f32::NAN; 3]; vertices as usize], vec![[7_u32; 3]; triangles as usize]);
        let mut seen = vec![9; vertices as usize];
        let (rows_at, corners_at) = (rows.as_mut_ptr().cast(), corners.as_mut_ptr().cast());
        let seen_at = if self.draw.one_in(3) { null_mut() } else { seen.as_mut_ptr() };
        // SAFETY: the pointers lead to valid values, and the counts are those of the arrays.
        let status = self.call("volume_surface", |_, detail| unsafe {
            hangpose_volume_surface(
                volume, memory, size, monitor, rows_at, vertices, corners_at, triangles, seen_at, &mut mesh,
                detail,
            )
        });
        work.check();
        if status == HANGPOSE_OK && (less == 0 || mesh.vertex_count == 0) {
            assert!(rows.as_flattened().iter().all(|x| x.is_finite()));
            assert!(corners.as_flattened().iter().all(|index| *index < mesh.vertex_count));
            assert!(seen_at.is_null() || seen.iter().all(|mark| *mark < 2));
        } else if less == 1 && mesh.vertex_count > 0 && status != HANGPOSE_OK {
            assert!(status < 0 || status == HANGPOSE_CANCELLED);
        }
    }

    pub(super) fn find_points(&mut self) {
        let drawn = self.images();
        let images: Vec<_> = drawn.iter().map(image).collect();
        let crop = [self.draw.place(1.0), self.draw.place(1.0)];
        let mut settings = hangpose_points_settings::sized();
        // SAFETY: the pointer leads to settings.
        self.call("points_settings_init", |_, detail| unsafe {
            hangpose_points_settings_init(&mut settings, size_of::<hangpose_points_settings>(), detail)
        });
        given::spoil(&mut settings, core::mem::offset_of!(hangpose_points_settings, crop), &mut self.draw);
        settings.crop = if self.draw.one_in(3) { crop.as_ptr().cast() } else { null() };
        let mut cloud = hangpose_cloud::sized();
        let count = images.len() as u32;
        // SAFETY: the pointers lead to valid values.
        let status = self.call("depth_points", |_, detail| unsafe {
            hangpose_depth_points(
                images.as_ptr(),
                count,
                &settings,
                null_mut(),
                null_mut(),
                0,
                null_mut(),
                &mut cloud,
                detail,
            )
        });
        if status != HANGPOSE_OK {
            return;
        }
        let less = u32::from(self.draw.one_in(4));
        let capacity = cloud.point_count - less.min(cloud.point_count);
        let (mut points, mut normals) =
            (vec![[0.0_f32; 3]; capacity as usize], vec![[0.0_f32; 3]; capacity as usize]);
        let mut viewpoints = vec![[0.0_f32; 3]; images.len()];
        // SAFETY: the pointers lead to valid values, and the counts are those of the arrays.
        let status = self.call("depth_points", |_, detail| unsafe {
            let [points, normals, viewpoints] =
                [&mut points, &mut normals, &mut viewpoints].map(|rows| rows.as_mut_ptr().cast());
            hangpose_depth_points(
                images.as_ptr(),
                count,
                &settings,
                points,
                normals,
                capacity,
                viewpoints,
                &mut cloud,
                detail,
            )
        });
        if status == HANGPOSE_OK {
            assert_eq!((cloud.point_count, less), (capacity, 0));
            assert!(points.as_flattened().iter().chain(normals.as_flattened()).all(|x| x.is_finite()));
        }
    }
}
