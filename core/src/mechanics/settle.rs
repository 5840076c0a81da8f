//! What becomes of the body when it is let go.

use super::motion::{Motion, Settings};
use super::neighbourhood::Sleep;
use super::{Body, GRAVITY, Support};
use crate::geometry::{Pose, Vector};
use crate::monitor::{Meter, Stop};
use crate::params::Params;

/// How it ends when an object is let go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It rests on the supporter.
    Rests,
    /// It sank too far and had turned: it rotated off.
    RotatesOff,
    /// It sank too far without turning: it slid off.
    SlidesOff,
    /// It still moved when time was up.
    Moves,
}

/// Where it ended, and how.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settled {
    pub(crate) fate: Fate,
    /// Object to supporter.
    pub(crate) pose: Pose,
}

/// How far the centre of mass may sink for the object to still be said to hang: DESIGN's 6 cm, or half its extent.
pub(super) fn most_sinking(body: &Body) -> f32 {
    0.06_f32.max(0.5 * body.extent)
}

/// Interval over which the speed of a body is averaged to tell whether it rests, s.
pub(super) const REST_WINDOW: f32 = 0.08;
/// What falls and has turned by more than this, radians, rotated off.
const TURNED: f32 = 0.7;

/// Lets the body go at `release`; `down` is the unit vector along which things fall.
pub(crate) fn settle(
    (body, support): (&Body, &Support),
    release: &Pose,
    down: &Vector,
    settings: Settings,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<Settled, Stop> {
    let mut motion = Motion::new((body, support), body.at(release), settings, sleeps);
    let steps = settings.steps(settings.settle_time);
    let fate = follow(&mut motion, body, down, steps, meter)?.unwrap_or(Fate::Moves);
    Ok(Settled { fate, pose: body.pose(&motion.state) })
}

/// Duration for which [`swing_out`] follows the body, s.
pub(super) const SWING_TIME: f32 = 4.0;
/// Slower than this, metres per second of its centre of mass, it hangs then.
const SLOW: f32 = 0.05;

/// The same with little of what makes it rest sooner, as it is in truth: it swings out, or falls for that. At last it may still move a little.
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
    let fate = follow(&mut motion, body, down, settings.steps(SWING_TIME), meter)?;
    let hangs = motion.touches && motion.state.velocity.norm() < SLOW;
    let fate = fate.unwrap_or(if hangs { Fate::Rests } else { Fate::Moves });
    Ok(Settled { fate, pose: body.pose(&motion.state) })
}

/// Whether the body comes to rest or falls within so many steps.
fn follow(
    motion: &mut Motion,
    body: &Body,
    down: &Vector,
    steps: usize,
    meter: &mut Meter,
) -> Result<Option<Fate>, Stop> {
    let Settings { rest_speed, .. } = motion.settings;
    let window = motion.settings.steps(REST_WINDOW);
    let start = motion.state;
    let mut mark = start;
    for step in 1..=steps {
        motion.step(&(down * GRAVITY), meter)?;
        let state = &motion.state;
        if down.dot(&(state.centre - start.centre)) > most_sinking(body) {
            let turned = start.rotation.angle_to(&state.rotation);
            return Ok(Some(if turned > TURNED { Fate::RotatesOff } else { Fate::SlidesOff }));
        }
        if step % window == 0 {
            if motion.touches && body.travel(&mark, state) < rest_speed * REST_WINDOW {
                return Ok(Some(Fate::Rests));
            }
            mark = *state;
        }
    }
    Ok(None)
}

/// It comes free when nothing bears on it any more and it has moved this far, metres,
const FREE: f32 = 0.002;
/// within this time, s.
pub(super) const FREEING_TIME: f32 = 0.5;

/// Whether the body comes off when gravity is reversed: what does not is wedged, or was pushed onto the supporter.
pub(crate) fn comes_free(
    (body, support): (&Body, &Support),
    rest: &Pose,
    down: &Vector,
    settings: Settings,
    sleeps: &mut [Sleep],
    meter: &mut Meter,
) -> Result<bool, Stop> {
    let start = body.at(rest);
    let mut motion = Motion::new((body, support), start, settings, sleeps);
    for _ in 0..settings.steps(FREEING_TIME) {
        motion.step(&(-down * GRAVITY), meter)?;
        if !motion.touches && (motion.state.centre - start.centre).norm() > FREE {
            return Ok(true);
        }
    }
    Ok(false)
}
