//! Hashes of the bits of numbers.

/// FNV-1a over little-endian words of 32 bits, as in embedded/pairs.c.
pub(crate) struct Hash(u32);

impl Hash {
    pub(crate) fn new() -> Self {
        Self(0x811c_9dc5)
    }

    pub(crate) fn words(&mut self, words: impl IntoIterator<Item = u32>) {
        for byte in words.into_iter().flat_map(u32::to_le_bytes) {
            self.0 = (self.0 ^ u32::from(byte)).wrapping_mul(0x0100_0193);
        }
    }

    pub(crate) fn floats<'a>(&mut self, numbers: impl IntoIterator<Item = &'a f32>) {
        self.words(numbers.into_iter().map(|x| x.to_bits()));
    }

    pub(crate) fn rows(&mut self, rows: &[[f32; 3]]) {
        self.floats(rows.as_flattened());
    }

    pub(crate) fn text(&self) -> String {
        format!("{:08x}", self.0)
    }
}
