//! What no input may do to hangpose: targets for libFuzzer, which `cargo test` runs over their seeds, over what was found
//! before, and over seeded mutations.
//!
//! A target takes any bytes and panics where the library breaks a promise: it panics itself, writes beyond its memory, takes
//! more than its input allows, answers differently when it is asked again, or answers with numbers that are none.
//! `CONTRIBUTING.md` says what to do with what they find.

pub mod calls;
mod draw;
pub mod files;
pub mod images;
pub mod memory;
pub mod models;
pub mod mutate;
mod oracle;
pub mod seeds;
mod shapes;

// What the tests of the readers make their files with.
#[allow(dead_code)]
#[path = "../../host/tests/images/mod.rs"]
mod images_of_files;
#[allow(dead_code)]
#[path = "../../host/tests/files/samples.rs"]
mod samples;

// The readers of the command that are not part of the library.
#[allow(dead_code)]
#[path = "../../host/src/cli/gripper.rs"]
mod gripper;
#[allow(dead_code)]
#[path = "../../host/src/cli/pose_file.rs"]
mod pose_file;
#[path = "../../host/src/cli/toml_error.rs"]
mod toml_error;

/// A target: its name and what takes the bytes.
pub type Target = (&'static str, fn(&[u8]));

/// All targets.
pub const TARGETS: [Target; 4] =
    [("files", files::run), ("models", models::run), ("images", images::run), ("calls", calls::run)];
