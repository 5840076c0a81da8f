//! Distances of the object from what stands still, by its signed distance field.

use super::touch::{Collector, Nearest, Touch};
use super::track::Track;
use super::{EXACT_UP_TO, PATCH_RANGE};
use crate::geometry::{
    Aabb, Node, Point, PointTree, Pose, Surface, Vector, ball_on, halves, longest_side_first, unit_or,
};
use crate::mechanics::{Body, Gap, Support, fall_over, gap_to_patch};
use crate::monitor::Meter;
use crate::motion::failure::{Mover, Obstacle};
use nalgebra::Rotation3;

/// Most halvings of a triangle until it is as small as distances are told.
const MAX_HALVINGS: usize = 24;
/// Radius of a piece of a triangle that is not halved any more, metres: its corners tell its distance.
pub(super) const SMALLEST_PIECE: f32 = 0.001;
/// The same where all that is near is told, and not only the nearest: what is as near to each other is told once.
const SMALLEST_OF_ALL: f32 = 0.0025;

/// The object at a pose.
pub(super) struct ObjectQuery<'q, 'a> {
    pub(super) body: &'q Body<'a>,
    pub(super) pose: &'q Pose,
    pub(super) to_object: Pose,
    found: &'q mut dyn Collector,
    /// Of what is looked for, metres: distance below which touches are of interest.
    limit: f32,
    /// Distance queries made.
    pub(super) queries: usize,
    /// Stops the queries of a large triangle, of which there may be millions; `None` where there are no triangles.
    meter: Option<&'q Meter<'q>>,
}

impl<'q, 'a> ObjectQuery<'q, 'a> {
    pub(super) fn new(
        body: &'q Body<'a>,
        pose: &'q Pose,
        found: &'q mut dyn Collector,
        meter: Option<&'q Meter<'q>>,
    ) -> Self {
        let limit = found.limit();
        Self { body, pose, to_object: pose.inverse(), found, limit, queries: 0, meter }
    }

    /// Lower bound of the distance of what is in a ball, by its centre in object coordinates; `None` if that need not be looked
    /// at: because it is farther away than matters, or because the bound is exact enough, and is offered.
    fn bound(&mut self, centre: &Point, radius: f32, obstacle: Obstacle) -> Option<f32> {
        let limit = self.limit;
        if self.body.is_beyond(centre, radius + limit) {
            return None;
        }
        self.queries += 1;
        let distance = self.body.field.distance(centre) - radius;
        // Beyond a few millimetres, half of the distance of the centre is exact enough: where two flat sides face each other, thousands
        // of small pieces would have to be looked at for more.
        if distance >= EXACT_UP_TO.min(PATCH_RANGE.max(radius)) {
            self.offer(distance, centre, Vector::zeros(), obstacle);
            return None;
        }
        (distance < limit).then_some(distance)
    }

    /// The same of a box in other coordinates, from which `to_object` leads to the object's.
    fn bound_of_box(&mut self, aabb: &Aabb, to_object: &Pose, more: f32, obstacle: Obstacle) -> Option<f32> {
        self.bound(&(to_object * aabb.centre()), 0.5 * aabb.diagonal() + more, obstacle)
    }

    fn offer(&mut self, distance: f32, at: &Point, gradient: Vector, obstacle: Obstacle) {
        if distance < self.limit {
            let normal = -(self.pose.rotation * gradient);
            self.take(Touch { distance, at: self.pose * at, normal, mover: Mover::Object, obstacle });
        }
    }

    fn take(&mut self, touch: Touch) {
        self.found.offer(touch);
        self.limit = self.found.limit();
    }

    pub(super) fn supporter(&mut self, support: &Support, track: &mut Track) {
        let rotation = self.pose.rotation.to_rotation_matrix();
        if let Some(before) = track.patches.get(track.nearest)
            && before - track.travelled < self.limit
        {
            self.patch(support, &rotation, track.nearest, track);
        }
        for (index, group) in support.groups.iter().enumerate() {
            if track.groups[index] - track.travelled >= self.limit {
                continue;
            }
            let at = self.in_object(&rotation, &group.centre);
            self.queries += 1;
            let bound = self.body.field.distance(&at) - group.radius;
            if bound >= EXACT_UP_TO {
                self.offer(bound, &at, Vector::zeros(), Obstacle::Supporter);
            }
            track.groups[index] = track.travelled + bound;
            if bound >= self.limit {
                continue;
            }
            let mut least = f32::INFINITY;
            for patch in group.patches() {
                if track.patches[patch] - track.travelled < self.limit {
                    self.patch(support, &rotation, patch, track);
                }
                least = least.min(track.patches[patch]);
            }
            track.groups[index] = least;
        }
    }

    /// A point in object coordinates, by the rotation of the pose: a matrix rotates faster than a quaternion.
    fn in_object(&self, rotation: &Rotation3<f32>, point: &Point) -> Point {
        rotation.inverse_transform_vector(&(point - self.pose.translation.vector).coords).into()
    }

    fn patch(&mut self, support: &Support, rotation: &Rotation3<f32>, patch: usize, track: &mut Track) {
        let at = self.in_object(rotation, &support.position(patch));
        self.queries += 1;
        let before = self.limit;
        let (distance, at, gradient) =
            match gap_to_patch(self.body, support, patch, (rotation, &at), before.min(PATCH_RANGE)) {
                Gap::Near { distance, at, gradient } => (distance, at, gradient),
                Gap::Beyond(distance) => (distance, at, Vector::zeros()),
            };
        track.patches[patch] = track.travelled + distance;
        self.offer(distance, &at, gradient, Obstacle::Supporter);
        if distance < before {
            track.nearest = patch;
        }
    }

