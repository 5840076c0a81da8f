//! The options that say how and where the object shall hang, and what it must not touch.

use super::scene::SceneArguments;
use super::{FrameArguments, parse_numbers};
use anyhow::{Context, Result, ensure};
use clap::{Args, ValueEnum};
use hangpose::hanging::{Approach, Distance, Region, Request, RequestError};
use hangpose::mechanics::{Kind, Kinds};
use hangpose::{Candidates, Params};
use std::f32::consts::PI;
use std::path::Path;

/// How and where the object shall hang.
#[derive(Args)]
pub(super) struct RequestArguments {
    /// Kinds of poses that are given at all, comma-separated: threaded (a bar runs through a loop of the object), hooked (an
    /// open hook holds it), capped (its cavity stands over a tip), balanced (friction holds it). The default is all.
    #[arg(long, value_name = "KINDS", value_enum, value_delimiter = ',')]
    allow: Vec<KindName>,
    /// Kinds that come first. The others follow if they are much more probable.
    #[arg(long, value_name = "KINDS", value_enum, value_delimiter = ',', default_values_t = [KindName::Threaded, KindName::Hooked])]
    prefer: Vec<KindName>,
    /// Point of the supporter at which the object shall hang, in metres in the supporter frame (after scale and up axis), and
    /// how far from it, 0.02 if not given.
    #[arg(long, value_name = "X,Y,Z[,R]", value_parser = parse_place, allow_hyphen_values = true)]
    here: Option<Place>,
    /// Point of the object by which it shall hang, in metres in the object frame (after scale and up axis), and how far from
    /// it, 0.02 if not given.
    #[arg(long, value_name = "X,Y,Z[,R]", value_parser = parse_place, allow_hyphen_values = true, conflicts_with = "by_box")]
    by: Option<Place>,
    /// Box of the object by which it shall hang, by its lower and its upper corner in metres in the object frame.
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = parse_numbers::<6>, allow_hyphen_values = true)]
    by_box: Option<[f64; 6]>,
    /// Direction in which the object comes to its release pose in a straight line, in the supporter frame.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_direction, allow_hyphen_values = true)]
    approach: Option<[f64; 3]>,
    /// Largest angle between that line and the direction, degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = 30.0, value_parser = parse_angle, allow_hyphen_values = true, requires = "approach")]
    approach_angle: f32,
    /// Length of that line, metres.
    #[arg(long, value_name = "METRES", default_value_t = 0.1, value_parser = parse_length, allow_hyphen_values = true, requires = "approach")]
    approach_length: f32,
    #[command(flatten)]
    scene: SceneArguments,
    /// How much two poses of a kind differ at least: metres between the centres of mass, or degrees of rotation.
    #[arg(long, value_name = "METRES,DEGREES", value_parser = parse_distance, allow_hyphen_values = true)]
    distinct: Option<Distance>,
}

#[derive(Clone, Copy, ValueEnum)]
enum KindName {
    Threaded,
    Hooked,
    Capped,
    Balanced,
}

/// A point and the radius around it, metres.
#[derive(Clone, Copy)]
struct Place {
    at: [f64; 3],
    radius: f32,
}

/// Radius around a point if none is given, metres: about a hook.
const RADIUS: f32 = 0.02;

/// Greatest length in a request, metres; the core checks it, too.
const MAX_LENGTH: f32 = 10.0;

fn parse_place(text: &str) -> Result<Place, String> {
    if let Ok(at) = parse_numbers::<3>(text) {
        return Ok(Place { at, radius: RADIUS });
    }
    match parse_numbers::<4>(text) {
        Ok([x, y, z, radius]) if radius >= 0.0 => Ok(Place { at: [x, y, z], radius: radius as f32 }),
        Ok(_) => Err("the radius is negative: use 0 or more metres, as in 0.07,0,0.15,0.02".into()),
        Err(_) => Err("use x,y,z or x,y,z,radius in metres, as in 0.07,0,0.15,0.02".into()),
    }
}

fn parse_direction(text: &str) -> Result<[f64; 3], String> {
    match parse_numbers::<3>(text)? {
        [0.0, 0.0, 0.0] => Err("it has no direction: use numbers that are not all 0, as in 0,0,-1".into()),
        direction => Ok(direction),
    }
}

fn parse_angle(text: &str) -> Result<f32, String> {
    match text.trim().parse() {
        Ok(degrees) if (0.0..=180.0).contains(&degrees) => Ok(degrees),
        _ => Err("use 0 to 180 degrees".into()),
    }
}

fn parse_length(text: &str) -> Result<f32, String> {
    match text.trim().parse() {
        Ok(metres) if (0.0..=MAX_LENGTH).contains(&metres) => Ok(metres),
        _ => Err(format!("use 0 to {MAX_LENGTH} metres")),
    }
}

