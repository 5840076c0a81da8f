//! A priority queue whose items' weights can grow, in the caller's memory.

/// A binary heap of the items 0 to n-1, each with a weight; the heaviest is on top, of equally heavy ones the
/// first. The items not in the heap stand behind it.
pub(crate) struct Heap<'s> {
    weights: &'s mut [f32],
    /// The heap in the first `len` entries, then the items that are not in it.
    order: &'s mut [u32],
    /// Where each item stands in `order`.
    places: &'s mut [u32],
    len: usize,
}

impl<'s> Heap<'s> {
    /// An empty heap for `weights.len()` items; `order` and `places`, of the same length, are overwritten.
    pub(crate) fn empty(weights: &'s mut [f32], order: &'s mut [u32], places: &'s mut [u32]) -> Self {
        debug_assert!(order.len() == weights.len() && places.len() == weights.len());
        for (index, (slot, place)) in order.iter_mut().zip(places.iter_mut()).enumerate() {
            (*slot, *place) = (index as u32, index as u32);
        }
        Self { weights, order, places, len: 0 }
    }

    fn contains(&self, item: usize) -> bool {
        (self.places[item] as usize) < self.len
    }

    /// Takes the heaviest item out; `None` if there is none.
    pub(crate) fn pop(&mut self) -> Option<usize> {
        self.len = self.len.checked_sub(1)?;
        self.exchange(0, self.len);
        self.sink(0);
        Some(self.order[self.len] as usize)
    }

    /// Puts an item in with this weight, or makes it heavier if it is in and lighter; says whether it did.
    pub(crate) fn offer(&mut self, item: usize, weight: f32) -> bool {
        if !self.contains(item) {
            self.exchange(self.places[item] as usize, self.len);
            self.len += 1;
        } else if weight <= self.weights[item] {
            return false;
        }
        self.weights[item] = weight;
        self.swim(self.places[item] as usize);
        true
    }

    fn is_heavier(&self, a: u32, b: u32) -> bool {
        let (wa, wb) = (self.weights[a as usize], self.weights[b as usize]);
        wa > wb || (wa == wb && a < b)
    }

    fn exchange(&mut self, a: usize, b: usize) {
        self.order.swap(a, b);
        self.places[self.order[a] as usize] = a as u32;
        self.places[self.order[b] as usize] = b as u32;
    }

    fn sink(&mut self, mut place: usize) {
        let item = self.order[place];
        loop {
            let mut child = 2 * place + 1;
            if child >= self.len {
                break;
            }
            if child + 1 < self.len && self.is_heavier(self.order[child + 1], self.order[child]) {
                child += 1;
            }
            if !self.is_heavier(self.order[child], item) {
                break;
            }
            self.order[place] = self.order[child];
            self.places[self.order[place] as usize] = place as u32;
            place = child;
        }
        self.order[place] = item;
        self.places[item as usize] = place as u32;
    }

    fn swim(&mut self, mut place: usize) {
        while place > 0 && self.is_heavier(self.order[place], self.order[(place - 1) / 2]) {
            self.exchange(place, (place - 1) / 2);
            place = (place - 1) / 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Random operations beside a plain list.
    #[test]
    fn agrees_with_a_list() {
        const N: usize = 50;
        let mut random = Random::new(3);
        let (mut weights, mut order, mut places) = ([0.0; N], [0; N], [0; N]);
        let mut list = [None::<f32>; N];
        let mut heap = Heap::empty(&mut weights, &mut order, &mut places);
        for _ in 0..5000 {
            let item = random.next_u32() as usize % N;
            let weight = (random.next_f32() * 20.0).floor();
            match random.next_u32() % 2 {
                0 => {
                    let heaviest = (0..N)
                        .rev()
                        .filter(|&i| list[i].is_some())
                        .max_by(|&a: &usize, &b: &usize| list[a].partial_cmp(&list[b]).unwrap());
                    assert_eq!(heap.pop(), heaviest);
                    if let Some(item) = heaviest {
                        list[item] = None;
                    }
                }
                _ => {
                    let changes = list[item].is_none_or(|old| weight > old);
                    assert_eq!(heap.offer(item, weight), changes);
                    if changes {
                        list[item] = Some(weight);
                    }
                }
            }
        }
        assert_eq!(core::iter::from_fn(|| heap.pop()).count(), list.iter().flatten().count());
    }
}
