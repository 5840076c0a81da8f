//! Triangulation of polygons.

use earcut::Earcut;
use earcut::utils3d::project3d_to_2d;

/// Triangulates polygons and keeps their winding order; reuses its buffers.
#[derive(Default)]
pub(super) struct Triangulator {
    earcut: Earcut<f64>,
    corners: Vec<[f64; 3]>,
    flat: Vec<[f64; 2]>,
    ears: Vec<u32>,
}

impl Triangulator {
    /// Appends the triangles of the polygon with corners `ring`, at least three.
    ///
    /// The polygon may be concave, have corners on straight edges, and be slightly non-planar.
    pub(super) fn append(&mut self, vertices: &[[f32; 3]], ring: &[u32], triangles: &mut Vec<[u32; 3]>) {
        match *ring {
            [a, b, c] => push(triangles, [a, b, c]),
            [a, b, c, d] => {
                let corners = [a, b, c, d].map(|i| vertices[i as usize].map(f64::from));
                for triangle in quad(&corners) {
                    push(triangles, triangle.map(|i| ring[i]));
                }
            }
            _ => {
                self.corners.clear();
                self.corners.extend(ring.iter().map(|&i| vertices[i as usize].map(f64::from)));
                self.ears.clear();
                // Projected along the normal, so that earcut's triangles, which are always counter-clockwise, have the
                // winding order of the polygon.
                if project3d_to_2d(&self.corners, ring.len(), &mut self.flat) {
                    self.earcut.earcut_slice(&self.flat, &[], &mut self.ears);
                }
                // earcut returns nothing for a polygon without area; a fan keeps its neighbours connected.
                if self.ears.is_empty() {
                    self.ears.extend((2..ring.len() as u32).flat_map(|i| [0, i - 1, i]));
                }
                for ear in self.ears.chunks_exact(3) {
                    push(triangles, [0, 1, 2].map(|k| ring[ear[k] as usize]));
                }
            }
        }
    }
}

/// Adds a triangle unless it repeats a corner, as a polygon that touches itself can cause.
fn push(triangles: &mut Vec<[u32; 3]>, [a, b, c]: [u32; 3]) {
    if a != b && b != c && c != a {
        triangles.push([a, b, c]);
    }
}

/// Cuts along the diagonal whose two triangles have the same winding order. In a concave quadrilateral it is the inner
/// one.
fn quad(p: &[[f64; 3]; 4]) -> [[usize; 3]; 2] {
    let candidates = [[[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [1, 3, 0]]];
    let [first, second] = candidates.map(|[s, t]| {
        let (m, n) = (normal(s.map(|i| p[i])), normal(t.map(|i| p[i])));
        m[0] * n[0] + m[1] * n[1] + m[2] * n[2]
    });
    if first > 0.0 || first >= second { candidates[0] } else { candidates[1] }
}

fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}
