//! The errors of the functions that take depth images. They are apart from [`Failure`], so that a program without depth
//! images does not link their texts.

use crate::failure::{Failure, Reason};
use crate::place::Place;
use crate::status::*;
use core::fmt::{Display, Formatter};
use hangpose_core::memory::OutOfMemory;
use hangpose_core::perception::completion::CompletionError;
use hangpose_core::perception::depth::{CameraError, DepthImageError};
use hangpose_core::perception::depth_points::DepthPointsError;
use hangpose_core::perception::isosurface::IsosurfaceError;
use hangpose_core::perception::volume::{VolumeError, VolumeSettingsError};

/// Reason why a call with depth images did nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DepthFailure {
    what: What,
    /// Index of the image in an array.
    image: Option<usize>,
}

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum What {
    Failure(Failure),
    Camera(CameraError),
    Quaternion { quaternion: [f32; 4] },
    Image { error: DepthImageError, position: [f32; 3] },
    Settings(VolumeSettingsError),
    Volume(VolumeError),
    Completion(CompletionError),
    Surface(IsosurfaceError),
    Points(DepthPointsError),
    NoRoom { max_depth: f32 },
    NoPoints { outside: usize, flying: usize, grazing: usize },
}

impl DepthFailure {
    /// The same for image `index` of an array.
    pub(crate) fn of_image(self, index: usize) -> Self {
        Self { image: Some(index), ..self }
    }
}

impl Reason for DepthFailure {
    fn status(&self) -> hangpose_status {
        match &self.what {
            What::Failure(failure) => failure.status(),
            What::Camera(CameraError::Size { .. })
            | What::Image { error: DepthImageError::Size { .. }, .. }
            | What::Volume(VolumeError::Mask { .. })
            | What::Points(DepthPointsError::Mask { .. })
            | What::Surface(IsosurfaceError::TooLarge { .. }) => HANGPOSE_ERROR_COUNT,
            What::Image { error: DepthImageError::Blank, .. }
            | What::NoRoom { .. }
            | What::NoPoints { .. } => HANGPOSE_ERROR_BLANK,
            What::Settings(VolumeSettingsError::DenseWithoutCrop)
            | What::Volume(VolumeError::Settings(VolumeSettingsError::DenseWithoutCrop)) => {
                HANGPOSE_ERROR_NULL
            }
            What::Volume(VolumeError::DenseLimit { .. } | VolumeError::Full { .. })
            | What::Surface(IsosurfaceError::Vertices { .. } | IsosurfaceError::Triangles { .. })
            | What::Points(DepthPointsError::Full { .. }) => HANGPOSE_ERROR_CAPACITY,
            What::Completion(CompletionError::Sparse) => HANGPOSE_ERROR_SPARSE,
            What::Volume(VolumeError::OutOfMemory(_))
            | What::Completion(CompletionError::OutOfMemory(_))
            | What::Surface(IsosurfaceError::OutOfMemory(_)) => HANGPOSE_ERROR_MEMORY,
            What::Volume(VolumeError::Stopped(stop))
            | What::Completion(CompletionError::Stopped(stop))
            | What::Surface(IsosurfaceError::Stopped(stop)) => stopped(Some(*stop)),
            What::Camera(_)
            | What::Quaternion { .. }
            | What::Image { .. }
            | What::Settings(_)
            | What::Volume(VolumeError::Settings(_))
            | What::Completion(CompletionError::Settings { .. })
            | What::Points(DepthPointsError::Setting { .. }) => HANGPOSE_ERROR_VALUE,
        }
    }

