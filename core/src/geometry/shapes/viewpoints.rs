//! Positions of cameras.

use crate::geometry::{Point, Pose};

/// The positions of the cameras that saw a shape, as the caller gives them, told in another frame.
#[derive(Clone, Copy)]
pub(crate) struct Viewpoints<'a> {
    given: &'a [Point],
    frame: Pose,
}

impl<'a> Viewpoints<'a> {
    /// The positions `given`, metres, moved by `frame`.
    pub(crate) fn new(given: &'a [Point], frame: &Pose) -> Self {
        Self { given, frame: *frame }
    }

    pub(crate) fn len(&self) -> usize {
        self.given.len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = Point> + use<'a> {
        let frame = self.frame;
        self.given.iter().map(move |viewpoint| frame * viewpoint)
    }

    pub(crate) fn get(&self, index: usize) -> Option<Point> {
        self.given.get(index).map(|viewpoint| self.frame * viewpoint)
    }

    /// The only one, if there is no other.
    pub(crate) fn single(&self) -> Option<Point> {
        self.get(0).filter(|_| self.len() == 1)
    }
}
