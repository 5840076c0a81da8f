use super::*;
use crate::geometry::{Aabb, Point, Vector};
use crate::perception::test_views::{
    BALL_RADIUS, BOX, Distance, TORUS, View, around, ball, camera, cuboid, look_from, poses, torus,
};
use crate::perception::volume::{VolumeLimits, VolumeSettings};
use std::collections::HashMap;
use std::f32::consts::PI;

const VOXEL: f32 = 0.002;

struct Extracted {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

/// Fuses the views and returns the surface.
fn extract<'a>(settings: &VolumeSettings, views: impl IntoIterator<Item = &'a View>) -> Extracted {
    let limits = VolumeLimits { blocks: 20000 };
    let mut memory = vec![0; Volume::bytes(&limits)];
    let mut volume = Volume::new(settings, &limits, &mut memory).unwrap();
    for view in views {
        volume.integrate(&view.image(), None, &Monitor::new()).unwrap();
    }
    surface(&volume)
}

fn surface(volume: &Volume) -> Extracted {
    let mut memory = vec![0; Isosurface::bytes(volume.blocks())];
    let found = Isosurface::find(volume, &mut memory, &Monitor::new()).unwrap();
    let mut vertices = vec![[f32::NAN; 3]; found.vertices()];
    let mut triangles = vec![[u32::MAX; 3]; found.triangles()];
    found.write(&mut vertices, &mut triangles).unwrap();
    Extracted { vertices, triangles }
}

impl Extracted {
    /// How often each edge is used in its direction.
    fn edges(&self) -> HashMap<(u32, u32), usize> {
        let mut edges = HashMap::new();
        for triangle in &self.triangles {
            for i in 0..3 {
                *edges.entry((triangle[i], triangle[(i + 1) % 3])).or_insert(0) += 1;
            }
        }
        edges
    }

    /// Number of edges with a triangle on one side only; every other has two.
    fn open_edges(&self) -> usize {
        let edges = self.edges();
        assert!(edges.values().all(|count| *count == 1), "an edge has two triangles on one side");
        edges.keys().filter(|(a, b)| !edges.contains_key(&(*b, *a))).count()
    }

    fn corners(&self, triangle: &[u32; 3]) -> [Point; 3] {
        triangle.map(|v| self.vertices[v as usize].into())
    }

    /// Volume by the divergence theorem; positive if triangles face outwards.
    fn volume(&self) -> f32 {
        let sixth = |t: &[u32; 3]| {
            let [a, b, c] = self.corners(t).map(|p| p.coords.map(f64::from));
            a.dot(&b.cross(&c)) / 6.0
        };
        self.triangles.iter().map(sixth).sum::<f64>() as f32
    }

    /// Part of the vertices within `bound` of the shape, and the greatest distance.
    fn accuracy(&self, shape: Distance, bound: f32) -> (f32, f32) {
        let distances: Vec<f32> = self.vertices.iter().map(|v| shape((*v).into()).abs()).collect();
        let within = distances.iter().filter(|d| **d <= bound).count();
        (within as f32 / distances.len() as f32, distances.iter().copied().fold(0.0, f32::max))
    }
}

/// Shapes and their volumes.
const SHAPES: [(Distance, f32); 3] = [
    (ball, 4.0 / 3.0 * PI * BALL_RADIUS * BALL_RADIUS * BALL_RADIUS),
    (torus, 2.0 * PI * PI * TORUS[0] * TORUS[1] * TORUS[1]),
    (cuboid, 8.0 * BOX[0] * BOX[1] * BOX[2]),
];

#[test]
fn seen_from_all_around_it_is_closed_accurate_and_of_the_right_volume() {
    for (index, (shape, volume)) in SHAPES.into_iter().enumerate() {
        let mesh = extract(&VolumeSettings::new(VOXEL), &around(shape, 24));
        let (within, worst) = mesh.accuracy(shape, 0.5 * VOXEL);
        let ratio = mesh.volume() / volume;
        assert_eq!(mesh.open_edges(), 0, "shape {index}");
        assert!(within > 0.95 && worst < 1.5 * VOXEL, "shape {index}: {within}, {worst}");
        assert!((ratio - 1.0).abs() < 0.02, "shape {index}: {ratio}");
    }
}

#[test]
fn a_wall_thinner_than_a_voxel_is_not_much_thicker() {
    // A hollow ball without its top, as a ladle's head.
    const WALL: f32 = 0.75 * VOXEL;
    let bowl: Distance = |p| {
        let shell = (p.coords.norm() - BALL_RADIUS).abs() - 0.5 * WALL;
        shell.max(p.z - 0.2 * BALL_RADIUS)
    };
    // Archimedes: the area of a zone of a sphere goes with its height.
    let volume = 2.0 * PI * BALL_RADIUS * (1.2 * BALL_RADIUS) * WALL;
    let mesh = extract(&VolumeSettings::new(VOXEL), &around(bowl, 24));
    let ratio = mesh.volume() / volume;
    assert!((ratio - 1.0).abs() < 0.35, "{ratio}");
}

