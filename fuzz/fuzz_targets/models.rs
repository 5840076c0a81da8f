//! Meshes and clouds near degeneracy, for libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::models::run(data));
