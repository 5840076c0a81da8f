//! Area, volume and centroids of a mesh.

use super::{Aabb, Mesh, triangle};
use crate::disjoint_sets::DisjointSets;
use crate::geometry::{Point, Vector};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use crate::sort::sort;
use bytemuck::{Pod, Zeroable};
use nalgebra::{Matrix3, Vector3};

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
    /// The centroid of that volume, or of the one that an open mesh bounds once each of its holes is closed by the fan
    /// around the mean of its rim. `None` where the holes are too large for that to mean something, and where bodies that
    /// face inwards and outwards cancel out.
    pub volume_centroid: Option<Point>,
    /// The inertia tensor of a unit mass spread evenly over that volume, or where it has no centroid over the surface,
    /// about its own centroid; m².
    pub inertia: Matrix3<f32>,
}

/// Area of the fans that close the holes of an open mesh, as a share of its own area, up to which the mesh bounds a volume.
/// A scan from all sides lacks a few percent; a bowl without a lid would be filled by a quarter of its area.
const MAX_HOLES: f64 = 0.15;
/// Fraction of its bounding box's volume that a closed mesh must enclose; below it is a folded sheet.
const LEAST_VOLUME: f32 = 1e-6;

impl MassProperties {
    /// Bytes of working memory for a mesh of `vertices` and `triangles`.
    pub(crate) const fn scratch_bytes(vertices: usize, triangles: usize) -> usize {
        array_bytes::<u32>(vertices)
            .saturating_add(array_bytes::<u32>(vertices))
            .saturating_add(array_bytes::<u32>(vertices.saturating_add(1)))
            .saturating_add(array_bytes::<[u32; 2]>(triangles.saturating_mul(3)).saturating_mul(2))
            .saturating_add(array_bytes::<Rim>(vertices))
    }

    pub(crate) fn of(mesh: &Mesh, mut scratch: Arena, meter: &Meter) -> Result<Self, Unfinished> {
        // As `Mesh::aabb`, but ended by a cancel.
        let mut aabb = Aabb::EMPTY;
        for index in 0..mesh.triangles().len() {
            meter.check_at(index)?;
            aabb = mesh.corners(index).iter().fold(aabb, |aabb, corner| aabb.grow(corner));
        }
        let mut holes = Holes::find(mesh, aabb.centre(), &mut scratch, meter)?;
        // Sums of thousands of terms, around the middle of the box, in double precision.
        let middle = aabb.centre().cast::<f64>();
        // Integrals over the surface, over the volume below it, and over the fans that close its holes.
        let (mut shell, mut solid, mut fans) = (Integrals::default(), Integrals::default(), 0.0);
        for index in 0..mesh.triangles().len() {
            meter.check_at(index)?;
            let corners = mesh.corners(index);
            let area = f64::from(triangle::scaled_normal(&corners).norm()) / 2.0;
            let corners = corners.map(|corner| corner.cast::<f64>() - middle);
            shell.add(&corners, area, 3.0, 12.0);
            solid.add(&corners, tetrahedron(&corners), 4.0, 20.0);
        }
        holes.for_each_fan_triangle(mesh, meter, |corners| {
            let corners = corners.map(|corner| corner.cast::<f64>() - middle);
            let [a, b, c] = corners;
            fans += (b - a).cross(&(c - a)).norm() / 2.0;
            solid.add(&corners, tetrahedron(&corners), 4.0, 20.0);
        })?;
        let e = aabb.extents();
        let is_closed = holes.count == 0;
        let encloses = (is_closed || fans < MAX_HOLES * shell.whole)
            && solid.whole.abs() as f32 > LEAST_VOLUME * e.x * e.y * e.z;
        let centroid = (middle + solid.mean()).cast::<f32>();
        // Inconsistently oriented bodies may cancel out, move the centroid outside, and give a tensor that is not positive.
        let is_solid = encloses && aabb.contains(&centroid) && is_positive(&solid.spread());
        let spread = if is_solid { solid.spread() } else { shell.spread() };
        let inertia = (Matrix3::identity() * spread.trace() - spread).cast::<f32>();
        Ok(Self {
            area: shell.whole as f32,
            is_closed,
            is_inside_out: encloses && is_closed && solid.whole < 0.0,
            volume: (encloses && is_closed).then_some(solid.whole.abs() as f32),
            volume_centroid: is_solid.then_some(centroid),
            inertia,
        })
    }
}

/// Volume of the tetrahedron of three corners and the origin; positive if the corners are counter-clockwise seen from
/// outside.
fn tetrahedron([a, b, c]: &[Vector3<f64>; 3]) -> f64 {
    a.dot(&b.cross(c)) / 6.0
}

