use crate::border::{DETAIL, Public, Region, input, keep_apart, place, report_model};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::getter::{at, get};
use crate::handle::{Handle, Model};
use crate::mesh::hangpose_mesh;
use crate::monitor::{self, hangpose_monitor};
use crate::params::hangpose_params;
use crate::status::*;
use core::ffi::c_void;
use hangpose_core::Monitor;
use hangpose_core::geometry::{MAX_FOLD, Symmetry};
use hangpose_core::hanging::{Object, ObjectCounts, sites};
use hangpose_core::memory::Limits;

/// An analysed object, at the front of the memory in which it was created. There is nothing to free. As long as it
/// is used, its memory must not be moved and nobody else may write to it. Any number of threads may use it at the
/// same time.
pub struct hangpose_object(#[allow(dead_code)] ObjectHandle);

pub(crate) type ObjectHandle = Handle<Object<'static>>;

impl Model for Object<'static> {
    const MAGIC: u32 = 0x4f62_6a31;
    const ARGUMENT: &'static str = "object";
    const MAKER: &'static str = "hangpose_object_create";
}

/// Analyses `mesh` in `memory` and sets `*object` to the result, which stays in `memory`. `memory_size` is at least
/// hangpose_object_bytes for the size of `mesh` and for `params`. `mesh`, its arrays and `params` are needed during
/// the call only. `monitor` may be null.
///
/// Returns HANGPOSE_OK; HANGPOSE_WORK_LIMIT with an object that may have more sites or contact candidates than were
/// found; HANGPOSE_CANCELLED or an error without an object. `*object` is then null, unless its address is part of
/// another argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_object_create(
    memory: *mut c_void,
    memory_size: usize,
    mesh: *const hangpose_mesh,
    params: *const hangpose_params,
    monitor: *mut hangpose_monitor,
    object: *mut *mut hangpose_object,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let create = || {
        let memory = memory.cast::<u8>();
        // SAFETY: the caller vouches for the pointers.
        let mesh = unsafe { input(mesh) }?;
        let [mesh_region, vertices, triangles, viewpoints] = mesh.regions();
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory, memory_size),
            Region::written("object", object, 1),
            Region::written("monitor", monitor, 1),
            Region::read("params", params, 1),
            mesh_region,
            vertices,
            triangles,
            viewpoints,
        ])?;
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (object, params, monitor) =
            unsafe { (place("object", object)?, input(params)?, monitor::of(monitor)?) };
        let params = params.to_core()?;
        mesh.check_counts()?;
        let limits = Limits {
            vertices: mesh.vertex_count as usize,
            triangles: mesh.triangle_count as usize,
            samples: params.samples,
            voxels: params.voxels,
            ..Limits::NONE
        };
        let none = Monitor::new();
        let analyze = |arena: &'static mut [u8]| -> Result<_, Failure> {
            // SAFETY: the caller vouches for the arrays.
            let mesh = unsafe { mesh.check() }?;
            Ok(Object::analyze(&mesh, &params, arena, monitor.unwrap_or(&none))?)
        };
        // SAFETY: the caller vouches for the memory, which is apart from the rest.
        let handle = unsafe { ObjectHandle::create(memory, memory_size, Object::bytes(&limits), analyze) }?;
        *object = handle.cast();
        // SAFETY: it was made just now.
        Ok(stopped(unsafe { ObjectHandle::share(handle) }?.model().stopped()))
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report_model::<_, Failure>("object", object, detail, create) }
}

