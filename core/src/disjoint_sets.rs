//! Disjoint sets of numbers: which points or vertices are connected.

/// Sets over the numbers below the length of the memory, in the caller's memory (Galler and Fischer, "An improved
/// equivalence algorithm", 1964). The least number of a set is its name.
pub(crate) struct DisjointSets<'s> {
    /// For each number another one of its set, nearer to the name.
    parents: &'s mut [u32],
}

impl<'s> DisjointSets<'s> {
    /// Every number in a set of its own.
    pub(crate) fn new(parents: &'s mut [u32]) -> Self {
        for (parent, number) in parents.iter_mut().zip(0..) {
            *parent = number;
        }
        Self { parents }
    }

    /// The name of the set that a number is in. Halves the way of later calls.
    pub(crate) fn find(&mut self, mut number: u32) -> u32 {
        while self.parents[number as usize] != number {
            let parent = self.parents[number as usize];
            self.parents[number as usize] = self.parents[parent as usize];
            number = parent;
        }
        number
    }

    /// Makes one set of the sets of two numbers.
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_numbers_have_one_name() {
        let mut parents = [9; 8];
        let mut sets = DisjointSets::new(&mut parents);
        for (a, b) in [(6, 7), (1, 2), (2, 7), (4, 5)] {
            sets.join(a, b);
        }
        let names: Vec<u32> = (0..8).map(|number| sets.find(number)).collect();
        assert_eq!(names, [0, 1, 1, 3, 4, 4, 1, 1]);
    }
}
