//! The definition of hanging and the course of a trial, the same in both engines.

use super::{GRAVITY, Scene, State, World};
use nalgebra::{Isometry3, Point3, Vector3};

/// Limits that define hanging. They are named here and are not tuning parameters.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Largest penetration depth of a clear pose, m.
    pub penetration: f64,
    /// Duration for which the object must hold, s.
    pub settling: f64,
    /// Largest sinking of the centre of mass, m; the larger of this and [`Limits::sinking_extents`] applies.
    pub sinking: f64,
    /// Largest sinking of the centre of mass in multiples of the object's largest extent.
    pub sinking_extents: f64,
    /// Largest speed of the centre of mass at the end, m/s.
    pub speed: f64,
    /// Duration of reversed gravity, within which the object must come free, s.
    pub reversal: f64,
    /// Smallest displacement of the centre of mass that counts as free, m.
    pub travel: f64,
    /// Angle by which gravity is tilted, rad.
    pub tilt: f64,
    /// Duration of each tilt, s.
    pub tilting: f64,
}

impl Limits {
    /// The limits of the definition.
    pub const DEFINITION: Self = Self {
        penetration: 0.002,
        settling: 4.0,
        sinking: 0.06,
        sinking_extents: 0.5,
        speed: 0.05,
        reversal: 1.5,
        travel: 0.002,
        tilt: 0.380_482,
        tilting: 1.5,
    };
}

/// Verdict on the release of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// The penetration depth at the predicted pose is at most 2 mm.
    pub clear: bool,
    /// After 4 s the object touches the supporter, has sunk less than the limit, and is slower than the limit.
    pub holds: bool,
    /// With gravity reversed, the object comes free within 1.5 s: at some moment no contact force acts on it and it has
    /// moved. An object that is wedged through the supporter does not. It need not leave the supporter: a ring lifts
    /// off a peg and then hangs upwards. False if the object does not hold.
    pub honest: bool,
    /// From its rest pose the object stays under gravity tilted by 21.8 degrees towards each of four sides. False if
    /// the object does not hold or the test was not run.
    pub robust: bool,
    /// Measurements behind the verdict.
    pub figures: Figures,
}

impl Verdict {
    /// Whether the object hangs: clear, holds and honest.
    pub fn success(&self) -> bool {
        self.clear && self.holds && self.honest
    }
}

/// Measurements of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Largest penetration depth at the predicted pose, m.
    pub penetration: f64,
    /// Sinking of the centre of mass, m.
    pub sank: f64,
    /// Speed of the centre of mass at the end, m/s.
    pub speed: f64,
    /// Whether the object touches the supporter at the end.
    pub touches: bool,
    /// Time after release from which the sinking stayed above its limit, s.
    pub fell_after: Option<f64>,
    /// Whether the object stays under gravity tilted towards +x, -x, +y and -y.
    pub tilts: [bool; 4],
    /// Rest pose, or the last pose of an object that falls. Maps object to supporter coordinates.
    pub rest: Isometry3<f32>,
    /// Rotation angle between release and rest, rad.
    pub turned: f64,
}

/// Interval between observations, s.
const LOOK: f64 = 0.01;
/// Interval between observations under reversed gravity, s: in a hole with 2 mm of play an object is free for 20 ms.
const LOOK_CLOSELY: f64 = 0.001;
/// Speed of the fastest point of the object below which it counts as still, m/s.
const STILL: f64 = 0.001;
/// Duration of stillness after which a phase ends early, s.
const STILL_FOR: f64 = 0.5;

struct Trial<'a> {
    world: &'a mut World,
    /// Distance from the centre of mass to the farthest vertex, m.
    reach: f64,
    /// Lower corner of the supporter's bounding box.
    low: Point3<f64>,
    /// Upper corner of the supporter's bounding box.
    high: Point3<f64>,
    /// Largest permitted sinking of the centre of mass, m.
    limit: f64,
}

struct Phase {
    state: State,
    touches: bool,
    sank: f64,
    fell_after: Option<f64>,
}

