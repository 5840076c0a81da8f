#!/usr/bin/env bash
# Tests that models, scans, poses and paths of all pairs have the same bits, those of embedded/pairs.txt: in Rust and
# C; on x86-64 (debug, release, and tuned to this processor), aarch64 and a Cortex-M7; with one and with two threads.
#   same_bits.sh [--write]      --write stores the bits of the Rust interface instead
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/embedded/library.sh"
work=$root/build/embedded
stored=$root/embedded/pairs.txt
mkdir -p "$work"

"$root/scripts/built.sh"
"${CARGO_TARGET_DIR:-$root/target}/debug/examples/pairs" "$work/pairs.bin" >"$work/rust.txt"
if [ "${1:-}" = --write ]; then
    cp "$work/rust.txt" "$stored"
    exit
fi
"$root/embedded/compare.py" "$stored" "$work/rust.txt" "Rust, debug"

# name, target of Rust, C compiler, what runs the program, options of rustc
run() {
    local name=$1 target=$2 compiler=$3 runner=$4 flags=${5:-} archive threads
    archive=$(library "$target" "$flags")
    $compiler -O2 -D_GNU_SOURCE -I"$root/include" "$root/embedded/pairs.c" -static "$archive" -lm -pthread -o "$work/$name"
    for threads in "" threads; do
        (cd "$work" && $runner "./$name" pairs.bin $threads) >"$work/$name.txt"
        "$root/embedded/compare.py" "$stored" "$work/$name.txt" "C, $name${threads:+, two threads}"
    done
}
run x86-64 x86_64-unknown-linux-gnu gcc ""
run x86-64-native x86_64-unknown-linux-gnu gcc "" "-C target-cpu=native"
run aarch64 aarch64-unknown-linux-gnu aarch64-linux-gnu-gcc qemu-aarch64
for_cortex_m7 -DLARGE='".large"' "$root/embedded/pairs.c" "$(library thumbv7em-none-eabihf)" -o "$work/cortex-m7"
(cd "$work" && on_cortex_m7 cortex-m7) >"$work/cortex-m7.txt" 2>&1 || { cat "$work/cortex-m7.txt" >&2; exit 1; }
"$root/embedded/compare.py" "$stored" "$work/cortex-m7.txt" "C, Cortex-M7"
grep ^most "$work/cortex-m7.txt"
