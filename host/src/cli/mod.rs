//! The command line of `hangpose`, one file per subcommand.

pub(crate) mod batch;
mod counts;
mod examples;
mod gripper;
mod input;
pub(crate) mod inspect;
mod json;
mod motion;
mod output;
mod params;
mod path;
pub(crate) mod plan;
mod planned;
mod pose_file;
pub(crate) mod predict;
mod progress;
mod recording;
mod request;
pub(crate) mod scan;
mod scene;
pub(crate) mod shell;
mod shown;
mod source;
mod terminal;
mod toml_error;
pub(crate) mod view;

pub(crate) use terminal::say;

use batch::{Given, Shard};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use hangpose::geometry::Aabb;
use hangpose::hanging::MAX_HUNG;
use motion::MotionArguments;
use recording::{DepthArguments, RecordingArguments};
use request::RequestArguments;
use scene::SceneArguments;
use shown::ShownArguments;
use std::path::PathBuf;

/// Predict how to hang an object on a supporter, without training data and without a GPU.
#[derive(Parser)]
#[command(version, after_help = examples::COMMAND)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const USAGE_OF_PLAN: &str = "hangpose plan --object <FILE> --supporter <FILE> --pose <FILE> [OPTIONS]
       hangpose plan --object-depth <PATTERN> --supporter-depth <PATTERN> --camera <FILE> --pose <FILE> [OPTIONS]";

const USAGE_OF_PREDICT: &str = "hangpose predict --object <FILE> --supporter <FILE> [OPTIONS]
       hangpose predict --object-depth <PATTERN> --supporter-depth <PATTERN> --camera <FILE> [OPTIONS]";

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Predict poses in which an object hangs on a supporter, best first.
    ///
    /// A pose maps object coordinates to supporter coordinates. Both frames are in metres with z up, after the options
    /// for scale and up axis are applied.
    ///
    /// Exit status: 0 poses were found, and with --plan one of them has a path; 3 nothing hangs, or no pose has a path (the
    /// JSON gives the reason); 1 bad input, 2 bad usage.
    #[command(override_usage = USAGE_OF_PREDICT, after_help = examples::PREDICT)]
    Predict(Box<PredictArguments>),
    /// Plan a path without collisions to a pose in which the object hangs, or away from it.
    ///
    /// The path leads from the start over the release pose to 0.3 mm before contact. Its poses map object coordinates to supporter
    /// coordinates. Both frames are in metres with z up, after the options for scale and up axis are applied.
    ///
    /// Exit status: 0 a path was found, 3 there is no path (the JSON gives the reason), 1 bad input, 2 bad usage.
    #[command(override_usage = USAGE_OF_PLAN, after_help = examples::PLAN)]
    Plan(Box<PlanArguments>),
    /// Show a prediction that was written before: as a page for a browser, as a picture, or both.
    ///
    /// The object and the supporter must be those of the prediction, with the same options for scale and up axis. Candidates
    /// that fell are shown only by predict --view.
    ///
    /// Exit status: 0 the page or picture was written, 1 bad input, 2 bad usage.
    #[command(after_help = examples::VIEW)]
    View(Box<ViewArguments>),
    /// Show the analysis of one file: size, centre of mass, and contact candidates or hanging sites.
    ///
    /// Exit status: 0 the file was read, even if it has no candidates, 1 bad input, 2 bad usage.
    #[command(after_help = examples::INSPECT)]
    Inspect(InspectArguments),
    /// Fuse depth images into the mesh or the point cloud of an object or of a scene.
    ///
    /// World coordinates are those of the poses, in metres. The mesh is open where no camera saw the surface.
    ///
    /// Exit status: 0 the mesh or cloud was written, 1 bad input, 2 bad usage.
    #[command(after_help = examples::SCAN)]
    Scan(ScanArguments),
    /// Predict many pairs of a table, on all processors or in shards on several computers.
    ///
    /// The table is a CSV file with a line for each pair. Its columns are object and supporter, paths relative to the table;
    /// id, which is the number of the pair if it is not given; and options of predict in snake_case, such as object_scale,
    /// supporter_up, com or allow. Several values of an option that may be repeated are separated by ;. A cell replaces what
    /// the command line says, unless it is empty. Each object and supporter is read and analysed once.
    ///
    /// The result has the pairs in the order of the table: a row for each pose, best first, or one row without a pose. Its
    /// columns are pair (the number from 1), id, object, supporter, rank, the release pose (x to qw) and the rest pose (rest_x to
    /// rest_qw), kind, probability and the other figures of predict --json, rejection and reason if nothing hangs, warning,
    /// and error. Lengths are metres, angles radians, quaternions have the scalar last. Cells without a value are null, or
    /// empty in CSV. The bytes of the result do not depend on --jobs, on shards, on time, or on how often a run was
    /// ended, so the table has no times.
    ///
    /// Rows that are done are kept in a journal beside the result, OUTPUT.partial, until all are. A run that was ended at any
    /// moment goes on with --resume and loses only the pairs it was working on.
    ///
    /// Exit status: 0 all pairs were handled, also if some have an error (their number is printed), 1 a bad table, file of
    /// constants or result, 2 bad usage.
    #[command(after_help = examples::BATCH)]
    Batch(Box<BatchArguments>),
    /// Join the results of the shards of a batch to the result of one run, byte by byte.
    ///
    /// Fails if a pair of the table has no row or is in two shards. The files may have different formats.
    ///
    /// Exit status: 0 the result was written, 1 a bad table, shard or result, 2 bad usage.
    #[command(after_help = examples::MERGE)]
    Merge(MergeArguments),
    /// Print a script that completes subcommands, options and their values in a shell.
    ///
    /// Exit status: 0 the script was printed, 1 it could not be, 2 bad usage.
    #[command(after_help = examples::COMPLETIONS)]
    Completions(CompletionsArguments),
    /// Write a man page of the command and of each subcommand.
    ///
    /// Exit status: 0 the pages were written, 1 the folder cannot be written, 2 bad usage.
    #[command(after_help = examples::MAN)]
    Man(ManArguments),
}

