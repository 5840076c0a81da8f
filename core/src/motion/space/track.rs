//! What has been learnt from the poses before: how near each part of the supporter may be by now.

use super::travel::Travels;
use crate::hanging::MAX_HUNG;
use crate::mechanics::Support;
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::motion::placement::{Leg, Placement};
use crate::perception::far_side;

/// Lower bounds of the distances of the supporter's patches and groups of patches from the object.
///
/// A search tests poses that are close to each other, one after another. A part that was found at some distance need not be looked at
/// again until the object has travelled that far, whichever way.
pub(in crate::motion) struct Track<'s> {
    /// For each group, how far the object must have travelled, all in all, before anything of it may be touched, metres.
    pub(super) groups: &'s mut [f32],
    /// The same for each patch.
    pub(super) patches: &'s mut [f32],
    /// The same for the scene and for each object that hangs already.
    others: [f32; OTHERS],
    /// The patch that was the nearest, which is likely to be it again.
    pub(super) nearest: usize,
    at: Option<Placement>,
    /// How far the object has travelled, metres: an upper bound for what of it may touch the supporter.
    pub(super) travelled: f32,
    /// The same for what may touch the scene and what hangs already.
    of_others: f32,
}

/// The scene, and what hangs already.
const OTHERS: usize = 1 + MAX_HUNG;
/// Travel after which the counter starts again, metres: single precision still tells hundredths of a millimetre.
const MAX_TRAVEL: f32 = 100.0;

impl<'s> Track<'s> {
    /// Bytes for a supporter of at most `points`.
    pub(super) const fn bytes(points: usize) -> usize {
        let points = far_side::max_points(points);
        array_bytes::<f32>(points).saturating_add(array_bytes::<f32>(Support::max_groups(points)))
    }

    pub(super) fn new(support: &Support, arena: &mut Arena<'s>) -> Result<Self, OutOfMemory> {
        let (groups, patches) = (arena.unset(support.groups.len())?, arena.unset(support.patches.len())?);
        Ok(Self { groups, patches, ..Self::none() })
    }

    /// For what has no distance field.
    pub(super) fn none() -> Self {
        let others = [f32::NEG_INFINITY; OTHERS];
        Self {
            groups: &mut [],
            patches: &mut [],
            others,
            nearest: 0,
            at: None,
            travelled: MAX_TRAVEL,
            of_others: 0.0,
        }
    }

    /// The memory of the patches, for other use: nothing is known of what is near any more.
    pub(super) fn lend(&mut self) -> &mut [u32] {
        self.travelled = MAX_TRAVEL;
        bytemuck::cast_slice_mut(self.patches)
    }

    /// Moves on to a placement; `travels` tells the travels of a leg from the placement before.
    pub(super) fn move_to(&mut self, at: &Placement, travels: impl Fn(&Placement, &Leg) -> Travels) {
        if let Some(before) = self.at {
            let travels = travels(&before, &before.leg_to(at));
            self.travelled += travels.supporter;
            self.of_others += travels.others;
        }
        self.at = Some(*at);
        if self.travelled.max(self.of_others) >= MAX_TRAVEL {
            (self.travelled, self.of_others) = (0.0, 0.0);
            self.groups.fill(f32::NEG_INFINITY);
            self.patches.fill(f32::NEG_INFINITY);
            self.others.fill(f32::NEG_INFINITY);
        }
    }

    /// Whether the scene, 0, or an object that hangs, counted from 1, may be closer than `limit` metres.
    pub(super) fn is_awake(&self, other: usize, limit: f32) -> bool {
        self.bound(other) < limit
    }

    /// Lower bound of the distance of one of these, metres.
    pub(super) fn bound(&self, other: usize) -> f32 {
        self.others.get(other).map_or(f32::NEG_INFINITY, |until| until - self.of_others)
    }

    /// Notes the distance of one of these, metres.
    pub(super) fn note(&mut self, other: usize, distance: f32) {
        if let Some(until) = self.others.get_mut(other) {
            *until = self.of_others + distance;
        }
    }
}
