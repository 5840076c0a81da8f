//! The constants of the method from a profile, a file and the command line.

use super::{FrameArguments, MethodArguments, Profile, toml_error};
use anyhow::{Context, Result, anyhow};
use hangpose::{CentreOfMass, Params};
use std::path::Path;

impl MethodArguments {
    /// The constants of the profile, overridden by the params file and the seed option.
    pub(super) fn params(&self) -> Result<Params> {
        let profile = match self.profile {
            Profile::Paper => Params::paper(),
            Profile::Default => Params::default(),
        };
        let mut params = match &self.params {
            Some(path) => overlay(&profile, path)?,
            None => profile,
        };
        if let Some(gravity) = self.gravity {
            params.gravity = gravity.map(|x| x as f32);
            params.validate().context("--gravity")?;
        }
        if let Some(seed) = self.seed {
            params.seed = seed;
        }
        Ok(params)
    }

    /// The same about the centre of mass that the options give, if they do.
    pub(super) fn params_for(&self, frames: &FrameArguments) -> Result<Params> {
        let mut params = self.params()?;
        if let Some(com) = frames.com {
            params.centre_of_mass = CentreOfMass::Given(com.map(|x| x as f32));
            params.validate().context("--com")?;
        }
        Ok(params)
    }
}

/// `profile` with the values of the file at `path` in place of its own.
fn overlay(profile: &Params, path: &Path) -> Result<Params> {
    let at = || path.display().to_string();
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("{}: cannot be read; give a readable TOML file of constants", at()))?;
    // Parsed as `Params` first: these errors name the line and the valid keys.
    let checked: Params =
        toml::from_str(&text).map_err(|error| anyhow!("{}: {}", at(), toml_error::text(&error)))?;
    checked.validate().with_context(|| format!("{}: correct this value", at()))?;
    let mut merged = toml::Table::try_from(profile).context("a profile is a table")?;
    merged.extend(text.parse::<toml::Table>().with_context(at)?);
    merged.try_into().with_context(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hangpose::CentreOfMass;

    fn overlaid(profile: &Params, text: &str) -> Result<Params> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        overlay(profile, file.path())
    }

    #[test]
    fn a_file_changes_what_it_names() {
        let text = "radius_ratio = 0.5\ncentre_of_mass = { given = [0.1, 0, -0.5] }";
        let params = overlaid(&Params::paper(), text).unwrap();
        let centre_of_mass = CentreOfMass::Given([0.1, 0.0, -0.5]);
        assert_eq!(params, Params { radius_ratio: 0.5, centre_of_mass, ..Params::paper() });
        assert_eq!(overlaid(&Params::default(), "").unwrap(), Params::default());
    }

    #[test]
    fn unknown_keys_and_bad_values_are_named() {
        let message = |text| format!("{:#}", overlaid(&Params::paper(), text).unwrap_err());
        assert!(message("\nradius_ration = 0.5").contains("line 2"));
        assert!(message("radius_ration = 0.5").contains("unknown field `radius_ration`"));
        assert!(message("radius_ratio = \"half\"").contains("expected f32"));
        assert!(message("radius_ratio = 7").contains("radius_ratio = 7 is outside its range, 0 to 1"));
        assert!(message("samples = -3").contains("line 1"));
    }
}
