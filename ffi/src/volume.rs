use crate::border::{
    DETAIL, Region, bytes_mut, input, keep_apart, memory as caller_memory, output, place, report,
    report_model, rows_mut,
};
use crate::depth_failure::DepthFailure;
use crate::depth_image::hangpose_depth_image;
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::handle::{Handle, Model};
use crate::mesh::hangpose_mesh;
use crate::monitor::{self, hangpose_monitor};
use crate::status::*;
use crate::volume_settings::hangpose_volume_settings;
use core::ffi::c_void;
use hangpose_core::Monitor;
use hangpose_core::perception::completion::{Completion, CompletionSettings};
use hangpose_core::perception::isosurface::Isosurface;
use hangpose_core::perception::volume::{Volume, VolumeLimits};

/// Depth images that are fused into a truncated signed distance volume, at the front of the memory in which it was
/// created. There is nothing to free. As long as it is used, its memory must not be moved and nobody else may write to
/// it. A thread that changes it must be the only one that uses it.
pub struct hangpose_volume(#[allow(dead_code)] VolumeHandle);

type VolumeHandle = Handle<Fusion>;

/// A volume and how far its completion may go.
pub(crate) struct Fusion {
    volume: Volume<'static>,
    guess: CompletionSettings,
}

impl Model for Fusion {
    const MAGIC: u32 = 0x566f_6c31;
    const ARGUMENT: &'static str = "volume";
    const MAKER: &'static str = "hangpose_volume_create";
}

/// Greatest number of blocks: an index of 32 bits for each voxel.
const MOST_BLOCKS: u32 = u32::MAX / 512;

fn limits(blocks: u32) -> VolumeLimits {
    VolumeLimits { blocks: blocks as usize }
}

/// Returns the bytes of memory for a volume of up to this many blocks of 8 x 8 x 8 voxels, about 2.1 KiB each.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_volume_bytes(blocks: u32) -> usize {
    VolumeHandle::BYTES.saturating_add(Volume::bytes(&limits(blocks)))
}

/// Returns the bytes of working memory that hangpose_volume_complete needs for a volume of up to this many blocks, at
/// most 6.7 KiB each.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_complete_bytes(blocks: u32) -> usize {
    Completion::bytes(blocks as usize)
}

/// Returns the bytes of working memory that hangpose_volume_surface needs for a volume of up to this many blocks, 244
/// each.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_surface_bytes(blocks: u32) -> usize {
    Isosurface::bytes(blocks as usize)
}

/// Creates an empty volume in `memory` and sets `*volume` to it. It has room for `blocks` blocks of 8 x 8 x 8
/// voxels, 1 to 8388607: hangpose_volume_blocks for a dense volume; for a sparse one, those within the truncation
/// of the surfaces. `memory_size` is at least hangpose_volume_bytes for `blocks`. `settings` are needed during the
/// call only.
///
/// Returns HANGPOSE_OK, or an error without a volume. `*volume` is then null, unless its address is part of another
/// argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_volume_create(
    memory: *mut c_void,
    memory_size: usize,
    settings: *const hangpose_volume_settings,
    blocks: u32,
    volume: *mut *mut hangpose_volume,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let create = || {
        let memory = memory.cast::<u8>();
        // SAFETY: the caller vouches for the pointer.
        let settings = unsafe { input(settings) }?;
        let [settings_region, crop] = settings.regions();
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory, memory_size),
            Region::written("volume", volume, 1),
            settings_region,
            crop,
        ])?;
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (volume, (settings, guess)) = unsafe { (place("volume", volume)?, settings.check()?) };
        if blocks == 0 || blocks > MOST_BLOCKS {
            let (count, most) = (blocks as usize, MOST_BLOCKS as usize);
            return Err(Failure::Count { field: "blocks", count, most }.into());
        }
        let limits = limits(blocks);
        let build = |arena: &'static mut [u8]| -> Result<_, DepthFailure> {
            Ok(Fusion { volume: Volume::new(&settings, &limits, arena)?, guess })
        };
        // SAFETY: the caller vouches for the memory, which is apart from the rest.
        let handle = unsafe { VolumeHandle::create(memory, memory_size, Volume::bytes(&limits), build) }?;
        *volume = handle.cast();
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe { report_model::<_, DepthFailure>("volume", volume, detail, create) }
}

/// Fuses an image. With settings.missing_is_free, pixels without a depth show free space; else they say nothing. Sets
/// `*pixels` to the number of pixels with the label and a surface within the volume; 0 says that the image shows nothing
/// of it. `image` and its arrays are needed during the call only. `monitor` may be null; a pixel counts as one ray of its
/// work limit.
///
/// Returns HANGPOSE_OK; HANGPOSE_WORK_LIMIT or an error, and the volume is as it was before; or HANGPOSE_CANCELLED, and a part
/// of the image may be fused, as if labels hid the rest. After HANGPOSE_ERROR_CAPACITY, create a volume of more blocks and fuse
/// all images again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_volume_integrate(
    volume: *mut hangpose_volume,
    image: *const hangpose_depth_image,
    monitor: *mut hangpose_monitor,
    pixels: *mut u32,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let integrate = || {
        // SAFETY: the caller vouches for the pointers.
        let (mut claimed, image) = unsafe { (VolumeHandle::claim(volume.cast())?, input(image)?) };
        let ([handle, arena], [depths, labels]) = (claimed.regions(), image.regions());
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            handle,
            arena,
            Region::written("monitor", monitor, 1),
            Region::written("pixels", pixels, 1),
            Region::read("image", image, 1),
            depths,
            labels,
        ])?;
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (pixels, monitor, (image, mask)) =
            unsafe { (place("pixels", pixels)?, monitor::of(monitor)?, image.check()?) };
        let none = Monitor::new();
        let done = claimed.model().volume.integrate(&image, mask, monitor.unwrap_or(&none))?;
        *pixels = done.pixels as u32;
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<DepthFailure>(detail, integrate) }
}

