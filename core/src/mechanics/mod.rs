//! What gravity does to an object that is let go: contact, friction, rest, and how firmly it stays.
//!
//! One rigid body against a supporter that stands still. The body is its signed distance field, the supporter its
//! points, each a small patch of surface; a step solves for the impulses at their contacts.

mod body;
mod clearance;
mod contact;
mod fit;
mod margin;
mod motion;
mod neighbourhood;
mod odometer;
mod patch;
mod release;
mod settle;
mod solver;
mod support;
#[cfg(test)]
mod tests;
mod touch;

pub(crate) use body::Body;
pub(crate) use clearance::{first_within, is_off_surface};
pub use margin::{Contact, DIRECTIONS, MAX_CONTACTS, Margin};
pub(crate) use margin::{Firmness, firmness};
pub(crate) use motion::Settings;
pub(crate) use neighbourhood::Sleep;
pub(crate) use release::release_pose;
pub use settle::Fate;
pub(crate) use settle::{Settled, comes_free, settle, swing_out};
pub(crate) use support::{Room, Support};

/// Standard gravity, m/s².
pub const GRAVITY: f32 = 9.81;
