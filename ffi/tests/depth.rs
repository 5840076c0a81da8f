//! The C functions for depth images give the same bits as the core. The golden hashes of the core's bits are in
//! host/tests/golden_scan.rs.

use hangpose::Monitor;
use hangpose::geometry::{Aabb, Cloud, Mesh, Point, Pose, Vector};
use hangpose::perception::completion::{Completion, CompletionSettings, room};
use hangpose::perception::depth::{DepthCamera, DepthImage, Mask};
use hangpose::perception::depth_points::{DepthPointsSettings, depth_points};
use hangpose::perception::isosurface::Isosurface;
use hangpose::perception::volume::{Volume, VolumeLimits, VolumeSettings};
use hangpose_ffi::*;
use nalgebra::{Quaternion, UnitQuaternion};
use std::mem::MaybeUninit;
use std::ptr::null_mut;

const CAMERA: hangpose_camera = hangpose_camera {
    width: 96,
    height: 72,
    focal: [120.0, 121.0],
    centre: [47.3, 36.1],
    distortion: [-0.1, 0.02, 1e-3, 0.0, 0.0],
};
/// Metres for each unit of depth.
const SCALE: f32 = 1e-4;
/// Radius of the ball around the origin, metres.
const RADIUS: f32 = 0.03;
/// Distance from the cameras to the ball, metres.
const AWAY: f32 = 0.3;
const VOXEL: f32 = 0.003;
/// Rotations of the cameras, as quaternions x, y, z, w of any length.
const TURNS: [[f32; 4]; 2] = [[0.0, 0.0, 0.0, 1.0], [0.5, 0.1, 0.0, 1.0]];

/// A view of the ball before nothing, worked out with nothing but square roots.
struct View {
    camera: DepthCamera,
    quaternion: [f32; 4],
    pose: Pose,
    depths: Vec<u16>,
    labels: Vec<u8>,
}

