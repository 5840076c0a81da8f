//! What the Rust interface makes of a pair, as hashes: those that embedded/pairs.c must find in C.

use crate::given::{CENTRE, DISTORTION, FOCAL, Given, Image, SIZE, Shape, UNIT, VOXEL};
use crate::hash::Hash;
use hangpose::geometry::{Cloud, Mesh, Pose};
use hangpose::hanging::{HangingPose, Object, Prediction, Request, Supporter};
use hangpose::motion::{Motion, Task, Waypoint, plan, plan_bytes};
use hangpose::perception::completion::{Completion, CompletionSettings, room};
use hangpose::perception::depth::{DepthCamera, DepthImage};
use hangpose::perception::depth_points::{DepthPointsSettings, depth_points};
use hangpose::perception::isosurface::Isosurface;
use hangpose::perception::volume::{Volume, VolumeLimits, VolumeSettings};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, predict_poses};
use hangpose_ffi::{
    HANGPOSE_NO_PATH, HANGPOSE_OK, HANGPOSE_PROFILE_PAPER, HANGPOSE_REJECTED, hangpose_plan, hangpose_pose,
    hangpose_prediction, hangpose_waypoint,
};
use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use std::error::Error;
use std::mem::offset_of;

/// Poses and waypoints for which there is room, as in embedded/pairs.c.
const POSES: usize = 10;
const WAYPOINTS: usize = 1000;

/// A stage that the pair does not have.
const NONE: &str = "-";

/// Hashes of the scan, the object, the supporter, the poses and the path, in this order, and the number of poses.
pub(crate) fn predicted(given: &Given) -> Result<([String; 5], usize), Box<dyn Error>> {
    let monitor = Monitor::new();
    let profile = if given.profile == HANGPOSE_PROFILE_PAPER { Params::paper() } else { Params::default() };
    let params = Params {
        seed: given.seed.into(),
        samples: given.samples as usize,
        voxels: given.voxels as usize,
        ..profile
    };
    let mut scan = Hash::new();
    let scanned_mesh = scanned_mesh(&given.object, &mut scan, &monitor)?;
    let scanned_cloud = scanned_cloud(&given.supporter, &mut scan)?;
    let has_scan = scanned_mesh.is_some() || scanned_cloud.is_some();
    let (mesh, cloud) =
        (scanned_mesh.as_ref().unwrap_or(&given.object), scanned_cloud.as_ref().unwrap_or(&given.supporter));
    let (mut memory, mut more_memory) = (Vec::new(), Vec::new());
    let mesh = Mesh::new(&mesh.points, &mesh.triangles)?.seen_from(&mesh.viewpoints)?;
    let object = analyze_object(&mesh, &params, &mut memory, &monitor)?;
    let normals = (!cloud.normals.is_empty()).then_some(&cloud.normals[..]);
    let cloud = Cloud::new(&cloud.points, normals)?.seen_from(&cloud.viewpoints)?;
    let supporter = analyze_supporter(&cloud, &params, &mut more_memory, &monitor)?;
    let mut poses = [HangingPose::default(); POSES];
    let found = predict_poses(&object, &supporter, &Request::ANY, &params, &mut poses, &monitor)?;
    let path = match found.poses.first() {
        Some(best) if given.plan == 1 => path(&object, &supporter, &params, best, &monitor)?,
        _ => NONE.into(),
    };
    let hashes = [
        if has_scan { scan.text() } else { NONE.into() },
        of_object(&object),
        of_supporter(&supporter),
        of_poses(&found),
        path,
    ];
    Ok((hashes, found.poses.len()))
}

/// The mesh that the images of an object show; `None` without images.
fn scanned_mesh(shape: &Shape, hash: &mut Hash, monitor: &Monitor) -> Result<Option<Shape>, Box<dyn Error>> {
    if shape.images.is_empty() {
        return Ok(None);
    }
    let images = shape.images.iter().map(core_image).collect::<Result<Vec<_>, _>>()?;
    let (guess, settings) = (CompletionSettings::default(), VolumeSettings::new(VOXEL));
    let margin = settings.truncation + 2.0 * settings.voxel;
    let crop = room(images.iter().map(|image| (*image, None)), &guess, settings.max_depth, margin);
    let settings = VolumeSettings { missing_is_free: true, crop, dense: true, ..settings };
    let limits = VolumeLimits { blocks: settings.dense_blocks().ok_or("the images show nothing")? };
    let mut memory = vec![0; Volume::bytes(&limits)];
    let mut volume = Volume::new(&settings, &limits, &mut memory)?;
    for image in &images {
        hash.words([volume.integrate(image, None, monitor)?.pixels as u32]);
    }
    volume.complete(&guess, &mut vec![0; Completion::bytes(limits.blocks)], monitor)?;
    let mut memory = vec![0; Isosurface::bytes(limits.blocks)];
    let surface = Isosurface::find(&volume, &mut memory, monitor)?;
    let mut points = vec![[0.0; 3]; surface.vertices()];
    let mut triangles = vec![[0; 3]; surface.triangles()];
    surface.write(&mut points, &mut triangles)?;
    hash.rows(&points);
    hash.words(triangles.as_flattened().iter().copied());
    let viewpoints = shape.images.iter().map(|image| image.position).collect();
    Ok(Some(Shape { points, triangles, viewpoints, ..Shape::default() }))
}

