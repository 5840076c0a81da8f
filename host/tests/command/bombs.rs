//! Small files that claim to be large, or become so: each is refused, with little memory and in little time.
#![cfg(target_os = "linux")]

use super::*;
use png::{BitDepth, ColorType};
use std::time::{Duration, Instant};

/// Memory that a run may reserve, kilobytes: a tenth of what the command takes for the largest input.
const MEMORY: &str = "500000";
/// A run takes at most this long, with a debug build on a busy machine.
const TIME: Duration = Duration::from_secs(20);

/// Asserts that a file is refused with a message that has `part`, in little memory.
#[track_caller]
fn assert_refused(path: &Path, arguments: &[&str], part: &str) {
    let begun = Instant::now();
    let mut command = Command::new("sh");
    command.args(["-c", &format!("ulimit -v {MEMORY}; exec \"$0\" \"$@\"")]);
    let run = finish(command.arg(env!("CARGO_BIN_EXE_hangpose")).args(arguments));
    let name = path.file_name().unwrap().to_str().unwrap();
    assert_eq!(run.status, Some(1), "{name}: {}", run.stderr);
    assert!(run.stdout.is_empty() && !run.stderr.contains("panicked"), "{name}: {}", run.stderr);
    let is_said = run.stderr.contains("error: ") && run.stderr.contains(name) && run.stderr.contains(part);
    assert!(is_said && run.stderr.len() < 4000, "{name} ({part}): {}", run.stderr);
    assert!(begun.elapsed() < TIME, "{name} took {:?}", begun.elapsed());
}

fn ply(format: &str, elements: &str, body: &str) -> Vec<u8> {
    format!("ply\nformat {format} 1.0\n{elements}end_header\n{body}").into_bytes()
}

const VERTICES: &str = "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n";

