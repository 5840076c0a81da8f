//! Every constant of the method, by name.

use crate::geometry::{Point, Vector};

/// What the object's centre of mass is taken to be.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum CentreOfMass {
    /// The mean of the surface samples: `h_c` of eq. (3).
    SampleMean,
    /// The centroid of the volume where the mesh is closed, the mean of the samples where it is not.
    Volume,
    /// Known to the caller; metres, in object coordinates.
    Given([f32; 3]),
}

/// Where the poses come from that are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Candidates {
    /// Every hanging site on every support site, as the paper matches them: section II-D.
    Sites,
    /// Every place of the object that can lie on something on every place of the supporter that can carry something.
    Contacts,
}

/// The constants of the method, with the paper's symbols; values of Table I unless said otherwise.
///
/// Two profiles exist: [`Params::paper`] is the published method, [`Params::default`] is ours.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct Params {
    /// Seed of the surface samples.
    pub seed: u64,
    /// Direction in which things fall, in supporter coordinates; any length but zero.
    pub gravity: [f32; 3],
    /// The centre of mass that the method works with.
    pub centre_of_mass: CentreOfMass,

    /// `N`: points sampled from the object's surface (paper: 10000, section II-B).
    pub samples: usize,
    /// `alpha_h`: least cosine between an object point's normal and its direction to the centre of mass, eq. (3).
    pub object_contact_cosine: f32,
    /// Radius of the mean shift's flat kernel, as a fraction of the bounding box's diagonal (not in the paper).
    pub cluster_bandwidth: f32,
    /// `l_c`: object clusters of this many points or fewer are dropped, eq. (4).
    pub min_cluster_points: usize,
    /// `N_h`: positions tried between a contact point and the surface opposite, for the free space.
    pub free_space_steps: usize,
    /// `r_alpha`: least free-space radius, metres.
    pub min_free_space_radius: f32,
    /// `N_p`: hanging directions tried at an object site.
    pub object_directions: usize,
    /// `N_r`: rays cast around each of those directions.
    pub rays_per_direction: usize,
    /// `alpha_1`: least share of the rays above the hanging position that must hit the object, eq. (6).
    pub min_encircled_above: f32,
    /// `alpha_2`: the same for the rays below it.
    pub min_encircled_below: f32,
    /// `r_beta`: object sites whose free-space radii differ by less than this fraction may be merged, eq. (7).
    pub similar_radius: f32,
    /// `beta`: ... if the cosine between their hanging directions is above this, eq. (7).
    pub similar_direction: f32,

    /// `alpha_s`: least cosine between a supporter point's normal and up, section II-C.
    pub supporter_contact_cosine: f32,
    /// `M_s`: directions in which the supporter is sliced at each site.
    pub supporter_directions: usize,
    /// `d_l`: half the thickness of a slice, metres.
    pub slice_half_thickness: f32,
    /// Points of a slice closer than this, metres, belong together (single linkage; not in the paper: `3 d_l`).
    pub slice_link_distance: f32,

    /// `alpha_m`: pairs whose free-space radius is below this times the support radius are dropped.
    pub radius_ratio: f32,
    /// Poses that put more than this fraction of the supporter's points inside the object are dropped
    /// (the paper drops none: 1).
    pub max_collision: f32,
    /// `gamma_1`: weight of the collision cost `S_c`, eq. (11).
    pub collision_weight: f32,
    /// `gamma_2`: weight of the boundary cost `S_b`, eq. (11).
    pub boundary_weight: f32,
    /// `gamma_3`: weight of the contact-area cost `S_a`, eq. (11).
    pub contact_area_weight: f32,

    /// Where poses come from. All above but the first four constants is for [`Candidates::Sites`].
    pub candidates: Candidates,
    /// Whether gravity acts before the answer is given: only what comes to rest is, and stays, is a pose.
    pub settle: bool,
    /// Coulomb's coefficient of friction between object and supporter.
    pub friction: f32,
    /// How far off the supporter the object is let go, metres, where there is room for that.
    pub clearance: f32,
    /// Time step of the simulation, s. A larger step is faster and less exact: contacts are sought from farther away (1.4 mm at 0.005 s),
    /// where the distance field is no longer exact. A smaller step costs time in proportion. The probability was fitted at the default.
    pub time_step: f32,
    /// Time within which a released object must come to rest or fall, s; after it the object counts as still moving.
    /// [`let_go`](crate::hanging::let_go) follows the object for four seconds instead.
    pub settle_time: f32,
    /// Speed below which a touching object is at rest, m/s: that of its fastest point, averaged over 80 ms.
    pub rest_speed: f32,
    /// Nodes of the object's signed distance field at most: two bytes each, and as much again for where they are.
    pub voxels: usize,
    /// Poses that are let go at most while none stays; once one does, no more than a quarter of that in all.
    pub settle_attempts: usize,
    /// No more poses are let go when so many stayed firmly: with a probability of 97.5 % or more, be it twice in the same place. More
    /// give more different poses to choose from.
    pub firm_enough: usize,
    /// Poses that are less likely to hang than this are none.
    pub min_probability: f32,
}

