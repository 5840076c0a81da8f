//! Objects and supporters from URDF files and ROS packages.

use super::*;
use std::fs;

/// A workspace with a package of the sample mug and hook, and a URDF of a wall that carries the hook.
fn workspace() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("things");
    fs::create_dir_all(package.join("meshes")).unwrap();
    for name in ["mug.obj", "hook.obj"] {
        fs::copy(sample(name), package.join("meshes").join(name)).unwrap();
    }
    let mesh = "<visual><geometry><mesh filename=\"package://things/meshes/hook.obj\"/></geometry></visual>";
    let wall = "<visual><geometry><box size=\"0.1 1 1\"/></geometry></visual>";
    let joint = "<parent link=\"wall\"/><child link=\"hook\"/><origin xyz=\"0.2 0 0\"/>";
    let text = format!(
        "<robot name=\"wall\"><link name=\"wall\">{wall}</link><link name=\"hook\">{mesh}</link>\
         <joint name=\"fixed\" type=\"fixed\">{joint}</joint></robot>"
    );
    fs::write(folder.path().join("wall.urdf"), text).unwrap();
    folder
}

fn predict(folder: &TempDir, object: &str, supporter: &str, variable: &str, path: &Path) -> Run {
    let mut command = command();
    command.current_dir(folder.path()).env_remove("AMENT_PREFIX_PATH").env_remove("ROS_PACKAGE_PATH");
    command.args(["predict", "--top", "1", "--json", "-", "--object", object, "--supporter", supporter]);
    finish(command.env(variable, path))
}

#[test]
fn a_link_of_a_urdf_is_what_its_mesh_is() {
    let folder = workspace();
    let [mug, hook] = ["things/meshes/mug.obj", "things/meshes/hook.obj"];
    let plain = timeless(predict(&folder, mug, hook, "ROS_PACKAGE_PATH", Path::new("")).json());
    let package = "package://things/meshes/mug.obj";
    let named = predict(&folder, package, "wall.urdf#hook", "ROS_PACKAGE_PATH", folder.path());
    assert_eq!((named.status, named.stderr.as_str()), (Some(0), ""));
    assert_eq!(plain, timeless(named.json()));

    // Where ROS 2 installs packages.
    let prefix = folder.path().join("install");
    fs::create_dir_all(prefix.join("share")).unwrap();
    fs::rename(folder.path().join("things"), prefix.join("share/things")).unwrap();
    let found = predict(&folder, package, "wall.urdf#hook", "AMENT_PREFIX_PATH", &prefix);
    assert_eq!(plain, timeless(found.json()));
    let lost = predict(&folder, package, "wall.urdf#hook", "AMENT_PREFIX_PATH", folder.path());
    assert_eq!(lost.status, Some(1));
    assert!(lost.stderr.contains("the package \"things\" was not found"), "{}", lost.stderr);

    // The box of the wall ends 0.05 m in front of its middle, and the hook begins 0.2 m in front of it.
    let mut command = command();
    let all = command.args(["inspect", "--json", "wall.urdf"]).current_dir(folder.path());
    let all = finish(all.env("AMENT_PREFIX_PATH", &prefix)).json();
    let hook = run!("inspect", "--json", prefix.join("share/things/meshes/hook.obj")).json();
    let [wall, hook] = [&all, &hook].map(|document| numbers::<3>(&document["extents"]));
    assert!((wall[1], wall[2]) == (1.0, 1.0) && wall[0] > hook[0] + 0.1, "{wall:?} {hook:?}");
}

#[test]
fn a_table_of_pairs_may_name_packages() {
    let folder = workspace();
    let table = "object,supporter\npackage://things/meshes/mug.obj,wall.urdf#hook\n";
    fs::write(folder.path().join("pairs.csv"), table).unwrap();
    let mut command = command();
    command.args(["batch", "-o", "out.csv"]).arg("pairs.csv").current_dir(folder.path());
    let run = finish(command.env("ROS_PACKAGE_PATH", folder.path()));
    assert!(run.status == Some(0) && run.stdout.contains(": 1 hang,"), "{}{}", run.stdout, run.stderr);
}
