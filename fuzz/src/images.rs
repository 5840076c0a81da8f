//! Depth images and cameras: their points, and the surface of their fusion.

use crate::draw::Draw;
use crate::memory::Block;
use crate::oracle::within;
use hangpose::Monitor;
use hangpose::geometry::{Aabb, Cloud, Mesh, Point, Pose, Vector};
use hangpose::perception::completion::{Completion, CompletionSettings, room};
use hangpose::perception::depth::{DepthCamera, DepthImage, Mask};
use hangpose::perception::depth_points::{DepthPointsSettings, depth_points};
use hangpose::perception::isosurface::Isosurface;
use hangpose::perception::volume::{Space, Volume, VolumeLimits, VolumeSettings};
use nalgebra::{Quaternion, UnitQuaternion};
use std::fmt::Write;

/// Most blocks of a volume here, 0.4 MB, so that a case takes milliseconds.
const MOST_BLOCKS: usize = 200;

/// An image as a caller gives it.
pub(crate) struct DrawnImage {
    pub(crate) size: [u32; 2],
    pub(crate) focal: [f32; 2],
    pub(crate) centre: [f32; 2],
    pub(crate) distortion: [f32; 5],
    pub(crate) depths: Vec<u16>,
    pub(crate) labels: Option<Vec<u8>>,
    pub(crate) label: u8,
    pub(crate) scale: f32,
    pub(crate) position: [f32; 3],
    pub(crate) quaternion: [f32; 4],
}

impl DrawnImage {
    pub(crate) fn draw(draw: &mut Draw) -> Self {
        let size = [1 + draw.below(32) as u32, 1 + draw.below(24) as u32];
        let [width, height] = size.map(|x| x as f32);
        let focal = draw.pick(&[40.0, 20.0, 1.0, 1000.0]);
        let mut image = Self {
            size,
            focal: [draw.or_number(focal), draw.or_number(focal)],
            centre: [draw.or_number(width / 2.0), draw.or_number(height / 2.0)],
            distortion: [0.0; 5],
            depths: Vec::new(),
            labels: None,
            label: 1,
            scale: 1e-3,
            position: [0.0, 0.0, -0.3],
            quaternion: [0.0, 0.0, 0.0, 1.0],
        };
        if draw.one_in(3) {
            image.distortion = [0; 5].map(|_: u8| 0.5 * draw.share()).map(|x| draw.or_number(x));
        }
        if draw.one_in(6) {
            image.scale = draw.number();
        }
        if draw.one_in(3) {
            image.position = draw.place(1.0);
            image.quaternion = [draw.share(), draw.share(), draw.share(), draw.share()];
        }
        let pixels = (size[0] * size[1]) as usize;
        let (base, slope) = (200 + 4 * u16::from(draw.byte()), draw.pick(&[0_u16, 1, 7, 300]));
        let pattern = draw.below(5);
        image.depths = (0..pixels)
            .map(|i| {
                let (u, v) = (i % size[0] as usize, i / size[0] as usize);
                let (du, dv) = (u as f32 - width / 2.0, v as f32 - height / 2.0);
                match pattern {
                    0 => base.wrapping_add(slope.wrapping_mul(u as u16)),
                    // A ball before nothing.
                    1 if du * du + dv * dv > 0.1 * width * height => 0,
                    1 => base + (du * du + dv * dv) as u16,
                    2 => base + if (u / 3 + v / 3) % 2 == 0 { 0 } else { slope },
                    3 => draw.word() as u16,
                    _ => {
                        if draw.byte() < 128 {
                            base
                        } else {
                            0
                        }
                    }
                }
            })
            .collect();
        for _ in 0..draw.below(6) {
            let at = draw.below(pixels);
            image.depths[at] = draw.pick(&[0, u16::MAX, 1, u16::MAX - 1, base]);
        }
        if draw.one_in(4) {
            let many = if draw.one_in(8) { pixels + 1 } else { pixels };
            image.labels = Some((0..many).map(|_| draw.byte() % 3).collect());
        }
        if draw.one_in(16) {
            image.depths.pop();
        }
        image
    }

