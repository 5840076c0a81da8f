use crate::border::{Region, elements, rows};
use crate::failure::Failure;
use crate::place::Place;
use hangpose_core::geometry::MAX_COORDINATE;
use hangpose_core::hanging::{self, RegionError};

/// What a region is made of, one of HANGPOSE_REGION_*.
pub type hangpose_region_shape = u32;

/// All of the object or of the supporter. No other field counts.
pub const HANGPOSE_REGION_EVERYWHERE: hangpose_region_shape = 0;
/// What is in the box from hangpose_region.low to hangpose_region.high.
pub const HANGPOSE_REGION_BOX: hangpose_region_shape = 1;
/// What is within hangpose_region.radius of points: of one point for "here", or of a part of the supporter's cloud.
pub const HANGPOSE_REGION_POINTS: hangpose_region_shape = 2;
/// What is within hangpose_region.radius of triangles of a mesh.
pub const HANGPOSE_REGION_TRIANGLES: hangpose_region_shape = 3;

/// A part of an object or of a supporter, in its coordinates; zeros for all of it. Part of hangpose_request. The
/// library keeps no pointer to the arrays after the call.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hangpose_region {
    /// One of HANGPOSE_REGION_*.
    pub shape: hangpose_region_shape,
    /// With HANGPOSE_REGION_BOX: x, y, z of the lower corner, metres, each within +-1,000,000.
    pub low: [f32; 3],
    /// With HANGPOSE_REGION_BOX: x, y, z of the upper corner, metres, each at least that of `low` and up to 1,000,000.
    pub high: [f32; 3],
    /// Largest distance from the points or triangles, metres; 0 to 1,000,000.
    pub radius: f32,
    /// Number of points, at least 1 with HANGPOSE_REGION_POINTS and HANGPOSE_REGION_TRIANGLES.
    pub point_count: u32,
    /// Number of triangles, at least 1 with HANGPOSE_REGION_TRIANGLES.
    pub triangle_count: u32,
    /// Number of indices, at least 1 if `indices` is not null.
    pub index_count: u32,
    /// Array of point_count rows of x, y, z: metres, each within +-1,000,000. With HANGPOSE_REGION_TRIANGLES these are
    /// the vertices of the mesh.
    pub points: *const f32,
    /// Array of triangle_count rows of three indices of points, counted from 0.
    pub triangles: *const u32,
    /// Array of index_count indices, counted from 0, of the points or triangles that count. With HANGPOSE_REGION_POINTS
    /// it may be null if index_count is 0: all points count.
    pub indices: *const u32,
}

/// Names of the fields of a region in messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Names {
    region: &'static str,
    shape: &'static str,
    low: &'static str,
    high: &'static str,
    radius: &'static str,
    point_count: &'static str,
    triangle_count: &'static str,
    index_count: &'static str,
    points: &'static str,
    triangles: &'static str,
    indices: &'static str,
}

macro_rules! names {
    ($region:literal) => {
        Names {
            region: $region,
            shape: concat!($region, ".shape"),
            low: concat!($region, ".low"),
            high: concat!($region, ".high"),
            radius: concat!($region, ".radius"),
            point_count: concat!($region, ".point_count"),
            triangle_count: concat!($region, ".triangle_count"),
            index_count: concat!($region, ".index_count"),
            points: concat!($region, ".points"),
            triangles: concat!($region, ".triangles"),
            indices: concat!($region, ".indices"),
        }
    };
}

/// The region of the supporter.
pub(crate) const ON: Names = names!("request.on");
/// The region of the object.
pub(crate) const BY: Names = names!("request.by");

impl hangpose_region {
    pub(crate) const EVERYWHERE: Self = Self {
        shape: HANGPOSE_REGION_EVERYWHERE,
        low: [0.0; 3],
        high: [0.0; 3],
        radius: 0.0,
        point_count: 0,
        triangle_count: 0,
        index_count: 0,
        points: core::ptr::null(),
        triangles: core::ptr::null(),
        indices: core::ptr::null(),
    };

