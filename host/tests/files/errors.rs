//! Each error states what is wrong, where, and how to mend it.

use std::path::Path;

use hangpose::files::{FileError, read_mesh, read_supporter};

use crate::samples::*;

/// Asserts that the message begins with the path and contains these parts.
fn assert_says(error: FileError, name: &str, parts: &[&str]) {
    let message = error.to_string();
    let (path, rest) = message.split_once(": ").expect("a path first");
    assert!(path.ends_with(name), "{message}");
    for part in parts {
        assert!(rest.contains(part), "\"{part}\" is not in: {message}");
    }
}

fn bad_mesh(name: &str, content: impl AsRef<[u8]>, parts: &[&str]) {
    assert_says(mesh(name, content).expect_err(name), name, parts);
}

fn bad_cloud(name: &str, content: impl AsRef<[u8]>, parts: &[&str]) {
    assert_says(cloud(name, content).expect_err(name), name, parts);
}

#[test]
fn no_file_no_content_no_format() {
    let missing = Path::new("/nowhere/mug.obj");
    assert_says(read_mesh(missing).unwrap_err(), "mug.obj", &["no such file; check the path"]);
    let directory = tempfile::TempDir::with_suffix(".obj").unwrap();
    assert_says(
        read_mesh(directory.path()).unwrap_err(),
        ".obj",
        &["it is a directory", "give the path of a file"],
    );
    bad_mesh("mug.obj", "", &["the file is empty"]);
    bad_mesh(
        "mug.step",
        "x",
        &["\".step\" is not a supported format", "supported are obj, stl, ply, glb, gltf and urdf", "export"],
    );
    bad_mesh(
        "mug.dae",
        "x",
        &["supported are obj,", "otherwise convert it", "assimp export mesh.dae mesh.obj"],
    );
    bad_mesh("mug", "x", &["the file name has no extension"]);
    bad_cloud("scan.las", "x", &["supported are ply, pcd, xyz, txt and pts"]);
    let supporter = read_supporter(&file("rack.fbx", "x").path).unwrap_err();
    assert_says(
        supporter,
        "rack.fbx",
        &["supported are obj, stl, ply, glb, gltf, urdf, pcd, xyz, txt and pts"],
    );
}

