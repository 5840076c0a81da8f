//! The supporter in the simulation: surface patches at representative points of its cloud.

use super::constants::{
    GROUP_SIZE, REPRESENTATIVE_COSINE, REPRESENTATIVE_SPACING, SPACING_NEIGHBOURS, SPACING_PROBES,
    SPACING_RATIO,
};
use super::fit::Surroundings;
use super::patch::Patch;
use crate::geometry::{
    Aabb, Nearest, Neighbour, Point, PointTree, Pose, Vector, principal_direction, unit_or,
};
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Unfinished};
use bytemuck::{Pod, Zeroable};
use core::ops::Range;

/// Radius around a contact in which the direction of the bar is estimated where the surface there is flat, metres: more than a
/// bar's thickness, less than its length.
const BAR_RADIUS: f32 = 0.02;
/// Least cosine between a bar and the normal of a surface that is across its way: bars lean by 60 degrees at most. The sides of a
/// bent bar are at a smaller angle to its way on.
const ACROSS: f32 = 0.45;

/// Distance of neighbours in a plane that was thinned, metres: the diagonal of a cube of which one point is kept near what may hang
/// (`PLANE_CUBE` in `perception/cleaning/merge.rs`, 12.5 mm), and a bit. Farther away there is nothing that a loop could hang on.
const PLANE_RANGE: f32 = 0.02;
/// Neighbours in a plane above which it was not thinned.
const MAX_IN_PLANE: usize = 16;
/// Largest height of a neighbour above the plane of a patch, as a share of its distance. Normals beside a bar are off by 10 degrees.
const IN_PLANE: f32 = 0.2;

/// A fixed supporter in its frame, here as in all of the mechanics called supporter coordinates.
#[derive(Clone, Copy)]
pub(crate) struct Support<'a> {
    /// All points of the cloud.
    pub(crate) tree: PointTree<'a>,
    /// Patches of the representatives, in tree order.
    pub(crate) patches: &'a [Patch],
    /// Indices of the representatives in the tree, ascending; one per patch.
    pub(crate) representatives: &'a [u32],
    /// Groups of consecutive patches, which cover all patches.
    pub(crate) groups: &'a [Group],
    /// Largest distance from the point of a patch to the patch's corners, metres.
    pub(crate) reach: f32,
    /// From the caller's supporter coordinates to these.
    pub(crate) frame: Pose,
}

/// Consecutive patches, close to each other, with a bounding sphere.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Group {
    first: u32,
    count: u32,
    /// Centre of the bounding sphere, supporter coordinates, metres.
    pub(crate) centre: Point,
    /// Radius of the bounding sphere, metres.
    pub(crate) radius: f32,
}

impl Group {
    /// Indices of the patches.
    pub(crate) fn patches(&self) -> Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// Memory for the patches and groups of a supporter.
pub(crate) struct Room<'a> {
    patches: &'a mut [Patch],
    representatives: &'a mut [u32],
    groups: &'a mut [Group],
}

impl<'a> Room<'a> {
    /// Bytes of memory for a cloud of `points` points.
    pub(crate) const fn bytes(points: usize) -> usize {
        array_bytes::<Patch>(points).saturating_add(array_bytes::<u32>(points)).saturating_add(array_bytes::<
            Group,
        >(
            Support::max_groups(points),
        ))
    }

    /// Allocates memory for a cloud of `points` points.
    pub(crate) fn new(points: usize, arena: &mut Arena<'a>) -> Result<Self, OutOfMemory> {
        Ok(Self {
            patches: arena.unset(points)?,
            representatives: arena.unset(points)?,
            groups: arena.unset(Support::max_groups(points))?,
        })
    }
}

impl<'a> Support<'a> {
    /// Number of patches and groups of a supporter of so many patches: the length of the working memory of
    /// [`Sleep`](super::Sleep).
    pub(crate) const fn sleepers(patches: usize) -> usize {
        patches.saturating_add(Self::max_groups(patches))
    }

    /// Most groups of the patches of `points` points.
    pub(crate) const fn max_groups(points: usize) -> usize {
        points.div_ceil(GROUP_SIZE)
    }

    /// Position of a patch, supporter coordinates, metres.
    pub(crate) fn position(&self, patch: usize) -> Point {
        self.tree.points()[self.representatives[patch] as usize]
    }

