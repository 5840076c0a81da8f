//! The pairs: the samples, and generated ones of every kind, as meshes, clouds and depth images.

use crate::given::{CENTRE, DISTORTION, FOCAL, Given, Image, SIZE, Shape, UNIT};
use hangpose::files;
use hangpose::geometry::{Mesh, Vector};
use hangpose::perception::depth::DepthCamera;
use hangpose::sample_supporter;
use hangpose_ffi::{HANGPOSE_PROFILE_DEFAULT, HANGPOSE_PROFILE_PAPER};
use host_tests::scan::{Sensor, Target, looking, sphere};
use host_tests::shapes::Random;
use host_tests::tables::case::{Case, Fit, made};
use meshopt::{SimplifyOptions, VertexDataAdapter};
use parry3d::shape::TriMesh;
use std::collections::HashMap;
use std::error::Error;
use std::path::Path;

/// Sizes of what a pair is given: points of the cloud, surface samples and voxels.
#[derive(Clone, Copy)]
struct Sizes {
    points: usize,
    samples: u32,
    voxels: u32,
}

/// The defaults of the library, and a cloud as dense as a depth camera gives.
const LARGE: Sizes = Sizes { points: 10_000, samples: 10_000, voxels: 200_000 };
/// Half of the time for generated pairs.
const MIDDLE: Sizes = Sizes { points: 4000, samples: 4000, voxels: 100_000 };
/// What fits 1 MB with [`SMALL_TRIANGLES`], see embedded/test.sh.
const SMALL: Sizes = Sizes { points: 700, samples: 1000, voxels: 20_000 };
/// Triangles of a small mesh.
const SMALL_TRIANGLES: usize = 1000;

/// Generated pairs that can hang, beside two thirds as many that cannot.
const MADE: usize = 28;
/// Seed of their sizes: one that is used for nothing else.
const SEED: u64 = 2100;
/// Every so many generated pairs are predicted with the paper's profile, are seen by depth images, or have no normals.
const PAPER: usize = 6;
const SCANNED: usize = 4;
const WITHOUT_NORMALS: usize = 5;

/// Directions from which a supporter on a wall is seen.
const FRONT: [[f32; 3]; 2] = [[1.0, 0.5, 0.5], [1.0, -0.6, 0.3]];

pub(crate) fn pairs() -> Result<Vec<Given>, Box<dyn Error>> {
    let mut pairs = samples()?;
    let cases = made(MADE, SEED);
    pairs.extend(cases.iter().enumerate().map(|(index, case)| generated(index, case)));
    pairs.extend(cases.iter().filter(|case| case.fit == Fit::Yes).map(small));
    Ok(pairs)
}

/// The samples, with both profiles, seen by depth images, and small.
fn samples() -> Result<Vec<Given>, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    let mesh = |name: &str| -> Result<Shape, Box<dyn Error>> {
        let file = files::read_mesh(&folder.join(name))?;
        Ok(Shape { points: file.vertices, triangles: file.triangles, ..Shape::default() })
    };
    let cloud = |name: &str| -> Result<Shape, Box<dyn Error>> {
        let file = files::read_cloud(&folder.join(name))?;
        let normals = file.normals.ok_or("the samples have normals")?;
        Ok(Shape { points: file.points, normals, ..Shape::default() })
    };
    let (mug, scissors, hook) = (mesh("mug.obj")?, mesh("scissors.obj")?, mesh("hook.obj")?);
    let front = FRONT.map(|direction| shot(&hook, &direction.into()));
    let seen_hook = Shape { images: front.into(), ..Shape::default() };
    let seen_mug = Shape {
        images: sphere(3, &mut Random::new(SEED)).iter().map(|eye| shot(&mug, eye)).collect(),
        ..Shape::default()
    };
    let small_hook = sampled(&hook, SMALL.points, 0);
    let (small_mug, small_scissors) = (simplified(&mug), simplified(&scissors));
    let pair = |name: &str, sizes, object, supporter| given(name.into(), sizes, 0, object, supporter);
    Ok(vec![
        pair("mug on hook", LARGE, mesh("mug.obj")?, cloud("hook.ply")?),
        by_the_paper(pair("mug on hook, paper", LARGE, mug, cloud("hook.ply")?)),
        pair("mug on hook, depth images", MIDDLE, seen_mug, seen_hook),
        without_path(pair("mug on hook, 1 MB", SMALL, small_mug, small_hook)),
        pair("scissors on mug tree", LARGE, mesh("scissors.obj")?, cloud("mug_tree.ply")?),
        by_the_paper(pair("scissors on hook, paper", LARGE, scissors, cloud("hook.ply")?)),
        without_path(pair("scissors on hook, 1 MB", SMALL, small_scissors, sampled(&hook, SMALL.points, 1))),
    ])
}

