//! Depth images in the caller's memory, validated.

use super::DepthCamera;
use crate::geometry::{MAX_COORDINATE, Point, Pose};

/// Depths beyond every range: what cameras write where they saw nothing, apart from 0.
pub(crate) const NOTHING: u16 = u16::MAX;

/// A checked view of a depth image. Nothing is copied.
#[derive(Clone, Copy, Debug)]
pub struct DepthImage<'a> {
    camera: DepthCamera,
    depths: &'a [u16],
    scale: f32,
    pose: Pose,
}

/// Why a depth image cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DepthImageError {
    /// The number of depths is not that of the camera's pixels.
    Size {
        /// Number of depths given.
        given: usize,
        /// Width and height of the camera's image, pixels.
        size: [u32; 2],
    },
    /// The depth scale is not a positive number.
    Scale {
        /// Metres per unit of depth.
        scale: f32,
    },
    /// A component of the pose is infinite, not a number, or too large.
    Pose,
    /// No pixel has a depth.
    Blank,
}

impl core::fmt::Display for DepthImageError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Size { given, size: [width, height] } => {
                write!(
                    f,
                    "the image has {given} depths and the camera {width} x {height} pixels: give intrinsics of the image's resolution"
                )
            }
            Self::Scale { scale } => write!(
                f,
                "the depth scale {scale} must be a positive number of metres per unit (0.001 where the depths are millimetres)"
            ),
            Self::Pose => {
                write!(
                    f,
                    "the camera's pose has components that are not numbers of metres within ±{MAX_COORDINATE}"
                )
            }
            Self::Blank => {
                write!(
                    f,
                    "no pixel has a depth: all are 0 or {NOTHING}, which mean that the camera saw nothing"
                )
            }
        }
    }
}

impl core::error::Error for DepthImageError {}

impl<'a> DepthImage<'a> {
    /// Checks an image of `camera`: its `depths` row by row, along the camera's z axis, in units of `scale` metres, where
    /// 0 and 65535 mean that nothing was seen; and the camera's `pose`, which maps camera to world coordinates, metres.
    pub fn new(
        camera: DepthCamera,
        depths: &'a [u16],
        scale: f32,
        pose: Pose,
    ) -> Result<Self, DepthImageError> {
        if depths.len() != camera.pixels() {
            return Err(DepthImageError::Size { given: depths.len(), size: camera.size() });
        }
        if !scale.is_finite() || scale <= 0.0 {
            return Err(DepthImageError::Scale { scale });
        }
        let is_usable = |x: &f32| x.is_finite() && x.abs() <= MAX_COORDINATE;
        if !pose.translation.vector.iter().chain(pose.rotation.coords.iter()).all(is_usable) {
            return Err(DepthImageError::Pose);
        }
        if depths.iter().all(|depth| matches!(*depth, 0 | NOTHING)) {
            return Err(DepthImageError::Blank);
        }
        Ok(Self { camera, depths, scale, pose })
    }

    /// The camera.
    pub fn camera(&self) -> &DepthCamera {
        &self.camera
    }

    /// The depths as they were given, row by row, in units of [`scale`](Self::scale).
    pub fn depths(&self) -> &'a [u16] {
        self.depths
    }

    /// Metres per unit of depth.
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// Pose of the camera: maps camera to world coordinates.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Position of the camera in world coordinates, metres.
    pub fn viewpoint(&self) -> Point {
        self.pose.translation.vector.into()
    }

    /// Depth at column `u` and row `v` along the camera's z axis, metres; `None` where nothing was seen.
    pub fn depth(&self, u: u32, v: u32) -> Option<f32> {
        let [width, height] = self.camera.size();
        if u >= width || v >= height {
            return None;
        }
        match self.depths[v as usize * width as usize + u as usize] {
            0 | NOTHING => None,
            depth => Some(f32::from(depth) * self.scale),
        }
    }

    /// The point seen at column `u` and row `v`, in camera coordinates, metres; `None` where nothing was seen.
    pub fn point(&self, u: u32, v: u32) -> Option<Point> {
        let depth = self.depth(u, v)?;
        let [x, y] = self.camera.direction([u as f32, v as f32]);
        Some(Point::new(x * depth, y * depth, depth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> DepthCamera {
        DepthCamera::new([4, 3], [2.0; 2], [1.0, 1.0], [0.0; 5]).unwrap()
    }

    #[test]
    fn points_are_where_the_pixels_look() {
        let mut depths = [0; 12];
        depths[4 + 3] = 1500;
        let image = DepthImage::new(camera(), &depths, 0.001, Pose::identity()).unwrap();
        assert!((image.point(3, 1).unwrap() - Point::new(1.5, 0.0, 1.5)).norm() < 1e-6);
        assert_eq!(image.point(0, 0), None);
        assert_eq!(image.depth(4, 0), None);
    }

    #[test]
    fn names_what_is_broken() {
        let new =
            |depths: &[u16], scale| DepthImage::new(camera(), depths, scale, Pose::identity()).unwrap_err();
        assert_eq!(new(&[1; 11], 0.001), DepthImageError::Size { given: 11, size: [4, 3] });
        assert_eq!(new(&[1; 12], 0.0), DepthImageError::Scale { scale: 0.0 });
        assert_eq!(new(&[0; 12], 0.001), DepthImageError::Blank);
        assert_eq!(new(&[NOTHING; 12], 0.001), DepthImageError::Blank);
        let away = Pose::translation(f32::NAN, 0.0, 0.0);
        assert_eq!(DepthImage::new(camera(), &[1; 12], 0.001, away).unwrap_err(), DepthImageError::Pose);
    }
}
