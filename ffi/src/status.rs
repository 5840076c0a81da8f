use core::ffi::{CStr, c_char};
use hangpose_core::Stop;
use hangpose_core::hanging::Stage;

/// Result of a call. 0: done. Above 0: a valid result that is not, or not only, poses or a path. Below 0: an error of the
/// caller; the call did nothing, and hangpose_detail says what to correct.
pub type hangpose_status = i32;

/// The call is done.
pub const HANGPOSE_OK: hangpose_status = 0;
/// No pose was found in which the object hangs; hangpose_prediction.stage names the step of the method that left
/// none.
pub const HANGPOSE_REJECTED: hangpose_status = 1;
/// hangpose_monitor_cancel was called. hangpose_predict returns the best poses found so far; a cancelled analysis
/// creates no model, and a cancelled change of a volume may have changed a part of it.
pub const HANGPOSE_CANCELLED: hangpose_status = 2;
/// The work limit of the monitor was reached, in this call or in the analysis of one of its models. The results
/// found so far are returned. hangpose_volume_integrate has none, and leaves the volume as it was.
pub const HANGPOSE_WORK_LIMIT: hangpose_status = 3;
/// No path was found to the pose, or to any of the poses; hangpose_plan.failure says why.
pub const HANGPOSE_NO_PATH: hangpose_status = 4;

/// A required pointer is null.
pub const HANGPOSE_ERROR_NULL: hangpose_status = -1;
/// A pointer is not aligned for its type. Memory for models and work may begin at any address.
pub const HANGPOSE_ERROR_MISALIGNED: hangpose_status = -2;
/// A struct_size is not the size of its struct: it was not set, or the program was compiled with another header.
pub const HANGPOSE_ERROR_STRUCT_SIZE: hangpose_status = -3;
/// The program was compiled with the header of another version of the library.
pub const HANGPOSE_ERROR_ABI_VERSION: hangpose_status = -4;
/// The memory is smaller than its size query requires.
pub const HANGPOSE_ERROR_MEMORY: hangpose_status = -5;
/// Memory that the call writes overlaps another argument.
pub const HANGPOSE_ERROR_OVERLAP: hangpose_status = -6;
/// A model or a monitor was never created, was moved, or was overwritten.
pub const HANGPOSE_ERROR_HANDLE: hangpose_status = -7;
/// A supporter or a volume cannot be changed while another thread uses it, or used while another thread changes it.
pub const HANGPOSE_ERROR_BUSY: hangpose_status = -8;
/// The supporter is empty because its last update was cancelled.
pub const HANGPOSE_ERROR_EMPTY: hangpose_status = -9;
/// A count is zero or above its maximum.
pub const HANGPOSE_ERROR_COUNT: hangpose_status = -10;
/// A number is outside its range, infinite or not a number.
pub const HANGPOSE_ERROR_VALUE: hangpose_status = -11;
/// An index refers to an element that does not exist.
pub const HANGPOSE_ERROR_INDEX: hangpose_status = -12;
/// Every triangle of the mesh has zero area.
pub const HANGPOSE_ERROR_DEGENERATE: hangpose_status = -13;
/// The params require a signed distance field, but the object was analysed with voxels = 0, or an object that hangs
/// already was.
pub const HANGPOSE_ERROR_NO_DISTANCE_FIELD: hangpose_status = -14;
/// The result does not fit into the caller's array or into the blocks of the volume. hangpose_detail.minimum is the
/// least capacity that may hold it.
pub const HANGPOSE_ERROR_CAPACITY: hangpose_status = -15;
/// Depth images show nothing: no pixel has a depth, or none that has one is of use.
pub const HANGPOSE_ERROR_BLANK: hangpose_status = -16;
/// A sparse volume does not know what is free, so it cannot be completed.
pub const HANGPOSE_ERROR_SPARSE: hangpose_status = -17;

/// The step of the method that left no pose, one of HANGPOSE_STAGE_*.
pub type hangpose_stage = u32;