    /// The region as the core takes it. The core checks the numbers.
    ///
    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    pub(crate) unsafe fn check(&self, names: &Names) -> Result<hanging::Region<'_>, Failure> {
        let &Self { shape, low, high, radius, .. } = self;
        match shape {
            HANGPOSE_REGION_EVERYWHERE => Ok(hanging::Region::Everywhere),
            HANGPOSE_REGION_BOX => Ok(hanging::Region::Box { low, high }),
            HANGPOSE_REGION_POINTS => {
                let indices = match self.indices.is_null() && self.index_count == 0 {
                    true => None,
                    // SAFETY: those of this function.
                    false => Some(unsafe { self.indices(names) }?),
                };
                // SAFETY: those of this function.
                Ok(hanging::Region::Points { points: unsafe { self.points(names) }?, indices, radius })
            }
            HANGPOSE_REGION_TRIANGLES => {
                check_count(names.triangle_count, self.triangle_count)?;
                // SAFETY: those of this function.
                let (vertices, triangles, indices) = unsafe {
                    (
                        self.points(names)?,
                        rows(names.triangles, self.triangles, self.triangle_count)?,
                        self.indices(names)?,
                    )
                };
                Ok(hanging::Region::Triangles { vertices, triangles, indices, radius })
            }
            value => Err(Failure::Choice { field: names.shape, value, most: HANGPOSE_REGION_TRIANGLES }),
        }
    }

    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    unsafe fn points(&self, names: &Names) -> Result<&[[f32; 3]], Failure> {
        check_count(names.point_count, self.point_count)?;
        // SAFETY: those of this function.
        unsafe { rows(names.points, self.points, self.point_count) }
    }

    /// # Safety
    ///
    /// The obligations of the caller, see `border`.
    unsafe fn indices(&self, names: &Names) -> Result<&[u32], Failure> {
        check_count(names.index_count, self.index_count)?;
        // SAFETY: those of this function.
        unsafe { elements(names.indices, self.indices, self.index_count) }
    }

    /// The arrays, whatever the shape.
    pub(crate) fn regions(&self, names: &Names) -> [Region; 3] {
        [
            Region::read(names.points, self.points.cast::<[f32; 3]>(), self.point_count as usize),
            Region::read(names.triangles, self.triangles.cast::<[u32; 3]>(), self.triangle_count as usize),
            Region::read(names.indices, self.indices, self.index_count as usize),
        ]
    }
}

fn check_count(field: &'static str, count: u32) -> Result<(), Failure> {
    if count == 0 { Err(Failure::Count { field, count: 0, most: u32::MAX as usize }) } else { Ok(()) }
}

/// Where in a region the error is.
pub(crate) fn region_place(error: RegionError, region: &hanging::Region, names: &Names) -> Place {
    let is_usable = |point: &[f32; 3]| point.iter().all(|x| x.abs() <= MAX_COORDINATE);
    let radius_or_point = |radius: f32, points: &[[f32; 3]]| match points.iter().position(|p| !is_usable(p)) {
        Some(index) => Place::of(names.points).coordinate(Some(index), points[index]),
        None => Place::of(names.radius).value(f64::from(radius)).range([0.0, f64::from(MAX_COORDINATE)]),
    };
    let index_at = |field, place: Option<usize>, index: u32, count: usize| {
        let named = Place::of(field).value(f64::from(index)).range([0.0, count as f64 - 1.0]);
        Place { index: place, ..named }
    };
    match (error, region) {
        (RegionError::Empty, hanging::Region::Box { low, high }) => {
            let axis = (0..3).find(|&i| low[i] > high[i]).unwrap_or(0);
            Place::of(names.low).value(f64::from(low[axis])).range([f64::NEG_INFINITY, f64::from(high[axis])])
        }
        (RegionError::Number, hanging::Region::Box { low, high }) => {
            if is_usable(low) {
                Place::of(names.high).coordinate(None, *high)
            } else {
                Place::of(names.low).coordinate(None, *low)
            }
        }
        (RegionError::Number, hanging::Region::Points { points, radius, .. }) => {
            radius_or_point(*radius, points)
        }
        (RegionError::Number, hanging::Region::Triangles { vertices, radius, .. }) => {
            radius_or_point(*radius, vertices)
        }
        (RegionError::Index { index, count }, hanging::Region::Points { indices, .. }) => {
            let place = indices.unwrap_or_default().iter().position(|one| *one == index);
            index_at(names.indices, place, index, count)
        }
        (RegionError::Index { index, count }, hanging::Region::Triangles { triangles, indices, .. }) => {
            match indices.iter().position(|one| *one as usize >= triangles.len()) {
                Some(place) => index_at(names.indices, Some(place), index, count),
                None => {
                    let triangle = indices.iter().find(|one| triangles[**one as usize].contains(&index));
                    index_at(names.triangles, triangle.map(|one| *one as usize), index, count)
                }
            }
        }
        // The counts were checked before, and no other region has such an error.
        _ => Place::of(names.region),
    }
}
