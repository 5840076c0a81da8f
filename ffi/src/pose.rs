use crate::detail::HANGPOSE_NO_INDEX;
use crate::failure::Failure;
use crate::kind::{hangpose_kind, kind};
use crate::place::Place;
use hangpose_core::geometry::{MAX_COORDINATE, Pose, Vector};
use hangpose_core::hanging::HangingPose;
use hangpose_core::hanging::sites::{Cost, SiteMatch};
use hangpose_core::mechanics::{Contact, DIRECTIONS, MAX_CONTACTS, Margin};
use nalgebra::{Quaternion, UnitQuaternion};

/// Number of directions in which gravity is tilted.
pub const HANGPOSE_DIRECTIONS: usize = 8;
/// Greatest number of contacts in a pose.
pub const HANGPOSE_MAX_CONTACTS: usize = 8;

/// Deviation of the squared length of a quaternion from 1 that counts as rounding: some ulps. A pose that the library gave
/// keeps its bits when it comes back.
const UNIT_ROUNDING: f32 = 1e-6;

const _: () = assert!(HANGPOSE_DIRECTIONS == DIRECTIONS && HANGPOSE_MAX_CONTACTS == MAX_CONTACTS);

/// A contact at which the supporter carries the object, in supporter coordinates. Part of hangpose_pose.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_contact {
    /// x, y, z of the contact, metres.
    pub position: [f32; 3],
    /// x, y, z of the contact normal: the unit vector in which the supporter pushes.
    pub normal: [f32; 3],
    /// Normal force, in multiples of the object's weight.
    pub force: f32,
}

/// Stability margins of a rest pose. Part of hangpose_pose.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_margin {
    /// Tilt of gravity at which the object last touched the supporter before it left, radians, in each of eight
    /// horizontal directions, with 70 % of the friction; larger than the static limit, because leaving takes time. The first direction is the supporter's x axis, made perpendicular to gravity (the y axis if
    /// gravity is along x); the others follow counter-clockwise seen from above. At most 1.2, where the test ends;
    /// 0 for directions that were not tried because the tilt in an earlier one is too small for the pose to be of use.
    pub tilts: [f32; HANGPOSE_DIRECTIONS],
    /// Least of the tilts, radians.
    pub least_tilt: f32,
    /// Time that the object stays, seconds, after gravity tilts by 21.8 degrees at once in the direction of the
    /// least tilt, while only friction damps its swing. 1 if it is still there after 1 s; 0 if the test was skipped
    /// because the tilt in some direction is too small.
    pub jolt_time: f32,
    /// Greatest distance that the centre of mass sank, metres, while gravity tilted by up to 0.9 radians. An object
    /// that settles deeper when it is shaken does not rest firmly.
    pub tilted_sinking: f32,
    /// Least rise of the centre of mass, metres, over the escape paths that were found, an upper bound of the true
    /// least; the greatest rise seen if no escape was found, which bounds nothing.
    pub escape_rise: f32,
    /// escape_rise divided by the distance from the contacts to the centre of mass; no unit.
    pub escape_ratio: f32,
    /// Speed of a knock that would carry the centre of mass over escape_rise, metres per second.
    pub knock_speed: f32,
    /// Distance that the true centre of mass may be away from the assumed one, metres.
    pub centre_of_mass_radius: f32,
}

