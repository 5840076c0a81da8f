//! Writes pairs of objects and supporters to a file for embedded/pairs.c, and prints hashes of what the Rust interface makes
//! of them: `cargo run -p hangpose-ffi --example pairs -- FILE [PART]`. PART is a part of the names of the pairs that count.
//!
//! embedded/pairs.txt has the hashes that each processor, build and interface must find.

mod given;
mod hash;
mod made;
mod predicted;

use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("usage: pairs FILE [PART]")?;
    let part = arguments.next().unwrap_or_default();
    let mut file = BufWriter::new(File::create(file)?);
    for given in made::pairs()?.iter().filter(|pair| pair.name.contains(&part)) {
        for word in given.words() {
            file.write_all(&word.to_le_bytes())?;
        }
        let ([scan, object, supporter, poses, path], count) = predicted::predicted(given)?;
        println!(
            "{scan:<8} {object:<8} {supporter:<8} {poses:<8} {path:<8} {count:>2} poses  {}",
            given.name
        );
    }
    Ok(file.flush()?)
}