impl View {
    fn new(quaternion: [f32; 4]) -> Self {
        let hangpose_camera { width, height, focal, centre, distortion } = CAMERA;
        let camera = DepthCamera::new([width, height], focal, centre, distortion).unwrap();
        let [x, y, z, w] = quaternion;
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        let eye = rotation * Vector::new(0.0, 0.0, -AWAY);
        let depth = |(u, v): (u32, u32)| {
            let [x, y] = camera.direction([u as f32, v as f32]);
            let square = x * x + y * y + 1.0;
            let root = AWAY * AWAY - square * (AWAY * AWAY - RADIUS * RADIUS);
            if root < 0.0 { 0 } else { ((AWAY - root.sqrt()) / square / SCALE) as u16 }
        };
        let pixels = || (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
        // A part of the ball belongs to something else.
        let labels = pixels().map(|(u, v)| if u > 50 && v > 40 { 3 } else { 7 }).collect();
        let depths = pixels().map(depth).collect();
        Self { camera, quaternion, pose: Pose::from_parts(eye.into(), rotation), depths, labels }
    }

    fn core(&self) -> (DepthImage<'_>, Option<Mask<'_>>) {
        let image = DepthImage::new(self.camera, &self.depths, SCALE, self.pose).unwrap();
        (image, Some(Mask { labels: &self.labels, label: 7 }))
    }

    fn c(&self) -> hangpose_depth_image {
        hangpose_depth_image {
            struct_size: size_of::<hangpose_depth_image>() as u32,
            depth_count: self.depths.len() as u32,
            label_count: self.labels.len() as u32,
            scale: SCALE,
            camera: CAMERA,
            position: self.pose.translation.vector.into(),
            quaternion: self.quaternion,
            depths: self.depths.as_ptr(),
            labels: self.labels.as_ptr(),
            label: 7,
        }
    }
}

fn views() -> Vec<View> {
    TURNS.map(View::new).into()
}

/// The bits of numbers, to compare them exactly.
fn bits(rows: &[[f32; 3]]) -> Vec<[u32; 3]> {
    rows.iter().map(|row| row.map(f32::to_bits)).collect()
}

fn c_settings(crop: &[[f32; 3]; 2]) -> hangpose_volume_settings {
    let mut settings = MaybeUninit::uninit();
    let size = size_of::<hangpose_volume_settings>();
    // SAFETY: the settings have room for what the call writes.
    let mut settings = unsafe {
        assert_eq!(
            hangpose_volume_settings_init(settings.as_mut_ptr(), size, VOXEL, null_mut()),
            HANGPOSE_OK
        );
        settings.assume_init()
    };
    (settings.dense, settings.missing_is_free, settings.crop) = (1, 1, crop.as_ptr().cast());
    settings
}

#[test]
fn a_completed_mesh_has_the_bits_of_the_core() {
    let (views, monitor, guess) = (views(), Monitor::new(), CompletionSettings::default());
    let settings = VolumeSettings { missing_is_free: true, ..VolumeSettings::new(VOXEL) };
    let margin = settings.truncation + 2.0 * settings.voxel;
    let crop = room(views.iter().map(View::core), &guess, settings.max_depth, margin).unwrap();
    let settings = VolumeSettings { crop: Some(crop), dense: true, ..settings };
    let limits = VolumeLimits { blocks: settings.dense_blocks().unwrap() };
    let mut memory = vec![0; Volume::bytes(&limits)];
    let mut volume = Volume::new(&settings, &limits, &mut memory).unwrap();
    let mut pixels = Vec::new();
    for (image, mask) in views.iter().map(View::core) {
        pixels.push(volume.integrate(&image, mask, &monitor).unwrap().pixels as u32);
    }
    volume.complete(&guess, &mut vec![0; Completion::bytes(limits.blocks)], &monitor).unwrap();
    let mut memory = vec![0; Isosurface::bytes(limits.blocks)];
    let surface = Isosurface::find(&volume, &mut memory, &monitor).unwrap();
    let (mut vertices, mut triangles) =
        (vec![[0.0_f32; 3]; surface.vertices()], vec![[0_u32; 3]; surface.triangles()]);
    let mut seen = vec![0; surface.vertices()];
    surface.write(&mut vertices, &mut triangles).unwrap();
    surface.write_seen(&mut seen).unwrap();
    assert!(pixels.iter().all(|count| *count > 300) && seen.contains(&0) && seen.contains(&1));

    let images: Vec<_> = views.iter().map(View::c).collect();
    let mut box_rows = [[0.0_f32; 3]; 2];
    let settings = c_settings(&box_rows);
    // SAFETY: the pointers lead to valid values, and the counts are those of the arrays.
    unsafe {
        let status = hangpose_volume_room(
            images.as_ptr(),
            2,
            &hangpose_volume_settings { crop: std::ptr::null(), ..settings },
            box_rows.as_mut_ptr().cast(),
            null_mut(),
        );
        assert_eq!(status, HANGPOSE_OK);
    }
    assert_eq!(Aabb { min: box_rows[0].into(), max: box_rows[1].into() }, crop);
    let settings = c_settings(&box_rows);
    // SAFETY: as above.
    let blocks = unsafe { hangpose_volume_blocks(&settings) };
    assert_eq!(blocks as usize, limits.blocks);

    let mut memory = vec![0_u8; hangpose_volume_bytes(blocks)];
    let mut work = vec![0_u8; hangpose_complete_bytes(blocks).max(hangpose_surface_bytes(blocks))];
    let (work, work_size) = (work.as_mut_ptr().cast(), work.len());
    let mut volume = null_mut();
    let mut mesh = hangpose_mesh {
        struct_size: size_of::<hangpose_mesh>() as u32,
        vertex_count: 0,
        triangle_count: 0,
        vertices: std::ptr::null(),
        viewpoint_count: 0,
        viewpoints: std::ptr::null(),
        triangles: std::ptr::null(),
    };
    // SAFETY: as above.
    unsafe {
        let (size, place) = (memory.len(), memory.as_mut_ptr().cast());
        assert_eq!(
            hangpose_volume_create(place, size, &settings, blocks, &mut volume, null_mut()),
            HANGPOSE_OK
        );
        for (image, expected) in images.iter().zip(&pixels) {
            let mut count = 0;
            let status = hangpose_volume_integrate(volume, image, null_mut(), &mut count, null_mut());
            assert_eq!((status, count), (HANGPOSE_OK, *expected));
        }
        assert_eq!(hangpose_volume_complete(volume, work, work_size, null_mut(), null_mut()), HANGPOSE_OK);
        let find = |vertices: &mut [[f32; 3]], triangles: &mut [[u32; 3]], seen: *mut u8, mesh: &mut _| {
            hangpose_volume_surface(
                volume,
                work,
                work_size,
                null_mut(),
                if vertices.is_empty() { null_mut() } else { vertices.as_mut_ptr().cast() },
                vertices.len() as u32,
                if triangles.is_empty() { null_mut() } else { triangles.as_mut_ptr().cast() },
                triangles.len() as u32,
                seen,
                mesh,
                null_mut(),
            )
        };
        assert_eq!(find(&mut [], &mut [], null_mut(), &mut mesh), HANGPOSE_OK);
        let (v, t) = (mesh.vertex_count as usize, mesh.triangle_count as usize);
        assert_eq!((v, t), (vertices.len(), triangles.len()));
        let (mut c_vertices, mut c_triangles, mut c_seen) = (vec![[0.0; 3]; v], vec![[0; 3]; t], vec![9; v]);
        let status = find(&mut c_vertices, &mut c_triangles, c_seen.as_mut_ptr(), &mut mesh);
        assert_eq!(status, HANGPOSE_OK);
        assert!(bits(&c_vertices) == bits(&vertices) && c_triangles == triangles && c_seen == seen);
        assert_eq!(
            (mesh.vertices, mesh.triangles),
            (c_vertices.as_ptr().cast(), c_triangles.as_ptr().cast())
        );
        assert!(Mesh::new(&c_vertices, &c_triangles).is_ok());
    }
}

#[test]
fn points_of_several_images_have_the_bits_of_the_core() {
    let views = views();
    let pixels = (CAMERA.width * CAMERA.height) as usize;
    let settings = DepthPointsSettings {
        stride: 2,
        crop: Some(Aabb { min: Point::new(-1.0, -0.01, -1.0), max: Point::new(1.0, 1.0, 1.0) }),
        ..Default::default()
    };
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    for (image, mask) in views.iter().map(View::core) {
        let (mut p, mut n) = (vec![[0.0; 3]; pixels], vec![[0.0; 3]; pixels]);
        let count = depth_points(&image, mask, &settings, &mut p, &mut n).unwrap().points;
        points.extend_from_slice(&p[..count]);
        normals.extend_from_slice(&n[..count]);
    }
    assert!(points.len() > 100);

    let images: Vec<_> = views.iter().map(View::c).collect();
    let crop = [[-1.0, -0.01, -1.0], [1.0_f32; 3]];
    let mut settings = MaybeUninit::uninit();
    let size = size_of::<hangpose_points_settings>();
    // SAFETY: the settings have room for what the call writes.
    let mut settings = unsafe {
        assert_eq!(hangpose_points_settings_init(settings.as_mut_ptr(), size, null_mut()), HANGPOSE_OK);
        settings.assume_init()
    };
    (settings.stride, settings.crop) = (2, crop.as_ptr().cast());
    let null = std::ptr::null();
    let mut cloud = hangpose_cloud {
        struct_size: size_of::<hangpose_cloud>() as u32,
        point_count: 0,
        viewpoint_count: 0,
        points: null,
        normals: null,
        viewpoints: null,
        marks: null.cast(),
        region: crop.as_ptr().cast(),
    };
    let find = |points: *mut f32, normals: *mut f32, capacity, viewpoints: *mut f32, cloud: &mut _| {
        // SAFETY: the pointers lead to valid values, and the counts are those of the arrays.
        unsafe {
            hangpose_depth_points(
                images.as_ptr(),
                2,
                &settings,
                points,
                normals,
                capacity,
                viewpoints,
                cloud,
                null_mut(),
            )
        }
    };
    assert_eq!(find(null_mut(), null_mut(), 0, null_mut(), &mut cloud), HANGPOSE_OK);
    let count = cloud.point_count as usize;
    assert_eq!((count, cloud.viewpoint_count), (points.len(), 2));
    let (mut c_points, mut c_normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
    let mut viewpoints = [[0.0; 3]; 2];
    let mut write = |capacity, cloud: &mut _| {
        let viewpoints = viewpoints.as_mut_ptr().cast();
        find(c_points.as_mut_ptr().cast(), c_normals.as_mut_ptr().cast(), capacity, viewpoints, cloud)
    };
    assert_eq!(write(count as u32 - 1, &mut cloud), HANGPOSE_ERROR_CAPACITY);
    assert_eq!(write(count as u32, &mut cloud), HANGPOSE_OK);
    assert!(bits(&c_points) == bits(&points) && bits(&c_normals) == bits(&normals));
    let eyes: Vec<[f32; 3]> = views.iter().map(|view| view.pose.translation.vector.into()).collect();
    assert_eq!(viewpoints[..], eyes);
    assert_eq!((cloud.points, cloud.viewpoints), (c_points.as_ptr().cast(), viewpoints.as_ptr().cast()));
    assert_eq!(cloud.region, crop.as_ptr().cast());
    assert!(Cloud::new(&c_points, Some(&c_normals)).unwrap().seen_from(&viewpoints).is_ok());
}
