//! A proof that there is no way out: a closed curve in the object and one in the supporter are linked like two rings of a chain.
//!
//! No motion without collision changes how often one curve winds through the other, and far away it does not. Both curves are found
//! in the same way: a graph of places inside the solid is flooded, and each place is numbered by how often the way to it has gone
//! round. Where two ways to the same place disagree, a closed curve goes round. In the object the graph is a grid, and it must go
//! round a bar at which the object hangs; in the supporter it is that of its points, and it must go through that curve.

use super::end::End;
use super::placement::Placement;
use super::space::{Space, Touch, Touches, spacing_of};
use crate::geometry::{Aabb, Point, Pose, Vector};
use crate::mechanics::{Body, REPRESENTATIVE_SPACING, Support};
use crate::memory::{Arena, array_bytes, larger};
use crate::monitor::Meter;
use crate::perception::far_side;
use bytemuck::{Pod, Zeroable};

/// Cells of the object's grid along each axis.
const CELLS: usize = 64;
/// Largest edges of a cell, metres, one tried after another: chords from cell to cell must not cut into a bar, and loops wider
/// than the grid are not found.
const LARGEST_CELLS: [f32; 2] = [0.0015, 0.003];
/// Cells of the object that are looked at, at most. More than a thin-walled object has.
const MAX_CELLS: usize = 1 << 16;
/// Distance from the centre of a cell to its corners, in cells: what is closer may be in it.
const HALF_DIAGONAL: f32 = 0.87;
/// Distance between points of the supporter that belong together, in multiples of the spacing. Of points that are sampled at
/// random, one in thousands is farther from all others.
const LINK: f32 = 3.0;
/// The same at least, metres: patches are as far apart as that.
const LEAST_REACH: f32 = 2.0 * REPRESENTATIVE_SPACING;
/// Largest distance between points that belong together, metres. In sparser clouds the mouths of hooks would be closed.
const COARSEST: f32 = 0.01;
/// Cosine between the normal of a patch and the way to another one above which it faces that.
const FACING: f32 = 0.5;
/// Distance from the object halfway between two points of it, in neighbouring cells, up to which they are joined, as a share of a
/// cell: what is bent lies beside its chord.
const BESIDE_CHORD: f32 = 0.15;
/// Share of a depth below the surface at which a point is that far from the surface all around: what is round is a little closer.
const THICK: f32 = 0.8;
/// Share of the points of a curve at which the object must be thick: at an edge of the mesh the way inwards is not well defined.
const MOST: f32 = 0.9;
/// Most points of the curve in the object.
const MAX_CURVE: usize = 4 * CELLS;
/// Distance within which object and supporter touch, metres: more than that of a release pose.
const TOUCH_RANGE: f32 = 0.003;
/// Depth inside the bar of the line that stands for it, metres.
const DEPTH: f32 = 0.001;

/// Bytes of working memory for a supporter of at most `points`.
pub(super) const fn bytes(points: usize) -> usize {
    let of_object = array_bytes::<Cell>(CELLS * CELLS * CELLS).saturating_add(array_bytes::<u32>(MAX_CELLS));
    larger(of_object, array_bytes::<i8>(far_side::max_points(points)))
}

