//! URDF files: solids, meshes, joints and packages.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use hangpose::files::{MeshFile, SupporterFile, read_mesh, read_supporter};
use tempfile::TempDir;

use crate::samples::*;

/// Volume inside a closed mesh, and its centroid.
fn solid(mesh: &MeshFile) -> (f64, [f64; 3]) {
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| mesh.vertices[i as usize].map(f64::from));
        let part = (0..3)
            .map(|i| a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3]))
            .sum::<f64>()
            / 6.0;
        volume += part;
        (0..3).for_each(|i| moment[i] += part * (a[i] + b[i] + c[i]) / 4.0);
    }
    (volume, moment.map(|m| m / volume))
}

/// Asserts a volume, of which solids of 48 sides lack up to 1 %, and a centroid, which moves by what they lack.
#[track_caller]
fn assert_solid(mesh: &MeshFile, volume: f64, centroid: [f64; 3]) {
    let (found, at) = solid(mesh);
    assert!(found <= 1.000001 * volume && found > 0.99 * volume, "{found}, not {volume}");
    assert!((0..3).all(|i| (at[i] - centroid[i]).abs() < 0.002), "{at:?}, not {centroid:?}");
}

const SPHERE: f64 = 4.0 / 3.0 * PI * 0.25 * 0.25 * 0.25;
const CAPSULE: f64 = SPHERE + PI * 0.25 * 0.25;

#[test]
fn links_are_where_their_joints_have_them() {
    let file = file("rack.urdf", URDF);
    let link = |name: &str| read_mesh(Path::new(&format!("{}#{name}", file.path.display()))).unwrap();
    assert_solid(&link("post"), 0.08, [0.0, 0.0, 0.5]);
    // In its own frame the cylinder lies along x.
    let arm = link("arm");
    assert_solid(&arm, 2.0 * PI * 0.01, [0.0; 3]);
    let reach = |axis: usize| arm.vertices.iter().map(|v| v[axis]).fold(0.0, f32::max);
    assert!((reach(0) - 1.0).abs() < 1e-6 && (reach(1) - 0.1).abs() < 1e-6);
    assert_eq!(arm.notes, ["links without visual meshes are their collision meshes: arm."]);
    let tip = link("tip");
    assert_solid(&tip, SPHERE + CAPSULE, [0.0, 0.0, 2.0 * CAPSULE / (SPHERE + CAPSULE)]);
    assert!(tip.notes.is_empty());

    // The arm is 3 above the post and turned from x to y, and the tip is 2 along it.
    let all = read_mesh(&file.path).unwrap();
    let count: usize = ["post", "arm", "tip"].map(|name| link(name).triangles.len()).iter().sum();
    assert_eq!(all.triangles.len(), count);
    let reach = |axis: usize| all.vertices.iter().map(|v| v[axis]).fold(f32::NEG_INFINITY, f32::max);
    assert!(
        (reach(0) - 0.25).abs() < 1e-6 && (reach(1) - 2.25).abs() < 1e-6 && (reach(2) - 5.75).abs() < 1e-6
    );
    assert!(matches!(read_supporter(&file.path), Ok(SupporterFile::Mesh(mesh)) if mesh == all));
}

/// A URDF of one link with a mesh.
fn with_mesh(name: &str, rest: &str) -> String {
    format!(
        "<robot name=\"r\"><link name=\"l\"><visual><geometry><mesh filename=\"{name}\"{rest}/></geometry></visual></link></robot>"
    )
}

#[test]
fn meshes_are_scaled_and_mirrored() {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("meshes")).unwrap();
    fs::write(folder.path().join("meshes/cube.stl"), stl_binary_cube("")).unwrap();
    let path = folder.path().join("r.urdf");
    let read = |text: String| {
        fs::write(&path, text).unwrap();
        read_mesh(&path)
    };
    assert_unit_cube(&read(with_mesh("meshes/cube.stl", "")).unwrap());
    let at = format!("file://{}/meshes/cube.stl", folder.path().display());
    assert_unit_cube(&read(with_mesh(&at, "")).unwrap());
    let scaled = read(with_mesh("meshes/cube.stl", " scale=\"2 -1 0.5\"")).unwrap();
    assert_solid(&scaled, 1.0, [1.0, -0.5, 0.25]);
}

#[test]
fn packages_are_found_above_the_file() {
    let folder = TempDir::new().unwrap();
    let package = folder.path().join("ws/src/my_rack");
    fs::create_dir_all(package.join("urdf")).unwrap();
    fs::write(package.join("cube.obj"), obj_cube()).unwrap();
    let path = package.join("urdf/r.urdf");
    fs::write(&path, with_mesh("package://my_rack/cube.obj", "")).unwrap();
    assert_unit_cube(&read_mesh(&path).unwrap());
    fs::write(&path, with_mesh("package://other/cube.obj", "")).unwrap();
    let message = read_mesh(&path).unwrap_err().to_string();
    assert!(
        message.contains("r.urdf: link \"l\": package://other/cube.obj: the package \"other\" was not found"),
        "{message}"
    );
}

#[test]
fn errors_name_the_link() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("r.urdf");
    let message = |text: &str, link: &str| {
        fs::write(&path, text).unwrap();
        let message = read_mesh(Path::new(&format!("{}{link}", path.display()))).unwrap_err().to_string();
        assert!(message.starts_with(&path.display().to_string()), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        message
    };
    let has = |text: String, part: &str| assert!(text.contains(part), "{part} is not in {text}");
    has(message(URDF, "#hook"), "there is no link \"hook\"; the links are post, arm, tip, camera");
    has(message(URDF, "#camera"), "holds no triangles");
    has(message("<robot", ""), "the file: ");
    has(message("<mujoco/>", ""), "a xacro becomes a URDF by");
    has(message(&with_mesh("arm.dae", ""), ""), "arm.dae: no such file");
    fs::write(folder.path().join("arm.dae"), "x").unwrap();
    has(message(&with_mesh("arm.dae", ""), ""), "\".dae\" is not a supported format; supported are obj");
    has(message(&with_mesh("r.urdf", ""), ""), "link \"l\": r.urdf: a URDF is no mesh");
    let looped = "<parent link=\"tip\"/><child link=\"post\"/></joint></robot>";
    let looped = URDF.replace("</robot>", &format!("<joint name=\"d\" type=\"fixed\">{looped}"));
    has(message(&looped, ""), "the joints form a loop at the link");
}