#[test]
fn no_triangle_is_degenerate_and_every_vertex_is_used() {
    let mesh = extract(&VolumeSettings::new(VOXEL), &around(cuboid, 24));
    let mut used = vec![false; mesh.vertices.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = mesh.corners(triangle);
        assert!((b - a).cross(&(c - a)).norm() > 0.0, "{triangle:?}");
        triangle.iter().for_each(|v| used[*v as usize] = true);
    }
    assert!(used.into_iter().all(|used| used));
}

#[test]
fn seen_once_it_is_open_and_nothing_is_invented() {
    for (index, (shape, _)) in SHAPES.into_iter().enumerate() {
        for (eye, wall) in [([0.4, 0.0, 0.0], 0.0), ([0.1, -0.3, 0.25], 0.0), ([0.2, 0.1, 0.33], 0.7)] {
            let eye = Point::from(eye);
            let view = View::new(camera(), look_from(eye), shape, wall);
            let crop = Some(Aabb { min: [-0.07; 3].into(), max: [0.07; 3].into() });
            for dense in [false, true] {
                let mesh = extract(&VolumeSettings { crop, dense, ..VolumeSettings::new(VOXEL) }, [&view]);
                assert!(mesh.open_edges() > 0);
                let (_, worst) = mesh.accuracy(shape, VOXEL);
                assert!(worst <= VOXEL, "shape {index}, wall {wall}: {worst}");
                for v in &mesh.vertices {
                    // The surface towards the camera: the way there leaves the shape.
                    let towards = (eye - Point::from(*v)).normalize();
                    let step = Point::from(*v) + towards * (2.0 * VOXEL);
                    assert!(shape(step) > shape((*v).into()) - 0.5 * VOXEL, "shape {index}: {v:?} is behind");
                }
            }
        }
    }
}

#[test]
fn the_limits_are_named() {
    let limits = VolumeLimits { blocks: 2000 };
    let mut memory = vec![0; Volume::bytes(&limits)];
    let mut volume = Volume::new(&VolumeSettings::new(VOXEL), &limits, &mut memory).unwrap();
    let views = around(ball, 2);
    volume.integrate(&views[0].image(), None, &Monitor::new()).unwrap();
    let needed = Isosurface::bytes(volume.blocks());
    let error = Isosurface::find(&volume, &mut vec![0; needed - 1], &Monitor::new()).err().unwrap();
    assert!(matches!(error, IsosurfaceError::OutOfMemory(e) if e.needed == needed && e.given == needed - 1));
    let monitor = Monitor::new();
    monitor.cancel();
    let error = Isosurface::find(&volume, &mut vec![0; needed], &monitor).err().unwrap();
    assert_eq!(error, IsosurfaceError::Stopped(crate::Stop::Cancelled));
    let mut memory = vec![0; needed];
    let found = Isosurface::find(&volume, &mut memory, &Monitor::new()).unwrap();
    let (v, t) = (found.vertices(), found.triangles());
    assert!(v > 1000 && t > 2000);
    let (mut vertices, mut triangles) = (vec![[0.0; 3]; v], vec![[0; 3]; t]);
    let error = found.write(&mut vertices[1..], &mut triangles).unwrap_err();
    assert_eq!(error, IsosurfaceError::Vertices { needed: v, limit: v - 1 });
    let error = found.write(&mut vertices, &mut triangles[1..]).unwrap_err();
    assert_eq!(error, IsosurfaceError::Triangles { needed: t, limit: t - 1 });
    assert!(vertices.iter().all(|v| *v == [0.0; 3]), "written in spite of the error");
}

#[test]
fn an_empty_volume_has_no_surface() {
    let mesh = extract(&VolumeSettings::new(VOXEL), []);
    assert!(mesh.vertices.is_empty() && mesh.triangles.is_empty());
}

/// A ring of wire 6 mm thick and a plate 3 mm thick, before a wall. What one side of them says reaches through to the other,
/// and the wall beside them says that space is free.
#[test]
fn thin_things_keep_their_place() {
    let wire: Distance = |p| (p.x.hypot(p.y) - 0.04).hypot(p.z) - 0.003;
    let plate: Distance = |p| {
        let outside = [p.x.abs() - 0.04, p.y.abs() - 0.04, p.z.abs() - 0.0015];
        let most = outside[0].max(outside[1]).max(outside[2]);
        Vector::from(outside.map(|x| x.max(0.0))).norm() + most.min(0.0)
    };
    let crop = Some(Aabb { min: [-0.07; 3].into(), max: [0.07; 3].into() });
    for (shape, voxel) in [(wire, 0.001), (plate, 0.0015)] {
        let views: Vec<View> = poses(24).map(|pose| View::new(camera(), pose, shape, 0.75)).collect();
        let mesh = extract(&VolumeSettings { crop, ..VolumeSettings::new(voxel) }, &views);
        let (within, worst) = mesh.accuracy(shape, 0.5 * voxel);
        // Pixels are as large as the finer voxels: single vertices at the outline are off by a little more.
        assert!(within > 0.99 && worst < 1.25 * voxel, "{within} {worst}");
        assert_eq!(mesh.open_edges(), 0);
    }
}
