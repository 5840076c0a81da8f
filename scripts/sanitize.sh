#!/usr/bin/env bash
# Runs the examples and the tests of the C interface under AddressSanitizer, UndefinedBehaviorSanitizer, ThreadSanitizer and
# valgrind, and calls of the C interface under Miri where it is to be had. The library is instrumented like its callers;
# Rust's checks of arithmetic and of unsafe code stand for UndefinedBehaviorSanitizer in it. Faults that are planted must be
# reported.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
target=${CARGO_TARGET_DIR:-$root/target}
work=$root/build/sanitize
mkdir -p "$work"
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
cd "$root"

say() { echo "sanitize: $*"; }
fail() { echo "sanitize: $*" >&2; exit 1; }
# Runs a command and prints its output only if it fails: quiet NAME COMMAND...
quiet() {
    local log=$work/$1.log
    shift
    "$@" >"$log" 2>&1 || { cat "$log" >&2; fail "failed: $*"; }
}

# ---- the library with Rust's `core` in it, by rustup's compiler or by Debian's, whichever has the source of `core`
cargo=cargo rustc=rustc
if ! [ -e "$(rustc --print sysroot)/lib/rustlib/src/rust/library/core" ]; then
    cargo=/usr/bin/cargo rustc=/usr/bin/rustc
    [ -e /usr/lib/rustlib/src/rust/library/core ] || fail "the source of Rust's core is missing: run scripts/setup.sh trust"
fi
# Prints the path of the archive for a sanitizer. Optimising the whole program at once would take minutes and find no more.
#   instrumented SANITIZER HAS_CHECKS
instrumented() {
    local dir=$target/sanitize/$1 triple=x86_64-unknown-linux-gnu
    RUSTC=$rustc RUSTC_BOOTSTRAP=1 RUSTFLAGS="-Zsanitizer=$1 -Cdebuginfo=line-tables-only" \
        CARGO_PROFILE_RELEASE_LTO=off CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 \
        CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS=$2 CARGO_PROFILE_RELEASE_OVERFLOW_CHECKS=$2 \
        "$cargo" rustc --quiet --locked --release -p hangpose-ffi --features archive --crate-type staticlib \
        --target $triple --target-dir "$dir" -Zbuild-std=core || return 1
    echo "$dir/$triple/release/libhangpose_ffi.a"
}

# ---- Miri, which is a part of nightly compilers only; beside all that follows, as it takes long and needs one core
miri=
if cargo +nightly miri --version >"$work/miri.log" 2>&1; then
    cargo +nightly miri test --locked --target-dir "$target/miri" -p fuzz --features fuzz/miri --test border >"$work/miri.log" 2>&1 &
    miri=$!
fi

# ---- programs: source, and arguments
examples=(
    examples-c/01_static_memory.c "examples-c/02_mesh_file.cpp samples/mug.obj samples/hook.obj" examples-c/03_two_threads.cpp
    examples-c/04_control_loop.cpp examples-c/05_eigen.cpp examples-c/06_every_error.c examples-c/07_depth_images.cpp
    "examples-c/08_plan.cpp samples/mug.obj samples/hook.obj" "examples-c/09_requests.cpp samples/mug.obj samples/mug_tree.obj"
)
tests=(ffi/tests/c/robustness.c ffi/tests/c/threads.cpp ffi/tests/c/wrapper.cpp ffi/tests/c/ros2.cpp)
threaded=(examples-c/03_two_threads.cpp ffi/tests/c/robustness.c examples-c/04_control_loop.cpp ffi/tests/c/threads.cpp
    examples-c/06_every_error.c ffi/tests/c/wrapper.cpp)
