//! From the points that a camera or a file gives to those that are surface: duplicates are merged, strays dropped, and walls
//! and tables told apart from what things hang on.

mod cubes;
mod merge;
mod planes;
pub(crate) mod spacing;
mod strays;
mod surroundings;

use crate::geometry::{Point, PointTreeSlots, Pose, Vector};
use crate::memory::{Arena, array_bytes, larger};
use crate::monitor::{Meter, Unfinished};
use merge::Kept;

/// Bytes of what is kept of a cloud of `points`.
pub(crate) const fn bytes(points: usize) -> usize {
    array_bytes::<Vector>(points)
        .saturating_add(array_bytes::<f32>(points))
        .saturating_add(array_bytes::<u8>(points).saturating_mul(2))
}

/// Bytes of working memory for a cloud of `points`.
pub(crate) const fn scratch_bytes(points: usize) -> usize {
    merge::bytes(points).saturating_add(larger(merge::scratch_bytes(points), strays::scratch_bytes(points)))
}

/// The points of a cloud that are left, without duplicates and strays, in the order of its tree.
pub(crate) struct Cleaned<'s> {
    /// Unit normals, zero where none was given.
    pub(crate) normals: &'s mut [Vector],
    /// Distance between points around each point, metres; zero in a cloud that is taken as it is, until
    /// [`spacing::measure`] measures it.
    pub(crate) spacings: &'s mut [f32],
    /// 1 for points on which nothing hangs: at first those on large planes, as walls and tables.
    pub(crate) is_excluded: &'s mut [u8],
    /// 1 for points that were not seen but guessed: at first none.
    pub(crate) is_guessed: &'s [u8],
    pub(crate) counts: CleaningCounts,
}

/// What was done to the points of a cloud.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CleaningCounts {
    /// Points that were merged with others: at the same place or, in a cloud of more than two points a cubic millimetre,
    /// in the same one.
    pub merged: usize,
    /// Points that were dropped as strays: alone in the air, or in a speck.
    pub strays: usize,
    /// Points left on large planes, as walls and tables: an object may collide with them, but not hang there.
    pub on_planes: usize,
}

/// Merges and drops points, unless the cloud is to be taken as it is, and fills `slots` with those that are left, at least
/// one, moved by `frame` and named by their indices in `points`. `normals` are of unit length in that frame, or zero where unknown.
pub(crate) fn clean<'s>(
    (points, frame): (&[Point], &Pose),
    normals: &[Vector],
    is_taken_as_it_is: bool,
    slots: &mut PointTreeSlots,
    arena: &mut Arena<'s>,
    meter: &Meter,
) -> Result<Cleaned<'s>, Unfinished> {
    let (normals_kept, spacings) = (arena.unset::<Vector>(points.len())?, arena.slice::<f32>(points.len())?);
    let (is_excluded, is_guessed) = (arena.unset::<u8>(points.len())?, arena.slice::<u8>(points.len())?);
    let mut scratch = arena.scratch();
    let moved = slots.lend(points.len());
    for (step, (to, from)) in moved.iter_mut().zip(points).enumerate() {
        meter.check_at(step)?;
        *to = frame * from;
    }
    let points = &*moved;
    let mut kept = match is_taken_as_it_is {
        true => Kept::all(points, normals, &mut scratch)?,
        false => merge::merge(points, normals, &mut scratch, meter)?,
    };
    let merged = points.len() - kept.points.len();
    let mut counts = CleaningCounts { merged, ..CleaningCounts::default() };
    slots.fill(kept.points, meter)?;
    if !is_taken_as_it_is {
        let spacings = &mut spacings[..kept.points.len()];
        let is_stray = strays::find(&slots.tree(), spacings, kept.is_on_plane, &mut scratch, meter)?;
        counts.strays = is_stray.iter().filter(|flag| **flag > 0).count();
        if counts.strays > 0 {
            kept = kept.without(is_stray);
            slots.fill(kept.points, meter)?;
            spacing::measure(&slots.tree(), &mut spacings[..kept.points.len()], meter)?;
        }
    }
    let count = kept.points.len();
    let (normals, spacings) = (&mut normals_kept[..count], &mut spacings[..count]);
    let (is_excluded, is_guessed) = (&mut is_excluded[..count], &is_guessed[..count]);
    let places = normals.iter_mut().zip(is_excluded.iter_mut()).zip(slots.tree().order());
    for (step, ((normal, is_excluded), &index)) in places.enumerate() {
        meter.check_at(step)?;
        *normal = kept.normals[index as usize];
        *is_excluded = kept.is_on_plane[index as usize];
    }
    counts.on_planes = is_excluded.iter().filter(|flag| **flag > 0).count();
    slots.rename(kept.names);
    Ok(Cleaned { normals, spacings, is_excluded, is_guessed, counts })
}

#[cfg(test)]
mod tests;
