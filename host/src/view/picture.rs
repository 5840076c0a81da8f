//! Pictures of meshes and clouds, seen from far away: what is hit by a ray of parry3d for each pixel.

use crate::geometry::{Point, Pose, Vector};
use crate::parry::pose_to_parry;
use parry3d::bounding_volume::Aabb;
use parry3d::math;
use parry3d::partitioning::{Bvh, BvhBuildStrategy};
use parry3d::query::{Ray, RayCast};
use parry3d::shape::TriMesh;
use png::{BitDepth, ColorType, Encoder};

/// A colour: red, green and blue, 0 to 1.
pub type Colour = [f32; 3];

/// Colour of an object.
pub const OBJECT: Colour = [0.85, 0.45, 0.20];
/// Colour of a supporter.
pub const SUPPORTER: Colour = [0.45, 0.50, 0.60];
/// Colour of points that were guessed, and of obstacles.
pub const GUESSED: Colour = [0.72, 0.66, 0.82];
/// Colour of the way of the centre of mass.
pub const WAY: Colour = [0.15, 0.25, 0.45];
/// Colour of contact forces.
pub const FORCE: Colour = [0.80, 0.10, 0.15];
const BACKGROUND: Colour = [1.0; 3];

/// Margin around what is seen, as a share of its larger side.
const MARGIN: f32 = 0.04;
/// Least margin, metres: what is seen may be a single point.
const LEAST_MARGIN: f32 = 0.001;
/// Rays for each pixel along each of its sides.
const FINE: u32 = 2;
/// Share of its opacity by which a translucent body hides an opaque one, so that this keeps its colour.
const OVER_OPAQUE: f32 = 0.3;
/// Half the width of a line, pixels.
const LINE: f32 = 1.2;
/// Radius of a dot, pixels.
const DOT: f32 = 4.0;
/// Distance of the camera, metres; larger than any scene.
const FAR: f32 = 100.0;
/// Radius of the disc that stands for a point of a cloud, as a multiple of the distance to the nearest other point.
const DISC: f32 = 1.5;
/// Points of a cloud whose distance to the nearest other point is measured.
const PROBES: usize = 100;
/// Number of poses on a way that are drawn, the start among them and the end not.
const ON_THE_WAY: usize = 6;
/// How much the first and the last of them hide of what is behind them.
const OPACITY: [f32; 2] = [0.30, 0.40];
/// Largest height of a picture, as a multiple of its width.
const MAX_HEIGHT: f32 = 2.0;

/// A picture of bodies, lines and dots, in supporter coordinates.
pub struct Picture<'a> {
    camera: Camera,
    bodies: Vec<Body<'a>>,
    lines: Vec<(Vec<Point>, Colour)>,
    dots: Vec<(Point, Colour)>,
    kept_in_view: Vec<Point>,
}

/// The pixels of a picture, row by row from the top.
pub struct Pixels {
    /// Pixels in a row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Red, green and blue of each pixel.
    pub rgb: Vec<u8>,
}

/// A shape with a colour.
struct Body<'a> {
    shape: Shape<'a>,
    colour: Colour,
    /// How much it hides of what is behind it.
    opacity: f32,
}

enum Shape<'a> {
    Mesh { mesh: &'a TriMesh, pose: math::Pose },
    Cloud { tree: Bvh, points: Vec<math::Vector>, normals: Vec<math::Vector>, radius: f32 },
}

/// An orthographic view.
struct Camera {
    right: math::Vector,
    up: math::Vector,
    back: math::Vector,
}

/// What is seen: its least and greatest coordinates to the right and up, metres.
struct Frame {
    low: [f32; 2],
    high: [f32; 2],
}

