//! Changes inputs at random, the same in every run.

/// SplitMix64 (Steele, Lea and Flood 2014), from a seed.
pub struct Random(pub u64);

impl Random {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `count`; 0 if there is none.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count.max(1) as u64) as usize
    }
}

/// A copy with a few changes: bytes replaced, removed, repeated or swapped with those of `other`, or the end cut off.
pub fn mutated(data: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = data.to_vec();
    for _ in 0..1 + random.below(5) {
        let at = random.below(bytes.len());
        if bytes.is_empty() {
            bytes.push(random.bits() as u8);
            continue;
        }
        match random.below(9) {
            0 => bytes[at] = random.bits() as u8,
            1 => bytes[at] ^= 1 << random.below(8),
            // Numbers and signs matter most in texts.
            2 => bytes[at] = b"0123456789-.eE ,[]{}\"<>/\n"[random.below(25)],
            3 => drop(bytes.remove(at)),
            4 => bytes.truncate(at),
            5 => bytes.insert(at, random.bits() as u8),
            6 => {
                let end = (at + 1 + random.below(32)).min(bytes.len());
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            7 => {
                let from = random.below(other.len());
                let piece = &other[from..(from + 1 + random.below(64)).min(other.len())];
                let end = (at + piece.len()).min(bytes.len());
                bytes.splice(at..end, piece.iter().copied());
            }
            _ => {
                let end = (at + 4).min(bytes.len());
                let extreme = [0_u32, u32::MAX, i32::MAX as u32, 1 << 31][random.below(4)].to_le_bytes();
                bytes[at..end].copy_from_slice(&extreme[..end - at]);
            }
        }
    }
    bytes
}
