//! URDF: the visual meshes and solids of the links, at zero joint positions.

use std::collections::{HashMap, HashSet};
use std::f64::consts::PI;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion};
use quick_xml::Reader;
use quick_xml::events::Event;
use urdf_rs::{Geometry, Joint, Robot};

use super::super::locate::locate;
use super::super::source::{Format, MESHES, Source};
use super::super::{FileError, Place};
use super::MeshFile;
use super::raw::{MOST_REPEATED, RawMesh};

/// Sides of a circle.
const SIDES: usize = 48;
/// Greatest depth of elements within elements: those of a robot are five deep, and extensions of simulators not much more. The
/// parsers take time that grows with the square of the depth.
const DEEPEST: usize = 64;

pub(super) fn read(source: &Source<'_>) -> Result<RawMesh, FileError> {
    let whole = |reason: String| source.malformed(Place::Whole, reason);
    let text = std::str::from_utf8(&source.bytes).map_err(|error| whole(error.to_string()))?;
    check_depth(text).map_err(whole)?;
    let robot = urdf_rs::read_from_string(text).map_err(|error| whole(in_line(&error.to_string())))?;
    if robot.links.is_empty() {
        return Err(whole("it has no links".into()));
    }
    if let Some(name) = &source.link
        && !robot.links.iter().any(|link| link.name == *name)
    {
        let names: Vec<_> = robot.links.iter().map(|link| link.name.as_str()).collect();
        return Err(whole(format!("there is no link {name:?}; the links are {}", names.join(", "))));
    }
    let mut mesh = RawMesh::default();
    let mut without_visual = Vec::new();
    let mut tree = Tree::of(&robot);
    for link in &robot.links {
        // A link that was asked for is in its own frame, and all links are in that of the root.
        let pose = match &source.link {
            Some(name) if *name != link.name => continue,
            Some(_) => Isometry3::identity(),
            None => tree.pose(&link.name).map_err(whole)?,
        };
        let shapes: Vec<_> = if link.visual.is_empty() {
            link.collision.iter().map(|shape| (&shape.origin, &shape.geometry)).collect()
        } else {
            link.visual.iter().map(|shape| (&shape.origin, &shape.geometry)).collect()
        };
        if link.visual.is_empty() && !shapes.is_empty() {
            without_visual.push(link.name.as_str());
        }
        for (origin, geometry) in shapes {
            let part = |reason: String| {
                source.malformed(Place::Part(format!("link {:?}", link.name)), in_line(&reason))
            };
            add(&mut mesh, geometry, &(pose * isometry(origin)), source).map_err(part)?;
            if mesh.size() > MOST_REPEATED {
                return Err(FileError::TooLarge { path: source.path.into(), most: MOST_REPEATED });
            }
        }
    }
    if !without_visual.is_empty() {
        let names = without_visual.join(", ");
        mesh.notes.push(format!("links without visual meshes are their collision meshes: {names}."));
    }
    Ok(mesh)
}

/// A message in one line.
fn in_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn isometry(pose: &urdf_rs::Pose) -> Isometry3<f64> {
    let ([x, y, z], [roll, pitch, yaw]) = (pose.xyz.0, pose.rpy.0);
    Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_euler_angles(roll, pitch, yaw))
}

