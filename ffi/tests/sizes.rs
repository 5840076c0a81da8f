//! Compares the macros HANGPOSE_*_BYTES of the header with the size queries.

use hangpose_ffi::*;

const NONE: hangpose_limits = hangpose_limits {
    struct_size: size_of::<hangpose_limits>() as u32,
    vertices: 0,
    triangles: 0,
    samples: 0,
    voxels: 0,
    points: 0,
    poses: 0,
    scene_points: 0,
    nodes: 0,
    waypoints: 0,
};

/// The value of a constant of the header.
fn constant(name: &str) -> usize {
    let header = include_str!("../../include/hangpose.h");
    let line =
        header.lines().find_map(|line| line.strip_prefix("#define ")?.strip_prefix(name)?.strip_prefix(' '));
    line.unwrap_or_else(|| panic!("no {name} in the header")).parse().unwrap()
}

#[test]
fn the_macros_never_give_less_than_the_queries() {
    let sizes = [0, 1, 2, 3, 100, 1000, 12_345, 100_000, 2_000_000];
    let [at_least, triangle, sample, voxel] = ["AT_LEAST", "EACH_TRIANGLE", "EACH_SAMPLE", "EACH_VOXEL"]
        .map(|name| constant(&format!("HANGPOSE_OBJECT_BYTES_{name}")));
    let [work_vertex, work_triangle, work_voxel] = ["VERTEX", "TRIANGLE", "VOXEL"]
        .map(|name| constant(&format!("HANGPOSE_OBJECT_BYTES_WORK_EACH_{name}")));
    let given = |limits: &hangpose_limits| {
        let [v, t, s, x] =
            [limits.vertices, limits.triangles, limits.samples, limits.voxels].map(|n| n as usize);
        let work = work_vertex * v + work_triangle * t + work_voxel * x;
        at_least + triangle * t + voxel * x + work.max(sample * s)
    };
    // SAFETY: the pointer leads to valid limits.
    let needed = |limits: &hangpose_limits| unsafe { hangpose_object_bytes(limits) };
    for vertices in sizes {
        for triangles in sizes {
            for samples in sizes {
                for voxels in sizes {
                    let limits = hangpose_limits { vertices, triangles, samples, voxels, ..NONE };
                    let (given, needed) = (given(&limits), needed(&limits));
                    assert!(
                        given >= needed,
                        "{vertices} vertices, {triangles} triangles, {samples} samples, {voxels} voxels: {given} < {needed}"
                    );
                }
            }
        }
    }
    // The macro gives less than 1.5 times the query, for a mug and the default params.
    let params = hangpose::Params::default();
    let (samples, voxels) = (params.samples as u32, params.voxels as u32);
    let mug = hangpose_limits { vertices: 3556, triangles: 7040, samples, voxels, ..NONE };
    assert!(given(&mug) < needed(&mug) + needed(&mug) / 2, "{} bytes for {}", given(&mug), needed(&mug));

    let [few, each_of_few, many, each_of_many] = ["FEW", "FEW_EACH_POINT", "MANY", "MANY_EACH_POINT"]
        .map(|name| constant(&format!("HANGPOSE_SUPPORTER_BYTES_{name}")));
    for points in sizes {
        let given = (few + each_of_few * points as usize).max(many + each_of_many * points as usize);
        // SAFETY: the pointer leads to valid limits.
        let needed = unsafe { hangpose_supporter_bytes(&hangpose_limits { points, ..NONE }) };
        assert!(
            (needed..needed + 4096 + needed / 20).contains(&given),
            "{points} points: {given} for {needed}"
        );
    }

    let [at_least, point, pose] = ["AT_LEAST", "EACH_POINT", "EACH_POSE"]
        .map(|name| constant(&format!("HANGPOSE_PREDICT_BYTES_{name}")));
    for points in sizes {
        for poses in sizes {
            let given = at_least + point * points as usize + pose * poses as usize;
            // SAFETY: the pointer leads to valid limits.
            let needed = unsafe { hangpose_predict_bytes(&hangpose_limits { points, poses, ..NONE }) };
            assert!(
                // Bytes for each point are rounded up to a whole number.
                (needed..needed + 4096 + needed / 20).contains(&given),
                "{points} points, {poses} poses: {given} for {needed}"
            );
        }
    }
}

