//! Whether an opening of an object can hold it on a bar of a supporter, by the construction of both.

use super::vector::{V, X, Y, Z, across, add, along, cross, dot, double, length, scale, sub, turn, unit};
use super::{Bar, HangObject, Opening, OpeningKind};
use crate::solid::Solid;

/// Smallest play between an opening and a bar, in radius, m.
const PLAY: f64 = 0.001;
/// Sine of the tilt above which a bar only carries a hollow over its end.
const STEEP: f64 = 0.9;
/// Smallest sine of the tilt of a bar that carries a hollow.
const UPWARD: f64 = 0.35;

/// Whether an opening of the object holds it on a bar: the opening is wider than the bar by 1 mm of play, and the object
/// has room there. Doubtful cases count as no. The further rules are:
///
/// - A hole needs a bar with a free end; a hook goes over any bar.
/// - The clear radius of a hole or hook is reduced by the cosine of the angle between its axis and the bar when the
///   object hangs straight down, and by the cosine of the bar's tilt.
/// - The object hangs by the centre of its opening at the outer end of the bar's usable length, with either face to the
///   wall. No vertex may be behind the wall's plane or below the stand's foot. The object may lean on the wall by up to
///   20°. The bar must be long enough for the thickness of the part that lies on it.
/// - If the bar has a neighbour, every part of the object that is not below the bar must end before the neighbour.
/// - A hollow needs a bar that points up by 20° or more, is a quarter as long as the hollow is deep, and ends as far
///   from the wall as half the radius of the hollow.
/// - A neck needs a gap that is wider than the stem with its play, and narrower than the head by 4 mm on each side.
pub(super) fn holds(object: &HangObject, opening: &Opening, bar: &Bar) -> bool {
    match opening.kind {
        OpeningKind::Hole | OpeningKind::Hook => goes_over(object, opening, centroid(&object.solid), bar),
        OpeningKind::Rim => covers(object, opening, bar),
        OpeningKind::Neck { head_radius } => {
            let (gap, below) = (f64::from(bar.gap), below(object, opening));
            2.0 * (f64::from(opening.clear_radius) + PLAY) < gap
                && 2.0 * f64::from(head_radius) > gap + 0.008
                && bar.has_free_end
                && f64::from(bar.length) > f64::from(head_radius)
                && f64::from(bar.drop) > below
        }
    }
}

/// Extent of the object from the opening against the opening's axis, m.
fn below(object: &HangObject, opening: &Opening) -> f64 {
    let (centre, axis) = (double(opening.centre), double(opening.axis));
    object.solid.vertices.iter().map(|&v| -dot(sub(double(v), centre), axis)).fold(0.0, f64::max)
}

/// Whether a hollow goes over the end of a bar.
fn covers(object: &HangObject, opening: &Opening, bar: &Bar) -> bool {
    // The axis points out of the hollow, so the farthest point against it is the ground of the hollow.
    let depth = below(object, opening);
    bar.has_free_end
        && f64::from(bar.direction[2]) > UPWARD
        && f64::from(opening.clear_radius) > f64::from(bar.pass_radius) + PLAY
        && f64::from(bar.length) > 0.5 * depth
        && bar.wall.is_none_or(|(normal, distance)| {
            let reach = f64::from(distance + bar.length * dot(double(bar.direction), double(normal)) as f32);
            reach > f64::from(opening.clear_radius)
        })
}

