//! Area, volume and centroids of a mesh.

use super::{Mesh, triangle};
use crate::geometry::Point;
use crate::memory::{Arena, OutOfMemory, array_bytes};
use nalgebra::Matrix3;

/// Mass properties of a mesh of uniform density.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct MassProperties {
    /// Surface area, m².
    pub area: f32,
    /// Whether every directed edge is matched by one in the opposite direction, so that the mesh bounds a volume.
    /// Vertices at exactly the same position count as one.
    pub is_closed: bool,
    /// Whether the mesh is closed but its triangles face inwards; inside and outside are then exchanged.
    pub is_inside_out: bool,
    /// The volume, m³, of a closed mesh. Where bodies overlap it counts twice.
    pub volume: Option<f32>,
    /// The centroid of that volume; `None` also where bodies that face inwards and outwards cancel out.
    pub volume_centroid: Option<Point>,
    /// The inertia tensor of a unit mass spread evenly over the volume, or where that has no centroid the surface, about its own
    /// centroid; m².
    pub inertia: Matrix3<f32>,
}

/// Fraction of its bounding box's volume that a closed mesh must enclose; below it is a folded sheet.
const LEAST_VOLUME: f32 = 1e-6;

impl MassProperties {
    /// Bytes of working memory for a mesh of `vertices` and `triangles`.
    pub(crate) const fn scratch_bytes(vertices: usize, triangles: usize) -> usize {
        array_bytes::<u32>(vertices)
            .saturating_add(array_bytes::<u32>(vertices))
            .saturating_add(array_bytes::<[u32; 2]>(triangles.saturating_mul(3)))
    }

    pub(crate) fn of(mesh: &Mesh, mut scratch: Arena) -> Result<Self, OutOfMemory> {
        let is_closed = is_closed(mesh, &mut scratch)?;
        let aabb = mesh.aabb();
        // Sums of thousands of terms, around the middle of the box, in double precision.
        let middle = aabb.centre().cast::<f64>();
        let (mut area, mut volume) = (0.0_f64, 0.0_f64);
        let mut moment = nalgebra::Vector3::<f64>::zeros();
        // Integrals of 1, x and x xᵀ over the surface, and of x xᵀ over the volume.
        let (mut shell_moment, mut shell) = (nalgebra::Vector3::<f64>::zeros(), Matrix3::<f64>::zeros());
        let mut solid = Matrix3::<f64>::zeros();
        for index in 0..mesh.triangles().len() {
            let corners = mesh.corners(index);
            let piece = f64::from(triangle::scaled_normal(&corners).norm()) / 2.0;
            area += piece;
            let [a, b, c] = corners.map(|corner| corner.cast::<f64>() - middle);
            let part = a.dot(&b.cross(&c)) / 6.0;
            volume += part;
            let sum = a + b + c;
            moment += sum * (part / 4.0);
            shell_moment += sum * (piece / 3.0);
            let squares = a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose();
            shell += squares * (piece / 12.0);
            solid += squares * (part / 20.0);
        }
        let e = aabb.extents();
        let bounds_volume = is_closed && volume.abs() as f32 > LEAST_VOLUME * e.x * e.y * e.z;
        let centroid = (middle + moment / volume).cast::<f32>();
        let about = |spread: Matrix3<f64>, mean: nalgebra::Vector3<f64>| spread - mean * mean.transpose();
        let mut spread = about(solid / volume, moment / volume);
        // Inconsistently oriented bodies may cancel out, move the centroid outside, and give a tensor that is not positive.
        let is_solid = bounds_volume && aabb.contains(&centroid) && is_positive(&spread);
        if !is_solid {
            spread = about(shell / area, shell_moment / area);
        }
        let inertia = (Matrix3::identity() * spread.trace() - spread).cast::<f32>();
        Ok(Self {
            area: area as f32,
            is_closed,
            is_inside_out: bounds_volume && volume < 0.0,
            volume: bounds_volume.then_some(volume.abs() as f32),
            volume_centroid: is_solid.then_some(centroid),
            inertia,
        })
    }
}

/// Whether a symmetric matrix is positive definite: Sylvester's criterion.
fn is_positive(m: &Matrix3<f64>) -> bool {
    m.m11 > 0.0 && m.m11 * m.m22 > m.m12 * m.m21 && m.determinant() > 0.0
}

