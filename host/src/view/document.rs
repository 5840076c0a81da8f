//! The JSON that the page shows. `viewer/src` reads it.

use super::Scene;
use super::display::{MAX_POINTS, ShownMesh, shown_points, thinned};
use super::motion::{self, Track};
use crate::geometry::{Point, Pose, Vector};
use crate::hanging::{HangingPose, PredictError};
use crate::mechanics::{Fate, Margin};
use crate::motion::{Capsule, Gripper, Path, Waypoint};
use crate::sample_supporter;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

/// Version of the document, raised by every change that the page could misread.
const SCHEMA: u32 = 1;
/// Most sample points of the object that are shown.
const MAX_SAMPLES: usize = 3_000;
/// Most candidates that fell that are shown, with how they fell: 10 kB at most for four seconds.
const MAX_FALLEN: usize = 40;

/// A pose that is shown, with all that is known of it.
#[derive(Clone, Debug, Serialize)]
pub struct ShownPose {
    #[serde(serialize_with = "placed")]
    release: Pose,
    #[serde(serialize_with = "placed_if_known")]
    rest: Option<Pose>,
    /// As in the JSON of the command: rank, kind, probability, margin, contacts, path and so on.
    #[serde(flatten)]
    details: Map<String, Value>,
}

impl ShownPose {
    /// A pose of a prediction, of this rank, counted from 1.
    pub fn new(rank: usize, pose: &HangingPose) -> Self {
        let details = pose.rest.as_ref().map(|rest| {
            json!({
                "kind": rest.kind,
                "probability": rest.probability,
                "robustness": rest.robustness,
                "sinking": rest.sinking,
                "clearance": rest.clearance,
                "tolerance": rest.tolerance,
                "unseen": rest.unseen,
                "margin": rest.margin,
                "contacts": rest.contacts(),
            })
        });
        let rest = pose.rest.as_ref().map(|rest| rest.pose);
        Self::from_details(pose.pose, rest, object_of(details)).with("rank", json!(rank))
    }

    /// A pose of which the JSON of the command says more.
    pub fn from_details(release: Pose, rest: Option<Pose>, details: Map<String, Value>) -> Self {
        Self { release, rest, details }
    }

    /// The pose with the path to it.
    pub fn with_path(self, path: &Path) -> Self {
        let waypoints = |list: &[Waypoint]| list.iter().map(waypoint).collect::<Vec<_>>();
        let path = json!({
            "waypoints": waypoints(path.object),
            "release": path.release,
            "gripper": waypoints(path.gripper),
            "clearance": path.clearance,
        });
        self.with("path", path)
    }

    /// The pose with the reason why it has no path.
    pub fn with_path_failure(self, message: &str) -> Self {
        self.with("path_failure", json!({ "message": message }))
    }

    fn with(mut self, name: &str, value: Value) -> Self {
        self.details.insert(name.into(), value);
        self
    }

    pub(super) fn release(&self) -> &Pose {
        &self.release
    }

    pub(super) fn rest(&self) -> Option<&Pose> {
        self.rest.as_ref()
    }

    /// Poses of the object on the path, if one is known.
    pub(super) fn path(&self) -> Vec<Pose> {
        let waypoints = self.details.get("path").and_then(|path| path.get("waypoints")?.as_array());
        waypoints.into_iter().flatten().filter_map(pose_of).collect()
    }

    /// Positions of the contacts, and their forces on the object in multiples of its weight.
    pub(super) fn contacts(&self) -> Vec<(Point, Vector)> {
        let contacts = self.details.get("contacts").and_then(Value::as_array);
        let contact = |contact: &Value| {
            let force = contact.get("force")?.as_f64()? as f32;
            let [position, normal] = ["position", "normal"].map(|name| numbers(contact.get(name)));
            Some((Point::from(position?), Vector::from(normal?) * force))
        };
        contacts.into_iter().flatten().filter_map(contact).collect()
    }
}

fn object_of(value: Option<Value>) -> Map<String, Value> {
    match value {
        Some(Value::Object(map)) => map,
        _ => Map::new(),
    }
}

fn numbers<const N: usize>(value: Option<&Value>) -> Option<[f32; N]> {
    let list: Option<Vec<f32>> = value?.as_array()?.iter().map(|x| x.as_f64().map(|x| x as f32)).collect();
    list?.try_into().ok()
}

fn pose_of(waypoint: &Value) -> Option<Pose> {
    let position: [f32; 3] = numbers(waypoint.get("position"))?;
    let quaternion: [f32; 4] = numbers(waypoint.get("quaternion_xyzw"))?;
    let rotation = nalgebra::UnitQuaternion::from_quaternion(quaternion.into());
    Some(Pose::from_parts(position.into(), rotation))
}

fn pose_json(pose: &Pose) -> Value {
    let (position, quaternion): ([f32; 3], [f32; 4]) =
        (pose.translation.vector.into(), pose.rotation.coords.into());
    json!({ "position": position, "quaternion_xyzw": quaternion })
}

fn placed<S: Serializer>(pose: &Pose, serializer: S) -> Result<S::Ok, S::Error> {
    pose_json(pose).serialize(serializer)
}

fn placed_if_known<S: Serializer>(pose: &Option<Pose>, serializer: S) -> Result<S::Ok, S::Error> {
    pose.as_ref().map(pose_json).serialize(serializer)
}

