//! Points that say the same as others: duplicates, and more points than the mechanics can tell apart.

use super::cubes::{cube, hash};
use super::planes;
use super::surroundings::Surroundings;
use crate::geometry::{Point, Vector, unit_or};
use crate::memory::{Arena, OutOfMemory, array_bytes, larger};
use crate::monitor::{Meter, Stop, Unfinished};

/// Edge of the cubes within which the points of a dense cloud are merged, metres: less than half of the distance between
/// the patches that the mechanics fits, and about the noise of a good depth camera.
const CUBE: f32 = 0.001;
/// Edge of the cubes within which the points on a large plane are merged, metres. Nothing hangs there, and a plane needs few
/// points to stop an object, as patches follow the spacing. With 1 cm a room of 300,000 points takes 1.4 times as long (`speed
/// growth`); with 2 cm, of a cloud without normals 13 instead of 5 % of the contacts get a wrong one (`cargo test -p host-tests
/// --test normals`).
const PLANE_CUBE: f32 = 0.0125;
/// The same at the rim of a plane, metres: the mean of the points that are merged is off the rim by half as much. A path may be off by a
/// millimetre (`make reach`: with [`PLANE_CUBE`] the base of a mug tree ended up to 2 mm early).
const RIM_CUBE: f32 = 0.003;
/// The same, far from all that is not on a plane.
const FAR_CUBE: f32 = 0.05;
/// Keep the cubes of planes apart from others.
const PLANE_TAG: u32 = 1 << 31;
const FAR_TAG: u32 = 1 << 30;
const RIM_TAG: u32 = 1 << 29;
/// Points per occupied cube above which a cloud is dense.
const DENSE: usize = 2;

/// The points that are left, in the order of the first point of each.
pub(super) struct Kept<'s> {
    /// Mean of the merged points, metres.
    pub(super) points: &'s mut [Point],
    /// Unit normals, zero where unknown.
    pub(super) normals: &'s mut [Vector],
    /// Index of the first of the merged points in the caller's cloud.
    pub(super) names: &'s mut [u32],
    /// 1 for points on large planes.
    pub(super) is_on_plane: &'s mut [u8],
}

/// Bytes of what is kept of a cloud of `points`.
pub(super) const fn bytes(points: usize) -> usize {
    array_bytes::<Point>(points)
        .saturating_add(array_bytes::<Vector>(points))
        .saturating_add(array_bytes::<u32>(points))
        .saturating_add(array_bytes::<u8>(points))
}

/// Bytes of working memory of [`merge`].
pub(super) const fn scratch_bytes(points: usize) -> usize {
    array_bytes::<u32>(table_size(points))
        .saturating_add(array_bytes::<u32>(points))
        .saturating_add(array_bytes::<Point>(points))
        .saturating_add(array_bytes::<u8>(points))
        .saturating_add(larger(planes::scratch_bytes(), Surroundings::BYTES))
}

/// Entries of the hash table, of which at most half are in use.
const fn table_size(points: usize) -> usize {
    points.saturating_mul(2).saturating_add(1)
}

