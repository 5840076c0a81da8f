//! The points that a depth image shows, with normals: the cloud of a supporter.
//!
//! Kept are pixels on a surface that is seen at a fair angle. Left out are flying pixels, which an outline makes up between
//! what is in front and what is behind, and grazing ones, whose depth and normal say little.

mod error;
mod window;

pub use error::DepthPointsError;

use super::depth::{DepthImage, Mask};
use crate::geometry::Aabb;
use window::Window;

/// Which pixels become points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthPointsSettings {
    /// Box in world coordinates, metres, outside of which there are no points.
    pub crop: Option<Aabb>,
    /// Greatest depth along the camera's z axis, metres.
    pub max_depth: f32,
    /// Standard deviation of the depth at one metre, metres. It grows with the square of the depth.
    pub noise: f32,
    /// Least cosine of the angle between the normal and the way to the camera.
    pub least_cosine: f32,
    /// Only every so many columns and rows give points; 1 for all.
    pub stride: u32,
}

impl Default for DepthPointsSettings {
    /// The noise of structured light (1.4 mm at one metre), depths up to 5 m, angles up to 78 degrees, all pixels.
    fn default() -> Self {
        Self { crop: None, max_depth: 5.0, noise: 0.0014, least_cosine: 0.2, stride: 1 }
    }
}

/// What became of the pixels with a depth, of the mask's label and on the stride.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DepthPoints {
    /// Written as points.
    pub points: usize,
    /// Beyond the greatest depth or outside of the box.
    pub outside: usize,
    /// Between two surfaces, or without enough neighbours for a normal.
    pub flying: usize,
    /// Seen at too flat an angle.
    pub grazing: usize,
}

impl DepthPointsSettings {
    /// Checks all values.
    pub fn validate(&self) -> Result<(), DepthPointsError> {
        let fields = [
            ("max_depth", self.max_depth, 0.0, f32::INFINITY),
            ("noise", self.noise, 0.0, 1.0),
            ("least_cosine", self.least_cosine, 0.01, 0.99),
            ("stride", self.stride as f32, 1.0, f32::INFINITY),
        ];
        for (field, value, least, greatest) in fields {
            if !(least <= value && value <= greatest) {
                return Err(DepthPointsError::Setting { field, value, range: [least, greatest] });
            }
        }
        Ok(())
    }
}

