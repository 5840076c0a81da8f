//! Whether an object can hang on a supporter, marked from how the two were made.

use super::vector::{V, Z, across, along, cross, dot, double, length, sub, unit};
use super::{Bar, HangObject, Opening, OpeningKind, Support};
use crate::solid::Solid;

/// How much wider than the bar an opening must be, metres.
const PLAY: f64 = 0.001;
/// A bar this steep (sine of its tilt) only carries what is put over its end.
const STEEP: f64 = 0.9;
/// A bar must point up at least this much (sine) to hold a hollow.
const UPWARD: f64 = 0.35;

/// Whether the object can hang on the supporter: some opening is wider than some bar by 1 mm of play, and there is
/// room for it. It errs towards no. The rules, besides:
///
/// - a hole goes only over a free end, a hook over any bar;
/// - a hole's or hook's widest bar is shortened by the cosine of the angle at which the bar crosses it when the object
///   hangs straight down from it, and by that of the bar's tilt;
/// - hung so, by its opening's middle at the outer end of the bar's usable length and with either face to the wall, no
///   vertex of it is behind the wall's plane or below the stand's foot, and the bar is long enough for the
///   thickness of what lies on it;
/// - a hollow needs a bar that points up by 20° or more and reaches half way to its ground;
/// - a neck needs a gap that it passes and its head does not, by 4 mm on each side.
pub fn fits(object: &HangObject, support: &Support) -> bool {
    let centroid = centroid(&object.solid);
    let pairs = object.openings.iter().flat_map(|o| support.bars.iter().map(move |b| (o, b)));
    pairs.into_iter().any(|(opening, bar)| match opening.kind {
        OpeningKind::Hole | OpeningKind::Hook => goes_over(object, opening, centroid, bar),
        OpeningKind::Rim => covers(object, opening, bar),
        OpeningKind::Neck { head_radius } => {
            let (gap, below) = (f64::from(bar.gap), below(object, opening));
            2.0 * (f64::from(opening.clear_radius) + PLAY) < gap
                && 2.0 * f64::from(head_radius) > gap + 0.008
                && bar.has_free_end
                && f64::from(bar.length) > f64::from(head_radius)
                && f64::from(bar.drop) > below
        }
    })
}

/// How far the object reaches from the opening against its axis.
fn below(object: &HangObject, opening: &Opening) -> f64 {
    let (centre, axis) = (double(opening.centre), double(opening.axis));
    object.solid.vertices.iter().map(|&v| -dot(sub(double(v), centre), axis)).fold(0.0, f64::max)
}

fn covers(object: &HangObject, opening: &Opening, bar: &Bar) -> bool {
    // The axis points out of the hollow, so that its ground is where the object reaches furthest against it.
    let depth = below(object, opening);
    bar.has_free_end
        && f64::from(bar.direction[2]) > UPWARD
        && f64::from(opening.clear_radius) > f64::from(bar.pass_radius) + PLAY
        && f64::from(bar.length) > 0.5 * depth
}

fn goes_over(object: &HangObject, opening: &Opening, centroid: V, bar: &Bar) -> bool {
    let direction = double(bar.direction);
    if direction[2].abs() > STEEP || (opening.kind == OpeningKind::Hole && !bar.has_free_end) {
        return false;
    }
    // As it hangs: the centroid straight below the opening, the opening's axis along the bar as seen from above.
    let (centre, axis) = (double(opening.centre), double(opening.axis));
    let reach = sub(centroid, centre);
    if length(reach) < 1e-6 || length(across(axis, unit(reach))) < 0.3 {
        return false;
    }
    let down = unit(reach);
    let ahead = unit(across(axis, down));
    let aside = cross(ahead, down);
    let clear =
        f64::from(opening.clear_radius) * dot(axis, ahead).abs() * length([direction[0], direction[1], 0.0]);
    if clear < f64::from(bar.pass_radius) + PLAY {
        return false;
    }
    let flat = unit([direction[0], direction[1], 0.0]);
    let lower = clear - f64::from(bar.radius);
    let place = along(double(bar.position), f64::from(bar.length), direction);
    // What lies on the bar is what is near the top of the opening.
    let vertices = || object.solid.vertices.iter().map(|&v| sub(double(v), centre));
    let thickness = vertices()
        .filter(|&v| {
            length(across(v, axis)) < 1.3 * f64::from(opening.clear_radius) + 0.003 && dot(v, down) < 0.0
        })
        .map(|v| 2.0 * dot(v, ahead).abs())
        .fold(0.0, f64::max);
    if opening.kind == OpeningKind::Hole && thickness > 2.0 * f64::from(bar.length) {
        return false;
    }
    [-1.0, 1.0].iter().any(|&face| {
        vertices().all(|v| {
            let sideways = along([0.0; 3], face * dot(v, aside), cross(flat, Z));
            let hung = along(along(sideways, face * dot(v, ahead), flat), -dot(v, down) - lower, Z);
            let at = sub(along(hung, 1.0, place), double(bar.position));
            let is_before_wall =
                bar.wall.is_none_or(|(normal, distance)| dot(at, double(normal)) > -f64::from(distance));
            is_before_wall && at[2] > -f64::from(bar.drop)
        })
    })
}

/// The middle of the volume; where bodies overlap it counts twice.
pub(crate) fn centroid(solid: &Solid) -> V {
    let mut sum = ([0.0; 3], 0.0);
    for t in &solid.triangles {
        let [a, b, c] = t.map(|v| double(solid.vertices[v as usize]));
        let volume = dot(a, cross(b, c));
        sum.0 = along(sum.0, volume / 4.0, [0, 1, 2].map(|i| a[i] + b[i] + c[i]));
        sum.1 += volume;
    }
    sum.0.map(|c| c / sum.1)
}