impl<'a> Picture<'a> {
    /// An empty picture, seen from the direction `eye` for a supporter whose z axis is up, turned as `up` is.
    pub fn new(eye: [f32; 3], up: &Vector) -> Self {
        let turn = nalgebra::UnitQuaternion::rotation_between(&Vector::z(), up).unwrap_or_else(|| {
            nalgebra::UnitQuaternion::from_axis_angle(&Vector::x_axis(), core::f32::consts::PI)
        });
        let turned = |vector: Vector| math::Vector::from_array((turn * vector).into());
        let back = turned(Vector::from(eye).normalize());
        let right = turned(Vector::z()).cross(back).normalize();
        let camera = Camera { right, up: back.cross(right), back };
        Self { camera, bodies: vec![], lines: vec![], dots: vec![], kept_in_view: vec![] }
    }

    /// Adds a mesh at a pose. `opacity` is how much it hides of what is behind it, 0 to 1.
    pub fn add_mesh(&mut self, mesh: &'a TriMesh, pose: &Pose, colour: Colour, opacity: f32) {
        let shape = Shape::Mesh { mesh, pose: pose_to_parry(pose) };
        self.bodies.push(Body { shape, colour, opacity });
    }

    /// Adds a mesh at the last of `way`, paler at poses that are evenly spread on the way, and the line of its centre of mass,
    /// which is in its own coordinates.
    pub fn add_way(&mut self, mesh: &'a TriMesh, way: &[Pose], centre: &Point, colour: Colour) {
        let Some(end) = way.last() else { return };
        self.add_mesh(mesh, end, colour, 1.0);
        let drawn = if way.len() > 1 { spread(way, mesh, centre) } else { vec![] };
        let [first, last] = OPACITY;
        for (index, pose) in drawn.iter().enumerate() {
            self.add_mesh(
                mesh,
                pose,
                colour,
                first + (last - first) * index as f32 / (ON_THE_WAY - 1) as f32,
            );
        }
        self.add_line(way.iter().map(|pose| pose * centre).collect(), WAY);
        drawn.iter().chain([end]).for_each(|pose| self.add_dot(pose * centre, WAY));
    }

    /// Adds points, as discs that face as their normals, or as balls without normals.
    pub fn add_cloud(&mut self, points: &[[f32; 3]], normals: &[[f32; 3]], colour: Colour) {
        let [points, normals] = [points, normals]
            .map(|list| list.iter().map(|&v| math::Vector::from_array(v)).collect::<Vec<_>>());
        let radius = DISC * spacing(&points);
        let boxes: Vec<Aabb> =
            points.iter().map(|&point| Aabb::from_half_extents(point, math::Vector::splat(radius))).collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        self.bodies.push(Body {
            shape: Shape::Cloud { tree, points, normals, radius },
            colour,
            opacity: 1.0,
        });
    }

    /// Adds a line through points, drawn over everything.
    pub fn add_line(&mut self, points: Vec<Point>, colour: Colour) {
        self.lines.push((points, colour));
    }

    /// Adds a dot, drawn over everything.
    pub fn add_dot(&mut self, point: Point, colour: Colour) {
        self.dots.push((point, colour));
    }

    /// Shows at least these points, of which nothing is drawn: for pictures that follow one another.
    pub fn keep_in_view(&mut self, points: impl IntoIterator<Item = Point>) {
        self.kept_in_view.extend(points);
    }

    /// The picture as PNG, so many pixels wide.
    pub fn png(&self, width: u32) -> Vec<u8> {
        self.pixels(width).png()
    }

