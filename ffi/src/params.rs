use crate::border::{DETAIL, Public, Region, check, check_size, keep_apart, report};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::status::*;
use crate::version;
use hangpose_core::{Candidates, CentreOfMass, Params};

/// A set of default constants, one of HANGPOSE_PROFILE_*.
pub type hangpose_profile = u32;

/// The library's own method.
pub const HANGPOSE_PROFILE_DEFAULT: hangpose_profile = 0;
/// The published method with the constants of its Table I.
pub const HANGPOSE_PROFILE_PAPER: hangpose_profile = 1;

/// Source of the object's centre of mass, one of HANGPOSE_CENTRE_OF_MASS_*.
pub type hangpose_centre_of_mass = u32;

/// The mean of the surface samples: h_c of eq. (3).
pub const HANGPOSE_CENTRE_OF_MASS_SAMPLE_MEAN: hangpose_centre_of_mass = 0;
/// The centroid of the volume if the mesh is closed, else the mean of the surface samples.
pub const HANGPOSE_CENTRE_OF_MASS_VOLUME: hangpose_centre_of_mass = 1;
/// The point hangpose_params.given_centre_of_mass.
pub const HANGPOSE_CENTRE_OF_MASS_GIVEN: hangpose_centre_of_mass = 2;

/// Source of the candidate poses, one of HANGPOSE_CANDIDATES_*.
pub type hangpose_candidates = u32;

/// Every hanging site of the object on every support site, as the paper matches them: section II-D.
pub const HANGPOSE_CANDIDATES_SITES: hangpose_candidates = 0;
/// Every contact candidate of the object on every contact candidate of the supporter.
pub const HANGPOSE_CANDIDATES_CONTACTS: hangpose_candidates = 1;

/// The constants of the method, with the symbols of the paper. The time step (0.004 s), the settle time (3 s) and the
/// rest speed (0.005 m/s) of the simulation cannot be changed through this interface. Set the struct with hangpose_params_init, then
/// change single fields. Every call that takes it checks each field against its range, which stands at the end of
/// the comment of the field.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_params {
    /// sizeof(hangpose_params), set by hangpose_params_init.
    pub struct_size: u32,
    /// Source of the centre of mass, one of HANGPOSE_CENTRE_OF_MASS_*.
    pub centre_of_mass: hangpose_centre_of_mass,
    /// Seed of the surface samples.
    pub seed: u64,
    /// x, y, z of the direction of gravity in supporter coordinates; any length but zero.
    pub gravity: [f32; 3],
    /// x, y, z of the centre of mass, metres, in object coordinates; used with HANGPOSE_CENTRE_OF_MASS_GIVEN.
    pub given_centre_of_mass: [f32; 3],

    /// N: number of points sampled from the surface of the object; 100 to 500000.
    pub samples: u32,
    /// alpha_h: least cosine between the normal of an object point and its direction to the centre of mass,
    /// eq. (3); 0 to 1.
    pub object_contact_cosine: f32,
    /// Radius of the flat mean-shift kernel, as a fraction of the diagonal of the bounding box; 0.001 to 1.
    pub cluster_bandwidth: f32,
    /// l_c: object clusters of this many points or fewer are dropped, eq. (4); 0 to 500000.
    pub min_cluster_points: u32,
    /// N_h: number of positions tried for the free space between a contact point and the opposite surface;
    /// 2 to 1000.
    pub free_space_steps: u32,
    /// r_alpha: least free-space radius, metres; 0 to 1.
    pub min_free_space_radius: f32,
    /// N_p: number of hanging directions tried at an object site; 1 to 720.
    pub object_directions: u32,
    /// N_r: number of rays cast around each hanging direction; 3 to 720.
    pub rays_per_direction: u32,
    /// alpha_1: least fraction of the rays above the hanging position that must hit the object, eq. (6); 0 to 1.
    pub min_encircled_above: f32,
    /// alpha_2: least fraction of the rays below the hanging position that must hit the object, eq. (6); 0 to 1.
    pub min_encircled_below: f32,
    /// r_beta: relative difference of the free-space radii below which two object sites may be merged, eq. (7);
    /// 0 to 1.
    pub similar_radius: f32,
    /// beta: cosine between the hanging directions above which two object sites of similar radius are merged,
    /// eq. (7); 0 to 1.
    pub similar_direction: f32,

    /// alpha_s: least cosine between the normal of a supporter point and up, section II-C; 0 to 1.
    pub supporter_contact_cosine: f32,
    /// M_s: number of directions in which the supporter is sliced at each site; 1 to 720.
    pub supporter_directions: u32,
    /// d_l: half the thickness of a slice, metres; 0.00001 to 1.
    pub slice_half_thickness: f32,
    /// Distance below which two points of a slice are linked into one cross-section, metres; 0.00001 to 1.
    pub slice_link_distance: f32,

    /// alpha_m: least ratio of free-space radius to support radius; pairs of sites below it are dropped; 0 to 1.
    pub radius_ratio: f32,
    /// Greatest fraction of the supporter points that may lie inside the object; poses above it are dropped;
    /// 0 to 1.
    pub max_collision: f32,
    /// gamma_1: weight of the collision cost S_c, eq. (11); 0 to 1.
    pub collision_weight: f32,
    /// gamma_2: weight of the boundary cost S_b, eq. (11); 0 to 1.
    pub boundary_weight: f32,
    /// gamma_3: weight of the contact-area cost S_a, eq. (11); 0 to 1.
    pub contact_area_weight: f32,

    /// Source of the candidate poses, one of HANGPOSE_CANDIDATES_*. The fields from object_contact_cosine to
    /// contact_area_weight apply to HANGPOSE_CANDIDATES_SITES only.
    pub candidates: hangpose_candidates,
    /// 1 to simulate the release of each pose under gravity and return only poses from which the object comes to
    /// rest and stays; 0 to return poses without this test.
    pub settle: u32,
    /// Coulomb friction coefficient between object and supporter; 0 to 2.
    pub friction: f32,
    /// Distance between object and supporter at release, metres, where there is room for it; 0 to 0.01.
    pub clearance: f32,
    /// Greatest number of nodes of the object's signed distance field; 0 to 10000000, at least 1 if `settle` is 1
    /// or with HANGPOSE_CANDIDATES_CONTACTS.
    pub voxels: u32,
    /// Greatest number of poses that are released while none stays. Once one stays, a quarter of this number is the
    /// limit. 0 to 10000.
    pub settle_attempts: u32,
    /// Number of firm releases that ends the search. A release is firm if its rest pose stays when it is jolted and
    /// when gravity tilts by about 1 rad; two releases to the same rest pose count twice. A larger number gives more
    /// different poses to choose from. 0 to 10000.
    pub firm_enough: u32,
    /// Least probability that the object hangs; poses below it are dropped; 0 to 1.
    pub min_probability: f32,
}

