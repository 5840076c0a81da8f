//! Meshes and clouds near degeneracy, from the analysis to the path.

use crate::draw::Draw;
use crate::memory::Block;
use crate::oracle::{check_path, check_prediction, is_rigid, within};
use crate::shapes::{self, DrawnCloud, DrawnMesh};
use hangpose::geometry::{Aabb, Cloud, Mesh, Point, Pose, Symmetry, Vector};
use hangpose::hanging::{
    AnalysisError, Approach, Distance, HangingPose, Hung, Object, Region, Request, Supporter, let_go,
    predict, predict_bytes, predict_many,
};
use hangpose::mechanics::{Kind, Kinds};
use hangpose::memory::Limits;
use hangpose::motion::{
    Capsule, Gripper, Motion, Plan, Task, Waypoint, plan, plan_bytes, predict_reachable, reachable_bytes,
};
use hangpose::{Candidates, CentreOfMass, Monitor, Params};
use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use std::fmt::Write;

/// Rays and distance queries of a call: about a millisecond.
const WORK: [u64; 6] = [4_000, 1_000, 20_000, 500, 10, 0];

/// What is asked for.
struct Case {
    mesh: DrawnMesh,
    cloud: DrawnCloud,
    params: Params,
    asked: Asked,
    work: u64,
    /// Alignment of the memory.
    offset: usize,
}

/// How and where it shall hang, and how it gets there.
struct Asked {
    allow: Kinds,
    prefer: Kinds,
    on: Place,
    by: Place,
    approach: Option<Approach>,
    scene: Vec<[f32; 3]>,
    hung: Option<Pose>,
    distinct: Distance,
    symmetries: Option<Vec<Symmetry>>,
    poses: usize,
    goal: Pose,
    /// What makes the goal of a path one that is none.
    beyond: [f32; 3],
    start: Option<Pose>,
    take_off: bool,
    parts: Vec<Capsule>,
    retreat: [f32; 3],
    workspace: Option<Aabb>,
    motion: Motion<'static>,
    waypoints: usize,
    /// The robot reaches poses on this side of a plane.
    reach: [f32; 4],
}

/// A region that owns its points.
enum Place {
    Everywhere,
    Box([[f32; 3]; 2]),
    Points(Vec<[f32; 3]>, Option<Vec<u32>>, f32),
    Triangles(Vec<[f32; 3]>, Vec<[u32; 3]>, Vec<u32>, f32),
}

impl Place {
    fn draw(draw: &mut Draw) -> Self {
        match draw.below(12) {
            0..=7 => Self::Everywhere,
            8 | 9 => {
                let (a, b) = (draw.shares(), draw.shares());
                Self::Box([
                    [0, 1, 2].map(|i| draw.or_number(0.1 * a[i].min(b[i]))),
                    [0, 1, 2].map(|i| draw.or_number(0.1 * a[i].max(b[i]))),
                ])
            }
            10 => {
                let points: Vec<_> = (0..draw.below(4)).map(|_| draw.shares().map(|x| 0.1 * x)).collect();
                let indices =
                    draw.one_in(2).then(|| (0..draw.below(4)).map(|_| draw.below(5) as u32).collect());
                Self::Points(points, indices, draw.or_number(0.02))
            }
            _ => {
                let points: Vec<_> = (0..3).map(|_| draw.shares().map(|x| 0.1 * x)).collect();
                let triangle = [0; 3].map(|_: u32| draw.below(4) as u32);
                Self::Triangles(points, vec![triangle], vec![draw.below(2) as u32], draw.or_number(0.02))
            }
        }
    }

    fn region(&self) -> Region<'_> {
        match self {
            Self::Everywhere => Region::Everywhere,
            Self::Box([low, high]) => Region::Box { low: *low, high: *high },
            Self::Points(points, indices, radius) => {
                Region::Points { points, indices: indices.as_deref(), radius: *radius }
            }
            Self::Triangles(vertices, triangles, indices, radius) => {
                Region::Triangles { vertices, triangles, indices, radius: *radius }
            }
        }
    }
}

fn kinds(draw: &mut Draw, plain: Kinds) -> Kinds {
    match draw.below(4) {
        0..=2 => plain,
        _ => {
            let chosen = draw.byte();
            let list: Vec<Kind> = Kind::ALL
                .into_iter()
                .enumerate()
                .filter(|(i, _)| chosen >> i & 1 == 1)
                .map(|(_, kind)| kind)
                .collect();
            Kinds::of(&list)
        }
    }
}

fn pose(draw: &mut Draw) -> Pose {
    let [x, y, z, w] = [draw.share(), draw.share(), draw.share(), draw.share()];
    let rotation = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-6).unwrap_or_default();
    // A hung object and a release may be anywhere, but somewhere.
    let far = draw.pick(&[0.1, 0.1, 0.1, 1.0, 1e3, 9e5]);
    Pose::from_parts(Vector::from(draw.shares().map(|x| far * x)).into(), rotation)
}

