#!/usr/bin/env bash
# Runs the C library on a Cortex-M7 without an operating system, under qemu: from depth images, or from a mesh and a
# cloud, to poses and a path, in 16 MB; and a small configuration in 1 MB. The results must have the stored bits,
# those of a desktop. The archive must need nothing and contain neither an allocator nor an unwinder. aarch64 runs the
# same program.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/embedded/library.sh"
source "$root/scripts/archive.sh"
work=$root/build/embedded
stored=$root/embedded/pairs.txt
# Greatest use of the stack, bytes: what the library promises, and 2 KB of the program and of newlib's printf.
most_stack=$((32 * 1024 + 2048))
mkdir -p "$work"
fail() { echo "embedded: $*" >&2; exit 1; }

"$root/scripts/built.sh"
pairs=${CARGO_TARGET_DIR:-$root/target}/debug/examples/pairs
mkdir -p "$work/16MB" "$work/1MB"
"$pairs" "$work/16MB/pairs.bin" "mug on hook" >"$work/rust.txt"
"$root/embedded/compare.py" "$stored" "$work/rust.txt" "Rust" --part
"$pairs" "$work/1MB/pairs.bin" "on hook, 1 MB" >/dev/null

# ---- the archive stands alone
archive=$(library thumbv7em-none-eabihf)
table=$(symbol_table "$archive")
check_forbidden embedded "$(cut -d ' ' -f 2 <<<"$table" | sort -u)"
undefined=$(undefined_symbols "$table")
[ -z "$undefined" ] || fail "undefined symbols:" $undefined
echo "embedded: the archive has no allocator, no unwinder and no undefined symbols"

# ---- a Cortex-M7 with 16 MB, and with 1 MB for everything but the code
for_cortex_m7 -DLARGE='".large"' "$root/embedded/pairs.c" "$archive" -o "$work/16MB/program"
for_cortex_m7 -DMEMORY="960 * 1024" -Wl,--defsym=ram=1M "$root/embedded/pairs.c" "$archive" -o "$work/1MB/program"
for size in 16MB 1MB; do
    (cd "$work/$size" && on_cortex_m7 program) >"$work/$size/result.txt" 2>&1 ||
        { cat "$work/$size/result.txt" >&2; fail "the Cortex-M7 with $size failed"; }
    "$root/embedded/compare.py" "$stored" "$work/$size/result.txt" "Cortex-M7 with $size" --part
    "$root/embedded/stages.py" "$work/$size/result.txt" $most_stack
done

# ---- aarch64
archive=$(library aarch64-unknown-linux-gnu)
aarch64-linux-gnu-gcc -O2 -D_GNU_SOURCE -I"$root/include" "$root/embedded/pairs.c" -static "$archive" -lm -pthread \
    -o "$work/aarch64"
qemu-aarch64 "$work/aarch64" "$work/16MB/pairs.bin" threads >"$work/aarch64.txt"
"$root/embedded/compare.py" "$stored" "$work/aarch64.txt" "aarch64, two threads" --part
