//! hangpose on a computer with files.

pub mod files;
pub mod parry;