/// No step: there are poses, or the search was stopped.
pub const HANGPOSE_STAGE_NONE: hangpose_stage = 0;
/// No part of the object's surface faces its centre of mass, or the parts that do are too small.
pub const HANGPOSE_STAGE_NO_CONTACT_POINTS: hangpose_stage = 1;
/// The object has no free space for a supporter beside its contact points.
pub const HANGPOSE_STAGE_NO_FREE_SPACE: hangpose_stage = 2;
/// The free spaces are open to the side, so a supporter would slip out.
pub const HANGPOSE_STAGE_NOT_ENCIRCLED: hangpose_stage = 3;
/// No part of the supporter faces up and holds together.
pub const HANGPOSE_STAGE_NO_SUPPORT: hangpose_stage = 4;
/// The supporter is too thick for every free space of the object.
pub const HANGPOSE_STAGE_TOO_THICK: hangpose_stage = 5;
/// The supporter penetrates the object in every pose.
pub const HANGPOSE_STAGE_ALL_COLLIDE: hangpose_stage = 6;
/// The released object rotates off the supporter, in all or most of the tried poses.
pub const HANGPOSE_STAGE_ROTATES_OFF: hangpose_stage = 7;
/// The released object slides off or falls through, in all or most of the tried poses.
pub const HANGPOSE_STAGE_SLIDES_OFF: hangpose_stage = 8;
/// The released object does not come to rest.
pub const HANGPOSE_STAGE_NEVER_RESTS: hangpose_stage = 9;
/// The object comes to rest, but a small disturbance would bring it down, it is wedged and would not come off again, or
/// there is no room to release it there.
pub const HANGPOSE_STAGE_TOO_LOOSE: hangpose_stage = 10;
/// The object comes to rest firmly enough, but too much of what would carry it or be in its way was not seen by any camera.
pub const HANGPOSE_STAGE_UNSEEN: hangpose_stage = 11;
/// The region that was asked for has no place to hang on or by, or the object comes to rest outside of it:
/// hangpose_request.on and hangpose_request.by.
pub const HANGPOSE_STAGE_OUTSIDE_REGION: hangpose_stage = 12;
/// The poses touch the scene or an object that hangs already: hangpose_request.scene_points and hangpose_request.hung.
pub const HANGPOSE_STAGE_IN_SCENE: hangpose_stage = 13;
/// The object stays, but hangs in another way than those that are allowed: hangpose_request.allow.
pub const HANGPOSE_STAGE_OTHER_KIND: hangpose_stage = 14;
/// The object stays, but no straight way in the direction that was asked for leads to the pose:
/// hangpose_request.has_approach.
pub const HANGPOSE_STAGE_NO_APPROACH: hangpose_stage = 15;

/// The object comes to rest firmly enough, but where the supporter would carry its points are so far apart that they hardly
/// tell its shape.
pub const HANGPOSE_STAGE_TOO_SPARSE: hangpose_stage = 16;

pub(crate) fn stage(stage: Stage) -> hangpose_stage {
    match stage {
        Stage::NoContactPoints => HANGPOSE_STAGE_NO_CONTACT_POINTS,
        Stage::NoFreeSpace => HANGPOSE_STAGE_NO_FREE_SPACE,
        Stage::NotEncircled => HANGPOSE_STAGE_NOT_ENCIRCLED,
        Stage::NoSupport => HANGPOSE_STAGE_NO_SUPPORT,
        Stage::TooThick => HANGPOSE_STAGE_TOO_THICK,
        Stage::AllCollide => HANGPOSE_STAGE_ALL_COLLIDE,
        Stage::RotatesOff => HANGPOSE_STAGE_ROTATES_OFF,
        Stage::SlidesOff => HANGPOSE_STAGE_SLIDES_OFF,
        Stage::NeverRests => HANGPOSE_STAGE_NEVER_RESTS,
        Stage::TooLoose => HANGPOSE_STAGE_TOO_LOOSE,
        Stage::Unseen => HANGPOSE_STAGE_UNSEEN,
        Stage::OutsideRegion => HANGPOSE_STAGE_OUTSIDE_REGION,
        Stage::InScene => HANGPOSE_STAGE_IN_SCENE,
        Stage::OtherKind => HANGPOSE_STAGE_OTHER_KIND,
        Stage::NoApproach => HANGPOSE_STAGE_NO_APPROACH,
        Stage::TooSparse => HANGPOSE_STAGE_TOO_SPARSE,
    }
}

/// HANGPOSE_OK if nothing stopped the call.
pub(crate) fn stopped(stop: Option<Stop>) -> hangpose_status {
    match stop {
        None => HANGPOSE_OK,
        Some(Stop::Cancelled) => HANGPOSE_CANCELLED,
        Some(Stop::WorkLimit) => HANGPOSE_WORK_LIMIT,
    }
}

/// Returns the meaning of a status in English; a static string, never null.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_status_string(status: hangpose_status) -> *const c_char {
    status_text(status).as_ptr()
}

/// Returns the meaning of a stage in English; a static string, never null.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_stage_string(stage: hangpose_stage) -> *const c_char {
    stage_text(stage).as_ptr()
}

