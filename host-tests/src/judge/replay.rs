//! Replays a path: the object, and the gripper that holds it, move as kinematic bodies among fixed shapes in Bullet, and at
//! the end the object is let go.
//!
//! Nothing that the planner says of its path is believed but its poses.

use super::{Bullet, Judge, Mass, Scene, Verdict, World};
use crate::solid::{Part, Solid};
use hangpose::motion::{Capsule, Gripper, Path};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

/// Largest distance that a point moves between two tests, m.
pub const STEP: f64 = 0.0005;
/// Largest penetration depth of a path that passes, m.
pub const DEEPEST: f64 = 0.001;

/// The deepest penetration on a part of a path, and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Depth {
    /// Penetration depth, m; 0 without overlap.
    pub depth: f64,
    /// Place on the path: the index of a waypoint, and the share of the way from there to the next one.
    pub at: f64,
}

impl Depth {
    fn add(&mut self, depth: f64, at: f64) {
        if depth > self.depth {
            *self = Self { depth, at };
        }
    }
}

/// What happened on a path.
#[derive(Clone, Copy, Debug)]
pub struct Replayed {
    /// The object on the way to the release pose.
    pub way: Depth,
    /// The object from the release pose to the rest pose.
    pub lowering: Depth,
    /// The gripper that holds the object.
    pub held: Depth,
    /// The gripper while it opens and leaves, places as on [`Path::gripper`].
    pub leaving: Depth,
    /// Poses at which a penetration depth was computed.
    pub tested: usize,
    /// What becomes of the object when it is let go at the end.
    pub verdict: Verdict,
}

impl Replayed {
    /// The largest penetration depth, m.
    pub fn depth(&self) -> f64 {
        let Self { way, lowering, held, leaving, .. } = self;
        [way, lowering, held, leaving].into_iter().fold(0.0, |deepest, it| it.depth.max(deepest))
    }

    /// Whether the object holds when it is let go. That it came there freely shows that it is neither wedged nor runs through the
    /// supporter, which is what [`Verdict::honest`] is for: an object in a hole with less than 2 mm of play is told to be honest by
    /// chance alone.
    pub fn hangs(&self) -> bool {
        self.verdict.clear && self.verdict.holds
    }

    /// Whether nothing is deeper than 1 mm and the object hangs.
    pub fn passes(&self) -> bool {
        self.depth() <= DEEPEST && self.hangs()
    }
}

/// Replays a path of the object of `scene` to the pose in which it hangs. `scene.supporter` is all that stands still. Between two
/// waypoints `centre`, in object coordinates, moves straight while the object turns about a fixed axis.
///
/// # Panics
///
/// If the path has no poses.
pub fn replay(scene: &Scene, path: &Path, gripper: Option<&Gripper>, centre: [f32; 3]) -> Replayed {
    let centre = Point3::from(centre).cast::<f64>();
    let poses: Vec<Isometry3<f64>> = path.object.iter().map(|waypoint| waypoint.pose.cast()).collect();
    let release = path.release.min(poses.len() - 1);
    let last = path.object[path.object.len() - 1].pose;
    let mut object = Mover::new(scene, centre);
    let way = object.follow(&poses[..=release], 0);
    let lowering = object.follow(&poses[release..], release);
    let mut replayed = Replayed {
        way,
        lowering,
        held: Depth::default(),
        leaving: Depth::default(),
        tested: object.tested,
        verdict: object.world.judge(scene, &last),
    };
    if let Some(gripper) = gripper {
        let mut held = Mover::new(&hand(&fingers(gripper, 0.0), scene.supporter), centre);
        replayed.held = held.follow(&poses, 0);
        replayed.leaving = opening(scene, gripper, &last.cast(), centre);
        let with_object = scene.supporter.with([(scene.object, last)]);
        let mut leaving = Mover::new(&hand(&fingers(gripper, 1.0), &with_object), centre);
        let away: Vec<Isometry3<f64>> = path.gripper.iter().map(|waypoint| waypoint.pose.cast()).collect();
        let Depth { depth, at } = leaving.follow(&away, 0);
        replayed.leaving.add(depth, at);
        replayed.tested += held.tested + leaving.tested;
    }
    replayed
}

