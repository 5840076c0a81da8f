//! Marching cubes (Lorensen and Cline, SIGGRAPH 1987): the triangles in a cell for each choice of corners inside.
//!
//! The table follows from one rule, worked out at compile time: on each face of the cell, a line goes around each run of
//! outside corners, so that two inside corners at a diagonal stay joined. The lines of all faces close into loops. Two
//! cells draw the same lines on the face that they share, and no triangle has an edge in a face that is not such a line,
//! so every edge of the surface has exactly two triangles.

/// Most triangles in a cell.
pub(super) const MAX_TRIANGLES: usize = 5;
/// Edges of a cell: four along x, four along y, four along z.
pub(super) const EDGES: usize = 12;
const CASES: usize = 256;
/// Longest loop.
const MAX_LOOP: usize = 7;

/// Triangles of one case.
#[derive(Clone, Copy)]
pub(super) struct Case {
    pub(super) count: u8,
    /// The edges, see [`edge_corner`], on which the vertices are, counter-clockwise seen from outside.
    pub(super) triangles: [[u8; 3]; MAX_TRIANGLES],
    /// A bit for each edge that is used.
    pub(super) edges: u16,
}

/// Cases by the corners inside: bit `x + 2 y + 4 z` is the corner at x, y, z.
pub(super) static CASE: [Case; CASES] = cases();

/// Axis along which an edge runs.
pub(super) const fn edge_axis(edge: usize) -> usize {
    edge / 4
}

/// Corner at which an edge begins.
pub(super) const fn edge_corner(edge: usize) -> usize {
    let (first, second) = (edge % 2, edge / 2 % 2);
    match edge_axis(edge) {
        0 => first << 1 | second << 2,
        1 => first | second << 2,
        _ => first | second << 1,
    }
}

/// The edge between two corners.
const fn edge_between(a: usize, b: usize) -> usize {
    let low = a & b;
    match a ^ b {
        1 => low >> 1,
        2 => 4 + (low & 1 | low >> 1 & 2),
        _ => 8 + (low & 3),
    }
}

/// The corners of a face, counter-clockwise seen from outside of the cell.
const fn face(index: usize) -> [usize; 4] {
    let (axis, side) = (index / 2, index % 2);
    let base = side << axis;
    let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
    if side == 1 {
        [base, base | u, base | u | v, base | v]
    } else {
        [base, base | v, base | u | v, base | u]
    }
}

/// Whether two edges lie in one face.
const fn share_face(a: usize, b: usize) -> bool {
    let mut index = 0;
    while index < 6 {
        if is_in_face(a, index) && is_in_face(b, index) {
            return true;
        }
        index += 1;
    }
    false
}

const fn is_in_face(edge: usize, index: usize) -> bool {
    let (axis, side) = (index / 2, index % 2);
    edge_axis(edge) != axis && edge_corner(edge) >> axis & 1 == side
}

/// For each edge that a case cuts, the next on its loop; [`EDGES`] for the others.
const fn successors(inside: usize) -> [usize; EDGES] {
    let mut next = [EDGES; EDGES];
    let mut index = 0;
    while index < 6 {
        let corners = face(index);
        let mut i = 0;
        while i < 4 {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            if inside >> a & 1 == 1 && inside >> b & 1 == 0 {
                // A run of outside corners begins at b; the line goes to where it ends.
                let mut j = (i + 1) % 4;
                while inside >> corners[(j + 1) % 4] & 1 == 0 {
                    j = (j + 1) % 4;
                }
                next[edge_between(corners[j], corners[(j + 1) % 4])] = edge_between(a, b);
            }
            i += 1;
        }
        index += 1;
    }
    next
}

const fn cases() -> [Case; CASES] {
    let mut cases = [Case { count: 0, triangles: [[0; 3]; MAX_TRIANGLES], edges: 0 }; CASES];
    let mut inside = 0;
    while inside < CASES {
        let mut next = successors(inside);
        let mut edge = 0;
        while edge < EDGES {
            // Takes the loop through this edge out of the list.
            let (mut ring, mut length, mut at) = ([0; MAX_LOOP], 0, edge);
            while next[at] < EDGES {
                ring[length] = at;
                length += 1;
                cases[inside].edges |= 1 << at;
                let following = next[at];
                next[at] = EDGES;
                at = following;
            }
            if length > 0 {
                cases[inside] = fan(cases[inside], ring, length);
            }
            edge += 1;
        }
        inside += 1;
    }
    cases
}

