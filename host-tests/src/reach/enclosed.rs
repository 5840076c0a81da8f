//! Objects and supporters that enclose each other, so that there is no way to the pose, and the same with a way out.

use crate::judge::{Bullet, Judge, Scene};
use crate::shapes::vector::{V, X, Y, Z, across, add, along, arc, cross, double, length, scale, sub, unit};
use crate::shapes::{Builder, HangObject, OBJECTS, Opening, OpeningKind, Random};
use crate::solid::Solid;
use clap::ValueEnum;
use hangpose::geometry::Pose;
use hangpose::parry::pose_to_parry;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use parry3d::query::PointQuery;
use parry3d::shape::TriMesh;

/// How object and supporter enclose each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Enclosure {
    /// A closed hole around a straight rail between two plates, each larger than the object.
    Rail,
    /// A closed hole around the wire of a closed loop.
    Loop,
    /// A solid object in a cage. The largest ball inside the object is wider than the diagonal of the openings of the cage.
    Cage,
    /// A solid object in a box with a slot. The largest ball inside the object is wider than the slot.
    Slot,
}

impl Enclosure {
    /// Name in the tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rail => "closed hole on a rail between plates",
            Self::Loop => "closed hole on a closed loop",
            Self::Cage => "object in a cage",
            Self::Slot => "object behind a narrow slot",
        }
    }
}

/// An object and a supporter, and a free pose at which one encloses the other.
#[derive(Clone, Debug)]
pub struct Enclosed {
    /// Kind of the object.
    pub object_kind: &'static str,
    /// The object.
    pub object: Solid,
    /// The supporter.
    pub supporter: Solid,
    /// The pose: object to supporter coordinates.
    pub pose: Pose,
    /// Direction of the way out of the supporter that is not closed, in supporter coordinates.
    pub out: V,
    /// Centre line of the supporter's loop; empty for a cage or slot.
    pub line: Vec<V>,
}

/// Clear radius of a hole below which no supporter is made, m.
const NARROWEST: f64 = 0.006;
/// Kinds of objects that are solid.
const SOLID: [&str; 4] = ["ball", "box", "can", "bottle"];
/// Radius of the wires of a cage, m.
const CAGE_WIRE: f64 = 0.003;
/// Thickness of the plates of a rail and of a box, m.
const PLATE: f64 = 0.01;

/// The pair of this seed, with the way closed or open; `None` if no object of the kind drawn fits.
pub fn enclosed(enclosure: Enclosure, seed: u64, is_closed: bool) -> Option<Enclosed> {
    let mut random = Random::named(enclosure.name(), seed);
    let is_linked = matches!(enclosure, Enclosure::Rail | Enclosure::Loop);
    let kinds: Vec<_> = OBJECTS
        .iter()
        .filter(|kind| if is_linked { kind.is_hangable } else { SOLID.contains(&kind.name) })
        .collect();
    let kind = kinds[random.pick(kinds.len())];
    let object = kind.make(seed);
    let made = match enclosure {
        Enclosure::Rail => rail(&object, &mut random, is_closed),
        Enclosure::Loop => wire_loop(&object, &mut random, is_closed),
        Enclosure::Cage => cage(&object.solid, &mut random, is_closed),
        Enclosure::Slot => slot(&object.solid, &mut random, is_closed),
    };
    let (supporter, pose, out, line) = made?;
    let scene = Scene::new(&object.solid, &supporter);
    let mut world = Bullet::default().world(&scene);
    world.release(&pose.cast());
    let is_free = world.penetration() <= 0.0;
    is_free.then_some(Enclosed { object_kind: kind.name, object: object.solid, supporter, pose, out, line })
}

type Made = Option<(Solid, Pose, V, Vec<V>)>;

/// The widest closed hole of an object, unless all are too narrow.
fn hole(object: &HangObject) -> Option<&Opening> {
    let holes =
        object.openings.iter().filter(|opening| opening.kind == OpeningKind::Hole && opening.is_meant);
    let widest = holes.max_by(|a, b| a.clear_radius.total_cmp(&b.clear_radius))?;
    (f64::from(widest.clear_radius) > NARROWEST).then_some(widest)
}

/// Largest extent of an object, m.
fn extent(solid: &Solid) -> f64 {
    f64::from(solid.mesh().aabb().extents().max())
}

/// The pose at which the axis of a hole is along y, the object hangs below it, and the centre of the hole is `below` metres
/// below the origin.
fn hung(object: &HangObject, opening: &Opening, below: f64) -> Pose {
    let (centre, axis) = (double(opening.centre), double(opening.axis));
    let scene = Scene::new(&object.solid, &object.solid);
    let mut down = across(sub(double(scene.centre_of_mass()), centre), axis);
    if length(down) < 1e-3 * f64::from(opening.clear_radius) {
        down = across(if axis[0].abs() < 0.7 { X } else { Y }, axis);
    }
    let down = unit(down);
    let rows = [cross(axis, scale(down, -1.0)), axis, scale(down, -1.0)].map(Vector3::from);
    let turn = Rotation3::from_matrix_unchecked(Matrix3::from_rows(&rows.map(|row| row.transpose())));
    let turn = UnitQuaternion::from_rotation_matrix(&turn);
    let at = Vector3::new(0.0, 0.0, -below) - turn * Vector3::from(centre);
    Isometry3::from_parts(Translation3::from(at), turn).cast()
}

