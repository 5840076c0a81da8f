# Builds the C library for a target, and programs for a Cortex-M7 that link it; sourced by the scripts of this folder
# and by bench/instructions/run.sh. Needs $root.

# Prints the path of the archive for a target of Rust, by rustup's compiler or by Debian's, which has the source of
# `core`. The archive has what no program loads: the bytes that each function takes of the stack, and the lines of the
# source. FLAGS are further options of rustc.
#   library TARGET [FLAGS]
library() {
    local target=$1 flags="-Z emit-stack-sizes -C debuginfo=line-tables-only ${2:-}"
    local dir=${CARGO_TARGET_DIR:-$root/target}/embedded${2:+/$(tr -c 'a-z0-9\n' _ <<<"$2")} with=()
    local cargo=cargo rustc=rustc
    if ! [ -e "$(rustc --print target-libdir --target "$target" 2>/dev/null)" ]; then
        if ! [ -e /usr/lib/rustlib/src/rust/library/core ]; then
            echo "no Rust compiler for $target: run scripts/setup.sh" >&2
            return 1
        fi
        cargo=/usr/bin/cargo rustc=/usr/bin/rustc
        with=(-Zbuild-std=core -Zbuild-std-features=compiler-builtins-mem)
    fi
    (cd "$root" && RUSTC=$rustc RUSTC_BOOTSTRAP=1 RUSTFLAGS="$flags" "$cargo" rustc --quiet --locked --release -p hangpose-ffi \
        --features archive --crate-type staticlib --target "$target" --target-dir "$dir" "${with[@]}") || return 1
    echo "$dir/$target/release/libhangpose_ffi.a"
}

# Compiles and links a C program for the board mps2-an500 with its own start.
#   for_cortex_m7 [OPTIONS OF GCC] SOURCE... ARCHIVE -o PROGRAM
for_cortex_m7() {
    arm-none-eabi-gcc -O2 -Wall -Wextra -Werror -I"$root/include" -mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 \
        --specs=rdimon.specs -nostartfiles "$root/embedded/cortex_m.c" -T "$root/embedded/mps2-an500.ld" \
        -Wl,--gc-sections -Wl,--no-warn-execstack "$@" -lm
}

# Runs a program on the board, in the folder in which it finds its files. Its clock advances by one nanosecond an
# instruction.
on_cortex_m7() {
    qemu-system-arm -M mps2-an500 -nographic -monitor none -serial none -icount shift=0 \
        -semihosting-config enable=on,target=native -kernel "$1" </dev/null
}
