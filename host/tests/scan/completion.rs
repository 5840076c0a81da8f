//! Scans of few images, completed.

use crate::scene::{RADIUS, Scene};
use hangpose::files::depth::read_scan;
use hangpose::perception::completion::CompletionSettings;
use hangpose::perception::volume::VolumeSettings;
use hangpose::{Monitor, complete_scan, scan};
use std::collections::HashSet;

/// One image of a ball gives all of it, if balls of its size are allowed behind what was seen.
#[test]
fn one_image_of_a_ball_becomes_a_closed_ball() {
    let files = read_scan(&Scene::new().sources()).unwrap();
    let (one, voxel) = (&files.frames[..1], 0.004);
    let settings = VolumeSettings::new(voxel);
    let guess = CompletionSettings { thickness: 2.0 * RADIUS, radius: 1.2 * RADIUS };
    let mesh = complete_scan(one, &settings, &guess, &Monitor::new()).unwrap();
    let edges: HashSet<_> =
        mesh.triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]).collect();
    assert!(edges.len() == 3 * mesh.triangles.len() && edges.iter().all(|(a, b)| edges.contains(&(*b, *a))));
    let off = |v: &[f32; 3]| (v.iter().map(|x| x * x).sum::<f32>().sqrt() - RADIUS).abs();
    let near = mesh.vertices.iter().filter(|v| off(v) < 3.0 * voxel).count();
    assert!(near * 100 > 95 * mesh.vertices.len(), "{near} of {}", mesh.vertices.len());
    assert!(mesh.seen.contains(&0) && mesh.seen.contains(&1));
    let open = scan(one, &settings, &Monitor::new()).unwrap();
    assert!(open.vertices.len() < mesh.vertices.len() && !open.seen.contains(&0));
}
