//! The pair of sites that a pose joins.

use super::cost::Cost;

/// An object site on a support site: section II-D.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SiteMatch {
    /// What it costs.
    pub cost: Cost,
    /// Index among [`Object::sites`](crate::hanging::Object::sites).
    pub object_site: u32,
    /// Index among [`Supporter::sites`](crate::hanging::Supporter::sites).
    pub support_site: u32,
    /// Whether the object's hanging direction is laid against the supporter's instead of along it.
    pub is_reversed: bool,
}

impl SiteMatch {
    /// The order of the ranking: by total cost, then by sites, so that it is the same however it is computed.
    pub(super) fn is_better(&self, other: &Self) -> bool {
        let sites = |m: &Self| (m.support_site, m.object_site, m.is_reversed);
        self.cost.total.total_cmp(&other.cost.total).then(sites(self).cmp(&sites(other))).is_lt()
    }
}