#[derive(Args)]
pub(crate) struct PredictArguments {
    #[command(flatten, next_help_heading = "Object and supporter")]
    files: FileArguments,
    #[command(flatten, next_help_heading = "Result")]
    result: ResultArguments,
    #[command(flatten, next_help_heading = "Points of the supporter")]
    cloud: CloudArguments,
    #[command(flatten, next_help_heading = "How and where it hangs")]
    request: RequestArguments,
    /// Plan a path without collisions to one pose after another, best first, until one has a path.
    #[arg(long, conflicts_with = "count", help_heading = "The path to it")]
    plan: bool,
    #[command(flatten, next_help_heading = "The path to it")]
    motion: MotionArguments,
    #[command(flatten, next_help_heading = "Method")]
    method: MethodArguments,
    #[command(flatten, next_help_heading = "Depth images in place of --object or --supporter")]
    recording: RecordingArguments,
}

#[derive(Args)]
pub(crate) struct PlanArguments {
    #[command(flatten, next_help_heading = "Object and supporter")]
    files: FileArguments,
    /// The pose in which the object hangs: JSON with "position" and "quaternion_xyzw" of the release pose in the supporter
    /// frame and, if it is known, "rest_pose"; or a result of `predict --json`.
    #[arg(long, value_name = "FILE", help_heading = "The pose")]
    pose: PathBuf,
    /// Rank of the pose, if the file has several.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..), help_heading = "The pose")]
    rank: u32,
    #[command(flatten, next_help_heading = "The path to it")]
    motion: MotionArguments,
    #[command(flatten)]
    scene: SceneArguments,
    /// File for the path as JSON; - prints the JSON to standard output instead of the text.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Points of the supporter")]
    cloud: CloudArguments,
    #[command(flatten, next_help_heading = "Method")]
    method: MethodArguments,
    #[command(flatten, next_help_heading = "Depth images in place of --object or --supporter")]
    recording: RecordingArguments,
}

