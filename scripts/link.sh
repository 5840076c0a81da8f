#!/usr/bin/env bash
# Builds and installs the C library and links it from outside the tree in every way that docs/book/build.md describes:
# through CMake and pkg-config, static and shared, with gcc and clang, from the Debian packages, and built from source. The
# command and its packages are tested with it, because the same files install them.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/scripts/archive.sh"
here=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$here"' EXIT
cd "$here"
log=quiet.log

say() { echo "link: $*"; }
fail() { echo "link: $*" >&2; exit 1; }
# Runs a command and prints its output only if it fails.
quiet() { "$@" >"$log" 2>&1 || { cat "$log" >&2; fail "failed: $*"; }; }

# ---- build and install, with a prefix other than that of the build
cp -r "$root/examples-c" "$root/ffi/tests" "$root/samples" .
# The command of the tests stands for the one that `make command` builds with the same sources and more optimisation.
target=${CARGO_TARGET_DIR:-$root/target}
quiet make -C "$root" lib
quiet "$root/scripts/built.sh"
quiet make -C "$root" command install COMMAND="$target/debug/hangpose" DESTDIR="$here/root" PREFIX=/opt/hangpose
prefix=$here/root/opt/hangpose
archive=$prefix/lib/libhangpose.a
shared=$prefix/lib/libhangpose.so

# ---- symbols of the archive and the shared library
table=$(symbol_table "$archive")
check_forbidden link "$(cut -d ' ' -f 2 <<<"$table" | sort -u)"
needed=$(undefined_symbols "$table" | grep -vxE 'mem(cpy|move|set|cmp)|bcmp' || true)
[ -z "$needed" ] || fail "the archive needs symbols other than memcpy, memmove, memset, memcmp and bcmp:" $needed
visible=$(readelf --syms --wide "$archive" | awk '$5 != "LOCAL" && $7 != "UND" && $8 !~ /^hangpose_/ && NF == 8 { print $8 }' |
    grep -vx Name || true)
[ -z "$visible" ] || fail "the archive has global symbols other than hangpose_*:" $visible
# .data.rel.ro is read-only after loading. Any other data section would be mutable state.
mutable=$(size -A "$archive" | awk '$1 ~ /^\.(data|bss|tdata|tbss)/ && $1 !~ /^\.data\.rel\.ro/ && $2 > 0 { print $1, $2 }')
[ -z "$mutable" ] || fail "the archive has mutable state:" $mutable
abi=$(sed -n 's/^#define HANGPOSE_ABI_VERSION //p' "$prefix/include/hangpose.h")
readelf -d "$shared" | grep -q "SONAME.*\[libhangpose.so.$abi\]" || fail "the SONAME is not libhangpose.so.$abi"
say "libhangpose.a has no allocator, no unwinding, no mutable state, and no global symbols other than hangpose_*"

# ---- flags, as a Makefile takes them from pkg-config
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
flags=$(pkg-config --cflags hangpose)
libs=$(pkg-config --libs hangpose)
static_libs="-Wl,-Bstatic $libs -Wl,-Bdynamic $(pkg-config --static --libs-only-l hangpose | sed 's/-lhangpose//')"
warnings="-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror"

# ---- invalid callers under valgrind, which takes long and needs one core: beside all that follows
caller="-std=gnu11 -g -O1 $flags -Iexamples-c tests/c/robustness.c $static_libs -lm -pthread"
quiet gcc $caller -o robustness
valgrind -q --error-exitcode=9 --fair-sched=yes ./robustness >valgrind.log 2>&1 &
valgrind=$!

# ---- the examples, through CMake
examples=(01_static_memory "02_mesh_file samples/mug.obj samples/hook.obj" 03_two_threads 04_control_loop 05_eigen 06_every_error
    07_depth_images "08_plan samples/mug.obj samples/hook.obj" "09_requests samples/mug.obj samples/mug_tree.obj")
run_examples() {
    local example
    for example in "${examples[@]}"; do quiet "$1"/$example; done
}
# The objects are the same for both libraries, so they are compiled once and linked twice.
for compilers in "gcc g++" "clang clang++"; do
    read -r cc cxx <<<"$compilers"
    for is_shared in OFF ON; do
        quiet cmake -S examples-c -B build-$cc -DCMAKE_PREFIX_PATH="$prefix" -DBUILD_SHARED_LIBS=$is_shared \
            -DCMAKE_C_COMPILER=$cc -DCMAKE_CXX_COMPILER=$cxx -DCMAKE_C_FLAGS=-Werror \
            -DCMAKE_CXX_FLAGS="-Werror -fno-exceptions -fno-rtti" -DCMAKE_C_EXTENSIONS=OFF -DCMAKE_CXX_EXTENSIONS=OFF
        quiet cmake --build build-$cc --parallel 2
        has_shared=$(readelf -d build-$cc/01_static_memory | grep -q 'libhangpose.so' && echo ON || echo OFF)
        [ $has_shared = $is_shared ] || fail "BUILD_SHARED_LIBS=$is_shared links the other library"
        run_examples build-$cc
    done
    say "all examples run, built through CMake with $cc, static and shared"
