//! Where and how to hang an object that a robot has never seen on a supporter that it has never seen.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod geometry;
