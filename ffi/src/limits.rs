use crate::border::{DETAIL, Public, Region, input, keep_apart, optional_input, output, report};
use crate::cloud::hangpose_cloud;
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::mesh::hangpose_mesh;
use crate::object::ObjectHandle;
use crate::params::hangpose_params;
use crate::plan::plan_needs;
use crate::reachable::reachable_needs;
use crate::slots::slot_bytes;
use crate::status::*;
use crate::supporter::SupporterHandle;
use hangpose_core::hanging::{HangingPose, Object, Supporter, predict_bytes};
use hangpose_core::memory::Limits;
use hangpose_core::motion::Motion;

/// The largest inputs for which memory is reserved. Smaller inputs need no more memory.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_limits {
    /// sizeof(hangpose_limits), set by the caller.
    pub struct_size: u32,
    /// Number of vertices of the object's mesh.
    pub vertices: u32,
    /// Number of triangles of the object's mesh.
    pub triangles: u32,
    /// Value of hangpose_params.samples.
    pub samples: u32,
    /// Value of hangpose_params.voxels.
    pub voxels: u32,
    /// Number of points of the supporter's cloud.
    pub points: u32,
    /// Value of `pose_capacity` for hangpose_predict or hangpose_predict_reachable, or of `object_count` for
    /// hangpose_predict_many.
    pub poses: u32,
    /// Value of hangpose_request.scene_point_count, for planning.
    pub scene_points: u32,
    /// Value of hangpose_motion.nodes.
    pub nodes: u32,
    /// Value of `waypoint_capacity` for hangpose_plan_path or hangpose_predict_reachable.
    pub waypoints: u32,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_limits {
    const NAME: &'static str = "limits";
}

impl hangpose_limits {
    pub(crate) fn to_core(self) -> Limits {
        Limits {
            vertices: self.vertices as usize,
            triangles: self.triangles as usize,
            samples: self.samples as usize,
            voxels: self.voxels as usize,
            points: self.points as usize,
        }
    }
}

/// Sets `limits` to what `params`, `mesh` and `cloud` need, with `poses` 1, `nodes` that of hangpose_motion_init, and no
/// scene points and waypoints. `mesh` or `cloud` may be null and then counts as empty. Only the counts are read, not the
/// arrays. Set limits->struct_size before the call. Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_limits_of(
    params: *const hangpose_params,
    mesh: *const hangpose_mesh,
    cloud: *const hangpose_cloud,
    limits: *mut hangpose_limits,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let set = || {
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            Region::written("limits", limits, 1),
            Region::read("params", params, 1),
            Region::read("mesh", mesh, 1),
            Region::read("cloud", cloud, 1),
        ])?;
        // SAFETY: the caller vouches for the pointers; the limits are apart from the rest.
        let (params, mesh, cloud, limits) =
            unsafe { (input(params)?, optional_input(mesh)?, optional_input(cloud)?, output(limits)?) };
        mesh.map_or(Ok(()), hangpose_mesh::check_counts)?;
        cloud.map_or(Ok(()), hangpose_cloud::check_count)?;
        *limits = hangpose_limits {
            struct_size: size_of::<hangpose_limits>() as u32,
            vertices: mesh.map_or(0, |mesh| mesh.vertex_count),
            triangles: mesh.map_or(0, |mesh| mesh.triangle_count),
            samples: params.samples,
            voxels: params.voxels,
            points: cloud.map_or(0, |cloud| cloud.point_count),
            poses: 1,
            scene_points: 0,
            nodes: Motion::DEFAULT.nodes as u32,
            waypoints: 0,
        };
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, set) }
}

/// Returns the bytes of memory for any object within `limits`; depends on vertices, triangles, samples and voxels.
/// Returns 0 if `limits` is null or its struct_size is wrong. For limits beyond any memory the result is larger
/// than any memory; it does not wrap around.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_object_bytes(limits: *const hangpose_limits) -> usize {
    // SAFETY: the caller vouches for the pointer.
    unsafe { bytes(limits, |limits| ObjectHandle::BYTES.saturating_add(Object::bytes(&limits.to_core()))) }
}

/// Returns the bytes of memory for any supporter within `limits`; depends on points. Returns 0 if `limits` is null
/// or its struct_size is wrong. For limits beyond any memory the result is larger than any memory; it does not wrap
/// around.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_supporter_bytes(limits: *const hangpose_limits) -> usize {
    // SAFETY: the caller vouches for the pointer.
    unsafe {
        bytes(limits, |limits| SupporterHandle::BYTES.saturating_add(Supporter::bytes(&limits.to_core())))
    }
}

/// Returns the bytes of working memory for hangpose_predict or hangpose_predict_many with any object and supporter
/// within `limits`; depends on points and poses. Returns 0 if `limits` is null or its struct_size is wrong. For limits
/// beyond any memory the result is larger than any memory; it does not wrap around.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_predict_bytes(limits: *const hangpose_limits) -> usize {
    // SAFETY: the caller vouches for the pointer.
    unsafe {
        bytes(limits, |limits| {
            let poses = slot_bytes::<HangingPose>(limits.poses as usize);
            poses.saturating_add(predict_bytes(&limits.to_core()))
        })
    }
}

/// Returns the bytes of working memory for hangpose_plan_path with any object and supporter within `limits`; depends on
/// points, scene_points, nodes and waypoints. Returns 0 if `limits` is null or its struct_size is wrong. For limits beyond
/// any memory the result is larger than any memory; it does not wrap around.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_plan_bytes(limits: *const hangpose_limits) -> usize {
    // SAFETY: the caller vouches for the pointer.
    unsafe {
        bytes(limits, |limits| {
            let (scene, nodes) = (limits.scene_points as usize, limits.nodes as usize);
            plan_needs(&limits.to_core(), scene, nodes, limits.waypoints as usize)
        })
    }
}

/// Returns the bytes of working memory for hangpose_predict_reachable with any object and supporter within `limits`;
/// depends on points, poses, scene_points, nodes and waypoints. Returns 0 if `limits` is null or its struct_size is wrong.
/// For limits beyond any memory the result is larger than any memory; it does not wrap around.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_reachable_bytes(limits: *const hangpose_limits) -> usize {
    // SAFETY: the caller vouches for the pointer.
    unsafe {
        bytes(limits, |limits| {
            let (scene, nodes) = (limits.scene_points as usize, limits.nodes as usize);
            let (poses, waypoints) = (limits.poses as usize, limits.waypoints as usize);
            reachable_needs(&limits.to_core(), scene, nodes, poses, waypoints)
        })
    }
}

/// # Safety
///
/// The obligations of the caller, see `border`.
unsafe fn bytes(limits: *const hangpose_limits, of: impl FnOnce(&hangpose_limits) -> usize) -> usize {
    // SAFETY: those of this function.
    unsafe { input(limits) }.map_or(0, of)
}