/// The deepest penetration of a gripper that opens at the rest pose. The object, which it touches before, does not count.
fn opening(scene: &Scene, gripper: &Gripper, rest: &Isometry3<f64>, centre: Point3<f64>) -> Depth {
    let farthest = gripper.parts.iter().map(|part| Vector3::from(part.opening).norm()).fold(0.0, f32::max);
    let steps = (f64::from(farthest) / STEP).ceil() as u32;
    let mut depth = Depth::default();
    for k in 0..=steps {
        let open = f64::from(k) / f64::from(steps.max(1));
        let mut mover = Mover::new(&hand(&fingers(gripper, open as f32), scene.supporter), centre);
        depth.add(mover.depth(rest), 0.0);
    }
    depth
}

/// The parts of a gripper that is opened to this share, in object coordinates.
pub(crate) fn fingers(gripper: &Gripper, open: f32) -> Solid {
    let part = |capsule: &Capsule| {
        let moved = |end: [f32; 3]| (Vector3::from(end) + Vector3::from(capsule.opening) * open).into();
        Part::Capsule { from: moved(capsule.from), to: moved(capsule.to), radius: capsule.radius }
    };
    Solid { parts: gripper.parts.iter().map(part).collect(), ..Solid::default() }
}

/// A gripper as the body that moves. Its mass does not matter.
pub(crate) fn hand<'a>(gripper: &'a Solid, obstacles: &'a Solid) -> Scene<'a> {
    let mass = Mass { mass: 1.0, inertia: [1.0; 3], frame: Isometry3::identity() };
    Scene { object: gripper, supporter: obstacles, mass, friction: 0.0, damping: 0.0, tilt: false }
}

/// The pose at a share `t` of the way between two poses: `centre` moves straight, and the body turns about a fixed axis.
pub fn between(from: &Isometry3<f64>, to: &Isometry3<f64>, centre: &Point3<f64>, t: f64) -> Isometry3<f64> {
    let turn = (to.rotation * from.rotation.inverse()).scaled_axis();
    let rotation = UnitQuaternion::new(turn * t) * from.rotation;
    let (start, end) = (from * centre, to * centre);
    let at = start + (end - start) * t;
    Isometry3::from_parts(Translation3::from(at - rotation * centre), rotation)
}

/// A body that moves among fixed shapes.
struct Mover {
    world: World,
    apart: Apart,
    centre: Point3<f64>,
    /// Distance from the centre to the farthest point of the body, m.
    reach: f64,
    tested: usize,
}

impl Mover {
    fn new(scene: &Scene, centre: Point3<f64>) -> Self {
        let apart = Apart::new(scene.object, scene.supporter);
        let reach = apart.balls.iter().map(|(middle, radius)| (middle - centre).norm() + radius);
        Self {
            world: Bullet::default().world(scene),
            reach: reach.fold(0.0, f64::max),
            apart,
            centre,
            tested: 0,
        }
    }

    /// The deepest penetration on a way. The first pose is the waypoint with index `first`.
    fn follow(&mut self, poses: &[Isometry3<f64>], first: usize) -> Depth {
        let mut deepest = Depth::default();
        if let Some(pose) = poses.first() {
            deepest.add(self.depth(pose), first as f64);
        }
        for (pair, index) in poses.windows(2).zip(first..) {
            let [from, to] = [&pair[0], &pair[1]];
            let shift = (to * self.centre - from * self.centre).norm();
            let moves = shift + from.rotation.angle_to(&to.rotation) * self.reach;
            let steps = (moves / STEP).ceil().max(1.0) as usize;
            let mut step = 1;
            while step <= steps {
                let t = step as f64 / steps as f64;
                let pose = between(from, to, &self.centre, t);
                let free = self.apart.distance(&pose);
                if free > 0.0 {
                    // No point reaches an obstacle before it has moved as far.
                    step += ((free / moves * steps as f64) as usize).max(1);
                    continue;
                }
                deepest.add(self.depth(&pose), index as f64 + t);
                step += 1;
            }
        }
        deepest
    }