impl Params {
    /// The published method with the constants of its Table I.
    pub const fn paper() -> Self {
        Self {
            seed: 0,
            gravity: [0.0, 0.0, -1.0],
            centre_of_mass: CentreOfMass::SampleMean,
            samples: 10_000,
            object_contact_cosine: 0.8,
            cluster_bandwidth: 0.06,
            min_cluster_points: 20,
            free_space_steps: 10,
            min_free_space_radius: 0.002,
            object_directions: 50,
            rays_per_direction: 50,
            min_encircled_above: 0.7,
            min_encircled_below: 0.5,
            similar_radius: 0.1,
            similar_direction: 0.9,
            supporter_contact_cosine: 0.8,
            supporter_directions: 20,
            slice_half_thickness: 0.002,
            slice_link_distance: 0.006,
            radius_ratio: 1.0,
            max_collision: 1.0,
            collision_weight: 1.0,
            boundary_weight: 1.0,
            contact_area_weight: 1.0,
            candidates: Candidates::Sites,
            settle: false,
            friction: 0.4,
            clearance: 0.001,
            time_step: 0.004,
            settle_time: 3.0,
            rest_speed: 0.005,
            voxels: 0,
            settle_attempts: 0,
            firm_enough: 0,
            min_probability: 0.0,
        }
    }