/// Whether object and supporter are linked at a placement at which they touch, or nearly so. Returns the width of the gaps that are
/// taken as closed, metres; `None` if no link is found.
pub(super) fn link(
    space: &mut Space,
    at: &Placement,
    arena: &mut Arena,
    meter: &mut Meter,
) -> Result<Option<f32>, End> {
    let mut touches = Touches::within(TOUCH_RANGE);
    space.collect(at, &mut touches, meter)?;
    let (support, pose) = (space.obstacles.support, &at.pose(&space.moving.centre));
    let Some(body) = space.moving.body else { return Ok(None) };
    let queue = space.lend();
    let reach = (LINK * spacing_of(&support.tree)).max(LEAST_REACH);
    if reach > COARSEST {
        return Ok(None);
    }
    let to_object = pose.inverse();
    let is_outside = |point: &Point| body.field.distance(&(to_object * point)) > 0.0;
    for touch in &touches.list {
        let Some(bar) = support.bar_near(&touch.at, &touch.normal) else { continue };
        for cell in LARGEST_CELLS {
            let mut curve = Curve::new();
            let grid = Grid::around(&body, &(to_object * touch.at), cell);
            if !grid.curve_around(pose, touch, &bar, &mut curve, arena.scratch(), meter)? {
                continue;
            }
            let thick = curve.iter().filter(|point| is_thick(&body, &(to_object * **point), reach)).count();
            if thick as f32 >= MOST * curve.len() as f32
                && goes_through(
                    support,
                    touch,
                    (reach, &is_outside),
                    (&curve, grid.cell),
                    (queue, arena.scratch()),
                    meter,
                )?
            {
                return Ok(Some(reach.max(2.0 * grid.between)));
            }
            break;
        }
    }
    Ok(None)
}

/// Whether the object is at least as thick, at a point of its surface, as the gaps that are taken as closed: anything thinner could
/// pass through them.
fn is_thick(body: &Body, point: &Point, gap: f32) -> bool {
    let (_, gradient) = body.field.sample(point);
    let half = 0.5 * gap;
    // The point is on the surface or in the cell below it. Deep inside, the field understates distances, so that the mesh is asked.
    [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().any(|depth| {
        let at = point - gradient * (depth * half);
        body.field.distance(&at) < 0.0 && (body.surface.closest_point(&at) - at).norm() > THICK * half
    })
}

type Curve = heapless::Vec<Point, MAX_CURVE>;

/// A cell of the object's grid.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Cell {
    /// [`UNKNOWN`](Self::UNKNOWN), [`EMPTY`](Self::EMPTY), or that it is of the object.
    state: u8,
    /// The neighbour from which it was reached.
    from: u8,
    /// How often the way to it goes round.
    turns: i8,
}

impl Cell {
    const UNKNOWN: u8 = 0;
    const EMPTY: u8 = 1;
    const OF_OBJECT: u8 = 2;
    /// `from` of the first cell.
    const ROOT: u8 = 6;
}

/// Cubes around a place where the object touches, in its coordinates.
struct Grid<'b> {
    body: &'b Body<'b>,
    origin: Point,
    /// Edge length, metres.
    cell: f32,
    /// Distance from the object halfway between two points of it up to which they are joined, metres.
    between: f32,
}

impl<'b> Grid<'b> {
    /// Around a point of the object.
    fn around(body: &'b Body<'b>, point: &Point, largest: f32) -> Self {
        // A small object with a cell to spare on either side.
        let cell = (2.0 * body.extent / (CELLS - 2) as f32).min(largest);
        let between = (BESIDE_CHORD * cell).max(body.field.voxel_size());
        Self { body, origin: point - Vector::repeat(0.5 * CELLS as f32 * cell), cell, between }
    }

    fn index(&self, place: [usize; 3]) -> usize {
        (place[2] * CELLS + place[1]) * CELLS + place[0]
    }

    fn place(&self, index: usize) -> [usize; 3] {
        [index % CELLS, index / CELLS % CELLS, index / (CELLS * CELLS)]
    }

    fn place_of(&self, point: &Point) -> [usize; 3] {
        [0, 1, 2].map(|axis| {
            let at = (point[axis] - self.origin[axis]) / self.cell;
            (at.max(0.0) as usize).min(CELLS - 1)
        })
    }

    fn centre(&self, index: usize) -> Point {
        self.origin + Vector::from(self.place(index).map(|k| (k as f32 + 0.5) * self.cell))
    }

