#!/usr/bin/env bash
# Counts the instructions of each stage of a prediction of the sample mug on the sample hook, under qemu: on x86-64, on
# aarch64 and on a Cortex-M7. Writes OUT, JSON; what is missing is named in it.
#   run.sh OUT
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
out=$(realpath -m "${1:?usage: run.sh OUT}")
here=$root/bench/instructions
work=$root/build/bench/instructions
cargo_dir=${CARGO_TARGET_DIR:-$root/target}/instructions
mkdir -p "$work" "$(dirname "$out")"
cd "$root"
python3 "$here/input.py" samples/mug.obj samples/hook.ply "$work/input.bin"
missing=()

# The C library for a target, by rustup's compiler or Debian's, which has the source of `core`.
library() {
    if rustc --print target-libdir --target "$1" >/dev/null 2>&1 && [ -e "$(rustc --print target-libdir --target "$1")" ]; then
        cargo rustc --quiet --locked --release -p hangpose-ffi --features archive --crate-type staticlib --target "$1" \
            --target-dir "$cargo_dir"
    elif [ -e /usr/lib/rustlib/src/rust/library/core ]; then
        RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 /usr/bin/cargo rustc --quiet --locked --release -p hangpose-ffi \
            --features archive --crate-type staticlib --target "$1" --target-dir "$cargo_dir" -Zbuild-std=core \
            -Zbuild-std-features=compiler-builtins-mem
    else
        return 1
    fi
}

# name, target of Rust, C compiler, emulator, options of the C compiler
count() {
    local name=$1 target=$2 compiler=$3 emulator=$4
    shift 4
    local tool
    for tool in "$compiler" "$emulator"; do
        command -v "$tool" >/dev/null || { missing+=("$name: $tool was not found"); return; }
    done
    library "$target" || { missing+=("$name: no Rust compiler for $target"); return; }
    "$compiler" -O2 -Iinclude "$here/predict.c" "$@" "$cargo_dir/$target/release/libhangpose_ffi.a" -lm -o "$work/$name"
    cd "$work"
    if [ "$name" = cortex-m7 ]; then
        "$emulator" -M mps2-an500 -nographic -monitor none -serial none -icount shift=0 -semihosting-config enable=on,target=native \
            -kernel "$name" </dev/null >"$name.txt" 2>&1
    else
        "$emulator" -plugin ./count.so "$name" >"$name.txt" 2>&1
    fi || { cat "$name.txt" >&2; exit 1; }
    cd "$root"
}

cc -O2 -shared -fPIC "$here/count.c" -o "$work/count.so"
rm -f "$work"/*.txt
count x86-64 x86_64-unknown-linux-gnu gcc qemu-x86_64 -static
count aarch64 aarch64-unknown-linux-gnu aarch64-linux-gnu-gcc qemu-aarch64 -static
count cortex-m7 thumbv7em-none-eabihf arm-none-eabi-gcc qemu-system-arm -mcpu=cortex-m7 -mthumb -mfloat-abi=hard \
    -mfpu=fpv4-sp-d16 --specs=rdimon.specs -nostartfiles "$here/cortex_m.c" -T "$here/mps2-an500.ld"
python3 "$here/result.py" "$work" "$out" "${missing[@]}"
