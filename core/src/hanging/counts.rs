//! How much was left after each step of a prediction.

use super::method::SearchCounts;
use super::settling::SettlingCounts;
use super::stage::Stage;

/// How much was left after each step of a prediction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Of the method's search.
    pub search: SearchCounts,
    /// Of the poses that were released.
    pub settling: SettlingCounts,
}

impl Counts {
    /// The step that left nothing. With `settle` the poses that were released count, too.
    pub(super) fn empty_stage(&self, settle: bool) -> Option<Stage> {
        if let Some(stage) = self.search.empty_stage() {
            return Some(if self.settling.outside > 0 { Stage::OutsideRegion } else { stage });
        }
        if !settle || self.settling.probable > 0 {
            return None;
        }
        if self.settling.unseen > 0 {
            return Some(Stage::Unseen);
        }
        if self.settling.sparse > 0 {
            return Some(Stage::TooSparse);
        }
        Some(self.settling.unmet_wish().unwrap_or_else(|| self.settling.failure()))
    }
}

impl SettlingCounts {
    /// The wish for which most poses were dropped.
    fn unmet_wish(&self) -> Option<Stage> {
        let wishes = [
            (self.no_approach, Stage::NoApproach),
            (self.other_kind, Stage::OtherKind),
            (self.in_scene, Stage::InScene),
            (self.outside, Stage::OutsideRegion),
        ];
        let most = wishes.iter().rev().max_by_key(|(count, _)| *count).filter(|(count, _)| *count > 0);
        most.map(|(_, stage)| *stage)
    }

    /// The most frequent way in which released poses failed.
    fn failure(&self) -> Stage {
        let fates = [
            (self.at_rest, Stage::TooLoose),
            (self.rotated_off, Stage::RotatesOff),
            (self.slid_off, Stage::SlidesOff),
            (self.moving, Stage::NeverRests),
        ];
        // Of equally frequent ones the first.
        let most = fates.iter().rev().max_by_key(|(count, _)| *count).filter(|(count, _)| *count > 0);
        most.map_or(Stage::AllCollide, |(_, stage)| *stage)
    }
}
