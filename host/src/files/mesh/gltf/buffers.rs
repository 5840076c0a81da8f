//! The buffers of a glTF file.

use std::collections::HashMap;
use std::fs;
use std::path::PathBuf;
use std::rc::Rc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf::Document;
use gltf::buffer::Source as Location;
use percent_encoding::percent_decode_str;

use super::super::super::source::Source;
use super::super::super::{FileError, Place};

/// Files that were read. Several buffers can name one file, which must not take its memory as often.
type Files = HashMap<PathBuf, Rc<Vec<u8>>>;

/// Reads every buffer: from the GLB itself, from a data URI, or from a file beside the glTF.
pub(super) fn read(
    source: &Source<'_>,
    document: &Document,
    blob: Option<Vec<u8>>,
) -> Result<Vec<Rc<Vec<u8>>>, FileError> {
    let (mut blob, mut files) = (blob, Files::new());
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        let place = || Place::Part(format!("buffer {}", buffer.index()));
        let bytes = match buffer.source() {
            Location::Bin => {
                blob.take().map(Rc::new).ok_or("it has no URI and the file has no binary part".to_string())
            }
            Location::Uri(uri) => from_uri(source, uri, &mut files),
        }
        .map_err(|reason| source.malformed(place(), reason))?;
        if bytes.len() < buffer.length() {
            let reason = format!("it should have {} bytes, but has {}", buffer.length(), bytes.len());
            return Err(source.truncated(place(), reason));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

fn from_uri(source: &Source<'_>, uri: &str, files: &mut Files) -> Result<Rc<Vec<u8>>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, payload) = data.split_once(',').ok_or("its data URI has no comma")?;
        if !kind.ends_with(";base64") {
            return Err("its data URI is not base64".into());
        }
        let bytes = STANDARD.decode(payload).map_err(|e| format!("its data URI is not base64: {e}"))?;
        return Ok(Rc::new(bytes));
    }
    if uri.contains("://") {
        return Err(format!("its URI {uri} is remote, and nothing is fetched from the network"));
    }
    let name =
        percent_decode_str(uri).decode_utf8().map_err(|_| format!("its file name {uri} is not UTF-8"))?;
    let path = source.file.parent().unwrap_or(&source.file).join(name.as_ref());
    if !path.is_file() {
        return Err(format!("its file {} is missing: keep it beside the glTF", path.display()));
    }
    let unreadable = |e| format!("its file {} cannot be read: {e}", path.display());
    let known = fs::canonicalize(&path).map_err(unreadable)?;
    if let Some(bytes) = files.get(&known) {
        return Ok(Rc::clone(bytes));
    }
    let bytes = Rc::new(fs::read(&path).map_err(unreadable)?);
    files.insert(known, Rc::clone(&bytes));
    Ok(bytes)
}
