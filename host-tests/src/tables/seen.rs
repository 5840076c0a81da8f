//! What the predictor is given of a pair: its exact shapes, or a scan of them.

use super::case::Case;
use crate::scan::{SeenCloud, Shot, Spec, Surface, cloud, fuse};
use crate::shapes::Random;
use hangpose::geometry::{Cloud, CloudError, Mesh, MeshError};
use hangpose::perception::completion::CompletionSettings;
use hangpose::perception::depth::DepthImage;

/// The object's mesh and the supporter's cloud.
#[derive(Debug, PartialEq)]
pub(super) struct Seen {
    /// The object's mesh.
    pub(super) surface: Surface,
    /// The supporter's cloud.
    pub(super) cloud: SeenCloud,
}

impl Seen {
    /// The exact mesh, and samples of the exact surface of the supporter.
    pub(super) fn exactly(case: &Case) -> Self {
        let cloud = case.supporter_cloud();
        let (vertices, triangles) = (case.object.vertices.clone(), case.object.triangles.clone());
        Self {
            surface: Surface { seen: vec![1; vertices.len()], vertices, triangles, viewpoints: Vec::new() },
            cloud: SeenCloud { points: cloud.points, normals: cloud.normals, viewpoints: Vec::new() },
        }
    }

    /// A scan. Its random numbers depend on nothing but the pair, the numbers of images and whether they are sensible.
    pub(super) fn scanned(case: &Case, spec: &Spec) -> Self {
        let images_taken = Spec { is_open: false, ..*spec };
        let mut random = Random::named(&format!("{} {images_taken}", case.name), case.seed);
        let mut seen = Self::exactly(case);
        let object = spec.shoot_object(&case.object, &case.openings, &mut random);
        let supporter = spec.shoot_supporter(&case.supporter, &case.bars, &mut random);
        if spec.object > 0 {
            seen.surface = fuse(&images(&object), (!spec.is_open).then_some(&CompletionSettings::default()));
        }
        if spec.supporter > 0 {
            seen.cloud = cloud(&images(&supporter));
        }
        seen
    }

    /// The mesh as the core takes it.
    pub(super) fn mesh(&self) -> Result<Mesh<'_>, MeshError> {
        Mesh::new(&self.surface.vertices, &self.surface.triangles)?.seen_from(&self.surface.viewpoints)
    }

    /// The cloud as the core takes it.
    pub(super) fn cloud(&self) -> Result<Cloud<'_>, CloudError> {
        Cloud::new(&self.cloud.points, self.cloud.normals.as_deref())?.seen_from(&self.cloud.viewpoints)
    }
}

fn images(shots: &[Shot]) -> Vec<DepthImage<'_>> {
    shots.iter().filter_map(Shot::image).collect()
}

#[cfg(test)]
mod tests {
    use super::super::case::made;
    use super::*;

    #[test]
    fn scans_repeat_and_stay_near_the_true_shapes() {
        // The first three kinds are larger, which takes longer.
        let case = &made(4, 9)[3];
        let spec: Spec = "2+1s".parse().unwrap();
        let seen = Seen::scanned(case, &spec);
        assert_eq!(seen, Seen::scanned(case, &spec));
        assert!(seen.mesh().is_ok() && seen.cloud().unwrap().viewpoints().len() == 1);
        let of_object = Seen::scanned(case, &"2+0".parse().unwrap());
        assert_eq!(of_object.cloud, Seen::exactly(case).cloud);
        assert_ne!(of_object.surface, Seen::exactly(case).surface);
        // Flying pixels of an image end 3 cm behind it.
        let box_of = |points: &[[f32; 3]]| {
            let all = |pick: fn(f32, f32) -> f32, start| {
                points.iter().fold([start; 3], |a, p| std::array::from_fn(|i| pick(a[i], p[i])))
            };
            [all(f32::min, f32::INFINITY), all(f32::max, f32::NEG_INFINITY)]
        };
        let [low, high] = box_of(&case.object.vertices);
        let [seen_low, seen_high] = box_of(&seen.surface.vertices);
        for i in 0..3 {
            assert!(
                seen_low[i] > low[i] - 0.035 && seen_high[i] < high[i] + 0.035,
                "{seen_low:?} {seen_high:?}"
            );
        }
    }
}
