#!/usr/bin/env bash
# Counts the instructions of each stage of a prediction of the sample mug on the sample hook, under qemu: on x86-64, on
# aarch64 and on a Cortex-M7. Writes OUT, JSON; what is missing is named in it.
#   run.sh OUT
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
out=$(realpath -m "${1:?usage: run.sh OUT}")
source "$root/embedded/library.sh"
here=$root/bench/instructions
work=$root/build/bench/instructions
mkdir -p "$work" "$(dirname "$out")"
cd "$root"
# The sample mug on the sample hook, with each profile, among others.
scripts/built.sh
"${CARGO_TARGET_DIR:-target}/debug/examples/pairs" "$work/pairs.bin" "mug on hook" >/dev/null
missing=()

# name, target of Rust, C compiler, emulator
count() {
    local name=$1 target=$2 compiler=$3 emulator=$4 tool archive
    for tool in "$compiler" "$emulator"; do
        command -v "$tool" >/dev/null || { missing+=("$name: $tool was not found"); return; }
    done
    archive=$(library "$target") || { missing+=("$name: no Rust compiler for $target"); return; }
    if [ "$name" = cortex-m7 ]; then
        for_cortex_m7 -DLARGE='".large"' embedded/pairs.c "$archive" -o "$work/$name"
        (cd "$work" && on_cortex_m7 "$name") >"$work/$name.txt" 2>&1
    else
        "$compiler" -O2 -D_GNU_SOURCE -Iinclude embedded/pairs.c -static "$archive" -lm -pthread -o "$work/$name"
        (cd "$work" && "$emulator" -plugin ./count.so "$name") >"$work/$name.txt" 2>&1
    fi || { cat "$work/$name.txt" >&2; exit 1; }
}

cc -O2 -shared -fPIC -Iembedded "$here/count.c" -o "$work/count.so"
rm -f "$work"/*.txt
count x86-64 x86_64-unknown-linux-gnu gcc qemu-x86_64
count aarch64 aarch64-unknown-linux-gnu aarch64-linux-gnu-gcc qemu-aarch64
count cortex-m7 thumbv7em-none-eabihf arm-none-eabi-gcc qemu-system-arm
python3 "$here/result.py" "$work" "$out" "${missing[@]}"