    fn image(&self) -> Result<DepthImage<'_>, String> {
        let camera = DepthCamera::new(self.size, self.focal, self.centre, self.distortion)
            .map_err(|error| error.to_string())?;
        let [x, y, z, w] = self.quaternion;
        let rotation = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-6).unwrap_or_default();
        let pose = Pose::from_parts(Vector::from(self.position).into(), rotation);
        DepthImage::new(camera, &self.depths, self.scale, pose).map_err(|error| error.to_string())
    }

    fn mask(&self) -> Option<Mask<'_>> {
        self.labels.as_ref().map(|labels| Mask { labels, label: self.label })
    }
}

fn aabb(draw: &mut Draw) -> Aabb {
    let (a, b) = (draw.shares(), draw.shares());
    Aabb {
        min: Point::from([0, 1, 2].map(|i| draw.or_number(0.4 * a[i].min(b[i])))),
        max: Point::from([0, 1, 2].map(|i| draw.or_number(0.4 * a[i].max(b[i])))),
    }
}

struct Case {
    images: Vec<DrawnImage>,
    points: DepthPointsSettings,
    volume: VolumeSettings,
    /// Whether the crop box is that of an object that is held alone.
    roomy: bool,
    guess: CompletionSettings,
    work: u64,
    offset: usize,
}

/// Takes images to points, and fuses them to a surface, twice: both times the answer is the same to the last bit.
pub fn run(data: &[u8]) {
    let mut draw = Draw::new(data);
    let voxel = draw.pick(&[0.02, 0.01, 0.05, 0.005]);
    let plain = VolumeSettings::new(draw.or_number(voxel));
    let case = Case {
        volume: VolumeSettings {
            truncation: draw.or_number(plain.truncation),
            crop: if draw.one_in(2) { Some(aabb(&mut draw)) } else { None },
            dense: draw.one_in(2),
            max_depth: draw.or_number(plain.max_depth),
            missing_is_free: draw.one_in(2),
            ..plain
        },
        roomy: draw.one_in(2),
        guess: CompletionSettings { thickness: draw.or_number(0.01), radius: draw.or_number(0.06) },
        points: DepthPointsSettings {
            crop: if draw.one_in(4) { Some(aabb(&mut draw)) } else { None },
            max_depth: draw.or_number(5.0),
            noise: draw.or_number(0.0014),
            least_cosine: draw.or_number(0.2),
            stride: if draw.one_in(8) { draw.word() } else { 1 + draw.below(3) as u32 },
        },
        work: draw.pick(&[u64::MAX, 100, 0]),
        offset: draw.below(16),
        images: (0..1 + draw.below(3)).map(|_| DrawnImage::draw(&mut draw)).collect(),
    };
    assert_eq!(
        answer(&case, case.offset),
        answer(&case, 0),
        "the answer is another one when it is asked for again"
    );
}