// SAFETY: `repr(C)` over numbers, `struct_size` first.
unsafe impl Public for hangpose_params {
    const NAME: &'static str = "params";
}

/// Sets all fields of `params` to the defaults of `profile`, one of HANGPOSE_PROFILE_*. `struct_size` is
/// sizeof(hangpose_params), `abi_version` is HANGPOSE_ABI_VERSION. Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_params_init(
    params: *mut hangpose_params,
    struct_size: usize,
    profile: hangpose_profile,
    abi_version: u32,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let init = || {
        version::check(abi_version)?;
        check_size::<hangpose_params>(struct_size)?;
        keep_apart(&[Region::written(DETAIL, detail, 1), Region::written("params", params, 1)])?;
        check(hangpose_params::NAME, params.cast_const())?;
        let core = match profile {
            HANGPOSE_PROFILE_DEFAULT => Params::default(),
            HANGPOSE_PROFILE_PAPER => Params::paper(),
            value => return Err(Failure::Choice { field: "profile", value, most: HANGPOSE_PROFILE_PAPER }),
        };
        // SAFETY: not null, aligned, and of the size that the caller vouches for.
        unsafe { params.write(hangpose_params::from_core(&core)) };
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, init) }
}

impl hangpose_params {
    /// Destructures every field, so that a new one cannot be forgotten.
    pub(crate) fn from_core(params: &Params) -> Self {
        let &Params {
            seed,
            gravity,
            centre_of_mass,
            samples,
            object_contact_cosine,
            cluster_bandwidth,
            min_cluster_points,
            free_space_steps,
            min_free_space_radius,
            object_directions,
            rays_per_direction,
            min_encircled_above,
            min_encircled_below,
            similar_radius,
            similar_direction,
            supporter_contact_cosine,
            supporter_directions,
            slice_half_thickness,
            slice_link_distance,
            radius_ratio,
            max_collision,
            collision_weight,
            boundary_weight,
            contact_area_weight,
            candidates,
            settle,
            friction,
            clearance,
            // The C interface has no fields for these: it uses the defaults.
            time_step: _,
            settle_time: _,
            rest_speed: _,
            voxels,
            settle_attempts,
            firm_enough,
            min_probability,
        } = params;
        let (centre_of_mass, given_centre_of_mass) = match centre_of_mass {
            CentreOfMass::SampleMean => (HANGPOSE_CENTRE_OF_MASS_SAMPLE_MEAN, [0.0; 3]),
            CentreOfMass::Volume => (HANGPOSE_CENTRE_OF_MASS_VOLUME, [0.0; 3]),
            CentreOfMass::Given(point) => (HANGPOSE_CENTRE_OF_MASS_GIVEN, point),
        };
        Self {
            struct_size: size_of::<Self>() as u32,
            centre_of_mass,
            seed,
            gravity,
            given_centre_of_mass,
            samples: samples as u32,
            object_contact_cosine,
            cluster_bandwidth,
            min_cluster_points: min_cluster_points as u32,
            free_space_steps: free_space_steps as u32,
            min_free_space_radius,
            object_directions: object_directions as u32,
            rays_per_direction: rays_per_direction as u32,
            min_encircled_above,
            min_encircled_below,
            similar_radius,
            similar_direction,
            supporter_contact_cosine,
            supporter_directions: supporter_directions as u32,
            slice_half_thickness,
            slice_link_distance,
            radius_ratio,
            max_collision,
            collision_weight,
            boundary_weight,
            contact_area_weight,
            candidates: match candidates {
                Candidates::Sites => HANGPOSE_CANDIDATES_SITES,
                Candidates::Contacts => HANGPOSE_CANDIDATES_CONTACTS,
            },
            settle: u32::from(settle),
            friction,
            clearance,
            voxels: voxels as u32,
            settle_attempts: settle_attempts as u32,
            firm_enough: firm_enough as u32,
            min_probability,
        }
    }

