use crate::border::{
    DETAIL, Public, Region, check, check_size, input, inputs, keep_apart, report, rows, rows_mut,
};
use crate::depth_failure::{DepthFailure, What};
use crate::depth_image::{check_all, hangpose_depth_image};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::status::*;
use hangpose_core::geometry::Aabb;
use hangpose_core::perception::completion::{CompletionSettings, room};
use hangpose_core::perception::volume::VolumeSettings;

/// Resolution and extent of a volume, and how far its completion may go. Set the struct with
/// hangpose_volume_settings_init, then change single fields.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_volume_settings {
    /// sizeof(hangpose_volume_settings), set by hangpose_volume_settings_init.
    pub struct_size: u32,
    /// 1 to store all of the crop box, so that the volume can be completed; 0 to store only the surroundings of the
    /// surfaces. Default: 0.
    pub dense: u32,
    /// 1 if a camera sees past everything at pixels without a depth, except for gaps of up to 7 pixels. It holds for an
    /// object that is held alone, with nothing behind it within the camera's range. Else 0, the default.
    pub missing_is_free: u32,
    /// Distance between neighbouring voxels, metres. The voxels are at its integer multiples in world coordinates.
    pub voxel: f32,
    /// Distance from the surface at which distances are cut off, metres: 2 to 32 voxels. Larger values bear more noise;
    /// walls thinner than half of it become thicker than they are. Default: 4 voxels.
    pub truncation: f32,
    /// Depth along the z axis of the camera beyond which surfaces are not stored, metres. What is before them is still
    /// free. Default: 5.
    pub max_depth: f32,
    /// For a completion: greatest thickness behind a surface that was seen from one side only and does not curve around
    /// what is behind it, metres. Default: 0.01.
    pub thickness: f32,
    /// For a completion: greatest radius of a ball that surfaces hold from two sides, metres. A bar of a greater radius
    /// stays open. Default: 0.06.
    pub radius: f32,
    /// Two rows of x, y, z: lower and upper corner of the box outside of which nothing is stored, metres, in world
    /// coordinates. Null for everything within 32767 voxels of the origin, which a dense volume cannot store. Default:
    /// null.
    pub crop: *const f32,
}

// SAFETY: `repr(C)` over numbers and a pointer, `struct_size` first.
unsafe impl Public for hangpose_volume_settings {
    const NAME: &'static str = "settings";
}

/// Sets `settings` to the defaults for voxels of this size, metres: about the distance between the points of
/// neighbouring pixels. `struct_size` is sizeof(hangpose_volume_settings). Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_volume_settings_init(
    settings: *mut hangpose_volume_settings,
    struct_size: usize,
    voxel: f32,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let init = || {
        check_size::<hangpose_volume_settings>(struct_size)?;
        keep_apart(&[Region::written(DETAIL, detail, 1), Region::written("settings", settings, 1)])?;
        check(hangpose_volume_settings::NAME, settings.cast_const())?;
        let VolumeSettings { voxel, truncation, crop: _, dense, max_depth, missing_is_free } =
            VolumeSettings::new(voxel);
        let CompletionSettings { thickness, radius } = CompletionSettings::default();
        let defaults = hangpose_volume_settings {
            struct_size: struct_size as u32,
            dense: u32::from(dense),
            missing_is_free: u32::from(missing_is_free),
            voxel,
            truncation,
            max_depth,
            thickness,
            radius,
            crop: core::ptr::null(),
        };
        // SAFETY: not null, aligned, and of the size that the caller vouches for.
        unsafe { settings.write(defaults) };
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, init) }
}

impl hangpose_volume_settings {
    /// The settings as the core takes them, each checked.
    ///
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    pub(crate) unsafe fn check(&self) -> Result<(VolumeSettings, CompletionSettings), DepthFailure> {
        let flag = |field, value| match value {
            0 => Ok(false),
            1 => Ok(true),
            value => Err(Failure::Choice { field, value, most: 1 }),
        };
        let crop = match self.crop.is_null() {
            true => None,
            false => {
                // SAFETY: those of this function.
                let corners = unsafe { rows("settings.crop", self.crop, 2) }?;
                Some(Aabb { min: corners[0].into(), max: corners[1].into() })
            }
        };
        let settings = VolumeSettings {
            voxel: self.voxel,
            truncation: self.truncation,
            crop,
            dense: flag("settings.dense", self.dense)?,
            max_depth: self.max_depth,
            missing_is_free: flag("settings.missing_is_free", self.missing_is_free)?,
        };
        settings.validate()?;
        let guess = CompletionSettings { thickness: self.thickness, radius: self.radius };
        guess.validate()?;
        Ok((settings, guess))
    }

    pub(crate) fn regions(&self) -> [Region; 2] {
        [Region::read("settings", self, 1), Region::read("settings.crop", self.crop.cast::<[f32; 3]>(), 2)]
    }
}

/// Sets `crop`, two rows of x, y, z, to the lower and upper corner of a crop box around an object that is held alone:
/// around what the pixels of `images` show, and around the room behind it that a completion may fill. Metres, in world
/// coordinates. `images` is an array of `image_count` structs, at least 1. Of the `settings`, `dense` and `crop` are
/// not used. Returns HANGPOSE_OK; or an error, such as HANGPOSE_ERROR_BLANK if no pixel of the label shows anything up to
/// settings->max_depth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_volume_room(
    images: *const hangpose_depth_image,
    image_count: u32,
    settings: *const hangpose_volume_settings,
    crop: *mut f32,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let find = || {
        // SAFETY: the caller vouches for the pointers.
        let (images, settings) = unsafe { (inputs("image_count", images, image_count)?, input(settings)?) };
        let written =
            [Region::written(DETAIL, detail, 1), Region::written("crop", crop.cast::<[f32; 3]>(), 2)];
        let [detail_region, crop_region] = written;
        let array = Region::read("images", images.as_ptr(), images.len());
        keep_apart(&[detail_region, crop_region, Region::read("settings", settings, 1), array])?;
        for image in images {
            let [depths, labels] = image.regions();
            keep_apart(&[detail_region, crop_region, depths, labels])?;
        }
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let crop = unsafe { rows_mut("crop", crop, 2) }?;
        let settings = hangpose_volume_settings { dense: 0, crop: core::ptr::null(), ..*settings };
        // SAFETY: the caller vouches for the pointers.
        let (settings, guess) = unsafe { settings.check() }?;
        // SAFETY: the caller vouches for the images.
        unsafe { check_all(images) }?;
        // SAFETY: the caller vouches for the images.
        let shown = images.iter().filter_map(|image| unsafe { image.check() }.ok());
        let margin = settings.truncation + 2.0 * settings.voxel;
        let max_depth = settings.max_depth;
        let found = room(shown, &guess, max_depth, margin).ok_or(What::NoRoom { max_depth })?;
        crop.copy_from_slice(&[found.min.into(), found.max.into()]);
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<DepthFailure>(detail, find) }
}

/// Returns the number of blocks of 8 x 8 x 8 voxels in the crop box: what a dense volume takes. Returns 0 if `settings`
/// is null, has no crop box or is not valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_volume_blocks(settings: *const hangpose_volume_settings) -> u32 {
    // SAFETY: the caller vouches for the pointers.
    let checked = unsafe { input(settings) }.ok().and_then(|settings| unsafe { settings.check() }.ok());
    let blocks = checked.and_then(|(settings, _)| settings.dense_blocks());
    blocks.map_or(0, |blocks| u32::try_from(blocks).unwrap_or(u32::MAX))
}