/// Whether each directed edge is matched by one in the opposite direction.
fn is_closed(mesh: &Mesh, scratch: &mut Arena) -> Result<bool, OutOfMemory> {
    let vertices = mesh.vertices();
    let order = scratch.slice::<u32>(vertices.len())?;
    let welded = scratch.slice::<u32>(vertices.len())?;
    let edges = scratch.slice::<[u32; 2]>(mesh.triangles().len() * 3)?;
    for (slot, index) in order.iter_mut().zip(0..) {
        *slot = index;
    }
    // Adding zero makes -0 and 0 the same.
    let position = |index: u32| vertices[index as usize].coords.add_scalar(0.0);
    let compare = |a: &u32, b: &u32| {
        let (a, b) = (position(*a), position(*b));
        (0..3).fold(core::cmp::Ordering::Equal, |order, i| order.then(a[i].total_cmp(&b[i])))
    };
    order.sort_unstable_by(|a, b| compare(a, b).then(a.cmp(b)));
    let mut representative = order.first().copied().unwrap_or(0);
    for &index in order.iter() {
        if compare(&representative, &index).is_ne() {
            representative = index;
        }
        welded[index as usize] = representative;
    }
    for (triangle, edges) in mesh.triangles().iter().zip(edges.chunks_exact_mut(3)) {
        let [a, b, c] = triangle.map(|v| welded[v as usize]);
        edges.copy_from_slice(&[[a, b], [b, c], [c, a]]);
    }
    // Sorted without direction, the runs of one edge stand together.
    let undirected = |&[a, b]: &[u32; 2]| (a.min(b), a.max(b));
    edges.sort_unstable_by_key(undirected);
    Ok(edges.chunk_by(|a, b| undirected(a) == undirected(b)).all(|run| {
        let forward = run.iter().filter(|[a, b]| a < b).count();
        let backward = run.iter().filter(|[a, b]| a > b).count();
        forward == backward
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;
    use crate::memory::model_bytes;

    fn mass_of(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> MassProperties {
        let needed = model_bytes(MassProperties::scratch_bytes(vertices.len(), triangles.len()));
        let mut memory = vec![0; needed];
        let mesh = Mesh::new(vertices, triangles).unwrap();
        MassProperties::of(&mesh, Arena::new(&mut memory, needed).unwrap()).unwrap()
    }

    const CORNERS: [[f32; 3]; 4] = [[1.0, 2.0, 3.0], [1.6, 2.0, 3.0], [1.0, 2.5, 3.0], [1.0, 2.0, 3.4]];
    const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    #[test]
    fn tetrahedron() {
        let mass = mass_of(&CORNERS, &FACES);
        assert!(mass.is_closed && !mass.is_inside_out);
        assert!((mass.volume.unwrap() - 0.6 * 0.5 * 0.4 / 6.0).abs() < 1e-6);
        let centroid = Point::new(1.0 + 0.15, 2.0 + 0.125, 3.0 + 0.1);
        assert!((mass.volume_centroid.unwrap() - centroid).norm() < 1e-6);
        let slanted = Vector::new(0.2, 0.24, 0.3).norm() / 2.0;
        assert!((mass.area - (0.15 + 0.12 + 0.1 + slanted)).abs() < 1e-6);
    }

    #[test]
    fn triangle_soup_inside_out_and_open() {
        // Each triangle with vertices of its own, as STL has it.
        let soup: Vec<[f32; 3]> = FACES.iter().flatten().map(|&v| CORNERS[v as usize]).collect();
        let triangles: Vec<[u32; 3]> = (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        assert_eq!(mass_of(&soup, &triangles), mass_of(&CORNERS, &FACES));

        let flipped = FACES.map(|[a, b, c]| [a, c, b]);
        let mass = mass_of(&CORNERS, &flipped);
        assert!(mass.is_closed && mass.is_inside_out);
        assert_eq!(mass.volume_centroid, mass_of(&CORNERS, &FACES).volume_centroid);

        let open = mass_of(&CORNERS, &FACES[..3]);
        assert_eq!((open.is_closed, open.volume, open.volume_centroid), (false, None, None));
        let one_flipped = [FACES[0], FACES[1], FACES[2], flipped[3]];
        assert!(!mass_of(&CORNERS, &one_flipped).is_closed);
        // Two bodies, one inwards and smaller: together they hold something, but it is nowhere. Its inertia is that of the surface.
        let beside = CORNERS.map(|corner| [11.0 - 0.9 * corner[0], corner[1] * 0.9, corner[2] * 0.9]);
        let vertices = [CORNERS, beside].concat();
        let both =
            |of: [[u32; 3]; 4]| mass_of(&vertices, &[FACES, of.map(|face| face.map(|v| v + 4))].concat());
        // The second is mirrored, so that its own faces look inwards.
        let (nowhere, apart) = (both(FACES), both(flipped));
        assert!(nowhere.is_closed && nowhere.volume.is_some() && nowhere.volume_centroid.is_none());
        assert!(apart.volume_centroid.is_some() && is_positive(&apart.inertia.cast()));
        assert!(is_positive(&nowhere.inertia.cast()), "{}", nowhere.inertia);
        // A sheet with two sides is closed but holds nothing.
        let sheet = mass_of(&CORNERS, &[FACES[0], flipped[0]]);
        assert_eq!((sheet.is_closed, sheet.volume), (true, None));
    }
}
