//! Readers of each mesh format.

use hangpose::files::{SupporterFile, read_mesh, read_supporter};

use crate::samples::*;

#[test]
fn every_format_reads_the_same_cube() {
    let cubes = [
        ("cube.obj", obj_cube().into_bytes()),
        ("cube.stl", stl_text_cube().into_bytes()),
        ("cube.STL", stl_binary_cube("made by hand")),
        ("cube.ply", ply_text_cube().into_bytes()),
        ("cube.ply", ply_binary_cube(false)),
        ("cube.ply", ply_binary_cube(true)),
        ("cube.glb", glb_cube(r#"{"mesh":0}"#)),
    ];
    for (name, content) in cubes {
        let mesh = mesh(name, content).expect(name);
        assert_unit_cube(&mesh);
        assert!(mesh.notes.is_empty(), "{name}: {:?}", mesh.notes);
    }
}

#[test]
fn a_binary_stl_may_begin_with_solid() {
    assert_unit_cube(
        &mesh("cube.stl", stl_binary_cube("solid exported by a program that does not know better")).unwrap(),
    );
}

#[test]
fn a_binary_stl_may_be_followed_by_more() {
    let mut content = stl_binary_cube("solid");
    content[5] = 0;
    content.extend([1, 2, 3]);
    let mesh = mesh("cube.stl", content).unwrap();
    assert_unit_cube(&mesh);
    assert_eq!(mesh.notes, ["3 bytes after the last triangle were ignored."]);
}

#[test]
fn a_text_stl_may_hold_several_solids_and_odd_normals() {
    let text = stl_text_cube()
        .replace("normal 0 0 0", "normal -nan(ind) nan nan")
        .replace("vertex 0 0 0", "VERTEX -0 0 -0.0");
    let far = text.replace("vertex 1", "vertex 1.5");
    let both = mesh("cubes.stl", text.clone() + "\n" + &far).unwrap();
    assert_eq!(both.triangles.len(), 24);
    assert_unit_cube(&mesh("cube.stl", text.replace('\n', "\r\n")).unwrap());
    assert_unit_cube(&mesh("cube.stl", text.replace("solid cube", "solid")).unwrap());
}

#[test]
fn obj_merges_groups_and_knows_every_form_of_corner() {
    // The cube with negative indices, textures, normals, colours, a weight, a continued line, a polyline and an old
    // code page.
    let content = b"mtllib missing.mtl\no \xfc\nv 0 0 0 0.5 0.5 0.5\nv 1 0 0\nv 0 1 0\nv 1 1 0\n\
        v 0 0 1\nv 2 0 2 2\nv 0 1 1\nv 1 1 1\nvt 0.5\nvt 0 0\nvn 0 0 1\n\
        g\nusemtl\nl 1 2 3\np 1\nf 1 3 4 2\ng one two\ns 1\nf -4 -3 -1 -2\no other\nf 1/1 2/1 6/2 5/2\n\
        f 3//1 7//1 8//1 4//1\nusemtl red\nf 1/1/1 5/2/1 \\\n 7/1/1 3/1/1 # side\nf 2 4 8 6\n";
    let mesh = mesh("cube.obj", content).unwrap();
    assert_unit_cube(&mesh);
    assert!(mesh.notes.is_empty(), "{:?}", mesh.notes);
}

#[test]
fn vertices_at_the_same_place_are_joined_and_unused_ones_left_out() {
    let content = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 nan\nv 1 0 -0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 5 6 7\n";
    let mesh = mesh("square.obj", content).unwrap();
    assert_eq!(mesh.vertices, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
    let notes = [
        "6 vertices at 4 distinct positions were merged.",
        "1 of 7 vertices belong to no face and were dropped.",
    ];
    assert_eq!(mesh.notes, notes);
}

#[test]
fn faces_with_repeated_vertices_are_dropped_but_thin_ones_kept() {
    let content = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 1 3\nf 1 2 4\nf 3 2 2 1\nf 2 3 2 4\n";
    let mesh = mesh("thin.obj", content).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, 3], [2, 1, 0]]);
    let notes = ["2 of 5 faces had repeated vertices and were dropped.", "1 of 3 triangles have no area."];
    assert_eq!(mesh.notes, notes);
}