/// Adds the triangles of a loop, from the first vertex whose diagonals all lie within the cell.
const fn fan(mut case: Case, ring: [usize; MAX_LOOP], length: usize) -> Case {
    let mut start = 0;
    while !is_within(&ring, length, start) {
        start += 1;
    }
    let mut i = 1;
    while i + 1 < length {
        let (b, c) = (ring[(start + i) % length], ring[(start + i + 1) % length]);
        case.triangles[case.count as usize] = [ring[start] as u8, b as u8, c as u8];
        case.count += 1;
        i += 1;
    }
    case
}

const fn is_within(ring: &[usize; MAX_LOOP], length: usize, start: usize) -> bool {
    let mut i = 2;
    while i + 1 < length {
        if share_face(ring[start], ring[(start + i) % length]) {
            return false;
        }
        i += 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    #[test]
    fn each_edge_lies_between_two_corners_of_which_one_is_inside() {
        for (inside, case) in CASE.iter().enumerate() {
            for edge in 0..EDGES {
                let (a, b) = (edge_corner(edge), edge_corner(edge) | 1 << edge_axis(edge));
                assert_eq!(edge_between(a, b), edge);
                let is_cut = (inside >> a ^ inside >> b) & 1 == 1;
                assert_eq!(case.edges >> edge & 1 == 1, is_cut, "{inside:08b} {edge}");
            }
        }
    }

    /// Directed edges of the triangles of a case, those within the cell left out, as they come twice.
    fn border(case: &Case) -> HashMap<(u8, u8), i32> {
        let mut border = HashMap::new();
        for triangle in &case.triangles[..case.count as usize] {
            for i in 0..3 {
                *border.entry((triangle[i], triangle[(i + 1) % 3])).or_insert(0) += 1;
            }
        }
        let both = |&(a, b): &(u8, u8)| border.contains_key(&(b, a));
        border.iter().filter(|(edge, _)| !both(edge)).map(|(edge, count)| (*edge, *count)).collect()
    }

    /// Neighbouring cells fit together: for all corners of two cells side by side, what one draws on the shared face, the
    /// other draws the other way around.
    #[test]
    fn neighbours_draw_the_same_lines_on_their_shared_face() {
        for axis in 0..3 {
            // On the upper face of the first cell and the lower of the second, by the corners of the face.
            let mut lines: HashMap<(usize, usize), Vec<_>> = HashMap::new();
            for (inside, case) in CASE.iter().enumerate() {
                for side in 0..2 {
                    let corners = (0..8).filter(|corner| corner >> axis & 1 == side);
                    let pattern = corners.fold(0, |pattern, corner| pattern << 1 | inside >> corner & 1);
                    // Edges are named as on the lower face.
                    let name = |edge: u8| {
                        let low = edge_corner(edge as usize) & !(1 << axis);
                        edge_between(low, low | 1 << edge_axis(edge as usize))
                    };
                    let mut on_face: Vec<_> = border(case)
                        .into_iter()
                        .filter(|((a, b), _)| {
                            [a, b].iter().all(|edge| is_in_face(**edge as usize, 2 * axis + side))
                        })
                        .map(|((a, b), count)| {
                            let (a, b) = (name(a), name(b));
                            (if side == 0 { (a, b) } else { (b, a) }, count)
                        })
                        .collect();
                    on_face.sort();
                    assert!(on_face.iter().all(|(_, count)| *count == 1));
                    let known = lines.entry((axis, pattern)).or_insert_with(|| on_face.clone());
                    assert_eq!(*known, on_face, "{inside:08b} along {axis}");
                }
            }
        }
    }

    #[test]
    fn one_corner_inside_gives_a_triangle_that_faces_away_from_it() {
        let case = &CASE[1];
        assert_eq!(case.count, 1);
        // Edges 0, 4 and 8 begin at this corner, along x, y and z: counter-clockwise seen from outside.
        let first = case.triangles[0].iter().position(|edge| *edge == 0).unwrap();
        let turned = [0, 1, 2].map(|i| case.triangles[0][(first + i) % 3]);
        assert_eq!(turned, [0, 4, 8]);
    }
}
