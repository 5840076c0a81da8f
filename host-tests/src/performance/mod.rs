//! Inputs and measurements of `make bench`: shapes of any size, files for other programs, growth, and single queries.

pub mod adversarial;
pub mod export;
pub mod growth;
#[cfg(feature = "peers")]
pub mod nanoflann;
pub mod ordinary;
pub mod primitives;
pub mod processor_time;
pub mod refine;
pub mod room;
pub mod stages;
pub mod step;