/// A pose in which the object hangs: the release pose, the rest pose to which gravity then takes the object, and
/// the sites that it matches.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_pose {
    /// sizeof(hangpose_pose), set by the library.
    pub struct_size: u32,
    /// 1 if there is a pose, as in all that hangpose_predict writes. 0 if hangpose_predict_many has none for the object:
    /// then all fields from here on are HANGPOSE_NO_INDEX, NaN or 0.
    pub has_pose: u32,
    /// Release pose: x, y, z of the origin of the object, metres, in supporter coordinates.
    pub position: [f32; 3],
    /// Release pose: x, y, z, w of the unit quaternion that rotates object coordinates into supporter coordinates.
    pub quaternion: [f32; 4],

    /// 1 with hangpose_params.settle. Else 0, and all fields from here to `contacts` are NaN or 0.
    pub has_rest: u32,
    /// How the object hangs, one of HANGPOSE_KIND_*.
    pub kind: hangpose_kind,
    /// Probability that the object hangs and stays, 0 to 1.
    pub probability: f32,
    /// Probability that it also stays when gravity tilts by 21.8 degrees towards any side, 0 to 1. Among poses that are sure to
    /// hang it tells which is the firmest.
    pub robustness: f32,
    /// Share of the directions from which no camera looked at the object, 0 to 1: the same for all poses. This and the next
    /// two are 0 if no viewpoints are given, and lower the probability.
    pub unseen_object: f32,
    /// Share of the supporter near the object that is in the shadow of the object's mesh, 0 to 1: no camera saw that the
    /// object is not there. Another view of the object would then say more.
    pub unseen_shadow: f32,
    /// Share of the supporter close to the object that no camera saw and that was guessed, 0 to 1. Another view of the
    /// supporter would then say more.
    pub unseen_supporter: f32,
    /// Direction from the object, in its coordinates, in which a camera would see most of what no camera saw: a unit vector,
    /// or 0, 0, 0.
    pub object_view: [f32; 3],
    /// Direction from the supporter, in its coordinates, in which a camera would see most of what was guessed close to the
    /// object: a unit vector, or 0, 0, 0.
    pub supporter_view: [f32; 3],
    /// Rest pose: x, y, z of the origin of the object, metres, in supporter coordinates.
    pub rest_position: [f32; 3],
    /// Rest pose: x, y, z, w of the unit quaternion that rotates object coordinates into supporter coordinates.
    pub rest_quaternion: [f32; 4],
    /// Distance that the centre of mass sinks from the release pose to the rest pose, metres.
    pub sinking: f32,
    /// Distance between object and supporter in the release pose, metres: hangpose_params.clearance, or less if
    /// there is no room.
    pub clearance: f32,
    /// Distance that the object may be away from the release pose in any direction when it is let go, metres: it still
    /// touches nothing, and comes to rest as it would have. This error and the next add up: half of either is fine
    /// together.
    pub tolerance_position: f32,
    /// Angle about the centre of mass by which the object may be rotated away from the release pose, radians.
    pub tolerance_rotation: f32,
    /// Stability margins of the rest pose.
    pub margin: hangpose_margin,
    /// Number of valid contacts; the others are 0.
    pub contact_count: u32,
    /// Contacts at which the supporter carries the object in the rest pose.
    pub contacts: [hangpose_contact; HANGPOSE_MAX_CONTACTS],

    /// 1 with HANGPOSE_CANDIDATES_SITES. Else 0, and all fields from here on are HANGPOSE_NO_INDEX, NaN or 0.
    pub is_matched: u32,
    /// Index of the hanging site, for hangpose_object_get_site.
    pub object_site: u32,
    /// Index of the support site, for hangpose_supporter_get_site.
    pub support_site: u32,
    /// 1 if the hanging direction of the object is opposite to that of the supporter, 0 if it is the same.
    pub is_reversed: u32,
    /// S_c: number of supporter points inside the object, eq. (8).
    pub collision: u32,
    /// S_b: distance of the hanging position from the middle of the supporter, from 0.5 in the middle to 1 at the
    /// boundary, eq. (9).
    pub boundary: f32,
    /// S_a: 0 to 1, larger for a smaller contact area relative to the largest of the object, eq. (10).
    pub contact_area: f32,
    /// S_total: weighted sum of S_c, S_b and S_a, eq. (11); lower is better.
    pub total: f32,
}

/// The pose of a position in metres and a quaternion x, y, z, w of any length; `None` if the quaternion is no rotation.
pub(crate) fn pose_of(position: [f32; 3], [x, y, z, w]: [f32; 4]) -> Option<Pose> {
    let quaternion = Quaternion::new(w, x, y, z);
    let square = quaternion.norm_squared();
    // To normalise what is normal but for rounding would change its last bits.
    let rotation = if (square - 1.0).abs() <= UNIT_ROUNDING {
        UnitQuaternion::new_unchecked(quaternion)
    } else {
        UnitQuaternion::from_quaternion(quaternion)
    };
    square.is_normal().then(|| Pose::from_parts(Vector::from(position).into(), rotation))
}

