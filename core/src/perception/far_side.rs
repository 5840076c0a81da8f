//! The far side of what a camera saw from one side.
//!
//! A bar of which only the front was seen has a back. It is guessed by symmetry: every point is mirrored through the
//! centre of the largest ball that touches the surface there from inside, holds no other point, and stays in the shadow
//! behind what was seen. The centres are the medial axis (Blum, "A transformation for extracting new descriptors of
//! shape", 1967), so that a round bar gets its exact back, a wire its other half, and a strip that was seen face on a
//! thickness like its width.

use super::cleaning::{self, Cleaned};
use super::visibility;
use crate::geometry::{Neighbour, Point, PointTree, PointTreeSlots, Vector, Viewpoints, any_perpendicular};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Unfinished};

/// Largest radius of the balls, metres. Thicker things get a back that is too near, but nothing reaches around them.
const MAX_RADIUS: f32 = 0.015;
/// Distance by which the far side is moved away from what was seen, metres: its error, so that an object which stays clear
/// of the guess is likely to stay clear of the truth. The noise of a good depth camera makes errors of this size in the
/// radius of a bar of 1 cm.
const ALLOWANCE: f32 = 0.0015;
/// Cosine of the turn between two normals from which on the farther point bounds the ball at the nearer one. Noise moves
/// nearer points into the ball.
const TURNED: f32 = 0.6;
/// Least distance of a guessed point from those that were seen, in distances between points: nearer ones are seen already.
const APART: f32 = 1.2;
/// Largest gap between the directions to the neighbours of a point inside a surface, radians. At an edge it is a half turn;
/// of points at random one in six thousand has a gap of this size.
const EDGE_GAP: f32 = 2.6;
/// Distance by which a ball may reach beyond an outline, in distances between points: the last points of a surface are
/// that far inside its outline on average.
const OUTLINE_SLACK: f32 = 0.5;
/// Neighbours of a point among which gaps are looked for, itself included.
const NEIGHBOURS: usize = 24;
/// Least cosine between a normal and the way to the camera of points that are mirrored. At the outline both sides were
/// seen.
const LEAST_COSINE: f32 = 0.1;

/// The most points of a cloud of `points` with its far side: of a longer far side a part is left out, spread over all.
pub(crate) const fn max_points(points: usize) -> usize {
    points.saturating_add(points / 2)
}

/// Bytes of what is kept of a cloud of `points` with its far side.
pub(crate) const fn bytes(points: usize) -> usize {
    cleaning::bytes(max_points(points))
}

/// Bytes of working memory for a cloud of `points`.
pub(crate) const fn scratch_bytes(points: usize) -> usize {
    let all = max_points(points);
    array_bytes::<Point>(all)
        .saturating_add(array_bytes::<u32>(all).saturating_mul(2))
        .saturating_add(array_bytes::<u8>(points))
}

