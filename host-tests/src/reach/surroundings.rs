//! What stands around a supporter: a wall, a shelf, or neighbours on which the same object hangs.
//!
//! All leave room for the object by construction.

use crate::shapes::vector::{V, Z, along, cross, dot, double, unit};
use crate::shapes::{Builder, OpeningKind};
use crate::solid::Solid;
use crate::tables::case::Case;
use clap::ValueEnum;
use hangpose::files::CloudFile;
use hangpose::geometry::{Point, Pose};
use hangpose::sample_supporter;
use nalgebra::{Isometry3, Translation3};

/// What stands around a supporter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Around {
    /// Nothing.
    Nothing,
    /// A wall behind it. Plates are let into the wall.
    Wall,
    /// A shelf above it: the object fits between the supporter and the shelf, with 3 cm to spare.
    Shelf,
    /// Copies of it at both sides, or the same rail, with the same object hung at the same pose.
    Neighbours,
}

impl Around {
    /// Name in the tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nothing => "bare supporter",
            Self::Wall => "wall behind",
            Self::Shelf => "shelf above",
            Self::Neighbours => "neighbours with the same object",
        }
    }
}

/// Things around a supporter, in its coordinates.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// What stands still beside the supporter, without the objects that hang.
    pub solid: Solid,
    /// Samples of its surface, as a camera gives them, m.
    pub points: Vec<[f32; 3]>,
    /// Poses at which the object hangs already.
    pub hung: Vec<Pose>,
    /// Height that is free for the object above the supporter, m.
    pub height: f64,
}

/// Supporters that stand on a foot; the others are on a wall.
const STANDS: [&str; 2] = ["mug tree", "rod"];
/// Distance from the front of the plates, at x = 0, to the wall into which they are let, m.
const LET_IN: f64 = 0.004;
/// Free distance of a wall from a supporter with a foot and from the object on it, m.
const BEHIND: f64 = 0.01;
/// What a wall or shelf exceeds supporter and object by, m.
const MARGIN: f64 = 0.1;
/// Thickness of a wall or shelf, m.
const THICKNESS: f64 = 0.02;
/// Height that the object has to spare below a shelf, m.
const SPARE: f64 = 0.03;
/// Free distance between neighbours, m; more by the width of the object if it comes from the side.
const APART: f64 = 0.03;
/// Spacing of the samples of a wall or shelf, m.
const COARSE: f64 = 0.005;
/// Spacing of the samples of a neighbour, m.
const FINE: f64 = 0.003;

/// The horizontal direction from which a person comes: away from the wall, or along the bar on which the object hangs. `None`
/// if a supporter with a foot is not joined with the object.
pub fn front(case: &Case, rest: &Pose) -> Option<V> {
    if !STANDS.contains(&case.supporter_kind.as_str()) {
        return Some([1.0, 0.0, 0.0]);
    }
    let [x, y, _] = double(case.bars[case.joined(rest)?.bar].direction);
    Some(unit([x, y, 0.0]))
}

/// Extent of a shape at a pose along a direction, m.
pub fn extent(solid: &Solid, pose: &Pose, direction: V) -> [f64; 2] {
    let heights = solid.vertices.iter().map(|&vertex| {
        let at: [f32; 3] = (pose * Point::from(vertex)).into();
        dot(double(at), direction)
    });
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| [low.min(s), high.max(s)])
}