/// The cloud that the images of a supporter show; `None` without images.
fn scanned_cloud(shape: &Shape, hash: &mut Hash) -> Result<Option<Shape>, Box<dyn Error>> {
    if shape.images.is_empty() {
        return Ok(None);
    }
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    for image in &shape.images {
        let (mut p, mut n) = (vec![[0.0; 3]; image.depths.len()], vec![[0.0; 3]; image.depths.len()]);
        let settings = DepthPointsSettings::default();
        let count = depth_points(&core_image(image)?, None, &settings, &mut p, &mut n)?.points;
        points.extend_from_slice(&p[..count]);
        normals.extend_from_slice(&n[..count]);
    }
    hash.rows(&points);
    hash.rows(&normals);
    let viewpoints = shape.images.iter().map(|image| image.position).collect();
    Ok(Some(Shape { points, normals, viewpoints, ..Shape::default() }))
}

fn core_image(image: &Image) -> Result<DepthImage<'_>, Box<dyn Error>> {
    let [x, y, z, w] = image.quaternion;
    let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
    let pose = Pose::from_parts(Translation3::from(image.position), rotation);
    let camera = DepthCamera::new(SIZE, FOCAL, CENTRE, DISTORTION)?;
    Ok(DepthImage::new(camera, &image.depths, UNIT, pose)?)
}

/// Mass, candidates or sites, symmetries, and what they took.
fn of_object(object: &Object) -> String {
    let mut hash = Hash::new();
    let mass = object.mass();
    hash.floats([&mass.area]);
    hash.floats(object.centre_of_mass().coords.as_slice());
    for contact in object.contacts() {
        for vector in [contact.position.coords, contact.normal, contact.bar_direction] {
            hash.floats(vector.as_slice());
        }
        hash.floats([&contact.capture, &contact.room, &contact.passage]);
    }
    for site in object.sites() {
        hash.words([site.contact_points]);
        for vector in [site.position.coords, site.hanging_direction, site.contact_point.coords] {
            hash.floats(vector.as_slice());
        }
        let encircled = [&site.encircled, &site.encircled_above, &site.encircled_below];
        hash.floats([&site.free_space_radius].into_iter().chain(encircled));
    }
    for symmetry in object.symmetries() {
        hash.words([symmetry.fold]);
        hash.floats(symmetry.axis.as_slice());
    }
    let work = object.work();
    hash.words([work.rays as u32, work.distance_queries as u32]);
    hash.text()
}

/// Counts, candidates or sites, and what they took.
fn of_supporter(supporter: &Supporter) -> String {
    let mut hash = Hash::new();
    let (cleaning, normals) = (supporter.cleaning(), supporter.normals());
    let counts = [
        supporter.points().points().len(),
        cleaning.merged,
        cleaning.strays,
        cleaning.on_planes,
        supporter.guessed(),
        normals.estimated,
        normals.renormalised,
        normals.reversed,
    ];
    hash.words(counts.map(|count| count as u32));
    for contact in supporter.contacts() {
        for vector in [contact.position.coords, contact.normal, contact.bar_direction] {
            hash.floats(vector.as_slice());
        }
    }
    for site in supporter.sites() {
        for vector in [site.position.coords, site.hanging_direction, site.contact_point.coords] {
            hash.floats(vector.as_slice());
        }
        hash.floats([site.support_radius].iter().chain(&site.boundary_distances));
    }
    let work = supporter.work();
    hash.words([work.rays as u32, work.distance_queries as u32]);
    hash.text()
}

/// The counts of a prediction, what it took, and every field of its poses.
fn of_poses(found: &Prediction) -> String {
    let mut hash = Hash::new();
    hash.words([if found.poses.is_empty() { HANGPOSE_REJECTED } else { HANGPOSE_OK } as u32]);
    let prediction = hangpose_prediction::from(found);
    let end = offset_of!(hangpose_prediction, settling_sparse) + size_of::<u32>();
    hash.words(words_between(&prediction, offset_of!(hangpose_prediction, pose_count), end));
    hash.words([prediction.rays as u32, prediction.distance_queries as u32]);
    for pose in found.poses {
        let start = offset_of!(hangpose_pose, has_pose);
        hash.words(words_between(&hangpose_pose::from(pose), start, size_of::<hangpose_pose>()));
    }
    hash.text()
}

/// The plan of a path to a pose, what it took, and its waypoints.
fn path(
    object: &Object,
    supporter: &Supporter,
    params: &Params,
    goal: &HangingPose,
    monitor: &Monitor,
) -> Result<String, Box<dyn Error>> {
    let motion = Motion::default();
    let mut waypoints = vec![Waypoint::default(); WAYPOINTS];
    let mut memory = vec![0; plan_bytes(&supporter.limits(), 0, motion.nodes)];
    let task = Task { object, supporter, request: &Request::ANY, params, motion };
    let found = plan(&task, goal, &mut waypoints, &mut |_| true, &mut memory, monitor)?;
    let mut hash = Hash::new();
    hash.words([if found.path.is_ok() { HANGPOSE_OK } else { HANGPOSE_NO_PATH } as u32]);
    let plan = hangpose_plan::from(&found);
    let end = offset_of!(hangpose_plan, asked) + size_of::<u32>();
    hash.words(words_between(&plan, offset_of!(hangpose_plan, has_path), end));
    hash.words([plan.rays as u32, plan.distance_queries as u32]);
    for waypoint in found.path.iter().flat_map(|path| path.object) {
        let start = offset_of!(hangpose_waypoint, seconds);
        hash.words(words_between(&hangpose_waypoint::from(waypoint), start, size_of::<hangpose_waypoint>()));
    }
    Ok(hash.text())
}

/// The words of a C struct between two offsets in bytes, where there is no padding.
fn words_between<T>(of: &T, start: usize, end: usize) -> Vec<u32> {
    assert!(end <= size_of::<T>() && align_of::<T>() >= 4);
    let first = std::ptr::from_ref(of).cast::<u32>();
    // SAFETY: within the struct and aligned; every field in between is a number or an array of numbers of 32 bits.
    (start / 4..end / 4).map(|word| unsafe { first.add(word).read() }).collect()
}