/// Adds the far side of a cloud to `slots`, which hold the cloud and have room for [`max_points`], as far as its
/// `viewpoints` left it unseen. Excluded points have no far side.
pub(crate) fn add<'s>(
    seen: Cleaned<'s>,
    viewpoints: Viewpoints,
    slots: &mut PointTreeSlots,
    arena: &mut Arena<'s>,
    meter: &Meter,
) -> Result<Cleaned<'s>, Unfinished> {
    let count = seen.normals.len();
    let most = max_points(count);
    let (normals, spacings) = (arena.unset::<Vector>(most)?, arena.unset::<f32>(most)?);
    let (is_excluded, is_guessed) = (arena.unset::<u8>(most)?, arena.unset::<u8>(most)?);
    let mut scratch = arena.scratch();
    let points = scratch.unset::<Point>(most)?;
    // Index of the point that was seen, its own or that of the mirrored one, in the old tree and in the caller's cloud.
    let (sources, names) = (scratch.unset::<u32>(most)?, scratch.unset::<u32>(most)?);
    debug_assert!(slots.tree().points().len() == count);
    for (to, from) in points.iter_mut().zip(slots.tree().points()) {
        *to = *from;
    }
    for (slot, index) in sources[..count].iter_mut().zip(0..) {
        *slot = index;
    }
    let far = &mut FarSide {
        points: &mut points[count..],
        sources: &mut sources[count..],
        count: 0,
        stride: 1,
        found: 0,
    };
    find(&slots.tree(), &seen, viewpoints, scratch, far, meter)?;
    let all = count + far.count;
    for (name, &source) in names.iter_mut().zip(&sources[..all]) {
        *name = slots.tree().order()[source as usize];
    }
    slots.fill(&points[..all], meter)?;
    let (normals, spacings) = (&mut normals[..all], &mut spacings[..all]);
    let (is_excluded, is_guessed) = (&mut is_excluded[..all], &mut is_guessed[..all]);
    for (place, &index) in slots.tree().order().iter().enumerate() {
        let (source, is_far) = (sources[index as usize] as usize, index as usize >= count);
        normals[place] = if is_far { -seen.normals[source] } else { seen.normals[source] };
        spacings[place] = seen.spacings[source];
        is_excluded[place] = seen.is_excluded[source];
        is_guessed[place] = u8::from(is_far);
    }
    slots.rename(&names[..all]);
    Ok(Cleaned { normals, spacings, is_excluded, is_guessed, ..seen })
}

/// The points of the far side that are kept: if there are too many, every second, fourth and so on.
struct FarSide<'a> {
    points: &'a mut [Point],
    sources: &'a mut [u32],
    count: usize,
    stride: usize,
    found: usize,
}

impl FarSide<'_> {
    fn push(&mut self, point: Point, source: u32) {
        if self.found.is_multiple_of(self.stride) {
            if self.count == self.points.len() {
                self.stride *= 2;
                self.count = self.count.div_ceil(2);
                for k in 0..self.count {
                    self.points[k] = self.points[2 * k];
                    self.sources[k] = self.sources[2 * k];
                }
            }
            if self.count < self.points.len() && self.found.is_multiple_of(self.stride) {
                (self.points[self.count], self.sources[self.count]) = (point, source);
                self.count += 1;
            }
        }
        self.found += 1;
    }
}

/// Finds the points of the far side, in the order of those that were seen.
fn find(
    tree: &PointTree,
    seen: &Cleaned,
    viewpoints: Viewpoints,
    mut scratch: Arena,
    far: &mut FarSide,
    meter: &Meter,
) -> Result<(), Unfinished> {
    let Cleaned { normals, spacings, is_excluded, .. } = seen;
    let is_edge = scratch.slice::<u8>(normals.len())?;
    tree.for_each_k_nearest::<NEIGHBOURS>(meter, |index, neighbours| {
        is_edge[index] = u8::from(is_at_edge(tree, normals, index, neighbours));
    })?;
    for of in (0..normals.len()).filter(|&index| is_excluded[index] == 0) {
        meter.check_cancelled()?;
        let (point, normal) = (tree.points()[of], normals[of]);
        let view = visibility::best_view(tree, (&point, &normal), spacings[of], viewpoints);
        let Some((way, _)) = view.filter(|(_, cosine)| *cosine > LEAST_COSINE) else { continue };
        let opposite = point - normal * (2.0 * radius(tree, seen, is_edge, of, &way));
        let apart = APART * spacings[of];
        if tree.nearest(&opposite).distance_squared > apart * apart {
            far.push(opposite - normal * ALLOWANCE, of as u32);
        }
    }
    Ok(())
}

/// Radius of the largest ball that touches the surface from inside at a point, holds no other point, and is hidden from
/// the direction `way` by what was seen.
fn radius(tree: &PointTree, seen: &Cleaned, is_edge: &[u8], of: usize, way: &Vector) -> f32 {
    let Cleaned { normals, spacings, .. } = seen;
    let (point, normal) = (tree.points()[of], normals[of]);
    let mut radius = MAX_RADIUS;
    // A ball of this radius reaches no farther than its diameter.
    tree.for_each_within(&point, 2.0 * MAX_RADIUS, |neighbour| {
        let other = neighbour.index as usize;
        let offset = tree.points()[other] - point;
        let depth = -offset.dot(&normal);
        if depth > 0.0 && normals[other].dot(&normal) < TURNED {
            radius = radius.min(neighbour.distance_squared / (2.0 * depth));
        }
        if is_edge[other] > 0 {
            let slack = OUTLINE_SLACK * spacings[other];
            radius = radius.min(radius_beside_ray(&-offset, &-normal, way, slack));
        }
    });
    radius
}

