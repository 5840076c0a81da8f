//! Pinhole cameras with Brown-Conrady distortion.
//!
//! Camera coordinates are those of OpenCV and ROS optical frames: x to the right, y down, z forward. Pixel (0, 0) is the
//! centre of the upper left pixel.

/// Steps of the fixed-point iteration that removes the distortion. With the coefficients of usual lenses, each step gains
/// more than one decimal.
const UNDISTORTION_STEPS: usize = 12;
/// Points nearer to the camera's plane than this, metres, have no projection.
const MIN_DEPTH: f32 = 1e-6;

/// A pinhole camera with Brown-Conrady distortion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthCamera {
    size: [u32; 2],
    focal: [f32; 2],
    centre: [f32; 2],
    distortion: [f32; 5],
}

/// Why numbers do not describe a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraError {
    /// The width or the height is zero, or they have more pixels than a `u32` can index.
    Size {
        /// Width and height, pixels.
        size: [u32; 2],
    },
    /// A focal length is not a positive number.
    FocalLength {
        /// Focal lengths fx and fy, pixels.
        focal: [f32; 2],
    },
    /// The principal point is outside the image, as with intrinsics of another resolution.
    PrincipalPoint {
        /// Principal point cx and cy, pixels.
        centre: [f32; 2],
        /// Width and height, pixels.
        size: [u32; 2],
    },
    /// A coefficient of the distortion is infinite or not a number.
    Distortion {
        /// k1, k2, p1, p2, k3.
        distortion: [f32; 5],
    },
}

impl core::fmt::Display for CameraError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Size { size: [width, height] } => {
                write!(
                    f,
                    "the image size {width} x {height} is not usable: give the width and height in pixels"
                )
            }
            Self::FocalLength { focal: [x, y] } => {
                write!(f, "the focal lengths fx = {x} and fy = {y} must be positive numbers of pixels")
            }
            Self::PrincipalPoint { centre: [x, y], size: [width, height] } => write!(
                f,
                "the principal point cx = {x:?}, cy = {y:?} is outside an image of {width} x {height}: the intrinsics may belong to another resolution (scale fx, fy, cx and cy like the image)"
            ),
            Self::Distortion { distortion } => {
                write!(
                    f,
                    "the distortion k1, k2, p1, p2, k3 = {distortion:?} must be numbers: give zeros where there is none"
                )
            }
        }
    }
}

impl core::error::Error for CameraError {}

impl DepthCamera {
    /// Checks a camera of `size` (width, height, pixels), `focal` lengths (fx, fy, pixels), principal point `centre` (cx,
    /// cy, pixels) and `distortion` (k1, k2, p1, p2, k3; zeros for none).
    pub fn new(
        size: [u32; 2],
        focal: [f32; 2],
        centre: [f32; 2],
        distortion: [f32; 5],
    ) -> Result<Self, CameraError> {
        if size.contains(&0) || u64::from(size[0]) * u64::from(size[1]) > u64::from(u32::MAX) {
            return Err(CameraError::Size { size });
        }
        if !focal.iter().all(|f| f.is_finite() && *f > 0.0) {
            return Err(CameraError::FocalLength { focal });
        }
        let is_inside = |(c, s): (&f32, &u32)| *c >= 0.0 && *c <= *s as f32;
        if !centre.iter().zip(&size).all(is_inside) {
            return Err(CameraError::PrincipalPoint { centre, size });
        }
        if !distortion.iter().all(|k| k.is_finite()) {
            return Err(CameraError::Distortion { distortion });
        }
        Ok(Self { size, focal, centre, distortion })
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Focal lengths fx and fy, pixels.
    pub fn focal(&self) -> [f32; 2] {
        self.focal
    }

    /// Principal point cx and cy, pixels.
    pub fn centre(&self) -> [f32; 2] {
        self.centre
    }

    /// Whether the lens distorts.
    pub fn is_distorted(&self) -> bool {
        self.distortion != [0.0; 5]
    }

    /// The pixel coordinates at which the camera sees a point given in camera coordinates, metres; `None` if the point is
    /// not in front of the camera. They may be outside the image.
    pub fn project(&self, [x, y, z]: [f32; 3]) -> Option<[f32; 2]> {
        if z < MIN_DEPTH {
            return None;
        }
        let [x, y] = self.distort([x / z, y / z]);
        Some([self.focal[0] * x + self.centre[0], self.focal[1] * y + self.centre[1]])
    }

    /// The direction in camera coordinates in which the camera sees pixel coordinates: x and y at a depth z of one metre.
    pub fn direction(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        let seen = [(u - self.centre[0]) / self.focal[0], (v - self.centre[1]) / self.focal[1]];
        let mut undistorted = seen;
        if self.is_distorted() {
            for _ in 0..UNDISTORTION_STEPS {
                let again = self.distort(undistorted);
                undistorted = [0, 1].map(|i| undistorted[i] + seen[i] - again[i]);
            }
        }
        undistorted
    }

    /// Brown-Conrady distortion of a direction.
    fn distort(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        [
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [640, 480];

    #[test]
    fn direction_inverts_projection() {
        // Coefficients of a RealSense colour camera and of a wide lens, of both signs.
        for distortion in [[0.0; 5], [0.12, -0.24, 1e-3, -5e-4, 0.1], [-0.28, 0.07, 2e-4, 1e-4, 0.0]] {
            let camera = DepthCamera::new(SIZE, [525.0, 520.0], [319.5, 241.0], distortion).unwrap();
            for pixel in [[0.0, 0.0], [319.5, 241.0], [639.0, 10.0], [200.25, 479.0]] {
                let [x, y] = camera.direction(pixel);
                let [u, v] = camera.project([2.0 * x, 2.0 * y, 2.0]).unwrap();
                assert!((u - pixel[0]).abs() < 0.01 && (v - pixel[1]).abs() < 0.01, "{pixel:?} {u} {v}");
            }
        }
    }

    #[test]
    fn behind_the_camera_is_not_seen() {
        let camera = DepthCamera::new(SIZE, [500.0; 2], [320.0, 240.0], [0.0; 5]).unwrap();
        assert_eq!(camera.project([0.1, 0.1, -1.0]), None);
        assert_eq!(camera.project([0.1, 0.1, 0.0]), None);
        assert_eq!(camera.project([0.0, 0.2, 1.0]), Some([320.0, 340.0]));
    }

    #[test]
    fn names_what_is_broken() {
        let new = |size, focal, centre| DepthCamera::new(size, focal, centre, [0.0; 5]).unwrap_err();
        let centre = [320.0, 240.0];
        assert_eq!(new([0, 480], [1.0; 2], centre), CameraError::Size { size: [0, 480] });
        assert_eq!(new(SIZE, [0.0, 1.0], centre), CameraError::FocalLength { focal: [0.0, 1.0] });
        let error = new([320, 200], [500.0; 2], centre);
        assert_eq!(error, CameraError::PrincipalPoint { centre, size: [320, 200] });
        assert!(error.to_string().contains("another resolution"));
    }
}