fn rail(object: &HangObject, random: &mut Random, is_closed: bool) -> Made {
    let opening = hole(object)?;
    let clear = f64::from(opening.clear_radius);
    let radius = (clear * random.range(0.25, 0.5)).min(0.012);
    let (plate, half) = (extent(&object.solid), extent(&object.solid) * random.range(0.6, 0.9) + 0.02);
    let mut builder = Builder::default();
    let line = vec![[0.0, -half - PLATE / 2.0, 0.0], [0.0, half + PLATE / 2.0, 0.0]];
    builder.tube(&line, radius);
    for side in if is_closed { vec![-1.0, 1.0] } else { vec![-1.0] } {
        let (a, b) = (side * half, side * (half + PLATE));
        let wide = 0.6 * plate + 0.01;
        builder.cuboid([-wide, a.min(b), -wide], [wide, a.max(b), wide]);
    }
    let pose = hung(object, opening, 0.7 * (clear - radius));
    Some((builder.finish(), pose, Y, line))
}

fn wire_loop(object: &HangObject, random: &mut Random, is_closed: bool) -> Made {
    let opening = hole(object)?;
    let clear = f64::from(opening.clear_radius);
    let wire = (clear * random.range(0.25, 0.4)).min(0.006);
    let bend = 0.04 + clear * random.range(2.0, 3.0);
    let mut builder = Builder::default();
    // From the top around through -y and y; the gap is at the side of +y.
    let centre = [0.0, 0.0, bend];
    let (from, to) = if is_closed { (90.0, 450.0) } else { (90.0, 340.0) };
    let line = arc(centre, scale(Y, bend), scale(Z, bend), [from, to], 48);
    builder.tube(&line, wire);
    let top = along(centre, bend, Z);
    builder.tube(&[top, add(top, [0.0, 0.0, 0.05])], wire);
    let ceiling = top[2] + 0.05;
    builder.cuboid([-0.03, -0.03, ceiling - 0.001], [0.03, 0.03, ceiling + PLATE]);
    let pose = hung(object, opening, 0.7 * (clear - wire));
    Some((builder.finish(), pose, X, if is_closed { line } else { Vec::new() }))
}

/// Radius of a ball inside a solid object around the middle of its box, m, and the pose that puts the middle at the origin.
fn inscribed(object: &Solid) -> Option<(f64, Pose)> {
    let middle = object.mesh().aabb().centre();
    let vertices = object.vertices.iter().map(|&vertex| vertex.map(|x| 1000.0 * x).into()).collect();
    let surface = TriMesh::new(vertices, object.triangles.clone()).expect("a shape has triangles");
    let at =
        pose_to_parry(&Isometry3::from_parts(Translation3::from(middle.coords * 1000.0), Default::default()));
    let radius = f64::from(surface.distance_to_local_point(at.translation, false)) / 1000.0;
    (radius > 0.01)
        .then(|| (radius, Isometry3::from_parts(Translation3::from(-middle.coords), Default::default())))
}

fn cage(object: &Solid, random: &mut Random, is_closed: bool) -> Made {
    let (ball, pose) = inscribed(object)?;
    let half = 0.5 * double(object.mesh().aabb().extents().into()).into_iter().fold(0.0, f64::max)
        + random.range(0.02, 0.04);
    let half = half * 1.2;
    // The diagonal of an opening is less than the ball is wide.
    let cells =
        (2.0 * half / (2.0 * ball / std::f64::consts::SQRT_2 * random.range(0.6, 0.9))).ceil() as usize;
    let mut builder = Builder::default();
    for (face, axes) in [(X, [Y, Z]), (Y, [Z, X]), (Z, [X, Y])] {
        for side in [-1.0, 1.0] {
            if !is_closed && face == X && side > 0.0 {
                continue;
            }
            for [u, v] in [axes, [axes[1], axes[0]]] {
                for k in 0..=cells {
                    let s = half * (2.0 * k as f64 / cells as f64 - 1.0);
                    let at = add(scale(face, side * half), scale(v, s));
                    builder.tube(&[along(at, -half, u), along(at, half, u)], CAGE_WIRE);
                }
            }
        }
    }
    Some((builder.finish(), pose, X, Vec::new()))
}

fn slot(object: &Solid, random: &mut Random, is_closed: bool) -> Made {
    let (ball, pose) = inscribed(object)?;
    let half = (0.5 * extent(object) + random.range(0.02, 0.04)) * 1.2;
    let (inner, outer) = (half, half + PLATE);
    let mut builder = Builder::default();
    builder.cuboid([-outer, -outer, -outer], [-inner, outer, outer]);
    for side in [-1.0, 1.0] {
        let (a, b) = (side * inner, side * outer);
        builder.cuboid([-outer, a.min(b), -outer], [outer, a.max(b), outer]);
        builder.cuboid([-outer, -outer, a.min(b)], [outer, outer, a.max(b)]);
        if is_closed {
            let edge = side * ball * random.range(0.6, 0.9);
            builder.cuboid([inner, edge.min(b), -outer], [outer, edge.max(b), outer]);
        }
    }
    Some((builder.finish(), pose, X, Vec::new()))
}
