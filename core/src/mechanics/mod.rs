//! Rigid-body mechanics: contact, friction, rest poses and stability margins of a released object.
//!
//! One rigid body moves against a fixed supporter. The body is its signed distance field, and the supporter
//! is a set of small surface patches at its points. Each time step solves for the contact impulses.
//! `docs/MECHANICS.md` describes the model.

mod body;
mod clearance;
mod constants;
mod contact;
mod enclosure;
mod fit;
mod frames;
mod gap;
mod kind;
mod margin;
mod motion;
mod neighbourhood;
mod obstacles;
mod odometer;
mod patch;
mod release;
mod settle;
mod solver;
mod support;
#[cfg(test)]
mod tests;
mod touch;
mod unseen;

pub(crate) use body::Body;
pub(crate) use clearance::{first_within, is_closer, is_off_surface, push_off_surface};
pub use constants::GRAVITY;
pub(crate) use constants::{ENOUGH_PLAY, REPRESENTATIVE_SPACING};
pub(crate) use frames::Frames;
pub(crate) use gap::{Gap, fall_over, gap_to_patch};
pub(crate) use kind::kind_of;
pub use kind::{Kind, Kinds};
pub use margin::{Contact, DIRECTIONS, MAX_CONTACTS, Margin};
pub(crate) use margin::{carrying_contacts, lever, margin};
pub(crate) use motion::Settings;
pub(crate) use neighbourhood::Sleep;
pub(crate) use obstacles::{is_clear_of_points, is_clear_of_surface};
pub(crate) use release::release_pose;
pub use settle::Fate;
pub(crate) use settle::{Pull, Settled, play, pulled, settle, settle_watched, swing_out};
pub(crate) use support::{Room, Support};
pub use unseen::Unseen;
pub(crate) use unseen::{Views, unseen};
