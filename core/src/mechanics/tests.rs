//! Rests, falls and margins with known answers.
