//! How far a completion may go.

use super::CompletionError;

/// How far a guess may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompletionSettings {
    /// Greatest thickness behind a surface that was seen from one side only and does not curve around what is behind it,
    /// metres. A plate seen face on gets this thickness, unless it is narrower. Round bars up to this thickness are
    /// completed to within 1.5 voxels, thicker ones to within 3.
    pub thickness: f32,
    /// Greatest radius of a ball that surfaces hold from two sides, metres. A bar of a greater radius stays open.
    pub radius: f32,
}

impl CompletionSettings {
    /// Checks all values.
    pub fn validate(&self) -> Result<(), CompletionError> {
        let Self { thickness, radius } = *self;
        if thickness >= 0.0 && radius >= 0.0 {
            Ok(())
        } else {
            Err(CompletionError::Settings { thickness, radius })
        }
    }
}

impl Default for CompletionSettings {
    /// Thickness 10 mm, radius 60 mm.
    fn default() -> Self {
        Self { thickness: 0.01, radius: 0.06 }
    }
}
