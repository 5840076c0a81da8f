//! Which pixels show an object.

/// A segmentation of an image and the label of one of its segments.
#[derive(Clone, Copy, Debug)]
pub struct Mask<'a> {
    /// One label a pixel, row by row.
    pub labels: &'a [u8],
    /// The label of the object.
    pub label: u8,
}

impl Mask<'_> {
    /// Whether a pixel shows the object. One without a label does not.
    #[inline]
    pub(crate) fn holds(&self, pixel: usize) -> bool {
        self.labels.get(pixel) == Some(&self.label)
    }
}
