//! What the predictor is given of a pair: its exact shapes, or a scan of them.

use super::case::Case;
use crate::scan::{SeenCloud, Shot, Spec, Surface, cloud, fuse};
use crate::shapes::Random;
use hangpose::geometry::{Cloud, CloudError, Mesh, MeshError};
use hangpose::perception::depth::DepthImage;

/// The object's mesh and the supporter's cloud.
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
            surface: Surface { vertices, triangles },
            cloud: SeenCloud { points: cloud.points, normals: cloud.normals, viewpoint: None },
        }
    }

    /// A scan. Its random numbers depend on nothing but the pair and the numbers of images.
    pub(super) fn scanned(case: &Case, spec: &Spec) -> Self {
        let mut random = Random::named(&format!("{} {spec}", case.name), case.seed);
        let mut seen = Self::exactly(case);
        let object = spec.shoot_object(&case.object, &case.openings, &mut random);
        let supporter = spec.shoot_supporter(&case.supporter, &case.bars, &mut random);
        if spec.object > 0 {
            seen.surface = fuse(&images(&object));
        }
        if spec.supporter > 0 {
            seen.cloud = cloud(&images(&supporter));
        }
        seen
    }

    /// The mesh as the core takes it.
    pub(super) fn mesh(&self) -> Result<Mesh<'_>, MeshError> {
        Mesh::new(&self.surface.vertices, &self.surface.triangles)
    }

    /// The cloud as the core takes it.
    pub(super) fn cloud(&self) -> Result<Cloud<'_>, CloudError> {
        let cloud = Cloud::new(&self.cloud.points, self.cloud.normals.as_deref())?;
        self.cloud.viewpoint.map_or(Ok(cloud), |viewpoint| cloud.seen_from(viewpoint))
    }
}

fn images(shots: &[Shot]) -> Vec<DepthImage<'_>> {
    shots.iter().filter_map(Shot::image).collect()
}
