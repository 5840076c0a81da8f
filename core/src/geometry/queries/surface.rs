//! A mesh arranged for queries: rays, closest points, inside and outside.

use super::bvh::{Bvh, Node};
use super::ray::Ray;
use crate::geometry::shapes::triangle;
use crate::geometry::{Aabb, Mesh, Point, Pose, Vector};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};
use bytemuck::{Pod, Zeroable};

/// A triangle mesh with a tree for rays, closest points and the winding number.
///
/// Holds copies of the triangles that have an area, so the mesh that it was built from need not stay.
#[derive(Clone, Copy)]
pub struct Surface<'m> {
    /// Corners of each triangle, in tree order.
    triangles: &'m [[Point; 3]],
    bvh: Bvh<'m>,
    /// For each node of the tree, the far-field approximation of its triangles.
    dipoles: &'m [Dipole],
    /// -1 where the mesh is closed but inside out, 1 otherwise.
    orientation: f32,
}

/// The first-order term of a node's winding number (Barill et al. 2018, "Fast Winding Numbers for Soups and
/// Clouds", eq. 13).
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Dipole {
    /// Sum of the triangles' normals, each of the length of its area.
    area_normal: [f32; 3],
    /// Area-weighted mean of the triangles' centroids.
    centre: [f32; 3],
    /// Square of the distance beyond which the dipole stands for the triangles: (`BETA` times the radius)².
    far_squared: f32,
    /// Sum of the areas.
    area: f32,
}

/// Distance in radii from which a node is replaced by its dipole; 2 is Barill et al.'s choice.
const BETA: f32 = 2.0;

impl<'m> Surface<'m> {
    /// Bytes for a mesh of `triangles`.
    pub(crate) const fn bytes(triangles: usize) -> usize {
        array_bytes::<[Point; 3]>(triangles)
            .saturating_add(array_bytes::<Node>(Bvh::max_nodes(triangles)))
            .saturating_add(array_bytes::<Dipole>(Bvh::max_nodes(triangles)))
    }

    /// Bytes of working memory for building it.
    pub(crate) const fn scratch_bytes(triangles: usize) -> usize {
        array_bytes::<u32>(triangles)
    }

    /// Arranges `mesh`; `inside_out` flips what is inside.
    pub(crate) fn build(
        mesh: &Mesh,
        inside_out: bool,
        arena: &mut Arena<'m>,
        meter: &Meter,
    ) -> Result<Self, Unfinished> {
        let mut count = 0;
        for _ in mesh.solid_triangles() {
            meter.check_at(count)?;
            count += 1;
        }
        let (triangles, _) = arena.unset::<Point>(3 * count)?.as_chunks_mut();
        let nodes = arena.unset::<Node>(Bvh::max_nodes(count))?;
        let dipoles = arena.unset::<Dipole>(Bvh::max_nodes(count))?;
        let mut scratch = arena.scratch();
        let order = scratch.unset::<u32>(count)?;
        let solid = mesh.solid_triangles();
        for ((name, corners), triangle) in order.iter_mut().zip(triangles.iter_mut()).zip(solid) {
            meter.check_at(triangle as usize)?;
            (*name, *corners) = (triangle, mesh.corners(triangle as usize));
        }
        let bvh = Bvh::build(order, triangles, nodes, meter)?;
        let triangles: &'m [[Point; 3]] = triangles;
        fill_dipoles(&bvh, triangles, dipoles, meter)?;
        Ok(Self { triangles, bvh, dipoles, orientation: if inside_out { -1.0 } else { 1.0 } })
    }