/// Params of small models, valid in most cases.
pub(crate) fn params(draw: &mut Draw) -> Params {
    let plain = if draw.one_in(4) { Params::paper() } else { Params::default() };
    let gravity = if draw.one_in(6) { draw.shares() } else { [0.0, 0.0, -1.0] };
    let mut params = Params {
        seed: u64::from(draw.byte()),
        gravity,
        samples: 100 + draw.below(256),
        voxels: draw.pick(&[2000, 500, 8000, 50, 1]),
        settle_attempts: draw.below(5),
        firm_enough: draw.below(3),
        min_probability: draw.pick(&[0.3, 0.0, 0.9]),
        settle_time: draw.pick(&[0.5, 0.1, 3.0]),
        object_directions: 1 + draw.below(8),
        rays_per_direction: 3 + draw.below(10),
        supporter_directions: 1 + draw.below(6),
        free_space_steps: 2 + draw.below(6),
        min_cluster_points: draw.below(6),
        ..plain
    };
    for _ in 0..draw.below(4) {
        match draw.below(20) {
            0 => params.settle = !params.settle,
            1 => params.candidates = Candidates::Sites,
            2 => params.candidates = Candidates::Contacts,
            3 => params.centre_of_mass = CentreOfMass::Given(draw.place(0.1)),
            4 => params.centre_of_mass = CentreOfMass::SampleMean,
            5 => params.friction = draw.up_to(2.0),
            6 => params.clearance = draw.up_to(0.01),
            7 => params.time_step = draw.or_number(0.005),
            8 => params.rest_speed = draw.up_to(0.1),
            9 => params.voxels = 0,
            10 => params.gravity = [draw.number(), draw.number(), draw.number()],
            11 => params.min_encircled_above = draw.up_to(1.0),
            12 => params.min_encircled_below = draw.up_to(1.0),
            13 => params.cluster_bandwidth = draw.up_to(1.0),
            14 => params.slice_half_thickness = draw.up_to(0.1),
            15 => params.slice_link_distance = draw.up_to(0.1),
            16 => params.max_collision = draw.up_to(1.0),
            17 => params.object_contact_cosine = draw.up_to(1.0),
            18 => params.supporter_contact_cosine = draw.up_to(1.0),
            _ => params.min_free_space_radius = draw.up_to(0.01),
        }
    }
    params
}

impl Asked {
    fn draw(draw: &mut Draw) -> Self {
        let any = Request::ANY;
        let mut asked = Self {
            allow: kinds(draw, any.allow),
            prefer: kinds(draw, any.prefer),
            on: Place::draw(draw),
            by: Place::draw(draw),
            approach: None,
            scene: Vec::new(),
            hung: None,
            distinct: any.distinct,
            symmetries: None,
            poses: 1 + draw.below(4),
            goal: pose(draw),
            beyond: draw.place(0.0),
            start: None,
            take_off: draw.one_in(4),
            parts: Vec::new(),
            retreat: [0.0; 3],
            workspace: None,
            motion: Motion { samples: 1 + draw.below(120), nodes: 64 + draw.below(100), ..Motion::DEFAULT },
            waypoints: draw.pick(&[400, 100, 3, 0]),
            reach: [0.0, 0.0, 0.0, 1.0],
        };
        for _ in 0..draw.below(5) {
            match draw.below(14) {
                0 => {
                    asked.approach = Some(Approach {
                        direction: draw.shares(),
                        angle: draw.up_to(3.0),
                        length: draw.up_to(1.0),
                    });
                }
                1 => asked.scene = (0..draw.below(40)).map(|_| draw.place(0.1)).collect(),
                2 => asked.hung = Some(pose(draw)),
                3 => asked.distinct = Distance { position: draw.up_to(1.0), rotation: draw.up_to(1.0) },
                4 => {
                    asked.symmetries = Some(
                        (0..draw.below(3))
                            .map(|_| Symmetry {
                                axis: draw.shares().into(),
                                fold: draw.pick(&[0, 2, 3, 360, 1, 361]),
                            })
                            .collect(),
                    );
                }
                5 => asked.start = Some(pose(draw)),
                6 | 7 => {
                    asked.parts = (0..1 + draw.below(3))
                        .map(|_| Capsule {
                            from: draw.place(0.1),
                            to: draw.shares().map(|x| 0.1 * x),
                            radius: draw.up_to(0.02),
                            opening: draw.shares().map(|x| 0.05 * x),
                        })
                        .collect();
                    asked.retreat = draw.shares().map(|x| 0.2 * x);
                }
                8 => {
                    let corner = draw.shares().map(|x| draw.or_number(x.abs() + 0.01));
                    asked.workspace = Some(Aabb { min: Point::from(corner.map(|x| -x)), max: corner.into() });
                }
                9 => asked.motion.clearance = draw.up_to(0.1),
                10 => asked.motion.step = Distance { position: draw.up_to(0.1), rotation: draw.up_to(1.0) },
                11 => asked.motion.speed.linear = draw.up_to(1.0),
                12 => asked.motion.speed.angular_acceleration = draw.up_to(1.0),
                _ => asked.reach = [draw.share(), draw.share(), draw.share(), draw.share()],
            }
        }
        asked
    }

