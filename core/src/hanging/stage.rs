//! The step of a prediction that left nothing.

/// The step that left nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Stage {
    /// Nowhere does the object's surface face its centre of mass, or only in specks: eqs. (3) and (4).
    NoContactPoints,
    /// No contact point has free space below it for a supporter.
    NoFreeSpace,
    /// The free spaces are open to the side, so that a supporter would slip out: eq. (6).
    NotEncircled,
    /// Nothing on the supporter faces up and holds together: section II-C.
    NoSupport,
    /// The supporter is too thick for every free space of the object.
    TooThick,
    /// Every pose runs the supporter through the object.
    AllCollide,
    /// Most released poses rotate and fall off.
    RotatesOff,
    /// Most released poses slide off or fall through.
    SlidesOff,
    /// Most released poses do not come to rest in time.
    NeverRests,
    /// Released poses come to rest, but too loosely to be given, or wedged, or with no room for a release pose near by.
    TooLoose,
    /// Released poses come to rest firmly enough, but too much of what would carry or be in the way was not seen by any camera
    /// ([`Unseen`](crate::mechanics::Unseen)).
    Unseen,
    /// The region that was asked for has no place to hang on or by, or poses come to rest outside of it
    /// ([`Request::on`](super::Request::on), [`Request::by`](super::Request::by)).
    OutsideRegion,
    /// Poses collide with the scene or with objects that hang already.
    InScene,
    /// Poses stay, but hang in another way than those that are allowed ([`Request::allow`](super::Request::allow)).
    OtherKind,
    /// Poses stay, but no straight way in the direction that was asked for leads to them
    /// ([`Request::approach`](super::Request::approach)).
    NoApproach,
    /// Released poses come to rest firmly enough, but where the supporter would carry its points are so far apart that they hardly tell its
    /// shape.
    TooSparse,
}

impl core::fmt::Display for Stage {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::NoContactPoints => {
                "the object has no surface that faces its centre of mass and could rest on a support"
            }
            Self::NoFreeSpace => "the object has no free space for a supporter beside its contact points",
            Self::NotEncircled => {
                "the object encloses none of its free spaces, so a supporter would slip out"
            }
            Self::NoSupport => "the supporter has no part that faces up",
            Self::TooThick => {
                "every part of the supporter that faces up is too thick for the object's free spaces"
            }
            Self::AllCollide => "in every pose the supporter penetrates the object",
            Self::RotatesOff => "no released pose stays: most often the object rotates off",
            Self::SlidesOff => "no released pose stays: most often the object slides off or falls through",
            Self::NeverRests => "no released pose stays: most often the object is still moving when the time is up",
            Self::TooLoose => "no released pose stays: most often the object is wedged where it rests, or a small disturbance brings it down",
            Self::Unseen => "poses stay only if what no camera has seen is as it is guessed, which is not likely enough: another view of the object or of the supporter would help",
            Self::OutsideRegion => "the object could hang only outside the region that was asked for, or the region has no place to hang on or by",
            Self::InScene => "every pose touches the scene or an object that hangs already",
            Self::OtherKind => "poses stay, but none hangs in a way that was allowed",
            Self::NoApproach => "poses stay, but no straight way in the direction that was asked for leads to any of them",
            Self::TooSparse => "poses stay, but the supporter's points are too far apart to tell its shape: points at most 8 mm apart would help",
        })
    }
}
