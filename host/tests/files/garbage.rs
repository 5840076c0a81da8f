//! On any content a reader returns soon, without a panic, and without reserving memory that only a header claims.

use std::fs;
use std::time::{Duration, Instant};

use hangpose::files::{SupporterFile, read_cloud, read_mesh, read_supporter};

use crate::random::Random;
use crate::samples::*;

fn samples() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("a.obj", obj_cube().into_bytes()),
        ("a.stl", stl_text_cube().into_bytes()),
        ("a.stl", stl_binary_cube("solid")),
        ("a.ply", ply_text_cube().into_bytes()),
        ("a.ply", ply_binary_cube(false)),
        ("a.ply", ply_binary_cube(true)),
        ("a.ply", PLY_CLOUD.into()),
        ("a.glb", glb_cube(r#"{"mesh":0}"#)),
        ("a.gltf", GLTF_TRIANGLE.into()),
        ("a.pcd", pcd_text().into_bytes()),
        ("a.pcd", pcd_binary()),
        ("a.pcd", pcd_compressed()),
        ("a.xyz", XYZ.into()),
        ("a.urdf", URDF.into()),
    ]
}

/// Writes `content` to the file, reads it with every reader, and checks the guarantees of the result.
fn read(file: &File, content: &[u8]) {
    fs::write(&file.path, content).unwrap();
    let finite = |points: &[[f32; 3]]| points.as_flattened().iter().all(|x| x.is_finite());
    let _ = read_mesh(&file.path);
    let _ = read_cloud(&file.path);
    match read_supporter(&file.path) {
        Ok(SupporterFile::Mesh(mesh)) => {
            assert!(finite(&mesh.vertices) && !mesh.triangles.is_empty());
            let (count, mut used) = (mesh.vertices.len(), vec![false; mesh.vertices.len()]);
            for t in &mesh.triangles {
                assert!(
                    t.iter().all(|i| (*i as usize) < count) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]
                );
                t.iter().for_each(|i| used[*i as usize] = true);
            }
            assert!(used.iter().all(|used| *used));
        }
        Ok(SupporterFile::Cloud(cloud)) => {
            assert!(finite(&cloud.points) && !cloud.points.is_empty());
            assert!(
                cloud.normals.is_none_or(|normals| finite(&normals) && normals.len() == cloud.points.len())
            );
        }
        Err(error) => assert!(error.to_string().starts_with(&file.path.display().to_string())),
    }
}

/// Asserts a bound on the peak virtual memory of the process, where the system reports it.
fn assert_modest_memory() {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmPeak:")?.trim().strip_suffix(" kB")?.parse().ok());
    assert!(peak.unwrap_or(0_u64) < 2_000_000, "{peak:?} kB");
}

#[test]
fn cut_anywhere() {
    for (name, content) in samples() {
        let file = file(name, "");
        for length in (0..content.len()).step_by(content.len().div_ceil(700)) {
            read(&file, &content[..length]);
        }
    }
    assert_modest_memory();
}

#[test]
fn bytes_flipped() {
    let mut random = Random(1);
    for (name, content) in samples() {
        let file = file(name, "");
        for _ in 0..700 {
            let mut content = content.clone();
            for _ in 0..=random.next() % 4 {
                let at = random.next() as usize % content.len();
                // Half of them become a digit or a sign, which has more effect on text.
                content[at] = match random.next() {
                    r if r % 2 == 0 => (r >> 8) as u8,
                    r => b"0123456789-. "[(r >> 8) as usize % 13],
                };
            }
            read(&file, &content);
        }
    }
    assert_modest_memory();
}

#[test]
fn the_format_is_another() {
    let all = samples();
    for (name, _) in &all {
        let file = file(name, "");
        for (_, content) in &all {
            read(&file, content);
        }
        let mut random = Random(7);
        read(&file, &(0..4096).map(|_| random.next() as u8).collect::<Vec<_>>());
        read(&file, &[0; 4096]);
    }
}