#[test]
fn glb_applies_the_transforms_of_all_nodes() {
    // A quarter turn about z, a scale of 2, then a translation by 10 along x: (1, 0, 0) goes to (10, 2, 0).
    let nodes = r#"{"translation":[10,0,0],"children":[1]},
        {"rotation":[0,0,0.70710678,0.70710678],"scale":[2,2,2],"mesh":0}"#;
    let turned = mesh("turned.glb", glb_cube(nodes)).unwrap();
    assert!(is_closed(&turned));
    assert!((volume(&turned) - 8.0).abs() < 1e-5);
    for (read, [x, y, z]) in turned.vertices.iter().zip(CUBE) {
        let expected = [10.0 - 2.0 * y, 2.0 * x, 2.0 * z];
        assert!(read.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5), "{read:?} {expected:?}");
    }

    // A column-major matrix that mirrors x: the surface must not turn inside out.
    let mirrored =
        mesh("mirrored.glb", glb_cube(r#"{"matrix":[-1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1],"mesh":0}"#)).unwrap();
    assert!((volume(&mirrored) - 1.0).abs() < 1e-9);
    assert!(mirrored.vertices.contains(&[5.0, 0.0, 0.0]) && mirrored.vertices.contains(&[4.0, 1.0, 1.0]));

    // Two nodes use one mesh; the second is a child of the first.
    let two =
        mesh("two.glb", glb_cube(r#"{"mesh":0,"children":[1]},{"mesh":0,"translation":[0,0,3]}"#)).unwrap();
    assert_eq!(two.triangles.len(), 24);
    assert!((volume(&two) - 2.0).abs() < 1e-9);
}

#[test]
fn a_circle_of_nodes_ends() {
    let mesh = mesh("circle.glb", glb_cube(r#"{"mesh":0,"children":[1]},{"children":[0]}"#)).unwrap();
    assert_unit_cube(&mesh);
}

#[test]
fn gltf_reads_data_uris_and_files_beside_it() {
    let triangle = mesh("triangle.gltf", GLTF_TRIANGLE).unwrap();
    assert_eq!(triangle.vertices, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(triangle.triangles, [[0, 1, 2]]);

    let file = file("cube.gltf", gltf_cube_json(r#"{"mesh":0}"#, r#""uri":"my%20cube.bin","#));
    std::fs::write(file.path.with_file_name("my cube.bin"), gltf_cube_buffer()).unwrap();
    assert_unit_cube(&read_mesh(&file.path).unwrap());
}

#[test]
fn gltf_strips_fans_and_unindexed_triangles() {
    let quad = [
        [0.0_f32, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 2.0, 0.0],
        [1.0, 2.0, 0.0],
    ];
    let bytes: Vec<u8> = quad.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let read = |mode: u32, points: usize| {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"mode":{mode}}},{{"attributes":{{"POSITION":0}},"mode":1}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":{points},"type":"VEC3"}}],
            "bufferViews":[{{"buffer":0,"byteLength":72}}],"buffers":[{{"byteLength":72}}]}}"#
        );
        mesh("quad.glb", glb(&json, &bytes)).unwrap()
    };
    let strip = read(5, 6);
    assert_eq!(strip.triangles, [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]]);
    assert_eq!(
        (area(&strip), strip.notes),
        (2.0, vec!["1 primitives are points or lines and were ignored.".to_string()])
    );
    assert_eq!(read(6, 4).triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(read(4, 6).triangles, [[0, 1, 2], [3, 4, 5]]);
}

#[test]
fn ply_takes_any_integer_for_its_indices_and_any_element_beside() {
    let content = "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float64 x\r\nproperty float64 y\r\nproperty float64 z\r\n\
        element edge 1\r\nproperty int vertex1\r\nelement face 1\r\nproperty uchar flag\r\n\
        property list int uint16 vertex_indices\r\nproperty list uchar float texcoord\r\nend_header\r\n\
        0 0 0\r\n1 0 0\r\n0 1 0\r\n7\r\n1 3 0 1 2 6 0 0 1 0 0 1\r\n";
    let mesh = mesh("triangle.ply", content).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(mesh.vertices[1], [1.0, 0.0, 0.0]);
}

#[test]
fn a_supporter_is_what_its_content_says() {
    let is_mesh = |name: &str, content: &[u8]| match read_supporter(&file(name, content).path).expect(name) {
        SupporterFile::Mesh(mesh) => {
            assert_unit_cube(&mesh);
            true
        }
        SupporterFile::Cloud(cloud) => {
            assert_eq!(cloud.points.len(), 3);
            false
        }
    };
    assert!(is_mesh("s.obj", obj_cube().as_bytes()));
    assert!(is_mesh("s.ply", &ply_binary_cube(true)));
    assert!(is_mesh("s.stl", &stl_binary_cube("")));
    assert!(is_mesh("s.glb", &glb_cube(r#"{"mesh":0}"#)));
    assert!(!is_mesh("s.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"));
    assert!(!is_mesh("s.ply", PLY_CLOUD.as_bytes()));
    assert!(!is_mesh("s.pcd", pcd_text().as_bytes()));
    assert!(!is_mesh("s.pts", XYZ.as_bytes()));
}