#[test]
fn the_macros_of_planning_never_give_less_than_the_queries() {
    let sizes = [0, 1, 100, 12_345, 100_000, 1_000_000];
    let [at_least, point, scene_point, node, waypoint] =
        ["AT_LEAST", "EACH_POINT", "EACH_SCENE_POINT", "EACH_NODE", "EACH_WAYPOINT"]
            .map(|name| constant(&format!("HANGPOSE_PLAN_BYTES_{name}")));
    let [more, each_point, each_pose, each_scene_point, each_node, each_waypoint] =
        ["AT_LEAST", "EACH_POINT", "EACH_POSE", "EACH_SCENE_POINT", "EACH_NODE", "EACH_WAYPOINT"]
            .map(|name| constant(&format!("HANGPOSE_REACHABLE_BYTES_{name}")));
    for points in sizes {
        for scene_points in sizes {
            for nodes in sizes {
                for waypoints in sizes {
                    let poses = waypoints / 10;
                    let limits = hangpose_limits { points, scene_points, nodes, waypoints, poses, ..NONE };
                    let [p, s, n, w, k] =
                        [points, scene_points, nodes, waypoints, poses].map(|count| count as usize);
                    let given = at_least + point * p + scene_point * s + node * n + waypoint * w;
                    let reachable = more
                        + each_point * p
                        + each_scene_point * s
                        + each_node * n
                        + each_waypoint * w
                        + each_pose * k;
                    // SAFETY: the pointer leads to valid limits.
                    let [needed, needed_reachable] =
                        unsafe { [hangpose_plan_bytes(&limits), hangpose_reachable_bytes(&limits)] };
                    let what = format!("{p} points, {s} scene points, {n} nodes, {w} waypoints");
                    assert!(given >= needed, "{what}: {given} < {needed}");
                    assert!(reachable >= needed_reachable, "{what}: {reachable} < {needed_reachable}");
                }
            }
        }
    }
}

#[test]
fn the_macros_of_blocks_never_give_less_than_the_queries() {
    let queries: [(_, extern "C" fn(u32) -> usize); 3] = [
        ("VOLUME", hangpose_volume_bytes),
        ("COMPLETE", hangpose_complete_bytes),
        ("SURFACE", hangpose_surface_bytes),
    ];
    for (name, query) in queries {
        let [at_least, block] =
            ["AT_LEAST", "EACH_BLOCK"].map(|term| constant(&format!("HANGPOSE_{name}_BYTES_{term}")));
        for blocks in [1, 2, 3, 100, 127, 128, 129, 1000, 12_345, 65_536, 65_537, 2_000_000, 8_388_607] {
            let (given, needed) = (at_least + block * blocks as usize, query(blocks));
            assert!(
                (needed..needed + 4096 + needed / 20).contains(&given),
                "{name}, {blocks} blocks: {given} for {needed}"
            );
        }
    }
}

#[test]
fn limits_beyond_all_memory_do_not_wrap() {
    let most = u32::MAX;
    for query in [hangpose_volume_bytes, hangpose_complete_bytes, hangpose_surface_bytes] {
        assert!(query(most) > most as usize);
    }
    let limits = hangpose_limits {
        vertices: most,
        triangles: most,
        samples: most,
        voxels: most,
        points: most,
        poses: most,
        scene_points: most,
        nodes: most,
        waypoints: most,
        ..NONE
    };
    // SAFETY: the pointer leads to valid limits.
    unsafe {
        assert!(hangpose_object_bytes(&limits) > most as usize);
        assert!(hangpose_supporter_bytes(&limits) > most as usize);
        assert!(hangpose_predict_bytes(&limits) > most as usize);
        assert!(hangpose_plan_bytes(&limits) > most as usize);
        assert!(hangpose_reachable_bytes(&limits) > most as usize);
        let unset = hangpose_limits { struct_size: 0, ..limits };
        assert_eq!(hangpose_object_bytes(&unset), 0);
        assert_eq!(hangpose_supporter_bytes(core::ptr::null()), 0);
    }
}
