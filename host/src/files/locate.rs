//! Where a file is that is named as ROS names files: by a package, by a link of a URDF, or relative to another file.

use super::FileError;
use std::env;
use std::path::{Path, PathBuf};

/// Start of a path within a ROS package.
const PACKAGE: &str = "package://";
/// Start of a path on this computer.
const FILE: &str = "file://";

/// Whether a path does not depend on the folder that it is given in.
pub fn is_located(path: &Path) -> bool {
    let text = path.to_string_lossy();
    path.is_absolute() || text.starts_with(PACKAGE) || text.starts_with(FILE)
}

/// Splits `robot.urdf#link` in the file and the name of the link. A file whose name is all of it comes first.
pub(super) fn split_link(path: &Path) -> (PathBuf, Option<String>) {
    let text = path.to_string_lossy();
    match text.rsplit_once('#') {
        Some((file, link)) if file.to_ascii_lowercase().ends_with(".urdf") && !path.exists() => {
            (file.into(), Some(link.into()))
        }
        _ => (path.into(), None),
    }
}

/// The file that a path names. `beside` is the file that names it, if one does.
pub(super) fn locate(path: &Path, beside: Option<&Path>) -> Result<PathBuf, FileError> {
    let folder = beside.and_then(Path::parent);
    let text = path.to_string_lossy();
    if let Some(rest) = text.strip_prefix(PACKAGE) {
        let (package, inside) = rest.split_once('/').unwrap_or((rest, ""));
        let found = candidates(package, folder).into_iter().find(|folder| folder.is_dir());
        let missing = || FileError::NoPackage { path: path.into(), package: package.into() };
        return Ok(found.ok_or_else(missing)?.join(inside.trim_start_matches('/')));
    }
    match (text.strip_prefix(FILE), folder) {
        (Some(path), _) => Ok(path.into()),
        (None, Some(folder)) => Ok(folder.join(path)),
        (None, None) => Ok(path.into()),
    }
}

/// Folders that a package may be in, in the order in which they are searched.
fn candidates(package: &str, folder: Option<&Path>) -> Vec<PathBuf> {
    let listed = |variable: &str| {
        let list = env::var_os(variable).unwrap_or_default();
        env::split_paths(&list).filter(|path| !path.as_os_str().is_empty()).collect::<Vec<_>>()
    };
    let is_package = |folder: &Path| folder.file_name().is_some_and(|name| name == package);
    let mut all: Vec<PathBuf> =
        listed("AMENT_PREFIX_PATH").into_iter().map(|prefix| prefix.join("share").join(package)).collect();
    for root in listed("ROS_PACKAGE_PATH") {
        if is_package(&root) {
            all.push(root.clone());
        }
        all.push(root.join(package));
        // A repository with several packages.
        let mut inside: Vec<_> = root.read_dir().into_iter().flatten().flatten().collect();
        inside.sort_by_key(|entry| entry.file_name());
        all.extend(inside.into_iter().map(|entry| entry.path().join(package)));
    }
    // The package that the file is in, so that a checkout works without the environment of ROS.
    let folder = folder.map(|folder| folder.canonicalize().unwrap_or_else(|_| folder.into()));
    let above = folder.iter().flat_map(|folder| folder.ancestors());
    all.extend(above.filter(|folder| is_package(folder)).map(PathBuf::from));
    all
}
