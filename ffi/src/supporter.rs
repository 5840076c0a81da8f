use crate::border::{DETAIL, Public, Region, input, keep_apart, place, report, report_model};
use crate::cloud::hangpose_cloud;
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::getter::{at, get};
use crate::handle::{Handle, Model};
use crate::monitor::{self, hangpose_monitor};
use crate::params::hangpose_params;
use crate::status::*;
use core::ffi::c_void;
use hangpose_core::Monitor;
use hangpose_core::hanging::{Supporter, SupporterCounts, sites};
use hangpose_core::memory::Limits;

/// An analysed supporter, at the front of the memory in which it was created. There is nothing to free. As long as
/// it is used, its memory must not be moved and nobody else may write to it. Any number of threads may use it at
/// the same time, except during hangpose_supporter_update.
pub struct hangpose_supporter(#[allow(dead_code)] SupporterHandle);

pub(crate) type SupporterHandle = Handle<Supporter<'static>>;

impl Model for Supporter<'static> {
    const MAGIC: u32 = 0x5375_7031;
    const ARGUMENT: &'static str = "supporter";
    const MAKER: &'static str = "hangpose_supporter_create";
}

/// Bytes behind the handle for the model of a cloud.
fn model_bytes(cloud: &hangpose_cloud) -> usize {
    let points = cloud.point_count as usize;
    Supporter::bytes(&Limits::of_points(points))
}

/// Analyses `cloud` in `memory` and sets `*supporter` to the result, which stays in `memory`. `memory_size` is at
/// least hangpose_supporter_bytes for the size of `cloud`; memory for more points leaves room for later updates.
/// `cloud`, its arrays and `params` are needed during the call only. `monitor` may be null.
///
/// Returns HANGPOSE_OK; HANGPOSE_WORK_LIMIT with a supporter that may have more sites or contact candidates than
/// were found; HANGPOSE_CANCELLED or an error without a supporter. `*supporter` is then null, unless its address is
/// part of another argument.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_supporter_create(
    memory: *mut c_void,
    memory_size: usize,
    cloud: *const hangpose_cloud,
    params: *const hangpose_params,
    monitor: *mut hangpose_monitor,
    supporter: *mut *mut hangpose_supporter,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let create = || {
        let memory = memory.cast::<u8>();
        // SAFETY: the caller vouches for the pointer.
        let cloud = unsafe { input(cloud) }?;
        let [cloud_region, points, normals, viewpoints, marks, region] = cloud.regions();
        keep_apart(&[
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory, memory_size),
            Region::written("supporter", supporter, 1),
            Region::written("monitor", monitor, 1),
            Region::read("params", params, 1),
            cloud_region,
            points,
            normals,
            viewpoints,
            marks,
            region,
        ])?;
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (supporter, params, monitor) =
            unsafe { (place("supporter", supporter)?, input(params)?, monitor::of(monitor)?) };
        let params = params.to_core()?;
        cloud.check_count()?;
        let none = Monitor::new();
        let analyze = |arena: &'static mut [u8]| -> Result<_, Failure> {
            // SAFETY: the caller vouches for the arrays.
            let cloud = unsafe { cloud.check() }?;
            Ok(Supporter::analyze(&cloud, &params, arena, monitor.unwrap_or(&none))?)
        };
        // SAFETY: the caller vouches for the memory, which is apart from the rest.
        let handle = unsafe { SupporterHandle::create(memory, memory_size, model_bytes(cloud), analyze) }?;
        *supporter = handle.cast();
        // SAFETY: it was made just now.
        Ok(stopped(unsafe { SupporterHandle::share(handle) }?.model().stopped()))
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report_model::<_, Failure>("supporter", supporter, detail, create) }
}

