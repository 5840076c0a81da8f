//! What cameras did not see of an object, guessed from what they saw: its mesh becomes closed.
//!
//! A guess has to fit into what no camera saw free. It is the union of balls: around each unknown voxel, the largest ball
//! that fits between what was seen free belongs to the object if it hangs on a surface that was seen. It does not if it
//! only touches the border of the shadow that the object throws. So a round bar seen from one side becomes a full round
//! bar, what was seen all around stays as it is, and a shadow stays empty. A flat surface does not tell how thick it is:
//! behind it, balls are at most as thick as the settings allow, unless surfaces hold them from two sides.
//!
//! The cameras must have seen beside the object: behind it there is a wall, or
//! [`missing_is_free`](super::volume::VolumeSettings::missing_is_free).

mod balls;
mod error;
mod grid;
mod room;
mod settings;
#[cfg(test)]
mod tests;
mod transform;

pub use error::CompletionError;
pub use room::room;
pub use settings::CompletionSettings;

use super::volume::Volume;
use super::volume::blocks::{BLOCK, BLOCK_VOXELS};
use super::volume::voxel::Voxel;
use crate::Monitor;
use crate::memory::{Arena, array_bytes, model_bytes};
use crate::monitor::{Meter, Stop};
use balls::Bounds;
use grid::{Grid, State};
use transform::{Line, transform};

/// Depth behind a surface up to which it is certain, voxels: both ends of each edge that the surface crosses, and a little
/// noise. Deeper, a camera only assumes that what it sees is not thinner than the truncation.
const CERTAIN: f32 = 1.5;

/// What was guessed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Completion {
    /// Voxels that no image saw and that were filled.
    pub filled: usize,
    /// Voxels that no image saw and that stay empty.
    pub empty: usize,
}

impl Completion {
    /// Bytes of memory to complete a volume of this many blocks ([`Volume::blocks`]), at most 6.7 KiB a block.
    pub const fn bytes(blocks: usize) -> usize {
        let voxels = blocks.saturating_mul(BLOCK_VOXELS);
        let arrays = array_bytes::<f32>(voxels)
            .saturating_mul(3)
            .saturating_add(array_bytes::<u8>(voxels))
            .saturating_add(Line::bytes(blocks.saturating_mul(BLOCK as usize)));
        model_bytes(arrays)
    }
}

/// Working memory: one value a voxel.
struct Work<'m> {
    grid: Grid,
    /// [`State`] of each voxel.
    states: &'m mut [u8],
    values: &'m mut [f32],
    sites: &'m mut [u32],
    /// Outside, the distance to the surface next to the voxel, negative for voxels that are next to none; elsewhere, the
    /// radius of the ball around the voxel. Voxels.
    lengths: &'m mut [f32],
    line: Line<'m>,
}

impl Volume<'_> {
    /// Guesses what no image saw, in `memory` of at least [`Completion::bytes`]. Then the surface of the volume is closed.
    /// The surfaces that were seen stay as they are, and the outermost voxels of the crop box become free.
    ///
    /// [`Isosurface::write_seen`](super::isosurface::Isosurface::write_seen) tells what was seen from what was guessed, and
    /// [`space`](Self::space) goes on to say that a guess is unknown. An image that is fused later replaces guesses where
    /// it sees something. A call that is cancelled may have written a part of the guesses; another call completes them.
    pub fn complete(
        &mut self,
        settings: &CompletionSettings,
        memory: &mut [u8],
        monitor: &Monitor,
    ) -> Result<Completion, CompletionError> {
        let meter = Meter::new(monitor);
        meter.check()?;
        if !self.settings().dense {
            return Err(CompletionError::Sparse);
        }
        settings.validate()?;
        let CompletionSettings { thickness, radius } = *settings;
        let voxel = self.settings().voxel;
        let one_sided = thickness / 2.0 / voxel;
        let bounds = Bounds { one_sided, radius: one_sided.max(radius / voxel) };
        let mut work = Work::new(self, memory)?;
        work.classify(self, &meter)?;
        work.find_gaps(self, &meter)?;
        meter.progress(0.2);
        work.find_nearest_free(&meter)?;
        meter.progress(0.5);
        work.find_balls(&bounds, &meter)?;
        meter.progress(0.7);
        work.unite_balls(&meter)?;
        meter.progress(0.9);
        work.fill_cavities(&meter)?;
        let completion = work.write(self, &meter)?;
        meter.progress(1.0);
        Ok(completion)
    }
}