/// Things around the supporter of a pair of which the object hangs at `rest`; `None` if there is no room for them.
pub fn surroundings(case: &Case, rest: &Pose, around: Around) -> Option<Surroundings> {
    let front = front(case, rest)?;
    let aside = cross(Z, front);
    let supporter = |direction: V| extent(&case.supporter, &Pose::identity(), direction);
    let both = |direction: V| {
        let ([a, b], [c, d]) = (supporter(direction), extent(&case.object, rest, direction));
        [a.min(c), b.max(d)]
    };
    let height = {
        let [low, high] = extent(&case.object, rest, Z);
        high - low
    };
    let mut made = Surroundings { height: f64::INFINITY, ..Surroundings::default() };
    match around {
        Around::Nothing => {}
        Around::Wall => {
            let is_stand = STANDS.contains(&case.supporter_kind.as_str());
            let at = if is_stand { both(front)[0] - BEHIND } else { -LET_IN };
            let wide = both(aside);
            let tall = both(Z);
            let mut wall = Builder::default();
            wall.cuboid(
                [-THICKNESS, wide[0] - MARGIN, tall[0] - MARGIN],
                [0.0, wide[1] + MARGIN, tall[1] + MARGIN],
            );
            made.solid = placed(&wall, [front, aside, Z], along([0.0; 3], at, front));
            made.points = samples(&made.solid, COARSE, Some(front));
        }
        Around::Shelf => {
            made.height = height + SPARE;
            let low = supporter(Z)[1] + made.height;
            let (deep, wide) = (both(front), both(aside));
            let mut shelf = Builder::default();
            shelf.cuboid(
                [deep[0], wide[0] - MARGIN, low],
                [deep[1] + MARGIN / 2.0, wide[1] + MARGIN, low + THICKNESS],
            );
            made.solid = placed(&shelf, [front, aside, Z], [0.0; 3]);
            made.points = samples(&made.solid, COARSE, None);
        }
        Around::Neighbours => neighbours(case, rest, aside, both(aside), &mut made)?,
    }
    Some(made)
}

fn neighbours(case: &Case, rest: &Pose, aside: V, both: [f64; 2], made: &mut Surroundings) -> Option<()> {
    let joint = case.joined(rest);
    let bar = joint.map(|joint| &case.bars[joint.bar]);
    let object = extent(&case.object, rest, aside);
    let wide = object[1] - object[0];
    let shifted = |s: f64| Translation3::from(along([0.0; 3], s, aside).map(|x| x as f32));
    if case.supporter_kind == "mug tree" {
        return None;
    }
    if bar.is_some_and(|bar| !bar.has_free_end) {
        // Others hang on the same rail, where it is long enough.
        let ends = extent(&case.supporter, &Pose::identity(), aside);
        let hook = joint.map(|joint| dot(double(joint.at), aside))?;
        let step = wide + APART;
        let is_on_rail = |s: &f64| hook + s > ends[0] + 2.0 * APART && hook + s < ends[1] - 2.0 * APART;
        made.hung = [-step, step].into_iter().filter(is_on_rail).map(|s| shifted(s) * rest).collect();
        return (!made.hung.is_empty()).then_some(());
    }
    let comes_aside = bar.is_some_and(|bar| {
        dot(double(bar.direction), aside).abs() > 0.5
            && !matches!(opening(case, rest), Some(OpeningKind::Rim))
    });
    let step = both[1] - both[0] + APART + if comes_aside { wide + APART } else { 0.0 };
    let points = samples(&case.supporter, FINE, None);
    for s in [-step, step] {
        let shift: Isometry3<f32> = shifted(s).into();
        made.solid = made.solid.with([(&*case.supporter, shift)]);
        made.points.extend(points.iter().map(|&point| <[f32; 3]>::from(shift * Point::from(point))));
        made.hung.push(shift * rest);
    }
    Some(())
}

fn opening(case: &Case, rest: &Pose) -> Option<OpeningKind> {
    Some(case.openings[case.joined(rest)?.opening].kind)
}

fn placed(builder: &Builder, axes: [V; 3], origin: V) -> Solid {
    let mut placed = Builder::default();
    placed.place(builder, axes, origin);
    placed.finish()
}

/// Samples of a surface at this spacing, m, with their normals.
pub fn sampled(solid: &Solid, spacing: f64) -> CloudFile {
    let at = |index: u32| Point::from(solid.vertices[index as usize]);
    let area = |&[a, b, c]: &[u32; 3]| f64::from((at(b) - at(a)).cross(&(at(c) - at(a))).norm()) / 2.0;
    let area: f64 = solid.triangles.iter().map(area).sum();
    let count = (area / (spacing * spacing)).ceil().max(1.0) as usize;
    sample_supporter(&solid.mesh(), count, 1)
}

/// The points alone; only those that face a direction, if it is given.
pub fn samples(solid: &Solid, spacing: f64, facing: Option<V>) -> Vec<[f32; 3]> {
    let CloudFile { points, normals, .. } = sampled(solid, spacing);
    let normals = normals.unwrap_or_default();
    let faces = |normal: [f32; 3]| facing.is_none_or(|facing| dot(double(normal), facing) > 0.5);
    points.into_iter().zip(normals).filter(|(_, normal)| faces(*normal)).map(|(point, _)| point).collect()
}
