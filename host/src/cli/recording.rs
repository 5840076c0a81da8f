//! Depth images as input: their options, reading them, and what the user is told of them.

use super::terminal::say;
use super::{parse_box, parse_scale, progress};
use anyhow::{Context, Result, anyhow, bail};
use clap::error::ErrorKind;
use clap::{ArgGroup, Args};
use hangpose::files::depth::{ScanError, ScanFiles, ScanFrame, ScanSources, read_scan};
use hangpose::files::{CloudFile, MeshFile};
use hangpose::geometry::Aabb;
use hangpose::perception::completion::CompletionSettings;
use hangpose::perception::depth_points::DepthPointsSettings;
use hangpose::perception::volume::VolumeSettings;
use hangpose::{
    CLOUD_VOXEL, FAIR_AGREEMENT, FuseError, Monitor, ScannedMesh, TooLarge, complete_scan, scan_cloud,
    suggested_voxel,
};
use std::path::{Path, PathBuf};

/// Options for all depth images of a call.
#[derive(Args)]
pub(super) struct DepthArguments {
    /// Poses map world to camera coordinates, not camera to world.
    #[arg(long)]
    pub(super) world_to_camera: bool,
    /// Metres per unit of depth [default: 0.001, or what the BOP file says].
    #[arg(long, value_name = "METRES", value_parser = parse_scale)]
    pub(super) depth_scale: Option<f32>,
    /// Depth beyond which surfaces are ignored, metres.
    #[arg(long, value_name = "METRES", default_value_t = 5.0, value_parser = parse_scale)]
    pub(super) max_depth: f32,
    /// Size of a voxel, metres [default: 0.002 for points; for a mesh a hundredth of what the images show, 0.0015 to
    /// 0.003].
    #[arg(long, value_name = "METRES", value_parser = parse_scale)]
    pub(super) voxel: Option<f32>,
}

/// Depth images in place of the files of `predict`.
#[derive(Args)]
#[command(
    group = ArgGroup::new("images").args(["object_depth", "supporter_depth", "depth"]).multiple(true),
    group = ArgGroup::new("object_images").args(["object_depth", "depth"]),
    group = ArgGroup::new("supporter_images").args(["supporter_depth", "depth"]),
    group = ArgGroup::new("object_masks").args(["object_mask", "mask"]),
    group = ArgGroup::new("supporter_masks").args(["supporter_mask", "mask"]),
)]
pub(super) struct RecordingArguments {
    /// Depth images of the object, held alone: a mesh is fused from them, and what they do not show is guessed. 16-bit PNG:
    /// a path, a pattern in quotes such as 'mug/*.png', or TUM's depth.txt.
    #[arg(long, value_name = "PATTERN", conflicts_with_all = ["object", "object_scale"])]
    object_depth: Option<String>,
    /// Depth images of the supporter, which become a point cloud. Each camera is a viewpoint.
    #[arg(long, value_name = "PATTERN", conflicts_with_all = ["supporter", "supporter_scale"])]
    supporter_depth: Option<String>,
    /// Depth images that show both; masks or boxes tell the two apart.
    #[arg(long, value_name = "PATTERN", conflicts_with_all = ["object", "supporter", "object_scale", "supporter_scale", "object_depth", "supporter_depth"])]
    depth: Option<String>,
    /// Intrinsics: a 3 x 3 matrix as text, or JSON of Open3D or BOP.
    #[arg(long, value_name = "FILE", requires = "images")]
    camera: Option<PathBuf>,
    /// Intrinsics of the object's images, if those of the supporter's differ.
    #[arg(long, value_name = "FILE", requires = "object_images")]
    object_camera: Option<PathBuf>,
    /// Intrinsics of the supporter's images, if those of the object's differ.
    #[arg(long, value_name = "FILE", requires = "supporter_images")]
    supporter_camera: Option<PathBuf>,
    /// Poses of the cameras, for --depth: 4 x 4 matrices, Open3D, TUM or BOP. Not needed for a single image.
    #[arg(long, value_name = "PATTERN", requires = "images")]
    poses: Option<String>,
    /// Poses of the cameras for the object's images. Their world is the object frame of the result.
    #[arg(long, value_name = "PATTERN", requires = "object_images")]
    object_poses: Option<String>,
    /// Poses of the cameras for the supporter's images. Their world is the supporter frame of the result.
    #[arg(long, value_name = "PATTERN", requires = "supporter_images")]
    supporter_poses: Option<String>,
    /// Masks for --depth: PNG with one label a pixel, one mask for each image.
    #[arg(long, value_name = "PATTERN", requires_all = ["images", "object_label", "supporter_label"])]
    mask: Option<String>,
    /// Masks for the object's images.
    #[arg(long, value_name = "PATTERN", requires_all = ["object_images", "object_label"])]
    object_mask: Option<String>,
    /// Masks for the supporter's images.
    #[arg(long, value_name = "PATTERN", requires_all = ["supporter_images", "supporter_label"])]
    supporter_mask: Option<String>,
    /// Label of the object in its masks.
    #[arg(long, value_name = "N", requires = "object_masks")]
    object_label: Option<u8>,
    /// Label of the supporter in its masks.
    #[arg(long, value_name = "N", requires = "supporter_masks")]
    supporter_label: Option<u8>,
    /// Box in the world of the object's images, metres, outside of which everything is ignored: least x, y, z and greatest
    /// x, y, z.
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = parse_box, allow_hyphen_values = true, requires = "object_images")]
    object_crop: Option<Aabb>,
    /// Box in the world of the supporter's images, metres, outside of which everything is ignored.
    #[arg(long, value_name = "X,Y,Z,X,Y,Z", value_parser = parse_box, allow_hyphen_values = true, requires = "supporter_images")]
    supporter_crop: Option<Aabb>,
    #[command(flatten)]
    all: DepthArguments,
}

