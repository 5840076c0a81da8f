//! The core's analyses in memory that grows as needed.

use crate::files::{CloudFile, MeshFile};
use crate::geometry::{Cloud, CloudError, Mesh, MeshError};
use crate::hanging::{
    AnalysisError, HangingPose, Object, PredictError, Prediction, Supporter, predict, predict_bytes,
};
use crate::memory::Limits;
use crate::perception::sampling;
use crate::{Monitor, Params};

/// The largest inputs that the command takes, so that a wrong file does not fill the computer: about 700 MB.
pub const LIMITS: Limits = Limits {
    vertices: 4_000_000,
    triangles: 2_000_000,
    samples: 500_000,
    voxels: 10_000_000,
    points: 1_000_000,
};

/// An input is larger than a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{count} {what} are {} more than the limit of {limit}; {remedy}", count - limit)]
pub struct TooLarge {
    /// What there is too much of.
    pub what: &'static str,
    /// How many there are.
    pub count: usize,
    /// How many there may be.
    pub limit: usize,
    /// What to do about it.
    pub remedy: &'static str,
}

impl TooLarge {
    /// Holds a mesh against [`LIMITS`].
    pub fn check_mesh(mesh: &MeshFile) -> Result<(), Self> {
        let remedy = "decimate the mesh";
        Self::check("vertices", mesh.vertices.len(), LIMITS.vertices, remedy)?;
        Self::check("triangles", mesh.triangles.len(), LIMITS.triangles, remedy)
    }

    /// Holds a cloud against [`LIMITS`].
    pub fn check_cloud(cloud: &CloudFile) -> Result<(), Self> {
        Self::check(
            "points",
            cloud.points.len(),
            LIMITS.points,
            "thin the cloud out, for example to one point a millimetre",
        )
    }

    fn check(what: &'static str, count: usize, limit: usize, remedy: &'static str) -> Result<(), Self> {
        if count > limit { Err(Self { what, count, limit, remedy }) } else { Ok(()) }
    }
}

impl MeshFile {
    /// The mesh as the core takes it.
    pub fn mesh(&self) -> Result<Mesh<'_>, MeshError> {
        Mesh::new(&self.vertices, &self.triangles)
    }
}

impl CloudFile {
    /// The cloud as the core takes it.
    pub fn cloud(&self) -> Result<Cloud<'_>, CloudError> {
        Cloud::new(&self.points, self.normals.as_deref())
    }
}

/// [`Object::analyze`] in `memory`, which is resized to what the mesh takes.
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

/// [`Supporter::analyze`] in `memory`, which is resized to what the cloud takes.
pub fn analyze_supporter<'m>(
    cloud: &Cloud,
    params: &Params,
    memory: &'m mut Vec<u8>,
    monitor: &Monitor,
) -> Result<Supporter<'m>, AnalysisError> {
    memory.resize(Supporter::bytes(&Limits::of_points(cloud.points().len())), 0);
    Supporter::analyze(cloud, params, memory, monitor)
}

/// [`predict`] with working memory of its own.
pub fn predict_poses<'p>(
    object: &Object,
    supporter: &Supporter,
    params: &Params,
    poses: &'p mut [HangingPose],
    monitor: &Monitor,
) -> Result<Prediction<'p>, PredictError> {
    predict(object, supporter, params, poses, &mut vec![0; predict_bytes(&supporter.limits())], monitor)
}

/// A cloud of `count` points and normals from a supporter that is given as a mesh.
pub fn sample_supporter(mesh: &Mesh, count: usize, seed: u64) -> CloudFile {
    let (mut points, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
    let mut memory = vec![0; sampling::sample_bytes(count)];
    sampling::sample(mesh, seed, &mut points, &mut normals, &mut memory)
        .expect("sample_bytes says how much memory it takes");
    CloudFile { points, normals: Some(normals), notes: Vec::new() }
}
