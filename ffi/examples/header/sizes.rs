//! The constants of the macros `HANGPOSE_*_BYTES`, computed from the size queries.

use hangpose_ffi::{
    hangpose_complete_bytes, hangpose_limits, hangpose_object_bytes, hangpose_plan_bytes,
    hangpose_predict_bytes, hangpose_reachable_bytes, hangpose_supporter_bytes, hangpose_surface_bytes,
    hangpose_volume_bytes,
};

type Query = unsafe extern "C" fn(*const hangpose_limits) -> usize;
/// The name of a counted element and the field with its count.
type Field = (&'static str, fn(&mut hangpose_limits) -> &mut u32);

const QUERIES: [(&str, Query, &[Field]); 5] = [
    (
        "OBJECT",
        hangpose_object_bytes,
        &[
            ("VERTEX", |limits| &mut limits.vertices),
            ("TRIANGLE", |limits| &mut limits.triangles),
            ("SAMPLE", |limits| &mut limits.samples),
            ("VOXEL", |limits| &mut limits.voxels),
        ],
    ),
    ("SUPPORTER", hangpose_supporter_bytes, &[("POINT", |limits| &mut limits.points)]),
    (
        "PREDICT",
        hangpose_predict_bytes,
        &[("POINT", |limits| &mut limits.points), ("POSE", |limits| &mut limits.poses)],
    ),
    (
        "PLAN",
        hangpose_plan_bytes,
        &[
            ("POINT", |limits| &mut limits.points),
            ("SCENE_POINT", |limits| &mut limits.scene_points),
            ("NODE", |limits| &mut limits.nodes),
            ("WAYPOINT", |limits| &mut limits.waypoints),
        ],
    ),
    (
        "REACHABLE",
        hangpose_reachable_bytes,
        &[
            ("POINT", |limits| &mut limits.points),
            ("POSE", |limits| &mut limits.poses),
            ("SCENE_POINT", |limits| &mut limits.scene_points),
            ("NODE", |limits| &mut limits.nodes),
            ("WAYPOINT", |limits| &mut limits.waypoints),
        ],
    ),
];

/// Queries that depend on a number of blocks alone.
const BLOCK_QUERIES: [(&str, extern "C" fn(u32) -> usize); 3] = [
    ("VOLUME", hangpose_volume_bytes),
    ("COMPLETE", hangpose_complete_bytes),
    ("SURFACE", hangpose_surface_bytes),
];

/// The constants as `#define` lines of the header.
pub(super) fn defines() -> String {
    let mut text = String::new();
    for (name, query, fields) in QUERIES {
        let none = hangpose_limits {
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
        // SAFETY: the pointer leads to valid limits.
        let bytes = |limits: hangpose_limits| unsafe { query(&limits) };
        // A query for all limits together is never greater than the sum of its queries for each limit alone. Rounding
        // to whole arrays adds less than 1024 bytes.
        let at_least = bytes(none).next_multiple_of(1024) + 1024;
        text += &format!("#define HANGPOSE_{name}_BYTES_AT_LEAST {at_least}\n");
        for (each, field) in fields {
            const MANY: u32 = 10_000_000;
            let with = |count| {
                let mut limits = none;
                *field(&mut limits) = count;
                bytes(limits)
            };
            let slope = (with(2 * MANY) - with(MANY)).div_ceil(MANY as usize);
            text += &format!("#define HANGPOSE_{name}_BYTES_EACH_{each} {slope}\n");
        }
    }
    for (name, query) in BLOCK_QUERIES {
        // The hash table of a volume doubles at this number.
        const MANY: u32 = (1 << 20) + 1;
        let at_least = query(0).next_multiple_of(1024) + 1024;
        let slope = (query(MANY) - at_least).div_ceil(MANY as usize);
        text += &format!("#define HANGPOSE_{name}_BYTES_AT_LEAST {at_least}\n");
        text += &format!("#define HANGPOSE_{name}_BYTES_EACH_BLOCK {slope}\n");
    }
    text
}