/// Whether a hole or hook goes over a bar with room for the object.
fn goes_over(object: &HangObject, opening: &Opening, centroid: V, bar: &Bar) -> bool {
    let direction = double(bar.direction);
    if direction[2].abs() > STEEP || (opening.kind == OpeningKind::Hole && !bar.has_free_end) {
        return false;
    }
    // In the hanging pose the centroid is straight below the opening, and the opening's axis is along the bar seen from
    // above.
    let (centre, axis) = (double(opening.centre), double(opening.axis));
    let mut reach = sub(centroid, centre);
    if length(across(reach, axis)) < 1e-3 * f64::from(opening.clear_radius) {
        // The centroid is on the axis, as in a ring: any direction serves as down.
        reach = across(if axis[0].abs() < 0.7 { X } else { Y }, axis);
    }
    let down = unit(reach);
    let ahead = across(axis, down);
    if length(ahead) < 0.3 {
        return false;
    }
    let (ahead, aside) = (unit(ahead), cross(unit(ahead), down));
    FACES_AND_LEANS.into_iter().any(|(face, lean)| {
        // The bar leaves the wall along the object's `out`. Leaning moves the lower end of the object outwards.
        let [cos, sin] = turn(lean);
        let out = scale(ahead, face);
        let hung =
            [along(scale(out, cos), sin, down), scale(aside, face), along(scale(down, cos), -sin, out)];
        has_room(object, opening, hung, bar)
    })
}

/// Sign of the face that is towards the wall, and angle by which the object leans, degrees.
const FACES_AND_LEANS: [(f64, f64); 6] =
    [(1.0, 0.0), (-1.0, 0.0), (1.0, 10.0), (-1.0, 10.0), (1.0, 20.0), (-1.0, 20.0)];

/// Whether the opening is wide enough for the bar and the object touches neither wall nor foot. The object hangs with
/// the given object directions pointing out from the wall, aside and down.
fn has_room(object: &HangObject, opening: &Opening, [out, aside, down]: [V; 3], bar: &Bar) -> bool {
    let (centre, axis, direction) = (double(opening.centre), double(opening.axis), double(bar.direction));
    let level = length([direction[0], direction[1], 0.0]);
    let clear = f64::from(opening.clear_radius) * dot(axis, out).abs() * level;
    if clear < f64::from(bar.pass_radius) + PLAY {
        return false;
    }
    let vertices = || object.solid.vertices.iter().map(|&v| sub(double(v), centre));
    // The part near the top of the opening lies on the bar, without a bag's other loop.
    let near = 1.3 * f64::from(opening.clear_radius) + 0.003;
    let thickness = vertices()
        .filter(|&v| length(across(v, axis)) < near && dot(v, down) < 0.0)
        .map(|v| 2.0 * dot(v, axis).abs())
        .filter(|&thickness| thickness < 0.06)
        .fold(0.0, f64::max);
    if thickness > 2.0 * f64::from(bar.length) && bar.has_free_end {
        return false;
    }
    let flat = unit([direction[0], direction[1], 0.0]);
    let sideways = cross(flat, Z);
    let lowered = along(scale(direction, f64::from(bar.length)), f64::from(bar.radius) - clear, Z);
    vertices().all(|v| {
        let turned = along(along(scale(flat, dot(v, out)), dot(v, aside), sideways), -dot(v, down), Z);
        let at = add(lowered, turned);
        let is_before_wall =
            bar.wall.is_none_or(|(normal, distance)| dot(at, double(normal)) > -f64::from(distance));
        let is_below_neighbour = bar.gap == 0.0
            || at[2] < lowered[2] + clear - 2.0 * f64::from(bar.radius)
            || dot(at, sideways).abs() < f64::from(bar.gap + bar.radius);
        is_before_wall && is_below_neighbour && at[2] > -f64::from(bar.drop)
    })
}

/// Centroid of the volume. Overlapping bodies count twice.
fn centroid(solid: &Solid) -> V {
    let mut sum = ([0.0; 3], 0.0);
    for t in &solid.triangles {
        let [a, b, c] = t.map(|v| double(solid.vertices[v as usize]));
        let volume = dot(a, cross(b, c));
        sum.0 = along(sum.0, volume / 4.0, [0, 1, 2].map(|i| a[i] + b[i] + c[i]));
        sum.1 += volume;
    }
    sum.0.map(|c| c / sum.1)
}