    /// Positions of all patches, supporter coordinates, metres.
    pub(crate) fn positions(&self) -> impl Iterator<Item = Point> + 'a {
        let points = self.tree.points();
        self.representatives.iter().map(move |&index| points[index as usize])
    }

    /// Positions of the patches that no viewpoint saw and that were guessed, supporter coordinates, metres.
    pub(crate) fn guessed(&self) -> impl Iterator<Item = Point> + 'a {
        self.positions().zip(self.patches).filter(|(_, patch)| patch.is_guessed()).map(|(point, _)| point)
    }

    /// Positions and unit normals of the patches on which something may hang, supporter coordinates, metres.
    pub(crate) fn hangable_surface(&self) -> impl Iterator<Item = (&'a Point, &'a Vector)> {
        let (points, patches) = (self.tree.points(), self.patches.iter());
        let surface = self.representatives.iter().map(move |&index| &points[index as usize]).zip(patches);
        surface
            .filter(|(_, patch)| patch.ends & Patch::EXCLUDED == 0)
            .map(|(point, patch)| (point, &patch.normal))
    }

    /// Distance from a place on the surface within which four points are, metres: how far apart the points are there. With fewer
    /// points infinite.
    pub(crate) fn spacing_at(&self, place: &Point) -> f32 {
        let mut found = [Neighbour::default(); 4];
        let nearest = self.tree.k_nearest(place, &mut found);
        nearest.get(3).map_or(f32::INFINITY, |last| libm::sqrtf(last.distance_squared))
    }

    /// The same at the point that is nearest to a place.
    pub(crate) fn spacing_near(&self, place: &Point) -> f32 {
        let mut found = [Neighbour::default()];
        let nearest = self.tree.k_nearest(place, &mut found).first();
        let point = nearest.and_then(|nearest| self.tree.points().get(nearest.index as usize));
        point.map_or(f32::INFINITY, |point| self.spacing_at(point))
    }

    /// Unit vector along the surface in the direction in which it is least curved, at the patch nearest to a point that faces as
    /// `normal`; `None` where the surface is flat or nothing faces there.
    pub(crate) fn bar_near(&self, point: &Point, normal: &Vector) -> Option<Vector> {
        let (mut nearest, mut least) = (None::<&Patch>, f32::INFINITY);
        for group in self.groups {
            if (group.centre - point).norm() - group.radius >= libm::sqrtf(least) {
                continue;
            }
            for (index, patch) in group.patches().zip(self.patches.get(group.patches()).unwrap_or_default()) {
                let square = (self.position(index) - point).norm_squared();
                if square < least && patch.faces(normal) {
                    (nearest, least) = (Some(patch), square);
                }
            }
        }
        nearest.and_then(Patch::bar_direction)
    }

    /// The same; where the surface is flat or round on all sides, as at the end of a peg, the direction in which its points around
    /// spread most. Its sign has no meaning.
    pub(crate) fn bar_or_spread(&self, point: &Point, normal: &Vector) -> Vector {
        self.bar_near(point, normal).unwrap_or_else(|| principal_direction(&self.tree, point, BAR_RADIUS))
    }

    /// Share of a segment from the end of a patch of a bar at which the bar meets a surface across its way, as where it is fixed to a
    /// plate. `None` if there is none, or if the bar ends before, with a face of its own.
    pub(crate) fn fixed_at(&self, bar: &Patch, from: &Point, to: &Point) -> Option<f32> {
        let way = unit_or(to - from, Vector::zeros());
        // Half way to its axis, where it meets the face of its end.
        let inwards = bar.normal * (0.5 / bar.curvature_across());
        let (from, to) = (from - inwards, to - inwards);
        let (mut fixed, mut end) = (None::<f32>, f32::INFINITY);
        for (at, patch) in self.positions().zip(self.patches) {
            let facing = patch.normal.dot(&way);
            if facing.abs() < ACROSS {
                continue;
            }
            if let Some(share) = patch.is_passed_at(&(from - at), &(to - at)) {
                if facing > 0.0 {
                    end = end.min(share);
                } else if fixed.is_none_or(|before| share < before) {
                    fixed = Some(share);
                }
            }
        }
        fixed.filter(|share| *share < end)
    }

    /// Whether `is_crossed` holds of a segment from a patch of a plane that was thinned to a neighbour in the same plane, where the extents
    /// of the patch do not fill what is between them: beside a bar that is fixed to the plane, neighbours are seen on some sides only.
    pub(crate) fn is_crossed_between(
        &self,
        index: usize,
        mut is_crossed: impl FnMut(&Point, &Point) -> bool,
    ) -> bool {
        let Some(patch) = self.patches.get(index).filter(|patch| patch.is_cut_off_in_plane()) else {
            return false;
        };
        let at = self.position(index);
        let mut others = heapless::Vec::<Point, MAX_IN_PLANE>::new();
        let mut is_dense = false;
        self.tree.for_each_within(&at, PLANE_RANGE, |neighbour| {
            let Ok(other) = self.representatives.binary_search(&neighbour.index) else { return };
            let (place, Some(other)) = (self.position(other), self.patches.get(other)) else { return };
            let height = (place - at).dot(&(patch.normal + other.normal)).abs();
            if other.normal.dot(&patch.normal) > REPRESENTATIVE_COSINE
                && height < 2.0 * IN_PLANE * libm::sqrtf(neighbour.distance_squared)
            {
                is_dense |= others.push(place).is_err();
            }
        });
        !is_dense && others.iter().any(|other| is_crossed(&at, other))
    }

    /// Indices of the patches at a range of points of the tree.
    pub(crate) fn patches_of(&self, points: &Range<usize>) -> Range<usize> {
        let before = |limit: usize| self.representatives.partition_point(|&index| (index as usize) < limit);
        before(points.start)..before(points.end)
    }
}

impl<'a> Support<'a> {
    /// The same, whose coordinates are those to which `frame` leads from the caller's.
    pub(crate) fn in_frame(self, frame: Pose) -> Self {
        Self { frame, ..self }
    }

