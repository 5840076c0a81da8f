//! Sets of the nodes of a brick, as bits of a `u128`: node (x, y, z) is bit x + 5 y + 25 z.

/// Voxels along each side of a block.
pub(super) const BLOCK: u32 = 4;
/// Nodes along each side of a brick, both ends included. Bricks side by side have a face of nodes in common.
pub(super) const SIDE: usize = BLOCK as usize + 1;
/// Nodes of a brick.
pub(super) const BRICK_NODES: usize = SIDE * SIDE * SIDE;
/// `BRICK_NODES` padded to a multiple of four, for four lanes at once.
pub(super) const PADDED: usize = 128;
/// Stride of the node index along each axis.
pub(super) const STEP: [usize; 3] = [1, SIDE, SIDE * SIDE];

/// A set of nodes of a brick.
pub(super) type Nodes = u128;

/// All nodes.
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

/// A place in a padded brick that is no node.
pub(super) const NOWHERE: usize = PADDED - 1;
/// The neighbours of each node before and after it along each axis; [`NOWHERE`] where there is none.
pub(super) const ALONG: [[[u8; 2]; 3]; BRICK_NODES] = {
    let mut all = [[[NOWHERE as u8; 2]; 3]; BRICK_NODES];
    let mut i = 0;
    while i < 3 * BRICK_NODES {
        let (node, axis) = (i / 3, i % 3);
        let at = coordinates(node)[axis];
        if at > 0 {
            all[node][axis][0] = (node - STEP[axis]) as u8;
        }
        if at < BLOCK as usize {
            all[node][axis][1] = (node + STEP[axis]) as u8;
        }
        i += 1;
    }
    all
};

/// Coordinates of a node within its brick.
pub(super) const fn coordinates(node: usize) -> [usize; 3] {
    [node % SIDE, node / SIDE % SIDE, node / (SIDE * SIDE)]
}

/// Coordinates of all nodes, one row per axis.
pub(super) const COORDINATES: [[f32; PADDED]; 3] = {
    let mut all = [[0.0; PADDED]; 3];
    let mut node = 0;
    while node < BRICK_NODES {
        let at = coordinates(node);
        (all[0][node], all[1][node], all[2][node]) = (at[0] as f32, at[1] as f32, at[2] as f32);
        node += 1;
    }
    all
};

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

/// The nodes for whose value and the value `step` nodes on something is true.
#[inline]
pub(super) fn compare(values: &[f32; PADDED], step: usize, is: impl Fn(f32, f32) -> bool) -> Nodes {
    let mut flags = [0_u8; PADDED];
    for (flag, (&a, &b)) in flags[..BRICK_NODES - step].iter_mut().zip(values.iter().zip(&values[step..])) {
        *flag = u8::from(is(a, b));
    }
    // Eight bytes to eight bits: each is moved to the top by a factor of its own.
    let (bytes, _) = flags.as_chunks();
    bytes.iter().rev().fold(0, |all, &byte| {
        let bits = u64::from_le_bytes(byte).wrapping_mul(0x0102_0408_1020_4080) >> 56;
        all << 8 | Nodes::from(bits)
    })
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
            let along = ALONG[node].iter().flatten().map(|&other| usize::from(other));
            let along: Vec<usize> = along.filter(|&other| other != NOWHERE).collect();
            assert_eq!(along.iter().fold(0, |all, other| all | 1 << other), BESIDE[node]);
            assert!(ALONG[node].iter().all(|[before, after]| usize::from(*before) > node || before < after));
        }
        let mut values = [0.0; PADDED];
        for node in [3, 8, 77, 124] {
            values[node] = 1.0;
        }
        assert_eq!(compare(&values, 0, |a, _| a > 0.5), 1 << 3 | 1 << 8 | 1 << 77 | 1 << 124);
        assert_eq!(compare(&values, 5, |a, b| a + b > 1.5), 1 << 3);
        assert_eq!(each(LOW[2] | HIGH[0]).count(), 45);
    }
}
