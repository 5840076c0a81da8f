//! The option that names what stands around the supporter.

use super::FrameArguments;
use super::input::{self, Placement};
use anyhow::Result;
use clap::Args;
use hangpose::files::{self, SupporterFile};
use std::path::{Path, PathBuf};

#[derive(Args)]
pub(super) struct SceneArguments {
    /// Things near the supporter, which the object does not touch and never hangs on: a point cloud or a mesh in the units
    /// and axes of the supporter's file.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
}

impl SceneArguments {
    /// The file that is read, if any.
    pub(super) fn file(&self) -> Option<&Path> {
        self.scene.as_deref()
    }

    /// The points, in the coordinates of the supporter's cloud, which begin at `origin` in its file.
    pub(super) fn read(&self, frames: &FrameArguments, origin: [f64; 3]) -> Result<Vec<[f32; 3]>> {
        let Some(path) = &self.scene else { return Ok(Vec::new()) };
        let placement =
            Placement { scale: frames.supporter_scale, up: frames.supporter_up, scale_option: None };
        let scene = match files::read_supporter(path)? {
            SupporterFile::Mesh(mesh) => input::scene_mesh(path, mesh, &placement)?,
            SupporterFile::Cloud(cloud) => input::placed_cloud(path, cloud, &placement)?,
        };
        let shift = [0, 1, 2].map(|i| (scene.origin[i] - origin[i]) as f32);
        Ok(scene.points.iter().map(|point| [0, 1, 2].map(|i| point[i] + shift[i])).collect())
    }
}
