//! The thing that is hung.

use super::AnalysisError;
use super::hangability::{self, Hangability, HangabilityCounts, HangingSite};
use super::object_contact::{self, ObjectContact};
use crate::geometry::{DistanceField, MassProperties, Mesh, Point, PointTree, Surface, Vector};
use crate::mechanics::Body;
use crate::memory::{Arena, Limits, array_bytes, larger, model_bytes};
use crate::monitor::{Meter, Monitor, Stop, Work};
use crate::params::{Candidates, Params};
use crate::perception::sampling;

/// An object, analysed: shape, centre of mass and hanging sites, in object coordinates. Immutable; any number of
/// threads may match it at once.
#[derive(Clone, Copy)]
pub struct Object<'m> {
    surface: Surface<'m>,
    field: Option<DistanceField<'m>>,
    contacts: &'m [ObjectContact],
    reach: f32,
    mass: MassProperties,
    centre_of_mass: Point,
    sites: &'m [HangingSite],
    counts: HangabilityCounts,
    work: Work,
    stopped: Option<Stop>,
}

impl<'m> Object<'m> {
    /// Bytes of memory for any object within `limits`.
    pub const fn bytes(limits: &Limits) -> usize {
        let model = Surface::bytes(limits.triangles)
            .saturating_add(DistanceField::bytes(limits.voxels))
            .saturating_add(array_bytes::<ObjectContact>(object_contact::MAX_CONTACTS))
            .saturating_add(array_bytes::<HangingSite>(hangability::MAX_SITES));
        let before_sampling = larger(
            MassProperties::scratch_bytes(limits.vertices, limits.triangles),
            larger(
                Surface::scratch_bytes(limits.triangles),
                DistanceField::scratch_bytes(limits.triangles, limits.voxels),
            ),
        );
        let samples = array_bytes::<Point>(limits.samples).saturating_mul(2);
        let after_tree =
            larger(PointTree::scratch_bytes(limits.samples), hangability::scratch_bytes(limits.samples));
        let with_samples = larger(
            sampling::scratch_bytes(limits.samples),
            PointTree::bytes(limits.samples).saturating_add(after_tree),
        );
        model_bytes(model.saturating_add(larger(before_sampling, samples.saturating_add(with_samples))))
    }

    /// What [`analyze`](Self::analyze) needs memory for with this mesh and these params.
    pub fn limits(mesh: &Mesh, params: &Params) -> Limits {
        Limits {
            vertices: mesh.vertices().len(),
            triangles: mesh.triangles().len(),
            samples: params.samples,
            voxels: params.voxels,
            points: 0,
        }
    }