    /// The cell beside another, 0 to 5 for either side along each axis.
    fn beside(&self, index: usize, side: u8) -> Option<usize> {
        let (mut place, axis) = (self.place(index), side as usize / 2);
        place[axis] = if side.is_multiple_of(2) { place[axis].checked_sub(1)? } else { place[axis] + 1 };
        (place[axis] < CELLS).then(|| self.index(place))
    }

    /// A point of the object in a cell, or `None` if there is none in it.
    fn inside(&self, index: usize) -> Option<Point> {
        let centre = self.centre(index);
        let (distance, gradient) = self.body.field.sample(&centre);
        (distance < HALF_DIAGONAL * self.cell).then(|| centre - gradient * distance.max(0.0))
    }

    /// Finds a closed curve in the object that goes round the bar at a touch, in supporter coordinates.
    fn curve_around(
        &self,
        pose: &Pose,
        touch: &Touch,
        bar: &Vector,
        curve: &mut Curve,
        arena: Arena,
        meter: &mut Meter,
    ) -> Result<bool, End> {
        let mut arena = arena;
        let cells = arena.slice::<Cell>(CELLS * CELLS * CELLS)?;
        let queue = arena.unset::<u32>(MAX_CELLS)?;
        let to_object = pose.inverse();
        let (axis, across) = (to_object * bar, to_object * touch.normal);
        let line = to_object * (touch.at - touch.normal * DEPTH);
        let side = axis.cross(&across);
        let flat = |point: &Point| {
            let arm = point - line;
            [arm.dot(&across), arm.dot(&side)]
        };
        let near = to_object * (touch.at + touch.normal * touch.distance.max(0.0));
        let first = self.index(self.place_of(&near));
        cells[first] = Cell { state: Cell::OF_OBJECT, from: Cell::ROOT, turns: 0 };
        queue[0] = first as u32;
        let (mut next, mut count) = (0, 1);
        while next < count {
            let index = queue[next] as usize;
            next += 1;
            meter.distance_queries(6)?;
            let here = self.inside(index).unwrap_or_else(|| self.centre(index));
            for side in 0..6 {
                let Some(beside) = self.beside(index, side) else { continue };
                if cells[beside].state == Cell::EMPTY {
                    continue;
                }
                let Some(there) = self.inside(beside) else {
                    cells[beside].state = Cell::EMPTY;
                    continue;
                };
                if self.body.field.distance(&nalgebra::center(&here, &there)) > self.between {
                    continue;
                }
                // What goes round more often than can be counted may or may not be closed.
                let Some(turns) = cells[index].turns.checked_add(turn(flat(&here), flat(&there))) else {
                    return Ok(false);
                };
                if cells[beside].state == Cell::UNKNOWN {
                    if count == queue.len() {
                        return Ok(false);
                    }
                    cells[beside] = Cell { state: Cell::OF_OBJECT, from: side ^ 1, turns };
                    queue[count] = beside as u32;
                    count += 1;
                } else if cells[beside].turns != turns {
                    return Ok(self.close(cells, [index, beside], pose, curve));
                }
            }
        }
        Ok(false)
    }

    /// Writes the curve from the first cell to one cell, on to its neighbour, and back.
    fn close(&self, cells: &[Cell], [there, back]: [usize; 2], pose: &Pose, curve: &mut Curve) -> bool {
        let point = |index: usize| pose * self.inside(index).unwrap_or_else(|| self.centre(index));
        let before = |index: usize| match cells[index].from {
            Cell::ROOT => None,
            side => self.beside(index, side),
        };
        let chain = |from: usize| core::iter::successors(Some(from), move |&index| before(index));
        let is_short = chain(there).all(|index| curve.push(point(index)).is_ok());
        curve.reverse();
        is_short && chain(back).all(|index| curve.push(point(index)).is_ok())
    }
}

