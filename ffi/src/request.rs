use crate::border::{DETAIL, Public, Region, check, check_size, elements, inputs, keep_apart, report, rows};
use crate::detail::hangpose_detail;
use crate::failure::{Failure, HungFault, ObjectFault};
use crate::handle::Shared;
use crate::kind::{hangpose_kind, kinds, mask};
use crate::object::{HANGPOSE_MAX_FOLD, ObjectHandle, hangpose_object, hangpose_symmetry};
use crate::place::Place;
use crate::pose::pose_of;
use crate::region::{BY, ON, hangpose_region, region_place};
use crate::status::*;
use core::f32::consts::PI;
use hangpose_core::geometry::{MAX_COORDINATE, Pose, Symmetry};
use hangpose_core::hanging::{Approach, Distance, Hung, MAX_HUNG, Object, Request, RequestError};

/// Greatest number of objects that hang already, hangpose_request.hung_count, and of objects that hang at once, those
/// of hangpose_predict_many included. Of more, pass points of their surfaces as hangpose_request.scene_points.
pub const HANGPOSE_MAX_HUNG: usize = 32;
/// Greatest number of symmetries that are given, hangpose_request.symmetry_count.
pub const HANGPOSE_MAX_SYMMETRIES: usize = 8;

const _: () = assert!(HANGPOSE_MAX_HUNG == MAX_HUNG);

/// An object that hangs already. Part of hangpose_request.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_hung {
    /// The object. The object that is to be hung may hang already, too.
    pub object: *const hangpose_object,
    /// Its pose: x, y, z of its origin, metres, in supporter coordinates, each within +-1,000,000.
    pub position: [f32; 3],
    /// Its pose: x, y, z, w of the quaternion that rotates object coordinates into supporter coordinates; any length
    /// but zero.
    pub quaternion: [f32; 4],
}

/// What hangpose_predict and hangpose_predict_many look for: how and where the object hangs, and what it must not touch.
/// Set the struct with hangpose_request_init, then change single fields. The library keeps no pointer to the arrays after
/// the call. With hangpose_params.settle = 0 only the regions count, and these only with HANGPOSE_CANDIDATES_CONTACTS.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_request {
    /// sizeof(hangpose_request), set by hangpose_request_init.
    pub struct_size: u32,
    /// The kinds that are given at all: HANGPOSE_KIND_*, joined with |, at least one. Default: HANGPOSE_KIND_ALL.
    pub allow: hangpose_kind,
    /// The kinds that come first: HANGPOSE_KIND_*, joined with |, or 0. Of the others, HANGPOSE_KIND_CAPPED comes
    /// before HANGPOSE_KIND_BALANCED. A pose of a kind that comes later is ranked before one that comes first only if
    /// it is much more probable. Default: HANGPOSE_KIND_THREADED | HANGPOSE_KIND_HOOKED.
    pub prefer: hangpose_kind,
    /// 1 if the object must come to its release pose on a straight way without a collision, as the next three fields
    /// say; 0, the default, for any way.
    pub has_approach: u32,
    /// x, y, z of the direction in which the object moves, in supporter coordinates; any length but zero.
    pub approach_direction: [f32; 3],
    /// Largest angle between the way and approach_direction, radians; 0 to pi.
    pub approach_angle: f32,
    /// Length of the way that is free, metres; 0 to 10.
    pub approach_length: f32,
    /// Two poses of the same kind differ by this distance of the centres of mass or by distinct_rotation, or by more,
    /// whichever way the object is turned by its symmetries; metres; 0 to 10. Default: 0.02.
    pub distinct_position: f32,
    /// Angle of the rotation from one pose to the other, radians; 0 to pi. Default: 0.35.
    pub distinct_rotation: f32,
    /// Number of points of the scene; 0, the default, if there are none.
    pub scene_point_count: u32,
    /// Number of objects that hang already; 0, the default, to HANGPOSE_MAX_HUNG.
    pub hung_count: u32,
    /// 1 if the object has the symmetries in the array `symmetries` and no others; 0, the default, for those that were
    /// detected, see hangpose_object_get_symmetry. Poses that differ by a symmetry, or by two about different axes one
    /// after the other, are one pose.
    pub has_symmetries: u32,
    /// Number of symmetries, 0 to HANGPOSE_MAX_SYMMETRIES. With has_symmetries = 1, 0 says that the object has none.
    pub symmetry_count: u32,
    /// The part of the supporter that carries the object: at least half of its weight rests there. In supporter
    /// coordinates. Default: everywhere.
    pub on: hangpose_region,
    /// The part of the object by which it hangs: at least half of its weight rests on it. In object coordinates.
    /// Default: everywhere.
    pub by: hangpose_region,
    /// Array of scene_point_count rows of x, y, z: points of things near the supporter, metres, in supporter
    /// coordinates, each within +-1,000,000. The object does not touch them and never hangs on them. They are not
    /// simulated. May be null if scene_point_count is 0.
    pub scene_points: *const f32,
    /// Array of hung_count objects that hang on the supporter already. As the scene, with their exact shapes. May be
    /// null if hung_count is 0.
    pub hung: *const hangpose_hung,
    /// Array of symmetry_count symmetries. May be null if symmetry_count is 0.
    pub symmetries: *const hangpose_symmetry,
}