pub(crate) fn status_text(status: hangpose_status) -> &'static CStr {
    match status {
        HANGPOSE_OK => c"done",
        HANGPOSE_REJECTED => c"nothing hangs",
        HANGPOSE_CANCELLED => c"cancelled",
        HANGPOSE_WORK_LIMIT => c"the work limit was reached",
        HANGPOSE_NO_PATH => c"no path was found",
        HANGPOSE_ERROR_NULL => c"a pointer is null",
        HANGPOSE_ERROR_MISALIGNED => c"a pointer is misaligned",
        HANGPOSE_ERROR_STRUCT_SIZE => c"a struct_size is wrong",
        HANGPOSE_ERROR_ABI_VERSION => c"the header and the library have different versions",
        HANGPOSE_ERROR_MEMORY => c"the memory is too small",
        HANGPOSE_ERROR_OVERLAP => c"arguments overlap in memory",
        HANGPOSE_ERROR_HANDLE => c"a handle is not valid",
        HANGPOSE_ERROR_BUSY => c"a model is in use by another thread",
        HANGPOSE_ERROR_EMPTY => c"the supporter is empty",
        HANGPOSE_ERROR_COUNT => c"a count is out of range",
        HANGPOSE_ERROR_VALUE => c"a value is out of range",
        HANGPOSE_ERROR_INDEX => c"an index is out of range",
        HANGPOSE_ERROR_DEGENERATE => c"every triangle has zero area",
        HANGPOSE_ERROR_NO_DISTANCE_FIELD => c"the object was analysed without voxels",
        HANGPOSE_ERROR_CAPACITY => c"the result does not fit",
        HANGPOSE_ERROR_BLANK => c"the depth images show nothing",
        HANGPOSE_ERROR_SPARSE => c"the volume is sparse",
        _ => c"unknown status",
    }
}

/// The text of the core, with the NUL that C needs.
pub(crate) fn stage_text(stage: hangpose_stage) -> &'static CStr {
    match stage {
        HANGPOSE_STAGE_NONE => c"nothing was rejected",
        HANGPOSE_STAGE_NO_CONTACT_POINTS => {
            c"the object has no surface that faces its centre of mass and could rest on a support"
        }
        HANGPOSE_STAGE_NO_FREE_SPACE => {
            c"the object has no free space for a supporter beside its contact points"
        }
        HANGPOSE_STAGE_NOT_ENCIRCLED => {
            c"the object encloses none of its free spaces, so a supporter would slip out"
        }
        HANGPOSE_STAGE_NO_SUPPORT => c"the supporter has no part that faces up",
        HANGPOSE_STAGE_TOO_THICK => {
            c"every part of the supporter that faces up is too thick for the object's free spaces"
        }
        HANGPOSE_STAGE_ALL_COLLIDE => c"in every pose the supporter penetrates the object",
        HANGPOSE_STAGE_ROTATES_OFF => c"no released pose stays: most often the object rotates off",
        HANGPOSE_STAGE_SLIDES_OFF => c"no released pose stays: most often the object slides off or falls through",
        HANGPOSE_STAGE_NEVER_RESTS => c"no released pose stays: most often the object is still moving when the time is up",
        HANGPOSE_STAGE_TOO_LOOSE => {
            c"no released pose stays: most often the object is wedged where it rests, or a small disturbance brings it down"
        }
        HANGPOSE_STAGE_UNSEEN => {
            c"poses stay only if what no camera has seen is as it is guessed, which is not likely enough: another view of the object or of the supporter would help"
        }
        HANGPOSE_STAGE_OUTSIDE_REGION => {
            c"the object could hang only outside the region that was asked for, or the region has no place to hang on or by"
        }
        HANGPOSE_STAGE_IN_SCENE => c"every pose touches the scene or an object that hangs already",
        HANGPOSE_STAGE_OTHER_KIND => c"poses stay, but none hangs in a way that was allowed",
        HANGPOSE_STAGE_NO_APPROACH => {
            c"poses stay, but no straight way in the direction that was asked for leads to any of them"
        }
        HANGPOSE_STAGE_TOO_SPARSE => {
            c"poses stay, but the supporter's points are too far apart to tell its shape: points at most 8 mm apart would help"
        }
        _ => c"unknown stage",
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn stages_say_what_the_core_says() {
        for core in [
            Stage::NoContactPoints,
            Stage::NoFreeSpace,
            Stage::NotEncircled,
            Stage::NoSupport,
            Stage::TooThick,
            Stage::AllCollide,
            Stage::RotatesOff,
            Stage::SlidesOff,
            Stage::NeverRests,
            Stage::TooLoose,
            Stage::Unseen,
            Stage::OutsideRegion,
            Stage::InScene,
            Stage::OtherKind,
            Stage::NoApproach,
            Stage::TooSparse,
        ] {
            assert_eq!(stage_text(stage(core)).to_str().unwrap(), core.to_string());
        }
    }

    #[test]
    fn every_status_has_words() {
        for status in -17..=4 {
            assert_ne!(status_text(status), c"unknown status", "{status}");
        }
        for status in [i32::MIN, -18, 5, i32::MAX] {
            assert_eq!(status_text(status), c"unknown status");
        }
    }
}