/// Depth images and the options that gave them.
pub(super) struct Recording<'a> {
    pub(super) sources: ScanSources,
    pub(super) crop: Option<Aabb>,
    pub(super) all: &'a DepthArguments,
    /// Name for messages: the option that gave the images.
    pub(super) name: &'static str,
    /// What the names of the options for the crop box, poses and mask begin with.
    pub(super) prefix: &'static str,
}

impl RecordingArguments {
    /// The images of the object, if it is given by images.
    pub(super) fn object(&self) -> Result<Option<Recording<'_>>> {
        let own = [&self.object_depth, &self.object_poses, &self.object_mask];
        let names = ["--object-depth", "--depth, object", "object-", "--object-camera"];
        self.recording(own, &self.object_camera, self.object_label, self.object_crop, names)
    }

    /// The images of the supporter, if it is given by images.
    pub(super) fn supporter(&self) -> Result<Option<Recording<'_>>> {
        let own = [&self.supporter_depth, &self.supporter_poses, &self.supporter_mask];
        let names = ["--supporter-depth", "--depth, supporter", "supporter-", "--supporter-camera"];
        self.recording(own, &self.supporter_camera, self.supporter_label, self.supporter_crop, names)
    }

    /// The images of one side. `own` are its patterns of images, poses and masks; `names` are that of its images alone, that
    /// of images which show both, the beginning of its options, and the option for its camera.
    fn recording(
        &self,
        own: [&Option<String>; 3],
        camera: &Option<PathBuf>,
        label: Option<u8>,
        crop: Option<Aabb>,
        [own_name, common_name, prefix, camera_option]: [&'static str; 4],
    ) -> Result<Option<Recording<'_>>> {
        // The patterns of images, poses and masks go together.
        let common = [&self.depth, &self.poses, &self.mask];
        let (name, given, [poses, mask], others, begin) = match (own[0], &self.depth) {
            (Some(depth), _) => (own_name, depth, [own[1], own[2]], common, prefix),
            (None, Some(depth)) => (common_name, depth, [common[1], common[2]], own, ""),
            (None, None) => return Ok(None),
        };
        if others.iter().any(|pattern| pattern.is_some()) {
            return Err(usage(format!(
                "{name}: give its poses and masks by --{begin}poses and --{begin}mask"
            )));
        }
        let Some(camera) = camera.as_ref().or(self.camera.as_ref()) else {
            return Err(usage(format!("{name}: pass --camera or {camera_option}")));
        };
        if self.depth.is_some() && mask.is_none() && crop.is_none() {
            return Err(usage(format!(
                "{name}: pass --mask, --object-label and --supporter-label, or --object-crop and --supporter-crop, to tell object and supporter apart"
            )));
        }
        let sources = ScanSources {
            depth: given.clone(),
            camera: camera.clone(),
            poses: poses.clone(),
            masks: mask.clone().zip(label),
            depth_scale: self.all.depth_scale,
            world_to_camera: self.all.world_to_camera,
        };
        Ok(Some(Recording { sources, crop, all: &self.all, name, prefix }))
    }
}

fn usage(message: String) -> anyhow::Error {
    clap::Error::raw(ErrorKind::MissingRequiredArgument, message + "\n").into()
}

