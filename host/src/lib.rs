//! hangpose on a computer with files.
