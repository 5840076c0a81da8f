//! The constants behind HANGPOSE_OBJECT_BYTES and its like, held against the queries.

use hangpose_ffi::*;

fn limits(vertices: u32, triangles: u32, samples: u32, points: u32, poses: u32) -> hangpose_limits {
    let struct_size = size_of::<hangpose_limits>() as u32;
    hangpose_limits { struct_size, vertices, triangles, samples, points, poses }
}

fn object(vertices: u32, triangles: u32, samples: u32) -> usize {
    // SAFETY: the limits are there.
    unsafe { hangpose_object_bytes(&limits(vertices, triangles, samples, 0, 0)) }
}

fn supporter(points: u32) -> usize {
    // SAFETY: the limits are there.
    unsafe { hangpose_supporter_bytes(&limits(0, 0, 0, points, 0)) }
}

fn predict(poses: u32) -> usize {
    // SAFETY: the limits are there.
    unsafe { hangpose_predict_bytes(&limits(0, 0, 0, 0, poses)) }
}

/// What one more of many takes, rounded up.
fn slope(bytes: impl Fn(u32) -> usize) -> usize {
    const MANY: u32 = 10_000_000;
    (bytes(2 * MANY) - bytes(MANY)).div_ceil(MANY as usize)
}

#[test]
fn the_macros_never_give_less_than_the_queries() {
    // No query gives more for all of its limits together than for each alone, added up; rounding to whole arrays adds
    // less than a page.
    let each = [
        ("OBJECT_BYTES_EACH_VERTEX", HANGPOSE_OBJECT_BYTES_EACH_VERTEX, slope(|n| object(n, 0, 0))),
        ("OBJECT_BYTES_EACH_TRIANGLE", HANGPOSE_OBJECT_BYTES_EACH_TRIANGLE, slope(|n| object(0, n, 0))),
        ("OBJECT_BYTES_EACH_SAMPLE", HANGPOSE_OBJECT_BYTES_EACH_SAMPLE, slope(|n| object(0, 0, n))),
        (
            "OBJECT_BYTES_AT_LEAST",
            HANGPOSE_OBJECT_BYTES_AT_LEAST,
            object(0, 0, 0).next_multiple_of(1024) + 1024,
        ),
        ("SUPPORTER_BYTES_EACH_POINT", HANGPOSE_SUPPORTER_BYTES_EACH_POINT, slope(supporter)),
        (
            "SUPPORTER_BYTES_AT_LEAST",
            HANGPOSE_SUPPORTER_BYTES_AT_LEAST,
            supporter(0).next_multiple_of(1024) + 1024,
        ),
        ("PREDICT_BYTES_EACH_POSE", HANGPOSE_PREDICT_BYTES_EACH_POSE, slope(predict)),
        ("PREDICT_BYTES_AT_LEAST", HANGPOSE_PREDICT_BYTES_AT_LEAST, predict(0).next_multiple_of(16)),
    ];
    let stale: Vec<_> = each.iter().filter(|(_, is, should_be)| is != should_be).collect();
    assert!(stale.is_empty(), "write into ffi/src/limits.rs, and then `make header`: {stale:#?}");

    let sizes = [0, 1, 2, 3, 100, 1000, 12_345, 100_000, 2_000_000];
    let object_macro = |vertices: u32, triangles: u32, samples: u32| {
        HANGPOSE_OBJECT_BYTES_AT_LEAST
            + HANGPOSE_OBJECT_BYTES_EACH_VERTEX * vertices as usize
            + HANGPOSE_OBJECT_BYTES_EACH_TRIANGLE * triangles as usize
            + HANGPOSE_OBJECT_BYTES_EACH_SAMPLE * samples as usize
    };
    for a in sizes {
        for b in sizes {
            for c in sizes {
                let (given, needed) = (object_macro(a, b, c), object(a, b, c));
                assert!(given >= needed, "{a} vertices, {b} triangles, {c} samples: {given} < {needed}");
            }
        }
        let given = HANGPOSE_SUPPORTER_BYTES_AT_LEAST + HANGPOSE_SUPPORTER_BYTES_EACH_POINT * a as usize;
        assert!(
            (supporter(a)..supporter(a) + 4096 + supporter(a) / 20).contains(&given),
            "{a} points: {given}"
        );
        let given = HANGPOSE_PREDICT_BYTES_AT_LEAST + HANGPOSE_PREDICT_BYTES_EACH_POSE * a as usize;
        assert!((predict(a)..predict(a) + 64).contains(&given), "{a} poses: {given}");
    }
    // How much more than needed, for a mug and the default samples.
    let (given, needed) = (object_macro(3556, 7040, 10_000), object(3556, 7040, 10_000));
    assert!(given < needed + needed / 3, "{given} bytes for {needed}");
}

#[test]
fn limits_beyond_all_memory_do_not_wrap() {
    let most = u32::MAX;
    // SAFETY: the limits are there.
    unsafe {
        let limits = limits(most, most, most, most, most);
        assert!(hangpose_object_bytes(&limits) > most as usize);
        assert!(hangpose_supporter_bytes(&limits) > most as usize);
        assert!(hangpose_predict_bytes(&limits) > most as usize);
        let unset = hangpose_limits { struct_size: 0, ..limits };
        assert_eq!(hangpose_object_bytes(&unset), 0);
        assert_eq!(hangpose_supporter_bytes(core::ptr::null()), 0);
    }
}
