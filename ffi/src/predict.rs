use crate::border::{
    DETAIL, Public, Region, check, check_size, input, keep_apart, memory as caller_memory, optional_input,
    output, report,
};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::monitor::{self, hangpose_monitor};
use crate::object::{ObjectHandle, hangpose_object};
use crate::params::hangpose_params;
use crate::pose::hangpose_pose;
use crate::request::{HungObjects, hangpose_request};
use crate::slots::{check_room, slot_bytes, slots};
use crate::status::*;
use crate::supporter::{SupporterHandle, hangpose_supporter};
use core::ffi::c_void;
use hangpose_core::Monitor;
use hangpose_core::hanging::contacts::CandidateCounts;
use hangpose_core::hanging::sites::MatchingCounts;
use hangpose_core::hanging::{HangingPose, Prediction, SearchCounts, SettlingCounts, predict, predict_bytes};

/// Result of hangpose_predict beside the poses: the number of candidates left after each step of the method, and
/// the work done. The fields matching_* are 0 with HANGPOSE_CANDIDATES_CONTACTS.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_prediction {
    /// sizeof(hangpose_prediction), set by the caller.
    pub struct_size: u32,
    /// Number of poses written.
    pub pose_count: u32,
    /// The step that left no pose, one of HANGPOSE_STAGE_*; hangpose_stage_string gives a text.
    pub stage: hangpose_stage,
    /// HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT if this call or the analysis of one of its models ended early,
    /// else HANGPOSE_OK.
    pub stopped: hangpose_status,
    /// With HANGPOSE_CANDIDATES_SITES: number of pairs of a hanging site and a support site.
    pub matching_pairs: u32,
    /// Number of pairs in which the support fits into the free space.
    pub matching_fitting: u32,
    /// Number of poses, two for each fitting pair, with no more collisions than allowed. Poses that are certain to
    /// be outranked are neither completed nor counted.
    pub matching_clear: u32,
    /// With HANGPOSE_CANDIDATES_CONTACTS: number of poses that bring a contact candidate of the object onto one of
    /// the supporter.
    pub settling_candidates: u32,
    /// Number of these candidates that are clear of the supporter, or could be moved clear of it.
    pub settling_clear: u32,
    /// Number of poses whose release was simulated.
    pub settling_released: u32,
    /// Number of releases after which the object rotated off.
    pub settling_rotated_off: u32,
    /// Number of releases after which the object slid off or fell through.
    pub settling_slid_off: u32,
    /// Number of releases after which the object still moved after 3 s, the settle time.
    pub settling_moving: u32,
    /// Number of releases after which the object came to rest.
    pub settling_at_rest: u32,
    /// Number of releases after which the object came to rest but is wedged: it would not come off again.
    pub settling_wedged: u32,
    /// Number of releases that came to rest in a pose that would be probable enough if what no camera has seen were known to be
    /// as it is guessed.
    pub settling_unseen: u32,
    /// Number of different rest poses with at least hangpose_params.min_probability, with those that gave way to a better one.
    pub settling_probable: u32,
    /// Number of firm releases, see hangpose_params.firm_enough.
    pub settling_firm: u32,
    /// Number of firm releases that hang in a way that is preferred: hangpose_request.prefer.
    pub settling_firm_as_preferred: u32,
    /// Number of poses that touch the scene or an object that hangs already.
    pub settling_in_scene: u32,
    /// Number of rest poses that hang on or by another region than was asked for, and 1 if the regions have no place
    /// for any.
    pub settling_outside: u32,
    /// Number of rest poses that hang in a way that is not allowed.
    pub settling_other_kind: u32,
    /// Number of poses that would stay, but have no way in the direction that was asked for.
    pub settling_no_approach: u32,
    /// Number of releases that came to rest in a pose that would be probable enough if the supporter's points were closer
    /// together.
    pub settling_sparse: u32,
    /// Number of rays cast.
    pub rays: u64,
    /// Number of distance and inside-outside queries.
    pub distance_queries: u64,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_prediction {
    const NAME: &'static str = "prediction";
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_pose {
    const NAME: &'static str = "poses";
}

/// Finds poses in which `object` hangs on `supporter` as `request` asks and writes the best to `poses`, best first.
/// Both models must have been analysed with these `params`. `request` may be null: anything anywhere.
///
/// `memory` is working memory of at least hangpose_predict_bytes, needed during the call only. `monitor` may be
/// null. `poses` is an array of `pose_capacity` structs, at least 1; a larger capacity may take more time.
/// `pose_size` is sizeof(hangpose_pose). Set prediction->struct_size before the call; prediction->pose_count is the
/// number of poses written. Concurrent calls may share the models, `request` and `params`, and need their own `memory`,
/// `poses`, `prediction` and `detail`.
///
/// Returns HANGPOSE_OK with at least one pose; HANGPOSE_REJECTED with none, and prediction->stage gives the reason;
/// HANGPOSE_CANCELLED or HANGPOSE_WORK_LIMIT with the best poses found so far, possibly none; or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_predict(
    object: *const hangpose_object,
    supporter: *const hangpose_supporter,
    request: *const hangpose_request,
    params: *const hangpose_params,
    memory: *mut c_void,
    memory_size: usize,
    monitor: *mut hangpose_monitor,
    poses: *mut hangpose_pose,
    pose_size: usize,
    pose_capacity: u32,
    prediction: *mut hangpose_prediction,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let call = || {
        let anything = hangpose_request::any();
        // SAFETY: the caller vouches for the pointers.
        let (object, supporter, request) = unsafe {
            (
                ObjectHandle::share(object.cast())?,
                SupporterHandle::share(supporter.cast())?,
                optional_input(request)?.unwrap_or(&anything),
            )
        };
        // SAFETY: as above.
        let hung = unsafe { HungObjects::of(request) }?;
        check_size::<hangpose_pose>(pose_size)?;
        let ([object_handle, object_arena], [supporter_handle, supporter_arena]) =
            (object.regions(), supporter.regions());
        let [one, two, three, four, five] = [
            Region::written(DETAIL, detail, 1),
            Region::written("memory", memory.cast::<u8>(), memory_size),
            Region::written("poses", poses, pose_capacity as usize),
            Region::written("prediction", prediction, 1),
            Region::written("monitor", monitor, 1),
        ];
        keep_apart(&[
            one,
            two,
            three,
            four,
            five,
            Region::read("params", params, 1),
            object_handle,
            object_arena,
            supporter_handle,
            supporter_arena,
        ])?;
        for read in request.regions().chain(hung.regions()) {
            keep_apart(&[one, two, three, four, five, read])?;
        }
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (params, monitor, prediction, memory) = unsafe {
            (
                input(params)?.to_core()?,
                monitor::of(monitor)?,
                output(prediction)?,
                caller_memory(memory.cast(), memory_size)?,
            )
        };
        check("poses", poses.cast_const())?;
        if pose_capacity == 0 {
            return Err(Failure::Count { field: "pose_capacity", count: 0, most: u32::MAX as usize });
        }
        let hung = hung.list();
        // SAFETY: the caller vouches for the arrays, which are apart from what is written.
        let symmetries = unsafe { request.symmetries() }?;
        // SAFETY: as above.
        let request = unsafe { request.check(&hung, symmetries.as_deref()) }?;
        let (object, supporter) = (object.model(), supporter.model());
        let count = pose_capacity as usize;
        let needed = slot_bytes::<HangingPose>(count).saturating_add(predict_bytes(&supporter.limits()));
        check_room(memory, needed)?;
        let (slots, memory) = slots(memory, count);
        let none = Monitor::new();
        let found = predict(object, supporter, &request, &params, slots, memory, monitor.unwrap_or(&none))?;
        for (index, pose) in found.poses.iter().enumerate() {
            // SAFETY: aligned, not null, and `index` is below the capacity that the caller vouches for.
            unsafe { poses.add(index).write(pose.into()) };
        }
        *prediction = (&found).into();
        Ok(match (found.stopped, found.poses) {
            (Some(stop), _) => stopped(Some(stop)),
            (None, []) => HANGPOSE_REJECTED,
            (None, _) => HANGPOSE_OK,
        })
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, call) }
}