#[derive(Args)]
#[command(group = clap::ArgGroup::new("shown").required(true).multiple(true).args(["view", "png"]))]
pub(crate) struct ViewArguments {
    #[command(flatten, next_help_heading = "Object and supporter")]
    files: FileArguments,
    /// The prediction: the JSON that `predict --json` wrote.
    #[arg(value_name = "PREDICTION")]
    prediction: PathBuf,
    #[command(flatten, next_help_heading = "Result")]
    shown: ShownArguments,
    #[command(flatten, next_help_heading = "Points of the supporter")]
    cloud: CloudArguments,
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten, next_help_heading = "Depth images in place of --object or --supporter")]
    recording: RecordingArguments,
}

/// The files of object and supporter.
#[derive(Args)]
struct FileArguments {
    /// The object: a mesh (obj, stl, ply, glb, gltf), or a urdf: all of its links, or one of them as in robot.urdf#link. The
    /// path may begin with package://.
    #[arg(long, value_name = "FILE", required_unless_present_any = ["object_depth", "depth"])]
    object: Option<PathBuf>,
    /// The supporter: a point cloud (ply, pcd, xyz), or a mesh or urdf, which is sampled.
    #[arg(long, value_name = "FILE", required_unless_present_any = ["supporter_depth", "depth"])]
    supporter: Option<PathBuf>,
    #[command(flatten)]
    frames: FrameArguments,
}

/// How the coordinates of object and supporter are meant.
#[derive(Args)]
struct FrameArguments {
    /// Centre of mass of the object, in metres in the object frame (after scale and up axis).
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_numbers::<3>, allow_hyphen_values = true)]
    com: Option<[f64; 3]>,
    /// Position of a camera from whose images the object's mesh was made, in metres in the object frame (after scale and up
    /// axis). Repeat it for several cameras. What none of them saw makes poses less probable. The default is what the file
    /// or the images say.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_numbers::<3>, allow_hyphen_values = true)]
    object_viewpoint: Vec<[f64; 3]>,
    /// Factor from the units of the object's file to metres (0.001 for millimetres).
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = parse_scale)]
    object_scale: f32,
    /// Factor from the units of the supporter's file to metres.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = parse_scale)]
    supporter_scale: f32,
    /// Axis of the object's file or images that becomes z: x, y, z, -x, -y or -z.
    #[arg(long, value_name = "AXIS", default_value = "z", value_parser = Axis::parse, allow_hyphen_values = true)]
    object_up: Axis,
    /// Axis of the supporter's file or images that points up and becomes z.
    #[arg(long, value_name = "AXIS", default_value = "z", value_parser = Axis::parse, allow_hyphen_values = true)]
    supporter_up: Axis,
}

/// What is computed and where it goes.
#[derive(Args)]
struct ResultArguments {
    /// Maximum number of poses.
    #[arg(long, value_name = "K", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    top: u32,
    /// Number of copies of the object that hang on the supporter at once. Each gets one pose, beside the others.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=MAX_HUNG as i64), conflicts_with = "top")]
    count: u32,
    /// File for the result as JSON; - prints the JSON to standard output instead of the table.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten)]
    shown: ShownArguments,
    /// 2 or more run what is independent on two threads: both analyses, and parts of each step. The poses are the same.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    threads: u32,
}

#[derive(Args)]
pub(crate) struct InspectArguments {
    /// A mesh or a point cloud.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Role of the file; by default a mesh is an object and a cloud a supporter.
    #[arg(long = "as", value_name = "ROLE")]
    role: Option<Role>,
    #[command(flatten)]
    method: MethodArguments,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
    /// Factor from the units of the file to metres.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = parse_scale)]
    scale: f32,
    /// Axis of the file that points up and becomes z: x, y, z, -x, -y or -z.
    #[arg(long, value_name = "AXIS", default_value = "z", value_parser = Axis::parse, allow_hyphen_values = true)]
    up: Axis,
    #[command(flatten)]
    cloud: CloudArguments,
}