/// Result of the analysis of an object.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_object_info {
    /// sizeof(hangpose_object_info), set by the caller.
    pub struct_size: u32,
    /// HANGPOSE_WORK_LIMIT if the search for sites or contact candidates ended early, else HANGPOSE_OK.
    pub stopped: hangpose_status,
    /// 1 if the mesh is closed, so that it has a volume, else 0.
    pub is_closed: u32,
    /// 1 if the mesh is closed and its triangles face inwards, else 0. The analysis corrects for this.
    pub is_inside_out: u32,
    /// Surface area, square metres.
    pub area: f32,
    /// Volume, cubic metres; NaN if the mesh is not closed.
    pub volume: f32,
    /// x, y, z of the centre of mass for which poses are made, metres, in object coordinates.
    pub centre_of_mass: [f32; 3],
    /// Number of samples whose normal points towards the centre of mass, eq. (3): with a cosine above
    /// object_contact_cosine, or 0.3 with HANGPOSE_CANDIDATES_CONTACTS.
    pub contact_points: u32,
    /// Number of clusters of contact points, eq. (4); 0 with HANGPOSE_CANDIDATES_CONTACTS.
    pub clusters: u32,
    /// Number of clusters with a free space outside the object; 0 with HANGPOSE_CANDIDATES_CONTACTS.
    pub with_free_space: u32,
    /// Number of free spaces that the object encircles, eq. (6); 0 with HANGPOSE_CANDIDATES_CONTACTS.
    pub encircled: u32,
    /// Number of hanging sites: encircled free spaces that differ from each other, eq. (7); 0 with
    /// HANGPOSE_CANDIDATES_CONTACTS.
    pub sites: u32,
    /// Number of contact candidates; 0 with HANGPOSE_CANDIDATES_SITES.
    pub contacts: u32,
    /// Number of symmetries that were detected; 0 with hangpose_params.voxels = 0.
    pub symmetries: u32,
    /// Number of rays cast.
    pub rays: u64,
    /// Number of distance and inside-outside queries.
    pub distance_queries: u64,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_object_info {
    const NAME: &'static str = "info";
}

/// Writes the result of the analysis to `info`. Set info->struct_size before the call. Returns HANGPOSE_OK, or an
/// error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_object_get_info(
    object: *const hangpose_object,
    info: *mut hangpose_object_info,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let read = |object: &Object| {
        let (mass, work) = (object.mass(), object.work());
        let (contact_points, counts) = match object.counts() {
            ObjectCounts::Sites(counts) => (counts.contact_points, counts),
            ObjectCounts::Contacts(counts) => (counts.contact_points, sites::ObjectCounts::default()),
        };
        Ok(hangpose_object_info {
            struct_size: size_of::<hangpose_object_info>() as u32,
            stopped: stopped(object.stopped()),
            is_closed: u32::from(mass.is_closed),
            is_inside_out: u32::from(mass.is_inside_out),
            area: mass.area,
            volume: mass.volume.unwrap_or(f32::NAN),
            centre_of_mass: object.centre_of_mass().into(),
            contact_points: contact_points as u32,
            clusters: counts.clusters as u32,
            with_free_space: counts.with_free_space as u32,
            encircled: counts.encircled as u32,
            sites: counts.sites as u32,
            contacts: object.contacts().len() as u32,
            symmetries: object.symmetries().len() as u32,
            rays: work.rays,
            distance_queries: work.distance_queries,
        })
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe { get(object.cast::<ObjectHandle>(), info, detail, read) }
}

/// A hanging site: a free space of the object into which a supporter can reach.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_object_site {
    /// sizeof(hangpose_object_site), set by the caller.
    pub struct_size: u32,
    /// |P_h|: number of samples in the cluster of contact points.
    pub contact_points: u32,
    /// c_h: x, y, z of the centre of the free space, metres, in object coordinates.
    pub position: [f32; 3],
    /// v_h: x, y, z of the unit vector along which the supporter passes through, in object coordinates; the sign is
    /// arbitrary.
    pub hanging_direction: [f32; 3],
    /// p_h: x, y, z of the contact point from which the free space was found, metres, in object coordinates.
    pub contact_point: [f32; 3],
    /// r_h: radius of the free space, metres.
    pub free_space_radius: f32,
    /// m: fraction of the rays around the hanging direction that hit the object, 0 to 1, eq. (5).
    pub encircled: f32,
    /// m_1: fraction of the rays above the hanging position that hit the object, 0 to 1.
    pub encircled_above: f32,
    /// m_2: fraction of the rays below the hanging position that hit the object, 0 to 1.
    pub encircled_below: f32,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_object_site {
    const NAME: &'static str = "site";
}