    fn motion(&self) -> Motion<'_> {
        let gripper =
            (!self.parts.is_empty()).then_some(Gripper { parts: &self.parts, retreat: self.retreat });
        Motion {
            start: self.start,
            take_off: self.take_off,
            gripper,
            workspace: self.workspace,
            ..self.motion
        }
    }

    fn accepts(&self, pose: &Pose) -> bool {
        let [x, y, z, beyond] = self.reach;
        pose.translation.vector.dot(&Vector::new(x, y, z)) <= beyond.abs()
    }
}

/// Analyses a mesh and a cloud, predicts, lets go and plans, twice: both times the answer is the same to the last bit.
pub fn run(data: &[u8]) {
    let mut draw = Draw::new(data);
    let case = Case {
        params: params(&mut draw),
        mesh: shapes::mesh(&mut draw),
        cloud: shapes::cloud(&mut draw),
        asked: Asked::draw(&mut draw),
        work: draw.pick(&WORK),
        offset: draw.below(16),
    };
    let (first, second) = (answer(&case, case.offset), answer(&case, 0));
    assert_eq!(first, second, "the answer is another one when it is asked for again");
}

/// All that the library says to a case, as text that tells any two numbers apart.
fn answer(case: &Case, offset: usize) -> String {
    let Case { mesh, cloud, params, asked, work, .. } = case;
    let mut said = String::new();
    let monitor = Monitor::with_work_limit(*work);
    let mesh = match Mesh::new(&mesh.vertices, &mesh.triangles)
        .and_then(|given| given.seen_from(&mesh.viewpoints))
    {
        Ok(mesh) => mesh,
        Err(error) => return told(error),
    };
    let given = Cloud::new(&cloud.points, cloud.normals.as_deref())
        .and_then(|given| given.seen_from(&cloud.viewpoints))
        .and_then(|given| cloud.marks.as_deref().map_or(Ok(given), |marks| given.hang_on(marks)))
        .and_then(|given| cloud.region.map_or(Ok(given), |[low, high]| given.hang_within(low, high)));
    let cloud = match given {
        Ok(cloud) => cloud,
        Err(error) => return told(error),
    };

    if let Err(error) = params.validate() {
        let refused = Object::analyze(&mesh, params, &mut [], &monitor).err().map(told);
        // As text, since an error may name a value that is no number, which equals nothing.
        assert_eq!(refused, Some(told(AnalysisError::Params(error))));
        return told(error);
    }
    let mut memory = Block::new(Object::bytes(&Object::limits(&mesh, params)), offset);
    let object = match Object::analyze(&mesh, params, memory.memory(), &monitor) {
        Ok(object) => object,
        Err(error) => return told(error),
    };
    check_object(&object, &mesh);
    let places: (Vec<_>, Vec<_>) = (object.sites().collect(), object.contacts().collect());
    write!(said, "{:?} {places:?} {:?} {:?}", object.mass(), object.symmetries(), object.work()).unwrap();

    let limits = Limits::of_points(cloud.points().len());
    let mut more_memory = Block::new(Supporter::bytes(&limits), offset);
    let supporter = match Supporter::analyze(&cloud, params, more_memory.memory(), &monitor) {
        Ok(supporter) => supporter,
        Err(error) => return said + &told(error),
    };
    check_supporter(&supporter, cloud.points().len());
    let places: (Vec<_>, Vec<_>) = (supporter.sites().collect(), supporter.contacts().collect());
    write!(said, "{places:?} {:?} {:?}", supporter.cleaning(), supporter.normals()).unwrap();

    let hung: Vec<_> = asked.hung.iter().map(|pose| Hung { object: &object, pose: *pose }).collect();
    let request = Request {
        allow: asked.allow,
        prefer: asked.prefer,
        on: asked.on.region(),
        by: asked.by.region(),
        approach: asked.approach,
        scene: &asked.scene,
        hung: &hung,
        distinct: asked.distinct,
        symmetries: asked.symmetries.as_deref(),
        watch: None,
    };
    let mut poses = vec![HangingPose::default(); asked.poses];
    let mut scratch = Block::new(predict_bytes(&limits), offset);
    match predict(&object, &supporter, &request, params, &mut poses, scratch.memory(), &monitor) {
        Ok(prediction) => {
            check_prediction(
                &prediction,
                params.settle,
                if params.settle { params.min_probability } else { 0.0 },
            );
            write!(said, "{prediction:?}").unwrap();
        }
        Err(error) => said += &told(error),
    }
    scratch.check();

    if params.settle && asked.poses > 2 {
        let mut places = vec![None; 2];
        match predict_many(
            &[&object, &object],
            &supporter,
            &request,
            params,
            &mut places,
            scratch.memory(),
            &monitor,
        ) {
            Ok(many) => write!(said, "{many:?} {places:?}").unwrap(),
            Err(error) => said += &told(error),
        }
        scratch.check();
    }

    match let_go(&object, &supporter, &asked.goal, params, scratch.memory(), &monitor) {
        Ok(Ok(gone)) => {
            is_rigid("a released object", &gone.pose);
            write!(said, "{gone:?}").unwrap();
        }
        Ok(Err(stop)) => write!(said, "{stop:?}").unwrap(),
        Err(error) => said += &told(error),
    }
    scratch.check();

    let motion = asked.motion();
    let task = Task { object: &object, supporter: &supporter, request: &request, params, motion };
    let mut waypoints = vec![Waypoint::default(); asked.waypoints];
    let mut ask = |pose: &Pose| {
        is_rigid("a pose that the robot is asked about", pose);
        asked.accepts(pose)
    };
    let mut check_plan = |plan: &Plan| {
        if let Ok(path) = &plan.path {
            check_path(path, &motion);
        }
        write!(said, "{plan:?}").unwrap();
    };
    // Beyond what a motion may have, the memory is not asked for.
    let (scene, nodes) = (asked.scene.len(), motion.nodes.min(1_000_000));
    let mut scratch = Block::new(plan_bytes(&limits, scene, nodes), offset);
    let pose = Translation3::from(Vector::from(asked.beyond)) * asked.goal;
    let goal = HangingPose { pose, ..HangingPose::default() };
    let outcome = match plan(&task, &goal, &mut waypoints, &mut ask, scratch.memory(), &monitor) {
        Ok(plan) => {
            check_plan(&plan);
            String::new()
        }
        Err(error) => told(error),
    };
    scratch.check();

    let mut scratch = Block::new(reachable_bytes(&limits, scene, nodes), offset);
    let mut failures = vec![None; asked.poses];
    let reached = predict_reachable(
        &task,
        &mut poses,
        &mut failures,
        &mut waypoints,
        &mut ask,
        scratch.memory(),
        &monitor,
    );
    let reached = match reached {
        Ok(reached) => {
            if let Some(plan) = &reached.plan {
                check_plan(plan);
            }
            format!("{} {failures:?}", reached.planned)
        }
        Err(error) => told(error),
    };
    scratch.check();
    memory.check();
    more_memory.check();
    said + &outcome + &reached
}

