//! A moving picture of the way to a pose and of the release there.

use crate::gallery::{ASIDE, mesh_of};
use crate::solid::Solid;
use gif::{Encoder, Frame, Repeat};
use hangpose::geometry::{Point, Pose, Vector};
use hangpose::motion::Waypoint;
use hangpose::view::picture::{OBJECT, Picture, SUPPORTER, WAY, between};
use std::io::{self, BufWriter};
use std::path::Path;

/// Width of the pictures, pixels.
const WIDTH: u32 = 440;
/// Pictures in a second.
const RATE: f32 = 20.0;
/// Duration for which the last picture is shown, seconds.
const PAUSE: f32 = 1.5;
/// Effort of the choice of colours: 1 is the best, 30 the fastest.
const SPEED: i32 = 10;

/// Writes a GIF: the object moves through `poses` as their times say. Its centre of mass, in its own coordinates, leaves a line.
pub fn write(
    path: &Path,
    object: &Solid,
    supporter: &Solid,
    poses: &[Waypoint],
    centre: [f32; 3],
) -> io::Result<()> {
    let [object, supporter] = [object, supporter].map(mesh_of);
    let centre = Point::from(centre);
    let corners =
        |pose: &Pose| object.vertices().iter().map(|v| pose * Point::from(v.to_array())).collect::<Vec<_>>();
    let all: Vec<Point> = poses.iter().flat_map(|waypoint| corners(&waypoint.pose)).collect();
    let seconds = poses.last().map_or(0.0, |last| last.seconds);
    let frames = (seconds * RATE).ceil() as usize;
    let mut encoder = None;
    let mut line = Vec::new();
    for index in 0..=frames {
        let pose = at(poses, &centre, index as f32 / RATE);
        line.push(pose * centre);
        let mut picture = Picture::new(ASIDE, &Vector::z());
        picture.keep_in_view(all.iter().copied());
        picture.add_mesh(&supporter, &Pose::identity(), SUPPORTER, 1.0);
        picture.add_mesh(&object, &pose, OBJECT, 1.0);
        picture.add_line(line.clone(), WAY);
        picture.add_dot(pose * centre, WAY);
        let pixels = picture.pixels(WIDTH);
        let [width, height] = [pixels.width, pixels.height].map(|side| side as u16);
        let encoder = match &mut encoder {
            Some(encoder) => encoder,
            none => {
                let file = BufWriter::new(std::fs::File::create(path)?);
                let mut new = Encoder::new(file, width, height, &[]).map_err(io::Error::other)?;
                new.set_repeat(Repeat::Infinite).map_err(io::Error::other)?;
                none.insert(new)
            }
        };
        let mut frame = Frame::from_rgb_speed(width, height, &pixels.rgb, SPEED);
        let duration = if index == frames { PAUSE } else { 1.0 / RATE };
        frame.delay = (100.0 * duration) as u16;
        encoder.write_frame(&frame).map_err(io::Error::other)?;
    }
    Ok(())
}

/// The pose at a time.
fn at(poses: &[Waypoint], centre: &Point, seconds: f32) -> Pose {
    let next = poses.partition_point(|waypoint| waypoint.seconds <= seconds);
    match (next.checked_sub(1).map(|index| poses[index]), poses.get(next)) {
        (Some(last), Some(next)) => {
            let share = (seconds - last.seconds) / (next.seconds - last.seconds);
            between(&last.pose, &next.pose, centre, share)
        }
        (Some(last), None) => last.pose,
        (None, next) => next.map_or_else(Pose::identity, |next| next.pose),
    }
}
