use super::*;
use crate::Stop;
use crate::geometry::{Aabb, Point, Pose};
use crate::perception::depth::{DepthCamera, DepthImage, Mask};
use crate::perception::isosurface::Isosurface;
use crate::perception::test_views::{
    BALL_RADIUS, Distance, TORUS, View, around, ball, camera, look_from, torus,
};
use crate::perception::volume::{Space, VolumeLimits, VolumeSettings};
use std::collections::HashMap;

const VOXEL: f32 = 0.002;
const HALF: f32 = 0.07;
/// Radius and half the length.
const BAR: [f32; 2] = [0.012, 0.05];

/// A bar along z with flat ends.
fn bar(p: Point) -> f32 {
    let (side, end) = (p.x.hypot(p.y) - BAR[0], p.z.abs() - BAR[1]);
    side.max(0.0).hypot(end.max(0.0)) + side.max(end).min(0.0)
}

/// A wire of 4 mm, half as thick as the truncation.
fn wire(p: Point) -> f32 {
    let (side, end) = (p.x.hypot(p.y) - 0.002, p.z.abs() - 0.05);
    side.max(0.0).hypot(end.max(0.0)) + side.max(end).min(0.0)
}

/// A square plate of 6 cm across the x axis, its front at x = 0.
fn plate(p: Point) -> f32 {
    let outside = [(p.x + 0.002).abs() - 0.002, p.y.abs() - 0.03, p.z.abs() - 0.03];
    let most = outside[0].max(outside[1]).max(outside[2]);
    Point::from(outside.map(|x| x.max(0.0))).coords.norm() + most.min(0.0)
}

fn settings() -> VolumeSettings {
    let crop = Some(Aabb { min: [-HALF; 3].into(), max: [HALF; 3].into() });
    VolumeSettings { crop, dense: true, missing_is_free: true, ..VolumeSettings::new(VOXEL) }
}

/// Calls `check` with a volume of these views.
fn with_views<T>(settings: VolumeSettings, views: &[View], check: impl FnOnce(&mut Volume) -> T) -> T {
    let limits = VolumeLimits { blocks: settings.dense_blocks().unwrap() };
    let mut memory = vec![0; Volume::bytes(&limits)];
    let mut volume = Volume::new(&settings, &limits, &mut memory).unwrap();
    for view in views {
        volume.integrate(&view.image(), None, &Monitor::new()).unwrap();
    }
    check(&mut volume)
}

fn complete_with(volume: &mut Volume, settings: &CompletionSettings) -> Completion {
    let mut memory = vec![0xAA; Completion::bytes(volume.blocks())];
    volume.complete(settings, &mut memory, &Monitor::new()).unwrap()
}

fn complete(volume: &mut Volume) -> Completion {
    complete_with(volume, &CompletionSettings::default())
}

struct Found {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    seen: Vec<u8>,
}

fn surface(volume: &Volume) -> Found {
    let mut memory = vec![0; Isosurface::bytes(volume.blocks())];
    let found = Isosurface::find(volume, &mut memory, &Monitor::new()).unwrap();
    let (mut vertices, mut triangles) = (vec![[0.0; 3]; found.vertices()], vec![[0; 3]; found.triangles()]);
    let mut seen = vec![9; found.vertices()];
    found.write(&mut vertices, &mut triangles).unwrap();
    found.write_seen(&mut seen).unwrap();
    Found { vertices, triangles, seen }
}

impl Found {
    fn assert_closed(&self) {
        let mut edges = HashMap::new();
        for t in &self.triangles {
            (0..3).for_each(|i| *edges.entry((t[i], t[(i + 1) % 3])).or_insert(0) += 1);
        }
        assert!(!edges.is_empty());
        assert!(edges.iter().all(|((a, b), count)| *count == 1 && edges.get(&(*b, *a)) == Some(&1)));
    }

    /// Greatest distance of seen and of guessed vertices from a shape, voxels.
    fn worst(&self, shape: impl Fn(Point) -> f32) -> [f32; 2] {
        let mut worst = [0.0_f32; 2];
        for (vertex, seen) in self.vertices.iter().zip(&self.seen) {
            let worst = &mut worst[1 - usize::from(*seen)];
            *worst = worst.max(shape((*vertex).into()).abs() / VOXEL);
        }
        worst
    }
}

/// One view of a shape from a point.
fn seen_from(eye: [f32; 3], shape: Distance) -> Vec<View> {
    vec![View::new(camera(), look_from(eye.into()), shape, 0.0)]
}

