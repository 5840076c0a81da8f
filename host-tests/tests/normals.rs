//! The outside of every kind of supporter is found from points alone, from normals of random sign and from inward normals.

use hangpose::files::CloudFile;
use hangpose::hanging::NormalCounts;
use hangpose::hanging::contacts::SupportContact;
use hangpose::{Monitor, Params, analyze_supporter, sample_supporter};
use host_tests::shapes::{Random, SUPPORTERS, SupporterKind};
use host_tests::solid::Solid;
use host_tests::winding::Winding;
use nalgebra::{Point3, Vector3};
use std::sync::OnceLock;

/// Seeds that no constant was chosen on.
const SEEDS: std::ops::Range<u64> = 40..42;

/// All supporters with 10 000 samples each, less those that lie within another body of the supporter, where no camera sees them; and
/// their true normals.
fn clouds() -> &'static [(String, CloudFile)] {
    static CLOUDS: OnceLock<Vec<(String, CloudFile)>> = OnceLock::new();
    CLOUDS.get_or_init(sampled)
}

fn sampled() -> Vec<(String, CloudFile)> {
    let seen = |solid: &Solid, seed| {
        let corner = |v: u32| Point3::from(solid.vertices[v as usize]).cast::<f64>();
        let winding = Winding::new(solid.triangles.iter().map(|triangle| triangle.map(corner)));
        let cloud = sample_supporter(&solid.mesh(), 10_000, seed);
        let normals = cloud.normals.unwrap();
        // Half a millimetre outside one body, a point that is inside the solid is within another.
        let is_seen = |(point, normal): &([f32; 3], [f32; 3])| {
            let out = Point3::from(*point) + Vector3::from(*normal) * 0.0005;
            winding.number(&out.cast::<f64>()) < 0.5
        };
        let (points, normals) = cloud.points.into_iter().zip(normals).filter(is_seen).unzip();
        CloudFile { points, normals: Some(normals), ..CloudFile::default() }
    };
    let cloud = |seed| {
        move |kind: &SupporterKind| (format!("{} {seed}", kind.name), seen(&kind.make(seed).solid, seed))
    };
    SEEDS.flat_map(|seed| SUPPORTERS.iter().map(cloud(seed))).collect()
}

/// What was done to the normals of a cloud; the number of points that are left of it, of its contact candidates whose normal is within 60
/// degrees of the truth, and of all its contact candidates.
fn analyse(cloud: &CloudFile, truth: &CloudFile) -> (NormalCounts, [usize; 3]) {
    let normals = truth.normals.as_ref().unwrap();
    // Points of dense clouds are merged, so that a contact is near true points and not at one.
    let true_normal = |at: &Point3<f32>| {
        let distance = |point: &[f32; 3]| (Point3::from(*point) - at).norm_squared();
        let points = truth.points.iter().zip(normals);
        points.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0))).unwrap().1
    };
    let mut memory = Vec::new();
    let supporter =
        analyze_supporter(&cloud.cloud().unwrap(), &Params::default(), &mut memory, &Monitor::new()).unwrap();
    let is_right = |contact: &&SupportContact| {
        contact.normal.iter().zip(true_normal(&contact.position)).map(|(a, b)| a * b).sum::<f32>() > 0.5
    };
    let contacts: Vec<_> = supporter.contacts().collect();
    let kept = supporter.points().points().len();
    (supporter.normals(), [kept, contacts.iter().filter(is_right).count(), contacts.len()])
}

/// The same cloud with other normals.
fn with_normals(cloud: &CloudFile, normals: Option<Vec<[f32; 3]>>) -> CloudFile {
    CloudFile { points: cloud.points.clone(), normals, ..CloudFile::default() }
}

#[test]
fn true_normals_stay_and_inward_ones_are_reversed() {
    for (name, cloud) in clouds() {
        assert_eq!(analyse(cloud, cloud).0, NormalCounts::default(), "{name}");
        let inward = cloud.normals.as_ref().unwrap().iter().map(|normal| normal.map(|x| -x)).collect();
        let (counts, [kept, right, contacts]) = analyse(&with_normals(cloud, Some(inward)), cloud);
        assert_eq!((counts.reversed, right), (kept, contacts), "{name}");
    }
}

#[test]
fn random_signs_and_missing_normals_end_up_outside() {
    let (mut right, mut all) = ([0, 0], [0, 0]);
    for (_, cloud) in clouds() {
        let mut random = Random::new(3);
        let mut signed =
            |normal: &[f32; 3]| normal.map(|x| if random.range(0.0, 1.0) < 0.5 { -x } else { x });
        let signs = cloud.normals.as_ref().unwrap().iter().map(&mut signed).collect();
        for (k, normals) in [Some(signs), None].into_iter().enumerate() {
            let (_, [_, outside, contacts]) = analyse(&with_normals(cloud, normals), cloud);
            (right[k], all[k]) = (right[k] + outside, all[k] + contacts);
        }
    }
    println!("outside: {right:?} of {all:?}");
    // One wrong point is one wrong contact, so that of the points themselves far more are right. A method that propagates signs from the
    // top, without a vote, reaches 42 and 61 %.
    assert!(right[0] * 100 >= 70 * all[0] && right[1] * 100 >= 90 * all[1], "{right:?} of {all:?}");
}