/// Guesses what no image shows of an object that is held alone, with hangpose_volume_settings.thickness and radius. The
/// surface is then closed. What was seen stays as it is. The volume must be dense, and the cameras must have seen past the
/// object: to a wall, or with settings.missing_is_free. `memory` is working memory of at least hangpose_complete_bytes,
/// needed during the call only. `monitor` may be null.
///
/// Returns HANGPOSE_OK; an error, and the volume is as it was before; or HANGPOSE_CANCELLED, and a part of the guesses may be
/// written, which another call completes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_volume_complete(
    volume: *mut hangpose_volume,
    memory: *mut c_void,
    memory_size: usize,
    monitor: *mut hangpose_monitor,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let complete = || {
        // SAFETY: the caller vouches for the pointer.
        let mut claimed = unsafe { VolumeHandle::claim(volume.cast()) }?;
        let [handle, arena] = claimed.regions();
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            handle,
            arena,
            Region::written("memory", memory.cast::<u8>(), memory_size),
            Region::written("monitor", monitor, 1),
        ])?;
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (memory, monitor) =
            unsafe { (caller_memory(memory.cast(), memory_size)?, monitor::of(monitor)?) };
        let none = Monitor::new();
        let Fusion { volume, guess } = claimed.model();
        volume.complete(guess, memory, monitor.unwrap_or(&none))?;
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<DepthFailure>(detail, complete) }
}

/// Finds the surface of a volume and sets `mesh` to it, ready for hangpose_object_create: in world coordinates, with
/// corners that are counter-clockwise seen from free space. Set mesh->struct_size before the call, and mesh->viewpoints to
/// the positions of the cameras after it. Where neither an image
/// nor hangpose_volume_complete says what is there, the mesh is open. If no image shows a surface, its counts are 0.
///
/// `vertices` is an array of `vertex_capacity` rows and `triangles` one of `triangle_capacity` rows, to which `mesh` will
/// point. If both are null, only the counts of `mesh` are set. `seen` is an array of `vertex_capacity` marks: 1 for
/// vertices that images show, 0 for those that were guessed. It may be null. `memory` is working memory of at least
/// hangpose_surface_bytes, needed during the call only. `monitor` may be null.
///
/// Returns HANGPOSE_OK; or HANGPOSE_CANCELLED or an error, and `mesh` is unchanged.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_volume_surface(
    volume: *const hangpose_volume,
    memory: *mut c_void,
    memory_size: usize,
    monitor: *mut hangpose_monitor,
    vertices: *mut f32,
    vertex_capacity: u32,
    triangles: *mut u32,
    triangle_capacity: u32,
    seen: *mut u8,
    mesh: *mut hangpose_mesh,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let find = || {
        // SAFETY: the caller vouches for the pointer.
        let shared = unsafe { VolumeHandle::share(volume.cast()) }?;
        let [handle, arena] = shared.regions();
        let rows = vertex_capacity as usize;
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory.cast::<u8>(), memory_size),
            Region::written("monitor", monitor, 1),
            Region::written("vertices", vertices.cast::<[f32; 3]>(), rows),
            Region::written("triangles", triangles.cast::<[u32; 3]>(), triangle_capacity as usize),
            Region::written("seen", seen, rows),
            Region::written("mesh", mesh, 1),
            handle,
            arena,
        ])?;
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (memory, monitor, mesh) =
            unsafe { (caller_memory(memory.cast(), memory_size)?, monitor::of(monitor)?, output(mesh)?) };
        let none = Monitor::new();
        let surface = Isosurface::find(&shared.model().volume, memory, monitor.unwrap_or(&none))?;
        if !vertices.is_null() || !triangles.is_null() {
            // SAFETY: the caller vouches for the arrays, which are apart from the rest.
            let (vertices, triangles) = unsafe {
                (
                    rows_mut("vertices", vertices, vertex_capacity)?,
                    rows_mut("triangles", triangles, triangle_capacity)?,
                )
            };
            surface.write(vertices, triangles)?;
            if !seen.is_null() {
                // SAFETY: the caller vouches for the array, which is apart from the rest.
                surface.write_seen(unsafe { bytes_mut("seen", seen, vertex_capacity) }?)?;
            }
        }
        *mesh = hangpose_mesh {
            struct_size: size_of::<hangpose_mesh>() as u32,
            vertex_count: surface.vertices() as u32,
            triangle_count: surface.triangles() as u32,
            viewpoint_count: 0,
            vertices,
            triangles,
            viewpoints: core::ptr::null(),
        };
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<DepthFailure>(detail, find) }
}
