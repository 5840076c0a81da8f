//! PCD, the format of the Point Cloud Library: text, binary and compressed.

use std::io::Cursor;

use pcd_rs::{DataKind, DynReader, Field, PcdMeta};

use super::super::source::Source;
use super::super::{FileError, Place};
use super::RawCloud;

pub(super) fn read(source: &Source<'_>) -> Result<RawCloud, FileError> {
    let mut cursor = Cursor::new(source.bytes.as_slice());
    let meta = PcdMeta::from_reader(&mut cursor)
        .map_err(|e| source.malformed(Place::Part("the header".into()), e.to_string()))?;
    let body = cursor.position() as usize;
    check_lengths(source, &meta, body)?;

    let columns = Columns::find(source, &meta)?;
    let reader = DynReader::from_bytes(&source.bytes)
        .map_err(|e| source.malformed(Place::Byte(body), e.to_string()))?;
    let mut cloud = RawCloud { normals: columns.normal.map(|_| Vec::new()), ..RawCloud::default() };
    for (index, record) in reader.enumerate() {
        let record = record.map_err(|e| {
            source.malformed(Place::Part(format!("point {index} (counted from 0)")), e.to_string())
        })?;
        let three = |columns: [usize; 3]| columns.map(|column| value(&record.0[column]));
        let point = three(columns.point);
        // An organised cloud has NaN for every pixel without depth.
        if point.iter().any(|x| x.is_nan()) {
            cloud.missing += 1;
            continue;
        }
        cloud.points.push(point);
        if let (Some(normals), Some(columns)) = (&mut cloud.normals, columns.normal) {
            // A normal is NaN where the point had too few neighbours.
            let normal = three(columns);
            normals.push(if normal.iter().any(|x| x.is_nan()) { [0.0; 3] } else { normal.map(|x| x as f32) });
        }
    }
    let read = (cloud.points.len() + cloud.missing) as u64;
    if read < meta.num_points {
        let reason = format!("the header declares {} points, but there are {read}", meta.num_points);
        return Err(source.truncated(Place::Byte(source.bytes.len()), reason));
    }
    // The position of the sensor in the frame of the points. The origin is what programs write that do not know it.
    let view = &meta.viewpoint;
    let position = [view.tx, view.ty, view.tz];
    if position != [0.0; 3] {
        cloud.viewpoints.push(position);
    }
    Ok(cloud)
}

/// Rejects sizes that exceed the length of the file. pcd-rs 0.13 trusts the header: it would reserve the claimed size
/// of a compressed file, index past the end of the decompressed data, and overflow when it sums counts.
fn check_lengths(source: &Source<'_>, meta: &PcdMeta, body: usize) -> Result<(), FileError> {
    let held = (source.bytes.len() - body) as u64;
    let too_few = |wanted: &str| {
        let reason = format!(
            "the header declares {} points in {wanted} bytes, but {held} bytes follow it",
            meta.num_points
        );
        source.truncated(Place::Byte(body), reason)
    };
    let sum = |each: &dyn Fn(u64, u64) -> Option<u64>| {
        meta.field_defs
            .iter()
            .try_fold(0_u64, |sum, f| sum.checked_add(each(f.count, f.kind.byte_size() as u64)?))
    };
    let total = match meta.data {
        // At least a digit and a separator per number; no separator follows the last.
        DataKind::Ascii => sum(&|count, _| count.checked_mul(2)),
        DataKind::Binary | DataKind::BinaryCompressed => sum(&|count, size| count.checked_mul(size)),
    }
    .and_then(|point| point.checked_mul(meta.num_points));
    let Some(total) = total else {
        return Err(too_few("more than 2^64"));
    };
    match meta.data {
        DataKind::Ascii => {
            let lines = source.bytes[body..]
                .split(|b| *b == b'\n')
                .filter(|line| !line.trim_ascii().is_empty())
                .count() as u64;
            if lines < meta.num_points {
                let reason =
                    format!("the header declares {} points, but {lines} lines follow it", meta.num_points);
                return Err(source.truncated(Place::Whole, reason));
            }
            // COUNT may still declare more numbers than the lines can hold.
            if total > held + 1 { Err(too_few(&format!("at least {total}"))) } else { Ok(()) }
        }
        DataKind::Binary if total > held => Err(too_few(&total.to_string())),
        DataKind::BinaryCompressed => {
            let word = |at: usize| {
                let bytes = source.bytes.get(body + at..body + at + 4)?;
                Some(u64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])))
            };
            let (Some(packed), Some(unpacked)) = (word(0), word(4)) else {
                return Err(too_few("at least 8"));
            };
            if packed + 8 > held {
                return Err(too_few(&format!("{packed} compressed")));
            }
            // LZF compresses by a factor of at most 88: three bytes encode up to 264.
            if unpacked != total || unpacked > 88 * packed {
                let reason = format!(
                    "{packed} bytes that unpack to {unpacked} do not make {} points of {total} bytes in all",
                    meta.num_points
                );
                return Err(source.malformed(Place::Byte(body), reason));
            }
            Ok(())
        }
        _ => Ok(()),
    }
}

/// Columns of a record that hold the point and its normal.
struct Columns {
    point: [usize; 3],
    normal: Option<[usize; 3]>,
}

impl Columns {
    fn find(source: &Source<'_>, meta: &PcdMeta) -> Result<Self, FileError> {
        // Records of pcd-rs omit the padding fields, which are named `_`.
        let column = |name: &str| {
            meta.field_defs.iter().filter(|f| !f.is_padding()).position(|f| f.name == name && f.count == 1)
        };
        let columns = |[x, y, z]: [&str; 3]| Some([column(x)?, column(y)?, column(z)?]);
        let lacking = || source.malformed(Place::Part("the header".into()), "FIELDS lacks x, y or z");
        Ok(Self {
            point: columns(["x", "y", "z"]).ok_or_else(lacking)?,
            normal: columns(["normal_x", "normal_y", "normal_z"]),
        })
    }
}

/// The number in a field, whose count has been checked to be one.
fn value(field: &Field) -> f64 {
    match field {
        Field::I8(v) => v.first().map(|x| f64::from(*x)),
        Field::I16(v) => v.first().map(|x| f64::from(*x)),
        Field::I32(v) => v.first().map(|x| f64::from(*x)),
        Field::I64(v) => v.first().map(|x| *x as f64),
        Field::U8(v) => v.first().map(|x| f64::from(*x)),
        Field::U16(v) => v.first().map(|x| f64::from(*x)),
        Field::U32(v) => v.first().map(|x| f64::from(*x)),
        Field::U64(v) => v.first().map(|x| *x as f64),
        Field::F32(v) => v.first().map(|x| f64::from(*x)),
        Field::F64(v) => v.first().copied(),
    }
    .unwrap_or(f64::NAN)
}
