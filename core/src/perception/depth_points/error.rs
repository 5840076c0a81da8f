//! Why the points of a depth image cannot be given.

/// Why the points of a depth image cannot be given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DepthPointsError {
    /// A setting is out of range.
    Setting {
        /// Name of the field.
        field: &'static str,
        /// Its value.
        value: f32,
        /// Least and greatest value allowed.
        range: [f32; 2],
    },
    /// The number of labels is not that of the image's pixels.
    Mask {
        /// Number of labels.
        labels: usize,
        /// Number of pixels.
        pixels: usize,
    },
    /// There are more points than the slices hold.
    Full {
        /// Number of points.
        needed: usize,
        /// Length of the shorter slice.
        limit: usize,
    },
}

impl core::fmt::Display for DepthPointsError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Setting { field, value, range: [least, greatest] } => {
                write!(f, "{field} is {value} and must be a number from {least} to {greatest}")
            }
            Self::Mask { labels, pixels } => {
                write!(
                    f,
                    "the mask has {labels} labels and the image {pixels} pixels: give one for each pixel"
                )
            }
            Self::Full { needed, limit } => write!(
                f,
                "the image shows {needed} points and the lists hold {limit}: give longer ones, a smaller box or a larger stride"
            ),
        }
    }
}

impl core::error::Error for DepthPointsError {}
