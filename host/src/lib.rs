//! hangpose on a computer with files.

pub mod files;