    /// Looks at the scene or an object that hangs already, unless it is known to be farther away than matters.
    pub(super) fn unless_asleep(&mut self, track: &mut Track, other: usize, look: impl Fn(&mut ObjectQuery)) {
        let limit = self.limit;
        if !track.is_awake(other, limit) {
            return;
        }
        if self.found.takes_all() {
            look(self);
            return;
        }
        // Farther than matters now, so that it sleeps for a while.
        let enough = self.found.enough();
        let mut nearest = Nearest { enough, ..Nearest::within(limit.max(EXACT_UP_TO)) };
        let mut query = ObjectQuery::new(self.body, self.pose, &mut nearest, self.meter);
        look(&mut query);
        self.queries += query.queries;
        // Something else may be nearer than what was enough.
        track.note(other, if nearest.distance < enough { f32::NEG_INFINITY } else { nearest.distance });
        if let Some(touch) = nearest.touch.filter(|touch| touch.distance < limit) {
            self.take(touch);
        }
    }

    fn limit(&self) -> f32 {
        self.limit
    }

    pub(super) fn scene(&mut self, scene: &PointTree, radius: f32) {
        let to_object = self.to_object;
        let obstacle = |index: usize| Obstacle::Scene(scene.order()[index] as usize);
        let bound = |query: &mut Self, node: &Node| {
            query.bound_of_box(&node.aabb(), &to_object, radius, Obstacle::Scene(0))
        };
        scene.bvh().visit_ordered(self, bound, Self::limit, |query, items, _| {
            for index in items {
                let at = to_object * scene.points()[index];
                query.queries += 1;
                let (distance, gradient) = query.body.field.sample(&at);
                query.offer(distance - radius, &at, gradient, obstacle(index));
            }
        });
    }

    /// Another object, by its surface and its pose.
    pub(super) fn surface(&mut self, surface: &Surface, pose: &Pose, obstacle: Obstacle) {
        let between = self.to_object * pose;
        let bound = |query: &mut Self, node: &Node| query.bound_of_box(&node.aabb(), &between, 0.0, obstacle);
        surface.bvh().visit_ordered(self, bound, Self::limit, |query, items, _| {
            for triangle in &surface.triangles()[items] {
                query.triangle(triangle.map(|corner| between * corner), obstacle);
            }
        });
    }

    /// A triangle in object coordinates. It is halved where its bounding ball alone does not tell, and the nearer half comes first.
    /// What is found is of no use where the meter stops the queries: the caller asks it next.
    fn triangle(&mut self, triangle: [Point; 3], obstacle: Obstacle) {
        let [a, b, c] = triangle;
        let normal = unit_or((b - a).cross(&(c - a)), Vector::zeros());
        let smallest = if self.found.takes_all() { SMALLEST_OF_ALL } else { SMALLEST_PIECE };
        let mut waiting = heapless::Vec::<(Piece, f32), { MAX_HALVINGS + 1 }>::new();
        let mut next = self.piece(triangle, &normal, obstacle);
        while let Some((piece, bound)) = next.or_else(|| waiting.pop()) {
            next = None;
            if self.meter.is_some_and(|meter| meter.check_with(self.queries).is_err()) {
                return;
            }
            if bound >= self.limit {
                continue;
            }
            if piece.radius < smallest || waiting.len() + 2 > MAX_HALVINGS {
                for corner in piece.corners {
                    self.queries += 1;
                    let (distance, gradient) = self.body.field.sample(&corner);
                    self.offer(distance, &corner, gradient, obstacle);
                }
                continue;
            }
            next = match halves(piece.corners).map(|half| self.piece(half, &normal, obstacle)) {
                [Some(one), Some(other)] => {
                    let (near, far) = if other.1 < one.1 { (other, one) } else { (one, other) };
                    let _ = waiting.push(far);
                    Some(near)
                }
                [only, None] | [None, only] => only,
            };
        }
    }

    /// A piece of a triangle with this unit normal, and a lower bound of its distance or, for all that is near, an estimate; `None`
    /// if the piece need not be looked at.
    fn piece(&mut self, corners: [Point; 3], normal: &Vector, obstacle: Obstacle) -> Option<(Piece, f32)> {
        let corners = longest_side_first(corners);
        let (centre, radius) = ball_on(&corners);
        let mut least = self.bound(&centre, radius, obstacle)?;
        let takes_all = self.found.takes_all();
        if takes_all || least + radius < self.limit {
            self.queries += 1;
            let (distance, gradient) = self.body.field.sample(&centre);
            self.offer(distance, &centre, gradient, obstacle);
            // What is told of all that is near is an estimate anyway: where it is first.
            if takes_all && gradient != Vector::zeros() && *normal != Vector::zeros() {
                let slope = (gradient - normal * gradient.dot(normal)).norm();
                least = least.max(distance - fall_over(radius, slope));
            }
        }
        (least < self.limit).then_some((Piece { corners, radius }, least))
    }
}

/// A piece of a triangle in object coordinates, with the radius of the ball around it.
struct Piece {
    /// The longest side is between the first two.
    corners: [Point; 3],
    /// Metres.
    radius: f32,
}
