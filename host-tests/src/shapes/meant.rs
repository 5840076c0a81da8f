//! How an object hangs on a supporter by the construction of both: how a person means it, and how it does at a rest pose.

use super::fits::holds;
use super::vector::{V, X, Y, across, add, along, cross, dot, double, length, scale, sub, turn, unit};
use super::{Bar, HangObject, Opening, OpeningKind, Support};
use crate::solid::{Part, Solid};
use hangpose::geometry::{Point, Pose};
use hangpose::mechanics::Kind;
use parry3d::query::{Ray, RayCast};
use parry3d::shape::TriMesh;

/// Kinds of objects that a person hangs every day.
const DAILY_OBJECTS: [&str; 7] = ["mug", "cap", "pan", "utensil", "scissors", "key", "clothes hanger"];
/// Words in the names of the kinds of supporters that a person hangs them on.
const DAILY_SUPPORTERS: [&str; 3] = ["hook", "tree", "peg"];

/// Whether a person hangs this kind of object on this kind of supporter every day.
pub fn is_daily(object: &str, supporter: &str) -> bool {
    DAILY_OBJECTS.contains(&object) && DAILY_SUPPORTERS.iter().any(|word| supporter.contains(word))
}

/// Whether the object can hang on the supporter: some opening by which a person hangs it fits some bar.
pub fn fits(object: &HangObject, support: &Support) -> bool {
    meant(object, support).is_some()
}

/// The kind of hanging that a person means for a pair: by a hole if one fits some bar, else by a hook or a neck, else by
/// a hollow; `None` if no opening fits.
pub fn meant(object: &HangObject, support: &Support) -> Option<Kind> {
    let openings = object.openings.iter().filter(|opening| opening.is_meant);
    let fitting = openings.filter(|opening| support.bars.iter().any(|bar| holds(object, opening, bar)));
    fitting.map(|opening| opening.kind.hangs()).min_by_key(rank)
}

/// Place of a kind in the order in which people prefer them.
fn rank(kind: &Kind) -> usize {
    Kind::ALL.iter().position(|other| other == kind).expect("all kinds are listed")
}

impl OpeningKind {
    /// How an object hangs by such an opening.
    fn hangs(self) -> Kind {
        match self {
            Self::Hole => Kind::Threaded,
            Self::Hook | Self::Neck { .. } => Kind::Hooked,
            Self::Rim => Kind::Capped,
        }
    }
}

/// An opening that is joined with a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// How the object hangs by it.
    pub kind: Kind,
    /// Index of the opening.
    pub opening: usize,
    /// Index of the bar nearest to the place where it passes the opening.
    pub bar: usize,
    /// Whether that bar is a part of the wire that passes the opening: nothing tells the ends of any other wire.
    pub is_on_bar: bool,
    /// Radius of the wire that passes the opening, m; `None` for a hollow and a neck, which no single wire passes.
    pub wire_radius: Option<f32>,
    /// The place, in supporter coordinates, m.
    pub at: [f32; 3],
}

/// The opening of a made object that is joined with a bar of a made supporter when the object is at `rest`; that of the
/// kind that people prefer if there are several, the first of [`joints`]. `None` if none is: the object is balanced.
pub fn joined(object: (&Solid, &[Opening]), supporter: (&Solid, &[Bar]), rest: &Pose) -> Option<Joint> {
    joints(object, supporter, rest).first().copied()
}

/// All openings of a made object that are joined with bars of a made supporter when the object is at `rest`, those of the kind that
/// people prefer first.
///
/// Bars are the centre lines of all wires of the supporter, including bends and ends that nothing is meant to hang on. Wall
/// plates and posts are no bars: an object that hangs on the edge of a plate is not joined. The opening is measured on the mesh by rays from its axis:
///
/// - A hole is joined with a bar whose centre line passes it: seen from the axis, the bar is before the rim of the hole.
///   It is as deep as the planes across its axis in which as many rays meet the object as in its middle.
/// - A hook likewise, and the ray through the bar must end at the object, unless the bar is near the middle.
/// - A hollow is joined with the free end of a bar that is inside: the rays to all sides and to its ground meet the object.
/// - A neck is joined with two bars on opposite sides of the stem that are within the radius of the head.
pub fn joints(object: (&Solid, &[Opening]), supporter: (&Solid, &[Bar]), rest: &Pose) -> Vec<Joint> {
    let (surface, lines) = (Surface::new(object.0), Lines::new(supporter));
    let joints = object.1.iter().enumerate().filter_map(|(index, opening)| {
        let (at, segment) = lines.joined(&surface, opening, rest)?;
        let nearest = |a: &(usize, &Bar), b: &(usize, &Bar)| {
            let distance = |bar: &Bar| length(sub(at, nearest_on(ends(bar), at)));
            distance(a.1).total_cmp(&distance(b.1))
        };
        let (bar, nearest) = supporter.1.iter().enumerate().min_by(nearest)?;
        let is_on_bar = segment.is_none_or(|segment| lines.is_same_wire(segment, nearest));
        let wire_radius = segment.map(|segment| lines.segments[segment].1 as f32);
        let (kind, at) = (opening.kind.hangs(), super::vector::single(at));
        Some(Joint { kind, opening: index, bar, is_on_bar, wire_radius, at })
    });
    let mut joints: Vec<_> = joints.collect();
    joints.sort_by_key(|joint| rank(&joint.kind));
    joints
}

