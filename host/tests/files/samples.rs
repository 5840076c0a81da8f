//! Small files written by the specification of each format, and measures of the meshes read from them.

use std::collections::HashMap;
use std::fs;
use std::path::PathBuf;

use hangpose::files::{CloudFile, FileError, MeshFile, read_cloud, read_mesh};
use tempfile::TempDir;

/// Corners of the unit cube: the bits of `i` are x, y and z of corner `i`.
pub(crate) const CUBE: [[f32; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [1.0, 1.0, 1.0],
];

/// Sides of the unit cube, counter-clockwise seen from outside.
pub(crate) const SIDES: [[u32; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

pub(crate) fn cube_triangles() -> Vec<[u32; 3]> {
    SIDES.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect()
}

/// A file in its own temporary directory, deleted on drop.
pub(crate) struct File {
    _directory: TempDir,
    pub(crate) path: PathBuf,
}

pub(crate) fn file(name: &str, content: impl AsRef<[u8]>) -> File {
    let directory = TempDir::new().expect("a temporary directory");
    let path = directory.path().join(name);
    fs::write(&path, content).expect("a temporary file");
    File { _directory: directory, path }
}

pub(crate) fn mesh(name: &str, content: impl AsRef<[u8]>) -> Result<MeshFile, FileError> {
    read_mesh(&file(name, content).path)
}

pub(crate) fn cloud(name: &str, content: impl AsRef<[u8]>) -> Result<CloudFile, FileError> {
    read_cloud(&file(name, content).path)
}

pub(crate) fn area(mesh: &MeshFile) -> f64 {
    corners(mesh).map(|[a, b, c]| length(cross(minus(b, a), minus(c, a))) / 2.0).sum()
}

/// Signed volume, positive if the triangles are counter-clockwise seen from outside.
pub(crate) fn volume(mesh: &MeshFile) -> f64 {
    corners(mesh).map(|[a, b, c]| dot(a, cross(b, c)) / 6.0).sum()
}

/// Whether each edge is used once in each direction.
pub(crate) fn is_closed(mesh: &MeshFile) -> bool {
    let mut edges = HashMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
        }
    }
    edges.iter().all(|((a, b), count)| *count == 1 && edges.contains_key(&(*b, *a)))
}

pub(crate) fn assert_unit_cube(mesh: &MeshFile) {
    let mut vertices = mesh.vertices.clone();
    vertices.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
    let mut expected = CUBE.to_vec();
    expected.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
    assert_eq!(vertices, expected);
    assert_eq!(mesh.triangles.len(), 12);
    assert!(is_closed(mesh));
    assert!((volume(mesh) - 1.0).abs() < 1e-9 && (area(mesh) - 6.0).abs() < 1e-9);
}

fn corners(mesh: &MeshFile) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
    mesh.triangles.iter().map(|t| t.map(|i| mesh.vertices[i as usize].map(f64::from)))
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn obj_cube() -> String {
    let vertices = CUBE.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
    let faces = SIDES.map(|s| format!("f {} {} {} {}\n", s[0] + 1, s[1] + 1, s[2] + 1, s[3] + 1)).concat();
    format!("# cube\no cube\n{vertices}{faces}")
}

pub(crate) fn stl_text_cube() -> String {
    let facets: String = cube_triangles()
        .iter()
        .map(|t| {
            let vertices = t.map(|i| CUBE[i as usize]).map(|[x, y, z]| format!("      vertex {x} {y} {z}\n"));
            format!("  facet normal 0 0 0\n    outer loop\n{}    endloop\n  endfacet\n", vertices.concat())
        })
        .collect();
    format!("solid cube\n{facets}endsolid cube\n")
}

pub(crate) fn stl_binary(header: &str, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut out = vec![b' '; 80];
    out[..header.len()].copy_from_slice(header.as_bytes());
    out.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        out.extend([0; 12]);
        out.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        out.extend([0; 2]);
    }
    out
}

pub(crate) fn stl_binary_cube(header: &str) -> Vec<u8> {
    let triangles: Vec<_> = cube_triangles().iter().map(|t| t.map(|i| CUBE[i as usize])).collect();
    stl_binary(header, &triangles)
}

pub(crate) fn ply_header(format: &str, list: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment made by hand\nelement vertex 8\nproperty float x\nproperty float y\n\
         property float z\nproperty uchar red\nelement face 6\nproperty list uchar int {list}\nend_header\n"
    )
}

pub(crate) fn ply_text_cube() -> String {
    let vertices = CUBE.map(|[x, y, z]| format!("{x} {y} {z} 255\n")).concat();
    let faces = SIDES.map(|s| format!("4 {} {} {} {}\n", s[0], s[1], s[2], s[3])).concat();
    ply_header("ascii", "vertex_indices") + &vertices + &faces
}

pub(crate) fn ply_binary_cube(big_endian: bool) -> Vec<u8> {
    let word = |bytes: [u8; 4]| {
        if big_endian { [bytes[3], bytes[2], bytes[1], bytes[0]] } else { bytes }
    };
    let format = if big_endian { "binary_big_endian" } else { "binary_little_endian" };
    let mut out = ply_header(format, "vertex_index").into_bytes();
    for vertex in CUBE {
        out.extend(vertex.iter().flat_map(|x| word(x.to_le_bytes())));
        out.push(255);
    }
    for side in SIDES {
        out.push(4);
        out.extend(side.iter().flat_map(|i| word(i.to_le_bytes())));
    }
    out
}