/// Errs if elements are nested too deep.
fn check_depth(text: &str) -> Result<(), String> {
    let mut reader = Reader::from_str(text);
    let mut depth = 0_usize;
    loop {
        match reader.read_event().map_err(|error| error.to_string())? {
            Event::Start(_) if depth == DEEPEST => {
                return Err(format!("its elements are nested more than {DEEPEST} deep"));
            }
            Event::Start(_) => depth += 1,
            Event::End(_) => depth = depth.saturating_sub(1),
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

/// The joints, and the poses of links in the frame of the root with all joints at zero, as far as they are known.
struct Tree<'a> {
    joints: HashMap<&'a str, &'a Joint>,
    poses: HashMap<&'a str, Isometry3<f64>>,
}

impl<'a> Tree<'a> {
    fn of(robot: &'a Robot) -> Self {
        let joints = robot.joints.iter().map(|joint| (joint.child.link.as_str(), joint)).collect();
        Self { joints, poses: HashMap::new() }
    }

    /// The pose of a link. Those of all links above it are kept, so that a long chain is walked once.
    fn pose(&mut self, link: &'a str) -> Result<Isometry3<f64>, String> {
        let (mut above, mut name, mut seen) = (Vec::new(), link, HashSet::new());
        let mut pose = loop {
            if let Some(pose) = self.poses.get(name) {
                break *pose;
            }
            let Some(joint) = self.joints.get(name) else { break Isometry3::identity() };
            if !seen.insert(name) {
                return Err(format!("the joints form a loop at the link {name:?}"));
            }
            above.push((name, *joint));
            name = &joint.parent.link;
        };
        for (name, joint) in above.into_iter().rev() {
            pose *= isometry(&joint.origin);
            self.poses.insert(name, pose);
        }
        Ok(pose)
    }
}

/// Adds a shape to the mesh.
fn add(
    mesh: &mut RawMesh,
    geometry: &Geometry,
    pose: &Isometry3<f64>,
    source: &Source,
) -> Result<(), String> {
    let (vertices, faces, scale) = match geometry {
        Geometry::Box { size } => {
            let (vertices, faces) = cuboid();
            (vertices, faces, size.0)
        }
        Geometry::Cylinder { radius, length } => {
            let half = length / 2.0;
            let (vertices, faces) = revolve(&[[0.0, -half], [*radius, -half], [*radius, half], [0.0, half]]);
            (vertices, faces, [1.0; 3])
        }
        Geometry::Capsule { radius, length } => round(*radius, length / 2.0),
        Geometry::Sphere { radius } => round(*radius, 0.0),
        Geometry::Mesh { filename, scale } => {
            let MeshFile { vertices, triangles, notes, .. } = file(filename, source)?;
            mesh.notes.extend(notes.into_iter().map(|note| format!("{filename}: {note}")));
            let faces = triangles.into_iter().map(|triangle| triangle.map(i64::from).to_vec()).collect();
            let scale = scale.map_or([1.0; 3], |scale| scale.0);
            (vertices.into_iter().map(|vertex| vertex.map(f64::from)).collect(), faces, scale)
        }
    };
    let first = mesh.vertices.len() as i64;
    mesh.vertices.extend(vertices.into_iter().map(|[x, y, z]| {
        let place = pose * Point3::new(x * scale[0], y * scale[1], z * scale[2]);
        <[f64; 3]>::from(place.coords).map(|x| x as f32)
    }));
    // A mirrored shape has its outside inside.
    let is_mirrored = scale.iter().product::<f64>() < 0.0;
    for mut face in faces {
        if is_mirrored {
            face.reverse();
        }
        mesh.face(face.into_iter().map(|corner| corner + first), 0);
    }
    Ok(())
}

/// Reads a mesh that a URDF names.
fn file(name: &str, source: &Source) -> Result<MeshFile, String> {
    let path = locate(name.as_ref(), Some(&source.file)).map_err(|error| error.to_string())?;
    // A URDF within a URDF might name itself.
    let inner = Source::open(&path, MESHES).map_err(|error| error.to_string())?;
    match inner.format {
        Format::Urdf => Err(format!("{name}: a URDF is no mesh; name a mesh")),
        _ => super::read(&inner).map_err(|error| error.to_string()),
    }
}

/// Vertices and polygons.
type Shape = (Vec<[f64; 3]>, Vec<Vec<i64>>);

/// A cube of unit size about the origin.
fn cuboid() -> Shape {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 0.5 } else { -0.5 });
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ((0..8).map(corner).collect(), sides.map(Vec::from).to_vec())
}

/// A sphere, or a capsule whose half-spheres are `half` away from the origin. The scale is that of no change.
fn round(radius: f64, half: f64) -> (Vec<[f64; 3]>, Vec<Vec<i64>>, [f64; 3]) {
    let quarter = SIDES / 4;
    let arc = |from: f64, z: f64| {
        (0..=quarter).map(move |i| {
            let angle = from + PI / 2.0 * i as f64 / quarter as f64;
            // Exact at the poles.
            let r =
                if i == 0 && from < 0.0 || i == quarter && from >= 0.0 { 0.0 } else { radius * angle.cos() };
            [r, z + radius * angle.sin()]
        })
    };
    let (lower, upper) = (arc(-PI / 2.0, -half), arc(0.0, half));
    // The two arcs of a sphere share the equator.
    let outline: Vec<_> = lower.chain(upper.skip(usize::from(half == 0.0))).collect();
    let (vertices, faces) = revolve(&outline);
    (vertices, faces, [1.0; 3])
}

/// A solid of revolution about z from the radii and heights of its outline, which leads from the axis up to the axis.
fn revolve(outline: &[[f64; 2]]) -> Shape {
    let last = outline.len() - 1;
    let (bottom, top) = (outline[0][1], outline[last][1]);
    let mut vertices = vec![[0.0, 0.0, bottom], [0.0, 0.0, top]];
    for &[radius, z] in &outline[1..last] {
        vertices.extend((0..SIDES).map(|side| {
            let (sin, cos) = (2.0 * PI * side as f64 / SIDES as f64).sin_cos();
            [radius * cos, radius * sin, z]
        }));
    }
    let vertex = |ring: usize, side: usize| (2 + ring * SIDES + side % SIDES) as i64;
    let mut faces = Vec::new();
    for side in 0..SIDES {
        faces.push(vec![0, vertex(0, side + 1), vertex(0, side)]);
        for ring in 0..last - 2 {
            let next = side + 1;
            faces.push(vec![
                vertex(ring, side),
                vertex(ring, next),
                vertex(ring + 1, next),
                vertex(ring + 1, side),
            ]);
        }
        faces.push(vec![1, vertex(last - 2, side), vertex(last - 2, side + 1)]);
    }
    (vertices, faces)
}
