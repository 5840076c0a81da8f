//! How many images a scan takes, as the tables name it.

use super::{Sensor, Shot, Target, views};
use crate::shapes::{Bar, Opening, Random};
use crate::solid::Solid;
use hangpose::geometry::{Point, Vector};
use parry3d::shape::TriMesh;
use std::fmt;
use std::str::FromStr;

/// Distance around the bars of a supporter that its images show at least, m: most of an object that hangs there.
const AROUND_BARS: f32 = 0.08;

/// Numbers of images of the object and of the supporter. Its text is `24+3`, or `1+1s` for sensible single images, and `1+1o` for an
/// object's mesh that is left open where no image shows it. Of
/// what has no images, as in `24+0`, the exact shape is given, which shows whose scan a failure comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spec {
    /// Number of images of the object.
    pub object: usize,
    /// Number of images of the supporter.
    pub supporter: usize,
    /// Whether a single image is taken from where somebody would take it: through an opening of the object, in front of
    /// the supporter. Otherwise its direction is random.
    pub is_sensible: bool,
    /// Whether the object's mesh is left open where no image shows it. Otherwise it is completed.
    pub is_open: bool,
}

impl fmt::Display for Spec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [sensible, open] =
            [(self.is_sensible, "s"), (self.is_open, "o")].map(|(is, text)| if is { text } else { "" });
        write!(f, "{}+{}{sensible}{open}", self.object, self.supporter)
    }
}

impl FromStr for Spec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let shut = text.strip_suffix('o').unwrap_or(text);
        let plain = shut.strip_suffix('s').unwrap_or(shut);
        let counts = plain.split_once('+').map(|(object, supporter)| [object.parse(), supporter.parse()]);
        match counts {
            Some([Ok(object), Ok(supporter)]) => {
                Ok(Self { object, supporter, is_sensible: plain != shut, is_open: shut != text })
            }
            _ => {
                Err("give the numbers of images of the object and of the supporter, such as 24+3 or 1+1s"
                    .into())
            }
        }
    }
}

impl Spec {
    /// Takes the images of an object with these openings. Images without the object are left out.
    pub fn shoot_object(&self, object: &Solid, openings: &[Opening], random: &mut Random) -> Vec<Shot> {
        let directions = match self.object {
            1 if self.is_sensible => vec![views::through(openings, random)],
            count => views::sphere(count, random),
        };
        shoot(object, &whole(object), &directions, random)
    }

    /// Takes the images of a supporter, aimed at its bars. Images without the supporter are left out.
    pub fn shoot_supporter(&self, supporter: &Solid, bars: &[Bar], random: &mut Random) -> Vec<Shot> {
        let directions = match self.supporter {
            1 if self.is_sensible => vec![views::off_front(random)],
            count => views::front(count, random),
        };
        let ends = bars.iter().flat_map(|bar| {
            let start = Point::from(bar.position);
            [start, start + Vector::from(bar.direction) * bar.length]
        });
        let target = if bars.is_empty() { whole(supporter) } else { Target::around(ends, AROUND_BARS) };
        shoot(supporter, &target, &directions, random)
    }
}

fn whole(solid: &Solid) -> Target {
    Target::around(solid.vertices.iter().map(|&vertex| vertex.into()), 0.0)
}

fn shoot(solid: &Solid, target: &Target, directions: &[Vector], random: &mut Random) -> Vec<Shot> {
    let vertices = solid.vertices.iter().map(|&vertex| vertex.into()).collect();
    let mesh = TriMesh::new(vertices, solid.triangles.clone()).expect("a shape has triangles");
    let shot = |direction| Sensor::default().take(&mesh, &views::looking(target, direction), random);
    directions.iter().map(shot).filter(|shot| shot.image().is_some()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn specs_have_one_text_each() {
        for text in ["24+3", "1+1s", "24+0", "1+0o", "3+1so"] {
            assert_eq!(text.parse::<Spec>().unwrap().to_string(), text);
        }
        for text in ["", "24", "-1+1", "1+x", "1+1ss", "1+1os", "s"] {
            assert!(text.parse::<Spec>().is_err(), "{text}");
        }
    }
}
