//! Causes for which poses fail, as the tables name them.

use serde::{Deserialize, Serialize};

/// Cause for which the best pose of a scan fails.
#[derive(Clone, Copy, Debug, Deserialize, Eq, Hash, Ord, PartialEq, PartialOrd, Serialize)]
pub enum Loss {
    /// No pose was found.
    NotFound,
    /// The shapes collide, or are stuck in each other, where the scan shows no surface.
    Unseen,
    /// The shapes collide, or are stuck in each other, although the scan shows both surfaces there.
    Inexact,
    /// The object falls.
    Falls,
    /// The object has not fallen, but swings or is off the supporter when the time is up.
    Moves,
}

impl Loss {
    /// All causes.
    pub const ALL: [Self; 5] = [Self::NotFound, Self::Unseen, Self::Inexact, Self::Falls, Self::Moves];

    /// Name in the tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::NotFound => "no pose found",
            Self::Unseen => "collides, unseen",
            Self::Inexact => "collides, seen",
            Self::Falls => "falls",
            Self::Moves => "still moves",
        }
    }
}