/// The back is as far from the true one as the spacing of the centres of the balls allows; above the thickness, also as the
/// angle from which on they are held.
#[test]
fn a_bar_a_wire_and_a_ball_seen_once_become_whole() {
    for shape in [bar as Distance, wire, ball] {
        for eye in [[0.4, 0.0, 0.0], [0.3, 0.27, 0.0], [0.0, -0.4, 0.0]] {
            for (thickness, bound) in [(2.0 * BALL_RADIUS, 1.5), (0.01, 3.0)] {
                with_views(settings(), &seen_from(eye, shape), |volume| {
                    let guess = CompletionSettings { thickness, ..CompletionSettings::default() };
                    let completion = complete_with(volume, &guess);
                    let mesh = surface(volume);
                    let [seen, guessed] = mesh.worst(shape);
                    mesh.assert_closed();
                    assert!(seen < 0.75 && guessed < bound, "{eye:?}: {seen} {guessed}");
                    assert!(completion.filled > 0 && mesh.seen.contains(&0) && mesh.seen.contains(&1));
                });
            }
        }
    }
}

#[test]
fn what_was_seen_all_around_stays() {
    for shape in [torus as Distance, ball, bar] {
        with_views(settings(), &around(shape, 24), |volume| {
            let before = surface(volume);
            let completion = complete(volume);
            let after = surface(volume);
            assert!(before.vertices == after.vertices && before.triangles == after.triangles);
            assert!(after.seen.iter().all(|seen| *seen == 1) && completion.empty == 0);
        });
    }
}

#[test]
fn a_ring_seen_face_on_gets_a_back_and_keeps_its_hole() {
    with_views(settings(), &seen_from([0.0, 0.0, 0.4], torus), |volume| {
        let thickness = 2.0 * TORUS[1];
        complete_with(volume, &CompletionSettings { thickness, ..CompletionSettings::default() });
        let mesh = surface(volume);
        mesh.assert_closed();
        let guessed = mesh.worst(torus)[1];
        assert!(guessed < 2.5, "{guessed}");
        let back = mesh.vertices.iter().map(|v| v[2]).fold(0.0, f32::min);
        assert!((back + TORUS[1]).abs() < 2.5 * VOXEL, "{back}");
        // A closed surface with a hole has as many edges as vertices and triangles.
        assert_eq!(mesh.vertices.len() + mesh.triangles.len(), mesh.triangles.len() / 2 * 3);
    });
}

/// Nothing tells how thick a plate is that is seen face on.
#[test]
fn a_plate_seen_face_on_is_as_thick_as_the_settings_allow() {
    let views = seen_from([0.4, 0.0, 0.0], plate);
    for thickness in [0.006, 0.02, 0.03] {
        with_views(settings(), &views, |volume| {
            complete_with(volume, &CompletionSettings { thickness, ..CompletionSettings::default() });
            let mesh = surface(volume);
            mesh.assert_closed();
            let back = mesh.vertices.iter().map(|v| v[0]).fold(0.0, f32::min);
            // The centres of the balls are a voxel apart, so thicknesses are two apart.
            assert!((back + thickness).abs() < 2.0 * VOXEL, "{thickness}: {back}");
        });
    }
}

/// A shape that the crop box cuts is closed there.
#[test]
fn the_border_of_the_crop_box_closes_the_surface() {
    let crop = Some(Aabb { min: [-HALF, -HALF, -0.02].into(), max: [HALF, HALF, 0.02].into() });
    with_views(VolumeSettings { crop, ..settings() }, &seen_from([0.4, 0.0, 0.0], bar), |volume| {
        complete(volume);
        surface(volume).assert_closed();
    });
}

#[test]
fn a_guess_stays_unknown_and_later_images_replace_it() {
    with_views(settings(), &seen_from([0.4, 0.0, 0.0], ball), |volume| {
        let back = Point::new(-BALL_RADIUS, 0.0, 0.0);
        complete(volume);
        assert_eq!(volume.space(&back), Space::Unknown);
        let once = surface(volume);
        complete(volume);
        let twice = surface(volume);
        assert!(once.vertices == twice.vertices && once.seen == twice.seen);
        let other = View::new(camera(), look_from(Point::new(-0.4, 0.0, 0.0)), ball, 0.0);
        volume.integrate(&other.image(), None, &Monitor::new()).unwrap();
        assert!(matches!(volume.space(&back), Space::Surface(d) if d.abs() < 0.5 * VOXEL));
    });
}

