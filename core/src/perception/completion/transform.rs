//! Distance transforms of a grid, exact and in linear time (Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled
//! Functions", Theory of Computing, 2012).

use crate::Stop;
use crate::memory::{Arena, OutOfMemory, array_bytes};

/// Working memory for one line of the grid.
pub(super) struct Line<'m> {
    values: &'m mut [f32],
    sites: &'m mut [u32],
    /// Places on the line of the parabolas of the lower envelope.
    envelope: &'m mut [u32],
    /// Where each of them begins to be the lowest.
    starts: &'m mut [f32],
}

impl<'m> Line<'m> {
    pub(super) const fn bytes(length: usize) -> usize {
        array_bytes::<f32>(length).saturating_mul(4)
    }

    pub(super) fn new(length: usize, arena: &mut Arena<'m>) -> Result<Self, OutOfMemory> {
        Ok(Self {
            values: arena.slice(length)?,
            sites: arena.slice(length)?,
            envelope: arena.slice(length)?,
            starts: arena.slice(length)?,
        })
    }

    /// Replaces each value on the line by the least sum of a value and the squared way to it, and each site by the one of
    /// that value.
    fn transform(&mut self, values: &mut [f32], sites: &mut [u32], first: usize, stride: usize) {
        let length = self.values.len();
        let mut count = 0;
        for at in 0..length {
            let value = values[first + at * stride];
            self.values[at] = value;
            self.sites[at] = sites[first + at * stride];
            if value == f32::INFINITY {
                continue;
            }
            let place = at as f32;
            let mut start = f32::NEG_INFINITY;
            while count > 0 {
                let other = self.envelope[count - 1] as usize;
                let other_place = other as f32;
                // The parabolas meet where value + (x - place)² is the same for both.
                let heights = value + place * place - (self.values[other] + other_place * other_place);
                start = heights / (2.0 * (place - other_place));
                if start > self.starts[count - 1] {
                    break;
                }
                count -= 1;
                start = f32::NEG_INFINITY;
            }
            self.envelope[count] = at as u32;
            self.starts[count] = start;
            count += 1;
        }
        if count == 0 {
            return;
        }
        let mut current = 0;
        for at in 0..length {
            while current + 1 < count && self.starts[current + 1] <= at as f32 {
                current += 1;
            }
            let lowest = self.envelope[current] as usize;
            let way = at as f32 - lowest as f32;
            values[first + at * stride] = self.values[lowest] + way * way;
            sites[first + at * stride] = self.sites[lowest];
        }
    }

    /// The same line memory for a shorter line.
    fn shortened(&mut self, length: usize) -> Line<'_> {
        Line {
            values: &mut self.values[..length],
            sites: &mut self.sites[..length],
            envelope: &mut self.envelope[..length],
            starts: &mut self.starts[..length],
        }
    }
}

/// Replaces the value at each place of a grid by the least sum of a value and the squared distance to its place, and each
/// site by the one of that value. The x index is the fastest. A value may be infinite; its site is then never taken.
pub(super) fn transform(
    size: [usize; 3],
    values: &mut [f32],
    sites: &mut [u32],
    line: &mut Line,
    mut check: impl FnMut() -> Result<(), Stop>,
) -> Result<(), Stop> {
    let strides = [1, size[0], size[0] * size[1]];
    for (axis, [inner, outer]) in [[1, 2], [0, 2], [0, 1]].into_iter().enumerate() {
        let mut line = line.shortened(size[axis]);
        for j in 0..size[outer] {
            check()?;
            for i in 0..size[inner] {
                let first = i * strides[inner] + j * strides[outer];
                line.transform(values, sites, first, strides[axis]);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;
    use crate::random::Random;

    #[test]
    fn agrees_with_trying_all_sites() {
        let size = [7, 11, 5];
        let count = size.iter().product::<usize>();
        let place = |i: usize| [i % 7, i / 7 % 11, i / 77].map(|x| x as f32);
        let squared = |i: usize, j: usize| {
            let (a, b) = (place(i), place(j));
            (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f32>()
        };
        let needed = model_bytes(Line::bytes(11));
        let mut random = Random::new(4);
        for round in 0..50 {
            let weights: Vec<f32> = (0..count)
                .map(|_| match random.next_f32() {
                    draw if draw < 0.9 => f32::INFINITY,
                    draw if round % 2 == 0 => -40.0 * draw * random.next_f32(),
                    _ => 0.0,
                })
                .collect();
            let (mut values, mut sites) = (weights.clone(), (0..count as u32).collect::<Vec<_>>());
            let mut memory = vec![0; needed];
            let mut line = Line::new(11, &mut Arena::new(&mut memory, needed).unwrap()).unwrap();
            transform(size, &mut values, &mut sites, &mut line, || Ok(())).unwrap();
            for i in 0..count {
                let best = (0..count).map(|j| weights[j] + squared(i, j)).fold(f32::INFINITY, f32::min);
                let site = sites[i] as usize;
                assert!((values[i] - best).abs() < 1e-3);
                assert!((weights[site] + squared(i, site) - best).abs() < 1e-3);
            }
        }
        let stopped = transform(
            size,
            &mut vec![0.0; count],
            &mut vec![0; count],
            &mut {
                let memory = vec![0; needed].leak();
                Line::new(11, &mut Arena::new(memory, needed).unwrap()).unwrap()
            },
            || Err(Stop::Cancelled),
        );
        assert_eq!(stopped, Err(Stop::Cancelled));
    }
}
