use crate::border::{
    DETAIL, Public, Region, check, check_size, input, inputs, keep_apart, output, report, rows, rows_mut,
};
use crate::cloud::hangpose_cloud;
use crate::depth_failure::{DepthFailure, What};
use crate::depth_image::{check_all, hangpose_depth_image};
use crate::detail::hangpose_detail;
use crate::failure::Failure;
use crate::status::*;
use hangpose_core::geometry::Aabb;
use hangpose_core::perception::depth_points::{
    DepthPoints, DepthPointsError, DepthPointsSettings, depth_points,
};

/// Which pixels of a depth image become points. Set the struct with hangpose_points_settings_init, then change single
/// fields.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_points_settings {
    /// sizeof(hangpose_points_settings), set by hangpose_points_settings_init.
    pub struct_size: u32,
    /// Only every so many columns and rows give points; at least 1, the default.
    pub stride: u32,
    /// Greatest depth along the z axis of the camera, metres. Default: 5.
    pub max_depth: f32,
    /// Standard deviation of the depth at one metre, metres; 0 to 1. It grows with the square of the depth. Default:
    /// 0.0014, that of structured light.
    pub noise: f32,
    /// Least cosine of the angle between the normal and the direction to the camera; 0.01 to 0.99. Default: 0.2.
    pub least_cosine: f32,
    /// Two rows of x, y, z: lower and upper corner of the box outside of which there are no points, metres, in world
    /// coordinates. Null for no box, the default.
    pub crop: *const f32,
}

// SAFETY: `repr(C)` over numbers and a pointer, `struct_size` first.
unsafe impl Public for hangpose_points_settings {
    const NAME: &'static str = "settings";
}

/// Sets `settings` to the defaults. `struct_size` is sizeof(hangpose_points_settings). Returns HANGPOSE_OK, or an error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_points_settings_init(
    settings: *mut hangpose_points_settings,
    struct_size: usize,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let init = || {
        check_size::<hangpose_points_settings>(struct_size)?;
        keep_apart(&[Region::written(DETAIL, detail, 1), Region::written("settings", settings, 1)])?;
        check(hangpose_points_settings::NAME, settings.cast_const())?;
        let DepthPointsSettings { crop: _, max_depth, noise, least_cosine, stride } = Default::default();
        let (struct_size, crop) = (struct_size as u32, core::ptr::null());
        let defaults = hangpose_points_settings { struct_size, stride, max_depth, noise, least_cosine, crop };
        // SAFETY: not null, aligned, and of the size that the caller vouches for.
        unsafe { settings.write(defaults) };
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<Failure>(detail, init) }
}

impl hangpose_points_settings {
    /// The settings as the core takes them, each checked.
    ///
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    unsafe fn check(&self) -> Result<DepthPointsSettings, DepthFailure> {
        let crop = match self.crop.is_null() {
            true => None,
            false => {
                // SAFETY: those of this function.
                let corners = unsafe { rows("settings.crop", self.crop, 2) }?;
                Some(Aabb { min: corners[0].into(), max: corners[1].into() })
            }
        };
        let &Self { struct_size: _, stride, max_depth, noise, least_cosine, crop: _ } = self;
        let settings = DepthPointsSettings { crop, max_depth, noise, least_cosine, stride };
        settings.validate()?;
        Ok(settings)
    }
}

type Rows<'a> = &'a mut [[f32; 3]];