    /// The picture, so many pixels wide.
    pub fn pixels(&self, width: u32) -> Pixels {
        let frame = self.frame();
        let [wide, high] = [0, 1].map(|i| frame.high[i] - frame.low[i]);
        let pixel = (wide / width as f32).max(high / (MAX_HEIGHT * width as f32));
        let height = ((high / pixel).ceil() as u32).max(1);
        let left = frame.low[0] - 0.5 * (pixel * width as f32 - wide);
        let on_picture = |point: &Point| {
            let [u, v] = self.camera.seen_at(math::Vector::from_array((*point).into()));
            [(u - left) / pixel, (frame.high[1] - v) / pixel]
        };
        let lines: Vec<(Vec<[f32; 2]>, Colour)> = self
            .lines
            .iter()
            .map(|(line, colour)| (line.iter().map(on_picture).collect(), *colour))
            .collect();
        let dots: Vec<([f32; 2], Colour)> =
            self.dots.iter().map(|(dot, colour)| (on_picture(dot), *colour)).collect();
        let drawn_at = |at: [f32; 2]| {
            let dot = dots.iter().rev().find(|(dot, _)| distance(at, [*dot, *dot]) <= DOT);
            let is_on =
                |line: &[[f32; 2]]| line.windows(2).any(|pair| distance(at, [pair[0], pair[1]]) <= LINE);
            dot.map(|(_, colour)| *colour)
                .or_else(|| lines.iter().find(|(line, _)| is_on(line)).map(|(_, colour)| *colour))
        };
        let mut rgb = Vec::with_capacity(3 * (width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                let mut sum = [0.0; 3];
                for k in 0..FINE * FINE {
                    let at = [(x, k % FINE), (y, k / FINE)]
                        .map(|(whole, part)| whole as f32 + (part as f32 + 0.5) / FINE as f32);
                    let seen = drawn_at(at)
                        .unwrap_or_else(|| self.colour(left + at[0] * pixel, frame.high[1] - at[1] * pixel));
                    sum = [0, 1, 2].map(|i| sum[i] + seen[i]);
                }
                rgb.extend(sum.map(|c| (255.0 * c / (FINE * FINE) as f32) as u8));
            }
        }
        Pixels { width, height, rgb }
    }

    /// All that the picture shows, with a margin.
    fn frame(&self) -> Frame {
        let mut frame = Frame { low: [f32::INFINITY; 2], high: [f32::NEG_INFINITY; 2] };
        let mut include = |point: math::Vector| {
            let at = self.camera.seen_at(point);
            frame.low = [0, 1].map(|i| frame.low[i].min(at[i]));
            frame.high = [0, 1].map(|i| frame.high[i].max(at[i]));
        };
        for body in &self.bodies {
            match &body.shape {
                Shape::Mesh { mesh, pose } => {
                    mesh.vertices().iter().for_each(|&vertex| include(pose.transform_point(vertex)));
                }
                Shape::Cloud { points, .. } => points.iter().for_each(|&point| include(point)),
            }
        }
        let marks = self.lines.iter().flat_map(|(line, _)| line).chain(self.dots.iter().map(|(dot, _)| dot));
        for &point in marks.chain(&self.kept_in_view) {
            include(math::Vector::from_array(point.into()));
        }
        let Frame { low, high } = frame;
        let margin = (MARGIN * (high[0] - low[0]).max(high[1] - low[1])).max(LEAST_MARGIN);
        Frame { low: low.map(|x| x - margin), high: high.map(|x| x + margin) }
    }

    /// The colour at a place in the view.
    fn colour(&self, u: f32, v: f32) -> Colour {
        let Camera { right, up, back } = self.camera;
        let ray = Ray::new(right * u + up * v + back * FAR, -back);
        let mut hits: Vec<(f32, Colour, f32)> = self
            .bodies
            .iter()
            .filter_map(|body| {
                let (distance, normal) = body.shape.hit(&ray)?;
                let shade = 0.35 + 0.65 * normal.dot(back).abs();
                Some((distance, body.colour.map(|c| c * shade), body.opacity))
            })
            .collect();
        hits.sort_by(|a, b| b.0.total_cmp(&a.0));
        let nothing = (BACKGROUND, 1.0);
        let (colour, _) = hits.into_iter().fold(nothing, |(behind, share), (_, colour, opacity)| {
            if opacity == 1.0 {
                return (colour, OVER_OPAQUE);
            }
            ([0, 1, 2].map(|i| behind[i] + (colour[i] - behind[i]) * opacity * share), share)
        });
        colour
    }
}