/// Integrals of 1, x and x xᵀ over triangles, or over the tetrahedra that they make with the origin.
#[derive(Default)]
struct Integrals {
    whole: f64,
    moment: Vector3<f64>,
    squares: Matrix3<f64>,
}

impl Integrals {
    /// Adds a triangle or a tetrahedron of this size, whose moments of first and second order have these divisors.
    fn add(&mut self, [a, b, c]: &[Vector3<f64>; 3], size: f64, first: f64, second: f64) {
        let sum = a + b + c;
        let squares = a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose();
        self.whole += size;
        self.moment += sum * (size / first);
        self.squares += squares * (size / second);
    }

    fn mean(&self) -> Vector3<f64> {
        self.moment / self.whole
    }

    /// Mean of x xᵀ about the mean of x.
    fn spread(&self) -> Matrix3<f64> {
        let mean = self.mean();
        self.squares / self.whole - mean * mean.transpose()
    }
}

/// Whether a symmetric matrix is positive definite: Sylvester's criterion.
fn is_positive(m: &Matrix3<f64>) -> bool {
    m.m11 > 0.0 && m.m11 * m.m22 > m.m12 * m.m21 && m.determinant() > 0.0
}

/// Sum of the middles of a rim's edges, weighted by length.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Rim {
    sum: [f32; 3],
    length: f32,
}

/// The edges of a mesh that are not matched by ones in the opposite direction, and the rims that they form.
struct Holes<'s> {
    /// Number of such edges.
    count: usize,
    /// All directed edges between welded vertices, those of one edge after each other.
    runs: &'s [[u32; 2]],
    /// Vertices connected by unmatched edges.
    connected: DisjointSets<'s>,
    /// By the name of the connected vertices; unset where there are no such edges.
    rims: &'s mut [Rim],
    /// The point that the middles of edges are measured from.
    centre: Point,
}

impl<'s> Holes<'s> {
    fn find(mesh: &Mesh, centre: Point, scratch: &mut Arena<'s>, meter: &Meter) -> Result<Self, Unfinished> {
        let vertices = mesh.vertices();
        let order = scratch.unset::<u32>(vertices.len())?;
        let welded = scratch.unset::<u32>(vertices.len())?;
        let edges = scratch.unset::<[u32; 2]>(mesh.triangles().len() * 3)?;
        let rims = scratch.unset::<Rim>(vertices.len())?;
        for (slot, index) in order.iter_mut().zip(0..) {
            meter.check_at(index as usize)?;
            *slot = index;
        }
        // Adding zero makes -0 and 0 the same.
        let position = |index: u32| vertices[index as usize].coords.add_scalar(0.0);
        let compare = |a: &u32, b: &u32| {
            let (a, b) = (position(*a), position(*b));
            (0..3).fold(core::cmp::Ordering::Equal, |order, i| order.then(a[i].total_cmp(&b[i])))
        };
        // Equal ones keep their order, so that the first of them comes first.
        sort(order, welded, meter, |a, b| compare(a, b).is_lt())?;
        let mut representative = order.first().copied().unwrap_or(0);
        for (step, &index) in order.iter().enumerate() {
            meter.check_at(step)?;
            if compare(&representative, &index).is_ne() {
                representative = index;
            }
            welded[index as usize] = representative;
        }
        sort_edges(mesh, welded, edges, scratch.scratch(), meter)?;
        let (mut connected, mut count) = (DisjointSets::new(order), 0);
        for_each_unmatched(edges, meter, |[a, b]| {
            connected.join(a, b);
            count += 1;
        })?;
        let mut holes = Self { count, runs: edges, connected, rims, centre };
        if count > 0 {
            holes.measure_rims(mesh, meter)?;
        }
        Ok(holes)
    }

    fn measure_rims(&mut self, mesh: &Mesh, meter: &Meter) -> Result<(), Stop> {
        let Self { runs, connected, rims, centre, .. } = self;
        for (step, rim) in rims.iter_mut().enumerate() {
            meter.check_at(step)?;
            *rim = Rim::zeroed();
        }
        for_each_unmatched(runs, meter, |[a, b]| {
            let rim = &mut rims[connected.find(a) as usize];
            let [start, end] = [a, b].map(|vertex| mesh.vertices()[vertex as usize]);
            let length = (end - start).norm();
            let middle = (start - *centre + (end - start) * 0.5) * length;
            rim.length += length;
            rim.sum = [0, 1, 2].map(|i| rim.sum[i] + middle[i]);
        })
    }

