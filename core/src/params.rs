//! The parameters of the method.

use crate::geometry::Vector;

/// Source of the object's centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum CentreOfMass {
    /// Mean of the surface samples: `h_c` of eq. (3).
    SampleMean,
    /// Centroid of the volume if the mesh is closed, mean of the samples if it is not.
    Volume,
    /// Given by the caller, in object coordinates, metres.
    Given([f32; 3]),
}

/// Source of the candidate poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Candidates {
    /// Every pair of a hanging site and a support site, matched as in the paper, section II-D.
    Sites,
    /// Every pair of a contact candidate of the object and one of the supporter that can carry it.
    Contacts,
}

/// The parameters of the method, with the paper's symbols.
///
/// There are two profiles. [`Params::paper`] is the published method, with the values of the paper's Table I
/// unless a field says otherwise; [`Params::default`] is the method of this library. [`Params::validate`]
/// checks the ranges.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct Params {
    /// Seed of the random surface samples.
    pub seed: u64,
    /// Direction of gravity in supporter coordinates; any length but zero.
    pub gravity: [f32; 3],
    /// Source of the centre of mass.
    pub centre_of_mass: CentreOfMass,

    /// `N`: number of points sampled from the object's surface (paper: 10000, section II-B).
    pub samples: usize,
    /// `alpha_h`: minimum cosine between an object point's normal and its direction to the centre of mass,
    /// eq. (3).
    pub object_contact_cosine: f32,
    /// Radius of the mean shift's flat kernel, as a fraction of the bounding box's diagonal (not in the
    /// paper).
    pub cluster_bandwidth: f32,
    /// `l_c`: largest number of points of an object cluster that is dropped, eq. (4).
    pub min_cluster_points: usize,
    /// `N_h`: number of positions between a contact point and the opposite surface that are tested for free
    /// space.
    pub free_space_steps: usize,
    /// `r_alpha`: minimum free-space radius, metres.
    pub min_free_space_radius: f32,
    /// `N_p`: number of hanging directions tested at an object site.
    pub object_directions: usize,
    /// `N_r`: number of rays cast around each hanging direction.
    pub rays_per_direction: usize,
    /// `alpha_1`: minimum fraction of the rays above the hanging position that hit the object, eq. (6).
    pub min_encircled_above: f32,
    /// `alpha_2`: minimum fraction of the rays below the hanging position that hit the object, eq. (6).
    pub min_encircled_below: f32,
    /// `r_beta`: relative difference of the free-space radii below which object sites may be merged, eq. (7).
    pub similar_radius: f32,
    /// `beta`: cosine between the hanging directions above which object sites may be merged, eq. (7).
    pub similar_direction: f32,

    /// `alpha_s`: minimum cosine between a supporter point's normal and the upward direction, section II-C.
    pub supporter_contact_cosine: f32,
    /// `M_s`: number of directions in which the supporter is sliced at each site.
    pub supporter_directions: usize,
    /// `d_l`: half thickness of a slice, metres.
    pub slice_half_thickness: f32,
    /// Distance below which points of a slice are linked into one cluster, metres (single linkage, `3 d_l`;
    /// not in the paper).
    pub slice_link_distance: f32,

    /// `alpha_m`: ratio of the free-space radius to the support radius below which a pair of sites is
    /// dropped.
    pub radius_ratio: f32,
    /// Fraction of the supporter's points inside the object above which a pose is dropped (the paper drops
    /// none: 1).
    pub max_collision: f32,
    /// `gamma_1`: weight of the collision cost `S_c`, eq. (11).
    pub collision_weight: f32,
    /// `gamma_2`: weight of the boundary cost `S_b`, eq. (11).
    pub boundary_weight: f32,
    /// `gamma_3`: weight of the contact-area cost `S_a`, eq. (11).
    pub contact_area_weight: f32,

    /// Source of the candidate poses. With [`Candidates::Contacts`] only the first four parameters above have
    /// an effect.
    pub candidates: Candidates,
    /// Whether the candidate poses are simulated under gravity. If so, only those that come to rest and are
    /// stable are returned.
    pub settle: bool,
    /// Coulomb's coefficient of friction between object and supporter.
    pub friction: f32,
    /// Distance between object and supporter at the release pose, metres; less where the opening is narrower.
    /// Below 0.0001 every release pose is discarded.
    pub clearance: f32,
    /// Time step of the simulation, seconds, 0.0005 to 0.005, default 0.004. The run time grows as its inverse.
    /// Keep the default unless you study the simulation: the probability was fitted with it.
    pub time_step: f32,
    /// Time that a released object has to come to rest or fall, seconds, 0.1 to 60. An object that does
    /// neither in this time is rejected as still moving. Objects that swing or slide for long may need more.
    /// [`let_go`](crate::hanging::let_go) has its own limit of four seconds.
    pub settle_time: f32,
    /// Speed below which an object in contact is at rest, m/s, 0.0001 to 0.1: no point of it moves faster,
    /// averaged over 80 ms. A larger value ends simulations earlier, but may classify a slow slide as rest. With a
    /// smaller one, an object that rocks or creeps counts as still moving.
    pub rest_speed: f32,
    /// Maximum number of nodes of the object's signed distance field. A node takes two bytes, and the index
    /// of the field as much again.
    pub voxels: usize,
    /// Maximum number of released poses while none is stable, and of candidates that touch the supporter, which are not released.
    /// Once a pose is stable, the maximum number of released poses is a quarter of it.
    pub settle_attempts: usize,
    /// Number of firm releases after which the search ends. A release is firm if its rest pose stays when it is jolted and when
    /// gravity tilts by about 1 rad, with 1 mm of clearance at release, or if it hardly differs from such a pose. The search also ends
    /// after four times as many releases in a row that come to rest without a better pose, once one is nearly as firm. A larger
    /// number gives more different poses to choose from.
    pub firm_enough: usize,
    /// Minimum probability that a returned pose hangs.
    pub min_probability: f32,
}

