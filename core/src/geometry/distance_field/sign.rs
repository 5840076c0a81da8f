//! On which side of the mesh the nodes and the blocks without bricks are.
//!
//! Two neighbouring nodes are on the same side if there is no room for the mesh between the two balls that it stays out
//! of. So around a closed mesh a side spreads from where it is known, and one winding number decides for a whole region.
//! Around an open mesh the side also changes where there is no mesh, so every brick computes winding numbers of its own.
//! For the remaining nodes, very close to the mesh, the plane of the nearest triangle decides, or their own winding number.

use super::brick::{
    ACROSS, ALL, BESIDE, BRICK_NODES, DIAGONAL, HIGH, LOW, Nodes, STEP, compare, coordinates, each,
};
use super::frame::Frame;
use super::layout::{Bricks, Layout};
use super::nearest::Nearest;
use super::{Entry, QUANTUM};
use crate::geometry::{Point, Surface, Vector};
use crate::memory::{Arena, array_bytes};
use crate::monitor::{Meter, Stop, Unfinished};

/// Side of a block that has not been decided yet.
const UNKNOWN: u8 = 0;
/// Side of a block outside the mesh.
const OUTSIDE: u8 = 1;
/// Side of a block inside the mesh.
pub(super) const INSIDE: u8 = 2;

/// Distance from the mesh beyond which a node may decide for its region, voxels.
const CLEAR: f32 = 0.5;
/// Difference of a winding number from one half that is not crossed within a brick.
const CERTAIN: f32 = 0.2;
/// Cosine between a triangle's normal and the direction from its nearest point above which the plane of the triangle decides
/// the side: only at an edge sharper than 37 degrees could another triangle be as near and disagree.
const ABOVE_FACE: f32 = 0.95;

/// Bytes of working memory.
pub(super) const fn scratch_bytes(bricks: usize, blocks: usize) -> usize {
    array_bytes::<Nodes>(bricks)
        .saturating_mul(2)
        .saturating_add(array_bytes::<[Nodes; 3]>(bricks))
        .saturating_add(array_bytes::<u8>(bricks))
        .saturating_add(array_bytes::<u32>(blocks))
}

/// Finds all sides: writes the signed distances of the bricks' nodes to `nodes` and the sides of the other blocks to `far`.
pub(super) fn find(
    bricks: &Bricks,
    nearest: &Nearest,
    nodes: &mut [i16],
    far: &mut [u8],
    mut scratch: Arena,
    meter: &mut Meter,
) -> Result<(), Unfinished> {
    let Bricks { surface, layout, grid, places, frames } = *bricks;
    let bricks = places.len();
    let mut sides = Sides {
        surface,
        layout,
        grid,
        places,
        nearest,
        frames,
        far,
        sides: [scratch.slice(bricks)?, scratch.slice(bricks)?],
        links: scratch.slice(bricks)?,
        waiting: scratch.slice(bricks)?,
        stack: scratch.slice(grid.len())?,
        height: 0,
        is_simple: true,
        meter,
    };
    sides.link()?;
    if is_closed(surface, sides.meter)? {
        sides.fill_regions()?;
    } else {
        sides.is_simple = false;
        sides.ask_bricks()?;
        sides.ask_blocks()?;
    }
    sides.finish(nodes)?;
    Ok(())
}

struct Sides<'a, 's, 'm> {
    surface: &'a Surface<'a>,
    layout: &'a Layout,
    grid: &'a [u32],
    /// The block of each brick.
    places: &'a [u32],
    nearest: &'a Nearest<'a>,
    frames: &'a [Frame],
    far: &'a mut [u8],
    /// The nodes of each brick that are known to be outside, and inside.
    sides: [&'s mut [Nodes]; 2],
    /// The nodes of each brick that are on the same side as the next along each axis.
    links: &'s mut [[Nodes; 3]],
    /// Whether a brick is on the stack.
    waiting: &'s mut [u8],
    /// Blocks whose side spreads to their neighbours.
    stack: &'s mut [u32],
    height: usize,
    /// Whether every winding number is 0 or 1, so that every triangle parts inside and outside.
    is_simple: bool,
    meter: &'a mut Meter<'m>,
}

/// All nodes that hang together with `nodes`.
fn flood(mut nodes: Nodes, links: &[Nodes; 3]) -> Nodes {
    loop {
        let before = nodes;
        for axis in 0..3 {
            nodes |= (nodes & links[axis]) << STEP[axis] | nodes >> STEP[axis] & links[axis];
        }
        if nodes == before {
            return nodes;
        }
    }
}

