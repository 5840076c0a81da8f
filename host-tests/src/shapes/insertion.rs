//! Whether an object can be brought to the pose in which it hangs, by the construction of both.

use super::vector::{dot, double};
use super::{Bar, Joint, Opening, OpeningKind};
use crate::solid::Solid;
use serde::{Deserialize, Serialize};

/// Whether there is a way of an object to the pose in which it hangs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Insertion {
    /// There is.
    Possible,
    /// There is none, since object and supporter are linked or one encloses the other.
    Impossible,
    /// The construction does not tell.
    Unknown,
}

/// Distance from the ends of a supporter within which a bar without a free end may still have a stub, m.
const END: f64 = 0.05;

/// Whether there is a way to a pose with these joints, the first of the kind that people prefer. `is_closed` says whether a wall closes
/// the loop of every bar without a free end.
///
/// - A closed hole comes over the free end of a bar if the end is not wider than the hole. A wider end may pass a hole that
///   is longer in one direction, which is not told. Nor is it of a wire that has no bar, as the bracket that carries a carabiner.
/// - Holes over several bars must come off all of them at once, which is not told.
/// - A closed hole around a bar without a free end is linked with it. Without a wall, it may come over the plates at its
///   ends, which is not told.
/// - A hook comes from its open side over a wire that is thinner than its mouth. A thicker one cannot pass the mouth, and whether the
///   hook comes over an end of it is not told.
/// - Everything else comes from the open side: a hollow over the end, a neck between two free ends, and what lies on top from
///   above.
pub fn insertion(
    joints: &[Joint],
    openings: &[Opening],
    (supporter, bars): (&Solid, &[Bar]),
    is_closed: bool,
) -> Insertion {
    let Some(joint) = joints.first() else { return Insertion::Possible };
    let mut holes = joints.iter().filter(|joint| openings[joint.opening].kind == OpeningKind::Hole);
    if holes.any(|other| other.bar != joint.bar) {
        return Insertion::Unknown;
    }
    let (opening, bar) = (&openings[joint.opening], &bars[joint.bar]);
    match opening.kind {
        OpeningKind::Hole if bar.has_free_end => {
            if joint.is_on_bar && opening.clear_radius > bar.pass_radius {
                Insertion::Possible
            } else {
                Insertion::Unknown
            }
        }
        OpeningKind::Hole => {
            let direction = double(bar.direction);
            let along = |v: [f32; 3]| dot(double(v), direction);
            let at = along(joint.at);
            let ends = supporter.vertices.iter().map(|&vertex| along(vertex) - at);
            let (low, high) = ends.fold((0.0_f64, 0.0_f64), |(low, high), s| (low.min(s), high.max(s)));
            let is_between = low < -END && high > END;
            if is_closed && is_between { Insertion::Impossible } else { Insertion::Unknown }
        }
        OpeningKind::Hook if joint.wire_radius.is_some_and(|radius| radius >= opening.clear_radius) => {
            Insertion::Unknown
        }
        OpeningKind::Hook | OpeningKind::Rim | OpeningKind::Neck { .. } => Insertion::Possible,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{OBJECTS, SUPPORTERS};
    use hangpose::mechanics::Kind;

    #[test]
    fn a_hole_comes_off_one_bar_and_may_not_come_off_two() {
        let tree = SUPPORTERS.iter().find(|kind| kind.name == "mug tree").unwrap().make(1);
        let bag = OBJECTS.iter().find(|kind| kind.name == "bag").unwrap().make(1);
        let holes = bag.openings.iter().zip(0..).filter(|(opening, _)| opening.kind == OpeningKind::Hole);
        let on = |bars: [usize; 2]| -> Vec<Joint> {
            let holes = holes.clone().zip(bars);
            holes
                .map(|((_, opening), bar)| Joint {
                    kind: Kind::Threaded,
                    opening,
                    bar,
                    is_on_bar: true,
                    wire_radius: Some(tree.bars[bar].radius),
                    at: tree.bars[bar].position,
                })
                .collect()
        };
        let told = |joints: &[Joint]| insertion(joints, &bag.openings, (&tree.solid, &tree.bars), false);
        assert_eq!(on([0, 0]).len(), 2);
        assert_eq!(told(&on([0, 0])), Insertion::Possible);
        assert_eq!(told(&on([0, 1])), Insertion::Unknown);
        assert_eq!(told(&[]), Insertion::Possible);
    }

    #[test]
    fn a_hook_comes_over_a_wire_that_is_thinner_than_its_mouth() {
        let supporter = SUPPORTERS.iter().find(|kind| kind.name == "S hook").unwrap().make(1);
        let hanger = OBJECTS.iter().find(|kind| kind.name == "clothes hanger").unwrap().make(1);
        let hook = hanger.openings.iter().position(|opening| opening.kind == OpeningKind::Hook).unwrap();
        let clear = hanger.openings[hook].clear_radius;
        let told = |radius: f32| {
            let joint = Joint {
                kind: Kind::Hooked,
                opening: hook,
                bar: 0,
                is_on_bar: false,
                wire_radius: Some(radius),
                at: supporter.bars[0].position,
            };
            insertion(&[joint], &hanger.openings, (&supporter.solid, &supporter.bars), false)
        };
        assert_eq!(told(0.99 * clear), Insertion::Possible);
        assert_eq!(told(1.01 * clear), Insertion::Unknown);
    }
}