/// Writes hanging site `index` to `site`. `index` is less than hangpose_object_info.sites; site 0 is encircled
/// best. Set site->struct_size before the call. Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_object_get_site(
    object: *const hangpose_object,
    index: u32,
    site: *mut hangpose_object_site,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let read = |object: &Object| {
        let found = at(object.sites(), index)?;
        Ok(hangpose_object_site {
            struct_size: size_of::<hangpose_object_site>() as u32,
            contact_points: found.contact_points,
            position: found.position.into(),
            hanging_direction: found.hanging_direction.into(),
            contact_point: found.contact_point.into(),
            free_space_radius: found.free_space_radius,
            encircled: found.encircled,
            encircled_above: found.encircled_above,
            encircled_below: found.encircled_below,
        })
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe { get(object.cast::<ObjectHandle>(), site, detail, read) }
}

/// A contact candidate of an object: a point of its surface that can rest on a supporter.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_object_contact {
    /// sizeof(hangpose_object_contact), set by the caller.
    pub struct_size: u32,
    /// x, y, z of the point on the surface, metres, in object coordinates.
    pub position: [f32; 3],
    /// x, y, z of the unit normal, out of the solid, in object coordinates.
    pub normal: [f32; 3],
    /// x, y, z of the direction in which the object catches a thin bar under the point best: a unit vector in
    /// object coordinates; the sign is arbitrary.
    pub bar_direction: [f32; 3],
    /// Distance that this bar must move from the point towards the centre of mass, which is down when the object hangs,
    /// before it can escape sideways, metres; 0 if it is not caught. The bar is a line without thickness.
    pub capture: f32,
    /// Distance from the point towards the centre of mass to the opposite surface, metres; infinite if there is none.
    pub room: f32,
    /// Distance that this bar can extend along its direction before it meets the object, on the longer side,
    /// metres; infinite if nothing stops it, as in a hole.
    pub passage: f32,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_object_contact {
    const NAME: &'static str = "contact";
}

/// Writes contact candidate `index` to `contact`. `index` is less than hangpose_object_info.contacts; candidate 0
/// has the greatest capture. Set contact->struct_size before the call. Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_object_get_contact(
    object: *const hangpose_object,
    index: u32,
    contact: *mut hangpose_object_contact,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let read = |object: &Object| {
        let found = at(object.contacts(), index)?;
        Ok(hangpose_object_contact {
            struct_size: size_of::<hangpose_object_contact>() as u32,
            position: found.position.into(),
            normal: found.normal.into(),
            bar_direction: found.bar_direction.into(),
            capture: found.capture,
            room: found.room,
            passage: found.passage,
        })
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe { get(object.cast::<ObjectHandle>(), contact, detail, read) }
}

/// Greatest hangpose_symmetry.fold.
pub const HANGPOSE_MAX_FOLD: u32 = 360;

const _: () = assert!(HANGPOSE_MAX_FOLD == MAX_FOLD);

/// Turns of an object after which it looks as before, about an axis through its centre of mass.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_symmetry {
    /// sizeof(hangpose_symmetry), set by the caller.
    pub struct_size: u32,
    /// 0 for a solid of revolution, which may turn by any angle; n, from 2 to HANGPOSE_MAX_FOLD, for turns by multiples
    /// of an n-th of a full turn.
    pub fold: u32,
    /// x, y, z of the direction of the axis, in object coordinates; the sign is arbitrary. Its length is 1 where it was
    /// detected; in a hangpose_request, any but zero.
    pub axis: [f32; 3],
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_symmetry {
    const NAME: &'static str = "symmetry";
}

/// Writes detected symmetry `index` to `symmetry`. `index` is less than hangpose_object_info.symmetries. Set
/// symmetry->struct_size before the call. Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_object_get_symmetry(
    object: *const hangpose_object,
    index: u32,
    symmetry: *mut hangpose_symmetry,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let read = |object: &Object| {
        let &Symmetry { axis, fold } = at(object.symmetries().iter(), index)?;
        Ok(hangpose_symmetry { struct_size: size_of::<hangpose_symmetry>() as u32, fold, axis: axis.into() })
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe { get(object.cast::<ObjectHandle>(), symmetry, detail, read) }
}