/// Writes the points that depth images show, their normals and the viewpoints to arrays and sets `cloud` to them, ready
/// for hangpose_supporter_create: in world coordinates. Left out are pixels that an outline makes up between what is in
/// front and what is behind, and those seen at a flat angle. Set cloud->struct_size before the call; cloud->marks and
/// cloud->region are not changed.
///
/// `images` is an array of `image_count` structs, at least 1. `points` and `normals` are arrays of `point_capacity` rows
/// of x, y, z; the pixels of all images are always enough. `viewpoints` is an array of `image_count` rows. If all three
/// are null, only the counts of `cloud` are set.
///
/// Returns HANGPOSE_OK; or an error, such as HANGPOSE_ERROR_BLANK if there are no points, and `cloud` is unchanged.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hangpose_depth_points(
    images: *const hangpose_depth_image,
    image_count: u32,
    settings: *const hangpose_points_settings,
    points: *mut f32,
    normals: *mut f32,
    point_capacity: u32,
    viewpoints: *mut f32,
    cloud: *mut hangpose_cloud,
    detail: *mut hangpose_detail,
) -> hangpose_status {
    let write = || {
        // SAFETY: the caller vouches for the pointers.
        let (images, settings) = unsafe { (inputs("image_count", images, image_count)?, input(settings)?) };
        let rows = |name, pointer: *mut f32, count: u32| {
            Region::written(name, pointer.cast::<[f32; 3]>(), count as usize)
        };
        let written = [
            Region::written(DETAIL, detail, 1),
            rows("points", points, point_capacity),
            rows("normals", normals, point_capacity),
            rows("viewpoints", viewpoints, image_count),
            Region::written("cloud", cloud, 1),
        ];
        let [one, two, three, four, five] = written;
        keep_apart(&[
            one,
            two,
            three,
            four,
            five,
            Region::read("settings", settings, 1),
            Region::read("settings.crop", settings.crop.cast::<[f32; 3]>(), 2),
            Region::read("images", images.as_ptr(), images.len()),
        ])?;
        for image in images {
            let [depths, labels] = image.regions();
            keep_apart(&[one, two, three, four, five, depths, labels])?;
        }
        // SAFETY: the caller vouches for the pointers, and what is written is apart from the rest.
        let (settings, cloud) = unsafe { (settings.check()?, output(cloud)?) };
        // SAFETY: the caller vouches for the images.
        unsafe { check_all(images) }?;
        let is_counted = points.is_null() && normals.is_null() && viewpoints.is_null();
        let (mut point_rows, mut normal_rows, viewpoint_rows): (Rows, Rows, Rows) = match is_counted {
            true => (&mut [], &mut [], &mut []),
            // SAFETY: the caller vouches for the arrays, which are apart from the rest.
            false => unsafe {
                (
                    rows_mut("points", points, point_capacity)?,
                    rows_mut("normals", normals, point_capacity)?,
                    rows_mut("viewpoints", viewpoints, image_count)?,
                )
            },
        };
        let mut total = DepthPoints::default();
        for (index, image) in images.iter().enumerate() {
            // SAFETY: the caller vouches for the images.
            let (image, mask) = unsafe { image.check() }?;
            if let Some(viewpoint) = viewpoint_rows.get_mut(index) {
                *viewpoint = image.viewpoint().into();
            }
            match depth_points(&image, mask, &settings, point_rows, normal_rows) {
                Ok(found) => {
                    total.points += found.points;
                    total.outside += found.outside;
                    total.flying += found.flying;
                    total.grazing += found.grazing;
                    point_rows = &mut point_rows[found.points..];
                    normal_rows = &mut normal_rows[found.points..];
                }
                // The other images are counted, too, to say how many points there are.
                Err(DepthPointsError::Full { needed, .. }) => {
                    total.points += needed;
                    (point_rows, normal_rows) = (&mut [], &mut []);
                }
                Err(error) => return Err(error.into()),
            }
        }
        let DepthPoints { points: needed, outside, flying, grazing } = total;
        if needed == 0 {
            return Err(What::NoPoints { outside, flying, grazing }.into());
        }
        if needed > point_capacity as usize && !is_counted {
            return Err(DepthPointsError::Full { needed, limit: point_capacity as usize }.into());
        }
        cloud.point_count = u32::try_from(needed).unwrap_or(u32::MAX);
        cloud.viewpoint_count = image_count;
        (cloud.points, cloud.normals, cloud.viewpoints) = (points, normals, viewpoints);
        Ok(HANGPOSE_OK)
    };
    // SAFETY: the caller vouches for the detail.
    unsafe { report::<DepthFailure>(detail, write) }
}
