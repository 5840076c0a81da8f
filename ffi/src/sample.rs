use crate::border::{DETAIL, Region, input, keep_apart, memory as caller_memory, report, rows_mut};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::mesh::hangpose_mesh;
use crate::status::*;
use core::ffi::c_void;
use hangpose_core::perception::sampling;

/// Returns the bytes of working memory that hangpose_mesh_sample needs for `count` samples.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_sample_bytes(count: u32) -> usize {
    sampling::sample_bytes(count as usize)
}

/// Samples `count` evenly spread points, 1 to 500000, and their normals from a mesh: the cloud of a supporter whose
/// mesh is known. `points` and `normals` are arrays of `count` rows of x, y, z: metres and unit vectors, in the
/// coordinates of the mesh. `memory` is working memory of at least hangpose_sample_bytes, needed during the call
/// only. The same seed gives the same samples. Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_mesh_sample(
    mesh: *const hangpose_mesh,
    seed: u64,
    memory: *mut c_void,
    memory_size: usize,
    points: *mut f32,
    normals: *mut f32,
    count: u32,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let sample = || {
        // SAFETY: the caller vouches for the pointer.
        let mesh = unsafe { input(mesh) }?;
        let [mesh_region, vertices, triangles, viewpoints] = mesh.regions();
        let rows = count as usize;
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory.cast::<u8>(), memory_size),
            Region::written("points", points.cast::<[f32; 3]>(), rows),
            Region::written("normals", normals.cast::<[f32; 3]>(), rows),
            mesh_region,
            vertices,
            triangles,
            viewpoints,
        ])?;
        if rows == 0 || rows > sampling::MAX_SAMPLES {
            return Err(Failure::Count { field: "count", count: rows, most: sampling::MAX_SAMPLES });
        }
        let needed = sampling::sample_bytes(rows);
        if memory_size < needed {
            return Err(Failure::Memory { argument: "memory", needed, given: memory_size });
        }
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (mesh, memory, points, normals) = unsafe {
            (
                mesh.check()?,
                caller_memory(memory.cast(), memory_size)?,
                rows_mut("points", points, count)?,
                rows_mut("normals", normals, count)?,
            )
        };
        sampling::sample(&mesh, seed, points, normals, memory)?;
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, sample) }
}