    fn place(&self) -> Place {
        let place = match self.what {
            What::Failure(failure) => failure.place(),
            What::Camera(error) => camera_place(error),
            What::Quaternion { .. } => Place::of("image.quaternion"),
            What::Image { error, position } => image_place(error, position),
            What::Settings(error) | What::Volume(VolumeError::Settings(error)) => settings_place(error),
            What::Volume(VolumeError::DenseLimit { needed, limit }) => at_least("blocks", limit, needed),
            What::Volume(VolumeError::Full { limit, .. }) => at_least("volume", limit, limit + 1),
            What::Volume(VolumeError::Mask { labels, pixels })
            | What::Points(DepthPointsError::Mask { labels, pixels }) => {
                Place::of("image.label_count").value(labels as f64).range([pixels as f64; 2])
            }
            What::Completion(CompletionError::Sparse) => Place::of("volume"),
            What::Completion(CompletionError::Settings { thickness, radius }) => {
                let is_thickness = thickness.is_nan() || thickness < 0.0;
                let (field, value) = if is_thickness {
                    ("settings.thickness", thickness)
                } else {
                    ("settings.radius", radius)
                };
                positive(field, value)
            }
            What::Surface(IsosurfaceError::TooLarge { count, limit }) => {
                Place::of("mesh").value(count as f64).range([1.0, limit as f64])
            }
            What::Surface(IsosurfaceError::Vertices { needed, limit }) => {
                at_least("vertex_capacity", limit, needed)
            }
            What::Surface(IsosurfaceError::Triangles { needed, limit }) => {
                at_least("triangle_capacity", limit, needed)
            }
            What::Points(DepthPointsError::Setting { field, value, range }) => {
                let place = Place { prefix: "settings.", ..Place::of(field) };
                place.value(f64::from(value)).range(range.map(f64::from))
            }
            What::Points(DepthPointsError::Full { needed, limit }) => {
                at_least("point_capacity", limit, needed)
            }
            What::NoRoom { .. } | What::NoPoints { .. } => Place::of("images"),
            What::Volume(VolumeError::OutOfMemory(error))
            | What::Completion(CompletionError::OutOfMemory(error))
            | What::Surface(IsosurfaceError::OutOfMemory(error)) => Failure::from(error).place(),
            What::Volume(VolumeError::Stopped(_))
            | What::Completion(CompletionError::Stopped(_))
            | What::Surface(IsosurfaceError::Stopped(_)) => Place::default(),
        };
        Place { index: self.image.or(place.index), ..place }
    }

    fn overlap(&self) -> Option<[&'static str; 2]> {
        match &self.what {
            What::Failure(failure) => failure.overlap(),
            _ => None,
        }
    }
}

/// A capacity that is too small.
fn at_least(field: &'static str, given: usize, needed: usize) -> Place {
    Place::of(field).value(given as f64).range([needed as f64, f64::INFINITY])
}

/// A number that is not positive, or not a number.
fn positive(field: &'static str, value: f32) -> Place {
    Place::of(field).value(f64::from(value)).range([0.0, f64::INFINITY])
}

fn camera_place(error: CameraError) -> Place {
    match error {
        CameraError::Size { size: [width, height] } => {
            let (field, value) =
                if width == 0 { ("image.camera.width", width) } else { ("image.camera.height", height) };
            let most = f64::from(u32::MAX / width.max(1));
            Place::of(field).value(f64::from(value)).range([1.0, most])
        }
        CameraError::FocalLength { focal: [x, y] } => {
            positive("image.camera.focal", if x.is_finite() && x > 0.0 { y } else { x })
        }
        CameraError::PrincipalPoint { centre, size } => {
            let bad = (0..2).find(|&i| !(0.0 <= centre[i] && centre[i] <= size[i] as f32)).unwrap_or(0);
            let place = Place::of("image.camera.centre").value(f64::from(centre[bad]));
            place.range([0.0, f64::from(size[bad])])
        }
        CameraError::Distortion { .. } => Place::of("image.camera.distortion"),
    }
}

fn image_place(error: DepthImageError, position: [f32; 3]) -> Place {
    match error {
        DepthImageError::Size { given, size: [width, height] } => {
            let pixels = f64::from(width) * f64::from(height);
            Place::of("image.depth_count").value(given as f64).range([pixels; 2])
        }
        DepthImageError::Scale { scale } => positive("image.scale", scale),
        DepthImageError::Pose => Place::of("image.position").coordinate(None, position),
        DepthImageError::Blank => Place::of("image.depths"),
    }
}

fn settings_place(error: VolumeSettingsError) -> Place {
    match error {
        VolumeSettingsError::Voxel { voxel } => positive("settings.voxel", voxel),
        VolumeSettingsError::Truncation { truncation, range } => {
            Place::of("settings.truncation").value(f64::from(truncation)).range(range.map(f64::from))
        }
        VolumeSettingsError::MaxDepth { max_depth } => positive("settings.max_depth", max_depth),
        VolumeSettingsError::EmptyCrop { .. }
        | VolumeSettingsError::FarCrop { .. }
        | VolumeSettingsError::DenseWithoutCrop => Place::of("settings.crop"),
    }
}