// SAFETY: `repr(C)` over numbers and pointers, `struct_size` first.
unsafe impl Public for hangpose_request {
    const NAME: &'static str = "request";
}

/// Sets `request` to anything anywhere, as a null request of hangpose_predict. `struct_size` is
/// sizeof(hangpose_request). Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_request_init(
    request: *mut hangpose_request,
    struct_size: usize,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let init = || {
        check_size::<hangpose_request>(struct_size)?;
        keep_apart(&[Region::written(DETAIL, detail, 1), Region::written("request", request, 1)])?;
        check(hangpose_request::NAME, request.cast_const())?;
        // SAFETY: not null, aligned, and of the size that the caller vouches for.
        unsafe { request.write(hangpose_request::any()) };
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, init) }
}

impl hangpose_request {
    /// Anything anywhere.
    pub(crate) fn any() -> Self {
        let Request { allow, prefer, distinct, .. } = Request::ANY;
        Self {
            struct_size: size_of::<Self>() as u32,
            allow: mask(allow),
            prefer: mask(prefer),
            has_approach: 0,
            approach_direction: [0.0; 3],
            approach_angle: 0.0,
            approach_length: 0.0,
            distinct_position: distinct.position,
            distinct_rotation: distinct.rotation,
            scene_point_count: 0,
            hung_count: 0,
            has_symmetries: 0,
            symmetry_count: 0,
            on: hangpose_region::EVERYWHERE,
            by: hangpose_region::EVERYWHERE,
            scene_points: core::ptr::null(),
            hung: core::ptr::null(),
            symmetries: core::ptr::null(),
        }
    }

    /// The symmetries that are given, if any are.
    ///
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    pub(crate) unsafe fn symmetries(
        &self,
    ) -> Result<Option<heapless::Vec<Symmetry, HANGPOSE_MAX_SYMMETRIES>>, Failure> {
        const COUNT: &str = "request.symmetry_count";
        match (self.has_symmetries, self.symmetry_count as usize) {
            (0, _) => Ok(None),
            (1, 0) => Ok(Some(heapless::Vec::new())),
            (1, count) if count > HANGPOSE_MAX_SYMMETRIES => {
                Err(Failure::Count { field: COUNT, count, most: HANGPOSE_MAX_SYMMETRIES })
            }
            (1, _) => {
                check(SYMMETRIES, self.symmetries)?;
                // SAFETY: those of this function.
                let given = unsafe { inputs(COUNT, self.symmetries, self.symmetry_count) }?;
                let to_core =
                    |given: &hangpose_symmetry| Symmetry { axis: given.axis.into(), fold: given.fold };
                Ok(Some(given.iter().map(to_core).collect()))
            }
            (value, _) => Err(Failure::Choice { field: "request.has_symmetries", value, most: 1 }),
        }
    }

    /// The request as the core takes it, each value checked. `hung` is what [`HungObjects::list`] gives for it, and
    /// `symmetries` what [`symmetries`](Self::symmetries) does.
    ///
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    pub(crate) unsafe fn check<'a>(
        &'a self,
        hung: &'a [Hung<'a>],
        symmetries: Option<&'a [Symmetry]>,
    ) -> Result<Request<'a>, Failure> {
        let approach = match self.has_approach {
            0 => None,
            1 => Some(Approach {
                direction: self.approach_direction,
                angle: self.approach_angle,
                length: self.approach_length,
            }),
            value => return Err(Failure::Choice { field: "request.has_approach", value, most: 1 }),
        };
        // SAFETY: those of this function.
        let (on, by, scene) = unsafe {
            (
                self.on.check(&ON)?,
                self.by.check(&BY)?,
                rows("request.scene_points", self.scene_points, self.scene_point_count)?,
            )
        };
        let request = Request {
            allow: kinds("request.allow", self.allow)?,
            prefer: kinds("request.prefer", self.prefer)?,
            on,
            by,
            approach,
            scene,
            hung,
            distinct: Distance { position: self.distinct_position, rotation: self.distinct_rotation },
            symmetries,
            watch: None,
        };
        match request.validate() {
            Ok(()) => Ok(request),
            Err(error) => Err(Failure::Request { error, spot: request_place(error, &request).into() }),
        }
    }

    /// The struct and its arrays.
    pub(crate) fn regions(&self) -> impl Iterator<Item = Region> {
        let scene = Region::read(
            "request.scene_points",
            self.scene_points.cast::<[f32; 3]>(),
            self.scene_point_count as usize,
        );
        let hung = Region::read("request.hung", self.hung, self.hung_count as usize);
        let symmetries = Region::read(SYMMETRIES, self.symmetries, self.symmetry_count as usize);
        let own = [Region::read("request", self, 1), scene, hung, symmetries];
        own.into_iter().chain(self.on.regions(&ON)).chain(self.by.regions(&BY))
    }
}