fn parse_distance(text: &str) -> Result<Distance, String> {
    let parsed = text.split_once(',').map(|(metres, degrees)| (parse_length(metres), parse_angle(degrees)));
    match parsed {
        Some((Ok(position), Ok(degrees))) => Ok(Distance { position, rotation: radians(degrees) }),
        _ => Err(format!("use 0 to {MAX_LENGTH} metres and 0 to 180 degrees, as in 0.05,30")),
    }
}

/// Degrees of 0 to 180 in radians of 0 to π, whatever the rounding.
fn radians(degrees: f32) -> f32 {
    degrees.to_radians().min(PI)
}

/// What the options ask for, with the memory that a [`Request`] borrows.
pub(super) struct Wishes {
    allow: Kinds,
    prefer: Kinds,
    here: Option<([[f32; 3]; 1], f32)>,
    by: Option<([[f32; 3]; 1], f32)>,
    by_box: Option<[[f32; 3]; 2]>,
    approach: Option<Approach>,
    scene: Vec<[f32; 3]>,
    distinct: Distance,
}

impl RequestArguments {
    /// Fails if an option would have no effect with these constants.
    pub(super) fn check(&self, params: &Params) -> Result<()> {
        let is_placed = params.settle || params.candidates == Candidates::Contacts;
        for (option, is_given, has_effect) in [
            ("--allow", !self.allow.is_empty(), params.settle),
            ("--here", self.here.is_some(), is_placed),
            ("--by", self.by.is_some(), is_placed),
            ("--by-box", self.by_box.is_some(), is_placed),
            ("--approach", self.approach.is_some(), params.settle),
            ("--scene", self.scene.file().is_some(), params.settle),
            ("--distinct", self.distinct.is_some(), params.settle),
        ] {
            ensure!(
                has_effect || !is_given,
                "{option} has no effect on poses that are not released: pass --profile default, or settle = true in the --params file"
            );
        }
        Ok(())
    }

    /// The file that is read, if any.
    pub(super) fn file(&self) -> Option<&Path> {
        self.scene.file()
    }

    /// Reads the scene, and moves what is in the supporter frame to the coordinates of its cloud, which begin at `origin`.
    pub(super) fn read(&self, frames: &FrameArguments, origin: [f64; 3]) -> Result<Wishes> {
        let kinds = |names: &[KindName]| Kinds::of(&names.iter().map(|name| name.kind()).collect::<Vec<_>>());
        let single = |place: Option<Place>, origin: [f64; 3]| {
            place.map(|Place { at, radius }| ([[0, 1, 2].map(|i| (at[i] - origin[i]) as f32)], radius))
        };
        Ok(Wishes {
            allow: if self.allow.is_empty() { Kinds::ALL } else { kinds(&self.allow) },
            prefer: kinds(&self.prefer),
            here: single(self.here, origin),
            by: single(self.by, [0.0; 3]),
            by_box: self.by_box.map(|[ax, ay, az, bx, by, bz]| {
                [[ax, ay, az], [bx, by, bz]].map(|corner| corner.map(|x| x as f32))
            }),
            approach: self.approach.map(|direction| Approach {
                direction: direction.map(|x| x as f32),
                angle: radians(self.approach_angle),
                length: self.approach_length,
            }),
            scene: self.scene.read(frames, origin)?,
            distinct: self.distinct.unwrap_or(Request::ANY.distinct),
        })
    }
}

impl KindName {
    fn kind(self) -> Kind {
        match self {
            Self::Threaded => Kind::Threaded,
            Self::Hooked => Kind::Hooked,
            Self::Capped => Kind::Capped,
            Self::Balanced => Kind::Balanced,
        }
    }
}

/// The region around a point.
fn near(place: &Option<([[f32; 3]; 1], f32)>) -> Region<'_> {
    match place {
        Some((points, radius)) => Region::Points { points, indices: None, radius: *radius },
        None => Region::Everywhere,
    }
}

impl Wishes {
    /// The request, checked.
    pub(super) fn request(&self) -> Result<Request<'_>> {
        let request = Request {
            allow: self.allow,
            prefer: self.prefer,
            on: near(&self.here),
            by: match self.by_box {
                Some([low, high]) => Region::Box { low, high },
                None => near(&self.by),
            },
            approach: self.approach,
            scene: &self.scene,
            hung: &[],
            distinct: self.distinct,
            symmetries: None,
            watch: None,
        };
        match request.validate() {
            Ok(()) => Ok(request),
            Err(error) => Err(error).context(self.option(&error)),
        }
    }

    /// The option that gave what is wrong.
    fn option(&self, error: &RequestError) -> &'static str {
        match error {
            RequestError::NothingAllowed => "--allow",
            RequestError::On(_) => "--here",
            RequestError::By(_) if self.by_box.is_some() => "--by-box",
            RequestError::By(_) => "--by",
            RequestError::Approach => "--approach",
            RequestError::Scene { .. } => "--scene",
            RequestError::Distinct => "--distinct",
            // The command gives none of these.
            RequestError::Hung { .. } => "hung",
            RequestError::Symmetry { .. } => "symmetries",
        }
    }
}