fn ends(bar: &Bar) -> [V; 2] {
    let from = double(bar.position);
    [from, along(from, f64::from(bar.length), double(bar.direction))]
}

/// The point of a segment nearest to `p`.
fn nearest_on([from, to]: [V; 2], p: V) -> V {
    let reach = sub(to, from);
    let squared = dot(reach, reach);
    let t = if squared > 0.0 { (dot(sub(p, from), reach) / squared).clamp(0.0, 1.0) } else { 0.0 };
    along(from, t, reach)
}

/// Distance below which the ends of two segments are one point, m: a wire is made of segments from end to end.
const SAME_POINT: f64 = 1e-6;
/// Number of rays to all sides.
const SIDES: usize = 16;
/// Largest half depth of a hole, m.
const DEEPEST: f64 = 0.03;
/// Step in which the depth of a hole is measured, m.
const DEPTH_STEP: f64 = 0.001;
/// Share of the clear radius within which a bar is in a hook in any direction.
const MIDDLE: f64 = 0.5;
/// Parts of the stem before and behind the middle of a neck that two bars may hold, m.
const STEM: [f64; 2] = [-0.015, 0.025];
/// Number of points of the stem that are tested.
const STEM_POINTS: usize = 12;
/// Cosine of the angle between the directions from the stem to two bars below which the bars are on opposite sides.
const OPPOSITE: f64 = -0.5;

/// The object's surface, in millimetres: in metres, parry's tolerances are too large for narrow triangles.
struct Surface(TriMesh);

impl Surface {
    fn new(solid: &Solid) -> Self {
        let vertices = solid.vertices.iter().map(|vertex| vertex.map(|x| 1000.0 * x).into()).collect();
        Self(TriMesh::new(vertices, solid.triangles.clone()).expect("a shape has triangles"))
    }

    /// Distance from `from` along the unit vector `way` to the object, m; infinite if it is not met.
    fn distance(&self, from: V, way: V) -> f64 {
        let ray = Ray::new(scale(from, 1000.0).map(|x| x as f32).into(), way.map(|x| x as f32).into());
        self.0.cast_local_ray(&ray, f32::MAX, false).map_or(f64::INFINITY, |toi| f64::from(toi) / 1000.0)
    }
}

/// Unit vectors to all sides of an axis.
fn sides(axis: V) -> impl Iterator<Item = V> {
    let u = unit(across(if axis[0].abs() < 0.7 { X } else { Y }, axis));
    let v = cross(axis, u);
    (0..SIDES).map(move |k| {
        let [cos, sin] = turn(360.0 * k as f64 / SIDES as f64);
        add(scale(u, cos), scale(v, sin))
    })
}

/// Centre lines of the supporter.
struct Lines {
    /// Segments with their radii, m.
    segments: Vec<([V; 2], f64)>,
    /// Flat bars, which only hold a neck, with half their widths, m.
    flat: Vec<([V; 2], f64)>,
    /// Free ends.
    tips: Vec<V>,
}

impl Lines {
    fn new((solid, bars): (&Solid, &[Bar])) -> Self {
        let capsules = solid.parts.iter().filter_map(|part| match part {
            Part::Capsule { from, to, radius } => Some(([double(*from), double(*to)], f64::from(*radius))),
            _ => None,
        });
        let segments: Vec<([V; 2], f64)> = capsules.collect();
        let flat = bars.iter().filter(|bar| bar.pass_radius.is_infinite());
        let all: Vec<V> = segments.iter().flat_map(|segment| segment.0).collect();
        let is_free =
            |tip: &V| all.iter().filter(|other| length(sub(**other, *tip)) < SAME_POINT).count() == 1;
        Self {
            flat: flat.map(|bar| (ends(bar), f64::from(bar.radius))).collect(),
            tips: all.iter().copied().filter(is_free).collect(),
            segments,
        }
    }