/// Signed crossing of the half plane behind the line, by the positions across it of the ends of a step.
fn turn([x, y]: [f32; 2], [u, v]: [f32; 2]) -> i8 {
    let crosses = (y < 0.0) != (v < 0.0);
    // Where the step is on the line across.
    let at = x + (u - x) * y / (y - v);
    match (crosses && at < 0.0, y < 0.0) {
        (false, _) => 0,
        (true, true) => 1,
        (true, false) => -1,
    }
}

/// Whether a closed way along patches of the supporter goes through a closed curve, which is exact to a cell. Its steps are of at most
/// `reach` metres, and outside of the object. `queue` has a slot for each patch.
fn goes_through(
    support: &Support,
    touch: &Touch,
    (reach, is_outside): (f32, &dyn Fn(&Point) -> bool),
    (curve, cell): (&[Point], f32),
    (queue, mut arena): (&mut [u32], Arena),
    meter: &mut Meter,
) -> Result<bool, End> {
    const UNKNOWN: i8 = i8::MIN;
    let (tree, patches) = (&support.tree, support.patches);
    let passes = arena.unset::<i8>(patches.len())?;
    passes.fill(UNKNOWN);
    let sum: Vector = curve.iter().map(|point| point.coords).sum();
    let disc = Disc { curve, apex: Point::from(sum / curve.len() as f32), aabb: Aabb::of(curve) };
    let distance = |patch: &usize| (support.position(*patch) - touch.at).norm_squared();
    let Some(first) = (0..patches.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))) else {
        return Ok(false);
    };
    let (Some(seen), Some(begin)) = (passes.get_mut(first), queue.first_mut()) else { return Ok(false) };
    (*seen, *begin) = (0, first as u32);
    // What goes through more often than can be counted, as a long spring does, may or may not be linked.
    let (mut next, mut count, mut is_linked, mut is_countable) = (0, 1, false, true);
    while next < count && !is_linked && is_countable {
        let index = queue[next] as usize;
        next += 1;
        meter.distance_queries(1)?;
        let here = support.position(index);
        tree.for_each_within(&here, reach, |neighbour| {
            let Ok(other) = support.representatives.binary_search(&neighbour.index) else { return };
            let there = support.position(other);
            // Surfaces that face each other have free space in between.
            let step = there - here;
            let limit = FACING * step.norm();
            if patches[index].normal.dot(&step) > limit || patches[other].normal.dot(&-step) > limit {
                return;
            }
            let is_near = disc.is_near(&here, &there);
            let mut between = [0.25, 0.5, 0.75].map(|share| here + step * share).into_iter();
            if is_near && !between.all(|point| is_outside(&point)) {
                return;
            }
            let through = if is_near { disc.passes(&here, &there) } else { 0 };
            // As near to the curve, the way may as well pass on its other side.
            if through != 0 && disc.distance(&here, &there) < cell {
                return;
            }
            let Some(passed) = passes[index].checked_add(through).filter(|passed| *passed != UNKNOWN) else {
                is_countable = false;
                return;
            };
            if passes[other] == UNKNOWN {
                (passes[other], queue[count]) = (passed, other as u32);
                count += 1;
            } else {
                is_linked |= passes[other] != passed;
            }
        });
    }
    Ok(is_linked && is_countable)
}

/// A surface with a closed curve as its border: triangles between the curve and an apex.
struct Disc<'c> {
    curve: &'c [Point],
    apex: Point,
    aabb: Aabb,
}

impl Disc<'_> {
    /// Whether a step is in the box around the disc, at least in part.
    fn is_near(&self, from: &Point, to: &Point) -> bool {
        (0..3).all(|axis| {
            from[axis].max(to[axis]) >= self.aabb.min[axis] && from[axis].min(to[axis]) <= self.aabb.max[axis]
        })
    }

    /// Distance of a step from the points of the curve, metres.
    fn distance(&self, from: &Point, to: &Point) -> f32 {
        let step = to - from;
        let of_point = |point: &Point| {
            let share = (point - from).dot(&step) / step.norm_squared();
            (from + step * share.clamp(0.0, 1.0) - point).norm_squared()
        };
        libm::sqrtf(self.curve.iter().map(of_point).fold(f32::INFINITY, f32::min))
    }

    /// How often a step passes through, with the sign of the direction.
    fn passes(&self, from: &Point, to: &Point) -> i8 {
        if from == to {
            return 0;
        }
        let sides = self.curve.iter().zip(self.curve.iter().cycle().skip(1));
        sides.map(|(a, b)| passes(from, to, [&self.apex, a, b])).fold(0, i8::saturating_add)
    }
}

