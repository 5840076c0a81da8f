use crate::detail::HANGPOSE_NO_INDEX;
use hangpose_core::hanging::HangingPose;
use hangpose_core::hanging::sites::{Cost, SiteMatch};
use hangpose_core::mechanics::{Contact, DIRECTIONS, MAX_CONTACTS, Margin};

/// Directions in which gravity is tilted.
pub const HANGPOSE_DIRECTIONS: usize = 8;
/// Contacts that a pose tells of, at most.
pub const HANGPOSE_MAX_CONTACTS: usize = 8;

const _: () = assert!(HANGPOSE_DIRECTIONS == DIRECTIONS && HANGPOSE_MAX_CONTACTS == MAX_CONTACTS);

/// A place where the supporter bears the object, in supporter coordinates. A part of hangpose_pose.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_contact {
    /// x, y, z, metres.
    pub position: [f32; 3],
    /// Unit vector in which the supporter pushes.
    pub normal: [f32; 3],
    /// How hard it pushes along it, in multiples of the object's weight.
    pub force: f32,
}

/// By how much an object stays up. A part of hangpose_pose.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_margin {
    /// How far gravity may tilt, radians, with 70 % of the friction, towards each of eight horizontal directions: the first is the
    /// supporter's x axis (or its y axis, where gravity is along x, made perpendicular to gravity), the others follow
    /// counter-clockwise seen from above.
    pub tilts: [f32; HANGPOSE_DIRECTIONS],
    /// The least of the tilts, radians.
    pub least_tilt: f32,
    /// How long it stays, seconds, when gravity tilts by 21.8 degrees at once, towards where it survives the least tilt, and
    /// nothing but friction stops its swing; 1 if it is still there then, 0 if that was not tried, because some tilt is hopeless.
    pub jolt_time: f32,
    /// How far the centre of mass sank at most, metres, while gravity tilted by up to 0.9 radians: what comes to lie deeper when it is
    /// shaken does not lie firmly where it is.
    pub tilted_sinking: f32,
    /// The least rise of the centre of mass, metres, over the ways of escape that were found, and the highest rise seen
    /// where none was found.
    pub escape_rise: f32,
    /// The same over the distance from the contacts to the centre of mass; no unit.
    pub escape_ratio: f32,
    /// The speed of a knock that would carry the centre of mass over that rise, m/s.
    pub knock_speed: f32,
    /// How far the centre of mass may be from where it was taken to be, metres.
    pub centre_of_mass_radius: f32,
}

/// A pose in which the object hangs: where to let it go, what gravity then makes of it, and which sites it joins.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_pose {
    /// sizeof(hangpose_pose), set by the library.
    pub struct_size: u32,
    /// Where to let the object go: x, y, z of its origin, metres, in supporter coordinates.
    pub position: [f32; 3],
    /// x, y, z, w of the unit quaternion that turns object coordinates into supporter coordinates.
    pub quaternion: [f32; 4],

    /// 1 with hangpose_params.settle; else 0, and all from here to `contacts` is NaN or 0.
    pub has_rest: u32,
    /// The probability that it hangs and stays.
    pub probability: f32,
    /// Where the object comes to rest: x, y, z of its origin, metres, in supporter coordinates.
    pub rest_position: [f32; 3],
    /// x, y, z, w of the unit quaternion that turns object coordinates into supporter coordinates there.
    pub rest_quaternion: [f32; 4],
    /// How far the centre of mass sinks from the release to there, metres.
    pub sinking: f32,
    /// How far the object is off the supporter where it is let go, metres: hangpose_params.clearance, or less where there
    /// is no room.
    pub clearance: f32,
    /// By how much it stays.
    pub margin: hangpose_margin,
    /// How many of the contacts there are; the others are 0.
    pub contact_count: u32,
    /// Where the supporter bears the object at rest.
    pub contacts: [hangpose_contact; HANGPOSE_MAX_CONTACTS],

    /// 1 with HANGPOSE_CANDIDATES_SITES; else 0, and all from here on is HANGPOSE_NO_INDEX, NaN or 0.
    pub is_matched: u32,
    /// Index of the hanging site, for hangpose_object_get_site.
    pub object_site: u32,
    /// Index of the support site, for hangpose_supporter_get_site.
    pub support_site: u32,
    /// 1 where the object's hanging direction is laid against the supporter's, 0 where it is laid along it.
    pub is_reversed: u32,
    /// S_c: points of the supporter inside the object, eq. (8).
    pub collision: u32,
    /// S_b: how far the hanging position is from the middle of the supporter, from 0.5 to 1, eq. (9).
    pub boundary: f32,
    /// S_a: how small the contact area is against the object's largest, from 0 to 1, eq. (10).
    pub contact_area: f32,
    /// S_total: the weighted sum of the three, eq. (11); less is better.
    pub total: f32,
}

impl From<&HangingPose> for hangpose_pose {
    fn from(pose: &HangingPose) -> Self {
        let mut answer = Self {
            struct_size: size_of::<Self>() as u32,
            position: pose.pose.translation.vector.into(),
            quaternion: pose.pose.rotation.coords.into(),
            ..Self::NEITHER
        };
        if let Some(rest) = &pose.rest {
            answer.has_rest = 1;
            answer.probability = rest.probability;
            answer.rest_position = rest.pose.translation.vector.into();
            answer.rest_quaternion = rest.pose.rotation.coords.into();
            answer.sinking = rest.sinking;
            answer.clearance = rest.clearance;
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
    /// Without rest and without match.
    const NEITHER: Self = {
        const NAN: f32 = f32::NAN;
        Self {
            struct_size: 0,
            position: [NAN; 3],
            quaternion: [NAN; 4],
            has_rest: 0,
            probability: NAN,
            rest_position: [NAN; 3],
            rest_quaternion: [NAN; 4],
            sinking: NAN,
            clearance: NAN,
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
