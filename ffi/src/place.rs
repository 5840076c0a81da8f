use hangpose_core::geometry::MAX_COORDINATE;

pub(crate) const COORDINATES: [f64; 2] = [-(MAX_COORDINATE as f64), MAX_COORDINATE as f64];

/// Location of a failure: the field with its prefix, the index of the element, the value and its range.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Place {
    pub(crate) prefix: &'static str,
    pub(crate) field: &'static str,
    pub(crate) index: Option<usize>,
    pub(crate) value: Option<f64>,
    pub(crate) range: Option<[f64; 2]>,
}

/// A [`Place`] without prefix in less memory, so that results stay small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spot {
    pub(crate) field: &'static str,
    index: Option<u32>,
    value: Option<f64>,
    range: Option<[f64; 2]>,
}

impl From<Place> for Spot {
    fn from(Place { prefix: _, field, index, value, range }: Place) -> Self {
        Self { field, index: index.map(|index| index as u32), value, range }
    }
}

impl From<Spot> for Place {
    fn from(Spot { field, index, value, range }: Spot) -> Self {
        Self { prefix: "", field, index: index.map(|index| index as usize), value, range }
    }
}

impl Place {
    pub(crate) fn of(field: &'static str) -> Self {
        Self { field, ..Self::default() }
    }

    pub(crate) fn value(self, value: f64) -> Self {
        Self { value: Some(value), ..self }
    }

    pub(crate) fn range(self, range: [f64; 2]) -> Self {
        Self { range: Some(range), ..self }
    }

    /// The first of three numbers that is not a valid coordinate.
    pub(crate) fn coordinate(self, index: Option<usize>, position: [f32; 3]) -> Self {
        let bad = position.into_iter().find(|x| x.is_nan() || x.abs() > MAX_COORDINATE);
        Self { index, value: bad.map(f64::from), range: Some(COORDINATES), ..self }
    }
}
