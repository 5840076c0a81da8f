//! The zero level of signed distances on a grid, by marching tetrahedra (Doi and Koide 1991).

use super::Surface;
use super::volume::Grid;
use hangpose::geometry::Vector;
use std::collections::HashMap;

/// The six tetrahedra of a cube around its diagonal, which meet those of the neighbouring cubes in the same diagonals.
/// Bit k of a corner is its step along axis k. All are positively oriented.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 3, 2, 7], [0, 6, 4, 7], [0, 5, 1, 7]];

/// The orders of four corners that keep the orientation.
const EVEN: [[usize; 4]; 12] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 0, 3, 2],
    [1, 2, 0, 3],
    [1, 3, 2, 0],
    [2, 0, 1, 3],
    [2, 1, 3, 0],
    [2, 3, 0, 1],
    [3, 0, 2, 1],
    [3, 1, 0, 2],
    [3, 2, 1, 0],
];

/// The zero level in all tetrahedra whose corners are known. Triangles face the positive side.
pub(super) fn surface(grid: &Grid) -> Surface {
    let [columns, rows, layers] = grid.size;
    let steps = [1, columns, columns * rows];
    let corner = |k: usize| (0..3).map(|axis| (k >> axis & 1) * steps[axis]).sum::<usize>();
    let corners: [usize; 8] = std::array::from_fn(corner);
    let mut level = Level { grid, numbers: HashMap::new(), surface: Surface::default() };
    for z in 0..layers - 1 {
        for y in 0..rows - 1 {
            for x in 0..columns - 1 {
                let first = x + columns * (y + rows * z);
                for tetrahedron in TETRAHEDRA {
                    level.cut(tetrahedron.map(|k| first + corners[k]));
                }
            }
        }
    }
    level.surface
}

/// The surface so far, with the vertex on each edge of the grid that it crosses.
struct Level<'g> {
    grid: &'g Grid,
    numbers: HashMap<[usize; 2], u32>,
    surface: Surface,
}

impl Level<'_> {
    /// Adds the triangles in one tetrahedron of nodes.
    fn cut(&mut self, nodes: [usize; 4]) {
        let distances = nodes.map(|node| self.grid.distances[node]);
        if distances.iter().any(|distance| distance.is_nan()) {
            return;
        }
        let inside = distances.map(|distance| distance < 0.0);
        let count = inside.iter().filter(|inside| **inside).count();
        let order = |is_first: &dyn Fn([bool; 4]) -> bool| {
            let order = EVEN.into_iter().find(|order| is_first(order.map(|k| inside[k])));
            order.expect("an even order brings every node to the front").map(|k| nodes[k])
        };
        match count {
            1 => {
                let [a, b, c, d] = order(&|[a, ..]| a);
                self.add([[a, b], [a, c], [a, d]]);
            }
            2 => {
                let [a, b, c, d] = order(&|[a, b, ..]| a && b);
                self.add([[a, c], [a, d], [b, d]]);
                self.add([[a, c], [b, d], [b, c]]);
            }
            3 => {
                let [a, b, c, d] = order(&|[a, ..]| !a);
                self.add([[a, d], [a, c], [a, b]]);
            }
            _ => {}
        }
    }

    fn add(&mut self, edges: [[usize; 2]; 3]) {
        let triangle = edges.map(|edge| self.vertex(edge));
        self.surface.triangles.push(triangle);
    }

    /// The vertex where the distance along an edge is zero.
    fn vertex(&mut self, [a, b]: [usize; 2]) -> u32 {
        let Grid { origin, spacing, size: [columns, rows, _], distances } = self.grid;
        *self.numbers.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let place = |node: usize| {
                Vector::from([node % columns, node / columns % rows, node / columns / rows].map(|k| k as f32))
            };
            let share = distances[a] / (distances[a] - distances[b]);
            let vertex = origin + place(a).lerp(&place(b), share) * *spacing;
            self.surface.vertices.push(vertex.into());
            self.surface.vertices.len() as u32 - 1
        })
    }
}
