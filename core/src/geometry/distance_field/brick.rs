//! Sets of the nodes of a brick, as bits of a `u128`: node (x, y, z) is bit x + 5 y + 25 z.

/// Voxels along each side of a block.
pub(super) const BLOCK: u32 = 4;
/// Nodes along each side of a brick, both ends included. Bricks side by side have a face of nodes in common.
pub(super) const SIDE: usize = BLOCK as usize + 1;
/// Nodes of a brick.
pub(super) const BRICK_NODES: usize = SIDE * SIDE * SIDE;
/// How much the index of a node grows along each axis.
pub(super) const STEP: [usize; 3] = [1, SIDE, SIDE * SIDE];

/// Some nodes of a brick.
pub(super) type Nodes = u128;

/// All of them.
pub(super) const ALL: Nodes = (1 << BRICK_NODES) - 1;

/// The nodes whose coordinate along each axis is 0; shifted by 4 steps, those where it is 4.
pub(super) const LOW: [Nodes; 3] = [layer(0), layer(1), layer(2)];
/// How far bits move from the low to the high face along each axis.
pub(super) const ACROSS: [usize; 3] =
    [BLOCK as usize * STEP[0], BLOCK as usize * STEP[1], BLOCK as usize * STEP[2]];
/// The nodes whose coordinate along each axis is 4.
pub(super) const HIGH: [Nodes; 3] = [LOW[0] << ACROSS[0], LOW[1] << ACROSS[1], LOW[2] << ACROSS[2]];

/// The up to 6 neighbours of each node.
pub(super) const BESIDE: [Nodes; BRICK_NODES] = neighbours(1);
/// The up to 20 neighbours of each node across edges and corners.
pub(super) const DIAGONAL: [Nodes; BRICK_NODES] = neighbours(3);

/// Coordinates of a node within its brick.
pub(super) const fn coordinates(node: usize) -> [usize; 3] {
    [node % SIDE, node / SIDE % SIDE, node / (SIDE * SIDE)]
}

const fn layer(axis: usize) -> Nodes {
    let (mut nodes, mut node) = (0, 0);
    while node < BRICK_NODES {
        if coordinates(node)[axis] == 0 {
            nodes |= 1 << node;
        }
        node += 1;
    }
    nodes
}

/// The nodes one step away along one axis, or along two or three if `axes` is 3.
const fn neighbours(axes: usize) -> [Nodes; BRICK_NODES] {
    let mut all = [0; BRICK_NODES];
    let mut a = 0;
    while a < BRICK_NODES {
        let mut b = 0;
        while b < BRICK_NODES {
            let (p, q) = (coordinates(a), coordinates(b));
            let d = [p[0].abs_diff(q[0]), p[1].abs_diff(q[1]), p[2].abs_diff(q[2])];
            let (sum, close) = (d[0] + d[1] + d[2], d[0] < 2 && d[1] < 2 && d[2] < 2);
            if close && ((axes == 1 && sum == 1) || (axes == 3 && sum > 1)) {
                all[a] |= 1 << b;
            }
            b += 1;
        }
        a += 1;
    }
    all
}

/// `nodes` and their neighbours across faces, edges and corners.
pub(super) fn dilate(mut nodes: Nodes) -> Nodes {
    for axis in 0..3 {
        nodes |= (nodes & !HIGH[axis]) << STEP[axis] | (nodes & !LOW[axis]) >> STEP[axis];
    }
    nodes
}

/// The nodes of a set, in order.
pub(super) fn each(mut nodes: Nodes) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let node = nodes.trailing_zeros() as usize;
        nodes &= nodes.wrapping_sub(1);
        (node < BRICK_NODES).then_some(node)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_one_step_away() {
        assert_eq!(BESIDE[62].count_ones(), 6);
        assert_eq!(DIAGONAL[62].count_ones(), 20);
        assert_eq!(BESIDE[0], 1 << 1 | 1 << 5 | 1 << 25);
        for node in 0..BRICK_NODES {
            assert_eq!(dilate(1 << node), 1 << node | BESIDE[node] | DIAGONAL[node]);
        }
        assert_eq!(each(LOW[2] | HIGH[0]).count(), 45);
    }
}
