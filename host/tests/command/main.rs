//! Runs of the command `hangpose` on shapes with known results.

mod bad_input;
mod batch;
mod bombs;
mod depth;
mod faults;
mod how_and_where;
mod inspect;
mod json;
mod notes;
mod output;
mod placement;
mod planning;
mod shapes;
mod shell;
mod urdf;
mod usage;
mod view;

#[path = "../images/mod.rs"]
mod images;

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// Result of a run: exit status, standard output, standard error.
struct Run {
    status: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Run {
    fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|e| panic!("{e}: {}\n{}", self.stdout, self.stderr))
    }
}

/// Runs the command. The arguments are strings or paths.
macro_rules! run {
    ($($argument:expr),* $(,)?) => {
        $crate::finish($crate::command().args([$(std::ffi::OsStr::new(AsRef::<std::ffi::OsStr>::as_ref(&$argument))),*]))
    };
}
use run;

/// Options that select the published method, which has sites and costs.
const PAPER: [&str; 2] = ["--profile", "paper"];

fn command() -> Command {
    Command::new(env!("CARGO_BIN_EXE_hangpose"))
}

fn finish(command: &mut Command) -> Run {
    let Output { status, stdout, stderr } = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Run { status: status.code(), stdout: text(stdout), stderr: text(stderr) }
}

/// Path of a sample file.
fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples").join(name)
}

/// A folder with a ring that carries a weight, a peg to hang it on, and a ball that cannot hang.
struct Scene {
    folder: TempDir,
    ring: PathBuf,
    peg: PathBuf,
    ball: PathBuf,
}

impl Scene {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: String| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            path
        };
        let ring = write("ring.obj", shapes::obj(&shapes::weighted_ring()));
        let peg = write("peg.xyz", shapes::xyz(&shapes::peg()));
        let ball = write("ball.obj", shapes::obj(&shapes::ball()));
        Self { folder, ring, peg, ball }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    /// Predicts the ring on the peg with further options and returns the JSON.
    fn predict(&self, options: &[&str]) -> Value {
        self.predict_with(&self.ring, &self.peg, options)
    }

    fn predict_with(&self, object: &Path, supporter: &Path, options: &[&str]) -> Value {
        let mut command = command();
        command.args(["predict", "--json", "-", "--object"]).arg(object);
        let run = finish(command.arg("--supporter").arg(supporter).args(options));
        assert_eq!(run.status, Some(0), "{}", run.stderr);
        run.json()
    }
}

/// The document without measured times.
fn timeless(mut document: Value) -> String {
    document["stats"].as_object_mut().unwrap().remove("seconds").unwrap();
    document.to_string()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let list: Vec<f64> = value.as_array().unwrap().iter().map(number).collect();
    list.try_into().unwrap_or_else(|list| panic!("{list:?} is not {N} numbers"))
}

/// Distance between two points.
fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// Transforms a point by a row-major pose.
fn transform(pose: &[f64; 16], p: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| (0..3).map(|j| pose[4 * i + j] * p[j]).sum::<f64>() + pose[4 * i + 3])
}