/// Merges the points at the same place; in a dense cloud and on large planes, those in the same cube. Points whose known normals differ by
/// more than 90 degrees, as those on the two sides of a sheet, stay apart.
pub(super) fn merge<'s>(
    points: &[Point],
    normals: &[Vector],
    arena: &mut Arena<'s>,
    meter: &Meter,
) -> Result<Kept<'s>, Unfinished> {
    let Kept { points: sums, normals: normal_sums, names, is_on_plane } = Kept::new(points.len(), arena)?;
    let mut scratch = arena.scratch();
    let table = scratch.unset::<u32>(table_size(points.len()))?;
    let members = scratch.slice::<u32>(points.len())?;
    let firsts = scratch.unset::<Point>(points.len())?;
    let on_plane = scratch.slice::<u8>(points.len())?;
    planes::mark(points, on_plane, scratch.scratch(), meter)?;
    let near = Surroundings::of(
        points.iter().zip(&*on_plane).filter(|(_, on)| **on == 0).map(|(point, _)| point),
        &mut scratch,
        meter,
    )?;
    let cubes = group(normals, |index| cube(&points[index], CUBE), table, names, meter, |_, _| {})?;
    let is_dense = points.len() > DENSE * cubes;
    let place = |index: usize| {
        let point = &points[index];
        let tagged = |edge: f32, tag: u32| cube(point, edge).map(|x| x ^ tag);
        match (on_plane[index], is_dense) {
            (planes::INSIDE, _) if near.has(point) => tagged(PLANE_CUBE, PLANE_TAG),
            (planes::RIM, _) if near.has(point) => tagged(RIM_CUBE, RIM_TAG),
            (planes::INSIDE | planes::RIM, _) => tagged(FAR_CUBE, FAR_TAG),
            (_, true) => cube(point, CUBE),
            (_, false) => bits(point),
        }
    };
    // Sums of offsets from the first point, which keep their precision.
    let count = group(normals, place, table, names, meter, |index, kept| {
        if members[kept] == 0 {
            (firsts[kept], is_on_plane[kept]) = (points[index], u8::from(on_plane[index] > 0));
            (sums[kept], normal_sums[kept]) = (Point::origin(), normals[index]);
        } else {
            sums[kept] += points[index] - firsts[kept];
            normal_sums[kept] += normals[index];
        }
        members[kept] += 1;
    })?;
    for k in 0..count {
        meter.check_at(k)?;
        sums[k] = firsts[k] + sums[k].coords / members[k] as f32;
        if members[k] > 1 {
            normal_sums[k] = unit_or(normal_sums[k], Vector::zeros());
        }
    }
    Ok(Kept { points: sums, normals: normal_sums, names, is_on_plane }.first(count))
}

impl<'s> Kept<'s> {
    fn new(points: usize, arena: &mut Arena<'s>) -> Result<Self, OutOfMemory> {
        Ok(Self {
            points: arena.unset(points)?,
            normals: arena.unset(points)?,
            names: arena.unset(points)?,
            is_on_plane: arena.slice(points)?,
        })
    }

    /// The first `count` points.
    fn first(self, count: usize) -> Self {
        Self {
            points: &mut self.points[..count],
            normals: &mut self.normals[..count],
            names: &mut self.names[..count],
            is_on_plane: &mut self.is_on_plane[..count],
        }
    }

    /// All points as they are.
    pub(super) fn all(
        points: &[Point],
        normals: &[Vector],
        arena: &mut Arena<'s>,
    ) -> Result<Self, OutOfMemory> {
        let kept = Self::new(points.len(), arena)?;
        for (to, from) in kept.points.iter_mut().zip(points) {
            *to = *from;
        }
        for (to, from) in kept.normals.iter_mut().zip(normals) {
            *to = *from;
        }
        for (name, index) in kept.names.iter_mut().zip(0..) {
            *name = index;
        }
        Ok(kept)
    }
    /// The points that are not flagged.
    pub(super) fn without(self, is_dropped: &[u8]) -> Self {
        let mut count = 0;
        for index in (0..is_dropped.len()).filter(|&index| is_dropped[index] == 0) {
            self.points[count] = self.points[index];
            self.normals[count] = self.normals[index];
            self.names[count] = self.names[index];
            self.is_on_plane[count] = self.is_on_plane[index];
            count += 1;
        }
        self.first(count)
    }
}

/// Groups the points by place, calls `visit` with the index of each point and of its group, writes the first point of each
/// group to `firsts`, and returns the number of groups.
fn group(
    normals: &[Vector],
    place: impl Fn(usize) -> [u32; 3],
    table: &mut [u32],
    firsts: &mut [u32],
    meter: &Meter,
    mut visit: impl FnMut(usize, usize),
) -> Result<usize, Stop> {
    table.fill(0);
    let mut count = 0_usize;
    for (index, normal) in normals.iter().enumerate() {
        meter.check_at(index)?;
        let key = place(index);
        // The hash scaled to the length of the table.
        let mut slot = ((u64::from(hash(key)) * table.len() as u64) >> 32) as usize;
        let group = loop {
            let Some(group) = (table[slot] as usize).checked_sub(1) else {
                count += 1;
                table[slot] = count as u32;
                firsts[count - 1] = index as u32;
                break count - 1;
            };
            let first = firsts[group] as usize;
            if place(first) == key && normals[first].dot(normal) >= 0.0 {
                break group;
            }
            slot = if slot + 1 < table.len() { slot + 1 } else { 0 };
        };
        visit(index, group);
    }
    Ok(count)
}

/// The very place of a point. Zero has two representations.
fn bits(point: &Point) -> [u32; 3] {
    [point.x, point.y, point.z].map(|x| (x + 0.0).to_bits())
}
