//! What the command `hangpose` understands, one file a task.

mod counts;
mod input;
pub(crate) mod inspect;
mod json;
mod output;
mod params;
pub(crate) mod predict;
mod progress;
mod terminal;

pub(crate) use terminal::say;

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Where and how to hang an object on a supporter: no training, no GPU.
#[derive(Parser)]
#[command(version, after_help = EXAMPLE)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXAMPLE: &str = "Example: hangpose predict --object samples/mug.obj --supporter samples/hook.ply";

#[derive(Subcommand)]
pub(crate) enum Command {
    /// Find poses in which an object hangs on a supporter, best first.
    ///
    /// A pose maps the object's coordinates to the supporter's, both in metres with z up: after scale and up, if they
    /// are given.
    ///
    /// Exit status: 0 poses were found, 3 nothing hangs (the JSON says why), 1 bad input, 2 bad usage.
    Predict(PredictArguments),
    /// Show what the method sees in one file: size, centre of mass, and where it can be hung or hung on.
    ///
    /// Exit status: 0 the file was read, even if it has no site, 1 bad input, 2 bad usage.
    Inspect(InspectArguments),
}

#[derive(Args)]
pub(crate) struct PredictArguments {
    /// The object: a mesh (obj, stl, ply, glb, gltf).
    #[arg(long, value_name = "FILE")]
    object: PathBuf,
    /// The supporter: a point cloud (ply, pcd, xyz), or a mesh, which is sampled.
    #[arg(long, value_name = "FILE")]
    supporter: PathBuf,
    #[command(flatten)]
    method: MethodArguments,
    /// How many poses to give.
    #[arg(long, value_name = "K", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    top: u32,
    /// The object's centre of mass, in metres in the object's frame (after scale and up).
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    com: Option<[f32; 3]>,
    /// Where the result goes as JSON; - is standard output, instead of the table.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// 1: object and supporter are analysed one after the other; 2 or more: side by side.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    threads: u32,
    /// What the object's coordinates are multiplied by to be metres (0.001 for millimetres).
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = parse_scale)]
    object_scale: f32,
    /// The same for the supporter.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = parse_scale)]
    supporter_scale: f32,
    /// The axis of the object's file that becomes z: x, y, z, -x, -y or -z.
    #[arg(long, value_name = "AXIS", default_value = "z", value_parser = Axis::parse, allow_hyphen_values = true)]
    object_up: Axis,
    /// The axis of the supporter's file that points up and becomes z.
    #[arg(long, value_name = "AXIS", default_value = "z", value_parser = Axis::parse, allow_hyphen_values = true)]
    supporter_up: Axis,
    #[command(flatten)]
    cloud: CloudArguments,
}

#[derive(Args)]
pub(crate) struct InspectArguments {
    /// A mesh or a point cloud.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// What to take it for; by default a mesh is an object and a cloud a supporter.
    #[arg(long = "as", value_name = "ROLE")]
    role: Option<Role>,
    #[command(flatten)]
    method: MethodArguments,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
    /// What the coordinates are multiplied by to be metres.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = parse_scale)]
    scale: f32,
    /// The axis that points up and becomes z: x, y, z, -x, -y or -z.
    #[arg(long, value_name = "AXIS", default_value = "z", value_parser = Axis::parse, allow_hyphen_values = true)]
    up: Axis,
    #[command(flatten)]
    cloud: CloudArguments,
}

/// The constants of the method.
#[derive(Args)]
struct MethodArguments {
    /// The method as published, or ours.
    #[arg(long, value_enum, default_value_t = Profile::Default)]
    profile: Profile,
    /// Constants that differ from the profile's, as TOML: `radius_ratio = 0.9`.
    #[arg(long, value_name = "FILE")]
    params: Option<PathBuf>,
    /// Seed of the samples; without it the params file's or 0.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
}

/// How a supporter becomes a cloud with normals.
#[derive(Args)]
struct CloudArguments {
    /// How many points a supporter that is a mesh is sampled to.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(100..=500_000))]
    supporter_points: u32,
    /// Where the camera stood that saw a cloud without normals, in metres in the supporter's frame (after scale and
    /// up).
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    viewpoint: Option<[f32; 3]>,
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

/// The axis of a file that becomes z.
#[derive(Clone, Copy)]
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

    /// Turns coordinates by the least angle that makes this axis z.
    fn turn(self, [x, y, z]: [f32; 3]) -> [f32; 3] {
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

fn parse_point(text: &str) -> Result<[f32; 3], String> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.map(<[f32; 3]>::try_from) {
        Ok(Ok(point)) if point.iter().all(|x| x.is_finite()) => Ok(point),
        _ => Err("use three numbers with commas between them, as in 0.01,0,-0.2".into()),
    }
}

fn parse_scale(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(scale) if scale.is_finite() && scale > 0.0 => Ok(scale),
        _ => Err("use a number above zero, as in 0.001".into()),
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
        assert_eq!(parse_point("0.01, -2,3e-1"), Ok([0.01, -2.0, 0.3]));
        assert!(["1,2", "1,2,3,4", "a,b,c", "1,2,nan", ""].iter().all(|text| parse_point(text).is_err()));
        assert!(["0", "-1", "inf", "nan", "x"].iter().all(|text| parse_scale(text).is_err()));
    }
}
