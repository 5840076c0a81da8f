use super::*;
use crate::Stop;
use crate::geometry::{Aabb, Point, Pose};
use crate::perception::depth::DepthCamera;
use crate::perception::test_views::{
    AWAY, BALL_RADIUS, TORUS, View, around, ball, camera, cuboid, look_from, torus,
};
use crate::random::Random;

const VOXEL: f32 = 0.002;
/// A box around all shapes.
const HALF: f32 = 0.07;

fn cropped(dense: bool) -> VolumeSettings {
    let crop = Some(Aabb { min: [-HALF; 3].into(), max: [HALF; 3].into() });
    VolumeSettings { crop, dense, ..VolumeSettings::new(VOXEL) }
}

/// Calls `check` with an empty volume.
fn with_volume(settings: VolumeSettings, blocks: usize, check: impl FnOnce(&mut Volume)) {
    let limits = VolumeLimits { blocks };
    let mut memory = vec![0xAA; Volume::bytes(&limits)];
    check(&mut Volume::new(&settings, &limits, &mut memory).unwrap());
}

fn integrate(volume: &mut Volume, view: &View) -> Integrated {
    volume.integrate(&view.image(), None, &Monitor::new()).unwrap()
}

/// All that a volume stores.
fn bytes(volume: &Volume) -> Vec<u8> {
    let keys = (0..volume.blocks()).flat_map(|block| volume.block(block).0.first_voxel());
    let mut bytes: Vec<u8> = keys.flat_map(u32::to_le_bytes).collect();
    bytes.extend_from_slice(bytemuck::cast_slice(&*volume.voxels));
    bytes
}

/// A ball before a wall, seen from one side.
fn before_wall(eye: [f32; 3]) -> View {
    View::new(camera(), look_from(eye.into()), ball, 0.7)
}

/// Every random place is what the rays of the one camera say of it.
#[test]
fn a_dense_volume_tells_free_from_unknown() {
    let eye = Point::new(0.4, 0.0, 0.0);
    with_volume(cropped(true), 2000, |volume| {
        assert_eq!(volume.space(&Point::origin()), Space::Unknown);
        integrate(volume, &before_wall(eye.into()));
        let (mut random, mut counts) = (Random::new(1), [0; 3]);
        for _ in 0..20_000 {
            let point = Point::from([(); 3].map(|()| (random.next_f32() * 2.0 - 1.0) * (HALF - 2.0 * VOXEL)));
            // How close the ray through the point passes the ball's centre, and where it enters the ball.
            let ray = (point - eye).normalize();
            let along = -eye.coords.dot(&ray);
            let miss = (eye.coords + ray * along).norm();
            let margin = 3.0 * VOXEL;
            let entry = along - (BALL_RADIUS * BALL_RADIUS - miss * miss).max(0.0).sqrt();
            // The distance along the camera's axis, which is -x.
            let depth = (entry - (point - eye).norm()) * -ray.x;
            let space = volume.space(&point);
            if miss > BALL_RADIUS + margin {
                assert_eq!(space, Space::Free, "beside the ball: {point}");
                counts[0] += 1;
            } else if miss < BALL_RADIUS - margin {
                let truncation = volume.settings().truncation;
                if depth > truncation + margin {
                    // Where the ball is steep, it is nearer than along the axis, and the volume may know.
                    let is_near = matches!(space, Space::Surface(d) if d > VOXEL);
                    let distance = point.coords.norm() - BALL_RADIUS;
                    assert!(
                        space == Space::Free || (is_near && distance < margin),
                        "before the ball: {point}"
                    );
                } else if depth < -truncation - margin {
                    assert_eq!(space, Space::Unknown, "behind the surface: {point}");
                    counts[1] += 1;
                } else if depth.abs() < truncation - margin {
                    // Towards the outline, distances along the axis change quickly from pixel to pixel.
                    let steepness = 1.0 / (1.0 - miss * miss / BALL_RADIUS / BALL_RADIUS).sqrt();
                    let Space::Surface(distance) = space else { panic!("at the surface: {point}") };
                    assert!((distance - depth).abs() < 0.5 * VOXEL * steepness, "{point} {distance} {depth}");
                    counts[2] += 1;
                }
            }
        }
        assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
    });
}

#[test]
fn a_sparse_volume_knows_the_same_near_the_surface_and_takes_less_memory() {
    let view = before_wall([0.1, 0.35, 0.2]);
    with_volume(cropped(true), 2000, |dense| {
        with_volume(cropped(false), 2000, |sparse| {
            integrate(dense, &view);
            integrate(sparse, &view);
            assert!(2 * sparse.blocks() < dense.blocks());
            let mut random = Random::new(2);
            for _ in 0..20_000 {
                let point = Point::from([(); 3].map(|()| (random.next_f32() * 2.0 - 1.0) * HALF));
                let (a, b) = (sparse.space(&point), dense.space(&point));
                let is_near = matches!(b, Space::Surface(d) if d.abs() < 0.5 * VOXEL);
                assert!(a == b || (a == Space::Unknown && !is_near), "{point}: {a:?} {b:?}");
            }
        });
    });
}