/// A glTF of `nodes` nodes with one mesh of 3000 vertices in a buffer beside it, and this view of the buffer.
fn gltf(nodes: usize, view: &str, count: &str, buffers: usize) -> Vec<u8> {
    let node = vec![r#"{"mesh":0}"#; nodes].join(",");
    let buffer = vec![r#"{"uri":"points.bin","byteLength":36000}"#; buffers].join(",");
    format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{node}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "buffers":[{buffer}],"bufferViews":[{{"buffer":0,{view}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":{count},"type":"VEC3"}}]}}"#
    )
    .into_bytes()
}

fn pcd(fields: &str, points: &str, packed: u32, unpacked: u32) -> Vec<u8> {
    let header = format!(
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT {fields}\nWIDTH {points}\nHEIGHT 1\n\
         VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\nDATA binary_compressed\n"
    );
    [header.as_bytes(), &packed.to_le_bytes(), &unpacked.to_le_bytes(), &[0xff; 64]].concat()
}

#[test]
fn meshes_and_clouds() {
    let scene = Scene::new();
    scene.write("points.bin", [0; 36_000]);
    let view = r#""byteLength":36000"#;
    let visual = r#"<visual><geometry><sphere radius="0.1"/></geometry></visual>"#;
    let robot = |inside: &str| format!("<robot name=\"r\">{inside}</robot>").into_bytes();
    let entities: String = (b'b'..=b'i')
        .map(|c| format!("<!ENTITY {} \"{}\">", c as char, format!("&{};", (c - 1) as char).repeat(10)))
        .collect();
    for (name, content, part) in [
        ("text.ply", ply("ascii", VERTICES, "0 0 0\n"), "declares 4000000000 of element vertex"),
        (
            "binary.ply",
            ply("binary_little_endian", VERTICES, "0 0 0\n"),
            "declares 4000000000 of element vertex",
        ),
        ("big.ply", ply("binary_big_endian", VERTICES, "0 0 0\n"), "declares 4000000000 of element vertex"),
        (
            "list.ply",
            ply(
                "binary_little_endian",
                "element face 1\nproperty list uint uint vertex_indices\n",
                "\u{7f}\u{7f}\u{7f}\u{7f}",
            ),
            "end of file",
        ),
        ("negative.gltf", gltf(1, r#""byteLength":36000,"byteStride":-12"#, "3000", 1), "-12"),
        ("stride.gltf", gltf(1, r#""byteLength":36000,"byteStride":4000000000"#, "3000", 1), "byteStride"),
        ("wide.gltf", gltf(1, r#""byteLength":36000,"byteStride":252"#, "3000", 1), "past the end"),
        ("view.gltf", gltf(1, r#""byteLength":18446744073709551615"#, "3000", 1), "past the end"),
        ("count.gltf", gltf(1, view, "18446744073709551615", 1), "past the end"),
        // One mesh a hundred thousand times, and one file ten thousand times.
        ("nodes.gltf", gltf(100_000, view, "3000", 1), "more than 16000000 vertices and face corners"),
        ("buffers.gltf", gltf(1, r#""byteLength":36000"#, "4000", 20_000), "past the end"),
        ("deep.gltf", "[".repeat(3_000_000).into_bytes(), "invalid type"),
        ("lzf.pcd", pcd("1 1 1", "300000000", 64, 3_600_000_000), "64 bytes that unpack to 3600000000"),
        ("lies.pcd", pcd("1 1 1", "100", 64, 1200), "LZF"),
        ("counts.pcd", pcd("1 1 4000000000", "4000000000", 64, 1200), "more than 2^64"),
        (
            "spheres.urdf",
            robot(&format!("<link name=\"l\">{}</link>", visual.repeat(20_000))),
            "more than 16000000",
        ),
        ("deep.urdf", robot(&"<link name=\"l\">".repeat(1_000_000)), "nested more than 64 deep"),
        (
            "entities.urdf",
            [
                b"<?xml version=\"1.0\"?><!DOCTYPE r [<!ENTITY a \"aaaaaaaaaa\">",
                entities.as_bytes(),
                b"]>",
                &robot("<link name=\"&i;\"/>")[..],
            ]
            .concat(),
            "entities.urdf",
        ),
        ("count.pts", b"4000000000\n1 2 3\n".into(), "4000000000"),
    ] {
        let path = scene.write(name, content);
        assert_refused(&path, &["inspect", path.to_str().unwrap()], part);
    }
}

/// A long chain of joints, as of a rope, is not refused: its time grows with its length.
#[test]
fn a_chain_of_joints_is_walked_once() {
    let scene = Scene::new();
    let count = 20_000;
    let links: String = (0..count).map(|i| format!("<link name=\"l{i}\"/>")).collect();
    let last = "<link name=\"end\"><visual><geometry><box size=\"0.1 0.1 0.1\"/></geometry></visual></link>";
    let joint = |i: usize, child: String| {
        format!(
            "<joint name=\"j{i}\" type=\"fixed\"><parent link=\"l{i}\"/><child link=\"{child}\"/><origin xyz=\"0 0 0.001\"/></joint>"
        )
    };
    let joints: String = (0..count)
        .map(|i| joint(i, if i + 1 < count { format!("l{}", i + 1) } else { "end".into() }))
        .collect();
    let path = scene.write("rope.urdf", format!("<robot name=\"r\">{links}{last}{joints}</robot>"));
    let begun = Instant::now();
    let run = run!("inspect", path, "--json");
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    assert!(begun.elapsed() < TIME, "{:?}", begun.elapsed());
}

/// A PNG whose header says another size, with its checksum.
fn resized(png: &[u8], size: u32) -> Vec<u8> {
    let size = size.to_be_bytes();
    // After the signature of 8 bytes and the length, the header is IHDR, width, height and 5 bytes more.
    let header = [&b"IHDR"[..], &size, &size, &png[24..29]].concat();
    let sum = header.iter().fold(u32::MAX, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg()))
    });
    [&png[..12], &header, &(!sum).to_be_bytes(), &png[33..]].concat()
}

#[test]
fn depth_images() {
    let scene = Scene::new();
    let camera = sample("mug_camera.txt");
    let small = images::depth_png([16, 16], &[500; 256]);
    // 60 MB that pack to 60 kB: an image as large as it says, which the camera does not fit.
    let long = images::png([3_000_000, 10], ColorType::Grayscale, BitDepth::Sixteen, &vec![0; 60_000_000]);
    for (name, content, part) in [
        ("huge.png", resized(&small, 100_000), "too short for 100000 x 100000 pixels"),
        ("most.png", resized(&small, 0x7fff_ffff), "limits"),
        ("long.png", long, ""),
    ] {
        let path = scene.write(name, content);
        // The image that can be read does not fit to the camera, whose name is then in the message.
        let named = if part.is_empty() { camera.clone() } else { path.clone() };
        let out = scene.path("out.ply");
        let [depth, camera, out] = [&path, &camera, &out].map(|path| path.to_str().unwrap());
        assert_refused(&named, &["scan", "--depth", depth, "--camera", camera, "--output", out], part);
    }
}

#[test]
fn texts_that_are_nested_deep() {
    let scene = Scene::new();
    let (mug, hook, start) = (sample("mug.obj"), sample("hook.ply"), sample("mug_start.json"));
    let [mug, hook, start] = [&mug, &hook, &start].map(|path| path.to_str().unwrap());
    let files = ["--object", mug, "--supporter", hook];
    let page = scene.path("page.html");
    for (name, content) in [
        ("lists.json", "[".repeat(2_000_000)),
        ("maps.json", "{\"poses\":".repeat(1_000_000)),
        ("poses.json", format!("{{\"poses\":{}", "[".repeat(2_000_000))),
    ] {
        let path = scene.write(name, content);
        let text = path.to_str().unwrap();
        assert_refused(&path, &[&["plan"], &files[..], &["--pose", text]].concat(), "recursion limit");
        let view = [&["view"], &files[..], &[text, "--view", page.to_str().unwrap()]].concat();
        assert_refused(&path, &view, "recursion limit");
    }
    let camera = scene.write("camera.json", "{\"intrinsic_matrix\":".repeat(1_000_000));
    let depth = sample("mug_depth.png");
    let scan =
        ["scan", "--depth", depth.to_str().unwrap(), "--camera", camera.to_str().unwrap(), "--output", "-"];
    assert_refused(&camera, &scan, "recursion limit");
    for (name, content) in [
        ("lists.toml", format!("a = {}", "[".repeat(500_000))),
        ("tables.toml", format!("a = {}", "{a=".repeat(500_000))),
        ("keys.toml", format!("a{} = 1", ".a".repeat(500_000))),
    ] {
        let path = scene.write(name, content);
        let text = path.to_str().unwrap();
        assert_refused(&path, &[&["predict"], &files[..], &["--params", text]].concat(), "");
        assert_refused(&path, &[&["plan"], &files[..], &["--pose", start, "--gripper", text]].concat(), "");
    }
}
