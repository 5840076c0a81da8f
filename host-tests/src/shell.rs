//! A mesh of unknown make as a shell of thin convex prisms, so that its holes, handles and hooks stay what they are.
//!
//! Convex decompositions fill them: what they call a part of a mug reaches across its handle.

use crate::solid::{Part, Solid};
use crate::winding::Winding;
use meshopt::{SimplifyOptions, VertexDataAdapter};
use nalgebra::{Point3, Vector3};
use parry3d::math::Vector;
use parry3d::query::{Ray, RayCast};
use parry3d::shape::TriMesh;

/// How far the simplified surface may be from the mesh, metres, as the simplification estimates it. Of 94 real meshes the
/// vertices are 0.1 to 0.6 mm off in the mean; the worst vertex 1.2 mm in the median mesh, and more at rims of open ones.
const SIMPLIFICATION: f32 = 0.0007;
/// Thickest that the shell is, and the thinnest, metres.
const THICKEST: f32 = 0.002;
const THINNEST: f32 = 0.0002;
/// How far the shell may reach inwards, as a share of the way to the opposite surface: less than half, so that the shells
/// of both sides of a wall do not meet.
const REACH: f32 = 0.45;
/// Thickness of what has no inside, metres: half on each side.
const SHEET: f32 = 0.0004;
/// How far from a triangle one looks for which of its sides is the inner one, metres.
const ASIDE: f64 = 0.0001;

impl Solid {
    /// A mesh of unknown make. Its parts are its simplified triangles, each extruded inwards, so the shell is on the
    /// surface and not outside of it, to the accuracy of the simplification.
    ///
    /// Inwards is where the surface winds around more often, in either direction: so meshes that are inside out, and those
    /// whose bodies overlap, are no matter. Where both sides are about the same, as at a sheet without thickness or near
    /// the rim of an open surface, the triangle is extruded half to each side.
    pub fn shell(vertices: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        let corners = simplified(&vertices, &triangles);
        Self { parts: prisms(&corners), vertices, triangles, is_shell: true }
    }
}

/// The corners of the triangles of a surface that is nearly the mesh's, with fewer of them.
fn simplified(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[Point3<f32>; 3]> {
    // Only what shares vertices is seen to be one surface. Adding zero makes -0 and 0 the same.
    let vertices: Vec<[f32; 3]> = vertices.iter().map(|v| v.map(|x| x + 0.0)).collect();
    let indices = triangles.as_flattened();
    let (count, remap) = meshopt::generate_vertex_remap(&vertices, Some(indices));
    let indices = meshopt::remap_index_buffer(Some(indices), indices.len(), &remap);
    let vertices = meshopt::remap_vertex_buffer(&vertices, count, &remap);
    let bytes = meshopt::typed_to_bytes(&vertices);
    let adapter = VertexDataAdapter::new(bytes, size_of::<[f32; 3]>(), 0).expect("three numbers each");
    let options = SimplifyOptions::ErrorAbsolute;
    let kept = meshopt::simplify(&indices, &adapter, 0, SIMPLIFICATION, options, None);
    let (kept, _) = kept.as_chunks::<3>();
    kept.iter().map(|triangle| triangle.map(|index| vertices[index as usize].into())).collect()
}

fn prisms(triangles: &[[Point3<f32>; 3]]) -> Vec<Part> {
    let points = triangles.as_flattened().iter().map(|&corner| <[f32; 3]>::from(corner).into()).collect();
    let indices = (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let surface = TriMesh::new(points, indices).expect("a mesh has triangles");
    let winding = Winding::new(triangles.iter().map(|corners| corners.map(|corner| corner.cast())));
    let prism = |corners: &[Point3<f32>; 3]| {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        let [outer, inner] = match inwards(&winding, corners, &normal) {
            None => [0.5, -0.5].map(|half| corners.map(|corner| corner + normal * (half * SHEET))),
            Some(inwards) => [*corners, extruded(corners, &surface, &inwards)],
        };
        Some(Part::Hull(outer.into_iter().chain(inner).map(Into::into).collect()))
    };
    triangles.iter().filter_map(prism).collect()
}

/// Where a triangle's corners are on the inner side of the shell.
fn extruded(corners: &[Point3<f32>; 3], surface: &TriMesh, inwards: &Vector3<f32>) -> [Point3<f32>; 3] {
    let [a, b, c] = corners;
    let middle = Point3::from((a.coords + b.coords + c.coords) / 3.0);
    corners.map(|corner| {
        // Not at the corner itself: there, the neighbours are hit.
        let room = room(surface, &(corner + (middle - corner) * 0.05), inwards);
        corner + inwards * (REACH * room).clamp(THINNEST, THICKEST)
    })
}

/// The direction that leads inside from a triangle, or none if none does.
fn inwards(winding: &Winding, [a, b, c]: &[Point3<f32>; 3], normal: &Vector3<f32>) -> Option<Vector3<f32>> {
    let middle = Point3::from((a.coords + b.coords + c.coords) / 3.0).cast::<f64>();
    let aside = normal.cast::<f64>() * ASIDE;
    let [front, back] = [middle + aside, middle - aside].map(|point| winding.number(&point).abs());
    ((front - back).abs() > 0.5).then(|| if back > front { -normal } else { *normal })
}

/// How far it is from a point of the surface to the opposite side.
fn room(surface: &TriMesh, from: &Point3<f32>, inwards: &Vector3<f32>) -> f32 {
    /// Leaves the surface that the point is on, metres.
    const OFF: f32 = 1e-5;
    let vector = |v: Vector3<f32>| Vector::from_array(v.into());
    let ray = Ray::new(vector(from.coords + inwards * OFF), vector(*inwards));
    let farthest = THICKEST / REACH;
    surface.cast_local_ray(&ray, farthest, false).unwrap_or(farthest)
}