/// Replaces the cloud of `supporter` by a new one and analyses it in the same memory. `monitor` may be null. No
/// other thread may use the supporter during the call; if one does, the call returns HANGPOSE_ERROR_BUSY.
///
/// Returns HANGPOSE_OK; HANGPOSE_WORK_LIMIT as hangpose_supporter_create does; HANGPOSE_CANCELLED, and the
/// supporter is empty until an update succeeds; or an error, and the supporter is unchanged.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_supporter_update(
    supporter: *mut hangpose_supporter,
    cloud: *const hangpose_cloud,
    params: *const hangpose_params,
    monitor: *mut hangpose_monitor,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let update = || {
        // SAFETY: the caller vouches for the pointers.
        let (cloud, core, watch) =
            unsafe { (input(cloud)?, input(params)?.to_core()?, monitor::of(monitor)?) };
        cloud.check_count()?;
        let check = |room, [handle, arena]: [Region; 2]| {
            let [cloud_region, points, normals, viewpoints, marks, region] = cloud.regions();
            keep_apart(&[
                Region::written(DETAIL, detail, 1),
                handle,
                arena,
                Region::written("monitor", monitor, 1),
                Region::read("params", params, 1),
                cloud_region,
                points,
                normals,
                viewpoints,
                marks,
                region,
            ])?;
            let needed = model_bytes(cloud);
            if needed > room {
                let more = SupporterHandle::BYTES;
                let (needed, given) = (needed.saturating_add(more), room.saturating_add(more));
                return Err(Failure::Memory { argument: "supporter", needed, given });
            }
            // SAFETY: the caller vouches for the arrays.
            unsafe { cloud.check() }.map(drop)
        };
        let none = Monitor::new();
        let mut answer = HANGPOSE_OK;
        let analyze = |arena: &'static mut [u8]| -> Result<_, Failure> {
            // SAFETY: the caller vouches for the arrays.
            let cloud = unsafe { cloud.check() }?;
            let model = Supporter::analyze(&cloud, &core, arena, watch.unwrap_or(&none))?;
            answer = stopped(model.stopped());
            Ok(model)
        };
        // SAFETY: the caller vouches for the supporter.
        unsafe { SupporterHandle::rebuild(supporter.cast(), check, analyze) }?;
        Ok(answer)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, update) }
}

/// Result of the analysis of a supporter.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_supporter_info {
    /// sizeof(hangpose_supporter_info), set by the caller.
    pub struct_size: u32,
    /// HANGPOSE_WORK_LIMIT if the search for sites or contact candidates ended early, else HANGPOSE_OK.
    pub stopped: hangpose_status,
    /// Number of points that are left of the cloud, without those that were merged and the strays, and with those that
    /// were guessed.
    pub points: u32,
    /// Number of points that were merged with others at the same place.
    pub points_merged: u32,
    /// Number of points that were dropped as strays: alone in the air, or in a speck.
    pub strays: u32,
    /// Number of points left on large planes, as walls and tables, on which nothing hangs.
    pub points_on_planes: u32,
    /// Number of points that no viewpoint saw and that were guessed: the far sides of bars and plates.
    pub points_guessed: u32,
    /// Number of normals that were missing or zero and were estimated from the neighbouring points: all of the
    /// cloud, where the given ones are no normals of the surface on which the points are.
    pub normals_estimated: u32,
    /// Number of normals that were not of unit length and were normalised.
    pub normals_renormalised: u32,
    /// Number of given normals that were reversed, because they pointed into the solid or because their signs did not
    /// agree with each other.
    pub normals_reversed: u32,
    /// Number of points that face up, eq. (2): with a cosine above supporter_contact_cosine, or 0.3 with
    /// HANGPOSE_CANDIDATES_CONTACTS.
    pub contact_points: u32,
    /// Number of clusters of contact points; 0 with HANGPOSE_CANDIDATES_CONTACTS.
    pub clusters: u32,
    /// Number of support sites: clusters at which a slice through the supporter holds together; 0 with
    /// HANGPOSE_CANDIDATES_CONTACTS.
    pub sites: u32,
    /// Number of contact candidates; 0 with HANGPOSE_CANDIDATES_SITES.
    pub contacts: u32,
    /// Number of rays cast.
    pub rays: u64,
    /// Number of distance and inside-outside queries.
    pub distance_queries: u64,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_supporter_info {
    const NAME: &'static str = "info";
}

