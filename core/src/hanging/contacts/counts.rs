//! How much is left after each step of the method.

use crate::hanging::stage::Stage;

/// How much was left on the object after each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ObjectCounts {
    /// Samples whose normal leans towards the centre of mass.
    pub contact_points: usize,
    /// Contact candidates among them.
    pub contacts: usize,
}

/// How much was left on the supporter after each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SupporterCounts {
    /// Points whose normal leans upwards.
    pub contact_points: usize,
    /// Contact candidates among them.
    pub contacts: usize,
}

/// How many poses were left after each step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CandidateCounts {
    /// Poses that lay a contact of the object on one of the supporter.
    pub made: usize,
    /// Those that are clear of the supporter, some after being pushed off it.
    pub clear: usize,
}

/// How much was left after each step of the method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// On the object.
    pub object: ObjectCounts,
    /// On the supporter.
    pub supporter: SupporterCounts,
    /// Of the poses that lay a contact of the object on one of the supporter.
    pub candidates: CandidateCounts,
}

impl Counts {
    /// The first step that left nothing.
    pub(in crate::hanging) fn empty_stage(&self) -> Option<Stage> {
        let steps = [
            (self.object.contacts, Stage::NoContactPoints),
            (self.supporter.contacts, Stage::NoSupport),
            (self.candidates.clear, Stage::AllCollide),
        ];
        steps.iter().find(|(left, _)| *left == 0).map(|(_, stage)| *stage)
    }
}
