//! Structs of the C interface that are made, spoiled and checked.

use crate::draw::Draw;
use crate::oracle::{UNIT, within};
use crate::shapes::{DrawnCloud, DrawnMesh};
use hangpose_ffi::*;
use std::ptr::null;

/// A struct of the interface: numbers and pointers, of which every bit pattern is a value, and its size first.
///
/// # Safety
///
/// As it says.
pub(super) unsafe trait Sized: Copy {
    /// The struct with its size, and zeros.
    fn sized() -> Self {
        // SAFETY: every bit pattern is a value, and the size is the first field.
        unsafe {
            let mut made: Self = std::mem::zeroed();
            (&raw mut made).cast::<u32>().write(size_of::<Self>() as u32);
            made
        }
    }
}

macro_rules! sized {
    ($($name:ty),* $(,)?) => {
        // SAFETY: they are `repr(C)` over numbers and pointers, with the size first.
        $(unsafe impl Sized for $name {})*
    };
}

sized!(
    hangpose_params,
    hangpose_monitor,
    hangpose_threads,
    hangpose_detail,
    hangpose_limits,
    hangpose_mesh,
    hangpose_cloud,
    hangpose_object_info,
    hangpose_object_site,
    hangpose_object_contact,
    hangpose_symmetry,
    hangpose_supporter_info,
    hangpose_supporter_site,
    hangpose_supporter_contact,
    hangpose_request,
    hangpose_pose,
    hangpose_prediction,
    hangpose_many,
    hangpose_motion,
    hangpose_plan,
    hangpose_plan_failure,
    hangpose_waypoint,
    hangpose_volume_settings,
    hangpose_points_settings,
    hangpose_depth_image,
);

/// The bytes of structs.
pub(super) fn bytes<T: Sized>(structs: &[T]) -> &[u8] {
    // SAFETY: those that are looked at were zeroed before the library wrote fields, so that padding has a value, too.
    unsafe { std::slice::from_raw_parts(structs.as_ptr().cast(), size_of_val(structs)) }
}

/// Replaces up to three of the first `bytes` bytes of a struct, four at a time, which hold no pointers.
pub(super) fn spoil<T: Sized>(given: &mut T, bytes: usize, draw: &mut Draw) {
    let words = bytes.min(size_of::<T>()) / 4;
    for _ in 0..draw.below(12).saturating_sub(8) {
        // At times the size itself.
        let word = if draw.one_in(16) { 0 } else { 1 + draw.below(words - 1) };
        let value = match draw.below(3) {
            0 => draw.number().to_bits(),
            1 => draw.below(300) as u32,
            _ => draw.word(),
        };
        // SAFETY: the word is in the struct, and every bit pattern is a value.
        unsafe { (given as *mut T).cast::<u32>().add(word).write_unaligned(value) };
    }
}

/// The pointer, or null at times.
pub(super) fn or_null<T>(pointer: *const T, draw: &mut Draw) -> *const T {
    if draw.one_in(48) { null() } else { pointer }
}

pub(super) fn mesh(drawn: &DrawnMesh, draw: &mut Draw) -> hangpose_mesh {
    let mut mesh = hangpose_mesh {
        vertex_count: drawn.vertices.len() as u32,
        triangle_count: drawn.triangles.len() as u32,
        viewpoint_count: drawn.viewpoints.len() as u32,
        vertices: or_null(drawn.vertices.as_ptr().cast(), draw),
        triangles: or_null(drawn.triangles.as_ptr().cast(), draw),
        viewpoints: or_null(drawn.viewpoints.as_ptr().cast(), draw),
        ..hangpose_mesh::sized()
    };
    match draw.below(32) {
        31 => mesh.struct_size = draw.word(),
        30 => mesh.vertex_count = 0,
        29 => mesh.triangle_count /= 2,
        _ => {}
    }
    mesh
}

pub(super) fn cloud(drawn: &DrawnCloud, draw: &mut Draw) -> hangpose_cloud {
    let mut cloud = hangpose_cloud {
        point_count: drawn.points.len() as u32,
        viewpoint_count: drawn.viewpoints.len() as u32,
        points: or_null(drawn.points.as_ptr().cast(), draw),
        normals: drawn.normals.as_ref().map_or(null(), |normals| normals.as_ptr().cast()),
        viewpoints: or_null(drawn.viewpoints.as_ptr().cast(), draw),
        marks: drawn.marks.as_ref().map_or(null(), |marks| marks.as_ptr()),
        region: drawn.region.as_ref().map_or(null(), |region| region.as_ptr().cast()),
        ..hangpose_cloud::sized()
    };
    match draw.below(32) {
        31 => cloud.struct_size = draw.word(),
        30 => cloud.point_count = 0,
        29 => cloud.point_count /= 2,
        _ => {}
    }
    cloud
}

/// A pose that the library wrote: numbers in their ranges.
pub(super) fn check_pose(pose: &hangpose_pose) {
    assert_eq!(pose.struct_size as usize, size_of::<hangpose_pose>());
    if pose.has_pose == 0 {
        return;
    }
    reached(&pose.position, &pose.quaternion);
    if pose.has_rest == 1 {
        reached(&pose.rest_position, &pose.rest_quaternion);
        within("the probability", pose.probability, 0.0, 1.0);
        within("the robustness", pose.robustness, 0.0, 1.0);
        within("the unseen part", pose.unseen_object, 0.0, 1.0);
        within("the least tilt", pose.margin.least_tilt, 0.0, 1.2);
        within("the jolt time", pose.margin.jolt_time, 0.0, 1.0);
        within("the rise of an escape", pose.margin.escape_rise, 0.0, f32::MAX);
        assert!(pose.contact_count as usize <= pose.contacts.len());
        assert!(
            [HANGPOSE_KIND_THREADED, HANGPOSE_KIND_HOOKED, HANGPOSE_KIND_CAPPED, HANGPOSE_KIND_BALANCED]
                .contains(&pose.kind)
        );
        for contact in &pose.contacts[..pose.contact_count as usize] {
            within("a contact force", contact.force, 0.0, f32::MAX);
        }
    }
}

/// A place and a unit quaternion.
pub(super) fn reached(position: &[f32; 3], quaternion: &[f32; 4]) {
    assert!(position.iter().all(|x| x.is_finite()), "a pose is at {position:?}");
    let length = quaternion.iter().map(|x| x * x).sum::<f32>().sqrt();
    assert!((length - 1.0).abs() < UNIT, "{quaternion:?} is no rotation");
}
