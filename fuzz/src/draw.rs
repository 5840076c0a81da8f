//! Numbers drawn from the bytes of an input, so that a small change of the input is a small change of the case.

/// The bytes of an input that are left. When there are none, every byte is zero, which every choice takes for its plainest
/// case.
pub(crate) struct Draw<'a>(&'a [u8]);

/// Numbers at which arithmetic breaks first.
const ODD: [f32; 16] = [
    0.0,
    -0.0,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    1e-45,
    1e-20,
    1e20,
    1e6,
    -1e6,
    1_000_001.0,
    f32::EPSILON,
    1e-7,
];

impl<'a> Draw<'a> {
    /// Draws from all of `data`.
    pub(crate) fn new(data: &'a [u8]) -> Self {
        Self(data)
    }

    /// Whether nothing is left.
    pub(crate) fn is_done(&self) -> bool {
        self.0.is_empty()
    }

    /// All that is left.
    pub(crate) fn rest(self) -> &'a [u8] {
        self.0
    }

    /// A byte.
    pub(crate) fn byte(&mut self) -> u8 {
        let (first, rest) = self.0.split_first().unwrap_or((&0, &[]));
        self.0 = rest;
        *first
    }

    /// Four bytes.
    pub(crate) fn word(&mut self) -> u32 {
        u32::from_le_bytes([self.byte(), self.byte(), self.byte(), self.byte()])
    }

    /// A number below `count`, which is not zero.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        let drawn = match count {
            0..=256 => usize::from(self.byte()),
            _ => usize::from(self.byte()) | usize::from(self.byte()) << 8,
        };
        drawn % count
    }

    /// True in one of `count` cases.
    pub(crate) fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == count - 1
    }

    /// One of the choices.
    pub(crate) fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// A number from -1 to 1, in steps that meet 0, 1 and each other often.
    pub(crate) fn share(&mut self) -> f32 {
        f32::from(self.byte() as i8) / 128.0
    }

    /// Three of them.
    pub(crate) fn shares(&mut self) -> [f32; 3] {
        [self.share(), self.share(), self.share()]
    }

    /// A number from 0 to 1.
    pub(crate) fn part(&mut self) -> f32 {
        f32::from(self.byte()) / 255.0
    }

    /// Any number: mostly of the size of lengths in metres, at times with any bits, or one at which arithmetic breaks.
    pub(crate) fn number(&mut self) -> f32 {
        match self.byte() % 8 {
            0..=4 => self.share(),
            5 => 1e-3 * self.share(),
            6 => f32::from_bits(self.word()),
            _ => self.pick(&ODD),
        }
    }

    /// `usual` in most cases, else any number.
    pub(crate) fn or_number(&mut self, usual: f32) -> f32 {
        if self.one_in(24) { self.number() } else { usual }
    }

    /// A number from 0 to `most` in most cases, else any number.
    pub(crate) fn up_to(&mut self, most: f32) -> f32 {
        let usual = most * self.part();
        self.or_number(usual)
    }

    /// Three numbers from `-most` to `most` in most cases, else any numbers.
    pub(crate) fn place(&mut self, most: f32) -> [f32; 3] {
        self.shares().map(|x| self.or_number(most * x))
    }
}