    /// Corners of all triangles that have an area.
    pub(crate) fn triangles(&self) -> &'m [[Point; 3]] {
        self.triangles
    }

    pub(crate) fn bvh(&self) -> &Bvh<'m> {
        &self.bvh
    }

    /// -1 where the triangles' normals point into the solid, 1 otherwise.
    pub(crate) fn orientation(&self) -> f32 {
        self.orientation
    }

    /// The box around the mesh.
    pub fn aabb(&self) -> Aabb {
        self.bvh.aabb()
    }

    /// How far along the unit `direction`, in metres, a ray from `origin` first meets the mesh, from either side.
    pub fn closest_hit(&self, origin: &Point, direction: &Vector) -> Option<f32> {
        let mut closest = None;
        let ray = Ray::new(origin, direction, &self.aabb());
        self.bvh.visit_along(&ray, f32::MAX, |items, mut limit| {
            for corners in &self.triangles[items] {
                if let Some(t) = ray.hit(corners, limit) {
                    (closest, limit) = (Some(t), t);
                }
            }
            limit
        });
        closest
    }

    /// Whether a ray from `origin` along `direction` meets the mesh.
    pub fn any_hit(&self, origin: &Point, direction: &Vector) -> bool {
        let mut hit = false;
        let ray = Ray::new(origin, direction, &self.aabb());
        self.bvh.visit_along(&ray, f32::MAX, |items, limit| {
            hit = self.triangles[items].iter().any(|t| ray.hit(t, limit).is_some());
            if hit { -1.0 } else { limit }
        });
        hit
    }

    /// Whether the segment between two points meets the mesh.
    pub(crate) fn is_crossed(&self, from: &Point, to: &Point) -> bool {
        let mut is_crossed = false;
        let ray = Ray::new(from, &(to - from), &self.aabb());
        self.bvh.visit_along(&ray, 1.0, |items, limit| {
            let triangles = self.triangles.get(items).unwrap_or_default();
            is_crossed = triangles.iter().any(|t| ray.hit(t, limit).is_some());
            if is_crossed { -1.0 } else { limit }
        });
        is_crossed
    }

    /// Whether an edge of another mesh, which `pose` brings into these coordinates, passes through a triangle of this one. Two meshes
    /// cross where that holds of one of them. Counts the queries.
    pub(crate) fn is_crossed_by(&self, other: &Surface, pose: &Pose, queries: &mut usize) -> bool {
        let mut is_crossed = false;
        other.bvh.descend(|_, node| {
            let aabb = node.aabb();
            *queries += 1;
            if is_crossed || !self.is_within(&(pose * aabb.centre()), 0.5 * aabb.diagonal()) {
                return false;
            }
            let triangles = node.items().and_then(|items| other.triangles.get(items));
            for triangle in triangles.unwrap_or_default() {
                let [a, b, c] = triangle.map(|corner| pose * corner);
                for [from, to] in [[a, b], [b, c], [c, a]] {
                    *queries += 1;
                    is_crossed |= self.is_crossed(&from, &to);
                }
            }
            !is_crossed
        });
        is_crossed
    }

    /// The point of the mesh that is closest to `point`.
    pub fn closest_point(&self, point: &Point) -> Point {
        self.closest_point_within(point, f32::INFINITY).unwrap_or(*point)
    }

    /// The closest point if it is closer than `radius` metres. A tight radius is faster.
    pub(crate) fn closest_point_within(&self, point: &Point, radius: f32) -> Option<Point> {
        let mut closest = None;
        self.bvh.visit_near(point, radius * radius, |items, mut limit| {
            for corners in &self.triangles[items] {
                if !triangle::may_be_within(corners, point, limit) {
                    continue;
                }
                let candidate = triangle::closest_point(corners, point);
                let distance = (candidate - point).norm_squared();
                if distance < limit {
                    (closest, limit) = (Some(candidate), distance);
                }
            }
            limit
        });
        closest
    }

    /// Whether the mesh comes closer to `point` than `radius` metres.
    pub fn is_within(&self, point: &Point, radius: f32) -> bool {
        let mut within = false;
        self.bvh.visit_near(point, radius * radius, |items, limit| {
            let is_near = |t: &[Point; 3]| {
                triangle::may_be_within(t, point, limit)
                    && (triangle::closest_point(t, point) - point).norm_squared() < limit
            };
            within = within || self.triangles[items].iter().any(is_near);
            if within { -1.0 } else { limit }
        });
        within
    }

    /// The generalised winding number: 1 inside a closed mesh and 0 outside, in between near the openings of an
    /// open one (Barill et al. 2018). Distant parts are approximated; on closed meshes of everyday objects the error
    /// stays below 0.2, so that it does not cross one half.
    pub fn winding_number(&self, point: &Point) -> f32 {
        let mut angle = 0.0;
        self.bvh.descend(|index, node| {
            let dipole = &self.dipoles[index as usize];
            let offset = Point::from(dipole.centre) - point;
            let distance_squared = offset.norm_squared();
            if distance_squared > dipole.far_squared {
                let distance = libm::sqrtf(distance_squared);
                angle += offset.dot(&Vector::from(dipole.area_normal)) / (distance_squared * distance);
                return false;
            }
            for corners in node.items().into_iter().flat_map(|items| &self.triangles[items]) {
                angle += triangle::solid_angle(corners, point);
            }
            true
        });
        self.orientation * angle / (4.0 * core::f32::consts::PI)
    }

    /// Whether `point` is inside: a winding number of more than one half, and not outside the box, where open meshes may
    /// have that too.
    pub fn is_inside(&self, point: &Point) -> bool {
        self.aabb().contains(point) && self.winding_number(point) > 0.5
    }

    /// Distance to the mesh in metres, negative inside: `S[.]` of section II-B.
    pub fn signed_distance(&self, point: &Point) -> f32 {
        let distance = (self.closest_point(point) - point).norm();
        if self.is_inside(point) { -distance } else { distance }
    }
}

