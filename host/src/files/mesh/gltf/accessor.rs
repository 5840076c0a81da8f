//! Reads numbers from buffers and checks every offset.

use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};
use std::rc::Rc;

/// The positions of a primitive's vertices.
pub(super) fn positions(accessor: &Accessor<'_>, buffers: &[Rc<Vec<u8>>]) -> Result<Vec<[f32; 3]>, String> {
    if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, Dimensions::Vec3) {
        return Err("its POSITION is not three floats".into());
    }
    let float = |b: &[u8], at: usize| f32::from_le_bytes([b[at], b[at + 1], b[at + 2], b[at + 3]]);
    Ok(items(accessor, buffers, 12)?.map(|b| [0, 4, 8].map(|at| float(b, at))).collect())
}

/// The indices of a primitive.
pub(super) fn indices(accessor: &Accessor<'_>, buffers: &[Rc<Vec<u8>>]) -> Result<Vec<u32>, String> {
    if accessor.dimensions() != Dimensions::Scalar {
        return Err("its indices are not single numbers".into());
    }
    Ok(match accessor.data_type() {
        DataType::U8 => items(accessor, buffers, 1)?.map(|b| b[0].into()).collect(),
        DataType::U16 => {
            items(accessor, buffers, 2)?.map(|b| u16::from_le_bytes([b[0], b[1]]).into()).collect()
        }
        DataType::U32 => {
            items(accessor, buffers, 4)?.map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
        }
        _ => return Err("its indices are not whole numbers without sign".into()),
    })
}

/// Iterates over the bytes of the items, each of `size` bytes.
fn items<'a>(
    accessor: &Accessor<'_>,
    buffers: &'a [Rc<Vec<u8>>],
    size: usize,
) -> Result<impl Iterator<Item = &'a [u8]>, String> {
    let name = format!("accessor {}", accessor.index());
    if accessor.sparse().is_some() {
        return Err(format!("{name} is sparse"));
    }
    let view = accessor.view().ok_or_else(|| format!("{name} has no buffer view; it may be compressed"))?;
    let stride = view.stride().unwrap_or(size);
    if stride < size {
        return Err(format!("{name} has items of {size} bytes with a stride of only {stride} bytes"));
    }
    // End of the last item within the view.
    let end = match accessor.count() {
        0 => Some(0),
        count => (count - 1)
            .checked_mul(stride)
            .and_then(|at| at.checked_add(size)?.checked_add(accessor.offset())),
    };
    let bytes = buffers.get(view.buffer().index()).zip(view.offset().checked_add(view.length()));
    let bytes = bytes.and_then(|(buffer, view_end)| buffer.get(view.offset()..view_end));
    let bytes = bytes.zip(end).and_then(|(bytes, end)| bytes.get(accessor.offset().min(end)..end));
    let bytes = bytes.ok_or_else(|| format!("{name} reaches past the end of its buffer"))?;
    // The last item may be shorter than a stride.
    Ok(bytes.chunks(stride).map(move |item| &item[..size]))
}