missing=$(comm -3 <(ls examples-c/*.c examples-c/*.cpp) <(printf '%s\n' "${examples[@]%% *}" | sort))
[ -z "$missing" ] || fail "examples that are not run:" $missing

# Compiles a program and prints its path: compiled KIND SOURCE OPTIONS...
compiled() {
    local kind=$1 source=$2 compiler="g++ -std=c++17" name
    shift 2
    name=$kind-$(basename "${source%.*}")
    [ "${source##*.}" != c ] || compiler="gcc -std=gnu11"
    quiet "$name" $compiler -g -O1 -Iinclude -Iexamples-c -Iffi/tests/ros2_stand_in $(pkg-config --cflags eigen3) "$source" "$@" \
        -lm -pthread -o "$work/$name"
    echo "$work/$name"
}
# Every second one of the programs, from the one with this index on.
lane() {
    local index=$1 kind=$2 options=$3 runner=$4 source arguments program
    local programs=("${@:5}")
    for (( ; index < ${#programs[@]}; index += 2)); do
        read -r source arguments <<<"${programs[index]}"
        program=$(compiled "$kind" "$source" $options)
        quiet "$(basename "$program")" timeout 600 $runner "$program" $arguments
    done
}
# Compiles and runs programs, two at a time: each KIND OPTIONS RUNNER PROGRAM...
each() {
    lane 1 "$@" &
    local other=$!
    lane 0 "$@"
    wait $other
}
# Fails unless a command fails, with a message about a function of the library: reports NAME MESSAGE COMMAND...
reports() {
    local log=$work/$1.log message=$2
    shift 2
    if "$@" >"$log" 2>&1; then fail "a planted fault was not found: $*"; fi
    { grep -q "$message" "$log" && grep -qE '#[0-9]+ .*hangpose_predict|(by|at) 0x.*hangpose_predict' "$log"; } ||
        { cat "$log" >&2; fail "a planted fault was reported as something else: $*"; }
}

# ---- AddressSanitizer and UndefinedBehaviorSanitizer
archive=$(instrumented address true)
flags="-fsanitize=address,undefined -fno-sanitize-recover=all $archive"
each address "$flags" "" "${examples[@]}" "${tests[@]}"
reports address-planted 'AddressSanitizer: heap-buffer-overflow' "$work/address-threads" beyond
say "${#examples[@]} examples and ${#tests[@]} tests of the border run under ASan and UBSan; $(tail -1 "$work/address-robustness.log")"

# ---- ThreadSanitizer
archive=$(instrumented thread false)
# LLVM calls functions for these that gcc's library lacks; memcpy and the others are its own there.
cat >"$work/tsan.c" <<'C'
#include <string.h>
void *__tsan_memcpy(void *to, const void *from, size_t count) { return memcpy(to, from, count); }
void *__tsan_memmove(void *to, const void *from, size_t count) { return memmove(to, from, count); }
void *__tsan_memset(void *to, int value, size_t count) { return memset(to, value, count); }
C
gcc -O2 -fno-builtin -c "$work/tsan.c" -o "$work/tsan.o"
export TSAN_OPTIONS=halt_on_error=1
each thread "-fsanitize=thread $work/tsan.o $archive" "" "${threaded[@]}"
reports thread-planted 'WARNING: ThreadSanitizer: data race' "$work/thread-threads" race
say "${#threaded[@]} programs with threads run under TSan; $(tail -2 "$work/thread-threads.log" | head -1)"

# ---- valgrind, with the library as users get it; scripts/link.sh runs the invalid callers under it
quiet lib make lib
archive=build/link/libhangpose.a
valgrind="valgrind -q --error-exitcode=9 --fair-sched=yes"
each valgrind "$archive" "$valgrind" "${examples[@]}"
reports valgrind-planted 'Invalid write' $valgrind "$(compiled valgrind ffi/tests/c/threads.cpp "$archive")" beyond
say "${#examples[@]} examples run under valgrind"

if [ -n "$miri" ]; then
    wait $miri || { cat "$work/miri.log" >&2; fail "Miri reported errors"; }
    say "the calls of fuzz/tests/border.rs run under Miri"
else
    say "Miri was NOT run: \`rustup toolchain install nightly --component miri,rust-src\` could not install it here"
fi
