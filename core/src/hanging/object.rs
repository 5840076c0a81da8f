//! The thing that is hung.

use super::contacts::ObjectContact;
use super::method::{self, ObjectCounts, ObjectPlaces, ObjectSlots};
use super::samples::ObjectSamples;
use super::sites::HangingSite;
use super::{AnalysisError, Supporter};
use crate::geometry::{
    DistanceField, MassProperties, Mesh, Point, Pose, Surface, Symmetries, Symmetry, Vector, Viewpoints,
    principal_frame,
};
use crate::mechanics::{Body, Frames, Views};
use crate::memory::{Arena, Limits, array_bytes, larger, model_bytes};
use crate::monitor::{Meter, Monitor, Stop, Work};
use crate::params::{CentreOfMass, Params};
use nalgebra::Matrix3;

/// An object, analysed: shape, centre of mass and the places by which it may hang. Immutable; any number of threads may use it at
/// once.
///
/// It is analysed in a frame of its own, that of the principal axes of its surface, so that nothing depends on the coordinates in which the
/// mesh is given. [`surface`](Self::surface) and [`distance_field`](Self::distance_field) are in this [`frame`](Self::frame); all else
/// that is told is in object coordinates, those of the mesh.
#[derive(Clone, Copy)]
pub struct Object<'m> {
    /// From object coordinates to those of all that follows but the mass properties and the symmetries.
    frame: Pose,
    surface: Surface<'m>,
    field: Option<DistanceField<'m>>,
    places: ObjectPlaces<'m>,
    reach: f32,
    mass: MassProperties,
    centre_of_mass: Point,
    /// [`Body::centre_error`].
    centre_error: f32,
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
        let frame = principal_frame(|| mesh.quadrature(), &meter)?;
        let mesh = &mesh.in_frame(&frame);
        let surface = Surface::build(mesh, mass.is_inside_out, &mut arena, &meter)?;
        let field = match params.voxels {
            0 => None,
            voxels => Some(DistanceField::build(&surface, voxels, &mut arena, &mut meter)?),
        };
        let viewpoints = Viewpoints::new(mesh.viewpoints(), &frame);
        let views = Views::new(viewpoints, &surface.aabb().centre(), &mut arena)?;
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

        let centre_of_mass = match params.centre_of_mass {
            CentreOfMass::SampleMean => None,
            CentreOfMass::Volume => mass.volume_centroid,
            CentreOfMass::Given(point) => Some(Point::from(point)),
        };
        let of_surface = mean_of(points);
        let centre_of_mass = centre_of_mass.map_or(of_surface, |point| frame * point);
        // Whether an open mesh is a solid with holes in its surface or a sheet is not known.
        let is_solid_or_sheet = params.centre_of_mass == CentreOfMass::Volume && !mass.is_closed;
        let centre_error = if is_solid_or_sheet { (centre_of_mass - of_surface).norm() } else { 0.0 };
        let symmetries = match &field {
            Some(field) => {
                let inertia = rotated(&mass.inertia, &frame);
                let found = Symmetries::find(&inertia, &centre_of_mass, field, points, &meter)?;
                found.rotated(&frame.rotation.inverse())
            }
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
        Ok(Self {
            frame,
            surface,
            field,
            places,
            reach,
            mass,
            centre_of_mass,
            centre_error,
            symmetries,
            views,
            work,
            stopped,
        })
    }

    /// The object as mechanics sees it, if it was analysed with voxels.
    pub(crate) fn body(&self) -> Option<Body<'_>> {
        let inverse_inertia = rotated(&self.mass.inertia, &self.frame).try_inverse().unwrap_or_else(|| {
            // All of it on a line or in a point: as a ball of its size.
            Matrix3::identity() * (2.5 / (self.reach * self.reach).max(1e-9))
        });
        Some(Body {
            field: self.field.as_ref()?,
            surface: &self.surface,
            centre: self.centre_of_mass,
            centre_error: self.centre_error,
            frame: &self.frame,
            inverse_inertia,
            reach: self.reach,
            extent: self.surface.aabb().extents().max(),
            views: self.views,
        })
    }

    /// The frame of the object: maps object coordinates to those of [`surface`](Self::surface) and
    /// [`distance_field`](Self::distance_field). Its axes are the principal axes of the surface, x that along which it spreads most.
    pub fn frame(&self) -> &Pose {
        &self.frame
    }

    /// The signed distances of the mesh on a grid, in the object's [`frame`](Self::frame), if it was analysed with [`voxels`](Params::voxels).
    pub fn distance_field(&self) -> Option<&DistanceField<'m>> {
        self.field.as_ref()
    }

    /// The mesh, for rays and distances, in the object's [`frame`](Self::frame).
    pub fn surface(&self) -> &Surface<'m> {
        &self.surface
    }

    /// Area, volume and closedness of the mesh; in object coordinates.
    pub fn mass(&self) -> &MassProperties {
        &self.mass
    }

    /// The centre of mass that the poses are made for, by [`Params::centre_of_mass`]; in object coordinates, metres.
    pub fn centre_of_mass(&self) -> Point {
        self.frame.inverse_transform_point(&self.centre_of_mass)
    }

    /// By how much the centre of mass may be wrong, metres: for [`CentreOfMass::Volume`] of an open mesh, which is a solid with holes in
    /// its surface or a sheet, the distance between the centroids of both. Zero for closed meshes and given centres.
    pub fn centre_of_mass_error(&self) -> f32 {
        self.centre_error
    }

    /// The frames of the object and of a supporter.
    pub(crate) fn frames_with(&self, supporter: &Supporter) -> Frames {
        Frames { object: self.frame, supporter: *supporter.frame() }
    }

    /// The centre of mass in the object's frame.
    pub(super) fn centre(&self) -> Point {
        self.centre_of_mass
    }

    /// Turns after which the object looks as before, as far as they were detected: of an object that was analysed without
    /// [`voxels`](Params::voxels) none are.
    pub fn symmetries(&self) -> &[Symmetry] {
        self.symmetries.as_slice()
    }

    /// The hanging sites, the best encircled first; none by the contact method.
    pub fn sites(&self) -> impl ExactSizeIterator<Item = HangingSite> + use<'m> {
        let back = self.frame.inverse();
        self.places.sites().iter().map(move |site| site.moved(&back))
    }

    /// The contact candidates, the deepest capture first; none by the published method.
    pub fn contacts(&self) -> impl ExactSizeIterator<Item = ObjectContact> + use<'m> {
        let back = self.frame.inverse();
        self.places.contacts().iter().map(move |contact| contact.moved(&back))
    }

    /// How much was left after each step of the search for places, by the method that it was analysed with.
    pub fn counts(&self) -> ObjectCounts {
        self.places.counts()
    }

    /// The places, in the object's frame.
    pub(super) fn places(&self) -> &ObjectPlaces<'m> {
        &self.places
    }

    /// Rays and distance queries spent.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Why the search for places ended early, if it did; then some may be missing.
    pub fn stopped(&self) -> Option<Stop> {
        self.stopped
    }
}

/// A tensor in the axes of a frame.
fn rotated(tensor: &Matrix3<f32>, frame: &Pose) -> Matrix3<f32> {
    let rotation = frame.rotation.to_rotation_matrix();
    rotation.matrix() * tensor * rotation.matrix().transpose()
}

/// `h_c` of eq. (3). Summed in double precision, so that ten thousand terms lose nothing.
fn mean_of(points: &[Point]) -> Point {
    let sum: nalgebra::Vector3<f64> = points.iter().map(|point| point.coords.cast::<f64>()).sum();
    Point::from((sum / points.len() as f64).cast::<f32>())
}