impl Sides<'_, '_, '_> {
    fn link(&mut self) -> Result<(), Stop> {
        for (links, distances) in self.links.iter_mut().zip(self.nearest.distances.iter()) {
            self.meter.check_cancelled()?;
            for axis in 0..3 {
                let linked = compare(distances, STEP[axis], |a, b| a + b > 1.001);
                links[axis] = linked & !HIGH[axis];
            }
        }
        Ok(())
    }

    /// Where a node is, in object coordinates.
    fn point(&self, brick: usize, node: usize) -> Point {
        self.layout.in_object(&self.local(brick, node))
    }

    fn local(&self, brick: usize, node: usize) -> Vector {
        let first = self.layout.first_node(self.places[brick] as usize);
        first + Vector::from(coordinates(node).map(|i| i as f32))
    }

    fn winding_number(&mut self, point: &Point) -> Result<f32, Stop> {
        self.meter.distance_queries(1)?;
        Ok(self.surface.winding_number(point))
    }

    /// Whether a node is inside by its own winding number.
    fn is_point_inside(&mut self, brick: usize, node: usize) -> Result<bool, Stop> {
        self.meter.distance_queries(1)?;
        Ok(self.surface.is_inside(&self.point(brick, node)))
    }

    fn unknown(&self, brick: usize) -> Nodes {
        ALL & !(self.sides[0][brick] | self.sides[1][brick])
    }

    /// The node of `among` that is furthest from the mesh.
    fn furthest(&self, brick: usize, among: Nodes) -> Option<(usize, f32)> {
        let distances = &self.nearest.distances[brick];
        each(among).map(|node| (node, distances[node])).reduce(|a, b| if b.1 > a.1 { b } else { a })
    }

    /// Closed meshes: spreads the outside from the border of the grid, and one winding number through each other region.
    fn fill_regions(&mut self) -> Result<(), Stop> {
        for block in 0..self.grid.len() {
            self.meter.check_at(block)?;
            let place = self.layout.place(block);
            for axis in 0..3 {
                for forward in [false, true] {
                    if self.layout.beside(place, axis, forward).is_none() {
                        self.enter(block, if forward { HIGH[axis] } else { LOW[axis] }, OUTSIDE);
                    }
                }
            }
        }
        self.spread(OUTSIDE)?;
        for brick in 0..self.places.len() {
            loop {
                self.meter.check_cancelled()?;
                let unknown = self.unknown(brick);
                let Some((node, distance)) = self.furthest(brick, unknown) else { break };
                if distance <= CLEAR {
                    break;
                }
                let winding = self.winding_number(&self.point(brick, node))?;
                self.is_simple &= (winding - 0.5).abs() < 1.0;
                let side = if winding > 0.5 { INSIDE } else { OUTSIDE };
                self.enter(self.places[brick] as usize, 1 << node, side);
                self.spread(side)?;
            }
        }
        Ok(())
    }

    /// Notes that `nodes` of a block are on `side`; what hangs together with them follows by [`spread`](Self::spread).
    fn enter(&mut self, block: usize, nodes: Nodes, side: u8) {
        match Entry::unpack(self.grid[block]) {
            Entry::Brick(brick) => {
                let new = nodes & self.unknown(brick);
                if new == 0 {
                    return;
                }
                self.sides[usize::from(side - OUTSIDE)][brick] |= new;
                if self.waiting[brick] != 0 {
                    return;
                }
                self.waiting[brick] = 1;
            }
            Entry::Far(_) if self.far[block] == UNKNOWN => self.far[block] = side,
            Entry::Far(_) => return,
        }
        // Every block is on the stack at most once.
        self.stack[self.height] = block as u32;
        self.height += 1;
    }

    fn spread(&mut self, side: u8) -> Result<(), Stop> {
        while self.height > 0 {
            self.meter.check_cancelled()?;
            self.height -= 1;
            let block = self.stack[self.height] as usize;
            let mut reached = ALL;
            if let Entry::Brick(brick) = Entry::unpack(self.grid[block]) {
                self.waiting[brick] = 0;
                let nodes = &mut self.sides[usize::from(side - OUTSIDE)][brick];
                *nodes = flood(*nodes, &self.links[brick]);
                reached = *nodes;
            }
            let place = self.layout.place(block);
            for axis in 0..3 {
                let shared = [
                    (true, (reached & HIGH[axis]) >> ACROSS[axis]),
                    (false, (reached & LOW[axis]) << ACROSS[axis]),
                ];
                for (forward, nodes) in shared {
                    if nodes != 0
                        && let Some(next) = self.layout.beside(place, axis, forward)
                    {
                        self.enter(next, nodes, side);
                    }
                }
            }
        }
        Ok(())
    }

    /// Open meshes: computes one winding number in each part of a brick, and more where that one is not certain.
    fn ask_bricks(&mut self) -> Result<(), Stop> {
        let aabb = self.surface.aabb();
        for brick in 0..self.places.len() {
            while let Some((node, distance)) = self.furthest(brick, self.unknown(brick)) {
                self.meter.check_cancelled()?;
                if distance <= CLEAR {
                    break;
                }
                let part = flood(1 << node, &self.links[brick]) & self.unknown(brick);
                let winding = self.winding_number(&self.point(brick, node))?;
                if (winding - 0.5).abs() > CERTAIN {
                    self.sides[usize::from(winding > 0.5)][brick] |= part;
                    continue;
                }
                for octant in 0..8 {
                    let group = part & octant_nodes(octant);
                    if let Some((node, _)) = self.furthest(brick, group) {
                        let inside = self.winding_number(&self.point(brick, node))? > 0.5;
                        self.sides[usize::from(inside)][brick] |= group;
                    }
                }
            }
            let inside = self.sides[1][brick];
            let (low, high) = (self.point(brick, 0), self.point(brick, BRICK_NODES - 1));
            if inside != 0 && !(aabb.contains(&low) && aabb.contains(&high)) {
                let out = each(inside)
                    .filter(|&node| !aabb.contains(&self.point(brick, node)))
                    .fold(0, |out, node| out | 1 << node);
                self.sides[0][brick] |= out;
                self.sides[1][brick] &= !out;
            }
        }
        Ok(())
    }

    /// Open meshes: computes winding numbers for the blocks without bricks, one for two by two by two blocks where it is certain.
    fn ask_blocks(&mut self) -> Result<(), Stop> {
        let aabb = self.surface.aabb();
        let blocks = self.layout.blocks;
        for z in (0..blocks[2]).step_by(2) {
            for y in (0..blocks[1]).step_by(2) {
                for x in (0..blocks[0]).step_by(2) {
                    self.meter.check_cancelled()?;
                    let all = (0..8).map(|i| [x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)]);
                    let in_grid = all.filter(|place| (0..3).all(|axis| place[axis] < blocks[axis]));
                    let mut winding = None::<f32>;
                    for place in in_grid {
                        let block = self.layout.index(place);
                        let Entry::Far(_) = Entry::unpack(self.grid[block]) else { continue };
                        let point = self.layout.in_object(&self.layout.centre(block));
                        let inside = if aabb.contains(&point) {
                            match winding {
                                Some(winding) if (winding - 0.5).abs() > CERTAIN => {}
                                _ => winding = Some(self.winding_number(&point)?),
                            }
                            winding.is_some_and(|winding| winding > 0.5)
                        } else {
                            false
                        };
                        self.far[block] = if inside { INSIDE } else { OUTSIDE };
                    }
                }
            }
        }
        Ok(())
    }

    /// Decides for the remaining nodes and writes the signed distances.
    fn finish(&mut self, nodes: &mut [i16]) -> Result<(), Stop> {
        for (brick, nodes) in nodes.chunks_exact_mut(BRICK_NODES).enumerate() {
            self.meter.check_cancelled()?;
            let mut inside = self.sides[1][brick];
            let mut verdicts = [None; 2];
            for node in each(self.unknown(brick)) {
                inside |= Nodes::from(self.is_inside(brick, node, &mut verdicts)?) << node;
            }
            self.sides[1][brick] = inside;
            let distances = &self.nearest.distances[brick];
            for (node, to) in nodes.iter_mut().enumerate() {
                let size = (distances[node] * (1.0 / QUANTUM) + 0.5).min(f32::from(i16::MAX)) as i32 as i16;
                *to = if inside >> node & 1 == 0 { size } else { -size };
            }
        }
        Ok(())
    }

    /// Whether a node very close to the mesh is inside. `verdicts` are those on nodes of the brick that were behind and in
    /// front of their nearest triangle.
    fn is_inside(
        &mut self,
        brick: usize,
        node: usize,
        verdicts: &mut [Option<bool>; 2],
    ) -> Result<bool, Stop> {
        let local = self.local(brick, node);
        let (distances, triangles) = (&self.nearest.distances[brick], &self.nearest.triangles[brick]);
        // None is known only far from the mesh, where the side is known.
        let Some(frame) = self.frames.get(triangles[node] as usize) else {
            return self.is_point_inside(brick, node);
        };
        let height = frame.height(&local);
        let is_above_face = height.abs() >= ABOVE_FACE * distances[node];
        if self.is_simple && is_above_face {
            return Ok(height * self.surface.orientation() < 0.0);
        }
        if !self.is_simple {
            // As a neighbour that is on the same side of both triangles.
            let known = self.sides[0][brick] | self.sides[1][brick];
            for other in each((BESIDE[node] | DIAGONAL[node]) & known) {
                let Some(its) = self.frames.get(triangles[other] as usize) else { continue };
                let there = self.local(brick, other);
                if frame.height(&there) * height > 0.0 && its.height(&there) * its.height(&local) > 0.0 {
                    return Ok(self.sides[1][brick] >> other & 1 == 1);
                }
            }
        }
        // In walls thinner than a voxel there are many, and what is right behind one face is right behind the next.
        let verdict = &mut verdicts[usize::from(height > 0.0)];
        match *verdict {
            Some(inside) if is_above_face => Ok(inside),
            _ => {
                let inside = self.is_point_inside(brick, node)?;
                if is_above_face {
                    *verdict = Some(inside);
                }
                Ok(inside)
            }
        }
    }
}