done

# ---- every standard; each compiler beside the other
echo '#include <hangpose.h>' >header.c
cp header.c header.cpp
in_c() {
    for std in c99 c11 c17; do
        quiet $1 -std=$std $warnings $flags -c header.c -o header-$1.o
        quiet $1 -std=$std $warnings $flags examples-c/01_static_memory.c $static_libs -lm -o 01-$1
        quiet ./01-$1
    done
}
in_cpp() {
    local strict="$warnings -fno-exceptions -fno-rtti"
    for std in c++17 c++20; do
        quiet $1 -std=$std $strict $flags -c header.cpp -o header-$1.o
        for test in wrapper ros2; do
            quiet $1 -std=$std $strict $flags -Iexamples-c -Itests/ros2_stand_in tests/c/$test.cpp $static_libs -pthread -o $test-$1
            quiet ./$test-$1
        done
    done
}
(log=gcc.log; in_c gcc; in_cpp g++) &
gcc=$!
(log=clang.log; in_c clang; in_cpp clang++)
wait $gcc
quiet gcc $flags examples-c/01_static_memory.c $libs -lm -o 01-shared
quiet env LD_LIBRARY_PATH="$prefix/lib" ./01-shared
say "hangpose.h compiles as C99, C11, C17 and C++, hangpose.hpp, hangpose/ros2.hpp and hangpose/second_thread.hpp as C++17 and C++20, through" \
    "pkg-config, static and shared"

# ---- invalid callers, and the C++ headers, under sanitizers
sanitize="-fsanitize=address,undefined -fno-sanitize-recover=all"
cpp_sanitized() {
    quiet g++ -std=c++17 -g $sanitize $flags -Iexamples-c -Itests/ros2_stand_in tests/c/$1.cpp $static_libs -pthread -o $1-sanitized
    quiet ./$1-sanitized
}
(log=sanitized.log; cpp_sanitized wrapper; cpp_sanitized ros2) &
sanitized=$!
quiet gcc $sanitize $caller -o sanitized
quiet ./sanitized
say "robustness under ASan and UBSan: $(tail -1 quiet.log)"
wait $sanitized

# ---- a caller with floating-point traps; without masking them it must be stopped, or the test would say nothing
quiet gcc -std=gnu11 $warnings $flags -Iexamples-c tests/c/traps.c $static_libs -lm -o traps
quiet ./traps
if { ./traps unmasked; } >traps.log 2>&1; then fail "no trap stops a caller that does not mask them"; fi
say "traps: $(./traps)"

# ---- a header of another version links but is refused at run time; CMake does not find another version
cp -r "$prefix/include" other-include
sed -i 's/#define HANGPOSE_ABI_VERSION .*/#define HANGPOSE_ABI_VERSION 999/' other-include/hangpose.h
quiet gcc -Iother-include examples-c/01_static_memory.c "$archive" -lm -o other-c
quiet g++ -std=c++17 -Iother-include examples-c/02_mesh_file.cpp "$archive" -o other-cpp
for program in ./other-c "./other-cpp samples/mug.obj samples/hook.obj"; do
    if $program >other.log 2>&1; then fail "a header of another version was accepted: $program"; fi
    grep -q "compiled for version 999" other.log || fail "the message does not name the other version: $(cat other.log)"
done
sed 's/find_package(hangpose 0.1 REQUIRED)/find_package(hangpose 99 REQUIRED)/' "$root/examples-c/CMakeLists.txt" \
    >examples-c/CMakeLists.txt
if cmake -S examples-c -B build-other -DCMAKE_PREFIX_PATH="$prefix" >other.log 2>&1; then
    fail "find_package(hangpose 99) accepts version 0.1"
fi
cp "$root/examples-c/CMakeLists.txt" examples-c/
say "a header of another version is refused: $(./other-c 2>&1 || true)"

# ---- the binary interface is the stored one; a header with another struct or constant is found out
say "$("$root/scripts/abi.sh" "$shared")"
for change in 's/^  uint32_t settle_attempts;/  float settle_attempts;/' 's/^#define HANGPOSE_REJECTED .*/#define HANGPOSE_REJECTED 99/'; do
    sed "$change" "$prefix/include/hangpose.h" >changed.h
    if HANGPOSE_HEADER=changed.h "$root/scripts/abi.sh" "$shared" >abi.log 2>&1; then fail "abi.sh overlooks: $change"; fi
    grep -q "settle_attempts\|HANGPOSE_REJECTED was" abi.log || fail "abi.sh does not name the change: $(cat abi.log)"