#[test]
fn what_later_images_see_through_is_gone() {
    with_volume(cropped(false), 2000, |volume| {
        let pose = look_from(Point::new(0.4, 0.0, 0.0));
        integrate(volume, &View::new(camera(), pose, ball, 0.7));
        let front = Point::new(BALL_RADIUS, 0.0, 0.0);
        assert!(matches!(volume.space(&front), Space::Surface(d) if d.abs() < 0.5 * VOXEL));
        let empty = View::new(camera(), pose, |_| f32::INFINITY, 0.7);
        let used = volume.blocks();
        for _ in 0..40 {
            assert_eq!(integrate(volume, &empty).pixels, 0);
        }
        assert_eq!(volume.blocks(), used);
        for block in 0..used {
            assert!(volume.block(block).1.iter().all(|v| !v.is_seen() || v.distance > 0));
        }
    });
}

#[test]
fn the_order_of_images_hardly_matters() {
    let views = around(cuboid, 12);
    with_volume(cropped(true), 2000, |forwards| {
        with_volume(cropped(true), 2000, |backwards| {
            for view in &views {
                integrate(forwards, view);
            }
            for view in views.iter().rev() {
                integrate(backwards, view);
            }
            let mut largest = 0;
            for (a, b) in forwards.voxels.iter().zip(&*backwards.voxels) {
                assert_eq!(a.weight, b.weight);
                largest = largest.max((i32::from(a.distance) - i32::from(b.distance)).abs());
            }
            // One rounding an image.
            assert!(largest <= 12, "{largest}");
        });
    });
}

#[test]
fn a_mask_keeps_other_surfaces_out_but_they_still_show_what_is_free() {
    let view = View::new(camera(), look_from(Point::new(0.4, 0.0, 0.0)), ball, 0.43);
    let wall = (0.43 / 1e-4) as u16;
    let labels: Vec<u8> = view.depths.iter().map(|depth| if *depth == wall { 9 } else { 4 }).collect();
    let mask = Mask { labels: &labels, label: 4 };
    with_volume(cropped(true), 2000, |volume| {
        let all = integrate(volume, &view);
        let object = volume.integrate(&view.image(), Some(mask), &Monitor::new()).unwrap();
        assert!(object.pixels < all.pixels && object.pixels == labels.iter().filter(|l| **l == 4).count());
    });
    with_volume(cropped(true), 2000, |volume| {
        volume.integrate(&view.image(), Some(mask), &Monitor::new()).unwrap();
        let beside = |x: f32| volume.space(&Point::new(x, 0.0, 0.06));
        assert_eq!((beside(0.0), beside(-0.03)), (Space::Free, Space::Unknown));
        assert!(matches!(volume.space(&Point::new(BALL_RADIUS, 0.0, 0.0)), Space::Surface(_)));
    });
}

/// A ring before nothing, seen face on: its hole and its surroundings are free, and behind it is its shadow. Lost pixels on
/// it change nothing.
#[test]
fn pixels_without_a_depth_are_free_when_asked_except_for_gaps() {
    let mut view = View::new(camera(), look_from(Point::new(0.0, 0.0, 0.4)), torus, 0.0);
    let width = camera().size()[0] as usize;
    let on_ring = (TORUS[0] / (AWAY - TORUS[1]) * camera().focal()[0]) as usize;
    for column in 0..5 {
        view.depths[119 * width + 158 + on_ring + column] = 0;
    }
    let settings = VolumeSettings { missing_is_free: true, ..cropped(true) };
    with_volume(settings, 2000, |volume| {
        integrate(volume, &view);
        let space = |x: f32, z: f32| volume.space(&Point::new(x, 0.0, z));
        for z in [-0.06, 0.0, 0.06] {
            assert_eq!([space(0.0, z), space(0.02, z)], [Space::Free; 2], "{z}");
        }
        // The shadow is a tenth wider than the ring.
        assert_eq!([space(0.068, -0.02), space(0.068, 0.04)], [Space::Free; 2]);
        assert_eq!([space(TORUS[0], -0.04), space(-TORUS[0], -0.04)], [Space::Unknown; 2]);
        assert_eq!(space(0.054, -0.04), Space::Unknown);
        // The outline has no wall along its shadow.
        for block in 0..volume.blocks() {
            let first = volume.block(block).0.first_voxel()[2];
            for (place, voxel) in volume.block(block).1.iter().enumerate() {
                let z = (first + place as u32 / 64) as f32 - blocks::VOXEL_RANGE as f32;
                assert!(!(voxel.is_seen() && voxel.distance < 0) || z * VOXEL > -3.0 * VOXEL);
            }
        }
    });
    with_volume(cropped(true), 2000, |volume| {
        integrate(volume, &view);
        assert_eq!(volume.space(&Point::new(0.0, 0.0, 0.0)), Space::Unknown);
    });
}