impl Params {
    /// The published method, with the values of the paper's Table I.
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
        // The bounds of counts keep working memory and index types small. Cosines may have any value that
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
        // The simulation needs the distance field, and contact candidates need the simulation.
        if self.voxels == 0 && self.uses_mechanics() {
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

    /// Whether a prediction needs the object's distance field and the supporter's patches.
    pub(crate) fn uses_mechanics(&self) -> bool {
        self.settle || self.candidates == Candidates::Contacts
    }

    /// Unit vector opposite to gravity, in supporter coordinates.
    pub fn up(&self) -> Vector {
        -Vector::from(self.gravity).normalize()
    }
}

/// The method of this library: pairs of contact candidates and the centroid of the volume, with simulation
/// under gravity.
impl Default for Params {
    fn default() -> Self {
        Self {
            centre_of_mass: CentreOfMass::Volume,
            max_collision: 0.01,
            candidates: Candidates::Contacts,
            settle: true,
            voxels: 200_000,
            settle_attempts: 192,
            firm_enough: 2,
            min_probability: 0.3,
            ..Self::paper()
        }
    }
}

/// Maximum of [`Params::voxels`]: a finer field than any mesh of an object that a robot hangs.
pub(crate) const MAX_VOXELS: usize = 10_000_000;

/// Maximum of [`Params::samples`]: more samples do not improve the result for any object that a robot can
/// hold.
pub const MAX_SAMPLES: usize = 500_000;
/// Maximum number of directions or rays: half a degree is finer than any of the data.
pub(crate) const MAX_DIRECTIONS: usize = 720;

/// Error: a parameter is invalid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamsError {
    /// A number is outside its range or not a number.
    OutOfRange {
        /// Name of the field of [`Params`].
        name: &'static str,
        /// Value of the field.
        value: f32,
        /// Minimum of the range.
        min: f32,
        /// Maximum of the range.
        max: f32,
    },
    /// `gravity` is zero, infinite or not a number.
    Gravity {
        /// Value of the field.
        gravity: [f32; 3],
    },
    /// `centre_of_mass` is infinite, not a number, or beyond the maximum coordinate.
    CentreOfMass {
        /// Value of the point.
        point: [f32; 3],
    },
}

impl core::fmt::Display for ParamsError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::OutOfRange { name, value, min, max } => {
                write!(f, "{name} = {value} is outside its range, {min} to {max}")
            }
            Self::Gravity { gravity } => {
                write!(f, "gravity = {gravity:?} has no direction; it must be finite and not zero")
            }
            Self::CentreOfMass { point } => write!(
                f,
                "centre_of_mass = {point:?} is not a point in metres within the range of coordinates"
            ),
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
