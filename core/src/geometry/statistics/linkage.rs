//! Clustering by single linkage.

use crate::geometry::Point;

/// Single linkage, for the one cluster that holds `points[0]`: moves its members to the front and returns how
/// many they are. Two points closer than `link` metres are in the same cluster.
///
/// Gives up with `None` as soon as a member lies farther than `reach` metres from `points[0]`.
pub(crate) fn linked_cluster(points: &mut [Point], link: f32, reach: f32) -> Option<usize> {
    let first = *points.first()?;
    // In front those whose neighbours are in, then members still to be looked at, then the others. The newest
    // member goes first: it is far out, so that few steps reach all of a dense slice.
    let (mut done, mut members) = (0, 1);
    while done < members && members < points.len() {
        points.swap(done, members - 1);
        let from = points[done];
        done += 1;
        let others = members..points.len();
        for i in others {
            if (points[i] - from).norm_squared() < link * link {
                if (points[i] - first).norm_squared() > reach * reach {
                    return None;
                }
                points.swap(members, i);
                members += 1;
            }
        }
    }
    Some(members)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Union of all pairs closer than the link, by brute force.
    fn brute_force_linkage(points: &[Point], link: f32) -> Vec<usize> {
        let mut labels: Vec<usize> = (0..points.len()).collect();
        for i in 0..points.len() {
            for j in 0..i {
                if (points[i] - points[j]).norm_squared() < link * link {
                    let (keep, lose) = (labels[i].min(labels[j]), labels[i].max(labels[j]));
                    labels.iter_mut().filter(|l| **l == lose).for_each(|l| *l = keep);
                }
            }
        }
        labels
    }

    #[test]
    fn linked_cluster_agrees_with_brute_force() {
        for seed in 0..20 {
            let mut random = Random::new(seed);
            let points: Vec<Point> =
                (0..200).map(|_| Point::new(random.next_f32(), random.next_f32(), 0.0)).collect();
            let labels = brute_force_linkage(&points, 0.06);
            let mut moved = points.clone();
            let count = linked_cluster(&mut moved, 0.06, f32::INFINITY).unwrap();
            assert_eq!(count, labels.iter().filter(|&&l| l == labels[0]).count());
            let key = |p: &Point| (p.x.to_bits(), p.y.to_bits());
            let mut found: Vec<_> = moved[..count].iter().map(key).collect();
            let mut expected: Vec<_> =
                points.iter().zip(&labels).filter(|(_, l)| **l == labels[0]).map(|(p, _)| key(p)).collect();
            found.sort_unstable();
            expected.sort_unstable();
            assert_eq!(found, expected);
            let extent = moved[..count].iter().map(|p| (p - points[0]).norm()).fold(0.0, f32::max);
            assert_eq!(linked_cluster(&mut points.clone(), 0.06, extent * 1.001), Some(count));
            if extent > 0.0 {
                assert_eq!(linked_cluster(&mut points.clone(), 0.06, extent * 0.999), None);
            }
        }
        assert_eq!(linked_cluster(&mut [], 1.0, 1.0), None);
    }
}
