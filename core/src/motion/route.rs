//! A sequence of placements with free ways between them.

use super::placement::{Leg, Placement};
use crate::hanging::Distance;
use crate::memory::{Arena, OutOfMemory, array_bytes};

/// Placements from the start to the goal, in the caller's memory.
pub(super) struct Route<'s> {
    places: &'s mut [Placement],
    /// Least distance from obstacles on the way from each place to the next, metres.
    clearances: &'s mut [f32],
    len: usize,
}

impl<'s> Route<'s> {
    pub(super) const fn bytes(places: usize) -> usize {
        array_bytes::<Placement>(places).saturating_add(array_bytes::<f32>(places))
    }

    pub(super) fn new(places: usize, arena: &mut Arena<'s>) -> Result<Self, OutOfMemory> {
        Ok(Self { places: arena.unset(places)?, clearances: arena.unset(places)?, len: 0 })
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Appends a place, to which the way from the one before has this clearance. Returns false if there is no room.
    pub(super) fn push(&mut self, place: Placement, clearance: f32) -> bool {
        if self.len == self.places.len() {
            return false;
        }
        self.places[self.len] = place;
        self.clearances[self.len.saturating_sub(1)] = clearance;
        self.len += 1;
        true
    }

    /// Drops the last place.
    pub(super) fn pop(&mut self) {
        self.len = self.len.saturating_sub(1);
    }

    pub(super) fn reverse(&mut self) {
        self.places[..self.len].reverse();
        let legs = self.legs();
        self.clearances[..legs].reverse();
    }

    pub(super) fn copy_from(&mut self, other: &Route) {
        debug_assert!(self.places.len() == other.places.len());
        self.len = other.len;
        self.places[..self.len].copy_from_slice(other.places());
        self.clearances[..self.len].copy_from_slice(&other.clearances[..self.len]);
    }

    pub(super) fn places(&self) -> &[Placement] {
        self.places.get(..self.len).unwrap_or_default()
    }

    /// Number of legs.
    pub(super) fn legs(&self) -> usize {
        self.len.saturating_sub(1)
    }

    pub(super) fn leg(&self, index: usize) -> Leg {
        self.places[index].leg_to(&self.places[index + 1])
    }

    /// Least clearance of a range of legs, metres.
    pub(super) fn clearance(&self, legs: core::ops::Range<usize>) -> f32 {
        self.clearances.get(legs).unwrap_or_default().iter().copied().fold(f32::INFINITY, f32::min)
    }

    /// Replaces the places after `first` and up to `last` by `between`, none or a few of them with the clearances of the ways to
    /// them and, last, of the way on. Returns false, and changes nothing, if there is no room.
    pub(super) fn replace(
        &mut self,
        first: usize,
        last: usize,
        between: &[Placement],
        clearances: &[f32],
    ) -> bool {
        let tail = self.len - last;
        let at = first + 1 + between.len();
        if at + tail > self.places.len() {
            return false;
        }
        self.places.copy_within(last..self.len, at);
        self.clearances.copy_within(last..self.len, at);
        debug_assert!(between.len() + 1 == clearances.len() && first + clearances.len() == at);
        for (to, from) in self.places[first + 1..at].iter_mut().zip(between) {
            *to = *from;
        }
        for (to, from) in self.clearances[first..at].iter_mut().zip(clearances) {
            *to = *from;
        }
        self.len = at + tail;
        true
    }
}

/// Parts of equal length into which a leg is cut so that none is longer than `step`.
pub(super) fn parts(leg: &Leg, step: &Distance) -> usize {
    let parts = (leg.shift.norm() / step.position).max(leg.turn.norm() / step.rotation);
    libm::ceilf(parts - 1e-4).max(1.0) as usize
}
