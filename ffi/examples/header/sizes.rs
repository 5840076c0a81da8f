//! The constants of the macros `HANGPOSE_*_BYTES`, computed from the size queries.

use hangpose_ffi::{
    hangpose_complete_bytes, hangpose_limits, hangpose_object_bytes, hangpose_plan_bytes,
    hangpose_predict_bytes, hangpose_reachable_bytes, hangpose_supporter_bytes, hangpose_surface_bytes,
    hangpose_volume_bytes,
};

type Query = unsafe extern "C" fn(*const hangpose_limits) -> usize;
/// The name of a counted element and the field with its count.
type Field = (&'static str, fn(&mut hangpose_limits) -> &mut u32);

/// Queries that grow by as much for each element, however many there are.
const QUERIES: [(&str, Query, &[Field]); 3] = [
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

/// So many elements that constant parts do not count.
const MANY: u32 = 10_000_000;

/// The constants as `#define` lines of the header.
pub(super) fn defines() -> String {
    let mut text = object() + &supporter();
    for (name, query, fields) in QUERIES {
        // A query for all limits together is never greater than the sum of its queries for each limit alone.
        text += &define(&format!("{name}_BYTES_AT_LEAST"), rounded(bytes(query, &NONE)));
        for (each, field) in fields {
            text += &define(&format!("{name}_BYTES_EACH_{each}"), slope(query, &NONE, *field));
        }
    }
    for (name, query) in BLOCK_QUERIES {
        // The hash table of a volume doubles at this number.
        const MANY: u32 = (1 << 20) + 1;
        let at_least = rounded(query(0));
        text += &define(&format!("{name}_BYTES_AT_LEAST"), at_least);
        text +=
            &define(&format!("{name}_BYTES_EACH_BLOCK"), (query(MANY) - at_least).div_ceil(MANY as usize));
    }
    text
}

/// Of an object: what it keeps, and the larger of the working memory for its samples and that before them.
fn object() -> String {
    let query = hangpose_object_bytes;
    // With so many samples, only what is kept grows with the rest.
    let sampled = hangpose_limits { samples: u32::MAX, ..NONE };
    let mut text = define("OBJECT_BYTES_AT_LEAST", rounded(bytes(query, &NONE)));
    text += &define("OBJECT_BYTES_EACH_SAMPLE", slope(query, &NONE, |limits| &mut limits.samples));
    let fields: [Field; 3] = [
        ("VERTEX", |limits| &mut limits.vertices),
        ("TRIANGLE", |limits| &mut limits.triangles),
        ("VOXEL", |limits| &mut limits.voxels),
    ];
    for (each, field) in fields {
        let kept = slope(query, &sampled, field);
        let work = slope(query, &NONE, field) - kept;
        if kept > 0 {
            text += &define(&format!("OBJECT_BYTES_EACH_{each}"), kept);
        }
        text += &define(&format!("OBJECT_BYTES_WORK_EACH_{each}"), work);
    }
    text
}

/// Of a supporter: with few points another step needs the most working memory than with many.
fn supporter() -> String {
    const FEW: u32 = 100;
    let of = |points| bytes(hangpose_supporter_bytes, &hangpose_limits { points, ..NONE });
    let none = of(0);
    [
        ("FEW", rounded(none)),
        ("FEW_EACH_POINT", (of(FEW) - none).div_ceil(FEW as usize)),
        ("MANY", rounded(2 * of(MANY) - of(2 * MANY))),
        ("MANY_EACH_POINT", slope(hangpose_supporter_bytes, &NONE, |limits| &mut limits.points)),
    ]
    .map(|(term, value)| define(&format!("SUPPORTER_BYTES_{term}"), value))
    .concat()
}

fn define(name: &str, value: usize) -> String {
    format!("#define HANGPOSE_{name} {value}\n")
}

/// Rounding to whole arrays adds less than 1024 bytes.
fn rounded(bytes: usize) -> usize {
    bytes.next_multiple_of(1024) + 1024
}

fn bytes(query: Query, limits: &hangpose_limits) -> usize {
    // SAFETY: the pointer leads to valid limits.
    unsafe { query(limits) }
}

/// Bytes for each element of a field, beside those of `limits`, rounded up.
fn slope(query: Query, limits: &hangpose_limits, field: fn(&mut hangpose_limits) -> &mut u32) -> usize {
    let with = |count| {
        let mut limits = *limits;
        *field(&mut limits) = count;
        bytes(query, &limits)
    };
    (with(2 * MANY) - with(MANY)).div_ceil(MANY as usize)
}