#[derive(Args)]
pub(crate) struct ScanArguments {
    /// Depth images: PNG with one channel of 16 bits. A path, a pattern in quotes such as 'scan/*.png', or a text file with
    /// a time and a path on each line (TUM's depth.txt).
    #[arg(long, value_name = "PATTERN")]
    depth: String,
    /// Intrinsics: a 3 x 3 matrix as text, or JSON of Open3D (PinholeCameraIntrinsic, PinholeCameraParameters) or BOP
    /// (scene_camera.json).
    #[arg(long, value_name = "FILE")]
    camera: PathBuf,
    /// Poses of the cameras: files of one 4 x 4 matrix each, or one file (4 x 4 matrices, an Open3D .log, a TUM trajectory,
    /// a BOP scene_camera.json). Not needed for a single image or if the camera file has poses.
    #[arg(long, value_name = "PATTERN")]
    poses: Option<String>,
    /// Masks: PNG with one label a pixel, one mask for each image.
    #[arg(long, value_name = "PATTERN", requires = "label")]
    mask: Option<String>,
    /// Label of the object in the masks.
    #[arg(long, value_name = "N", requires = "mask")]
    label: Option<u8>,
    /// Box in world coordinates, metres, outside of which everything is ignored: least x, y, z and greatest x, y, z.
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = parse_box, allow_hyphen_values = true)]
    crop: Option<Aabb>,
    #[command(flatten)]
    all: DepthArguments,
    /// Guess what no image shows, so that the mesh is closed. The object must be held alone: pixels without a depth count as
    /// seen through.
    #[arg(long)]
    complete: bool,
    /// Write the points of the images with normals, a cloud for `predict --supporter`, instead of a mesh.
    #[arg(long, conflicts_with = "complete")]
    cloud: bool,
    /// The mesh or cloud as PLY; - for standard output.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Also write the positions of the cameras as a JSON list.
    #[arg(long, value_name = "FILE")]
    viewpoints: Option<PathBuf>,
}

#[derive(Args)]
pub(crate) struct BatchArguments {
    /// The table of pairs: CSV.
    #[arg(value_name = "PAIRS")]
    pairs: PathBuf,
    /// File for the result: .parquet, .csv or .jsonl.
    #[arg(short, long, value_name = "OUTPUT")]
    output: PathBuf,
    /// Number of pairs that are predicted at the same time [default: the number of processors].
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    jobs: Option<u32>,
    /// Predict the i-th of n parts of the pairs only: consecutive ones, so that each part reads few files.
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = Shard::parse)]
    shard: Shard,
    /// Go on with a run that was ended, if there is one. The pairs, the options and the version must be the same. A result
    /// that is there already is kept.
    #[arg(long)]
    resume: bool,
    /// Memory for objects and supporters that later pairs need again, MiB. If they take more, those that are needed last are
    /// dropped and read again.
    #[arg(long, value_name = "MIB", default_value_t = 1024)]
    memory: u32,
    #[command(flatten)]
    given: Given,
}

#[derive(Args)]
pub(crate) struct MergeArguments {
    /// The table of pairs of which the shards are parts.
    #[arg(value_name = "PAIRS")]
    pairs: PathBuf,
    /// The results of the shards.
    #[arg(value_name = "SHARD", required = true)]
    shards: Vec<PathBuf>,
    /// File for the result: .parquet, .csv or .jsonl.
    #[arg(short, long, value_name = "OUTPUT")]
    output: PathBuf,
}

#[derive(Args)]
pub(crate) struct CompletionsArguments {
    /// The shell.
    #[arg(value_name = "SHELL", value_enum)]
    shell: Shell,
}

