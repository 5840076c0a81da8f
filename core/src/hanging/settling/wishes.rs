//! Whether a pose is as the caller asked for.

use super::{CLEARANCE, Settling};
use crate::geometry::{Pose, Vector, any_perpendicular, rotate_about};
use crate::hanging::request::{Approach, Request};
use crate::mechanics::{
    Body, Contact, Frames, Kind, Support, first_within, is_clear_of_points, is_clear_of_surface,
};
use crate::monitor::{Meter, Stop};
use nalgebra::Translation3;

/// Share of the weight that the contacts in a region must carry.
const SHARE_IN_REGION: f32 = 0.5;
/// Length of a step along an approach, metres: less than what a bar is thick.
const APPROACH_STEP: f32 = 0.002;
/// Directions tried on either of two circles in the cone of an approach, beside its axis.
const AROUND: usize = 8;

/// Whether the object at `pose`, from frame to frame, is at least `clearance` metres away from the scene and from what hangs already.
pub(in crate::hanging) fn is_clear_of_scene(
    (body, support): (&Body, &Support),
    request: &Request,
    pose: &Pose,
    clearance: f32,
    meter: &mut Meter,
) -> Result<bool, Stop> {
    // Scene and poses are in the caller's supporter coordinates.
    let pose = &(support.frame.inverse() * pose);
    for hung in request.hung {
        let other_pose = hung.pose * hung.object.frame().inverse();
        if !is_clear_of_surface(body, pose, (hung.object.surface(), &other_pose), clearance, meter)? {
            return Ok(false);
        }
    }
    is_clear_of_points(body, pose, request.scene, clearance, meter)
}

impl Settling<'_> {
    /// Whether the object hangs where and in the way that was asked for, at its rest pose and its release pose. Counts why not.
    pub(super) fn is_as_asked(
        &mut self,
        (rest, release): (&Pose, &Pose),
        contacts: &[Contact],
        kind: Kind,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        let (bodies, request) = ((self.body, self.support), self.request);
        let is_clear =
            |pose: &Pose, meter: &mut Meter| is_clear_of_scene(bodies, request, pose, CLEARANCE, meter);
        if !self.hangs_in_region(rest, contacts) {
            self.counts.outside += 1;
        } else if !self.request.allow.contains(kind) {
            self.counts.other_kind += 1;
        } else if !is_clear(rest, meter)? || !is_clear(release, meter)? {
            self.counts.in_scene += 1;
        } else {
            return Ok(true);
        }
        Ok(false)
    }

    /// Whether most of the weight rests in both regions.
    fn hangs_in_region(&self, rest: &Pose, contacts: &[Contact]) -> bool {
        let (request, to_object) = (self.request, rest.inverse());
        if !request.on.is_limited() && !request.by.is_limited() {
            return true;
        }
        let frames = Frames::of((self.body, self.support));
        let is_inside = |contact: &&Contact| {
            request.on.contains(&frames.on_supporter(&contact.position))
                && request.by.contains(&frames.on_object(&(to_object * contact.position)))
        };
        let weight =
            |contacts: &mut dyn Iterator<Item = &Contact>| contacts.map(|contact| contact.force).sum::<f32>();
        let inside = weight(&mut contacts.iter().filter(is_inside));
        inside >= SHARE_IN_REGION * weight(&mut contacts.iter())
    }

    /// Whether a straight way in the direction that was asked for leads to the release pose without a collision.
    pub(super) fn has_approach(&self, release: &Pose, meter: &mut Meter) -> Result<bool, Stop> {
        let Some(Approach { direction, angle, length }) = self.request.approach else { return Ok(true) };
        let axis = self.support.frame * Vector::from(direction).normalize();
        let first = any_perpendicular(axis);
        let ways = core::iter::once(axis).chain([0.5 * angle, angle].into_iter().flat_map(|angle| {
            let (sin, cos) = libm::sincosf(angle);
            let turn = move |k: usize| core::f32::consts::TAU * k as f32 / AROUND as f32;
            (0..AROUND).map(move |k| axis * cos + rotate_about(axis, turn(k), first) * sin)
        }));
        for way in ways {
            if self.is_way_free(release, &way, length, meter)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether the object collides with nothing while it moves along `way` for `length` metres to its release pose.
    fn is_way_free(
        &self,
        release: &Pose,
        way: &Vector,
        length: f32,
        meter: &mut Meter,
    ) -> Result<bool, Stop> {
        let steps = libm::ceilf(length / APPROACH_STEP) as usize;
        for step in 1..=steps {
            let back = way * -(length * step as f32 / steps as f32);
            let pose = Translation3::from(back) * release;
            let is_free = first_within((self.body, self.support), &pose, 0.0, meter)?.is_none()
                && is_clear_of_scene((self.body, self.support), self.request, &pose, 0.0, meter)?;
            if !is_free {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