impl From<&Prediction<'_>> for hangpose_prediction {
    fn from(found: &Prediction) -> Self {
        let (matching, candidates) = match found.counts.search {
            SearchCounts::Sites(counts) => (counts.matching, CandidateCounts::default()),
            SearchCounts::Contacts(counts) => (MatchingCounts::default(), counts.candidates),
        };
        let MatchingCounts { pairs, fitting, clear: matching_clear } = matching;
        let CandidateCounts { made, clear } = candidates;
        let SettlingCounts {
            released,
            rotated_off,
            slid_off,
            moving,
            at_rest,
            wedged,
            unseen,
            sparse,
            probable,
            firm,
            firm_as_preferred,
            in_scene,
            outside,
            other_kind,
            no_approach,
        } = found.counts.settling;
        Self {
            struct_size: size_of::<Self>() as u32,
            pose_count: found.poses.len() as u32,
            stage: found.rejection.map_or(HANGPOSE_STAGE_NONE, |rejection| stage(rejection.stage)),
            stopped: stopped(found.stopped),
            matching_pairs: pairs as u32,
            matching_fitting: fitting as u32,
            matching_clear: matching_clear as u32,
            settling_candidates: made as u32,
            settling_clear: clear as u32,
            settling_released: released as u32,
            settling_rotated_off: rotated_off as u32,
            settling_slid_off: slid_off as u32,
            settling_moving: moving as u32,
            settling_at_rest: at_rest as u32,
            settling_wedged: wedged as u32,
            settling_unseen: unseen as u32,
            settling_probable: probable as u32,
            settling_firm: firm as u32,
            settling_firm_as_preferred: firm_as_preferred as u32,
            settling_in_scene: in_scene as u32,
            settling_outside: outside as u32,
            settling_other_kind: other_kind as u32,
            settling_no_approach: no_approach as u32,
            settling_sparse: sparse as u32,
            rays: found.work.rays,
            distance_queries: found.work.distance_queries,
        }
    }
}
