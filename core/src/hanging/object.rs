//! The thing that is hung.

use super::AnalysisError;
use super::method::{self, ObjectPlaces, ObjectSlots};
use super::samples::ObjectSamples;
use crate::geometry::{DistanceField, MassProperties, Mesh, Point, Surface, Symmetries, Symmetry, Vector};
use crate::mechanics::{Body, Views};
use crate::memory::{Arena, Limits, array_bytes, larger, model_bytes};
use crate::monitor::{Meter, Monitor, Stop, Work};
use crate::params::Params;

/// An object, analysed: shape, centre of mass and the places by which it may hang, in object coordinates. Immutable;
/// any number of threads may use it at once.
#[derive(Clone, Copy)]
pub struct Object<'m> {
    surface: Surface<'m>,
    field: Option<DistanceField<'m>>,
    places: ObjectPlaces<'m>,
    reach: f32,
    mass: MassProperties,
    centre_of_mass: Point,
    symmetries: Symmetries,
    views: Views<'m>,
    work: Work,
    stopped: Option<Stop>,
}

impl<'m> Object<'m> {
    /// Bytes of memory for any object within `limits`.
    pub const fn bytes(limits: &Limits) -> usize {
        let model = Surface::bytes(limits.triangles)
            .saturating_add(DistanceField::bytes(limits.voxels))
            .saturating_add(Views::BYTES)
            .saturating_add(method::object_bytes());
        let before_sampling = larger(
            MassProperties::scratch_bytes(limits.vertices, limits.triangles),
            larger(
                Surface::scratch_bytes(limits.triangles),
                DistanceField::scratch_bytes(limits.triangles, limits.voxels),
            ),
        );
        let samples = array_bytes::<Point>(limits.samples).saturating_mul(2);
        let with_samples = method::object_scratch_bytes(limits.samples);
        model_bytes(model.saturating_add(larger(before_sampling, samples.saturating_add(with_samples))))
    }

    /// The limits that this mesh and these params require.
    pub fn limits(mesh: &Mesh, params: &Params) -> Limits {
        Limits {
            vertices: mesh.vertices().len(),
            triangles: mesh.triangles().len(),
            samples: params.samples,
            voxels: params.voxels,
            ..Limits::NONE
        }
    }

    /// Analyses `mesh` in `memory`, which must hold [`Object::bytes`] for its [`limits`](Self::limits). The mesh need
    /// not stay.
    pub fn analyze(
        mesh: &Mesh,
        params: &Params,
        memory: &'m mut [u8],
        monitor: &Monitor,
    ) -> Result<Self, AnalysisError> {
        params.validate()?;
        let mut arena = Arena::new(memory, Self::bytes(&Self::limits(mesh, params)))?;
        let mut meter = Meter::new(monitor);

        let mass = MassProperties::of(mesh, arena.scratch(), &meter)?;
        let surface = Surface::build(mesh, mass.is_inside_out, &mut arena, &meter)?;
        let field = match params.voxels {
            0 => None,
            voxels => Some(DistanceField::build(&surface, voxels, &mut arena, &mut meter)?),
        };
        let views = Views::new(mesh.viewpoints(), &surface.aabb().centre(), &mut arena)?;
        let slots = ObjectSlots::new(params, &mut arena)?;
        meter.check()?;

        let mut scratch = arena.scratch();
        let points = scratch.slice::<Point>(params.samples)?;
        let normals = scratch.slice::<Vector>(params.samples)?;
        method::sample(mesh, params, points, normals, scratch.scratch(), &meter)?;
        if mass.is_inside_out {
            normals.iter_mut().for_each(|normal| *normal = -*normal);
        }
        meter.check()?;

        let sample_mean = mean_of(points);
        let centre_of_mass = params.resolve_centre_of_mass(sample_mean, mass.volume_centroid);
        let symmetries = match &field {
            Some(field) => Symmetries::find(&mass.inertia, &centre_of_mass, field, points, &meter)?,
            None => Symmetries::default(),
        };
        let samples = ObjectSamples { surface: &surface, points, normals, centre_of_mass, params };
        let (places, stopped) = slots.find(&samples, &mut meter, scratch)?;
        if stopped == Some(Stop::Cancelled) {
            return Err(AnalysisError::Cancelled);
        }
        let mut reach = 0.0_f32;
        for (step, corners) in surface.triangles().iter().enumerate() {
            meter.check_at(step)?;
            reach = corners.iter().map(|corner| (corner - centre_of_mass).norm()).fold(reach, f32::max);
        }
        let work = meter.work;
        Ok(Self { surface, field, places, reach, mass, centre_of_mass, symmetries, views, work, stopped })
    }

    /// The object as mechanics sees it, if it was analysed with voxels.
    pub(crate) fn body(&self) -> Option<Body<'_>> {
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
            views: self.views,
        })
    }

    /// The signed distances of the mesh on a grid, if it was analysed with [`voxels`](Params::voxels).
    pub fn distance_field(&self) -> Option<&DistanceField<'m>> {
        self.field.as_ref()
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

    /// Turns after which the object looks as before, as far as they were detected: of an object that was analysed without
    /// [`voxels`](Params::voxels) none are.
    pub fn symmetries(&self) -> &[Symmetry] {
        self.symmetries.as_slice()
    }

    /// Where the object may hang, by the method that it was analysed with.
    pub fn places(&self) -> &ObjectPlaces<'m> {
        &self.places
    }

    /// Rays and distance queries spent.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Why the search for places ended early, if it did; then [`places`](Self::places) may lack some.
    pub fn stopped(&self) -> Option<Stop> {
        self.stopped
    }
}

/// `h_c` of eq. (3). Summed in double precision, so that ten thousand terms lose nothing.
fn mean_of(points: &[Point]) -> Point {
    let sum: nalgebra::Vector3<f64> = points.iter().map(|point| point.coords.cast::<f64>()).sum();
    Point::from((sum / points.len() as f64).cast::<f32>())
}
