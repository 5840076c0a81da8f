//! The supporter as mechanics sees it: points that stand for patches of its surface.

use super::fit::fit_patch;
use super::patch::Patch;
use crate::geometry::{Aabb, Neighbour, Point, PointTree, Vector};
use crate::memory::{Arena, OutOfMemory, array_bytes};
use bytemuck::{Pod, Zeroable};
use core::ops::Range;

/// A supporter that stands still, in its own coordinates.
#[derive(Clone, Copy)]
pub(crate) struct Support<'a> {
    pub(crate) tree: PointTree<'a>,
    /// What the points stand for, of those that no other stands for, in tree order,
    pub(crate) patches: &'a [Patch],
    /// and which these are.
    pub(crate) representatives: &'a [u32],
    pub(crate) groups: &'a [Group],
    /// How far a patch reaches from its point at most, metres.
    pub(crate) reach: f32,
}

/// Some patches, close to each other.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Group {
    first: u32,
    count: u32,
    pub(crate) centre: Point,
    /// What holds all of them, metres.
    pub(crate) radius: f32,
}

impl Group {
    /// So many make a group, at most.
    const MOST: usize = 8;

    pub(crate) fn patches(&self) -> Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// Memory for the patches of a supporter.
pub(crate) struct Room<'a> {
    patches: &'a mut [Patch],
    representatives: &'a mut [u32],
    groups: &'a mut [Group],
}

impl<'a> Room<'a> {
    /// Bytes for the patches of so many points.
    pub(crate) const fn bytes(points: usize) -> usize {
        array_bytes::<Patch>(points).saturating_add(array_bytes::<u32>(points)).saturating_add(array_bytes::<
            Group,
        >(
            Support::most_groups(points),
        ))
    }

    /// For so many points.
    pub(crate) fn new(points: usize, arena: &mut Arena<'a>) -> Result<Self, OutOfMemory> {
        Ok(Self {
            patches: arena.slice(points)?,
            representatives: arena.slice(points)?,
            groups: arena.slice(Support::most_groups(points))?,
        })
    }
}

impl<'a> Support<'a> {
    /// How many things may sleep where there are so many points.
    pub(crate) const fn sleepers(points: usize) -> usize {
        points + Self::most_groups(points)
    }

    const fn most_groups(points: usize) -> usize {
        points.div_ceil(Group::MOST)
    }

    /// Where a patch is.
    pub(crate) fn place(&self, patch: usize) -> Point {
        self.tree.points()[self.representatives[patch] as usize]
    }

    /// Where all of them are.
    pub(crate) fn places(&self) -> impl Iterator<Item = Point> + 'a {
        let points = self.tree.points();
        self.representatives.iter().map(move |&index| points[index as usize])
    }

    /// The patches of some points.
    pub(crate) fn patches_of(&self, points: &Range<usize>) -> Range<usize> {
        let before = |limit: usize| self.representatives.partition_point(|&index| (index as usize) < limit);
        before(points.start)..before(points.end)
    }
}

/// Points closer than this to one that looks the same way add nothing to where things rest, metres.
const REPRESENTATIVES_APART: f32 = 0.0025;
/// ... that is, whose normals have this cosine: about 25 degrees.
const SAME_WAY: f32 = 0.9;

impl<'a> Support<'a> {
    /// Without patches: nothing can touch it.
    pub(crate) fn bare(tree: PointTree<'a>) -> Self {
        Self { tree, patches: &[], representatives: &[], groups: &[], reach: 0.0 }
    }

    /// Bytes of working memory for [`fit`](Self::fit).
    pub(crate) const fn scratch_bytes(points: usize) -> usize {
        array_bytes::<u8>(points)
    }

    /// Chooses points so that every other has one near it that looks the same way, and fits their patches. `normals` are in tree order.
    pub(crate) fn fit(
        tree: PointTree<'a>,
        normals: &[Vector],
        room: Room<'a>,
        mut scratch: Arena,
    ) -> Result<Self, OutOfMemory> {
        let (points, Room { patches, representatives, groups }) = (tree.points(), room);
        let is_covered = scratch.slice::<u8>(points.len())?;
        let spacing = spacing(&tree);
        let apart = spacing.max(REPRESENTATIVES_APART);
        let mut count = 0;
        for index in 0..points.len() {
            if is_covered[index] > 0 {
                continue;
            }
            tree.for_each_within(&points[index], REPRESENTATIVES_APART, |neighbour| {
                let other = neighbour.index as usize;
                if normals[other].dot(&normals[index]) > SAME_WAY {
                    is_covered[other] = 1;
                }
            });
            patches[count] = fit_patch(&tree, normals, index, apart, spacing);
            representatives[count] = index as u32;
            count += 1;
        }
        let (patches, representatives) = (&patches[..count], &representatives[..count]);
        let groups = &mut groups[..count.div_ceil(Group::MOST)];
        let members = patches.chunks(Group::MOST).zip(representatives.chunks(Group::MOST));
        for (k, (group, (patches, representatives))) in groups.iter_mut().zip(members).enumerate() {
            let places = || representatives.iter().map(|&index| &points[index as usize]);
            let centre = Aabb::of(places()).centre();
            let reach = |(place, patch): (&Point, &Patch)| (place - centre).norm() + patch.reach();
            let radius = places().zip(patches).map(reach).fold(0.0, f32::max);
            *group = Group { first: (k * Group::MOST) as u32, count: patches.len() as u32, centre, radius };
        }
        let reach = patches.iter().map(Patch::reach).fold(0.0, f32::max);
        Ok(Self { tree, patches, representatives, groups, reach })
    }
}

/// The distance at which points have their fourth neighbour, as the median of some, metres.
fn spacing(tree: &PointTree) -> f32 {
    const PROBES: usize = 64;
    let points = tree.points();
    let mut distances = [0.0; PROBES];
    for (k, distance) in distances.iter_mut().enumerate() {
        let mut found = [Neighbour::default(); 5];
        let found = tree.k_nearest(&points[k * points.len() / PROBES], &mut found);
        *distance = found.last().map_or(0.0, |neighbour| libm::sqrtf(neighbour.distance_squared));
    }
    distances.sort_unstable_by(f32::total_cmp);
    distances[PROBES / 2]
}