    /// Calls `visit` with the triangles of the fans that close the holes, wound as the mesh is.
    fn for_each_fan_triangle(
        &mut self,
        mesh: &Mesh,
        meter: &Meter,
        mut visit: impl FnMut([Point; 3]),
    ) -> Result<(), Stop> {
        if self.count == 0 {
            return Ok(());
        }
        let Self { runs, connected, rims, centre, .. } = self;
        for_each_unmatched(runs, meter, |[a, b]| {
            let rim = rims[connected.find(a) as usize];
            let middle = *centre + Vector::from(rim.sum) / rim.length.max(f32::MIN_POSITIVE);
            let [start, end] = [a, b].map(|vertex| mesh.vertices()[vertex as usize]);
            visit([end, start, middle]);
        })
    }
}

/// Writes the directed edges between welded vertices to `edges`, those of one edge after each other.
fn sort_edges(
    mesh: &Mesh,
    welded: &[u32],
    edges: &mut [[u32; 2]],
    mut scratch: Arena,
    meter: &Meter,
) -> Result<(), Unfinished> {
    let starts = scratch.slice::<u32>(welded.len() + 1)?;
    let spare = scratch.unset::<[u32; 2]>(edges.len())?;
    let of = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| welded[v as usize]);
        [[a, b], [b, c], [c, a]]
    };
    // By the lesser of both vertices, a bucket each; then within the buckets.
    let bucket = |edge: &[u32; 2]| undirected(edge).0 as usize;
    for (step, triangle) in mesh.triangles().iter().enumerate() {
        meter.check_at(step)?;
        of(triangle).iter().for_each(|edge| starts[bucket(edge)] += 1);
    }
    let mut end = 0;
    for (step, start) in starts.iter_mut().enumerate() {
        meter.check_at(step)?;
        end += *start;
        *start = end;
    }
    for (step, triangle) in mesh.triangles().iter().enumerate() {
        meter.check_at(step)?;
        for edge in of(triangle) {
            let start = &mut starts[bucket(&edge)];
            *start -= 1;
            edges[*start as usize] = edge;
        }
    }
    for bounds in starts.windows(2) {
        let edges = &mut edges[bounds[0] as usize..bounds[1] as usize];
        sort(edges, spare, meter, |a, b| undirected(a).1 < undirected(b).1)?;
    }
    Ok(())
}

fn undirected(&[a, b]: &[u32; 2]) -> (u32, u32) {
    (a.min(b), a.max(b))
}

/// Calls `visit` with the edges that occur more often in one direction than in the other, once for each excess.
fn for_each_unmatched(runs: &[[u32; 2]], meter: &Meter, mut visit: impl FnMut([u32; 2])) -> Result<(), Stop> {
    for (step, run) in runs.chunk_by(|a, b| undirected(a) == undirected(b)).enumerate() {
        meter.check_at(step)?;
        let (a, b) = undirected(&run[0]);
        let forward = run.iter().filter(|[a, b]| a < b).count();
        let backward = run.iter().filter(|[a, b]| a > b).count();
        let edge = if forward > backward { [a, b] } else { [b, a] };
        (0..forward.abs_diff(backward)).for_each(|_| visit(edge));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;

    fn mass_of(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> MassProperties {
        let needed = model_bytes(MassProperties::scratch_bytes(vertices.len(), triangles.len()));
        let mut memory = vec![0; needed];
        let mesh = Mesh::new(vertices, triangles).unwrap();
        MassProperties::of(&mesh, Arena::new(&mut memory, needed).unwrap(), &Meter::unwatched()).unwrap()
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
    fn small_holes_are_closed_for_the_centroid_and_large_ones_are_not() {
        let shape = crate::test_shapes::torus(0.04, 0.012, 48, 24).map(|p| p + Vector::new(0.3, 0.1, 0.2));
        let whole = mass_of(&shape.vertices, &shape.triangles);
        let centre = whole.volume_centroid.unwrap();
        // The triangles of a patch of its outside, of so many steps around the ring.
        let without = |steps: usize| {
            let kept = shape.triangles.iter().filter(|triangle| {
                let corner = Point::from(shape.vertices[triangle[0] as usize]) - centre;
                let turn = libm::atan2f(corner.y, corner.x) / core::f32::consts::TAU * 48.0;
                !(corner.xy().norm() > 0.04 && (0.0..steps as f32).contains(&turn))
            });
            mass_of(&shape.vertices, &kept.copied().collect::<Vec<_>>())
        };
        let nearly = without(3);
        assert!(!nearly.is_closed && nearly.volume.is_none());
        // The fan cuts off half of the tube, 3 % of the volume at 4 cm.
        assert!((nearly.volume_centroid.unwrap() - centre).norm() < 0.002);
        assert!((nearly.inertia - whole.inertia).norm() < 0.1 * whole.inertia.norm());
        assert_eq!(without(20).volume_centroid, None);
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