impl<'m> Work<'m> {
    fn new(volume: &Volume, memory: &'m mut [u8]) -> Result<Self, CompletionError> {
        let grid = Grid::of(volume);
        let count = grid.count();
        let mut arena = Arena::new(memory, Completion::bytes(volume.blocks()))?;
        let longest = grid.size.into_iter().fold(0, usize::max);
        Ok(Self {
            grid,
            states: arena.slice(count)?,
            values: arena.slice(count)?,
            sites: arena.slice(count)?,
            lengths: arena.slice(count)?,
            line: Line::new(longest, &mut arena)?,
        })
    }

    fn state(&self, index: usize) -> State {
        State::of(self.states[index])
    }

    /// Sets the states.
    fn classify(&mut self, volume: &Volume, meter: &Meter) -> Result<(), Stop> {
        let grid = self.grid;
        let certain = -CERTAIN * volume.settings().voxel / volume.settings().truncation;
        for index in 0..self.states.len() {
            meter.check_at(index)?;
            let voxel = grid.voxel(volume, index);
            let state = if !grid.is_within(grid.steps(index)) {
                State::Outside
            } else if !voxel.is_seen() {
                State::Unknown
            } else if voxel.distance >= 0 {
                State::Outside
            } else if voxel.part() >= certain {
                State::Surface
            } else {
                State::Behind
            };
            self.states[index] = state as u8;
        }
        for index in 0..self.states.len() {
            meter.check_at(index)?;
            let is_outside = |other: &usize| self.state(*other) == State::Outside;
            if self.state(index) == State::Behind && grid.neighbours(index).iter().any(is_outside) {
                self.states[index] = State::Surface as u8;
            }
        }
        Ok(())
    }

    /// Sets the lengths of the voxels outside: the distance to the plane that cuts the edges to the neighbours where the
    /// signed distance is zero.
    fn find_gaps(&mut self, volume: &Volume, meter: &Meter) -> Result<(), Stop> {
        let grid = self.grid;
        for index in 0..self.states.len() {
            meter.check_at(index)?;
            self.lengths[index] = -1.0;
            if self.state(index) != State::Outside || !grid.is_within(grid.steps(index)) {
                continue;
            }
            let distance = grid.voxel(volume, index).part();
            // Along each axis, one over the way to the plane.
            let mut inverses = [0.0_f32; 3];
            for (side, other) in grid.neighbours(index).into_iter().enumerate() {
                if self.state(other) == State::Surface {
                    let inverse = 1.0 - grid.voxel(volume, other).part() / distance.max(f32::EPSILON);
                    inverses[side / 2] = inverses[side / 2].max(inverse);
                }
            }
            let sum: f32 = inverses.iter().map(|x| x * x).sum();
            if sum > 0.0 {
                self.lengths[index] = 1.0 / libm::sqrtf(sum);
            }
        }
        Ok(())
    }

    /// Sets the sites to the nearest voxel outside.
    fn find_nearest_free(&mut self, meter: &Meter) -> Result<(), CompletionError> {
        let voxels = self.states.iter().zip(self.values.iter_mut()).zip(self.sites.iter_mut());
        for (index, ((&state, value), site)) in voxels.enumerate() {
            meter.check_at(index)?;
            let is_outside = State::of(state) == State::Outside;
            (*value, *site) = (if is_outside { 0.0 } else { f32::INFINITY }, index as u32);
        }
        Ok(transform(self.grid.size, self.values, self.sites, &mut self.line, || meter.check())?)
    }