/// Radius of the ball that reaches beyond the ray through an outline by `slack` metres. `offset` leads from the outline to
/// where the ball touches the surface, metres; the unit vector `inwards` from there to its centre. Beyond the ray space is
/// free.
fn radius_beside_ray(offset: &Vector, inwards: &Vector, way: &Vector, slack: f32) -> f32 {
    // Without the parts along the ray, the distance of the centre from the ray is r - s where
    // (1 - |b|²) r² - 2 (a·b + s) r - (|a|² - s²) = 0.
    let a = offset - way * offset.dot(way);
    let b = inwards - way * inwards.dot(way);
    let (square, half) = (1.0 - b.norm_squared(), a.dot(&b) + slack);
    let constant = (a.norm_squared() - slack * slack).max(0.0);
    let root = libm::sqrtf((half * half + square * constant).max(0.0));
    // The larger root, without a difference of like numbers.
    if half > 0.0 { (half + root) / square.max(1e-6) } else { constant / (root - half).max(1e-9) }
}

/// Whether a point is at the end of its surface: its neighbours are on one side.
fn is_at_edge(tree: &PointTree, normals: &[Vector], index: usize, neighbours: &[Neighbour]) -> bool {
    let (point, normal) = (tree.points()[index], normals[index]);
    let ahead = any_perpendicular(normal);
    let aside = normal.cross(&ahead);
    let mut angles = heapless::Vec::<f32, NEIGHBOURS>::new();
    for neighbour in neighbours {
        let offset = tree.points()[neighbour.index as usize] - point;
        let is_on_surface = offset.dot(&normal).abs() < 0.8 * offset.norm();
        if neighbour.distance_squared > 0.0 && is_on_surface {
            let _ = angles.push(libm::atan2f(offset.dot(&aside), offset.dot(&ahead)));
        }
    }
    angles.sort_unstable_by(f32::total_cmp);
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return false };
    let around = core::f32::consts::TAU - (last - first);
    angles.windows(2).map(|pair| pair[1] - pair[0]).fold(around, f32::max) > EDGE_GAP
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::memory::model_bytes;
    use crate::perception::visibility;
    use crate::random::Random;

    const EYE: Point = Point::new(0.6, 0.0, 0.1);

    /// The far side of points with normals, as seen from the eye.
    fn far_side(points: &[Point], normals: &[Vector]) -> Vec<Point> {
        let n = points.len();
        let needed = model_bytes(
            PointTree::bytes(max_points(n))
                + cleaning::bytes(n)
                + bytes(n)
                + cleaning::scratch_bytes(n).max(scratch_bytes(n)),
        );
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let mut slots = PointTreeSlots::new(max_points(n), &mut arena).unwrap();
        let seen = cleaning::clean(
            (points, &Pose::identity()),
            normals,
            true,
            &mut slots,
            &mut arena,
            &Meter::unwatched(),
        )
        .unwrap();
        cleaning::spacing::measure(&slots.tree(), seen.spacings, &Meter::unwatched()).unwrap();
        if !visibility::explain(
            &slots.tree(),
            seen.normals,
            seen.spacings,
            Viewpoints::new(&[EYE], &Pose::identity()),
            &Meter::unwatched(),
        )
        .unwrap()
        {
            return Vec::new();
        }
        let all = add(
            seen,
            Viewpoints::new(&[EYE], &Pose::identity()),
            &mut slots,
            &mut arena,
            &Meter::unwatched(),
        )
        .unwrap();
        let tree = slots.tree();
        let far = tree.points().iter().zip(all.is_guessed).filter(|(_, flag)| **flag > 0);
        far.map(|(point, _)| *point).collect()
    }

    /// Points at random on a bar along y with this radius, those that the eye sees or all.
    fn bar(radius: f32, is_whole: bool) -> (Vec<Point>, Vec<Vector>) {
        let mut random = Random::new(3);
        let all = (0..6000).map(|_| {
            let (s, c) = (std::f32::consts::TAU * random.next_f32()).sin_cos();
            (Point::new(radius * c, 0.1 * random.next_f32(), radius * s), Vector::new(c, 0.0, s))
        });
        all.filter(|(p, n)| is_whole || n.dot(&(EYE - p)) > 0.2 * (EYE - p).norm()).unzip()
    }

    #[test]
    fn a_round_bar_gets_its_back() {
        for radius in [0.003, 0.006, 0.012] {
            let (points, normals) = bar(radius, false);
            let far = far_side(&points, &normals);
            assert!(far.len() * 3 > points.len(), "{} of {}", far.len(), points.len());
            // Away from the ends, where the bar tapers.
            let middle: Vec<f32> =
                far.iter().filter(|p| (0.02..0.08).contains(&p.y)).map(|p| p.x.hypot(p.z)).collect();
            let good =
                middle.iter().filter(|r| (**r - radius - ALLOWANCE).abs() < 0.1 * radius + 0.0005).count();
            assert!(good * 10 > middle.len() * 8, "{good} of {} at radius {radius}", middle.len());
            assert!(middle.iter().all(|r| *r < radius + ALLOWANCE + 0.1 * radius), "radius {radius}");
            assert!(far.iter().all(|p| p.x < radius), "in front of radius {radius}");
        }
    }

    #[test]
    fn what_was_seen_from_all_sides_gets_nothing() {
        let (points, normals) = bar(0.006, true);
        assert!(far_side(&points, &normals).is_empty());
        // Also where points are as far apart as the bar is thick.
        for step in [40, 60, 80] {
            let (points, normals): (Vec<Point>, Vec<Vector>) =
                points.iter().zip(&normals).step_by(step).map(|(p, n)| (*p, *n)).unzip();
            assert!(far_side(&points, &normals).is_empty(), "every {step}th point");
        }
    }

    #[test]
    fn a_strip_gets_a_thickness_like_its_width() {
        // 20 mm wide, face on.
        let mut random = Random::new(4);
        let points: Vec<Point> = (0..2000)
            .map(|_| Point::new(0.0, 0.1 * random.next_f32(), 0.02 * random.next_f32() - 0.01))
            .collect();
        let far = far_side(&points, &vec![Vector::x(); points.len()]);
        let deepest = far.iter().map(|p| -p.x).fold(0.0, f32::max);
        assert!((0.016..0.024).contains(&deepest), "{deepest}");
        // It stays in the shadow: the way to the eye passes through the strip.
        let crossing = |p: &Point| p.z - p.x * (EYE.z - p.z) / (EYE.x - p.x);
        assert!(far.iter().all(|p| crossing(p).abs() < 0.0115));
    }

    #[test]
    fn the_ball_beside_a_ray_touches_it() {
        // A ball that touches the plane x = 0 from behind, 4 mm from the outline of what was seen.
        let radius = radius_beside_ray(&Vector::new(0.0, 0.0, 0.004), &-Vector::x(), &Vector::x(), 0.0);
        assert!((radius - 0.004).abs() < 1e-6);
        // Seen at 45 degrees, the shadow leans: the centre at depth r is 0.004 + r to the side of the ray.
        let way = Vector::new(1.0, 0.0, -1.0).normalize();
        let radius = radius_beside_ray(&Vector::new(0.0, 0.0, 0.004), &-Vector::x(), &way, 0.0);
        let centre = Vector::new(-radius, 0.0, 0.004);
        assert!(((centre - way * centre.dot(&way)).norm() - radius).abs() < 1e-6, "{radius}");
    }
}
