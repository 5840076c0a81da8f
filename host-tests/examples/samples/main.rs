//! Writes the files of `samples/`, with the same bytes on every machine. With `--check` it only compares them.
//!
//! All shapes are meshes in metres with z up. The supporters are also written as point clouds. The start of the path in
//! `make demo` is a pose as `hangpose predict --start` reads it. The depth image shows the mug to `hangpose scan`, and the
//! pairs are those of `hangpose batch`.

mod shapes;

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use hangpose::geometry::{Point, Vector};
use hangpose::perception::depth::DepthCamera;
use host_tests::scan::{Sensor, Target, looking};
use host_tests::shapes::Random;
use host_tests::shapes::vector::{V, X, Y, Z, add, arc, cross, length, scale, sub, turn, unit};
use host_tests::winding::Winding;
use parry3d::math;
use parry3d::shape::TriMesh;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};
use shapes::{Body, line};

/// Named closed bodies, which may overlap.
type Mesh = Vec<(&'static str, Body)>;

/// The mug upright, in front of the hook and below it, with the handle towards the wall: its pose in the hook's frame.
const MUG_START: &str = "{\"position\": [0.22, 0, -0.16], \"quaternion_xyzw\": [0, 0, 1, 0]}\n";

/// Pairs of the samples, with an option of one pair in a column.
const PAIRS: &str = "\
id,object,supporter,object_scale
mug on hook,mug.obj,hook.ply,
mug on tree,mug.obj,mug_tree.ply,
large mug on tree,mug.obj,mug_tree.ply,1.2
scissors on hook,scissors.obj,hook.ply,
";

/// Width and height of the depth image, pixels.
const IMAGE: [u32; 2] = [200, 150];
/// fx and fy of the depth image, pixels.
const FOCAL: f32 = 600.0;
/// Direction from the mug to the camera: obliquely from above, with the handle on one side.
const EYE: [f32; 3] = [0.4, -0.8, 0.5];

/// The intrinsics of the depth image.
fn camera_matrix() -> String {
    let [cx, cy] = principal_point();
    format!("{FOCAL} 0 {cx}\n0 {FOCAL} {cy}\n0 0 1\n")
}

fn principal_point() -> [f32; 2] {
    IMAGE.map(|size| (size as f32 - 1.0) / 2.0)
}

/// A depth image in millimetres, as PNG without compression, which has the same bytes whatever wrote it.
fn depth_image(mesh: &Mesh) -> Vec<u8> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (_, body) in mesh {
        let first = vertices.len() as u32;
        vertices.extend(body.vertices.iter().map(|v| Point::from(v.map(|x| x as f32))));
        triangles.extend(body.triangles.iter().map(|t| t.map(|i| i as u32 + first)));
    }
    let target = Target::around(vertices.iter().copied(), 0.0);
    let vertices = vertices.iter().map(|v| math::Vector::new(v.x, v.y, v.z)).collect();
    let trimesh = TriMesh::new(vertices, triangles).expect("the mesh has triangles");
    let camera = DepthCamera::new(IMAGE, [FOCAL; 2], principal_point(), [0.0; 5]).expect("valid");
    let sensor = Sensor { camera, unit: 0.001, ..Sensor::perfect() };
    let shot = sensor.take(&trimesh, &looking(&target, &Vector::from(EYE)), &mut Random::new(0));
    let image = shot.image().expect("the mug is in the image");
    let bytes: Vec<u8> = image.depths().iter().flat_map(|depth| depth.to_be_bytes()).collect();
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, IMAGE[0], IMAGE[1]);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::Sixteen);
    encoder.set_compression(Compression::NoCompression);
    encoder.set_filter(Filter::NoFilter);
    let mut writer = encoder.write_header().expect("memory takes the header");
    writer.write_image_data(&bytes).expect("there are as many bytes as the size says");
    drop(writer);
    file
}

/// A mug of 3.5 dl. The cup stands on z = 0 about the z axis; the handle is on the side of +x.
fn mug() -> Mesh {
    let mut outline =
        vec![(0.0, 0.0), (0.012, 0.0), (0.025, 0.0), (0.037, 0.0), (0.0398, 0.0012), (0.041, 0.004)];
    outline.extend((1..=12).map(|i| (0.041, 0.004 + 0.089 * f64::from(i) / 12.0)));
    outline.extend([(0.0404, 0.0944), (0.039, 0.095), (0.0376, 0.0944)]);
    outline.extend((0..=12).map(|i| (0.037, 0.093 - 0.085 * f64::from(i) / 12.0)));
    outline.extend([(0.0358, 0.0052), (0.033, 0.004), (0.022, 0.004), (0.011, 0.004), (0.0, 0.004)]);
    // The ends of the handle lie inside the wall; its hole is 22 mm by 45 mm.
    let mut path = line([0.0385, 0.0, 0.075], [0.052, 0.0, 0.075], 4);
    path.extend(&arc([0.052, 0.0, 0.059], scale(X, 0.016), scale(Z, 0.016), [90.0, 0.0], 10)[1..]);
    path.extend(&line([0.068, 0.0, 0.059], [0.068, 0.0, 0.036], 8)[1..]);
    path.extend(&arc([0.052, 0.0, 0.036], scale(X, 0.016), scale(Z, 0.016), [0.0, -90.0], 10)[1..]);
    path.extend(&line([0.052, 0.0, 0.020], [0.0385, 0.0, 0.020], 4)[1..]);
    let handle = Body::sweep(&path, Y, [0.006, 0.005], 24, [false; 2]);
    vec![("cup", Body::revolve(&outline, 72)), ("handle", handle)]
}