impl Shape<'_> {
    /// Distance along a ray and normal where it hits.
    fn hit(&self, ray: &Ray) -> Option<(f32, math::Vector)> {
        match self {
            Self::Mesh { mesh, pose } => {
                let hit = mesh.cast_ray_and_get_normal(pose, ray, 2.0 * FAR, false)?;
                Some((hit.time_of_impact, hit.normal))
            }
            Self::Cloud { tree, points, normals, radius } => {
                let normal = |index: usize| normals.get(index).copied().unwrap_or(-ray.dir);
                let hit = |index: u32, _: f32| {
                    let (point, normal) = (points[index as usize], normal(index as usize));
                    let slope = normal.dot(ray.dir);
                    let distance = (slope.abs() > EDGE_ON).then(|| normal.dot(point - ray.origin) / slope)?;
                    ((ray.origin + ray.dir * distance - point).length() <= *radius).then_some(distance)
                };
                let (index, distance) = tree.cast_ray(ray, 2.0 * FAR, hit)?;
                Some((distance, normal(index as usize)))
            }
        }
    }
}

/// Cosine between a ray and the normal of a disc below which the disc is seen from its edge.
const EDGE_ON: f32 = 0.05;

impl Camera {
    /// Where a point is in the view, right and up, metres.
    fn seen_at(&self, point: math::Vector) -> [f32; 2] {
        [self.right, self.up].map(|axis| axis.dot(point))
    }
}

/// Poses at even distances on a way. The distance of two poses is the most that a point of the mesh can move.
fn spread(way: &[Pose], mesh: &TriMesh, centre: &Point) -> Vec<Pose> {
    let reach = mesh.vertices().iter().map(|vertex| (Point::from(vertex.to_array()) - centre).norm());
    let reach = reach.fold(0.0, f32::max);
    let moved = |from: &Pose, to: &Pose| {
        (to * centre - from * centre).norm() + reach * from.rotation.angle_to(&to.rotation)
    };
    let moves: Vec<f32> = way.windows(2).map(|pair| moved(&pair[0], &pair[1])).collect();
    let all: f32 = moves.iter().sum();
    let at = |index: usize| {
        let mut left = all * index as f32 / ON_THE_WAY as f32;
        for (pair, &moves) in way.windows(2).zip(&moves) {
            if left < moves {
                return between(&pair[0], &pair[1], centre, left / moves);
            }
            left -= moves;
        }
        way[way.len() - 1]
    };
    (0..ON_THE_WAY).map(at).collect()
}

/// The pose at a share of the way between two poses: the centre moves straight, and the body turns about a fixed axis.
pub fn between(from: &Pose, to: &Pose, centre: &Point, share: f32) -> Pose {
    let turn = (to.rotation * from.rotation.inverse()).scaled_axis();
    let rotation = nalgebra::UnitQuaternion::new(turn * share) * from.rotation;
    let at = from * centre + (to * centre - from * centre) * share;
    Pose::from_parts((at - rotation * centre).into(), rotation)
}

/// Median distance of a point to the nearest other one, metres.
fn spacing(points: &[math::Vector]) -> f32 {
    let nearest = |index: usize| {
        let distances = points.iter().enumerate().filter(|(other, _)| *other != index);
        distances.map(|(_, other)| (points[index] - *other).length()).fold(f32::INFINITY, f32::min)
    };
    let probes = points.len().min(PROBES);
    let mut distances: Vec<f32> = (0..probes).map(|k| nearest(k * points.len() / probes)).collect();
    distances.sort_by(f32::total_cmp);
    distances.get(distances.len() / 2).copied().filter(|distance| distance.is_finite()).unwrap_or(0.001)
}

/// Distance of a point from a segment in the plane.
fn distance(point: [f32; 2], [from, to]: [[f32; 2]; 2]) -> f32 {
    let [point, from, to] = [point, from, to].map(nalgebra::Vector2::from);
    let (along, away) = (to - from, point - from);
    let share = (away.dot(&along) / along.norm_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    (away - along * share).norm()
}

impl Pixels {
    fn png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        let mut writer =
            encoder.write_header().expect("memory takes any header of a picture that has pixels");
        writer.write_image_data(&self.rgb).expect("there are as many bytes as the size says");
        drop(writer);
        bytes
    }
}
