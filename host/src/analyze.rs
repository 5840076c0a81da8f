//! The core's functions with memory from the heap.

use crate::files::{CloudFile, MeshFile};
use crate::geometry::{Cloud, CloudError, Mesh, MeshError};
use crate::hanging::{
    AnalysisError, HangingPose, Object, PredictError, Prediction, Request, Supporter, predict, predict_bytes,
};
use crate::memory::Limits;
use crate::perception::sampling;
use crate::{Monitor, Params};

/// Largest inputs that the command accepts, about 700 MB of memory. They keep a wrong file from exhausting the
/// computer.
pub const LIMITS: Limits = Limits {
    vertices: 4_000_000,
    triangles: 2_000_000,
    samples: 500_000,
    voxels: 10_000_000,
    points: 1_000_000,
};

/// An input exceeds a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{count} {what} are {} more than the limit of {limit}; {remedy}", count - limit)]
pub struct TooLarge {
    /// Name of the items that exceed the limit.
    pub what: &'static str,
    /// Number of items in the input.
    pub count: usize,
    /// Largest permitted number of items.
    pub limit: usize,
    /// How to reduce the input.
    pub remedy: &'static str,
}

impl TooLarge {
    /// Checks a mesh against [`LIMITS`].
    pub fn check_mesh(mesh: &MeshFile) -> Result<(), Self> {
        let remedy = "decimate the mesh";
        Self::check("vertices", mesh.vertices.len(), LIMITS.vertices, remedy)?;
        Self::check("triangles", mesh.triangles.len(), LIMITS.triangles, remedy)
    }

    /// Checks a cloud against [`LIMITS`].
    pub fn check_cloud(cloud: &CloudFile) -> Result<(), Self> {
        Self::check(
            "points",
            cloud.points.len(),
            LIMITS.points,
            "downsample the cloud, for example to one point per millimetre",
        )
    }

    fn check(what: &'static str, count: usize, limit: usize, remedy: &'static str) -> Result<(), Self> {
        if count > limit { Err(Self { what, count, limit, remedy }) } else { Ok(()) }
    }
}

impl MeshFile {
    /// The mesh as the core takes it.
    pub fn mesh(&self) -> Result<Mesh<'_>, MeshError> {
        Mesh::new(&self.vertices, &self.triangles)?.seen_from(&self.viewpoints)
    }
}

impl CloudFile {
    /// The cloud as the core takes it.
    pub fn cloud(&self) -> Result<Cloud<'_>, CloudError> {
        Cloud::new(&self.points, self.normals.as_deref())?.seen_from(&self.viewpoints)
    }
}

/// Calls [`Object::analyze`] after resizing `memory` to the required size.
pub fn analyze_object<'m>(
    mesh: &Mesh,
    params: &Params,
    memory: &'m mut Vec<u8>,
    monitor: &Monitor,
) -> Result<Object<'m>, AnalysisError> {
    params.validate()?;
    memory.resize(Object::bytes(&Object::limits(mesh, params)), 0);
    Object::analyze(mesh, params, memory, monitor)
}

/// Calls [`Supporter::analyze`] after resizing `memory` to the required size.
pub fn analyze_supporter<'m>(
    cloud: &Cloud,
    params: &Params,
    memory: &'m mut Vec<u8>,
    monitor: &Monitor,
) -> Result<Supporter<'m>, AnalysisError> {
    memory.resize(Supporter::bytes(&Limits::of_points(cloud.points().len())), 0);
    Supporter::analyze(cloud, params, memory, monitor)
}

/// Calls [`predict`] with scratch memory from the heap.
pub fn predict_poses<'p>(
    object: &Object,
    supporter: &Supporter,
    request: &Request,
    params: &Params,
    poses: &'p mut [HangingPose],
    monitor: &Monitor,
) -> Result<Prediction<'p>, PredictError> {
    predict(
        object,
        supporter,
        request,
        params,
        poses,
        &mut vec![0; predict_bytes(&supporter.limits())],
        monitor,
    )
}

/// Samples `count` points and normals on the mesh of a supporter.
pub fn sample_supporter(mesh: &Mesh, count: usize, seed: u64) -> CloudFile {
    let (mut points, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
    let mut memory = vec![0; sampling::sample_bytes(count)];
    sampling::sample(mesh, seed, &mut points, &mut normals, &mut memory)
        .expect("the memory has the size that sample_bytes returns");
    CloudFile { points, normals: Some(normals), ..CloudFile::default() }
}
