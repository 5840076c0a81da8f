//! The same surface in more triangles.

use std::collections::{BinaryHeap, HashMap};

/// A triangle mesh: vertices and vertex indices.
pub type Triangles = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// Makes one vertex of all at the same position.
pub fn weld(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Triangles {
    let (mut kept, mut places) = (Vec::new(), HashMap::new());
    let names: Vec<u32> = vertices
        .iter()
        .map(|vertex| {
            // Adding zero turns -0 into 0.
            *places.entry(vertex.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                kept.push(*vertex);
                kept.len() as u32 - 1
            })
        })
        .collect();
    (kept, triangles.iter().map(|triangle| triangle.map(|vertex| names[vertex as usize])).collect())
}

/// Halves the longest edges, in all triangles that share them, until there are at least `count` triangles. Edges are shared by
/// index, see [`weld`]. The surface stays the same, and a closed one stays closed.
pub fn refine((mut vertices, mut triangles): Triangles, count: usize) -> Triangles {
    let mut edges: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
    for (index, &[a, b, c]) in (0..).zip(&triangles) {
        for edge in [[a, b], [b, c], [c, a]] {
            edges.entry(sorted(edge)).or_default().push(index);
        }
    }
    // Lengths are positive, so that their bits have the same order. Equally long edges follow their indices.
    let length = |vertices: &[[f32; 3]], [a, b]: [u32; 2]| {
        let [p, q] = [a, b].map(|index| vertices[index as usize]);
        (0..3).map(|k| (q[k] - p[k]).powi(2)).sum::<f32>().to_bits()
    };
    let mut longest: BinaryHeap<(u32, [u32; 2])> =
        edges.keys().map(|&edge| (length(&vertices, edge), edge)).collect();
    while triangles.len() < count {
        let Some((_, edge)) = longest.pop() else { break };
        let Some(around) = edges.remove(&edge) else { continue };
        let [from, to] = edge;
        let middle = vertices.len() as u32;
        let [p, q] = edge.map(|index| vertices[index as usize]);
        vertices.push([0, 1, 2].map(|k| p[k] + 0.5 * (q[k] - p[k])));
        let mut touched = vec![[from, middle], [middle, to]];
        for index in around {
            let old = triangles[index as usize];
            let half = |end| old.map(|vertex| if vertex == end { middle } else { vertex });
            let new = triangles.len() as u32;
            triangles[index as usize] = half(to);
            triangles.push(half(from));
            let Some(&apex) = old.iter().find(|vertex| !edge.contains(vertex)) else { continue };
            if let Some(beside) = edges.get_mut(&sorted([to, apex])) {
                for user in beside.iter_mut().filter(|user| **user == index) {
                    *user = new;
                }
            }
            edges.entry(sorted([from, middle])).or_default().push(index);
            edges.entry(sorted([middle, to])).or_default().push(new);
            edges.entry(sorted([middle, apex])).or_default().extend([index, new]);
            touched.push([middle, apex]);
        }
        longest.extend(touched.into_iter().map(|edge| (length(&vertices, edge), sorted(edge))));
    }
    (vertices, triangles)
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::OBJECTS;
    use crate::solid::Solid;

    /// Volume by the divergence theorem, m³.
    fn volume((vertices, triangles): &Triangles) -> f64 {
        let corner = |index: u32| nalgebra::Vector3::from(vertices[index as usize]).cast::<f64>();
        let part = |&[a, b, c]: &[u32; 3]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0;
        triangles.iter().map(part).sum()
    }

    #[test]
    fn finer_mesh_is_the_same_solid() {
        let solid = OBJECTS[0].make(1).solid;
        let welded = weld(&solid.vertices, &solid.triangles);
        let count = 3 * welded.1.len();
        let finer = refine(welded.clone(), count);
        assert!(finer.1.len() >= count && finer.1.len() <= count + 8, "{}", finer.1.len());
        assert!((volume(&finer) / volume(&welded) - 1.0).abs() < 1e-4);
        let (vertices, triangles) = finer;
        assert!(Solid { vertices, triangles, ..solid }.is_closed());
    }
}
