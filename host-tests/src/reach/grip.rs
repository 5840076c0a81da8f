//! A gripper with two fingers that holds the lower end of an object that hangs.

use super::surroundings::samples;
use crate::judge::{Bullet, Judge, replay};
use crate::shapes::vector::turn;
use crate::solid::Solid;
use hangpose::geometry::{Point, Pose, Vector};
use hangpose::motion::{Capsule, Gripper};

/// Height of the part of the object that the fingers hold, m.
const HELD: f32 = 0.03;
/// Largest width between the fingers, m.
const WIDEST: f32 = 0.1;
/// Radius of a finger, m.
const FINGER: f32 = 0.006;
/// Radius of the palm, m.
const PALM: f32 = 0.012;
/// Radius of the wrist, m.
const WRIST: f32 = 0.03;
/// Play between a finger and the object, m.
const PLAY: f32 = 0.001;
/// Distance from the lower end of the object to the palm, m.
const BELOW: f32 = 0.03;
/// Length of the wrist, m.
const LONG: f32 = 0.1;
/// How far each finger opens, m.
const OPENS: f32 = 0.015;
/// How far the gripper leaves downwards, m.
const RETREAT: f32 = 0.08;
/// Free distance of the gripper from what stands still, m.
const ROOM: f32 = 0.004;
/// Number of directions of the fingers that are tried.
const TURNS: u32 = 12;

/// A gripper with its parts.
#[derive(Clone, Debug)]
pub struct Grip {
    parts: Vec<Capsule>,
    retreat: [f32; 3],
}

impl Grip {
    /// A gripper that holds the lower end of an object at `rest` from below, where that is least wide, and is 4 mm off what
    /// stands still while it holds and after it has opened; `None` if there is none.
    pub fn of(object: &Solid, rest: &Pose, obstacles: &Solid) -> Option<Self> {
        let points: Vec<Point> =
            samples(object, 0.004, None).iter().map(|&point| rest * Point::from(point)).collect();
        let low = points.iter().map(|point| point.z).fold(f32::INFINITY, f32::min);
        let mut widths: Vec<(f32, Vector, Point)> = (0..TURNS)
            .map(|k| {
                let [cos, sin] = turn(180.0 * f64::from(k) / f64::from(TURNS)).map(|x| x as f32);
                let (aside, across) = (Vector::new(cos, sin, 0.0), Vector::new(-sin, cos, 0.0));
                let span = |way: Vector| {
                    let held = points
                        .iter()
                        .filter(|point| point.z < low + HELD)
                        .map(|point| way.dot(&point.coords));
                    held.fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), s| (a.min(s), b.max(s)))
                };
                let ((a, b), (c, d)) = (span(aside), span(across));
                let middle = aside * (0.5 * (a + b)) + across * (0.5 * (c + d)) + Vector::z() * low;
                (b - a, aside, middle.into())
            })
            .collect();
        widths.retain(|(width, ..)| *width < WIDEST);
        widths.sort_by(|a, b| a.0.total_cmp(&b.0));
        let grips = widths.into_iter().map(|(width, aside, middle)| Self::at(width, aside, middle, rest));
        grips.into_iter().find(|grip| {
            [0.0, 1.0].into_iter().all(|open| {
                let wider = |part: &Capsule| Capsule { radius: part.radius + ROOM, ..*part };
                let parts: Vec<Capsule> = grip.parts.iter().map(wider).collect();
                let hand = replay::fingers(&Gripper { parts: &parts, retreat: grip.retreat }, open);
                let scene = replay::hand(&hand, obstacles);
                let mut world = Bullet::default().world(&scene);
                world.release(&rest.cast());
                world.penetration() <= 0.0
            })
        })
    }

    fn at(width: f32, aside: Vector, middle: Point, rest: &Pose) -> Self {
        let to_object = rest.inverse();
        let capsule = |from: Point, to: Point, radius: f32, opening: Vector| Capsule {
            from: (to_object * from).into(),
            to: (to_object * to).into(),
            radius,
            opening: (to_object * opening).into(),
        };
        let up = |height: f32| Vector::z() * height;
        let beside = aside * (0.5 * width + FINGER + PLAY);
        let finger = |side: f32| {
            let at = middle + beside * side;
            capsule(at + up(HELD - 2.0 * FINGER), at - up(BELOW), FINGER, aside * side * OPENS)
        };
        let palm = middle - up(BELOW + PALM);
        let wrist = palm - up(WRIST);
        let parts = vec![
            finger(-1.0),
            finger(1.0),
            capsule(palm - beside, palm + beside, PALM, Vector::zeros()),
            capsule(wrist, wrist - up(LONG), WRIST, Vector::zeros()),
        ];
        Self { parts, retreat: (to_object * -up(RETREAT)).into() }
    }

    /// The gripper as the planner takes it.
    pub fn gripper(&self) -> Gripper<'_> {
        Gripper { parts: &self.parts, retreat: self.retreat }
    }
}
