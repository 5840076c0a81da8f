//! The course of a trial, the same in every engine, and what is concluded from it.

use super::{GRAVITY, Scene, State, World};
use nalgebra::{Isometry3, Point3, Vector3};

/// What counts as hanging. The numbers are the definition; they are here to be named, not to be tuned.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// The deepest that a clear pose may penetrate, metres.
    pub penetration: f64,
    /// How long it has to hold, seconds.
    pub settling: f64,
    /// How far the centre of mass may sink, metres, or else [`Limits::sinking_extents`].
    pub sinking: f64,
    /// The same in multiples of the object's largest extent.
    pub sinking_extents: f64,
    /// How fast it may still be at the end, metres per second.
    pub speed: f64,
    /// How long it has to come free when gravity is reversed, seconds.
    pub reversal: f64,
    /// How far it has to have moved then, metres.
    pub travel: f64,
    /// How far gravity is tilted, radians.
    pub tilt: f64,
    /// How long it has to stay then, seconds.
    pub tilting: f64,
}

impl Limits {
    /// The definition.
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

/// What became of an object that was let go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// At the predicted pose nothing penetrates deeper than 2 mm.
    pub clear: bool,
    /// After 4 s it still touches the supporter, has sunk no further than it may, and is slow.
    pub holds: bool,
    /// With gravity reversed it comes free within 1.5 s: at some moment nothing bears on it and
    /// it has moved. What is
    /// wedged through the supporter does not. (It need not get away: a ring lifts off a peg, and then hangs upwards.)
    /// False when it does not hold.
    pub honest: bool,
    /// From rest it stays through gravity tilted by 21.8 degrees towards each of four sides. False when it does not
    /// hold, or was not tried.
    pub robust: bool,
    /// What the above was concluded from.
    pub figures: Figures,
}

impl Verdict {
    /// Whether it hangs.
    pub fn success(&self) -> bool {
        self.clear && self.holds && self.honest
    }
}

/// What was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// The deepest at the predicted pose, metres.
    pub penetration: f64,
    /// How far the centre of mass sank, metres.
    pub sank: f64,
    /// Of the centre of mass at the end, metres per second.
    pub speed: f64,
    /// Whether it touches the supporter at the end.
    pub touches: bool,
    /// When it had sunk too far for good, seconds after the release.
    pub fell_after: Option<f64>,
    /// Whether it stays when gravity is tilted towards +x, -x, +y and -y.
    pub tilts: [bool; 4],
    /// Where it came to rest, or was seen last. Maps object to supporter coordinates.
    pub rest: Isometry3<f32>,
    /// The angle between release and rest, radians.
    pub turned: f64,
}

/// How often it is looked at, seconds.
const LOOK: f64 = 0.01;
/// The same while it comes free: what lies in a hole with 2 mm of play flies freely for 20 ms.
const LOOK_CLOSELY: f64 = 0.001;
/// Slower than this, metres per second of any of its points, it is still; and when it was still for so long, seconds,
/// then the rest of a phase is not waited for.
const STILL: f64 = 0.001;
const STILL_FOR: f64 = 0.5;

struct Trial<'a> {
    world: &'a mut World,
    /// From the centre of mass to the farthest vertex.
    reach: f64,
    /// The supporter's box.
    low: Point3<f64>,
    high: Point3<f64>,
    /// How far the centre of mass may sink.
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
    /// Lets gravity act, until time is up or it is clear how that would end.
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

    /// Whether it has fallen past all of the supporter.
    fn out_of_reach(&self, state: &State, down: &Vector3<f64>) -> bool {
        let lowest: f64 = (0..3).map(|i| (self.low[i] * down[i]).max(self.high[i] * down[i])).sum();
        state.velocity.dot(down) > 0.0 && state.centre.dot(down) > lowest + self.reach
    }

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

fn bounds(vertices: &[[f32; 3]]) -> (Point3<f64>, Point3<f64>) {
    let points = || vertices.iter().map(|&vertex| Point3::from(vertex).cast::<f64>());
    let low = points().reduce(|a, b| a.inf(&b)).unwrap_or_default();
    let high = points().reduce(|a, b| a.sup(&b)).unwrap_or_default();
    (low, high)
}