fn waypoint(&Waypoint { seconds, ref pose }: &Waypoint) -> Value {
    let mut value = pose_json(pose);
    value["seconds"] = json!(seconds);
    value
}

/// Numbers in the base64 of their little-endian bytes.
fn packed<T: Copy, const N: usize>(
    numbers: impl IntoIterator<Item = T>,
    bytes: impl Fn(T) -> [u8; N],
) -> String {
    STANDARD.encode(numbers.into_iter().flat_map(bytes).collect::<Vec<u8>>())
}

fn floats(numbers: impl IntoIterator<Item = f32>) -> String {
    packed(numbers, f32::to_le_bytes)
}

fn vectors(vectors: impl IntoIterator<Item = [f32; 3]>) -> String {
    floats(vectors.into_iter().flatten())
}

fn track_json(track: &Track) -> Value {
    let numbers = track.iter().flat_map(|(_, pose)| {
        let ([x, y, z], [i, j, k, w]): ([f32; 3], [f32; 4]) =
            (pose.translation.vector.into(), pose.rotation.coords.into());
        [x, y, z, i, j, k, w]
    });
    json!({ "seconds": floats(track.iter().map(|(seconds, _)| *seconds)), "poses": floats(numbers) })
}

fn gripper_json(gripper: &Gripper) -> Value {
    let part = |&Capsule { from, to, radius, opening }: &Capsule| json!({ "from": from, "to": to, "radius": radius, "opening": opening });
    json!({ "parts": gripper.parts.iter().map(part).collect::<Vec<_>>(), "retreat": gripper.retreat })
}

/// All that the page shows.
pub(super) fn document(scene: &Scene) -> Result<Value, PredictError> {
    let mut poses = Vec::new();
    let mut simulation = motion::Simulation::new(scene);
    for pose in scene.poses {
        let mut value = json!(pose);
        value["motion"] = track_json(&simulation.settled(pose)?);
        poses.push(value);
    }
    let mut fallen = Vec::new();
    for (release, fate) in some_that_fell(scene.released) {
        let track = simulation.track(release)?;
        fallen.push(json!({ "fate": fate, "release": pose_json(release), "motion": track_json(&track) }));
    }
    Ok(json!({
        "schema": SCHEMA,
        "version": env!("CARGO_PKG_VERSION"),
        "object": object_json(scene),
        "supporter": supporter_json(scene),
        "obstacles": vectors(thinned(scene.request.scene.len(), MAX_POINTS).map(|index| scene.request.scene[index])),
        "gripper": scene.gripper.as_ref().map(gripper_json),
        "poses": poses,
        "fallen": fallen,
        "counts": scene.counts.map(|counts| counts.settling),
        "rejection": scene.rejection.map(|rejection| {
            json!({ "stage": rejection.stage, "reason": rejection.stage.to_string() })
        }),
        "most_tilt": Margin::MOST_TILT,
    }))
}

/// Candidates that did not come to rest, spread evenly over the search.
fn some_that_fell(released: &[(Pose, Fate)]) -> impl Iterator<Item = &(Pose, Fate)> {
    let fell: Vec<_> = released.iter().filter(|(_, fate)| *fate != Fate::Rests).collect();
    thinned(fell.len(), MAX_FALLEN).map(move |index| fell[index])
}

fn object_json(scene: &Scene) -> Value {
    let mesh = ShownMesh::of(scene.mesh);
    let samples = sample_supporter(scene.mesh, scene.params.samples.min(MAX_SAMPLES), scene.params.seed);
    let places = scene.object.contacts().map(|contact| (contact.position, contact.normal));
    let places = places.chain(scene.object.sites().map(|site| (site.position, site.hanging_direction)));
    json!({
        "name": scene.object_name,
        "triangle_count": scene.mesh.triangles().len(),
        "positions": vectors(mesh.vertices),
        "indices": packed(mesh.triangles.as_flattened().iter().copied(), u32::to_le_bytes),
        "centre_of_mass": <[f32; 3]>::from(scene.object.centre_of_mass()),
        "samples": vectors(samples.points),
        "contacts": places_json(places),
        "viewpoints": positions(scene.mesh.viewpoints()),
    })
}

fn supporter_json(scene: &Scene) -> Value {
    let (points, normals) = shown_points(scene.cloud);
    let places = scene.supporter.contacts().map(|contact| (contact.position, contact.normal));
    let places = places.chain(scene.supporter.sites().map(|site| (site.position, site.hanging_direction)));
    json!({
        "name": scene.supporter_name,
        "point_count": scene.cloud.points().len(),
        "up": <[f32; 3]>::from(scene.params.up()),
        "points": vectors(points),
        "normals": vectors(normals),
        "guessed": vectors(scene.supporter.guessed_points().map(Into::into)),
        "contacts": places_json(places),
        "viewpoints": positions(scene.cloud.viewpoints()),
    })
}

/// Contact candidates with their normals, or sites with their hanging directions.
fn places_json(places: impl Iterator<Item = (Point, Vector)>) -> Value {
    let (positions, normals): (Vec<_>, Vec<_>) = places.unzip();
    json!({
        "positions": vectors(positions.into_iter().map(Into::into)),
        "normals": vectors(normals.into_iter().map(Into::into)),
    })
}

fn positions(points: &[Point]) -> Vec<[f32; 3]> {
    points.iter().map(|&point| point.into()).collect()
}