/// Writes the points of an image in world coordinates, metres, and their unit normals, which face the camera, to the front
/// of the slices, row by row. Slices that are too short are an error that says how many points there are.
pub fn depth_points(
    image: &DepthImage,
    mask: Option<Mask>,
    settings: &DepthPointsSettings,
    points: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) -> Result<DepthPoints, DepthPointsError> {
    settings.validate()?;
    if let Some(mask) = mask.filter(|mask| mask.labels.len() != image.depths().len()) {
        return Err(DepthPointsError::Mask { labels: mask.labels.len(), pixels: image.depths().len() });
    }
    let rotation = image.pose().rotation.to_rotation_matrix();
    let viewpoint = image.viewpoint();
    let [width, height] = image.camera().size();
    let limit = points.len().min(normals.len());
    let mut counts = DepthPoints::default();
    for v in (0..height).step_by(settings.stride as usize) {
        for u in (0..width).step_by(settings.stride as usize) {
            let Some(point) = image.point(u, v) else { continue };
            if mask.is_some_and(|mask| !mask.holds((v * width + u) as usize)) {
                continue;
            }
            let place = viewpoint + rotation * point.coords;
            if point.z > settings.max_depth || settings.crop.is_some_and(|crop| !crop.contains(&place)) {
                counts.outside += 1;
                continue;
            }
            let window = Window::new(image, settings, [u, v], point.z);
            let Some(normal) = window.normal().filter(|_| !window.is_flying()) else {
                counts.flying += 1;
                continue;
            };
            if -normal.dot(&point.coords) < settings.least_cosine * point.coords.norm() {
                counts.grazing += 1;
                continue;
            }
            if counts.points < limit {
                points[counts.points] = place.into();
                normals[counts.points] = (rotation * normal).into();
            }
            counts.points += 1;
        }
    }
    if counts.points > limit {
        return Err(DepthPointsError::Full { needed: counts.points, limit });
    }
    Ok(counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Vector};
    use crate::perception::test_views::{SCALE, View, ball, camera, cuboid, look_from, torus};
    use crate::random::Random;

    fn points(
        view: &View,
        mask: Option<Mask>,
        settings: &DepthPointsSettings,
    ) -> (DepthPoints, Vec<[Point; 2]>) {
        let (mut points, mut normals) = (vec![[0.0; 3]; 80_000], vec![[0.0; 3]; 80_000]);
        let counts = depth_points(&view.image(), mask, settings, &mut points, &mut normals).unwrap();
        let pairs = points.iter().zip(&normals).take(counts.points);
        (counts, pairs.map(|(p, n)| [(*p).into(), (*n).into()]).collect())
    }

    /// Gradient of a distance.
    fn gradient(shape: fn(Point) -> f32, p: Point) -> Vector {
        let h = 1e-3;
        let along = |axis: Vector| shape(p + axis * h) - shape(p - axis * h);
        Vector::new(along(Vector::x()), along(Vector::y()), along(Vector::z())).normalize()
    }

    #[test]
    fn points_are_on_the_surface_and_normals_perpendicular_to_it() {
        for shape in [ball as fn(Point) -> f32, torus, cuboid] {
            let view = View::new(camera(), look_from(Point::new(0.25, 0.2, 0.22)), shape, 0.0);
            let (counts, found) = points(&view, None, &DepthPointsSettings::default());
            assert!(counts.points > 3000, "{counts:?}");
            let mut good = 0;
            for [point, normal] in &found {
                assert!(shape(*point).abs() < 2.0 * SCALE && (normal.coords.norm() - 1.0).abs() < 1e-4);
                assert!(normal.coords.dot(&(view.pose.translation.vector - point.coords)) > 0.0);
                good += usize::from(gradient(shape, *point).dot(&normal.coords) > 0.97);
            }
            // Along the edges of the box and at grazing angles they are means.
            assert!(good as f32 > 0.9 * found.len() as f32, "{good} of {}", found.len());
        }
    }

    #[test]
    fn noise_of_the_camera_keeps_the_normals_of_a_wall() {
        let mut view = View::new(camera(), Default::default(), |_| f32::INFINITY, 1.0);
        let mut random = Random::new(4);
        let mut normal = || (0..12).map(|_| random.next_f32()).sum::<f32>() - 6.0;
        view.depths
            .iter_mut()
            .for_each(|depth| *depth = (f32::from(*depth) + normal() * 0.0014 / SCALE) as u16);
        let (counts, found) = points(&view, None, &DepthPointsSettings::default());
        assert!(counts.points as f32 > 0.98 * view.depths.len() as f32, "{counts:?}");
        let mean = found.iter().map(|[_, n]| n.coords).sum::<Vector>() / found.len() as f32;
        assert!((mean.normalize() + Vector::z()).norm() < 0.01 && mean.norm() > 0.97, "{mean}");
    }

    #[test]
    fn flying_pixels_between_a_ball_and_a_wall_are_dropped() {
        let mut view = View::new(camera(), look_from(Point::new(0.4, 0.0, 0.0)), ball, 0.7);
        let wall = (0.7 / SCALE) as u16;
        let clean = view.depths.clone();
        // Every pixel of the wall beside the ball is halfway between.
        for i in 1..clean.len() - 1 {
            let nearest = clean[i - 1].min(clean[i + 1]);
            if clean[i] == wall && nearest < wall {
                view.depths[i] = nearest / 2 + wall / 2;
            }
        }
        assert!(view.depths != clean);
        let (counts, found) = points(&view, None, &DepthPointsSettings::default());
        assert!(counts.flying > 100);
        for [point, _] in found {
            let depth = 0.4 - point.x;
            assert!(ball(point).abs() < 0.002 || (depth - 0.7).abs() < 0.002, "{point} flies");
        }
    }

    #[test]
    fn box_mask_depth_and_stride_choose_pixels() {
        let view = View::new(camera(), look_from(Point::new(0.4, 0.0, 0.0)), ball, 0.7);
        let all = DepthPointsSettings::default();
        let (total, _) = points(&view, None, &all);
        let crop = Some(Aabb { min: [-0.06; 3].into(), max: [0.06; 3].into() });
        let (cropped, found) = points(&view, None, &DepthPointsSettings { crop, ..all });
        assert!(found.iter().all(|[p, _]| ball(*p).abs() < 0.001) && cropped.points < total.points / 2);
        let (near, found_near) = points(&view, None, &DepthPointsSettings { max_depth: 0.5, ..all });
        assert_eq!((near, found_near), (cropped, found.clone()));
        let labels: Vec<u8> = view.depths.iter().map(|d| u8::from(*d < 5000)).collect();
        let (masked, found_masked) = points(&view, Some(Mask { labels: &labels, label: 1 }), &all);
        assert_eq!((masked.points, found_masked), (cropped.points, found));
        let (coarse, _) = points(&view, None, &DepthPointsSettings { stride: 2, ..all });
        assert!((coarse.points as f32 / total.points as f32 - 0.25).abs() < 0.01);
    }

    #[test]
    fn names_what_is_broken() {
        let view = View::new(camera(), look_from(Point::new(0.4, 0.0, 0.0)), ball, 0.0);
        let fine = DepthPointsSettings::default();
        let (counts, _) = points(&view, None, &fine);
        let mut short = vec![[0.0; 3]; counts.points - 1];
        let error = depth_points(&view.image(), None, &fine, &mut short.clone(), &mut short).unwrap_err();
        assert_eq!(error, DepthPointsError::Full { needed: counts.points, limit: counts.points - 1 });
        let mask = Mask { labels: &[], label: 0 };
        let error =
            depth_points(&view.image(), Some(mask), &fine, &mut short.clone(), &mut short).unwrap_err();
        assert_eq!(error, DepthPointsError::Mask { labels: 0, pixels: 320 * 240 });
        for broken in [
            DepthPointsSettings { stride: 0, ..fine },
            DepthPointsSettings { noise: f32::NAN, ..fine },
            DepthPointsSettings { max_depth: -1.0, ..fine },
            DepthPointsSettings { least_cosine: 0.0, ..fine },
        ] {
            assert!(matches!(broken.validate(), Err(DepthPointsError::Setting { .. })));
        }
    }
}
