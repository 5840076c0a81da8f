use crate::failure::Reason;
use crate::place::Place;
use crate::status::{hangpose_status, status_text};
use core::ffi::c_char;
use core::fmt::Write;

/// Value of an index that does not apply.
pub const HANGPOSE_NO_INDEX: u32 = 0xFFFF_FFFF;
/// Length of hangpose_detail.field in characters, with the terminating NUL.
pub const HANGPOSE_FIELD_CHARS: usize = 64;
/// Length of hangpose_detail.message in characters, with the terminating NUL.
pub const HANGPOSE_MESSAGE_CHARS: usize = 256;

/// Diagnosis of a call: the argument or field that is wrong, its value and its valid range. Every function that can
/// fail takes a pointer to one, which may be null, and writes it on success too. Concurrent calls need one each.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_detail {
    /// sizeof(hangpose_detail), set by the caller.
    pub struct_size: u32,
    /// The status that the call returned.
    pub status: hangpose_status,
    /// Index of the wrong vertex, triangle, point, image or other element of an array, or HANGPOSE_NO_INDEX.
    pub index: u32,
    /// The wrong value; NaN if it is not a number or does not apply.
    pub value: f64,
    /// Least valid value; NaN if there is no range.
    pub minimum: f64,
    /// Greatest valid value; NaN if there is no range.
    pub maximum: f64,
    /// Name of the wrong argument or field, such as "params.radius_ratio" or "memory", or "".
    pub field: [c_char; HANGPOSE_FIELD_CHARS],
    /// A sentence for people: what is wrong and how to correct it.
    pub message: [c_char; HANGPOSE_MESSAGE_CHARS],
}

impl hangpose_detail {
    /// Fills in the detail of a successful call.
    pub(crate) fn answer(&mut self, status: hangpose_status) {
        self.set(status, Place::default(), &status_text(status).to_str().unwrap_or_default());
    }

    /// Fills in the detail of a failed call, which did nothing.
    pub(crate) fn failure<R: Reason>(&mut self, reason: &R) {
        self.set(reason.status(), reason.place(), reason);
    }

    fn set(&mut self, status: hangpose_status, place: Place, message: &dyn core::fmt::Display) {
        self.status = status;
        self.index = place.index.map_or(HANGPOSE_NO_INDEX, |index| index as u32);
        self.value = place.value.unwrap_or(f64::NAN);
        [self.minimum, self.maximum] = place.range.unwrap_or([f64::NAN; 2]);
        print(&mut self.field, format_args!("{}{}", place.prefix, place.field));
        print(&mut self.message, format_args!("{message}"));
    }
}

/// Writes text and a NUL; characters beyond ASCII in UTF-8.
fn print(to: &mut [c_char], text: core::fmt::Arguments) {
    let mut writer = Writer { to, used: 0 };
    // Fails only if the text does not fit. It is then truncated; a test checks that the longest messages fit.
    let _ = writer.write_fmt(text);
    let Writer { to, used } = writer;
    if let Some(end) = to.get_mut(used) {
        *end = 0;
    }
}

struct Writer<'a> {
    to: &'a mut [c_char],
    used: usize,
}