/// Signed passage of a step through a triangle. Neighbouring triangles share the test of their common side, so that a step through
/// it passes one of them.
fn passes(from: &Point, to: &Point, [a, b, c]: [&Point; 3]) -> i8 {
    let is_above = |point: &Point| volume([a, b, c, point]) >= 0.0;
    if is_above(from) == is_above(to) {
        return 0;
    }
    let [ab, bc, ac] = [[a, b], [b, c], [a, c]].map(|[p, q]| volume([from, to, p, q]) >= 0.0);
    match (ab, bc, ac) {
        (true, true, false) => 1,
        (false, false, true) => -1,
        _ => 0,
    }
}

/// Six times the signed volume of a tetrahedron.
fn volume([a, b, c, d]: [&Point; 4]) -> f32 {
    (b - a).cross(&(c - a)).dot(&(d - a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::PointTree;
    use crate::memory::model_bytes;
    use crate::motion::failure::{Mover, Obstacle};

    /// Whether a spring that is wound around a ring, open at both ends and with so many turns, goes through it.
    fn spring_goes_through(turns: f32, is_closed: bool) -> bool {
        use core::f32::consts::TAU;
        const RADIUS: f32 = 1.0;
        let on_ring = |angle: f32| Vector::new(libm::cosf(angle), libm::sinf(angle), 0.0);
        let curve: Vec<Point> =
            (0..256).map(|k| Point::from(on_ring(TAU * k as f32 / 256.0) * RADIUS)).collect();
        let count = (30.0 * turns.abs()) as usize;
        let points: Vec<Point> = (0..count)
            .map(|k| {
                let share = k as f32 / count as f32 * if is_closed { 1.0 } else { 0.95 };
                let (out, turn) = (on_ring(TAU * share), TAU * turns * share);
                Point::from(
                    out * (RADIUS + 0.02 * libm::cosf(turn)) + Vector::z() * (0.02 * libm::sinf(turn)),
                )
            })
            .collect();
        let needed = model_bytes(PointTree::bytes(count) + bytes(count));
        let mut memory = vec![0; needed];
        let mut arena = Arena::new(&mut memory, needed).unwrap();
        let mut meter = Meter::unwatched();
        let tree = PointTree::build(&points, &mut arena, &meter).unwrap();
        let (patches, representatives) =
            (vec![Zeroable::zeroed(); count], (0..count as u32).collect::<Vec<_>>());
        let support = Support {
            tree,
            patches: &patches,
            representatives: &representatives,
            groups: &[],
            reach: 0.0,
            frame: Pose::identity(),
        };
        let touch = Touch {
            distance: 0.0,
            at: points[0],
            normal: Vector::z(),
            mover: Mover::Object,
            obstacle: Obstacle::Supporter,
        };
        let memory = (&mut vec![0; count][..], arena);
        goes_through(&support, &touch, (0.01, &|_| true), (&curve, 0.005), memory, &mut meter).ok().unwrap()
    }

    #[test]
    fn a_spring_around_a_ring_is_linked_only_where_its_ends_meet() {
        for sign in [1.0, -1.0] {
            assert!(spring_goes_through(sign * 60.0, true));
            assert!(!spring_goes_through(sign * 60.0, false));
            // More turns than an `i8` counts.
            assert!(!spring_goes_through(sign * 150.0, false));
        }
    }
}
