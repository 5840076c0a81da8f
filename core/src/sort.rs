//! Sorting that looks at the monitor on its way, which the standard library's cannot.

use crate::monitor::{Meter, Stop};

/// Length of the runs that are sorted by insertion before they are merged.
const RUN: usize = 24;

/// Sorts `items` so that none is before one that `is_before` it; equal ones keep their order. `spare` is at least as long.
pub(crate) fn sort<T: Copy>(
    items: &mut [T],
    spare: &mut [T],
    meter: &Meter,
    is_before: impl Fn(&T, &T) -> bool,
) -> Result<(), Stop> {
    let spare = &mut spare[..items.len()];
    for run in items.chunks_mut(RUN) {
        meter.check_cancelled()?;
        for sorted in 1..run.len() {
            let item = run[sorted];
            let mut place = sorted;
            while place > 0 && is_before(&item, &run[place - 1]) {
                run[place] = run[place - 1];
                place -= 1;
            }
            run[place] = item;
        }
    }
    let (mut width, mut is_in_spare) = (RUN, false);
    while width < items.len() {
        let (from, to) = if is_in_spare { (&*spare, &mut *items) } else { (&*items, &mut *spare) };
        for (pair, merged) in from.chunks(2 * width).zip(to.chunks_mut(2 * width)) {
            let (left, right) = pair.split_at(width.min(pair.len()));
            merge(left, right, merged, meter, &is_before)?;
        }
        (width, is_in_spare) = (2 * width, !is_in_spare);
    }
    if is_in_spare {
        items.copy_from_slice(spare);
    }
    Ok(())
}

/// Merges two sorted slices into one as long as both.
fn merge<T: Copy>(
    left: &[T],
    right: &[T],
    merged: &mut [T],
    meter: &Meter,
    is_before: &impl Fn(&T, &T) -> bool,
) -> Result<(), Stop> {
    let (mut a, mut b) = (0, 0);
    for (step, slot) in merged.iter_mut().enumerate() {
        meter.check_at(step)?;
        *slot = match (left.get(a), right.get(b)) {
            (Some(first), Some(second)) if is_before(second, first) => {
                b += 1;
                *second
            }
            (Some(first), _) => {
                a += 1;
                *first
            }
            (None, Some(second)) => {
                b += 1;
                *second
            }
            (None, None) => break,
        };
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::monitor::Monitor;
    use crate::random::Random;

    #[test]
    fn as_the_standard_library_sorts() {
        let mut random = Random::new(2);
        for count in (0..60).chain([100, 1000, 4097]) {
            for kinds in [1, 7, 1_000_000] {
                let mut items: Vec<[u32; 2]> =
                    (0..count).map(|index| [random.next_u32() % kinds, index]).collect();
                let mut expected = items.clone();
                expected.sort_by_key(|item| item[0]);
                let meter = Meter::unwatched();
                let mut spare = vec![[0; 2]; (count + random.next_u32() % 3) as usize];
                sort(&mut items, &mut spare, &meter, |a, b| a[0] < b[0]).unwrap();
                assert_eq!(items, expected);
            }
        }
    }

    #[test]
    fn a_cancelled_one_stops() {
        let monitor = Monitor::new();
        monitor.cancel();
        let sorted = sort(&mut [2, 1], &mut [0; 2], &Meter::new(&monitor), |a, b| a < b);
        assert_eq!(sorted, Err(Stop::Cancelled));
    }
}