/// Buffer of the cube: 8 positions, then 36 two-byte indices.
pub(crate) fn gltf_cube_buffer() -> Vec<u8> {
    let positions = CUBE.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    let indices = cube_triangles().into_iter().flatten().flat_map(|i| (i as u16).to_le_bytes());
    positions.chain(indices).collect()
}

/// glTF JSON for `gltf_cube_buffer`, with these nodes and this key of the buffer.
pub(crate) fn gltf_cube_json(nodes: &str, buffer: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}},
        {{"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":72}}],
        "buffers":[{{{buffer}"byteLength":168}}]}}"#
    )
}

pub(crate) fn glb(json: &str, buffer: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut buffer = buffer.to_vec();
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend((12 + 8 + json.len() as u32 + 8 + buffer.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", buffer)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

pub(crate) fn glb_cube(nodes: &str) -> Vec<u8> {
    glb(&gltf_cube_json(nodes, ""), &gltf_cube_buffer())
}

/// glTF with a data URI: indices 0 1 2, two bytes of padding, then (0 0 0) (1 0 0) (0 1 0).
pub(crate) const GLTF_TRIANGLE: &str = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],
    "buffers":[{"uri":"data:application/octet-stream;base64,AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA=","byteLength":44}],
    "bufferViews":[{"buffer":0,"byteLength":6},{"buffer":0,"byteOffset":8,"byteLength":36}],
    "accessors":[{"bufferView":0,"componentType":5123,"count":3,"type":"SCALAR"},
    {"bufferView":1,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]}"#;

pub(crate) fn pcd_header(fields: &str, count: usize, data: &str) -> String {
    let n = fields.split(' ').count();
    let each = |word: &str| vec![word; n].join(" ");
    format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS {fields}\nSIZE {}\nTYPE {}\nCOUNT {}\nWIDTH {count}\nHEIGHT 1\n\
         VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA {data}\n",
        each("4"),
        each("F"),
        each("1")
    )
}

pub(crate) const PCD_POINTS: [[f32; 3]; 4] =
    [[1.0, 2.0, 0.0], [f32::NAN, f32::NAN, 0.0], [3.0, 4.0, 0.0], [5.0, 6.0, 0.0]];

pub(crate) fn pcd_text() -> String {
    pcd_header("x y z", 4, "ascii") + "1 2 0\nnan nan 0\n3 4 0\n5 6 0\n"
}

pub(crate) fn pcd_binary() -> Vec<u8> {
    let mut out = pcd_header("x y z", 4, "binary").into_bytes();
    out.extend(PCD_POINTS.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    out
}

/// Column-major and compressed by LZF: literal runs, then one back reference to a run of zeros.
pub(crate) fn pcd_compressed() -> Vec<u8> {
    let column = |k: usize| PCD_POINTS.iter().flat_map(|p| p[k].to_le_bytes()).collect::<Vec<u8>>();
    let mut packed = Vec::new();
    for k in [0, 1] {
        packed.push(15);
        packed.extend(column(k));
    }
    // A literal zero, then a long back reference: 15 bytes (2 + 7 + 6) from one byte back.
    packed.extend([0, 0, 7 << 5, 6, 0]);
    let mut out = pcd_header("x y z", 4, "binary_compressed").into_bytes();
    out.extend((packed.len() as u32).to_le_bytes());
    out.extend(48_u32.to_le_bytes());
    out.extend(packed);
    out
}

pub(crate) const PLY_CLOUD: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n\
     property double z\nproperty float nx\nproperty float ny\nproperty float nz\nend_header\n\
     1 2 3 0 0 1\n-1 .5 1. 0 0 2\n\n1e-3 +2 3 0 0 0\n";

pub(crate) const XYZ: &str =
    "\u{feff}# a scan\r\n3\r\n1 2 3 1 0 0 # first\r\n4,5,6,0,1,0\r\n\r\n// rest\r\n7;8;9;0;0;-1\r\n";

/// A rack of a post and two arms, one on the other, of which the first has no visual meshes.
pub(crate) const URDF: &str = r#"<?xml version="1.0"?>
<robot name="rack">
  <link name="post">
    <visual><origin xyz="0 0 0.5"/><geometry><box size="0.2 0.4 1"/></geometry></visual>
    <collision><geometry><sphere radius="9"/></geometry></collision>
  </link>
  <link name="arm">
    <collision><origin rpy="0 1.5707963267948966 0"/><geometry><cylinder radius="0.1" length="2"/></geometry></collision>
  </link>
  <link name="tip">
    <visual><geometry><sphere radius="0.25"/></geometry></visual>
    <visual><origin xyz="0 0 2"/><geometry><capsule radius="0.25" length="1"/></geometry></visual>
  </link>
  <link name="camera"/>
  <joint name="a" type="revolute">
    <parent link="post"/><child link="arm"/>
    <origin xyz="0 0 3" rpy="0 0 1.5707963267948966"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="b" type="fixed"><parent link="arm"/><child link="tip"/><origin xyz="2 0 0"/></joint>
  <joint name="c" type="fixed"><parent link="arm"/><child link="camera"/></joint>
</robot>
"#;
