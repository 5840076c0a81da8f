//! Versions that are written in two places must be the same in both.

use std::fs::read_to_string;
use std::path::Path;

fn read(path: &str) -> String {
    read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).unwrap()
}

#[test]
fn ros_and_cargo_know_the_same_version() {
    let version = concat!("<version>", env!("CARGO_PKG_VERSION"), "</version>");
    assert!(read("package.xml").contains(version), "package.xml has another version than Cargo.toml");
}