/// An error in words.
fn told(error: impl std::error::Error) -> String {
    let text = error.to_string();
    assert!(!text.is_empty());
    text
}

fn check_object(object: &Object, mesh: &Mesh) {
    let mass = object.mass();
    within("the area", mass.area, 0.0, f32::MAX);
    assert!(object.centre_of_mass().iter().all(|x| x.is_finite()));
    if let Some(volume) = mass.volume {
        within("the volume", volume, 0.0, f32::MAX);
    }
    for contact in object.contacts() {
        assert!(
            (contact.normal.norm() - 1.0).abs() < 1e-3 && (contact.bar_direction.norm() - 1.0).abs() < 1e-3,
            "{contact:?}"
        );
        assert!(contact.position.iter().all(|x| x.is_finite()) && contact.capture >= 0.0);
    }
    for symmetry in object.symmetries() {
        assert!((symmetry.axis.norm() - 1.0).abs() < 1e-3 && symmetry.fold != 1);
    }
    if let Some(field) = object.distance_field() {
        let bounds = mesh.aabb();
        for point in [bounds.min, bounds.centre(), bounds.max] {
            let (distance, gradient) = field.sample(&(object.frame() * point));
            assert!(distance.is_finite() && gradient.iter().all(|x| x.is_finite()), "{distance} {gradient}");
        }
    }
}

fn check_supporter(supporter: &Supporter, given: usize) {
    let kept = supporter.points().points();
    assert!(kept.iter().flat_map(|point| point.iter()).all(|x| x.is_finite()));
    assert!(supporter.guessed() <= kept.len() && kept.len() <= 2 * given + 1, "{} of {given}", kept.len());
    for contact in supporter.contacts() {
        assert!(
            (contact.normal.norm() - 1.0).abs() < 1e-3 && (contact.bar_direction.norm() - 1.0).abs() < 1e-3,
            "{contact:?}"
        );
    }
}