/// A generated pair, and what it is given as: every so many in another way.
fn generated(index: usize, case: &Case) -> Given {
    let object = of_mesh(&case.object.mesh());
    let supporter = of_mesh(&case.supporter.mesh());
    let mut random = Random::new(case.seed);
    let is_scanned = |turn| index % SCANNED == turn;
    let object = if is_scanned(1) {
        let images = sphere(2, &mut random).iter().map(|eye| shot(&object, eye)).collect();
        Shape { images, ..Shape::default() }
    } else {
        object
    };
    let supporter = if is_scanned(3) {
        let images = FRONT.map(|direction| shot(&supporter, &direction.into())).into();
        Shape { images, ..Shape::default() }
    } else {
        let cloud = sampled(&supporter, MIDDLE.points, case.seed);
        let normals = if index.is_multiple_of(WITHOUT_NORMALS) { Vec::new() } else { cloud.normals };
        Shape { normals, ..cloud }
    };
    let pair = given(case.name.clone(), MIDDLE, case.seed as u32, object, supporter);
    if index % PAPER == PAPER - 1 { by_the_paper(pair) } else { pair }
}

/// A generated pair in 1 MB.
fn small(case: &Case) -> Given {
    let object = simplified(&of_mesh(&case.object.mesh()));
    let supporter = sampled(&of_mesh(&case.supporter.mesh()), SMALL.points, case.seed);
    without_path(given(format!("{}, 1 MB", case.name), SMALL, case.seed as u32, object, supporter))
}

/// A path takes more than 1 MB.
fn without_path(pair: Given) -> Given {
    Given { plan: 0, ..pair }
}

fn given(name: String, sizes: Sizes, seed: u32, object: Shape, supporter: Shape) -> Given {
    let Sizes { samples, voxels, .. } = sizes;
    Given { name, profile: HANGPOSE_PROFILE_DEFAULT, seed, samples, voxels, plan: 1, object, supporter }
}

/// With the paper's profile, which has no distance field and so no paths.
fn by_the_paper(pair: Given) -> Given {
    without_path(Given { profile: HANGPOSE_PROFILE_PAPER, voxels: 0, ..pair })
}

fn of_mesh(mesh: &Mesh) -> Shape {
    let points = mesh.vertices().iter().map(|vertex| vertex.coords.into()).collect();
    Shape { points, triangles: mesh.triangles().to_vec(), ..Shape::default() }
}

/// Points and normals on a mesh.
fn sampled(of: &Shape, count: usize, seed: u64) -> Shape {
    let mesh = Mesh::new(&of.points, &of.triangles).expect("a mesh that was read or made");
    let file = sample_supporter(&mesh, count, seed);
    Shape { points: file.points, normals: file.normals.unwrap_or_default(), ..Shape::default() }
}

/// A mesh with [`SMALL_TRIANGLES`] and the vertices that these use.
fn simplified(of: &Shape) -> Shape {
    let bytes = meshopt::typed_to_bytes(&of.points);
    let adapter = VertexDataAdapter::new(bytes, size_of::<[f32; 3]>(), 0).expect("three numbers each");
    let (indices, count) = (of.triangles.as_flattened(), 3 * SMALL_TRIANGLES.min(of.triangles.len()));
    let kept = meshopt::simplify(indices, &adapter, count, f32::MAX, SimplifyOptions::ErrorAbsolute, None);
    let mut places = HashMap::new();
    let mut points = Vec::new();
    let mut place = |old: u32| {
        *places.entry(old).or_insert_with(|| {
            points.push(of.points[old as usize]);
            points.len() as u32 - 1
        })
    };
    let (kept, _) = kept.as_chunks::<3>();
    let triangles = kept.iter().map(|triangle| triangle.map(&mut place)).collect();
    Shape { points, triangles, ..Shape::default() }
}

/// What a depth camera sees of a mesh, with nothing behind it, from a direction and as near as all of it is in the image.
fn shot(of: &Shape, direction: &Vector) -> Image {
    let camera = DepthCamera::new(SIZE, FOCAL, CENTRE, DISTORTION).expect("a valid camera");
    let sensor = Sensor { camera, unit: UNIT, ..Sensor::perfect() };
    let vertices = of.points.iter().map(|&point| point.into()).collect();
    let mesh = TriMesh::new(vertices, of.triangles.clone()).expect("the mesh has triangles");
    let target = Target::around(of.points.iter().map(|&point| point.into()), 0.0);
    let pose = looking(&target, direction);
    let shot = sensor.take(&mesh, &pose, &mut Random::new(0));
    let image = shot.image().expect("the mesh is in the image");
    Image {
        position: pose.translation.vector.into(),
        quaternion: pose.rotation.coords.into(),
        depths: image.depths().to_vec(),
    }
}