    /// The params as the core takes them, each checked against its range.
    pub(crate) fn to_core(self) -> Result<Params, Failure> {
        let centre_of_mass = match self.centre_of_mass {
            HANGPOSE_CENTRE_OF_MASS_SAMPLE_MEAN => CentreOfMass::SampleMean,
            HANGPOSE_CENTRE_OF_MASS_VOLUME => CentreOfMass::Volume,
            HANGPOSE_CENTRE_OF_MASS_GIVEN => CentreOfMass::Given(self.given_centre_of_mass),
            value => {
                let (field, most) = ("params.centre_of_mass", HANGPOSE_CENTRE_OF_MASS_GIVEN);
                return Err(Failure::Choice { field, value, most });
            }
        };
        let candidates = match self.candidates {
            HANGPOSE_CANDIDATES_SITES => Candidates::Sites,
            HANGPOSE_CANDIDATES_CONTACTS => Candidates::Contacts,
            value => {
                let (field, most) = ("params.candidates", HANGPOSE_CANDIDATES_CONTACTS);
                return Err(Failure::Choice { field, value, most });
            }
        };
        let settle = match self.settle {
            0 => false,
            1 => true,
            value => return Err(Failure::Choice { field: "params.settle", value, most: 1 }),
        };
        let defaults = Params::default();
        let params = Params {
            seed: self.seed,
            gravity: self.gravity,
            centre_of_mass,
            samples: self.samples as usize,
            object_contact_cosine: self.object_contact_cosine,
            cluster_bandwidth: self.cluster_bandwidth,
            min_cluster_points: self.min_cluster_points as usize,
            free_space_steps: self.free_space_steps as usize,
            min_free_space_radius: self.min_free_space_radius,
            object_directions: self.object_directions as usize,
            rays_per_direction: self.rays_per_direction as usize,
            min_encircled_above: self.min_encircled_above,
            min_encircled_below: self.min_encircled_below,
            similar_radius: self.similar_radius,
            similar_direction: self.similar_direction,
            supporter_contact_cosine: self.supporter_contact_cosine,
            supporter_directions: self.supporter_directions as usize,
            slice_half_thickness: self.slice_half_thickness,
            slice_link_distance: self.slice_link_distance,
            radius_ratio: self.radius_ratio,
            max_collision: self.max_collision,
            collision_weight: self.collision_weight,
            boundary_weight: self.boundary_weight,
            contact_area_weight: self.contact_area_weight,
            candidates,
            settle,
            friction: self.friction,
            clearance: self.clearance,
            time_step: defaults.time_step,
            settle_time: defaults.settle_time,
            rest_speed: defaults.rest_speed,
            voxels: self.voxels as usize,
            settle_attempts: self.settle_attempts as usize,
            firm_enough: self.firm_enough as usize,
            min_probability: self.min_probability,
        };
        params.validate()?;
        Ok(params)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failure::Reason;

    #[test]
    fn both_profiles_come_back_as_they_were() {
        let given =
            Params { centre_of_mass: CentreOfMass::Given([1.0, 2.0, 3.0]), seed: 7, ..Params::paper() };
        for params in [Params::paper(), Params::default(), given] {
            assert_eq!(hangpose_params::from_core(&params).to_core(), Ok(params));
        }
    }

    /// The core checks the ranges in the comments above.
    #[test]
    fn what_is_out_of_range_is_named() {
        let mut params = hangpose_params::from_core(&Params::default());
        params.samples = 99;
        let place = params.to_core().unwrap_err().place();
        assert_eq!(
            (place.prefix, place.field, place.range),
            ("params.", "samples", Some([100.0, 500_000.0]))
        );
        let right = hangpose_params::from_core(&Params::default());
        for wrong in [
            hangpose_params { centre_of_mass: 3, ..right },
            hangpose_params { candidates: 2, ..right },
            hangpose_params { settle: 2, ..right },
            hangpose_params { voxels: 0, ..right },
        ] {
            assert_eq!(wrong.to_core().unwrap_err().status(), HANGPOSE_ERROR_VALUE);
        }
    }
}