impl Display for DepthFailure {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match &self.what {
            What::Failure(failure) => failure.fmt(f),
            What::Camera(error) => error.fmt(f),
            What::Quaternion { quaternion } => write!(
                f,
                "the quaternion x, y, z, w = {quaternion:?} is no rotation of the camera: give numbers that are not all zero (0, 0, 0, 1 for none)"
            ),
            What::Image { error, .. } => error.fmt(f),
            What::Settings(error) => error.fmt(f),
            What::Volume(VolumeError::OutOfMemory(error))
            | What::Completion(CompletionError::OutOfMemory(error))
            | What::Surface(IsosurfaceError::OutOfMemory(error)) => Failure::from(*error).fmt(f),
            What::Volume(error) => error.fmt(f),
            What::Completion(error) => error.fmt(f),
            What::Surface(error) => error.fmt(f),
            What::Points(error) => error.fmt(f),
            What::NoRoom { max_depth } => write!(
                f,
                "no pixel shows anything up to the greatest depth of {max_depth} m: check the depth scale, the labels and max_depth"
            ),
            What::NoPoints { outside, flying, grazing } => write!(
                f,
                "no pixel gives a point: {outside} are outside of the box or too deep, {flying} without a normal, {grazing} seen at too flat an angle: check the depth scale, the labels and the settings"
            ),
        }
    }
}

impl<E: Into<What>> From<E> for DepthFailure {
    fn from(error: E) -> Self {
        Self { what: error.into(), image: None }
    }
}

impl From<Failure> for What {
    fn from(error: Failure) -> Self {
        Self::Failure(error)
    }
}

impl From<OutOfMemory> for What {
    fn from(error: OutOfMemory) -> Self {
        Self::Failure(error.into())
    }
}

impl From<CameraError> for What {
    fn from(error: CameraError) -> Self {
        Self::Camera(error)
    }
}

impl From<VolumeSettingsError> for What {
    fn from(error: VolumeSettingsError) -> Self {
        Self::Settings(error)
    }
}

impl From<VolumeError> for What {
    fn from(error: VolumeError) -> Self {
        Self::Volume(error)
    }
}

impl From<CompletionError> for What {
    fn from(error: CompletionError) -> Self {
        Self::Completion(error)
    }
}

impl From<IsosurfaceError> for What {
    fn from(error: IsosurfaceError) -> Self {
        Self::Surface(error)
    }
}