    fn depth(&mut self, pose: &Isometry3<f64>) -> f64 {
        self.tested += 1;
        self.world.release(pose);
        self.world.penetration()
    }
}

/// A lower bound of the distance between a body and fixed shapes: from balls around the parts of the one to boxes around the
/// parts of the other.
struct Apart {
    balls: Vec<(Point3<f64>, f64)>,
    /// A ball around all of these.
    whole: (Point3<f64>, f64),
    boxes: Vec<[Point3<f64>; 2]>,
}

impl Apart {
    fn new(body: &Solid, fixed: &Solid) -> Self {
        let balls: Vec<_> = body.parts.iter().map(ball_around).collect();
        let middle = balls.iter().map(|ball| ball.0.coords).sum::<Vector3<f64>>() / balls.len().max(1) as f64;
        let middle = Point3::from(middle);
        let radius = balls.iter().map(|(at, radius)| (at - middle).norm() + radius).fold(0.0, f64::max);
        Self { balls, whole: (middle, radius), boxes: fixed.parts.iter().map(box_around).collect() }
    }

    /// The bound at a pose of the body, m; negative if the distance may be zero.
    fn distance(&self, pose: &Isometry3<f64>) -> f64 {
        let distance = |box_: &[Point3<f64>; 2], (middle, radius): &(Point3<f64>, f64)| {
            (middle - middle.sup(&box_[0]).inf(&box_[1])).norm() - radius
        };
        let whole = (pose * self.whole.0, self.whole.1);
        let balls: Vec<_> = self.balls.iter().map(|(middle, radius)| (pose * middle, *radius)).collect();
        let mut least = f64::INFINITY;
        for box_ in &self.boxes {
            if distance(box_, &whole) < least {
                least = balls.iter().map(|ball| distance(box_, ball)).fold(least, f64::min);
            }
            if least <= 0.0 {
                break;
            }
        }
        least
    }
}

/// Points whose hull with this radius around them has the part.
fn corners(part: &Part) -> (Vec<Point3<f64>>, f64) {
    let point = |v: &[f32; 3]| Point3::from(*v).cast::<f64>();
    match part {
        Part::Hull(points) => (points.iter().map(point).collect(), 0.0),
        Part::Capsule { from, to, radius } => (vec![point(from), point(to)], f64::from(*radius)),
        Part::Cuboid { centre, axes, half_extents } => {
            let [a, b, c] = [0, 1, 2].map(|i| (Vector3::from(axes[i]) * half_extents[i]).cast::<f64>());
            let sign = |bit: u32, k: u32| if k & bit == 0 { -1.0 } else { 1.0 };
            let corner = |k: u32| point(centre) + a * sign(1, k) + b * sign(2, k) + c * sign(4, k);
            ((0..8).map(corner).collect(), 0.0)
        }
    }
}

fn box_around(part: &Part) -> [Point3<f64>; 2] {
    let (points, radius) = corners(part);
    let low = points.iter().copied().reduce(|a, b| a.inf(&b)).unwrap_or_default();
    let high = points.iter().copied().reduce(|a, b| a.sup(&b)).unwrap_or_default();
    let radius = Vector3::repeat(radius);
    [low - radius, high + radius]
}

fn ball_around(part: &Part) -> (Point3<f64>, f64) {
    let (points, radius) = corners(part);
    let [low, high] = box_around(part);
    let middle = nalgebra::center(&low, &high);
    (middle, points.iter().map(|point| (point - middle).norm()).fold(0.0, f64::max) + radius)
}
