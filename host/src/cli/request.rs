//! The options that say how and where the object shall hang, and what it must not touch.

use super::input::{self, Placement};
use super::{FileArguments, parse_numbers};
use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use hangpose::files::{self, CloudFile, SupporterFile};
use hangpose::hanging::{Approach, Distance, Region, Request};
use hangpose::mechanics::{Kind, Kinds};
use std::path::PathBuf;

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
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_numbers::<3>, allow_hyphen_values = true)]
    approach: Option<[f64; 3]>,
    /// Largest angle between that line and the direction, degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = 30.0, requires = "approach")]
    approach_angle: f32,
    /// Length of that line, metres.
    #[arg(long, value_name = "METRES", default_value_t = 0.1, requires = "approach")]
    approach_length: f32,
    /// Things near the supporter, which the object does not touch and never hangs on: a point cloud or a mesh in the units
    /// and axes of the supporter's file.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// How much two poses of a kind differ at least: metres between the centres of mass, or degrees of rotation.
    #[arg(long, value_name = "METRES,DEGREES", value_parser = parse_numbers::<2>)]
    distinct: Option<[f64; 2]>,
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

fn parse_place(text: &str) -> Result<Place, String> {
    if let Ok([x, y, z, radius]) = parse_numbers::<4>(text) {
        return Ok(Place { at: [x, y, z], radius: radius as f32 });
    }
    parse_numbers::<3>(text)
        .map(|at| Place { at, radius: RADIUS })
        .map_err(|error| format!("{error}, and a radius if need be"))
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
    /// Reads the scene, and moves what is in the supporter frame to the coordinates of its cloud.
    pub(super) fn read(&self, files: &FileArguments, supporter: &CloudFile) -> Result<Wishes> {
        let kinds = |names: &[KindName]| Kinds::of(&names.iter().map(|name| name.kind()).collect::<Vec<_>>());
        let single = |place: Option<Place>, origin: [f64; 3]| {
            place.map(|Place { at, radius }| ([[0, 1, 2].map(|i| (at[i] - origin[i]) as f32)], radius))
        };
        Ok(Wishes {
            allow: if self.allow.is_empty() { Kinds::ALL } else { kinds(&self.allow) },
            prefer: kinds(&self.prefer),
            here: single(self.here, supporter.origin),
            by: single(self.by, [0.0; 3]),
            by_box: self.by_box.map(|[ax, ay, az, bx, by, bz]| {
                [[ax, ay, az], [bx, by, bz]].map(|corner| corner.map(|x| x as f32))
            }),
            approach: self.approach.map(|direction| Approach {
                direction: direction.map(|x| x as f32),
                angle: self.approach_angle.to_radians(),
                length: self.approach_length,
            }),
            scene: self.scene(files, supporter)?,
            distinct: self.distinct.map_or(Request::ANY.distinct, |[metres, degrees]| Distance {
                position: metres as f32,
                rotation: (degrees as f32).to_radians(),
            }),
        })
    }

    fn scene(&self, files: &FileArguments, supporter: &CloudFile) -> Result<Vec<[f32; 3]>> {
        let Some(path) = &self.scene else { return Ok(Vec::new()) };
        let placement =
            Placement { scale: files.supporter_scale, up: files.supporter_up, scale_option: None };
        let scene = match files::read_supporter(path)? {
            SupporterFile::Mesh(mesh) => input::scene_mesh(path, mesh, &placement)?,
            SupporterFile::Cloud(cloud) => input::placed_cloud(path, cloud, &placement)?,
        };
        let shift = [0, 1, 2].map(|i| (scene.origin[i] - supporter.origin[i]) as f32);
        Ok(scene.points.iter().map(|point| [0, 1, 2].map(|i| point[i] + shift[i])).collect())
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
        };
        request.validate().context("--here, --by, --approach or --distinct")?;
        Ok(request)
    }
}