/// Closed scissors in the x-y plane, with the screw at the origin, the tips at +x and the loops at -x.
fn scissors() -> Mesh {
    let mut mesh = Mesh::new();
    let names = [["loop_left", "shank_left", "blade_left"], ["loop_right", "shank_right", "blade_right"]];
    for (names, side) in names.into_iter().zip([1.0, -1.0]) {
        let mut path = arc([-0.062, side * 0.0205, 0.0], scale(X, 0.022), scale(Y, 0.0165), [0.0, 360.0], 56);
        path[56] = path[0];
        mesh.push((names[0], Body::sweep(&path, Z, [0.0035, 0.0035], 20, [true; 2])));
        // From the loop to the blade on the other side; the shanks pass each other in z where they cross.
        let z = side * 0.00135;
        let path = line([-0.0425, side * 0.0135, z / 2.0], [-0.004, side * 0.0005, z], 12);
        mesh.push((names[1], Body::sweep(&path, Z, [0.0014, 0.0032], 20, [true; 2])));
        let outline = [
            [-0.012, 0.001],
            [-0.004, -0.006],
            [0.03, -0.007],
            [0.08, -0.001],
            [0.081, 0.0],
            [0.06, 0.0025],
            [0.008, 0.006],
            [-0.006, 0.006],
        ];
        let [low, high] = if side > 0.0 { [-0.0001, 0.0026] } else { [-0.0026, 0.0001] };
        mesh.push((names[2], Body::prism(&outline.map(|[x, y]| [x, side * y]), low, high)));
    }
    let screw = [
        (0.0, -0.0034),
        (0.0032, -0.0034),
        (0.004, -0.0028),
        (0.004, 0.0028),
        (0.0032, 0.0034),
        (0.0, 0.0034),
    ];
    mesh.push(("screw", Body::revolve(&screw, 24)));
    mesh
}

/// A hook on a wall plate with its front at x = 0. The hook points along +x, long enough for a mug beside the plate,
/// and its tip points up.
fn hook() -> Mesh {
    let plate = Body::cuboid([-0.0025, 0.0, 0.0], [0.005, 0.04, 0.08], 0.001);
    let mut path = line([-0.003, 0.0, 0.0], [0.078, 0.0, 0.0], 27);
    path.extend(&arc([0.078, 0.0, 0.012], scale(X, 0.012), scale(Z, 0.012), [-90.0, 0.0], 12)[1..]);
    path.extend(&line([0.090, 0.0, 0.012], [0.090, 0.0, 0.024], 4)[1..]);
    vec![("plate", plate), ("hook", Body::sweep(&path, Y, [0.004; 2], 24, [false, true]))]
}

/// A stand for six mugs: a disc, a post about the z axis, and pegs that are tilted up by 20 degrees.
fn mug_tree() -> Mesh {
    let base = [
        (0.0, 0.0),
        (0.068, 0.0),
        (0.07, 0.002),
        (0.07, 0.010),
        (0.0694, 0.0114),
        (0.068, 0.012),
        (0.0, 0.012),
    ];
    let mut post = vec![(0.0, 0.006)];
    post.extend((0..=30).map(|i| (0.008, 0.006 + 0.286 * f64::from(i) / 30.0)));
    post.extend([(0.0069, 0.296), (0.004, 0.2989), (0.0, 0.3)]);
    let mut mesh = vec![("base", Body::revolve(&base, 72)), ("post", Body::revolve(&post, 32))];
    let names = ["peg_1", "peg_2", "peg_3", "peg_4", "peg_5", "peg_6"];
    let [cos, sin] = turn(20.0);
    for (i, name) in names.into_iter().enumerate() {
        let [x, y] = turn(f64::from(60 * (i as u32 / 2) + 180 * (i as u32 % 2)));
        let along = [cos * x, cos * y, sin];
        let start = [0.0, 0.0, 0.14 + 0.06 * (i / 2) as f64];
        let path = line(add(start, scale(along, 0.002)), add(start, scale(along, 0.0735)), 24);
        mesh.push((name, Body::sweep(&path, [-y, x, 0.0], [0.0045; 2], 20, [false, true])));
    }
    mesh
}

