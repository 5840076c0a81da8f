use crate::border::{
    DETAIL, Public, Region, check, check_size, elements, input, keep_apart, memory as caller_memory,
    optional_input, output, report,
};
use crate::detail::hangpose_detail;
use crate::failure::{Failure, ObjectFault};
use crate::handle::Shared;
use crate::monitor::{self, hangpose_monitor};
use crate::object::{ObjectHandle, hangpose_object};
use crate::params::hangpose_params;
use crate::pose::hangpose_pose;
use crate::request::{HANGPOSE_MAX_HUNG, HungObjects, hangpose_request};
use crate::slots::{check_room, slot_bytes, slots};
use crate::status::*;
use crate::supporter::{SupporterHandle, hangpose_supporter};
use core::ffi::c_void;
use hangpose_core::Monitor;
use hangpose_core::hanging::{HangingPose, Many, Object, predict_bytes, predict_many};

// The memory for a number of poses holds as many that may be missing.
const _: () = assert!(size_of::<Option<HangingPose>>() == size_of::<HangingPose>());

/// Result of hangpose_predict_many beside the poses.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_many {
    /// sizeof(hangpose_many), set by the caller.
    pub struct_size: u32,
    /// Number of objects that have a pose.
    pub placed: u32,
    /// Why the first object without a pose has none, one of HANGPOSE_STAGE_*; hangpose_stage_string gives a text.
    /// HANGPOSE_STAGE_NONE if all have one, or if all for which HANGPOSE_MAX_HUNG leaves room have one.
    pub stage: hangpose_stage,
    /// HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT if this call or the analysis of one of its models ended early, else
    /// HANGPOSE_OK.
    pub stopped: hangpose_status,
    /// Number of rays cast.
    pub rays: u64,
    /// Number of distance and inside-outside queries.
    pub distance_queries: u64,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_many {
    const NAME: &'static str = "many";
}

/// Finds poses in which all of `objects` hang on `supporter` at once, each as `request` asks and clear of the others.
///
/// `objects` is an array of `object_count` objects, 1 to HANGPOSE_MAX_HUNG; copies are the same pointer several times.
/// `poses` is an array of as many structs in the order of the objects: `has_pose` of one is 0 if there is no room
/// for it. The first objects choose first. At most HANGPOSE_MAX_HUNG hang in the end, with those that hang already; the
/// objects beyond have no pose. The models must have been analysed with these `params`, of which `settle` must be 1.
///
/// `memory` is working memory of at least hangpose_predict_bytes with limits.poses = object_count. A work limit of
/// `monitor` holds for each of the predictions of which the call consists: one for each object, and up to two for each
/// pair of them. Set many->struct_size before the call. Everything else is as for hangpose_predict.
///
/// Returns HANGPOSE_OK if at least one object has a pose, and many->placed says how many; HANGPOSE_REJECTED if none has,
/// and many->stage gives the reason; HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT with the poses found so far, possibly
/// none; or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_predict_many(
    objects: *const *const hangpose_object,
    object_count: u32,
    supporter: *const hangpose_supporter,
    request: *const hangpose_request,
    params: *const hangpose_params,
    memory: *mut c_void,
    memory_size: usize,
    monitor: *mut hangpose_monitor,
    poses: *mut hangpose_pose,
    pose_size: usize,
    many: *mut hangpose_many,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let call = || {
        let anything = hangpose_request::any();
        // SAFETY: the caller vouches for the pointers.
        let (shared, supporter, request) = unsafe {
            (
                share(objects, object_count)?,
                SupporterHandle::share(supporter.cast())?,
                optional_input(request)?.unwrap_or(&anything),
            )
        };
        // SAFETY: as above.
        let hung = unsafe { HungObjects::of(request) }?;
        check_size::<hangpose_pose>(pose_size)?;
        let written = [
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory.cast::<u8>(), memory_size),
            Region::written("poses", poses, object_count as usize),
            Region::written("many", many, 1),
            Region::written("monitor", monitor, 1),
        ];
        keep_apart(&written)?;
        let [one, two, three, four, five] = written;
        let arrays =
            [Region::read("objects", objects, object_count as usize), Region::read("params", params, 1)];
        let models = shared.iter().flat_map(Shared::regions).map(|region| region.named("objects"));
        let read = arrays.into_iter().chain(models).chain(supporter.regions());
        for read in read.chain(request.regions()).chain(hung.regions()) {
            keep_apart(&[one, two, three, four, five, read])?;
        }
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (params, monitor, many, memory) = unsafe {
            (
                input(params)?.to_core()?,
                monitor::of(monitor)?,
                output(many)?,
                caller_memory(memory.cast(), memory_size)?,
            )
        };
        if !params.settle {
            return Err(Failure::NotSettled);
        }
        check("poses", poses.cast_const())?;
        let hung = hung.list();
        // SAFETY: the caller vouches for the arrays, which are apart from what is written.
        let symmetries = unsafe { request.symmetries() }?;
        // SAFETY: as above.
        let request = unsafe { request.check(&hung, symmetries.as_deref()) }?;
        let supporter = supporter.model();
        let models: heapless::Vec<&Object, HANGPOSE_MAX_HUNG> = shared.iter().map(Shared::model).collect();
        let count = object_count as usize;
        let needed = slot_bytes::<HangingPose>(count).saturating_add(predict_bytes(&supporter.limits()));
        check_room(memory, needed)?;
        let (slots, memory) = slots(memory, count);
        let none = Monitor::new();
        let found =
            predict_many(&models, supporter, &request, &params, slots, memory, monitor.unwrap_or(&none))?;
        for (index, pose) in slots.iter().enumerate() {
            let pose = pose.as_ref().map_or(hangpose_pose::NONE, hangpose_pose::from);
            // SAFETY: aligned, not null, and `index` is below the count that the caller vouches for.
            unsafe { poses.add(index).write(pose) };
        }
        *many = (&found).into();
        Ok(match (found.stopped, found.placed) {
            (Some(stop), _) => stopped(Some(stop)),
            (None, 0) => HANGPOSE_REJECTED,
            (None, _) => HANGPOSE_OK,
        })
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, call) }
}

/// The objects of an array, each in use as long as this exists.
///
/// # Safety
///
/// The obligations of the caller, see `border`.
unsafe fn share<'a>(
    objects: *const *const hangpose_object,
    count: u32,
) -> Result<heapless::Vec<Shared<'a, Object<'static>>, HANGPOSE_MAX_HUNG>, Failure> {
    if count == 0 || count as usize > HANGPOSE_MAX_HUNG {
        return Err(Failure::Count { field: "object_count", count: count as usize, most: HANGPOSE_MAX_HUNG });
    }
    // SAFETY: those of this function.
    let objects = unsafe { elements("objects", objects, count) }?;
    let share = |(index, object): (usize, &*const hangpose_object)| {
        // SAFETY: those of this function.
        let shared = unsafe { ObjectHandle::share(object.cast()) };
        shared.map_err(|failure| Failure::Listed { index, fault: ObjectFault::of(&failure) })
    };
    let mut all = heapless::Vec::new();
    for object in objects.iter().enumerate() {
        // Their number was checked above.
        let _ = all.push(share(object)?);
    }
    Ok(all)
}

impl From<&Many> for hangpose_many {
    fn from(&Many { placed, rejection, stopped: stop, work }: &Many) -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            placed: placed as u32,
            stage: rejection.map_or(HANGPOSE_STAGE_NONE, |rejection| stage(rejection.stage)),
            stopped: stopped(stop),
            rays: work.rays,
            distance_queries: work.distance_queries,
        }
    }
}
