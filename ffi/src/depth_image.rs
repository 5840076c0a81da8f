use crate::border::{Public, Region, elements};
use crate::depth_failure::{DepthFailure, What};
use crate::pose::pose_of;
use hangpose_core::perception::depth::{DepthCamera, DepthImage, Mask};
use hangpose_core::perception::volume::VolumeError;

/// A pinhole camera with Brown-Conrady distortion. Its coordinates are those of OpenCV and of optical frames in ROS: x to
/// the right, y down, z forward. Pixel (0, 0) is the centre of the upper left pixel.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_camera {
    /// Width of the image, pixels.
    pub width: u32,
    /// Height of the image, pixels.
    pub height: u32,
    /// fx, fy: focal lengths, pixels.
    pub focal: [f32; 2],
    /// cx, cy: principal point, pixels.
    pub centre: [f32; 2],
    /// k1, k2, p1, p2, k3: coefficients of the distortion, in the order of OpenCV and of plumb_bob in ROS, no unit; zeros
    /// where there is none or it was removed.
    pub distortion: [f32; 5],
}

/// A depth image in the caller's arrays, with its camera. The library keeps no pointer to the arrays after the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_depth_image {
    /// sizeof(hangpose_depth_image), set by the caller.
    pub struct_size: u32,
    /// Number of depths: the width times the height of the camera's image.
    pub depth_count: u32,
    /// Number of labels: depth_count, or 0 if there are none.
    pub label_count: u32,
    /// Metres for each unit of depth: 0.001 where the depths are millimetres.
    pub scale: f32,
    /// The camera that took the image.
    pub camera: hangpose_camera,
    /// Pose of the camera: x, y, z of its position, metres, in world coordinates, each within +-1,000,000.
    pub position: [f32; 3],
    /// Pose of the camera: x, y, z, w of the quaternion that rotates camera coordinates into world coordinates; any length
    /// but zero.
    pub quaternion: [f32; 4],
    /// Array of depth_count distances along the z axis of the camera, row by row, in units of `scale`. 0 and 65535 mean
    /// that nothing was seen.
    pub depths: *const u16,
    /// Array of label_count labels, row by row: a segmentation of the image. Surfaces are taken only from pixels with the
    /// label `label`; the others still show where space is free. May be null: all pixels count.
    pub labels: *const u8,
    /// Label of the pixels that count.
    pub label: u8,
}

// SAFETY: `repr(C)` over numbers and pointers, `struct_size` first.
unsafe impl Public for hangpose_depth_image {
    const NAME: &'static str = "image";
}

impl hangpose_depth_image {
    /// The image and its mask as the core takes them.
    ///
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    pub(crate) unsafe fn check(&self) -> Result<(DepthImage<'_>, Option<Mask<'_>>), DepthFailure> {
        let hangpose_camera { width, height, focal, centre, distortion } = self.camera;
        let camera = DepthCamera::new([width, height], focal, centre, distortion)?;
        // SAFETY: those of this function.
        let depths = unsafe { elements("image.depths", self.depths, self.depth_count) }?;
        let &Self { position, quaternion, .. } = self;
        let pose = pose_of(position, quaternion).ok_or(What::Quaternion { quaternion })?;
        let image = DepthImage::new(camera, depths, self.scale, pose)
            .map_err(|error| What::Image { error, position })?;
        if self.labels.is_null() && self.label_count == 0 {
            return Ok((image, None));
        }
        // SAFETY: those of this function.
        let labels = unsafe { elements("image.labels", self.labels, self.label_count) }?;
        if labels.len() != depths.len() {
            return Err(VolumeError::Mask { labels: labels.len(), pixels: depths.len() }.into());
        }
        Ok((image, Some(Mask { labels, label: self.label })))
    }

    pub(crate) fn regions(&self) -> [Region; 2] {
        [
            Region::read("image.depths", self.depths, self.depth_count as usize),
            Region::read("image.labels", self.labels, self.label_count as usize),
        ]
    }
}

/// Checks every image of an array.
///
/// # Safety
///
/// The obligations of the caller, see `border`.
pub(crate) unsafe fn check_all(images: &[hangpose_depth_image]) -> Result<(), DepthFailure> {
    // SAFETY: those of this function.
    images.iter().enumerate().try_for_each(|(index, image)| match unsafe { image.check() } {
        Ok(_) => Ok(()),
        Err(failure) => Err(failure.of_image(index)),
    })
}