    /// A supporter without patches: no object can touch it.
    pub(crate) fn bare(tree: PointTree<'a>) -> Self {
        Self { tree, patches: &[], representatives: &[], groups: &[], reach: 0.0, frame: Pose::identity() }
    }

    /// Bytes of working memory for [`fit`](Self::fit).
    pub(crate) const fn scratch_bytes(points: usize) -> usize {
        array_bytes::<u8>(points)
    }

    /// Chooses representatives and fits their patches. Every other point has a representative within
    /// [`REPRESENTATIVE_SPACING`] whose normal is similar. `normals`, `spacings`, the distance between points around
    /// each, metres, `is_guessed`, 1 for points that nobody saw, and `is_excluded`, 1 for points on which nothing shall hang, are in
    /// tree order.
    pub(crate) fn fit(
        tree: PointTree<'a>,
        (normals, spacings, is_guessed, is_excluded): (&[Vector], &[f32], &[u8], &[u8]),
        room: Room<'a>,
        mut scratch: Arena,
        meter: &Meter,
    ) -> Result<Self, Unfinished> {
        let (points, Room { patches, representatives, groups }) = (tree.points(), room);
        debug_assert!(
            [normals.len(), spacings.len(), is_guessed.len(), is_excluded.len()] == [points.len(); 4]
        );
        debug_assert!(patches.len() >= points.len() && representatives.len() >= points.len());
        let is_covered = scratch.slice::<u8>(points.len())?;
        let overall = overall_spacing(spacings);
        let (mut around, mut count) = (Surroundings::new(), 0);
        for index in 0..points.len() {
            if is_covered[index] > 0 {
                continue;
            }
            meter.check_cancelled()?;
            // One search serves for everything where the spacing is that of the cloud, as it mostly is.
            let mut found = [Neighbour::default(); SPACING_NEIGHBOURS];
            let mut nearest = Nearest::new(&mut found);
            around.collect(&tree, normals, index, overall, |neighbour| {
                nearest.offer(neighbour);
                let other = neighbour.index as usize;
                let is_near = neighbour.distance_squared <= REPRESENTATIVE_SPACING * REPRESENTATIVE_SPACING;
                if is_near && normals[other].dot(&normals[index]) > REPRESENTATIVE_COSINE {
                    is_covered[other] = 1;
                }
            });
            let nearest = match nearest.is_full() {
                true => nearest.into_slice(),
                false => tree.k_nearest(&points[index], &mut found),
            };
            let spacing = spacing_around(nearest, spacings, overall);
            if spacing != overall {
                around.collect(&tree, normals, index, spacing, |_| {});
            }
            patches[count] = around.fit_patch();
            patches[count].ends |= if is_guessed[index] > 0 { Patch::GUESSED } else { 0 };
            patches[count].ends |= if is_excluded[index] > 0 { Patch::EXCLUDED } else { 0 };
            representatives[count] = index as u32;
            count += 1;
        }
        let (patches, representatives) = (&patches[..count], &representatives[..count]);
        let groups = &mut groups[..count.div_ceil(GROUP_SIZE)];
        let members = patches.chunks(GROUP_SIZE).zip(representatives.chunks(GROUP_SIZE));
        for (k, (group, (patches, representatives))) in groups.iter_mut().zip(members).enumerate() {
            let places = || representatives.iter().map(|&index| &points[index as usize]);
            let centre = Aabb::of(places()).centre();
            let reach = |(place, patch): (&Point, &Patch)| (place - centre).norm() + patch.reach();
            let radius = places().zip(patches).map(reach).fold(0.0, f32::max);
            *group = Group { first: (k * GROUP_SIZE) as u32, count: patches.len() as u32, centre, radius };
        }
        let reach = patches.iter().map(Patch::reach).fold(0.0, f32::max);
        Ok(Self { tree, patches, representatives, groups, reach, frame: Pose::identity() })
    }
}

/// Spacing of the cloud, metres: the median over some of the points.
fn overall_spacing(spacings: &[f32]) -> f32 {
    let mut probes: [f32; SPACING_PROBES] =
        core::array::from_fn(|k| spacings[k * spacings.len() / SPACING_PROBES]);
    probes.sort_unstable_by(f32::total_cmp);
    probes[SPACING_PROBES / 2]
}

/// Spacing around a point by its nearest neighbours, metres: that of the cloud, unless the points around are much denser or sparser, as those of a
/// wall behind a hook.
fn spacing_around(nearest: &[Neighbour], spacings: &[f32], overall: f32) -> f32 {
    let mut around = [0.0; SPACING_NEIGHBOURS];
    for (spacing, neighbour) in around.iter_mut().zip(nearest) {
        *spacing = spacings[neighbour.index as usize];
    }
    let around = &mut around[..nearest.len()];
    around.sort_unstable_by(f32::total_cmp);
    let local = around[around.len() / 2];
    let is_like_overall = local <= SPACING_RATIO * overall && overall <= SPACING_RATIO * local;
    if is_like_overall { overall } else { local }
}
