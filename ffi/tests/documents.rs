//! Texts and versions that are written in two places must be the same in both.

use std::fs::read_to_string;
use std::path::Path;

fn read(path: &str) -> String {
    read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).unwrap()
}

#[test]
fn the_readme_shows_the_examples_as_they_are() {
    let readme = read("README.md");
    for (language, path) in [("c", "examples-c/01_static_memory.c"), ("cpp", "examples-c/02_mesh_file.cpp")] {
        let shown = format!("```{language}\n{}```\n", read(path));
        assert!(readme.contains(&shown), "README.md does not show {path} as it is");
    }
}

#[test]
fn ros_and_cargo_know_the_same_version() {
    let version = concat!("<version>", env!("CARGO_PKG_VERSION"), "</version>");
    assert!(read("package.xml").contains(version), "package.xml has another version than Cargo.toml");
}