    /// Sets the lengths of the voxels that are not outside to the radii of the balls that are kept, zero for others.
    fn find_balls(&mut self, bounds: &Bounds, meter: &Meter) -> Result<(), CompletionError> {
        for index in 0..self.states.len() {
            meter.check_at(index)?;
            if self.state(index) != State::Outside {
                let (states, gaps) = (&*self.states, &*self.lengths);
                let radius = balls::radius(&self.grid, index, states, self.sites, gaps, bounds);
                self.lengths[index] = radius.unwrap_or(0.0);
            }
        }
        Ok(())
    }

    /// Sets the values to the signed distance to the union of the balls, voxels, exact where it is zero.
    fn unite_balls(&mut self, meter: &Meter) -> Result<(), CompletionError> {
        let balls = self.states.iter().zip(self.lengths.iter());
        let voxels = balls.zip(self.values.iter_mut().zip(self.sites.iter_mut()));
        for (index, ((&state, &radius), (value, site))) in voxels.enumerate() {
            meter.check_at(index)?;
            let is_ball = State::of(state) != State::Outside && radius > 0.0;
            (*value, *site) = (if is_ball { -radius * radius } else { f32::INFINITY }, index as u32);
        }
        transform(self.grid.size, self.values, self.sites, &mut self.line, || meter.check())?;
        for index in 0..self.states.len() {
            meter.check_at(index)?;
            if self.values[index] < f32::INFINITY {
                let centre = self.sites[index] as usize;
                self.values[index] = self.grid.distance(index, centre) - self.lengths[centre];
            }
        }
        Ok(())
    }

    /// Fills what no ball fills and no free space borders on.
    fn fill_cavities(&mut self, meter: &Meter) -> Result<(), CompletionError> {
        // From here on, a site is one where free space reaches the voxel.
        for (index, (site, &state)) in self.sites.iter_mut().zip(self.states.iter()).enumerate() {
            meter.check_at(index)?;
            *site = u32::from(State::of(state) == State::Outside);
        }
        let [x, y, z] = self.grid.strides();
        let count = self.states.len();
        let mut changes = true;
        while changes {
            changes = false;
            for index in z..count {
                meter.check_at(index)?;
                changes |= self.reach(index, [index - x, index - y, index - z]);
            }
            for index in (0..count - z).rev() {
                meter.check_at(index)?;
                changes |= self.reach(index, [index + x, index + y, index + z]);
            }
        }
        let voxels = self.sites.iter().zip(self.values.iter_mut()).zip(self.lengths.iter());
        for (index, ((&site, value), length)) in voxels.enumerate() {
            meter.check_at(index)?;
            if site == 0 {
                *value = value.min(-length.max(1.0));
            }
        }
        Ok(())
    }

    /// Lets free space reach an empty voxel from one of its neighbours; whether it did.
    #[inline]
    fn reach(&mut self, index: usize, from: [usize; 3]) -> bool {
        let is_new =
            self.sites[index] == 0 && self.values[index] >= 0.0 && from.iter().any(|i| self.sites[*i] == 1);
        self.sites[index] |= u32::from(is_new);
        is_new
    }

    /// Writes the guesses to the volume.
    fn write(&self, volume: &mut Volume, meter: &Meter) -> Result<Completion, Stop> {
        let grid = self.grid;
        let voxels_a_truncation = volume.settings().truncation / volume.settings().voxel;
        let mut completion = Completion::default();
        for index in 0..self.states.len() {
            meter.check_at(index)?;
            let place = grid.place(volume, index);
            let distance = self.values[index];
            let guess = Voxel::guess(distance / voxels_a_truncation);
            let voxel = &mut volume.voxels_mut()[place];
            match self.state(index) {
                State::Surface => {}
                State::Behind => *voxel = guess,
                State::Unknown => {
                    *voxel = guess;
                    completion.filled += usize::from(distance < 0.0);
                    completion.empty += usize::from(distance >= 0.0);
                }
                State::Outside if !grid.is_within(grid.steps(index)) => *voxel = Voxel::guess(1.0),
                // Beside a guess, the surface is where the ball ends.
                State::Outside if self.lengths[index] < 0.0 && distance < 1.0 => {
                    voxel.distance = voxel.distance.min(guess.distance.max(1));
                }
                State::Outside => {}
            }
        }
        Ok(completion)
    }
}