/// Name of the array of symmetries in messages.
const SYMMETRIES: &str = "request.symmetries";

/// The objects of a request that hang already, each in use as long as this exists.
pub(crate) struct HungObjects<'a>(heapless::Vec<(Shared<'a, Object<'static>>, Pose), HANGPOSE_MAX_HUNG>);

impl<'a> HungObjects<'a> {
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    pub(crate) unsafe fn of(request: &hangpose_request) -> Result<Self, Failure> {
        let hung = match request.hung_count {
            0 => &[],
            count if count as usize > HANGPOSE_MAX_HUNG => return Err(Failure::ManyHung { count }),
            // SAFETY: those of this function.
            count => unsafe { elements("request.hung", request.hung, count) }?,
        };
        // SAFETY: those of this function.
        let share = |hung: &hangpose_hung| unsafe { hung.share() };
        let mut objects = heapless::Vec::new();
        for (index, hung) in hung.iter().enumerate() {
            // Their number was checked above.
            let _ = objects.push(share(hung).map_err(|fault| Failure::Hung { index, fault })?);
        }
        Ok(Self(objects))
    }

    /// The objects as the core takes them.
    pub(crate) fn list(&self) -> heapless::Vec<Hung<'_>, HANGPOSE_MAX_HUNG> {
        let mut hung = heapless::Vec::new();
        for (object, pose) in &self.0 {
            let _ = hung.push(Hung { object: object.model(), pose: *pose });
        }
        hung
    }

    /// The memory of the objects.
    pub(crate) fn regions(&self) -> impl Iterator<Item = Region> {
        self.0
            .iter()
            .flat_map(|(object, _)| object.regions())
            .map(|region| region.named("request.hung.object"))
    }
}

impl hangpose_hung {
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    unsafe fn share<'a>(&self) -> Result<(Shared<'a, Object<'static>>, Pose), HungFault> {
        let &Self { object, position, quaternion } = self;
        // SAFETY: those of this function.
        let object = unsafe { ObjectHandle::share(object.cast()) }
            .map_err(|failure| HungFault::Object(ObjectFault::of(&failure)))?;
        if !position.iter().all(|x| x.abs() <= MAX_COORDINATE) {
            return Err(HungFault::Position(position));
        }
        let pose = pose_of(position, quaternion).ok_or(HungFault::Quaternion(quaternion))?;
        Ok((object, pose))
    }
}

/// Greatest length in a request, metres; the core checks it.
const MAX_LENGTH: f32 = 10.0;

/// Where in a request the error is.
fn request_place(error: RequestError, request: &Request) -> Place {
    let outside =
        |field, value: f32, most: f32| Place::of(field).value(f64::from(value)).range([0.0, f64::from(most)]);
    match error {
        RequestError::NothingAllowed => {
            Place::of("request.allow").value(0.0).range([1.0, f64::from(crate::HANGPOSE_KIND_ALL)])
        }
        RequestError::On(error) => region_place(error, &request.on, &ON),
        RequestError::By(error) => region_place(error, &request.by, &BY),
        RequestError::Approach => match request.approach {
            Some(Approach { angle, .. }) if !(0.0..=PI).contains(&angle) => {
                outside("request.approach_angle", angle, PI)
            }
            Some(Approach { length, .. }) if !(0.0..=MAX_LENGTH).contains(&length) => {
                outside("request.approach_length", length, MAX_LENGTH)
            }
            _ => Place::of("request.approach_direction"),
        },
        RequestError::Scene { point, position } => {
            Place::of("request.scene_points").coordinate(Some(point), position)
        }
        RequestError::Hung { index } => Place { index: Some(index), ..Place::of("request.hung.position") },
        RequestError::Symmetry { index } => {
            let fold = request.symmetries.and_then(|given| given.get(index)).map_or(0, |given| given.fold);
            let place = if fold == 1 || fold > HANGPOSE_MAX_FOLD {
                outside("request.symmetries.fold", fold as f32, HANGPOSE_MAX_FOLD as f32)
            } else {
                Place::of("request.symmetries.axis")
            };
            Place { index: Some(index), ..place }
        }
        RequestError::Distinct => match request.distinct {
            Distance { position, .. } if !(0.0..=MAX_LENGTH).contains(&position) => {
                outside("request.distinct_position", position, MAX_LENGTH)
            }
            Distance { rotation, .. } => outside("request.distinct_rotation", rotation, PI),
        },
    }
}