done

# ---- the C call, in C memory, gives the same bits as the Rust call
"$target/debug/examples/pairs" pairs.bin >rust.txt
quiet gcc -O2 -D_GNU_SOURCE $flags "$root/embedded/pairs.c" $static_libs -pthread -lm -o pairs
./pairs pairs.bin threads >c.txt
for who in rust c; do
    quiet "$root/embedded/compare.py" "$root/embedded/pairs.txt" $who.txt "$who"
    say "$(cat quiet.log)"
done

# ---- links beside another Rust archive that has std; and with --gc-sections
cat >other.rs <<'RUST'
#[unsafe(no_mangle)]
pub extern "C" fn other(count: u32) -> u32 {
    std::panic::catch_unwind(|| (0..count).map(|i| i.to_string()).collect::<Vec<_>>().concat().len() as u32).unwrap_or(0)
}
RUST
quiet rustc --edition 2024 --crate-type staticlib -O other.rs -o libother.a
cat >both.c <<'C'
#include <hangpose.h>
#include <stdio.h>
uint32_t other(uint32_t count);
int main(void) { return printf("%s %u\n", hangpose_version(), (unsigned)other(12)) < 0 || other(12) != 14; }
C
whole="-Wl,--whole-archive $archive -Wl,--no-whole-archive"
for order in "$whole libother.a" "libother.a $whole"; do
    quiet gcc $flags both.c $order -lpthread -ldl -lm -lgcc_s -o both
    quiet ./both
done
quiet gcc -O2 -ffunction-sections -fdata-sections $flags examples-c/01_static_memory.c "$archive" -lm -Wl,--gc-sections -o small
quiet ./small
strip small
say "links beside a Rust archive that has std, and with --gc-sections"
say "a stripped C program that predicts (01, static): $(stat -c %s small) bytes; code and constants of libhangpose.a:" \
    "$(size "$archive" | awk 'NR == 2 { print $1 + $2 }') bytes"

# ---- the command and the Debian packages
installed() {
    [ "$($1/bin/hangpose --version)" = "hangpose $2" ] || fail "$1/bin/hangpose does not run"
    bash -c "source $1/share/bash-completion/completions/hangpose && complete -p hangpose" >/dev/null ||
        fail "the completions of bash do not load"
    for file in share/zsh/$3/_hangpose share/fish/vendor_completions.d/hangpose.fish; do
        grep -q predict $1/$file || fail "$1/$file has no completions"
    done
    for page in hangpose hangpose-predict; do
        gzip -dc $1/share/man/man1/$page.1.gz | grep -q '^\.TH' || fail "$page.1.gz is no man page"
    done
}
version=$(pkg-config --modversion hangpose)
installed "$prefix" $version site-functions
quiet make -C "$root" deb COMMAND="$target/debug/hangpose"
for package in libhangpose$abi libhangpose-dev hangpose; do
    file=$root/build/${package}_${version}_$(dpkg --print-architecture).deb
    dpkg-deb -x "$file" debian
    say "$package depends on $(dpkg-deb -f "$file" Depends)"
done
installed debian/usr $version vendor-completions
libdir=$(dirname "$(find debian/usr -name libhangpose.a)")
quiet env PKG_CONFIG_PATH="$here/$libdir/pkgconfig" sh -c \
    'gcc $(pkg-config --cflags hangpose) examples-c/01_static_memory.c $(pkg-config --libs hangpose) -lm -o 01-debian'
quiet env LD_LIBRARY_PATH="$here/$libdir" ./01-debian
quiet cmake -S examples-c -B build-debian -DCMAKE_PREFIX_PATH="$here/debian/usr"
quiet cmake --build build-debian --target 02_mesh_file
quiet build-debian/02_mesh_file samples/mug.obj samples/hook.obj
grep -q '<name>hangpose</name>' debian/usr/share/hangpose/package.xml || fail "the Debian packages have no package.xml"
say "the Debian packages link, and the command has completions and man pages"

# ---- built from source in another project
cargo_dir=$target/link
for how in add_subdirectory FetchContent; do
    for is_shared in OFF ON; do
        dir=build-$how
        quiet cmake -S tests/cmake -B $dir -DHOW=$how -DHANGPOSE_SOURCE="$root" -DHANGPOSE_CARGO_DIR="$cargo_dir" \
            -DBUILD_SHARED_LIBS=$is_shared
        quiet cmake --build $dir --parallel 2
        quiet $dir/in_c
        quiet $dir/in_cpp samples/mug.obj samples/hook.obj
    done
done
say "builds from source through add_subdirectory and FetchContent, static and shared"

wait $valgrind || { cat valgrind.log >&2; fail "valgrind reported errors"; }
say "robustness under valgrind: $(tail -1 valgrind.log)"
