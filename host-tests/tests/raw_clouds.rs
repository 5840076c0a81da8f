//! Clouds of supporters as cameras and people hand them over: the best pose must hang on the true scene, judged in Bullet.

use hangpose::files::{CloudFile, read_mesh};
use hangpose::hanging::{HangingPose, Request};
use hangpose::{Monitor, Params, analyze_object, analyze_supporter, predict_poses, sample_supporter};
use host_tests::judge::{Bullet, Judge, Scene};
use host_tests::shapes::Random;
use host_tests::solid::Solid;
use host_tests::tables::case::{Case, Fit, POINTS, made};
use nalgebra::Vector3;
use std::path::Path;
use std::sync::Arc;

/// Where the camera is, m. Supporters point towards +x.
const EYE: [f32; 3] = [0.6, 0.15, 0.25];
/// Half the edge of walls and tables, m.
const HALF: f32 = 0.5;
/// Thickness of walls and tables, m.
const THICKNESS: f32 = 0.02;

/// A kind of cloud: what is wrong with it, and how it is made of a clean one with normals and a source of random numbers.
type Kind = (&'static str, fn(&Case, CloudFile, &mut Random) -> Raw);

/// A cloud and what is true beside the supporter.
struct Raw {
    cloud: CloudFile,
    /// Boxes by their lower and upper corners.
    boxes: Vec<[[f32; 3]; 2]>,
}

impl Raw {
    fn of(points: Vec<[f32; 3]>, normals: Option<Vec<[f32; 3]>>, viewpoints: Vec<[f32; 3]>) -> Self {
        let cloud = CloudFile { points, normals, viewpoints, ..CloudFile::default() };
        Self { cloud, boxes: Vec::new() }
    }
}

/// The points that face the eye. Bars that hide each other are seen through.
fn facing(cloud: &CloudFile) -> Vec<[f32; 3]> {
    let normals = cloud.normals.iter().flatten();
    let faces = |(point, normal): &(&[f32; 3], &[f32; 3])| {
        (0..3).map(|i| (EYE[i] - point[i]) * normal[i]).sum::<f32>() > 0.0
    };
    cloud.points.iter().zip(normals).filter(faces).map(|(point, _)| *point).collect()
}

fn moved(points: &[[f32; 3]], mut shift: impl FnMut(&[f32; 3]) -> [f32; 3]) -> Vec<[f32; 3]> {
    points
        .iter()
        .map(|point| {
            let by = shift(point);
            [0, 1, 2].map(|i| point[i] + by[i])
        })
        .collect()
}

/// Points at random on a square of a wall (across x) or of a table (across z) through `at`.
fn sheet(across: usize, at: f32, count: usize, random: &mut Random) -> Vec<[f32; 3]> {
    let coordinate = |i, random: &mut Random| {
        if i == across { at } else { random.range(-f64::from(HALF), f64::from(HALF)) as f32 }
    };
    (0..count).map(|_| [0, 1, 2].map(|i| coordinate(i, random))).collect()
}

fn least(solid: &Solid, axis: usize) -> f32 {
    solid.vertices.iter().map(|vertex| vertex[axis]).fold(f32::INFINITY, f32::min)
}

const KINDS: [Kind; 11] = [
    ("one point in a hundred is a stray", |_, cloud, random| {
        let mut points = cloud.points;
        for _ in 0..points.len() / 100 {
            points.push(
                [(-0.1, 0.3), (-0.2, 0.2), (-0.2, 0.2)].map(|(low, high)| random.range(low, high) as f32),
            );
        }
        Raw::of(points, None, vec![EYE])
    }),
    ("the wall that it is screwed to", |case, cloud, random| {
        let back = least(&case.supporter, 0);
        let points = [cloud.points, sheet(0, back, 12_000, random)].concat();
        let wall = [[back - THICKNESS, -HALF, -HALF], [back, HALF, HALF]];
        Raw { boxes: vec![wall], ..Raw::of(points, None, Vec::new()) }
    }),
    ("a table below", |case, cloud, random| {
        let top = least(&case.supporter, 2) - 0.36;
        let points = [cloud.points, sheet(2, top, 12_000, random)].concat();
        let table = [[-HALF, -HALF, top - THICKNESS], [HALF, HALF, top]];
        Raw { boxes: vec![table], ..Raw::of(points, None, vec![EYE]) }
    }),
    ("1 mm of noise", |_, cloud, random| {
        Raw::of(moved(&cloud.points, |_| [0; 3].map(|_| random.gaussian() as f32 * 0.001)), None, vec![EYE])
    }),
    ("one view with noise along its rays", |_, cloud, random| {
        let along = |point: &[f32; 3]| {
            let way = (Vector3::from(*point) - Vector3::from(EYE)).normalize();
            (way * random.gaussian() as f32 * 0.0012).into()
        };
        Raw::of(moved(&facing(&cloud), along), None, vec![EYE])
    }),
    ("normals point inwards", |_, cloud, _| {
        let normals = cloud.normals.map(|normals| normals.iter().map(|n| n.map(|x| -x)).collect());
        Raw::of(cloud.points, normals, Vec::new())
    }),
    ("normals of random sign", |_, cloud, random| {
        let mut sign = || if random.chance(0.5) { 1.0 } else { -1.0 };
        let normals = cloud.normals.map(|normals| {
            normals
                .iter()
                .map(|n| {
                    let sign = sign();
                    n.map(|x| sign * x)
                })
                .collect()
        });
        Raw::of(cloud.points, normals, Vec::new())
    }),
    ("one view", |_, cloud, _| Raw::of(facing(&cloud), None, vec![EYE])),
    ("600 points", |_, cloud, _| {
        Raw::of(cloud.points.into_iter().step_by(10_000 / 600).collect(), None, vec![EYE])
    }),
    ("each point eight times", |_, cloud, _| {
        let normals = cloud.normals.map(|normals| normals.repeat(8));
        Raw::of(cloud.points.repeat(8), normals, Vec::new())
    }),
    ("rounded to millimetres", |_, cloud, _| {
        let points = cloud.points.iter().map(|p| p.map(|x| (x * 1000.0).round() / 1000.0)).collect();
        Raw::of(points, None, vec![EYE])
    }),
];

/// The supporter with boxes beside it.
fn with_boxes(solid: &Solid, boxes: &[[[f32; 3]; 2]]) -> Solid {
    let (mut vertices, mut triangles) = (solid.vertices.clone(), solid.triangles.clone());
    for [low, high] in boxes {
        let first = vertices.len() as u32;
        vertices.extend((0..8).map(|k| [0, 1, 2].map(|i| if k >> i & 1 == 1 { high[i] } else { low[i] })));
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        for [a, b, c, d] in quads.map(|quad: [u32; 4]| quad.map(|k| first + k)) {
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Solid::shell(vertices, triangles)
}

/// Whether the best pose hangs, in words.
fn outcome(case: &Case, raw: &Raw) -> Result<(), String> {
    // A coarser object than by default, which takes half the time.
    let params = Params { samples: 4000, voxels: 100_000, ..Params::default() };
    let monitor = Monitor::new();
    let (mut memory, mut more_memory) = (Vec::new(), Vec::new());
    let object = analyze_object(&case.object.mesh(), &params, &mut memory, &monitor).unwrap();
    let cloud = raw.cloud.cloud().unwrap();
    let supporter = analyze_supporter(&cloud, &params, &mut more_memory, &monitor).unwrap();
    let mut poses = [HangingPose::default()];
    let found = predict_poses(&object, &supporter, &Request::ANY, &params, &mut poses, &monitor).unwrap();
    let Some(best) = found.poses.first() else {
        return Err(format!("no pose: {:?}", found.rejection.map(|r| r.stage)));
    };
    let truth = with_boxes(&case.supporter, &raw.boxes);
    let mut scene = Scene::new(&case.object, &truth);
    scene.tilt = false;
    let verdict = Bullet::default().judge(&scene, &best.pose);
    let said = best.rest.map_or(0.0, |rest| rest.probability);
    if verdict.success() {
        return Ok(());
    }
    Err(format!(
        "said {said:.2}, clear {} (by {:.1} mm), holds {}, honest {}",
        verdict.clear,
        1000.0 * verdict.figures.penetration,
        verdict.holds,
        verdict.honest
    ))
}

/// The sample mug and hook.
fn sample() -> Case {
    let solid = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../samples").join(name);
        let mesh = read_mesh(&path).unwrap();
        Arc::new(Solid::shell(mesh.vertices, mesh.triangles))
    };
    Case {
        name: "sample mug on sample hook".into(),
        seed: 0,
        object_kind: "mug".into(),
        supporter_kind: "hook".into(),
        fit: Fit::Yes,
        meant: None,
        object: solid("mug.obj"),
        supporter: solid("hook.obj"),
        points: POINTS,
        openings: Vec::new(),
        bars: Vec::new(),
    }
}

/// The kinds of clouds of a pair on which the best pose does not hang, and why.
fn failures(case: &Case) -> Vec<String> {
    let failure = |(kind, make): &Kind| {
        let cloud = sample_supporter(&case.supporter.mesh(), 8000, case.seed);
        let raw = make(case, cloud, &mut Random::named(kind, case.seed));
        outcome(case, &raw).err().map(|why| format!("{}: {kind}: {why}", case.name))
    };
    KINDS.iter().filter_map(failure).collect()
}

#[test]
fn the_sample_hangs_whatever_is_wrong_with_the_cloud() {
    let failures = failures(&sample());
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn other_shapes_hang_as_well() {
    let all = made(40, 21);
    let is_tried = |case: &&Case| case.object_kind == "scissors" && case.fit == Fit::Yes;
    let case = all.iter().find(is_tried).expect("scissors are among the kinds of objects");
    let failures = failures(case);
    println!("{} of {} fail:\n{}", failures.len(), KINDS.len(), failures.join("\n"));
    // Of five such pairs, 52 of 55 clouds gave a pose that hangs: 600 points on a peg with a plate are too few for the plate.
    assert!(failures.len() <= 1, "{}", failures.join("\n"));
}
