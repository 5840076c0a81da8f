//! Items taken out by weight, heaviest first, while the weights of the others fall.

use crate::memory::{Arena, OutOfMemory, array_bytes};

/// A queue of the items 0 to n-1, each with a weight that only falls; of equally heavy ones the first comes first.
///
/// Items wait in buckets by the leading bits of their weights. What falls stays where it is until its turn comes, and only
/// then goes where it belongs. So only the few items of the heaviest bucket are kept in order, by a binary heap, and most
/// changes of a weight cost nothing but the change.
pub(super) struct FallingQueue<'s> {
    weights: &'s mut [f32],
    /// The first item of each bucket.
    heads: &'s mut [u32],
    /// The item behind each in its bucket; [`TAKEN`] for those that were taken out.
    behind: &'s mut [u32],
    /// The items of the heaviest bucket, with the weights that they had, as keys in heap order.
    heap: &'s mut [u64],
    len: usize,
    bucket: usize,
}

/// Ends a bucket.
const END: u32 = u32::MAX;
/// Marks an item that was taken out.
const TAKEN: u32 = u32::MAX - 1;
/// Weight up to which all are in the first bucket.
const LIGHT: f32 = 1.0 / (1 << 24) as f32;
/// Bits of a weight's mantissa that tell buckets apart: 1 in 256.
const MANTISSA_BITS: u32 = 8;
/// Buckets, over 32 powers of two: all weights above 256 are in the last.
const BUCKETS: usize = 32 << MANTISSA_BITS;

/// Bytes of working memory for this many items.
pub(super) const fn scratch_bytes(items: usize) -> usize {
    array_bytes::<u32>(BUCKETS)
        .saturating_add(array_bytes::<u32>(items))
        .saturating_add(array_bytes::<u64>(items))
}

fn bucket_of(weight: f32) -> usize {
    let above = weight.max(LIGHT).to_bits() - LIGHT.to_bits();
    ((above >> (f32::MANTISSA_DIGITS - 1 - MANTISSA_BITS)) as usize).min(BUCKETS - 1)
}

/// A number that is greater for what comes first. Rounding makes weights a little less than zero; those count as zero.
fn key(weight: f32, item: usize) -> u64 {
    u64::from(weight.max(0.0).to_bits()) << 32 | u64::from(!(item as u32))
}

fn item_of(key: u64) -> usize {
    !(key as u32) as usize
}

impl<'s> FallingQueue<'s> {
    /// A queue of the first `items`, which have these weights.
    pub(super) fn new(
        weights: &'s mut [f32],
        items: usize,
        scratch: &mut Arena<'s>,
    ) -> Result<Self, OutOfMemory> {
        let heads = scratch.unset::<u32>(BUCKETS)?;
        let (behind, heap) = (scratch.unset::<u32>(items)?, scratch.unset::<u64>(items)?);
        heads.fill(END);
        let mut queue = Self { weights, heads, behind, heap, len: 0, bucket: BUCKETS };
        for item in 0..items {
            queue.put(item, bucket_of(queue.weights[item]));
        }
        Ok(queue)
    }

    /// The weights, which may fall. Those of items that were taken out do not matter.
    pub(super) fn weights(&mut self) -> &mut [f32] {
        self.weights
    }

    /// Takes the heaviest item out; `None` if there is none.
    pub(super) fn pop(&mut self) -> Option<usize> {
        loop {
            while self.len == 0 {
                self.bucket = self.bucket.checked_sub(1)?;
                self.open();
            }
            let top = self.heap[0];
            let item = item_of(top);
            let now = key(self.weights[item], item);
            let bucket = bucket_of(self.weights[item]);
            if now < top && bucket == self.bucket {
                self.heap[0] = now;
                self.sink(0);
                continue;
            }
            self.len -= 1;
            self.heap[0] = self.heap[self.len];
            self.sink(0);
            if bucket == self.bucket {
                self.behind[item] = TAKEN;
                return Some(item);
            }
            self.put(item, bucket);
        }
    }

    /// The items that were not taken out, in order.
    pub(super) fn into_items(self) -> impl Iterator<Item = usize> + 's {
        let behind = self.behind;
        (0..behind.len()).filter(|&item| behind[item] != TAKEN)
    }

    fn put(&mut self, item: usize, bucket: usize) {
        self.behind[item] = self.heads[bucket];
        self.heads[bucket] = item as u32;
    }

    /// Makes a heap of the items of the bucket, and moves those that have fallen to theirs.
    fn open(&mut self) {
        let mut item = core::mem::replace(&mut self.heads[self.bucket], END);
        while item != END {
            let (this, weight) = (item as usize, self.weights[item as usize]);
            item = self.behind[this];
            let bucket = bucket_of(weight);
            if bucket == self.bucket {
                self.heap[self.len] = key(weight, this);
                self.len += 1;
            } else {
                self.put(this, bucket);
            }
        }
        for place in (0..self.len / 2).rev() {
            self.sink(place);
        }
    }

    fn sink(&mut self, mut place: usize) {
        let heap = &mut self.heap[..self.len];
        let Some(&key) = heap.get(place) else { return };
        loop {
            let mut child = 2 * place + 1;
            if child + 1 < heap.len() && heap[child + 1] > heap[child] {
                child += 1;
            }
            if child >= heap.len() || heap[child] <= key {
                break;
            }
            heap[place] = heap[child];
            place = child;
        }
        heap[place] = key;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::model_bytes;
    use crate::random::Random;

    /// Random changes beside a plain list: weights of all sizes, many equal ones, and all in one bucket.
    #[test]
    fn agrees_with_a_list() {
        const N: usize = 200;
        for round in 0..3 {
            let mut random = Random::new(3);
            let mut weights: Vec<f32> = (0..N)
                .map(|_| match round {
                    0 => (random.next_f32() * 30.0 - 20.0).exp2(),
                    1 => (random.next_f32() * 20.0).floor(),
                    _ => 1e-9 * random.next_f32(),
                })
                .collect();
            let mut list: Vec<Option<f32>> = weights.iter().map(|&weight| Some(weight)).collect();
            let mut memory = vec![0xAA; model_bytes(scratch_bytes(N))];
            let mut arena = Arena::new(&mut memory, 0).unwrap();
            let mut queue = FallingQueue::new(&mut weights, N, &mut arena).unwrap();
            for _ in 0..N / 2 {
                for _ in 0..10 {
                    let item = random.next_u32() as usize % N;
                    let by = list[item].unwrap_or(1.0) * random.next_f32() * 0.5;
                    queue.weights()[item] -= by;
                    list[item] = list[item].map(|weight| weight - by);
                }
                let heaviest = (0..N).rev().filter(|&i| list[i].is_some()).max_by(|&a, &b| {
                    let weight = |i: usize| list[i].unwrap();
                    weight(a).partial_cmp(&weight(b)).unwrap()
                });
                assert_eq!(queue.pop(), heaviest);
                list[heaviest.unwrap()] = None;
            }
            assert!(queue.into_items().eq((0..N).filter(|&i| list[i].is_some())));
        }
    }

    #[test]
    fn an_empty_one_has_none() {
        let mut memory = vec![0; model_bytes(scratch_bytes(1))];
        let mut weights = [2.0];
        let mut arena = Arena::new(&mut memory, 0).unwrap();
        let mut queue = FallingQueue::new(&mut weights, 1, &mut arena).unwrap();
        assert_eq!((queue.pop(), queue.pop()), (Some(0), None));
    }
}
