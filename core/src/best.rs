//! A short list that keeps the best.

/// The best items offered so far, best first, in a slice from outside; when it is full the worst makes way.
pub(crate) struct Best<'a, T> {
    slots: &'a mut [T],
    len: usize,
}

impl<'a, T: Copy> Best<'a, T> {
    pub(crate) fn new(slots: &'a mut [T]) -> Self {
        Self { slots, len: 0 }
    }

    /// The first `len` of the slots, which are in order.
    pub(crate) fn filled(slots: &'a mut [T], len: usize) -> Self {
        Self { slots, len }
    }

    /// Inserts `item` behind those that it is not better than. It is dropped if the list is full of better ones.
    pub(crate) fn offer(&mut self, item: T, is_better: impl Fn(&T, &T) -> bool) {
        let filled = self.slots.get(..self.len).unwrap_or_default();
        let place = filled.partition_point(|other| !is_better(&item, other));
        if place < self.slots.len() {
            self.len = (self.len + 1).min(self.slots.len());
            // Each moves on by one place.
            let mut moved = item;
            for slot in self.slots.get_mut(place..self.len).unwrap_or_default() {
                core::mem::swap(slot, &mut moved);
            }
        }
    }

    /// Drops the items of which `is_dropped` is true.
    pub(crate) fn drop_where(&mut self, is_dropped: impl Fn(&T) -> bool) {
        let mut kept = 0;
        for index in 0..self.len {
            let Some(&item) = self.slots.get(index) else { break };
            if !is_dropped(&item)
                && let Some(slot) = self.slots.get_mut(kept)
            {
                *slot = item;
                kept += 1;
            }
        }
        self.len = kept;
    }

    /// The worst item if the list is full: the next one to be dropped.
    pub(crate) fn next_to_go(&self) -> Option<&T> {
        if self.len == self.slots.len() { self.slots.last() } else { None }
    }

    pub(crate) fn len(&self) -> usize {
        self.len
    }

    pub(crate) fn is_full(&self) -> bool {
        self.len == self.slots.len()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &T> {
        self.slots.iter().take(self.len)
    }

    pub(crate) fn into_slice(self) -> &'a mut [T] {
        self.slots.get_mut(..self.len).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_the_best_in_order_and_the_first_of_equals() {
        let mut slots = [(0, ' '); 3];
        let mut best = Best::new(&mut slots);
        for item in [(5, 'a'), (2, 'b'), (5, 'c'), (1, 'd'), (2, 'e'), (9, 'f')] {
            best.offer(item, |a, b| a.0 < b.0);
        }
        assert_eq!(best.next_to_go(), Some(&(2, 'e')));
        assert_eq!(best.into_slice(), [(1, 'd'), (2, 'b'), (2, 'e')]);
        let mut slots = [5, 2, 3, 0];
        let mut best = Best::filled(&mut slots, 3);
        best.drop_where(|item| *item == 2);
        assert_eq!(best.into_slice(), [5, 3]);
        let mut none: [u8; 0] = [];
        let mut best = Best::new(&mut none);
        best.offer(1, |a, b| a < b);
        assert!(best.into_slice().is_empty());
    }
}