#[test]
fn surfaces_beyond_the_greatest_depth_are_left_out() {
    let view = before_wall([0.4, 0.0, 0.0]);
    let near = VolumeSettings { max_depth: 0.5, ..VolumeSettings::new(VOXEL) };
    let far = VolumeSettings { max_depth: 1.0, ..near };
    let pixels = [near, far].map(|settings| {
        let mut pixels = 0;
        with_volume(settings, 20_000, |volume| pixels = integrate(volume, &view).pixels);
        pixels
    });
    assert_eq!(pixels[1], view.depths.len());
    let on_ball = view.depths.iter().filter(|depth| **depth < 5000).count();
    assert_eq!(pixels[0], on_ball);
}

#[test]
fn a_distorted_lens_sees_the_same_shape() {
    let lens = [-0.2, 0.05, 1e-3, -2e-3, 0.01];
    let camera = DepthCamera::new([320, 240], [400.0, 398.0], [160.3, 119.2], lens).unwrap();
    let view = View::new(camera, look_from(Point::new(0.2, 0.3, 0.1)), ball, 0.0);
    with_volume(cropped(false), 2000, |volume| {
        integrate(volume, &view);
        let ray = Point::new(0.2, 0.3, 0.1).coords.normalize();
        let space = volume.space(&Point::from(ray * BALL_RADIUS));
        assert!(matches!(space, Space::Surface(d) if d.abs() < 0.2 * VOXEL), "{space:?}");
    });
}

#[test]
fn a_full_volume_says_so_and_stays_as_it_was() {
    let views = around(ball, 3);
    with_volume(VolumeSettings::new(VOXEL), 800, |volume| {
        let first = integrate(volume, &views[0]);
        assert!(first.blocks > 100 && first.blocks == volume.blocks());
        let limit = volume.blocks();
        with_volume(VolumeSettings::new(VOXEL), limit, |tight| {
            integrate(tight, &views[0]);
            let before = bytes(tight);
            let error = tight.integrate(&views[2].image(), None, &Monitor::new()).unwrap_err();
            let VolumeError::Full { limit: named, used, pixels, of } = error else { panic!("{error}") };
            assert_eq!((named, used, of), (limit, limit, first_pixels(&views[2])));
            assert!(0 < pixels && pixels <= of);
            assert!(before == bytes(tight));
            integrate(tight, &views[0]);
        });
    });
}

fn first_pixels(view: &View) -> usize {
    view.depths.iter().filter(|depth| **depth > 0).count()
}

#[test]
fn a_cancelled_call_and_one_over_its_work_limit_change_nothing() {
    let views = around(ball, 2);
    with_volume(VolumeSettings::new(VOXEL), 2000, |volume| {
        integrate(volume, &views[0]);
        let before = bytes(volume);
        let cancelled = Monitor::new();
        cancelled.cancel();
        for (monitor, stop) in
            [(cancelled, Stop::Cancelled), (Monitor::with_work_limit(2000), Stop::WorkLimit)]
        {
            let error = volume.integrate(&views[1].image(), None, &monitor).unwrap_err();
            assert_eq!(error, VolumeError::Stopped(stop));
            assert!(before == bytes(volume));
        }
    });
}

#[test]
fn names_what_is_broken() {
    let limits = VolumeLimits { blocks: 10 };
    let needed = Volume::bytes(&limits);
    let new = |settings: VolumeSettings, bytes: usize| {
        Volume::new(&settings, &limits, &mut vec![0; bytes]).err().unwrap()
    };
    let error = new(VolumeSettings::new(VOXEL), needed - 1);
    assert!(matches!(error, VolumeError::OutOfMemory(e) if e.needed == needed));
    let boxed = cropped(true).dense_blocks().unwrap();
    assert_eq!(new(cropped(true), needed), VolumeError::DenseLimit { needed: boxed, limit: 10 });
    assert!(matches!(new(VolumeSettings::new(0.0), needed), VolumeError::Settings(_)));
    let huge = VolumeLimits { blocks: usize::MAX };
    assert!(Volume::bytes(&huge) > usize::MAX / 2);
    with_volume(cropped(false), 10, |volume| {
        let view = before_wall([0.4, 0.0, 0.0]);
        let mask = Mask { labels: &[1; 7], label: 1 };
        let error = volume.integrate(&view.image(), Some(mask), &Monitor::new()).unwrap_err();
        assert_eq!(error, VolumeError::Mask { labels: 7, pixels: 320 * 240 });
        // A camera that looks elsewhere sees nothing of the volume.
        let away = View { pose: Pose::translation(50.0, 0.0, 0.0), ..view };
        assert_eq!(integrate(volume, &away), Integrated::default());
        assert_eq!(volume.space(&Point::new(f32::NAN, 0.0, 0.0)), Space::Unknown);
        assert_eq!(volume.space(&Point::new(1e9, 0.0, 0.0)), Space::Unknown);
    });
}

#[test]
fn an_object_and_its_surroundings_fit_into_little_memory() {
    // 1500 blocks hold what one image of 640 x 480 shows of an object of 20 cm at 0.6 m in voxels of 2 mm.
    assert!(Volume::bytes(&VolumeLimits { blocks: 1500 }) < 3_300_000);
}