impl From<DepthPointsError> for What {
    fn from(error: DepthPointsError) -> Self {
        Self::Points(error)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::{HANGPOSE_FIELD_CHARS, HANGPOSE_MESSAGE_CHARS};
    use hangpose_core::Stop;
    use hangpose_core::geometry::Aabb;
    use std::string::ToString;

    /// Every reason with the longest numbers, and the status and the field that it gives.
    #[test]
    fn every_reason_has_a_status_a_place_and_a_message_that_fits() {
        let (most, pixels, worst) = (usize::MAX, [u32::MAX; 2], -1.175_494_4e-38_f32);
        let far = Aabb { min: [worst; 3].into(), max: [-worst; 3].into() };
        let (needed, limit, labels) = (most, most - 1, most);
        let nothing = What::NoPoints { outside: most, flying: most, grazing: most };
        let image = |error| What::Image { error, position: [f32::NAN; 3] };
        let memory = OutOfMemory { needed, given: most };
        let reasons: [(What, hangpose_status, &str); 37] = [
            (Failure::Null { argument: "image" }.into(), HANGPOSE_ERROR_NULL, "image"),
            (CameraError::Size { size: [0, 1] }.into(), HANGPOSE_ERROR_COUNT, "image.camera.width"),
            (CameraError::Size { size: pixels }.into(), HANGPOSE_ERROR_COUNT, "image.camera.height"),
            (
                CameraError::FocalLength { focal: [worst; 2] }.into(),
                HANGPOSE_ERROR_VALUE,
                "image.camera.focal",
            ),
            (
                CameraError::PrincipalPoint { centre: [worst; 2], size: pixels }.into(),
                HANGPOSE_ERROR_VALUE,
                "image.camera.centre",
            ),
            (
                CameraError::Distortion { distortion: [worst; 5] }.into(),
                HANGPOSE_ERROR_VALUE,
                "image.camera.distortion",
            ),
            (What::Quaternion { quaternion: [worst; 4] }, HANGPOSE_ERROR_VALUE, "image.quaternion"),
            (
                image(DepthImageError::Size { given: most, size: pixels }),
                HANGPOSE_ERROR_COUNT,
                "image.depth_count",
            ),
            (image(DepthImageError::Scale { scale: worst }), HANGPOSE_ERROR_VALUE, "image.scale"),
            (image(DepthImageError::Pose), HANGPOSE_ERROR_VALUE, "image.position"),
            (image(DepthImageError::Blank), HANGPOSE_ERROR_BLANK, "image.depths"),
            (VolumeSettingsError::Voxel { voxel: worst }.into(), HANGPOSE_ERROR_VALUE, "settings.voxel"),
            (
                VolumeSettingsError::Truncation { truncation: worst, range: [worst; 2] }.into(),
                HANGPOSE_ERROR_VALUE,
                "settings.truncation",
            ),
            (VolumeSettingsError::EmptyCrop { crop: far }.into(), HANGPOSE_ERROR_VALUE, "settings.crop"),
            (
                VolumeSettingsError::FarCrop { crop: far, limit: 0.032_765 }.into(),
                HANGPOSE_ERROR_VALUE,
                "settings.crop",
            ),
            (VolumeSettingsError::DenseWithoutCrop.into(), HANGPOSE_ERROR_NULL, "settings.crop"),
            (
                VolumeSettingsError::MaxDepth { max_depth: worst }.into(),
                HANGPOSE_ERROR_VALUE,
                "settings.max_depth",
            ),
            (
                VolumeError::Settings(VolumeSettingsError::DenseWithoutCrop).into(),
                HANGPOSE_ERROR_NULL,
                "settings.crop",
            ),
            (VolumeError::OutOfMemory(memory).into(), HANGPOSE_ERROR_MEMORY, "memory"),
            (VolumeError::DenseLimit { needed, limit }.into(), HANGPOSE_ERROR_CAPACITY, "blocks"),
            (
                VolumeError::Full { limit, used: most, pixels: most, of: most }.into(),
                HANGPOSE_ERROR_CAPACITY,
                "volume",
            ),
            (VolumeError::Mask { labels, pixels: most }.into(), HANGPOSE_ERROR_COUNT, "image.label_count"),
            (VolumeError::Stopped(Stop::Cancelled).into(), HANGPOSE_CANCELLED, ""),
            (VolumeError::Stopped(Stop::WorkLimit).into(), HANGPOSE_WORK_LIMIT, ""),
            (CompletionError::Sparse.into(), HANGPOSE_ERROR_SPARSE, "volume"),
            (
                CompletionError::Settings { thickness: worst, radius: worst }.into(),
                HANGPOSE_ERROR_VALUE,
                "settings.thickness",
            ),
            (
                CompletionError::Settings { thickness: 0.0, radius: f32::NAN }.into(),
                HANGPOSE_ERROR_VALUE,
                "settings.radius",
            ),
            (CompletionError::OutOfMemory(memory).into(), HANGPOSE_ERROR_MEMORY, "memory"),
            (CompletionError::Stopped(Stop::Cancelled).into(), HANGPOSE_CANCELLED, ""),
            (IsosurfaceError::OutOfMemory(memory).into(), HANGPOSE_ERROR_MEMORY, "memory"),
            (IsosurfaceError::TooLarge { count: most, limit }.into(), HANGPOSE_ERROR_COUNT, "mesh"),
            (IsosurfaceError::Vertices { needed, limit }.into(), HANGPOSE_ERROR_CAPACITY, "vertex_capacity"),
            (
                IsosurfaceError::Triangles { needed, limit }.into(),
                HANGPOSE_ERROR_CAPACITY,
                "triangle_capacity",
            ),
            (
                DepthPointsError::Setting { field: "least_cosine", value: worst, range: [worst; 2] }.into(),
                HANGPOSE_ERROR_VALUE,
                "settings.least_cosine",
            ),
            (DepthPointsError::Full { needed, limit }.into(), HANGPOSE_ERROR_CAPACITY, "point_capacity"),
            (What::NoRoom { max_depth: worst }, HANGPOSE_ERROR_BLANK, "images"),
            (nothing, HANGPOSE_ERROR_BLANK, "images"),
        ];
        for (what, status, field) in reasons {
            let reason = DepthFailure::from(what);
            let (text, place) = (reason.to_string(), reason.place());
            assert_eq!(
                (reason.status(), std::format!("{}{}", place.prefix, place.field)),
                (status, field.into())
            );
            assert!(text.len() < HANGPOSE_MESSAGE_CHARS, "{} bytes: {text}", text.len());
            assert!(field.len() < HANGPOSE_FIELD_CHARS);
            assert_eq!(reason.of_image(3).place().index, Some(3));
        }
    }
}