/// A call that was cancelled while it wrote left the guesses of the first voxels.
#[test]
fn another_call_completes_a_part_of_the_guesses() {
    for (shape, eye) in [(ball as Distance, [0.4, 0.0, 0.0]), (bar, [0.3, 0.27, 0.0])] {
        let views = seen_from(eye, shape);
        let at_once = with_views(settings(), &views, |volume| {
            complete(volume);
            volume.voxels().to_vec()
        });
        with_views(settings(), &views, |volume| {
            let grid = grid::Grid::of(volume);
            for index in 0..grid.count() / 2 {
                let place = grid.place(volume, index);
                volume.voxels_mut()[place] = at_once[place];
            }
            complete(volume);
            surface(volume).assert_closed();
            let differs = |(a, b): (&Voxel, &Voxel)| (a.distance < 0) != (b.distance < 0);
            assert!(!volume.voxels().iter().zip(&at_once).any(differs));
        });
    }
}

#[test]
fn names_what_is_broken_and_leaves_the_volume_alone() {
    let views = seen_from([0.4, 0.0, 0.0], ball);
    let fine = CompletionSettings::default();
    with_views(settings(), &views, |volume| {
        let before = bytemuck::cast_slice::<_, u8>(volume.voxels()).to_vec();
        let needed = Completion::bytes(volume.blocks());
        let mut fail = |settings: &CompletionSettings, bytes: usize, monitor: &Monitor| {
            let error = volume.complete(settings, &mut vec![0; bytes], monitor).unwrap_err();
            assert!(before == bytemuck::cast_slice::<_, u8>(volume.voxels()));
            error
        };
        let error = fail(&fine, needed - 1, &Monitor::new());
        assert!(matches!(error, CompletionError::OutOfMemory(e) if e.needed == needed));
        let cancelled = Monitor::new();
        cancelled.cancel();
        assert_eq!(fail(&fine, needed, &cancelled), CompletionError::Stopped(Stop::Cancelled));
        for broken in [f32::NAN, -1.0] {
            let error = fail(&CompletionSettings { radius: broken, ..fine }, needed, &Monitor::new());
            assert!(matches!(error, CompletionError::Settings { .. }));
        }
    });
    let limits = VolumeLimits { blocks: 10 };
    let mut memory = vec![0; Volume::bytes(&limits)];
    let mut sparse = Volume::new(&VolumeSettings::new(VOXEL), &limits, &mut memory).unwrap();
    assert_eq!(sparse.complete(&fine, &mut [], &Monitor::new()), Err(CompletionError::Sparse));
    assert!(Completion::bytes(usize::MAX) > usize::MAX / 2);
}

/// The room is that of a volume into which the whole shape fits, and not much larger.
#[test]
fn the_room_holds_what_is_behind() {
    let settings = CompletionSettings::default();
    let of = |views: &[View]| {
        room(views.iter().map(|view| (view.image(), None)), &settings, 1.0, 4.0 * VOXEL).unwrap()
    };
    for eye in [[0.4, 0.0, 0.0], [0.2, -0.3, 0.2]] {
        let once = of(&seen_from(eye, ball));
        assert!((0..3).all(|i| once.min[i] < -BALL_RADIUS && once.max[i] > BALL_RADIUS), "{once:?}");
        assert!(once.extents().max() < 4.0 * BALL_RADIUS);
    }
    let all = of(&around(ball, 24));
    assert!((0..3).all(|i| (all.min[i] + BALL_RADIUS + 4.0 * VOXEL).abs() < VOXEL), "{all:?}");
    let views = seen_from([0.4, 0.0, 0.0], ball);
    let images = views.iter().map(|view| (view.image(), None));
    assert!(room(images.clone(), &settings, 0.1, 0.0).is_none());
    // Nowhere, and larger than any number.
    assert!(room(images.clone(), &settings, 1.0, f32::INFINITY).is_none());
    // A mask without labels shows nothing, and one with some of them some.
    let mask = Mask { labels: &[], label: 1 };
    let masked = views.iter().map(|view| (view.image(), Some(mask)));
    assert_eq!(room(masked, &settings, 1.0, 0.0), None);
    let lens = DepthCamera::new([2, 2], [1e-30; 2], [0.5; 2], [1e30, 0.0, 0.0, 0.0, 0.0]).unwrap();
    let image = DepthImage::new(lens, &[500; 4], 0.001, Pose::identity()).unwrap();
    assert_eq!(room([(image, None)].into_iter(), &settings, 1.0, 0.0), None);
}