/// Writes the result of the analysis to `info`. Set info->struct_size before the call. Returns HANGPOSE_OK, or an
/// error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_supporter_get_info(
    supporter: *const hangpose_supporter,
    info: *mut hangpose_supporter_info,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let read = |supporter: &Supporter| {
        let (cleaning, normals, work) = (supporter.cleaning(), supporter.normals(), supporter.work());
        let (contact_points, counts) = match supporter.counts() {
            SupporterCounts::Sites(counts) => (counts.contact_points, counts),
            SupporterCounts::Contacts(counts) => (counts.contact_points, sites::SupporterCounts::default()),
        };
        Ok(hangpose_supporter_info {
            struct_size: size_of::<hangpose_supporter_info>() as u32,
            stopped: stopped(supporter.stopped()),
            points: supporter.points().points().len() as u32,
            points_merged: cleaning.merged as u32,
            strays: cleaning.strays as u32,
            points_on_planes: cleaning.on_planes as u32,
            points_guessed: supporter.guessed() as u32,
            normals_estimated: normals.estimated as u32,
            normals_renormalised: normals.renormalised as u32,
            normals_reversed: normals.reversed as u32,
            contact_points: contact_points as u32,
            clusters: counts.clusters as u32,
            sites: counts.sites as u32,
            contacts: supporter.contacts().len() as u32,
            rays: work.rays,
            distance_queries: work.distance_queries,
        })
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe { get(supporter.cast::<SupporterHandle>(), info, detail, read) }
}

/// A support site: a cross-section of the supporter on which an object can hang.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_supporter_site {
    /// sizeof(hangpose_supporter_site), set by the caller.
    pub struct_size: u32,
    /// c_s: x, y, z of the centre of the cross-section, metres, in supporter coordinates.
    pub position: [f32; 3],
    /// v_s: x, y, z of the horizontal unit vector along which the cross-section is smallest, in supporter
    /// coordinates; the sign is arbitrary.
    pub hanging_direction: [f32; 3],
    /// p_s: x, y, z of the contact point at which the supporter was sliced, metres, in supporter coordinates.
    pub contact_point: [f32; 3],
    /// r_s: radius of the sphere around the cross-section, metres.
    pub support_radius: f32,
    /// d_1, d_2: distances from the position to the convex hull of the supporter along the hanging direction and
    /// against it, metres.
    pub boundary_distances: [f32; 2],
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_supporter_site {
    const NAME: &'static str = "site";
}

/// Writes support site `index` to `site`. `index` is less than hangpose_supporter_info.sites; site 0 is the
/// thinnest. Set site->struct_size before the call. Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_supporter_get_site(
    supporter: *const hangpose_supporter,
    index: u32,
    site: *mut hangpose_supporter_site,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let read = |supporter: &Supporter| {
        let found = at(supporter.sites(), index)?;
        Ok(hangpose_supporter_site {
            struct_size: size_of::<hangpose_supporter_site>() as u32,
            position: found.position.into(),
            hanging_direction: found.hanging_direction.into(),
            contact_point: found.contact_point.into(),
            support_radius: found.support_radius,
            boundary_distances: found.boundary_distances,
        })
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe { get(supporter.cast::<SupporterHandle>(), site, detail, read) }
}

/// A contact candidate of a supporter: a point on which an object can rest.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_supporter_contact {
    /// sizeof(hangpose_supporter_contact), set by the caller.
    pub struct_size: u32,
    /// x, y, z of the point, metres, in supporter coordinates.
    pub position: [f32; 3],
    /// x, y, z of the unit normal, out of the solid, in supporter coordinates.
    pub normal: [f32; 3],
    /// x, y, z of the unit vector along which the supporter extends around the point, in supporter coordinates; the
    /// sign is arbitrary.
    pub bar_direction: [f32; 3],
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_supporter_contact {
    const NAME: &'static str = "contact";
}

/// Writes contact candidate `index` to `contact`. `index` is less than hangpose_supporter_info.contacts. Set
/// contact->struct_size before the call. Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_supporter_get_contact(
    supporter: *const hangpose_supporter,
    index: u32,
    contact: *mut hangpose_supporter_contact,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let read = |supporter: &Supporter| {
        let found = at(supporter.contacts(), index)?;
        Ok(hangpose_supporter_contact {
            struct_size: size_of::<hangpose_supporter_contact>() as u32,
            position: found.position.into(),
            normal: found.normal.into(),
            bar_direction: found.bar_direction.into(),
        })
    };
    // SAFETY: the caller vouches for the pointers.
    unsafe { get(supporter.cast::<SupporterHandle>(), contact, detail, read) }
}