    /// Checks every value against its range.
    pub fn validate(&self) -> Result<(), ParamsError> {
        // Counts are bounded so that working memory and index types stay small; cosines may be anything that
        // still selects.
        let ranges: [(&'static str, f32, f32, f32); 30] = [
            ("samples", self.samples as f32, 100.0, MAX_SAMPLES as f32),
            ("object_contact_cosine", self.object_contact_cosine, 0.0, 1.0),
            ("cluster_bandwidth", self.cluster_bandwidth, 0.001, 1.0),
            ("min_cluster_points", self.min_cluster_points as f32, 0.0, MAX_SAMPLES as f32),
            ("free_space_steps", self.free_space_steps as f32, 2.0, 1000.0),
            ("min_free_space_radius", self.min_free_space_radius, 0.0, 1.0),
            ("object_directions", self.object_directions as f32, 1.0, MAX_DIRECTIONS as f32),
            ("rays_per_direction", self.rays_per_direction as f32, 3.0, MAX_DIRECTIONS as f32),
            ("min_encircled_above", self.min_encircled_above, 0.0, 1.0),
            ("min_encircled_below", self.min_encircled_below, 0.0, 1.0),
            ("similar_radius", self.similar_radius, 0.0, 1.0),
            ("similar_direction", self.similar_direction, 0.0, 1.0),
            ("supporter_contact_cosine", self.supporter_contact_cosine, 0.0, 1.0),
            ("supporter_directions", self.supporter_directions as f32, 1.0, MAX_DIRECTIONS as f32),
            ("slice_half_thickness", self.slice_half_thickness, 1e-5, 1.0),
            ("slice_link_distance", self.slice_link_distance, 1e-5, 1.0),
            ("radius_ratio", self.radius_ratio, 0.0, 1.0),
            ("max_collision", self.max_collision, 0.0, 1.0),
            ("collision_weight", self.collision_weight, 0.0, 1.0),
            ("boundary_weight", self.boundary_weight, 0.0, 1.0),
            ("contact_area_weight", self.contact_area_weight, 0.0, 1.0),
            ("friction", self.friction, 0.0, 2.0),
            ("clearance", self.clearance, 0.0, 0.01),
            ("time_step", self.time_step, 0.0005, 0.005),
            ("settle_time", self.settle_time, 0.1, 60.0),
            ("rest_speed", self.rest_speed, 0.0001, 0.1),
            ("voxels", self.voxels as f32, 0.0, MAX_VOXELS as f32),
            ("settle_attempts", self.settle_attempts as f32, 0.0, 10_000.0),
            ("firm_enough", self.firm_enough as f32, 0.0, 10_000.0),
            ("min_probability", self.min_probability, 0.0, 1.0),
        ];
        for (name, value, min, max) in ranges {
            if !(min..=max).contains(&value) {
                return Err(ParamsError::OutOfRange { name, value, min, max });
            }
        }
        // Without its distances nothing can be let go, and contacts are only worth that.
        if self.voxels == 0 && (self.settle || self.candidates == Candidates::Contacts) {
            return Err(ParamsError::OutOfRange {
                name: "voxels",
                value: 0.0,
                min: 1.0,
                max: MAX_VOXELS as f32,
            });
        }
        let gravity = Vector::from(self.gravity);
        if !(gravity.norm_squared().is_finite() && gravity.norm() > 1e-6) {
            return Err(ParamsError::Gravity { gravity: self.gravity });
        }
        if let CentreOfMass::Given(point) = self.centre_of_mass
            && !point.iter().all(|x| x.abs() <= crate::geometry::MAX_COORDINATE)
        {
            return Err(ParamsError::CentreOfMass { point });
        }
        Ok(())
    }

    /// The unit vector against gravity, in supporter coordinates.
    pub(crate) fn up(&self) -> Vector {
        -Vector::from(self.gravity).normalize()
    }

    /// The centre of mass in object coordinates.
    pub(crate) fn resolve_centre_of_mass(&self, sample_mean: Point, volume_centroid: Option<Point>) -> Point {
        match self.centre_of_mass {
            CentreOfMass::SampleMean => sample_mean,
            CentreOfMass::Volume => volume_centroid.unwrap_or(sample_mean),
            CentreOfMass::Given(point) => Point::from(point),
        }
    }
}

/// Ours: contact on contact about the true centre of mass, and then gravity decides.
impl Default for Params {
    fn default() -> Self {
        Self {
            centre_of_mass: CentreOfMass::Volume,
            max_collision: 0.01,
            candidates: Candidates::Contacts,
            settle: true,
            voxels: 400_000,
            settle_attempts: 192,
            firm_enough: 2,
            min_probability: 0.3,
            ..Self::paper()
        }
    }
}

/// More nodes than this are finer than any mesh of a thing that a robot hangs.
pub(crate) const MAX_VOXELS: usize = 10_000_000;

/// More samples than this serve no object that a robot can hold.
pub const MAX_SAMPLES: usize = 500_000;
/// Half a degree is finer than any of the data.
pub(crate) const MAX_DIRECTIONS: usize = 720;

/// A constant that is out of its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamsError {
    /// A number outside its range, or not a number.
    OutOfRange {
        /// The field of [`Params`].
        name: &'static str,
        /// What it is.
        value: f32,
        /// The least that it may be.
        min: f32,
        /// The most that it may be.
        max: f32,
    },
    /// `gravity` is zero, infinite or not a number.
    Gravity {
        /// What it is.
        gravity: [f32; 3],
    },
    /// `centre_of_mass` is infinite, not a number, or farther away than any coordinate may be.
    CentreOfMass {
        /// What it is.
        point: [f32; 3],
    },
}

impl core::fmt::Display for ParamsError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::OutOfRange { name, value, min, max } => {
                write!(f, "{name} = {value} is outside its range, {min} to {max}")
            }
            Self::Gravity { gravity } => write!(f, "gravity = {gravity:?} gives no direction"),
            Self::CentreOfMass { point } => write!(f, "centre_of_mass = {point:?} is not a point in metres"),
        }
    }
}

impl core::error::Error for ParamsError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_profiles_are_valid() {
        assert_eq!(Params::paper().validate(), Ok(()));
        assert_eq!(Params::default().validate(), Ok(()));
    }

    #[test]
    fn a_value_out_of_range_is_named() {
        let params = Params { radius_ratio: 1.5, ..Params::paper() };
        let message = params.validate().unwrap_err().to_string();
        assert_eq!(message, "radius_ratio = 1.5 is outside its range, 0 to 1");
        for params in [
            Params { similar_radius: f32::NAN, ..Params::paper() },
            Params { samples: 0, ..Params::paper() },
            Params { samples: usize::MAX, ..Params::paper() },
            Params { time_step: 0.01, ..Params::paper() },
            Params { settle_time: 0.0, ..Params::paper() },
            Params { rest_speed: 0.0, ..Params::paper() },
            Params { gravity: [0.0; 3], ..Params::paper() },
            Params { gravity: [f32::MAX; 3], ..Params::paper() },
            Params { centre_of_mass: CentreOfMass::Given([0.0, f32::NAN, 0.0]), ..Params::paper() },
        ] {
            assert!(params.validate().is_err(), "{params:?}");
        }
    }
}
