//! The option that names what stands around the supporter.

use super::FileArguments;
use super::input::{self, Placement};
use anyhow::Result;
use clap::Args;
use hangpose::files::{self, CloudFile, SupporterFile};
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

    /// The points, in the coordinates of the supporter's cloud.
    pub(super) fn read(&self, files: &FileArguments, supporter: &CloudFile) -> Result<Vec<[f32; 3]>> {
        let Some(path) = &self.scene else { return Ok(Vec::new()) };
        let placement =
            Placement { scale: files.supporter_scale, up: files.supporter_up, scale_option: None };
        let scene = match files::read_supporter(path)? {
            SupporterFile::Mesh(mesh) => input::scene_mesh(path, mesh, &placement)?,
            SupporterFile::Cloud(cloud) => input::placed_cloud(path, cloud, &placement)?,
        };
        let shift = [0, 1, 2].map(|i| (scene.origin[i] - supporter.origin[i]) as f32);
        Ok(scene.points.iter().map(|point| [0, 1, 2].map(|i| point[i] + shift[i])).collect())
    }
}