#[test]
fn cut_off() {
    let cube = stl_binary_cube("");
    bad_mesh("a.stl", &cube[..50], &["byte 50: ", "84 bytes of header", "cut off"]);
    bad_mesh(
        "a.stl",
        &cube[..500],
        &["byte 500: the header declares 12 triangles in 684 bytes, but there are 500"],
    );
    let text = stl_text_cube();
    let cut = text.find("vertex 1 1 0").unwrap() + 8;
    bad_mesh("a.stl", &text[..cut], &["line 6: expected three numbers"]);
    bad_mesh(
        "a.stl",
        stl_text_cube().replace("endsolid cube", ""),
        &["line 85: the last solid has no \"endsolid\""],
    );
    bad_mesh(
        "a.ply",
        ply_text_cube().split("element face").next().unwrap(),
        &["the header has no end_header", "export it again"],
    );
    bad_mesh(
        "a.ply",
        ply_text_cube().replace("4 1 3 7 5\n", ""),
        &["declares 6 of element face, but there are 5"],
    );
    bad_mesh("a.ply", &ply_binary_cube(false)[..300], &["cut off"]);
    bad_mesh(
        "a.glb",
        &glb_cube(r#"{"mesh":0}"#)[..600],
        &["byte 600: the header declares ", "but there are 600"],
    );
    bad_mesh("a.gltf", &GLTF_TRIANGLE[..300], &["re-export it as glb"]);
    bad_cloud(
        "a.pcd",
        &pcd_binary()[..pcd_binary().len() - 9],
        &["the header declares 4 points in 48 bytes, but 39 bytes follow it"],
    );
    bad_cloud(
        "a.pcd",
        pcd_text().replace("5 6 0\n", ""),
        &["the header declares 4 points, but 3 lines follow it"],
    );
    bad_cloud("a.pts", "3\n1 2 3\n4 5 6\n", &["a count of 3 points, but has 2", "cut off"]);
}

#[test]
fn not_what_it_says() {
    bad_mesh("a.obj", "v 0 0 0\nv 1 0\n", &["line 2: expected three numbers", "re-export"]);
    bad_mesh("a.obj", "v 0 0 zero\n", &["line 1: expected a number, not \"zero\""]);
    bad_mesh("a.obj", "v 0 0 0\nf 1 0 1\n", &["line 2: \"0\" is not a vertex: vertices are counted from 1"]);
    bad_mesh("a.obj", "v 0 0 0\nf 1 1\n", &["line 2: a face needs three corners, this one has 2"]);
    bad_mesh(
        "a.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nendloop\nendfacet\nendsolid\n",
        &["line 6: a facet needs three vertices, this one has 1"],
    );
    bad_mesh("a.stl", "solid a\nfacette\n", &["line 2: unexpected \"facette\"", "binary STL"]);
    bad_mesh("a.ply", "solid a\n", &["line 1: Expected magic number 'ply'", "check that it is a PLY"]);
    bad_mesh(
        "a.ply",
        ply_text_cube().replace("4 0 2 3 1", "4 0 2 x 1"),
        &["line 20: vertex_indices of element face cannot be \"x\""],
    );
    bad_mesh(
        "a.ply",
        ply_text_cube().replace("0 0 0 255", "0 0 0 255 7"),
        &["line 12: \"7\" is more than the header declares"],
    );
    bad_mesh("a.ply", ply_text_cube().replace("float z", "float w"), &["element vertex: it lacks x, y or z"]);
    bad_mesh(
        "a.ply",
        ply_text_cube().replace("vertex_indices", "corners"),
        &["element face: it lacks vertex_indices"],
    );
    bad_mesh("a.glb", "not a glb at all", &["re-export it as glb"]);
    // Behind a byte order mark the crate subtracts from the length 0.
    bad_mesh("a.glb", "\u{feff}glTF\x02\0\0\0\0\0\0\0\0", &["cannot be 0 bytes long"]);
    bad_mesh("a.gltf", GLTF_TRIANGLE.replace("\"mesh\":0", "\"mesh\":5"), &["nodes[0].mesh"]);
    bad_mesh(
        "a.gltf",
        GLTF_TRIANGLE.replace("5126", "5122"),
        &["mesh 0, primitive 0: its POSITION is not three floats"],
    );
    bad_mesh(
        "a.gltf",
        GLTF_TRIANGLE.replace("base64,AAAB", "base64,AAA?"),
        &["buffer 0: its data URI is not base64"],
    );
    bad_mesh(
        "a.gltf",
        gltf_cube_json(r#"{"mesh":0}"#, r#""uri":"cube.bin","#),
        &["cube.bin is missing: keep it beside the glTF"],
    );
    let draco = GLTF_TRIANGLE
        .replace("\"nodes\"", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"nodes\"");
    bad_mesh("a.gltf", draco, &["an unsupported extension", "without mesh compression"]);
    bad_cloud("a.pcd", "VERSION 0.7\nFIELDS x y z\n", &["the header: ", "save it as binary PCD"]);
    bad_cloud("a.pcd", pcd_text().replace("FIELDS x y z", "FIELDS x y w"), &["FIELDS lacks x, y or z"]);
    bad_cloud("a.pcd", pcd_text().replace("3 4 0", "3 four 0"), &["point 2 (counted from 0)"]);
    bad_cloud("a.xyz", "x y z\n1 2 3\n", &["line 1: expected a number, not \"x\"", "put # before headings"]);
    bad_cloud("a.xyz", "1 2 3\n1 2\n", &["line 2: the previous points have 3 numbers, this one has 2"]);
    bad_cloud(
        "a.xyz",
        "1 2 3 4 5\n",
        &["line 1: expected 3 numbers (x y z) or 6 (x y z and a normal), found 5"],
    );
}

#[test]
fn nothing_in_it() {
    bad_mesh(
        "a.obj",
        "# only a comment\n",
        &["holds no triangles; check that the exporter includes the mesh"],
    );
    bad_mesh("a.stl", "solid a\nendsolid a\n", &["holds no triangles"]);
    bad_mesh("a.stl", stl_binary("", &[]), &["holds no triangles"]);
    bad_mesh("a.gltf", r#"{"asset":{"version":"2.0"}}"#, &["holds no triangles"]);
    bad_cloud("a.xyz", "# nothing\n", &["holds no points; check"]);
    bad_cloud(
        "a.pcd",
        pcd_header("x y z", 2, "ascii") + "nan nan nan\nnan nan nan\n",
        &["no points: all 2 are marked as missing"],
    );
}

#[test]
fn a_cloud_for_a_mesh_and_a_mesh_for_a_cloud() {
    let wanted =
        ["is a point cloud (points without faces), but a mesh is needed; reconstruct its surface first"];
    bad_mesh("a.obj", "v 0 0 0\nv 1 1 1\n", &wanted);
    bad_mesh("a.ply", PLY_CLOUD, &wanted);
    bad_mesh("a.pcd", pcd_text(), &wanted);
    bad_mesh("a.xyz", XYZ, &wanted);
    let wanted = ["is a mesh, but a point cloud is needed; sample points on its surface first"];
    bad_cloud("a.obj", obj_cube(), &wanted);
    bad_cloud("a.ply", ply_text_cube(), &wanted);
    bad_cloud("a.stl", stl_text_cube(), &wanted);
}

#[test]
fn numbers_that_are_none() {
    bad_mesh(
        "a.obj",
        obj_cube().replace("v 1 1 1", "v 1 nan 1"),
        &["vertex 7 (counted from 0) is not finite; check the exporter"],
    );
    bad_mesh("a.obj", obj_cube().replace("v 1 1 1", "v 1 1e39 1"), &["vertex 7 "]);
    bad_mesh("a.stl", stl_text_cube().replacen("vertex 0 0 0", "vertex 0 inf 0", 1), &["vertex 0 "]);
    bad_mesh("a.stl", stl_binary("", &[[CUBE[0], CUBE[1], [0.0, f32::NAN, 0.0]]]), &["vertex 2 "]);
    bad_mesh("a.ply", ply_text_cube().replace("0 1 1 255", "0 -nan 1 255"), &["vertex 6 "]);
    bad_cloud("a.ply", PLY_CLOUD.replace("-1 .5", "inf .5"), &["point 1 (counted from 0) is not finite"]);
    bad_cloud(
        "a.ply",
        PLY_CLOUD.replace("0 0 2", "0 nan 2"),
        &["normal of point 1 (counted from 0) is not finite"],
    );
    bad_cloud("a.xyz", "1 2 3\n4 1.#QNAN 6\n", &["point 1 "]);
    bad_cloud("a.pcd", pcd_text().replace("5 6 0", "5 inf 0"), &["point 2 "]);
}

#[test]
fn indices_out_of_range() {
    bad_mesh(
        "a.obj",
        obj_cube() + "f 1 2 9\n",
        &["line 17 uses vertex 9, but there are 8 vertices, counted from 1", "export it again"],
    );
    bad_mesh(
        "a.obj",
        obj_cube() + "f 1 2 -9\n",
        &["line 17: \"-9\" counts back past the first of 8 vertices"],
    );
    bad_mesh(
        "a.ply",
        ply_text_cube().replace("4 1 3 7 5", "4 1 3 8 5"),
        &["line 25 uses vertex 8, but there are 8 vertices, counted from 0"],
    );
    bad_mesh("a.ply", ply_text_cube().replace("4 1 3 7 5", "4 1 3 -1 5"), &["line 25 uses vertex -1"]);
    let mut binary = ply_binary_cube(false);
    *binary.last_mut().unwrap() = 0xff;
    bad_mesh("a.ply", binary, &["face 5 (counted from 0) uses vertex -16777211, but there are 8"]);
    let mut buffer = gltf_cube_buffer();
    buffer[96] = 8;
    bad_mesh(
        "a.glb",
        glb(&gltf_cube_json(r#"{"mesh":0}"#, ""), &buffer),
        &["mesh 0, primitive 0 uses vertex 8, but there are 8 vertices"],
    );
}

#[test]
fn nothing_but_degenerate_faces() {
    let wanted = ["none of its 2 faces has an area; check the scale and the unit"];
    bad_mesh("a.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\nf 1 1 2\n", &wanted);
    bad_mesh("a.obj", "v 0 0 0\nv 1 1 1\nf 1 1 2\nf 1 2 2\n", &wanted);
}
