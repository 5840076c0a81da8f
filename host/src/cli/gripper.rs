//! The file of a gripper: capsules in object coordinates, metres.

use super::toml_error;
use anyhow::{Context, Result, anyhow};
use hangpose::motion::{Capsule, Gripper};
use serde::Deserialize;
use std::path::Path;

/// A gripper as its file gives it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct GripperFile {
    #[serde(default)]
    retreat: [f32; 3],
    #[serde(rename = "part", default)]
    parts: Vec<Part>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Part {
    from: [f32; 3],
    to: [f32; 3],
    radius: f32,
    #[serde(default)]
    opening: [f32; 3],
}

/// The memory that a [`Gripper`] borrows.
pub(super) struct Hand {
    parts: Vec<Capsule>,
    retreat: [f32; 3],
}

impl Hand {
    pub(super) fn read(path: &Path) -> Result<Self> {
        let at = || path.display().to_string();
        let text = std::fs::read_to_string(path).with_context(|| {
            format!("{}: cannot be read; give a readable TOML file of the parts of a gripper", at())
        })?;
        let GripperFile { retreat, parts } = toml::from_str(&text).map_err(|error| {
            anyhow!(
                "{}: {}\ngive retreat = [x, y, z] and for each part [[part]] from = [x, y, z], to = [x, y, z], radius and opening = [x, y, z]: object coordinates, metres",
                at(),
                toml_error::text(&error)
            )
        })?;
        let parts =
            parts.into_iter().map(|Part { from, to, radius, opening }| Capsule { from, to, radius, opening });
        Ok(Self { parts: parts.collect(), retreat })
    }

    pub(super) fn gripper(&self) -> Gripper<'_> {
        Gripper { parts: &self.parts, retreat: self.retreat }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Hand> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        Hand::read(file.path())
    }

    #[test]
    fn parts_and_retreat_are_read() {
        let hand = read(
            "retreat = [0, 0, 0.1]\n[[part]]\nfrom = [1, 2, 3]\nto = [4, 5, 6]\nradius = 0.5\n\n[[part]]\nfrom = [0, 0, 0]\nto = [0, 0, 0]\nradius = 1\nopening = [0, 0.02, 0]\n",
        );
        let hand = hand.unwrap();
        let gripper = hand.gripper();
        let first = Capsule { from: [1.0, 2.0, 3.0], to: [4.0, 5.0, 6.0], radius: 0.5, opening: [0.0; 3] };
        let second = Capsule { radius: 1.0, opening: [0.0, 0.02, 0.0], ..Capsule::default() };
        assert_eq!((gripper.parts, gripper.retreat), (&[first, second][..], [0.0, 0.0, 0.1]));
    }

    #[test]
    fn unknown_and_missing_keys_are_named() {
        let message = |text| read(text).err().unwrap().to_string();
        let unknown = message("[[part]]\nfrom = [0, 0, 0]\nto = [0, 0, 0]\nradius = 1\nwidth = 2\n");
        assert!(unknown.contains("unknown field `width`") && unknown.contains("radius"), "{unknown}");
        assert!(message("retreats = [0, 0, 0]").contains("unknown field `retreats`"));
        assert!(message("[[part]]\nfrom = [0, 0, 0]\nto = [0, 0, 0]").contains("missing field `radius`"));
        assert!(message("[[part]]\nfrom = [0, 0]").contains("line 2"));
    }
}