/// The pose of a position and a quaternion in fields with these names.
pub(crate) fn checked_pose(
    (position_field, position): (&'static str, [f32; 3]),
    (quaternion_field, quaternion): (&'static str, [f32; 4]),
) -> Result<Pose, Failure> {
    let wrong = |place: Place| Failure::Pose { spot: place.into() };
    if !position.iter().all(|x| x.abs() <= MAX_COORDINATE) {
        return Err(wrong(Place::of(position_field).coordinate(None, position)));
    }
    pose_of(position, quaternion).ok_or_else(|| wrong(Place::of(quaternion_field)))
}

impl From<&HangingPose> for hangpose_pose {
    fn from(pose: &HangingPose) -> Self {
        let mut answer = Self {
            has_pose: 1,
            position: pose.pose.translation.vector.into(),
            quaternion: pose.pose.rotation.coords.into(),
            ..Self::NONE
        };
        if let Some(rest) = &pose.rest {
            answer.has_rest = 1;
            answer.kind = kind(rest.kind);
            answer.probability = rest.probability;
            answer.robustness = rest.robustness;
            answer.unseen_object = rest.unseen.object;
            answer.unseen_shadow = rest.unseen.shadow;
            answer.unseen_supporter = rest.unseen.supporter;
            answer.object_view = rest.unseen.object_view;
            answer.supporter_view = rest.unseen.supporter_view;
            answer.rest_position = rest.pose.translation.vector.into();
            answer.rest_quaternion = rest.pose.rotation.coords.into();
            answer.sinking = rest.sinking;
            answer.clearance = rest.clearance;
            answer.tolerance_position = rest.tolerance.position;
            answer.tolerance_rotation = rest.tolerance.rotation;
            answer.margin = (&rest.margin).into();
            answer.contact_count = rest.contacts().len() as u32;
            for (place, contact) in answer.contacts.iter_mut().zip(rest.contacts()) {
                *place = contact.into();
            }
        }
        if let Some(SiteMatch { cost, object_site, support_site, is_reversed }) = pose.matched {
            let Cost { collision, boundary, contact_area, total } = cost;
            let (is_matched, is_reversed) = (1, u32::from(is_reversed));
            answer = Self {
                is_matched,
                object_site,
                support_site,
                is_reversed,
                collision,
                boundary,
                contact_area,
                total,
                ..answer
            };
        }
        answer
    }
}

impl hangpose_pose {
    /// No pose, and so without rest and without match.
    pub(crate) const NONE: Self = {
        const NAN: f32 = f32::NAN;
        Self {
            struct_size: size_of::<Self>() as u32,
            has_pose: 0,
            position: [NAN; 3],
            quaternion: [NAN; 4],
            has_rest: 0,
            kind: 0,
            probability: NAN,
            robustness: NAN,
            unseen_object: NAN,
            unseen_shadow: NAN,
            unseen_supporter: NAN,
            object_view: [NAN; 3],
            supporter_view: [NAN; 3],
            rest_position: [NAN; 3],
            rest_quaternion: [NAN; 4],
            sinking: NAN,
            clearance: NAN,
            tolerance_position: NAN,
            tolerance_rotation: NAN,
            margin: hangpose_margin {
                tilts: [NAN; HANGPOSE_DIRECTIONS],
                least_tilt: NAN,
                jolt_time: NAN,
                tilted_sinking: NAN,
                escape_rise: NAN,
                escape_ratio: NAN,
                knock_speed: NAN,
                centre_of_mass_radius: NAN,
            },
            contact_count: 0,
            contacts: [hangpose_contact { position: [0.0; 3], normal: [0.0; 3], force: 0.0 };
                HANGPOSE_MAX_CONTACTS],
            is_matched: 0,
            object_site: HANGPOSE_NO_INDEX,
            support_site: HANGPOSE_NO_INDEX,
            is_reversed: 0,
            collision: 0,
            boundary: NAN,
            contact_area: NAN,
            total: NAN,
        }
    };
}

impl From<&Margin> for hangpose_margin {
    fn from(margin: &Margin) -> Self {
        let &Margin {
            tilts,
            jolt_time,
            tilted_sinking,
            escape_rise,
            escape_ratio,
            knock_speed,
            centre_of_mass_radius,
        } = margin;
        let least_tilt = margin.least_tilt();
        Self {
            tilts,
            least_tilt,
            jolt_time,
            tilted_sinking,
            escape_rise,
            escape_ratio,
            knock_speed,
            centre_of_mass_radius,
        }
    }
}

impl From<&Contact> for hangpose_contact {
    fn from(contact: &Contact) -> Self {
        let &Contact { position, normal, force } = contact;
        Self { position: position.into(), normal: normal.into(), force }
    }
}