/// The nodes of one of the eight corners of a brick; its middle layers belong to the far ones.
fn octant_nodes(octant: usize) -> Nodes {
    (0..3).fold(ALL, |nodes, axis| {
        let low = LOW[axis] | LOW[axis] << STEP[axis];
        nodes & if octant >> axis & 1 == 0 { low } else { !low }
    })
}

/// Whether every edge of the triangles is matched by one that runs back, wherever it is: then winding numbers are whole.
///
/// The sum over all edges of a number for each, whose sign an edge and its reverse differ in. That the sum is zero by
/// chance is as likely as to guess 64 bits. Corners count as the same if they are within a 65536th of the box, far less
/// than a voxel: a crack as narrow does not let anything through.
fn is_closed(surface: &Surface, meter: &Meter) -> Result<bool, Stop> {
    let scramble = |mut x: u64| {
        x = (x ^ x >> 32).wrapping_mul(0x9E6C_63D0_676A_9A99);
        x = (x ^ x >> 29).wrapping_mul(0xD3B5_4F1C_8A2E_7B45);
        x ^ x >> 32
    };
    let aabb = surface.aabb();
    let scale = 65_536.0 / aabb.extents().max();
    let corner = |p: &Point| {
        let [x, y, z] = [0, 1, 2].map(|i| ((p[i] - aabb.min[i]) * scale + 0.5) as u64);
        scramble(x | y << 20 | z << 40)
    };
    let edge = |a: u64, b: u64| {
        scramble(a.wrapping_add(b.rotate_left(21))).wrapping_sub(scramble(b.wrapping_add(a.rotate_left(21))))
    };
    let mut sum = 0_u64;
    for (step, corners) in surface.triangles().iter().enumerate() {
        meter.check_at(step)?;
        let [a, b, c] = [corner(&corners[0]), corner(&corners[1]), corner(&corners[2])];
        sum = sum.wrapping_add(edge(a, b)).wrapping_add(edge(b, c)).wrapping_add(edge(c, a));
    }
    Ok(sum == 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;
    use crate::test_shapes::{Shape, ball, grid};

    #[test]
    fn only_whole_meshes_are_closed() {
        let check = |shape: &Shape| {
            let mesh = shape.mesh();
            let count = mesh.triangles().len();
            let mut memory = vec![0; model_bytes(Surface::bytes(count) + Surface::scratch_bytes(count))];
            let mut arena = Arena::new(&mut memory, 0).unwrap();
            let meter = Meter::unwatched();
            is_closed(&Surface::build(&mesh, false, &mut arena, &meter).unwrap(), &meter).unwrap()
        };
        // Its poles are many corners that differ by roundings.
        let mut ball = ball(1.0, 9, 14);
        assert!(check(&ball) && check(&ball.inside_out()));
        ball.triangles.remove(60);
        assert!(!check(&ball) && !check(&grid(1.0, 3)));
    }
}
