use crate::border::{DETAIL, Public, Region, input, keep_apart, place, report};
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
use hangpose_core::hanging::sites::ObjectCounts;
use hangpose_core::hanging::{Object, ObjectPlaces};
use hangpose_core::memory::Limits;

/// An object, analysed once, at the front of the memory that it was made in. There is nothing to free; the memory must
/// stay where it is, and no one else may write to it, for as long as the object is used. Any number of threads may use
/// it at once.
pub struct hangpose_object(#[allow(dead_code)] ObjectHandle);

pub(crate) type ObjectHandle = Handle<Object<'static>>;

impl Model for Object<'static> {
    const MAGIC: u32 = 0x4f62_6a31;
    const ARGUMENT: &'static str = "object";
    const MAKER: &'static str = "hangpose_object_create";
}

/// Analyses `mesh` in `memory`, which takes hangpose_object_bytes for its size and that of `params`, and sets `object` to
/// what it made there, or to null. `monitor` may be null.
///
/// HANGPOSE_OK, or HANGPOSE_WORK_LIMIT with an object that may have more sites or contacts than were found;
/// HANGPOSE_CANCELLED without one.
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
        let [mesh_region, vertices, triangles] = mesh.regions();
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory, memory_size),
            Region::written("object", object, 1),
            Region::written("monitor", monitor, 1),
            Region::read("params", params, 1),
            mesh_region,
            vertices,
            triangles,
        ])?;
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (object, params, monitor) =
            unsafe { (place("object", object)?, input(params)?, monitor::of(monitor)?) };
        *object = core::ptr::null_mut();
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
    unsafe { report(detail, create) }
}

/// What the analysis of an object found.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_object_info {
    /// sizeof(hangpose_object_info), set by the caller.
    pub struct_size: u32,
    /// HANGPOSE_WORK_LIMIT where the search for sites or contacts ended early, HANGPOSE_OK where it did not.
    pub stopped: hangpose_status,
    /// 1 where the mesh is closed, so that it has a volume, else 0.
    pub is_closed: u32,
    /// 1 where the mesh is closed but its triangles face inwards, which is allowed for, else 0.
    pub is_inside_out: u32,
    /// Surface area, square metres.
    pub area: f32,
    /// Volume, cubic metres; NaN where the mesh is not closed.
    pub volume: f32,
    /// x, y, z of the centre of mass that poses are made for, metres, in object coordinates.
    pub centre_of_mass: [f32; 3],
    /// Samples whose normal leans towards the centre of mass, eq. (3).
    pub contact_points: u32,
    /// Clusters of them, eq. (4).
    pub clusters: u32,
    /// Clusters with a free space outside the object.
    pub with_free_space: u32,
    /// Free spaces that the object encircles, eq. (6).
    pub encircled: u32,
    /// Different ones among them, eq. (7): the object's hanging sites; 0 with HANGPOSE_CANDIDATES_CONTACTS.
    pub sites: u32,
    /// Places where the object can lie on something; 0 with HANGPOSE_CANDIDATES_SITES.
    pub contacts: u32,
    /// Rays cast.
    pub rays: u64,
    /// Distance and inside-outside queries made.
    pub distance_queries: u64,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_object_info {
    const NAME: &'static str = "info";
}

/// Writes what the analysis found to `info`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_object_get_info(
    object: *const hangpose_object,
    info: *mut hangpose_object_info,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let read = |object: &Object| {
        let (mass, work) = (object.mass(), object.work());
        let (contact_points, counts) = match *object.places() {
            ObjectPlaces::Sites { counts, .. } => (counts.contact_points, counts),
            ObjectPlaces::Contacts { counts, .. } => (counts.contact_points, ObjectCounts::default()),
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
            rays: work.rays,
            distance_queries: work.distance_queries,
        })
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe { get(object.cast::<ObjectHandle>(), info, detail, read) }
}

/// A place on an object into which a supporter can reach.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_object_site {
    /// sizeof(hangpose_object_site), set by the caller.
    pub struct_size: u32,
    /// |P_h|: samples in the cluster of contact points.
    pub contact_points: u32,
    /// c_h: x, y, z of the centre of the free space, metres, in object coordinates.
    pub position: [f32; 3],
    /// v_h: unit vector along which the supporter passes through, in object coordinates; its sign means nothing.
    pub hanging_direction: [f32; 3],
    /// p_h: x, y, z of the contact point that the free space was found from, metres, in object coordinates.
    pub contact_point: [f32; 3],
    /// r_h: radius of the free space, metres.
    pub free_space_radius: f32,
    /// m: share of the rays around the hanging direction that hit the object, eq. (5).
    pub encircled: f32,
    /// m_1: the same among the rays above the hanging position.
    pub encircled_above: f32,
    /// m_2: the same among the rays below it.
    pub encircled_below: f32,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_object_site {
    const NAME: &'static str = "site";
}

/// Writes hanging site `index`, below hangpose_object_info.sites, to `site`; the best encircled is 0.
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

/// A place where an object can lie on something.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_object_contact {
    /// sizeof(hangpose_object_contact), set by the caller.
    pub struct_size: u32,
    /// x, y, z of a point on the surface, metres, in object coordinates.
    pub position: [f32; 3],
    /// Unit vector out of the solid, in object coordinates.
    pub normal: [f32; 3],
    /// Unit vector along the thin bar that the object catches best under the point, in object coordinates; its sign means
    /// nothing.
    pub bar_direction: [f32; 3],
    /// How far such a bar must come down before it gets out sideways, metres; 0 if it is not caught.
    pub capture: f32,
    /// How far it is to the surface opposite, metres; infinite where there is none.
    pub room: f32,
    /// How far such a bar gets along its direction, on the side where it gets farther, metres; infinite where nothing stops it,
    /// as in a hole.
    pub passage: f32,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_object_contact {
    const NAME: &'static str = "contact";
}

/// Writes contact `index`, below hangpose_object_info.contacts, to `contact`; the one that catches best is 0.
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