pub(super) fn examine(world: &mut World, scene: &Scene, release: &Isometry3<f64>) -> Verdict {
    let limits = Limits::DEFINITION;
    let (low, high) = bounds(&scene.object.vertices);
    let centre = Point3::from(scene.mass.frame.translation.vector);
    let reach = scene.object.vertices.iter().map(|&vertex| (Point3::from(vertex).cast() - centre).norm());
    let reach = reach.fold(0.0, f64::max);
    let limit = limits.sinking.max(limits.sinking_extents * (high - low).max());
    let (low, high) = bounds(&scene.supporter.vertices);
    let mut trial = Trial { world, reach, low, high, limit };

    trial.world.release(release);
    let penetration = trial.world.penetration();
    let start = trial.world.state();
    let settled = trial.phase(&start, Vector3::new(0.0, 0.0, -GRAVITY), limits.settling);
    let speed = settled.state.velocity.norm();
    let holds = settled.touches && settled.sank < limit && speed < limits.speed;
    let honest = holds && trial.comes_free(&settled.state, &limits);
    let tilts = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]].map(|[x, y]| {
        let (across, down) = limits.tilt.sin_cos();
        let gravity = Vector3::new(x * across, y * across, -down) * GRAVITY;
        scene.tilt && holds && {
            let phase = trial.phase(&settled.state, gravity, limits.tilting);
            phase.touches && phase.sank < limit
        }
    });
    Verdict {
        clear: penetration <= limits.penetration,
        holds,
        honest,
        robust: tilts == [true; 4],
        figures: Figures {
            penetration,
            sank: settled.sank,
            speed,
            touches: settled.touches,
            fell_after: settled.fell_after,
            tilts,
            rest: settled.state.pose.cast(),
            turned: start.pose.rotation.angle_to(&settled.state.pose.rotation),
        },
    }
}

impl Trial<'_> {
    /// Simulates from `start` under `gravity`, until the time is over or the outcome is certain.
    fn phase(&mut self, start: &State, gravity: Vector3<f64>, seconds: f64) -> Phase {
        self.world.place(start);
        self.world.pull(gravity);
        let down = gravity.normalize();
        let (mut time, mut still, mut fell_after) = (0.0, 0.0, None);
        loop {
            let touches = self.world.pass(LOOK) > 0.0;
            time += LOOK;
            let state = self.world.state();
            let sank = down.dot(&(state.centre - start.centre));
            fell_after = if sank < self.limit { None } else { fell_after.or(Some(time)) };
            let slow = state.velocity.norm() + state.spin.norm() * self.reach < STILL;
            still = if slow && touches { still + LOOK } else { 0.0 };
            let gone = !touches && fell_after.is_some() && self.out_of_reach(&state, &down);
            if time + LOOK / 2.0 > seconds || still > STILL_FOR || gone {
                return Phase { state, touches, sank, fell_after };
            }
        }
    }

    /// Whether the object has fallen past the whole supporter.
    fn out_of_reach(&self, state: &State, down: &Vector3<f64>) -> bool {
        let lowest: f64 = (0..3).map(|i| (self.low[i] * down[i]).max(self.high[i] * down[i])).sum();
        state.velocity.dot(down) > 0.0 && state.centre.dot(down) > lowest + self.reach
    }

    /// Whether the object comes free from `rest` under reversed gravity.
    fn comes_free(&mut self, rest: &State, limits: &Limits) -> bool {
        self.world.place(rest);
        self.world.pull(Vector3::new(0.0, 0.0, GRAVITY));
        (0..(limits.reversal / LOOK_CLOSELY).round() as u32).any(|_| {
            let touches = self.world.pass(LOOK_CLOSELY) > 0.0;
            let travel = (self.world.state().centre - rest.centre).norm();
            !touches && travel > limits.travel
        })
    }
}

/// Lower and upper corner of the bounding box.
pub(super) fn bounds(vertices: &[[f32; 3]]) -> (Point3<f64>, Point3<f64>) {
    let points = || vertices.iter().map(|&vertex| Point3::from(vertex).cast::<f64>());
    let low = points().reduce(|a, b| a.inf(&b)).unwrap_or_default();
    let high = points().reduce(|a, b| a.sup(&b)).unwrap_or_default();
    (low, high)
}