/// Sums the dipoles of all nodes from the leaves up.
fn fill_dipoles(
    bvh: &Bvh,
    triangles: &[[Point; 3]],
    dipoles: &mut [Dipole],
    meter: &Meter,
) -> Result<(), Stop> {
    // Children stand behind their parents.
    for (index, node) in bvh.nodes().iter().enumerate().rev() {
        meter.check_at(index)?;
        let (mut area, mut area_normal, mut moment) = (0.0, Vector::zeros(), Vector::zeros());
        let mut add = |part_area: f32, part_normal: Vector, part_centre: Vector| {
            area += part_area;
            area_normal += part_normal;
            moment += part_centre * part_area;
        };
        if let Some(items) = node.items() {
            for corners in &triangles[items] {
                let normal = triangle::scaled_normal(corners) * 0.5;
                let [a, b, c] = corners.map(|corner| corner.coords);
                add(normal.norm(), normal, (a + b + c) / 3.0);
            }
        } else {
            for child in node.children().map(|child| &dipoles[child as usize]) {
                add(child.area, child.area_normal.into(), child.centre.into());
            }
        }
        let centre = Point::from(moment / area);
        let far_squared = BETA * BETA * node.aabb().farthest_squared(&centre);
        dipoles[index] = Dipole { area_normal: area_normal.into(), centre: centre.into(), far_squared, area };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;

    /// A cube of edge 2 around the origin, without the top if `open`.
    fn with_cube(open: bool, inside_out: bool, check: impl Fn(&Surface)) {
        let vertices: Vec<[f32; 3]> =
            (0..8).map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 })).collect();
        let quads = [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [4, 5, 7, 6]];
        let triangles: Vec<[u32; 3]> = quads[..if open { 5 } else { 6 }]
            .iter()
            .flat_map(
                |&[a, b, c, d]| {
                    if inside_out { [[a, c, b], [a, d, c]] } else { [[a, b, c], [a, c, d]] }
                },
            )
            .collect();
        let mesh = Mesh::new(&vertices, &triangles).unwrap();
        let needed = model_bytes(Surface::bytes(triangles.len()) + Surface::scratch_bytes(triangles.len()));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        check(&Surface::build(&mesh, inside_out, &mut arena, &Meter::unwatched()).unwrap());
    }

    #[test]
    fn cubes_cross_where_neither_holds_the_other_nor_is_apart() {
        with_cube(false, false, |cube| {
            let crosses = |pose: &Pose| {
                let mut queries = 0;
                [*pose, pose.inverse()].iter().any(|pose| cube.is_crossed_by(cube, pose, &mut queries))
            };
            let turned = nalgebra::UnitQuaternion::from_euler_angles(0.3, 0.2, 0.1);
            let at = |x: f32, turned| Pose::from_parts(nalgebra::Translation3::new(x, 0.1, 0.2), turned);
            assert!(crosses(&at(1.9, turned)));
            assert!(crosses(&at(1.9, nalgebra::UnitQuaternion::identity())));
            assert!(!crosses(&at(2.1, nalgebra::UnitQuaternion::identity())));
            assert!(!crosses(&at(4.0, turned)));
        });
    }

    #[test]
    fn known_answers_on_a_cube() {
        for inside_out in [false, true] {
            with_cube(false, inside_out, |cube| {
                assert!((cube.winding_number(&Point::origin()) - 1.0).abs() < 1e-5);
                assert!(cube.winding_number(&Point::new(9.0, 1.0, 2.0)).abs() < 0.01);
                assert!((cube.signed_distance(&Point::new(0.2, 0.0, -0.7)) + 0.3).abs() < 1e-6);
                assert!((cube.signed_distance(&Point::new(4.0, 5.0, 1.0)) - 5.0).abs() < 1e-6);
                assert_eq!(cube.closest_hit(&Point::new(0.0, 0.0, 5.0), &-Vector::z()), Some(4.0));
                assert_eq!(cube.closest_hit(&Point::new(0.0, 0.0, 5.0), &Vector::z()), None);
                assert!(cube.any_hit(&Point::origin(), &Vector::y()));
                assert!(!cube.any_hit(&Point::new(0.0, 1.1, 0.0), &Vector::y()));
                assert!(cube.is_within(&Point::new(0.0, 0.0, 1.5), 0.51));
                assert!(!cube.is_within(&Point::new(0.0, 0.0, 1.5), 0.49));
            });
        }
    }

    #[test]
    fn a_segment_crosses_where_a_ray_hits_before_its_end() {
        with_cube(false, false, |cube| {
            let mut random = crate::random::Random::new(3);
            let mut crossed = 0;
            for _ in 0..1000 {
                let mut point = || Point::from([(); 3].map(|()| 4.0 * random.next_f32() - 2.0));
                let (from, to) = (point(), point());
                let way = to - from;
                let hit = cube.closest_hit(&from, &way.normalize());
                let is_crossed = cube.is_crossed(&from, &to);
                assert_eq!(is_crossed, hit.is_some_and(|hit| hit < way.norm()), "{from} {to}");
                crossed += u32::from(is_crossed);
            }
            assert!((200..800).contains(&crossed), "{crossed}");
        });
    }

    #[test]
    fn an_open_box_keeps_its_inside() {
        with_cube(true, false, |cube| {
            // The missing face covers a sixth of the sphere around the centre.
            assert!((cube.winding_number(&Point::origin()) - 5.0 / 6.0).abs() < 1e-5);
            assert!(cube.is_inside(&Point::new(0.3, 0.1, 0.6)));
            assert!(!cube.is_inside(&Point::new(0.0, 0.0, 1.4)));
            assert!(!cube.is_inside(&Point::new(0.0, 1.2, 0.0)));
        });
    }
}
