//! The outcome of a release: rest, fall or continued motion.

use super::body::State;
use super::constants::{
    ENOUGH_PLAY, FALL_EXTENT_RATIO, FALL_HEIGHT, FREE_TRAVEL, FREEING_TIME, GRAVITY, REST_WINDOW,
    ROTATION_OFF_ANGLE, SWING_REST_SPEED, SWING_TIME,
};
use super::motion::{Motion, Settings};
use super::neighbourhood::Sleep;
use super::{Body, Support};
use crate::geometry::{Point, Pose, Vector};
use crate::monitor::{Meter, Stop};
use crate::params::Params;

/// Outcome of the release of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Fate {
    /// The object rests on the supporter.
    Rests,
    /// The object fell and had turned: it rotated off.
    RotatesOff,
    /// The object fell without turning: it slid off.
    SlidesOff,
    /// The object still moved when the time was up.
    Moves,
}

/// Outcome and final pose of a release.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settled {
    pub(crate) fate: Fate,
    /// Object to supporter coordinates.
    pub(crate) pose: Pose,
}

/// Drop of the centre of mass beyond which the body has fallen, metres.
pub(super) fn max_sinking(body: &Body) -> f32 {
    FALL_HEIGHT.max(FALL_EXTENT_RATIO * body.extent)
}

/// Releases the body at `release` and simulates it for at most the settle time; `down` is the unit vector of
/// gravity.
pub(crate) fn settle(
    (body, support): (&Body, &Support),
    release: &Pose,
    down: &Vector,
    settings: Settings,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<Settled, Stop> {
    settle_watched((body, support), release, down, settings, sleeps, meter, |_| ())
}

/// [`settle`], and calls `watch` with the state after each time step.
pub(crate) fn settle_watched(
    (body, support): (&Body, &Support),
    release: &Pose,
    down: &Vector,
    settings: Settings,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
    watch: impl FnMut(&State),
) -> Result<Settled, Stop> {
    let mut motion = Motion::new((body, support), body.at(release), settings, sleeps);
    let steps = settings.steps(settings.settle_time);
    let fate = simulate(&mut motion, body, down, steps, meter, watch)?.unwrap_or(Fate::Moves);
    Ok(Settled { fate, pose: body.pose(&motion.state) })
}

/// Releases the body like [`settle`], but with realistic, low damping, so that it swings out or falls while
/// swinging. A body that touches and is slow after [`SWING_TIME`] rests, too.
pub(crate) fn swing_out(
    (body, support): (&Body, &Support),
    release: &Pose,
    down: &Vector,
    params: &Params,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<Settled, Stop> {
    let settings = Settings::swinging(params);
    let mut motion = Motion::new((body, support), body.at(release), settings, sleeps);
    let fate = simulate(&mut motion, body, down, settings.steps(SWING_TIME), meter, |_| ())?;
    let hangs = motion.touches && motion.state.velocity.norm() < SWING_REST_SPEED;
    let fate = fate.unwrap_or(if hangs { Fate::Rests } else { Fate::Moves });
    Ok(Settled { fate, pose: body.pose(&motion.state) })
}

/// Simulates until the body rests or falls, or returns `None` after `steps`; calls `watch` after each of them.
fn simulate(
    motion: &mut Motion,
    body: &Body,
    down: &Vector,
    steps: usize,
    meter: &mut Meter,
    mut watch: impl FnMut(&State),
) -> Result<Option<Fate>, Stop> {
    let window = motion.settings.steps(REST_WINDOW);
    let rest_travel = motion.settings.rest_speed * REST_WINDOW;
    let start = motion.state;
    let mut window_start = start;
    for step in 1..=steps {
        motion.step(&(down * GRAVITY), meter)?;
        let state = &motion.state;
        watch(state);
        if down.dot(&(state.centre - start.centre)) > max_sinking(body) {
            let turned = start.rotation.angle_to(&state.rotation);
            return Ok(Some(if turned > ROTATION_OFF_ANGLE { Fate::RotatesOff } else { Fate::SlidesOff }));
        }
        if step.is_multiple_of(window) {
            if motion.touches && body.travel(&window_start, state) < rest_travel {
                return Ok(Some(Fate::Rests));
            }
            window_start = *state;
        }
    }
    Ok(None)
}

/// How far the body travels without contact when gravity is reversed, metres, at most [`ENOUGH_PLAY`]; `None` if it does not come
/// free. A body that does not is wedged, or was pushed onto the supporter.
pub(crate) fn play(
    (body, support): (&Body, &Support),
    rest: &Pose,
    down: &Vector,
    settings: Settings,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<Option<f32>, Stop> {
    let start = body.at(rest);
    let mut motion = Motion::new((body, support), start, settings, sleeps);
    // Where the contact was lost, and the longest travel without contact.
    let (mut lost, mut play) = (start.centre, 0.0_f32);
    let mut is_free = false;
    for _ in 0..settings.steps(FREEING_TIME) {
        motion.step(&(-down * GRAVITY), meter)?;
        let centre = motion.state.centre;
        if motion.touches {
            lost = centre;
            continue;
        }
        is_free |= (centre - start.centre).norm() > FREE_TRAVEL;
        play = play.max((centre - lost).norm());
        if is_free && play >= ENOUGH_PLAY {
            break;
        }
    }
    Ok(is_free.then_some(play.min(ENOUGH_PLAY)))
}

/// Time steps of a pull without contact; what is held back is pulled for twice as long.
const PULL_STEPS: u16 = 10;
/// Radius of gyration about the point at which a body is pulled, metres. The rim of a hole is about as far from that point: so what
/// the body is threaded on turns it easily, however long it is.
const PULLED_RADIUS: f32 = 0.01;
/// Travel of the farthest point of a body that is pulled at another point, in multiples of the travel asked for, after which the pull
/// ends: it does not turn far between two poses.
const MOST_TURNED: f32 = 4.0;

/// How a body is pulled, in supporter coordinates but for the point.
pub(crate) struct Pull {
    /// Unit vector.
    pub(crate) direction: Vector,
    /// The point at which it is pulled, in object coordinates, as if its mass were near to it; by default the centre of mass.
    pub(crate) at: Option<Point>,
    /// Travel after which the pull ends, metres: of that point, or of the farthest one of the body.
    pub(crate) travel: f32,
    /// Distance that it keeps from the supporter, metres.
    pub(crate) gap: f32,
}

/// Where the body is after it has been pulled from rest, without friction. What is in its way turns it and leads it aside.
pub(crate) fn pulled(
    (body, support): (&Body, &Support),
    from: &Pose,
    pull: &Pull,
    params: &Params,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<Pose, Stop> {
    let settings = Settings::pulled(params, pull.gap);
    let body = &pull.at.map_or(*body, |at| body.with_mass_at(at, PULLED_RADIUS));
    let start = body.at(from);
    let seconds = f32::from(PULL_STEPS) * settings.time_step;
    let acceleration = pull.direction * (2.0 * pull.travel / (seconds * seconds));
    let mut motion = Motion::new((body, support), start, settings, sleeps);
    for _ in 0..2 * PULL_STEPS {
        motion.step(&acceleration, meter)?;
        let (of_point, of_all) =
            ((motion.state.centre - start.centre).norm(), body.travel(&start, &motion.state));
        let most = if pull.at.is_some() { MOST_TURNED * pull.travel } else { pull.travel };
        if of_point > pull.travel || of_all > most {
            break;
        }
    }
    Ok(body.pose(&motion.state))
}