    /// Whether a segment and a bar are parts of one wire: from end to end, other segments lead from the one to the other.
    fn is_same_wire(&self, segment: usize, bar: &Bar) -> bool {
        let [from, to] = ends(bar);
        let middle = scale(add(from, to), 0.5);
        let is_joined = |a: &[V; 2], b: &[V; 2]| {
            a.iter().any(|end| b.iter().any(|other| length(sub(*end, *other)) < SAME_POINT))
        };
        let mut wire = vec![segment];
        let mut next = 0;
        while let Some(&here) = wire.get(next) {
            let (here, radius) = &self.segments[here];
            if length(sub(middle, nearest_on(*here, middle))) < *radius {
                return true;
            }
            let beside = (0..self.segments.len()).filter(|other| is_joined(here, &self.segments[*other].0));
            let new: Vec<usize> = beside.filter(|other| !wire.contains(other)).collect();
            wire.extend(new);
            next += 1;
        }
        false
    }

    /// Where a bar is joined with an opening, in supporter coordinates, and its segment if a single one passes the opening.
    fn joined(&self, surface: &Surface, opening: &Opening, rest: &Pose) -> Option<(V, Option<usize>)> {
        let to_object = rest.inverse();
        let moved = |pose: &Pose, v: V| -> V {
            let moved = pose * Point::from(super::vector::single(v));
            double(moved.into())
        };
        match opening.kind {
            OpeningKind::Hole | OpeningKind::Hook => {
                self.segments.iter().enumerate().find_map(|(index, (segment, _))| {
                    let segment = segment.map(|end| moved(&to_object, end));
                    passes(surface, opening, segment).map(|at| (moved(rest, at), Some(index)))
                })
            }
            OpeningKind::Rim => {
                let is_inside = |tip: V| {
                    let ground = scale(double(opening.axis), -1.0);
                    sides(double(opening.axis))
                        .chain([ground])
                        .all(|way| surface.distance(tip, way).is_finite())
                };
                let tip = self.tips.iter().find(|tip| is_inside(moved(&to_object, **tip)))?;
                Some((*tip, None))
            }
            OpeningKind::Neck { head_radius } => {
                let (centre, axis) = (double(opening.centre), double(opening.axis));
                let stem = STEM.map(|s| moved(rest, along(centre, s, axis)));
                Some((self.beside(stem, f64::from(head_radius))?, None))
            }
        }
    }

    /// A point of a stem that is between two bars, each within `reach` metres.
    fn beside(&self, stem: [V; 2], reach: f64) -> Option<V> {
        let axis = unit(sub(stem[1], stem[0]));
        let near: Vec<(V, V)> = (self.segments.iter().chain(&self.flat))
            .filter_map(|&(segment, radius)| {
                let points = (0..STEM_POINTS).map(|k| {
                    let t = k as f64 / (STEM_POINTS - 1) as f64;
                    let at = along(stem[0], t, sub(stem[1], stem[0]));
                    (at, sub(nearest_on(segment, at), at))
                });
                let (at, apart) = points.min_by(|a, b| length(a.1).total_cmp(&length(b.1)))?;
                let (level, aside) = (dot(apart, axis).abs(), across(apart, axis));
                (level < radius && (1e-6..reach + radius).contains(&length(aside))).then(|| (at, unit(aside)))
            })
            .collect();
        near.iter()
            .find(|(_, side)| near.iter().any(|(_, other)| dot(*side, *other) < OPPOSITE))
            .map(|near| near.0)
    }
}

/// Where the centre line of a bar passes a hole or hook, in object coordinates.
fn passes(surface: &Surface, opening: &Opening, segment: [V; 2]) -> Option<V> {
    let (centre, axis) = (double(opening.centre), double(opening.axis));
    let heights = segment.map(|end| dot(sub(end, centre), axis));
    let (low, high) = (heights[0].min(heights[1]), heights[0].max(heights[1]));
    let height = 0.0_f64.clamp(low, high);
    if !is_as_deep(surface, centre, axis, height) {
        return None;
    }
    let t = if high > low { (height - heights[0]) / (heights[1] - heights[0]) } else { 0.5 };
    let at = along(segment[0], t, sub(segment[1], segment[0]));
    let middle = along(centre, height, axis);
    let (away, clear) = (length(sub(at, middle)), f64::from(opening.clear_radius));
    if away < MIDDLE * clear {
        return Some(at);
    }
    let rim = surface.distance(middle, scale(sub(at, middle), 1.0 / away));
    let is_closed = opening.kind == OpeningKind::Hole || rim.is_finite();
    (is_closed && away < rim).then_some(at)
}

/// Whether a hole or hook still is one in the plane that is `height` metres from its middle: the same rays meet the object
/// there, and in all planes between.
fn is_as_deep(surface: &Surface, centre: V, axis: V, height: f64) -> bool {
    let met = |height: f64| {
        let from = along(centre, height, axis);
        sides(axis).map(move |way| surface.distance(from, way).is_finite())
    };
    let steps = (height.abs() / DEPTH_STEP).ceil() as u32;
    height.abs() < DEEPEST && (1..=steps).all(|k| met(height * f64::from(k) / f64::from(steps)).eq(met(0.0)))
}