impl Recording<'_> {
    /// Reads the images and prints what was left out.
    pub(super) fn read(&self) -> Result<ScanFiles> {
        let files = read_scan(&self.sources).map_err(|error| match error {
            ScanError::DepthScale { suggested, .. } => anyhow!("{error} (--depth-scale {suggested})"),
            ScanError::NoPoses { .. } => anyhow!("{error} (--{}poses)", self.prefix),
            error => error.into(),
        })?;
        files.notes.iter().for_each(|note| say("note", note));
        Ok(files)
    }

    /// Size of a voxel of the mesh of these images, metres.
    pub(super) fn voxel_of_mesh(&self, frames: &[ScanFrame]) -> f32 {
        let DepthArguments { voxel, max_depth, .. } = *self.all;
        voxel.unwrap_or_else(|| suggested_voxel(frames, max_depth, self.crop))
    }

    /// Size of a voxel of the cloud, metres.
    pub(super) fn voxel_of_cloud(&self) -> f32 {
        self.all.voxel.unwrap_or(CLOUD_VOXEL)
    }

    /// The volume for voxels of this size, metres.
    pub(super) fn volume(&self, voxel: f32) -> VolumeSettings {
        VolumeSettings { crop: self.crop, max_depth: self.all.max_depth, ..VolumeSettings::new(voxel) }
    }

    /// Which pixels become points.
    pub(super) fn points(&self) -> DepthPointsSettings {
        DepthPointsSettings { crop: self.crop, max_depth: self.all.max_depth, ..Default::default() }
    }

    /// An error with the options that mend it.
    pub(super) fn explain(&self, error: FuseError) -> anyhow::Error {
        let prefix = self.prefix;
        match &error {
            FuseError::Convention { .. } if self.all.world_to_camera => {
                anyhow!("{error}: leave out --world-to-camera")
            }
            FuseError::Convention { .. } => anyhow!("{error}: pass --world-to-camera"),
            FuseError::Outside { .. } => {
                anyhow!(
                    "{error} (--{prefix}crop, --max-depth, --depth-scale, --{prefix}poses, --{prefix}mask)"
                )
            }
            FuseError::Settings(_) | FuseError::Volume { .. } => anyhow!("{error} (--{prefix}crop, --voxel)"),
            _ => error.into(),
        }
    }

    /// Warns of images that hardly agree.
    pub(super) fn warn_of(&self, agreement: Option<f32>) {
        if let Some(agreement) = agreement.filter(|agreement| *agreement < FAIR_AGREEMENT) {
            say(
                "warning",
                format_args!(
                    "{}: only {:.0} % of the points of an image reappear in the next: check that poses and images are in the same order, or that the images overlap",
                    self.name,
                    100.0 * agreement
                ),
            );
        }
    }

    /// The closed mesh of an object that is held alone.
    pub(super) fn object(&self) -> Result<MeshFile> {
        let named = || self.name;
        let files = self.read().with_context(named)?;
        let (voxel, monitor) = (self.voxel_of_mesh(&files.frames), Monitor::new());
        let (settings, guess) = (self.volume(voxel), CompletionSettings::default());
        let mesh =
            progress::show_while(&[&monitor], || complete_scan(&files.frames, &settings, &guess, &monitor));
        let mesh = mesh.map_err(|error| self.explain(error)).with_context(named)?;
        if mesh.triangles.is_empty() {
            bail!("{}: the images show no surface in voxels of {voxel} m: pass a smaller --voxel", self.name);
        }
        self.warn_of(mesh.agreement);
        let shown = mesh.seen.iter().filter(|seen| **seen == 1).count() as f32 / mesh.seen.len() as f32;
        let note = format!(
            "the images show {:.0} % of the object's surface; the rest is a guess",
            (100.0 * shown).floor()
        );
        let notes = if shown < 1.0 { vec![note] } else { Vec::new() };
        let ScannedMesh { vertices, triangles, viewpoints, .. } = mesh;
        let file = MeshFile { vertices, triangles, viewpoints, notes };
        let remedy = "pass a larger --voxel or a crop box";
        TooLarge::check_mesh(&file).map_err(|error| TooLarge { remedy, ..error }).with_context(named)?;
        Ok(file)
    }

    /// The point cloud of a supporter.
    pub(super) fn supporter(&self) -> Result<CloudFile> {
        let named = || self.name;
        let files = self.read().with_context(named)?;
        let found = scan_cloud(&files.frames, self.voxel_of_cloud(), &self.points());
        let found = found.map_err(|error| self.explain(error)).with_context(named)?;
        self.warn_of(found.agreement);
        let remedy = "pass a larger --voxel or a crop box";
        let checked = TooLarge::check_cloud(&found.cloud);
        checked.map_err(|error| TooLarge { remedy, ..error }).with_context(named)?;
        Ok(found.cloud)
    }

    /// The files that are read, as far as the options name them.
    pub(super) fn files(&self) -> [&Path; 2] {
        [Path::new(&self.sources.depth), &self.sources.camera]
    }
}