/// All that the library says to a case.
fn answer(case: &Case, offset: usize) -> String {
    let mut said = String::new();
    let monitor = Monitor::with_work_limit(case.work);
    let mut images = Vec::new();
    for drawn in &case.images {
        match drawn.image() {
            Ok(image) => images.push((image, drawn.mask())),
            Err(error) => said += &error,
        }
    }
    for (image, mask) in &images {
        said += &points_of(image, *mask, &case.points);
    }
    let mut settings = case.volume;
    if case.roomy {
        let fits = |(image, mask): &&(DepthImage, Option<Mask>)| {
            mask.is_none_or(|mask| mask.labels.len() == image.depths().len())
        };
        let held = images.iter().filter(fits).copied();
        settings.crop =
            room(held, &case.guess, settings.max_depth, settings.truncation + 2.0 * settings.voxel);
        write!(said, "{:?}", settings.crop).unwrap();
    }
    let blocks =
        settings.dense_blocks().filter(|_| settings.dense).unwrap_or(MOST_BLOCKS / 2).min(MOST_BLOCKS);
    let limits = VolumeLimits { blocks };
    let mut memory = Block::new(Volume::bytes(&limits), offset);
    let mut volume = match Volume::new(&settings, &limits, memory.memory()) {
        Ok(volume) => volume,
        Err(error) => return said + &error.to_string(),
    };
    for (image, mask) in &images {
        match volume.integrate(image, *mask, &monitor) {
            Ok(done) => {
                assert!(done.pixels <= image.depths().len() && volume.blocks() <= blocks);
                write!(said, "{done:?}").unwrap();
            }
            Err(error) => said += &error.to_string(),
        }
    }
    for (image, _) in &images {
        match volume.space(&image.viewpoint()) {
            Space::Surface(distance) => within("a distance", distance.abs(), 0.0, settings.truncation),
            space => write!(said, "{space:?}").unwrap(),
        }
    }
    said += &surface_of(&volume, offset, true);
    let mut scratch = Block::new(Completion::bytes(volume.blocks()), offset);
    match volume.complete(&case.guess, scratch.memory(), &monitor) {
        Ok(done) => {
            write!(said, "{done:?}").unwrap();
            scratch.check();
            said += &surface_of(&volume, offset, false);
        }
        Err(error) => said += &error.to_string(),
    }
    scratch.check();
    drop(images);
    memory.check();
    said
}

fn points_of(image: &DepthImage, mask: Option<Mask>, settings: &DepthPointsSettings) -> String {
    let pixels = image.depths().len();
    let (mut points, mut normals) = (vec![[0.0; 3]; pixels], vec![[0.0; 3]; pixels]);
    let counts = match depth_points(image, mask, settings, &mut points, &mut normals) {
        Ok(counts) => counts,
        Err(error) => return error.to_string(),
    };
    assert!(counts.points + counts.outside + counts.flying + counts.grazing <= pixels);
    points.truncate(counts.points);
    normals.truncate(counts.points);
    for normal in &normals {
        let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
        assert!((length - 1.0).abs() < 1e-3, "the normal {normal:?} of a pixel is no unit vector");
    }
    assert!(
        points.as_flattened().iter().all(|x| x.is_finite()),
        "a point of a pixel is not finite: {points:?}"
    );
    // Coordinates may be too large for a cloud, never anything else.
    let cloud = if points.is_empty() {
        String::new()
    } else {
        format!("{:?}", Cloud::new(&points, Some(&normals)).err())
    };
    format!("{counts:?} {points:?} {normals:?} {cloud}")
}

/// The surface, which is a mesh that the core takes. `is_measured` says that nothing was guessed.
fn surface_of(volume: &Volume, offset: usize, is_measured: bool) -> String {
    let mut memory = Block::new(Isosurface::bytes(volume.blocks()), offset);
    let monitor = Monitor::new();
    let surface =
        Isosurface::find(volume, memory.memory(), &monitor).expect("a volume of few blocks has a surface");
    let (mut vertices, mut triangles) =
        (vec![[0.0; 3]; surface.vertices()], vec![[0; 3]; surface.triangles()]);
    surface.write(&mut vertices, &mut triangles).expect("the counts are those of the surface");
    let mut seen = vec![7; surface.vertices()];
    surface.write_seen(&mut seen).expect("the count is that of the surface");
    assert!(seen.iter().all(|mark| *mark == 1 || (*mark == 0 && !is_measured)));
    assert!(vertices.as_flattened().iter().all(|x| x.is_finite()));
    let mut is_used = vec![false; vertices.len()];
    triangles.as_flattened().iter().for_each(|index| is_used[*index as usize] = true);
    assert!(is_used.iter().all(|used| *used), "a vertex of a surface belongs to no triangle");
    let mesh = if triangles.is_empty() { None } else { Mesh::new(&vertices, &triangles).err() };
    memory.check();
    format!("{vertices:?} {triangles:?} {seen:?} {mesh:?}")
}