#[test]
fn headers_that_lie() {
    let start = Instant::now();
    let ply = |body: &str| format!("ply\nformat {body}\nend_header\n\0\0\0\0\u{7f}\u{7f}\u{7f}\u{7f}");
    let xyz = "property float x\nproperty float y\nproperty float z";
    let mut stl = stl_binary_cube("");
    stl[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let pcd = |content: String| {
        let mut bytes = content.into_bytes();
        bytes.extend([0xff, 0xff, 0, 0, 0xff, 0xff, 0xff, 0xff, 0, 0]);
        bytes
    };
    let huge = |data: &str, points: &str| {
        pcd_header("x y z", 4, data).replace("POINTS 4", &format!("POINTS {points}"))
    };
    let mut unpacked = pcd_compressed();
    let sizes = unpacked.len() - 39 - 4;
    assert_eq!(unpacked[sizes..sizes + 4], 48_u32.to_le_bytes());
    unpacked[sizes..sizes + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut packed = pcd_compressed();
    packed[sizes - 4..sizes].copy_from_slice(&u32::MAX.to_le_bytes());
    let gltf = |from: &str, to: &str| GLTF_TRIANGLE.replace(from, to).into_bytes();

    let lies: Vec<(&str, Vec<u8>)> = vec![
        ("a.stl", stl),
        ("a.ply", ply(&format!("ascii 1.0\nelement vertex 4000000000\n{xyz}")).into()),
        ("a.ply", ply(&format!("binary_little_endian 1.0\nelement vertex 4000000000\n{xyz}")).into()),
        ("a.ply", ply(&format!("binary_big_endian 1.0\nelement vertex 18446744073709551615\n{xyz}")).into()),
        ("a.ply", ply("binary_big_endian 1.0\nelement nothing 4000000000\nelement vertex 0").into()),
        (
            "a.ply",
            ply("ascii 1.0\nelement face 1\nproperty list uint int vertex_indices")
                .replace("\0\0\0\0", "4000000000 1 ")
                .into(),
        ),
        (
            "a.ply",
            ply("binary_little_endian 1.0\nelement face 1\nproperty list uint int vertex_indices")
                .replace('\0', "\u{7f}")
                .into(),
        ),
        ("a.pcd", pcd(huge("ascii", "4000000000"))),
        ("a.pcd", pcd(huge("binary", "4000000000"))),
        ("a.pcd", pcd(huge("binary_compressed", "4000000000"))),
        ("a.pcd", pcd(huge("binary", "18446744073709551615"))),
        (
            "a.pcd",
            pcd(huge("binary", "2").replace("COUNT 1 1 1", "COUNT 1 9223372036854775807 9223372036854775807")),
        ),
        (
            "a.pcd",
            pcd(huge("ascii", "2").replace("COUNT 1 1 1", "COUNT 1 9223372036854775807 9223372036854775807")),
        ),
        ("a.pcd", unpacked),
        ("a.pcd", packed),
        ("a.gltf", gltf("\"count\":3", "\"count\":4000000000")),
        ("a.gltf", gltf("\"count\":3", "\"count\":0")),
        ("a.gltf", gltf("\"byteLength\":44", "\"byteLength\":18446744073709551615")),
        ("a.gltf", gltf("\"byteOffset\":8", "\"byteOffset\":18446744073709551615")),
        ("a.gltf", gltf("\"byteLength\":36", "\"byteLength\":18446744073709551615")),
        ("a.gltf", gltf("\"bufferView\":1", "\"byteOffset\":18446744073709551615,\"bufferView\":1")),
        ("a.pts", b"4000000000\n1 2 3\n".into()),
    ];
    for (name, content) in lies {
        let file = file(name, &content);
        read(&file, &content);
        let error = read_supporter(&file.path).expect_err(&String::from_utf8_lossy(&content));
        assert!(error.to_string().len() < 400, "{error}");
    }
    assert_modest_memory();
    assert!(start.elapsed() < Duration::from_secs(5));
}
