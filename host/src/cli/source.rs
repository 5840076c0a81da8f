//! Where an object or a supporter comes from: a file or depth images.

use super::input::{self, Placed, Placement};
use super::recording::{Recording, RecordingArguments};
use super::{CloudArguments, FileArguments, FrameArguments};
use anyhow::{Context, Result};
use hangpose::files::{self, CloudFile, MeshFile, SupporterFile};
use std::path::Path;

/// What an object or a supporter is read from.
pub(super) enum Source<'a> {
    File(&'a Path),
    Images(Recording<'a>),
}

impl<'a> Source<'a> {
    /// The object that the options name.
    pub(super) fn of_object(files: &'a FileArguments, recording: &'a RecordingArguments) -> Result<Self> {
        Self::new(files.object.as_deref(), recording.object()?)
    }

    /// The supporter that the options name.
    pub(super) fn of_supporter(files: &'a FileArguments, recording: &'a RecordingArguments) -> Result<Self> {
        Self::new(files.supporter.as_deref(), recording.supporter()?)
    }

    fn new(file: Option<&'a Path>, images: Option<Recording<'a>>) -> Result<Self> {
        let images = images.map(Self::Images);
        images.or(file.map(Self::File)).context("pass a file or depth images")
    }

    /// What messages call it.
    pub(super) fn name(&self) -> &Path {
        match self {
            Self::File(path) => path,
            Self::Images(recording) => Path::new(recording.name),
        }
    }

    /// The files that are read, as far as the options name them.
    pub(super) fn files(&self) -> Vec<&Path> {
        match self {
            Self::File(path) => vec![path],
            Self::Images(recording) => recording.files().into(),
        }
    }

    /// The object in metres with z up.
    pub(super) fn object(&self, frames: &FrameArguments) -> Result<Placed<MeshFile>> {
        let (scale, up) = (frames.object_scale, frames.object_up);
        let (file, placement) = match self {
            Self::File(path) => {
                (files::read_mesh(path)?, Placement { scale, up, scale_option: Some("--object-scale") })
            }
            Self::Images(images) => (images.object()?, Placement { scale: 1.0, up, scale_option: None }),
        };
        let mut placed = input::object(self.name(), file, &placement)?;
        if !frames.object_viewpoint.is_empty() {
            let views = frames.object_viewpoint.iter().map(|view| view.map(|x| x as f32));
            placed.shape.viewpoints = views.collect();
            placed.shape.mesh().context("--object-viewpoint")?;
        }
        Ok(placed)
    }

    /// The supporter in metres with z up.
    pub(super) fn supporter(
        &self,
        frames: &FrameArguments,
        points: &CloudArguments,
        seed: u64,
    ) -> Result<Placed<CloudFile>> {
        let (scale, up) = (frames.supporter_scale, frames.supporter_up);
        let (file, placement) = match self {
            Self::File(path) => (
                files::read_supporter(path)?,
                Placement { scale, up, scale_option: Some("--supporter-scale") },
            ),
            Self::Images(images) => {
                (SupporterFile::Cloud(images.supporter()?), Placement { scale: 1.0, up, scale_option: None })
            }
        };
        input::supporter(self.name(), file, &placement, points, seed)
    }
}
