//! Mug trees of which all branches but one are taken.

use crate::shapes::{Bar, HangObject, OBJECTS, Random, SUPPORTERS, Support, meant};
use hangpose::geometry::{Point, Vector};
use hangpose::mechanics::Kind;

/// Largest extent of a mug with its handle, in distances between the tips of neighbouring pegs; larger mugs are made smaller. It
/// hangs half as far to either side of its peg, so that neighbours have room.
const ROOM: f32 = 0.8;

/// A tree, and a mug that fits for each of its pegs.
pub struct Tree {
    /// The tree.
    pub tree: Support,
    /// The mugs.
    pub mugs: Vec<HangObject>,
    /// Index of the mug that is to be hung.
    pub last: usize,
}

impl Tree {
    /// The tree and the mugs of this seed.
    pub fn new(seed: u64) -> Self {
        let named = |name: &str| OBJECTS.iter().find(|kind| kind.name == name).expect("there are mugs");
        let tree =
            SUPPORTERS.iter().find(|kind| kind.name == "mug tree").expect("there are trees").make(seed);
        let tip = |bar: &Bar| Point::from(bar.position) + Vector::from(bar.direction) * bar.length;
        let apart = |a: &Bar| {
            let others =
                tree.bars.iter().map(|b| (tip(a) - tip(b)).norm()).filter(|distance| *distance > 0.0);
            others.fold(f32::INFINITY, f32::min)
        };
        let nearest = tree.bars.iter().map(apart).fold(f32::INFINITY, f32::min);
        let mugs: Vec<_> = (0..)
            .map(|k| {
                let mug = named("mug").make(seed.wrapping_mul(1009).wrapping_add(k));
                let size = mug.solid.mesh().aabb().extents().max();
                mug.scaled((ROOM * nearest / size).min(1.0))
            })
            .filter(|mug| meant(mug, &tree) == Some(Kind::Threaded))
            .take(tree.bars.len())
            .collect();
        let last = Random::named("free branch", seed).pick(mugs.len());
        Self { tree, mugs, last }
    }
}