    /// Analyses `mesh` in `memory`, which must hold [`Object::bytes`] for its [`limits`](Self::limits). The mesh need not
    /// stay.
    pub fn analyze(
        mesh: &Mesh,
        params: &Params,
        memory: &'m mut [u8],
        monitor: &Monitor,
    ) -> Result<Self, AnalysisError> {
        params.validate()?;
        let mut arena = Arena::new(memory, Self::bytes(&Self::limits(mesh, params)))?;
        let mut meter = Meter::new(monitor);

        let mass = MassProperties::of(mesh, arena.scratch())?;
        let surface = Surface::build(mesh, mass.is_inside_out, &mut arena)?;
        meter.check().map_err(|_| AnalysisError::Cancelled)?;
        let field = match params.voxels {
            0 => None,
            voxels => Some(DistanceField::build(&surface, voxels, &mut arena)?),
        };
        let contacts = arena.slice::<ObjectContact>(object_contact::MAX_CONTACTS)?;
        let sites = arena.slice::<HangingSite>(hangability::MAX_SITES)?;
        meter.check().map_err(|_| AnalysisError::Cancelled)?;

        let mut scratch = arena.scratch();
        let points = scratch.slice::<Point>(params.samples)?;
        let normals = scratch.slice::<Vector>(params.samples)?;
        match params.candidates {
            Candidates::Sites => {
                sampling::sample_into(mesh, params.seed, points, normals, scratch.scratch())?
            }
            // Contacts are kept apart as they are found.
            Candidates::Contacts => sampling::scatter_into(mesh, params.seed, points, normals),
        }
        if mass.is_inside_out {
            normals.iter_mut().for_each(|normal| *normal = -*normal);
        }
        meter.check().map_err(|_| AnalysisError::Cancelled)?;

        let sample_mean = mean_of(points);
        let centre_of_mass = params.resolve_centre_of_mass(sample_mean, mass.volume_centroid);
        let mut counts = HangabilityCounts::default();
        let (mut site_count, mut contact_count) = (0, 0);
        let found;
        match params.candidates {
            Candidates::Sites => {
                let tree = PointTree::build(points, &mut scratch)?;
                let search =
                    Hangability { surface: &surface, points, normals, tree: &tree, centre_of_mass, params };
                let (left, stop) = search.find(sites, &mut meter, scratch)?;
                (counts, site_count, found) = (left, left.sites, stop.map_or(Ok(()), Err));
            }
            Candidates::Contacts => {
                let search = object_contact::Search { surface: &surface, points, normals, centre_of_mass };
                (contact_count, found) = search.find(contacts, &mut counts, &mut meter);
            }
        }
        let stopped = found.err();
        if stopped == Some(Stop::Cancelled) {
            return Err(AnalysisError::Cancelled);
        }
        let (sites, contacts) = (&sites[..site_count], &contacts[..contact_count]);
        let corners = surface.triangles().iter().flatten();
        let reach = corners.map(|corner| (corner - centre_of_mass).norm()).fold(0.0, f32::max);
        Ok(Self {
            surface,
            field,
            contacts,
            reach,
            mass,
            centre_of_mass,
            sites,
            counts,
            work: meter.work,
            stopped,
        })
    }

    /// The object as mechanics sees it, if it was analysed with voxels.
    pub(super) fn body(&self) -> Option<Body<'_>> {
        let inverse_inertia = self.mass.inertia.try_inverse().unwrap_or_else(|| {
            // All of it on a line or in a point: as a ball of its size.
            nalgebra::Matrix3::identity() * (2.5 / (self.reach * self.reach).max(1e-9))
        });
        Some(Body {
            field: self.field.as_ref()?,
            surface: &self.surface,
            centre: self.centre_of_mass,
            inverse_inertia,
            reach: self.reach,
            extent: self.surface.aabb().extents().max(),
        })
    }

    /// The signed distances of the mesh on a grid, if it was analysed with [`voxels`](Params::voxels).
    pub fn distance_field(&self) -> Option<&DistanceField<'m>> {
        self.field.as_ref()
    }

    /// Where the object can lie on something, what catches best first: [`Candidates::Contacts`].
    pub fn contacts(&self) -> &'m [ObjectContact] {
        self.contacts
    }

    /// The mesh, for rays and distances.
    pub fn surface(&self) -> &Surface<'m> {
        &self.surface
    }

    /// Area, volume and closedness of the mesh.
    pub fn mass(&self) -> &MassProperties {
        &self.mass
    }

    /// The centre of mass that the poses are made for, by [`Params::centre_of_mass`]; metres.
    pub fn centre_of_mass(&self) -> Point {
        self.centre_of_mass
    }

    /// Where the object can be hung, the best encircled site first: [`Candidates::Sites`].
    pub fn sites(&self) -> &'m [HangingSite] {
        self.sites
    }

    /// What was left after each step of the search for sites.
    pub fn counts(&self) -> HangabilityCounts {
        self.counts
    }

    /// Rays and distance queries spent.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Why the search for sites ended early, if it did; then there may be more than [`sites`](Self::sites).
    pub fn stopped(&self) -> Option<Stop> {
        self.stopped
    }
}

/// `h_c` of eq. (3). Summed in double precision, so that ten thousand terms lose nothing.
fn mean_of(points: &[Point]) -> Point {
    let sum: nalgebra::Vector3<f64> = points.iter().map(|point| point.coords.cast::<f64>()).sum();
    Point::from((sum / points.len() as f64).cast::<f32>())
}