/// `n` points and normals, uniform on the part of the surface that no other body contains.
fn sample_cloud(mesh: &Mesh, n: usize, seed: u64) -> (Vec<V>, Vec<V>) {
    let mut random = Random::new(seed);
    let windings: Vec<Winding> = mesh.iter().map(|(_, body)| body.winding()).collect();
    let mut triangles = Vec::new();
    let mut total = 0.0;
    for (owner, (_, body)) in mesh.iter().enumerate() {
        for t in &body.triangles {
            let [a, b, c] = t.map(|i| body.vertices[i]);
            let normal = cross(sub(b, a), sub(c, a));
            total += length(normal);
            triangles.push((total, owner, [a, b, c], unit(normal)));
        }
    }
    let (mut points, mut normals) = (Vec::new(), Vec::new());
    while points.len() < n {
        let pick = random.range(0.0, 1.0) * total;
        let (mut u, mut v) = (random.range(0.0, 1.0), random.range(0.0, 1.0));
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let &(_, owner, [a, b, c], normal) = &triangles[triangles.partition_point(|t| t.0 <= pick)];
        let p = add(a, add(scale(sub(b, a), u), scale(sub(c, a), v)));
        let mut others = windings.iter().enumerate().filter(|(other, _)| *other != owner);
        let hidden = others.any(|(_, winding)| winding.number(&p.into()) > 0.5);
        if !hidden {
            points.push(p);
            normals.push(normal);
        }
    }
    (points, normals)
}

fn obj(mesh: &Mesh) -> Vec<u8> {
    let mut text = String::from("# metres, z up\n");
    let mut first = 1;
    for (name, body) in mesh {
        writeln!(text, "o {name}").unwrap();
        for [x, y, z] in &body.vertices {
            // Adding zero turns -0 into 0.
            let micrometres = |c: f64| (c * 1e6).round() / 1e6 + 0.0;
            writeln!(text, "v {:.6} {:.6} {:.6}", micrometres(*x), micrometres(*y), micrometres(*z)).unwrap();
        }
        for [a, b, c] in &body.triangles {
            writeln!(text, "f {} {} {}", a + first, b + first, c + first).unwrap();
        }
        first += body.vertices.len();
    }
    text.into_bytes()
}

fn ply(points: &[V], normals: &[V]) -> Vec<u8> {
    let mut bytes = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", points.len());
    for name in ["x", "y", "z", "nx", "ny", "nz"] {
        writeln!(bytes, "property float {name}").unwrap();
    }
    bytes.push_str("end_header\n");
    let mut bytes = bytes.into_bytes();
    for (p, n) in points.iter().zip(normals) {
        for c in p.iter().chain(n) {
            bytes.extend((*c as f32).to_le_bytes());
        }
    }
    bytes
}

fn main() -> ExitCode {
    let check = match std::env::args().nth(1).as_deref() {
        None => false,
        Some("--check") => true,
        Some(other) => {
            eprintln!("samples: unknown option {other}; the only option is --check");
            return ExitCode::from(2);
        }
    };
    let cloud = |mesh: &Mesh, seed| {
        let (points, normals) = sample_cloud(mesh, 10_000, seed);
        ply(&points, &normals)
    };
    let files = [
        ("mug.obj", obj(&mug())),
        ("mug_depth.png", depth_image(&mug())),
        ("mug_camera.txt", camera_matrix().into_bytes()),
        ("mug_start.json", MUG_START.into()),
        ("pairs.csv", PAIRS.into()),
        ("scissors.obj", obj(&scissors())),
        ("hook.obj", obj(&hook())),
        ("hook.ply", cloud(&hook(), 1)),
        ("mug_tree.obj", obj(&mug_tree())),
        ("mug_tree.ply", cloud(&mug_tree(), 2)),
    ];
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples");
    let mut all_well = true;
    for (name, bytes) in files {
        let path = folder.join(name);
        if !check {
            let written = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&path, &bytes));
            if let Err(error) = written {
                eprintln!("samples: cannot write {}: {error}", path.display());
                return ExitCode::FAILURE;
            }
            println!("samples/{name}: {} bytes", bytes.len());
            continue;
        }
        match std::fs::read(&path) {
            Ok(there) if there == bytes => {}
            Ok(_) => {
                eprintln!("samples/{name} differs from the generated file; run `make samples` to write it");
                all_well = false;
            }
            Err(error) => {
                eprintln!("samples/{name}: {error}; run `make samples` to write it");
                all_well = false;
            }
        }
    }
    if all_well { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
