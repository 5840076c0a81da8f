//! How much of what matters at a pose no camera has seen.

use super::constants::{NEAR_GUESS, OFF_MESH};
use super::{Body, Support};
use crate::geometry::{Point, Pose, Vector, Viewpoints, fibonacci_direction, unit_or};
use crate::memory::{Arena, OutOfMemory, array_bytes};
use crate::monitor::{Meter, Stop};

/// How much of what matters at a pose no camera has seen. All zero where no viewpoints are given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Unseen {
    /// Share of the directions from which no camera looked at the object, 0 to 1: the same for all poses.
    pub object: f32,
    /// Share of the supporter near the object, in the box around its mesh along its principal axes, that is in the shadow
    /// of the mesh, 0 to 1. No camera saw that the object is not there. What is behind the object, outside the box, does not count.
    pub shadow: f32,
    /// Share of the supporter close to the object that no camera saw and that was guessed, 0 to 1.
    pub supporter: f32,
    /// Direction from the object, in its coordinates, in which a camera would see most of what no camera saw: a unit vector,
    /// or zero.
    pub object_view: [f32; 3],
    /// Direction from the supporter, in its coordinates, in which a camera would see most of what was guessed close to the
    /// object: a unit vector, or zero.
    pub supporter_view: [f32; 3],
}

/// Where an object was seen from.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Views<'a> {
    /// Positions of the cameras in object coordinates, metres.
    pub(super) viewpoints: &'a [Point],
    /// See [`Unseen::object`].
    pub(super) unseen: f32,
    /// See [`Unseen::object_view`].
    pub(super) needed: [f32; 3],
}

/// The most viewpoints that are kept. Of more, as many are taken, spread over all. More than a scan from all sides has (24), and as many as
/// fit into the memory for an object that programs were promised by the C header (`HANGPOSE_OBJECT_BYTES_AT_LEAST`).
const MAX_VIEWS: usize = 28;
/// Directions that are probed for a camera.
const DIRECTIONS: usize = 128;
/// Cosine of the angle between a surface's normal and the way to a camera up to which the camera sees the surface well: 60
/// degrees. Beyond, depth cameras lose points.
const SEES_WELL: f32 = 0.5;

impl<'a> Views<'a> {
    /// Bytes of memory, whatever the mesh.
    pub(crate) const BYTES: usize = array_bytes::<Point>(MAX_VIEWS);

    /// The views of a mesh from the viewpoints that are `given`; `centre` is the middle of the box around the mesh.
    pub(crate) fn new(given: Viewpoints, centre: &Point, arena: &mut Arena<'a>) -> Result<Self, OutOfMemory> {
        let viewpoints = arena.slice::<Point>(given.len().min(MAX_VIEWS))?;
        let (all, count) = (given.len(), viewpoints.len());
        for (k, viewpoint) in viewpoints.iter_mut().enumerate() {
            *viewpoint = given.get(k * all / count).unwrap_or(*viewpoint);
        }
        let (unseen, needed) = unseen_directions(centre, viewpoints);
        Ok(Self { viewpoints, unseen, needed })
    }
}

/// Share of the directions around a centre from which no viewpoint looks at it, 0 without viewpoints, and their mean
/// direction.
fn unseen_directions(centre: &Point, viewpoints: &[Point]) -> (f32, [f32; 3]) {
    if viewpoints.is_empty() {
        return (0.0, [0.0; 3]);
    }
    let is_seen = |direction: &Vector| {
        viewpoints.iter().any(|viewpoint| {
            let way = viewpoint - centre;
            direction.dot(&way) > SEES_WELL * way.norm()
        })
    };
    let unseen = || {
        (0..DIRECTIONS).map(|k| fibonacci_direction(k, DIRECTIONS)).filter(|direction| !is_seen(direction))
    };
    (unseen().count() as f32 / DIRECTIONS as f32, unit_or(unseen().sum(), Vector::zeros()).into())
}

/// How much of what matters no camera has seen with the object at `pose`.
pub(crate) fn unseen(
    (body, support): (&Body, &Support),
    pose: &Pose,
    meter: &mut Meter,
) -> Result<Unseen, Stop> {
    let (to_object, views) = (pose.inverse(), &body.views);
    if views.viewpoints.is_empty() && !support.patches.iter().any(|patch| patch.is_guessed()) {
        return Ok(Unseen::default());
    }
    let sees = |viewpoint: &Point, point: &Point| {
        let way = unit_or(viewpoint - point, Vector::z());
        !body.surface.any_hit(&(point + way * OFF_MESH), &way)
    };
    let (mut close, mut guessed, mut outwards) = (0_u32, 0_u32, Vector::zeros());
    let (mut enclosed, mut hidden) = (0_u32, 0_u32);
    let around = body.surface.aabb();
    for (position, patch) in support.positions().zip(support.patches) {
        let point = to_object * position;
        if !views.viewpoints.is_empty() && around.contains(&point) {
            enclosed += 1;
            let seen_by = views.viewpoints.iter().position(|viewpoint| sees(viewpoint, &point));
            meter.rays(seen_by.map_or(views.viewpoints.len(), |index| index + 1))?;
            hidden += u32::from(seen_by.is_none());
        }
        if body.is_beyond(&point, NEAR_GUESS) {
            continue;
        }
        meter.distance_queries(1)?;
        if body.field.distance(&point) < NEAR_GUESS {
            close += 1;
            if patch.is_guessed() {
                guessed += 1;
                outwards += patch.normal;
            }
        }
    }
    let share = |part: u32, all: u32| part as f32 / all.max(1) as f32;
    Ok(Unseen {
        object: views.unseen,
        shadow: share(hidden, enclosed),
        supporter: share(guessed, close),
        object_view: views.needed,
        supporter_view: unit_or(outwards, Vector::zeros()).into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    #[test]
    fn a_camera_sees_a_quarter_of_all_directions_well() {
        let centre = Point::new(0.1, 0.2, 0.3);
        let unseen = |ways: &[Vector]| {
            let viewpoints: Vec<Point> = ways.iter().map(|way| centre + way * 0.7).collect();
            unseen_directions(&centre, &viewpoints).0
        };
        assert_eq!(unseen(&[]), 0.0);
        // A cap of 60 degrees is a quarter of the sphere; two opposite ones are a half; six see all, since no
        // direction is more than 54.7 degrees from all axes.
        assert!((unseen(&[Vector::x()]) - 0.75).abs() < 0.02);
        assert!((unseen(&[Vector::x(), -Vector::x()]) - 0.5).abs() < 0.02);
        let axes = [Vector::x(), Vector::y(), Vector::z()];
        assert_eq!(unseen(&axes.map(|axis| [axis, -axis]).concat()), 0.0);
        // What the camera in front does not see, one behind sees best.
        let needed = Vector::from(unseen_directions(&centre, &[centre + Vector::x()]).1);
        assert!((needed + Vector::x()).norm() < 0.05, "{needed}");
    }
}