#[derive(Args)]
pub(crate) struct ManArguments {
    /// Folder for the pages, which is created if it is missing.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// The constants of the method.
#[derive(Args)]
struct MethodArguments {
    /// Profile of constants: the published method, or the default, which also simulates the release of poses.
    #[arg(long, value_enum, default_value_t = Profile::Default)]
    profile: Profile,
    /// TOML file of constants that override the profile's, as in `radius_ratio = 0.9`. `predict --json` prints all of them
    /// under `params`.
    #[arg(long, value_name = "FILE")]
    params: Option<PathBuf>,
    /// Direction of gravity in the supporter frame (after the up axis), of any length, as 0,1,0 in the frame of a camera
    /// that looks ahead. The default is that of the params file, or -z.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_numbers::<3>, allow_hyphen_values = true)]
    gravity: Option<[f64; 3]>,
    /// Seed of the samples; the default is the seed of the params file, or 0.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
}

/// Options for the supporter's point cloud and normals.
#[derive(Args)]
struct CloudArguments {
    /// For supporters: number of points that a mesh is sampled to.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(100..=500_000))]
    supporter_points: u32,
    /// For supporters: camera position that orients normals that are missing or do not agree in sign, in metres in the
    /// supporter frame (after scale and up axis). Repeat it for several cameras. The default is what the file or the images say.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_numbers::<3>, allow_hyphen_values = true)]
    viewpoint: Vec<[f64; 3]>,
    /// For supporters: box that limits the places to hang on, by its lower and its upper corner in metres in the supporter
    /// frame (after scale and up axis). What is outside remains an obstacle.
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = parse_numbers::<6>, allow_hyphen_values = true)]
    region: Option<[f64; 6]>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Profile {
    Paper,
    Default,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Role {
    Object,
    Supporter,
}

/// Axis of a file that becomes z.
#[derive(Clone, Copy, Debug)]
enum Axis {
    X,
    Y,
    Z,
    MinusX,
    MinusY,
    MinusZ,
}

impl Axis {
    fn parse(text: &str) -> Result<Self, String> {
        Ok(match text.to_ascii_lowercase().as_str() {
            "x" | "+x" => Self::X,
            "y" | "+y" => Self::Y,
            "z" | "+z" => Self::Z,
            "-x" => Self::MinusX,
            "-y" => Self::MinusY,
            "-z" => Self::MinusZ,
            _ => return Err("use x, y, z, -x, -y or -z".into()),
        })
    }

    /// Rotates coordinates by the smallest angle that maps this axis to z.
    fn turn<T: std::ops::Neg<Output = T>>(self, [x, y, z]: [T; 3]) -> [T; 3] {
        match self {
            Self::X => [-z, y, x],
            Self::Y => [x, -z, y],
            Self::Z => [x, y, z],
            Self::MinusX => [z, y, -x],
            Self::MinusY => [x, z, -y],
            Self::MinusZ => [x, -y, -z],
        }
    }
}

fn parse_numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.map(<[f64; N]>::try_from) {
        Ok(Ok(numbers)) if numbers.iter().all(|x| x.is_finite()) => Ok(numbers),
        _ => Err(format!("use {N} comma-separated numbers, as in 0.01,0,-0.2")),
    }
}

fn parse_box(text: &str) -> Result<Aabb, String> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[a, b, c, d, e, f]) => Ok(Aabb { min: [a, b, c].into(), max: [d, e, f].into() }),
        _ => Err("use six comma-separated numbers, as in -0.1,-0.1,0,0.1,0.1,0.3".into()),
    }
}

fn parse_scale(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(scale) if scale.is_finite() && scale > 0.0 => Ok(scale),
        _ => Err("use a positive number, as in 0.001".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_are_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }

    #[test]
    fn turns_are_rotations_that_bring_the_axis_up() {
        let axes = [("x", [1.0, 0.0, 0.0]), ("+y", [0.0, 1.0, 0.0]), ("Z", [0.0, 0.0, 1.0])];
        for (name, axis) in axes {
            for (name, axis) in
                [(name.to_string(), axis), (format!("-{}", &name[name.len() - 1..]), axis.map(|x| -x))]
            {
                let up = Axis::parse(&name).unwrap();
                assert_eq!(up.turn(axis).map(|x| x + 0.0), [0.0, 0.0, 1.0], "{name}");
                let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| up.turn(e).into());
                assert_eq!(nalgebra::Matrix3::<f32>::from_columns(&columns).determinant(), 1.0, "{name}");
            }
        }
        assert!(Axis::parse("up").is_err());
    }

    #[test]
    fn points_and_scales_are_numbers() {
        assert_eq!(parse_numbers("0.01, -2,3e-1"), Ok([0.01, -2.0, 0.3]));
        assert!(
            ["1,2", "1,2,3,4", "a,b,c", "1,2,nan", ""].iter().all(|text| parse_numbers::<3>(text).is_err())
        );
        assert!(["0", "-1", "inf", "nan", "x"].iter().all(|text| parse_scale(text).is_err()));
    }
}