impl Write for Writer<'_> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let free = self.to.get_mut(self.used..).unwrap_or_default();
        let room = free.len().saturating_sub(1);
        let fits = (0..=room.min(text.len())).rev().find(|&end| text.is_char_boundary(end)).unwrap_or(0);
        for (slot, byte) in free.iter_mut().zip(text.bytes().take(fits)) {
            *slot = byte as c_char;
        }
        self.used += fits;
        if fits == text.len() { Ok(()) } else { Err(core::fmt::Error) }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::failure::{Failure, HungFault, ObjectFault};
    use hangpose_core::ParamsError;
    use hangpose_core::geometry::{CloudError, MeshError};
    use hangpose_core::hanging::{RegionError, RequestError};
    use hangpose_core::motion::MotionError;
    use std::string::ToString;

    #[test]
    fn the_longest_messages_fit() {
        let request = |error| Failure::Request { error, spot: Place::default().into() };
        let (most, worst) = (usize::MAX, [-1.175_494_4e-38_f32; 3]);
        for failure in [
            Failure::StructSize { argument: "supporter memory", given: most, expected: most },
            Failure::Version { given: u32::MAX },
            Failure::Memory { argument: "prediction memory", needed: most, given: most },
            Failure::Overlap { written: "prediction", other: "the object's memory" },
            Failure::Handle { argument: "supporter", maker: "hangpose_supporter_create" },
            Failure::Choice { field: "params.centre_of_mass", value: u32::MAX, most: u32::MAX },
            Failure::Count { field: "mesh.triangle_count", count: most, most },
            Failure::Index { argument: "index", index: u32::MAX, count: most },
            MeshError::TooLarge { count: most, limit: most }.into(),
            MeshError::Coordinate { vertex: most, position: worst }.into(),
            MeshError::Index { triangle: most, vertex: u32::MAX, vertices: most }.into(),
            MeshError::Viewpoint { viewpoint: usize::MAX, position: worst }.into(),
            MeshError::AllDegenerate { triangles: most }.into(),
            CloudError::TooLarge { count: most, limit: most }.into(),
            CloudError::Normal { point: most, normal: worst }.into(),
            CloudError::Viewpoint { viewpoint: usize::MAX, position: worst }.into(),
            CloudError::Region { low: worst, high: worst }.into(),
            ParamsError::Gravity { gravity: worst }.into(),
            ParamsError::CentreOfMass { point: worst }.into(),
            Failure::NoDistanceField,
            Failure::ManyHung { count: u32::MAX },
            Failure::Listed { index: most, fault: ObjectFault::Handle },
            Failure::NotSettled,
            Failure::Hung { index: most, fault: HungFault::Object(ObjectFault::Handle) },
            Failure::Hung { index: most, fault: HungFault::Position(worst) },
            Failure::Hung { index: most, fault: HungFault::Quaternion([worst[0]; 4]) },
            request(RequestError::NothingAllowed),
            request(RequestError::On(RegionError::Empty)),
            request(RequestError::On(RegionError::Number)),
            request(RequestError::On(RegionError::Index { index: u32::MAX, count: most })),
            request(RequestError::Approach),
            request(RequestError::Scene { point: most, position: worst }),
            request(RequestError::Hung { index: most }),
            request(RequestError::Distinct),
            request(RequestError::Symmetry { index: most }),
            Failure::Motion(MotionError::Start),
            Failure::Motion(MotionError::Part { part: most }),
            Failure::Motion(MotionError::Retreat),
            Failure::Motion(MotionError::Workspace),
            Failure::Motion(MotionError::Value {
                name: "speed.angular_acceleration",
                value: worst[0],
                min: worst[0],
                max: worst[0],
            }),
            Failure::Motion(MotionError::Count { name: "samples", value: most, min: most, max: most }),
            Failure::Pose { spot: Place::of("goal.rest_quaternion").into() },
            Failure::NoGoal { value: u32::MAX },
            Failure::HungWithoutField { index: most },
            Failure::Waypoints { needed: most, given: most },
        ] {
            let text = failure.to_string();
            assert!(text.len() < HANGPOSE_MESSAGE_CHARS, "{} bytes: {text}", text.len());
            let Place { prefix, field, .. } = failure.place();
            assert!(prefix.len() + field.len() < HANGPOSE_FIELD_CHARS, "{prefix}{field}");
        }
    }

    #[test]
    fn text_is_cut_between_characters() {
        let mut room = [1; 4];
        print(&mut room, format_args!("a{}é", "b"));
        assert_eq!(room.map(|c| c as u8), *b"ab\0\x01");
        print(&mut room, format_args!("aé"));
        assert_eq!(room.map(|c| c as u8), *b"a\xc3\xa9\0");
    }
}
