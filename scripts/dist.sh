#!/usr/bin/env bash
# Builds a release in build/dist/: the crates, archives of the C library for x86-64 and aarch64 and of the command for
# x86-64, the Debian packages, the wheel if there is one, and SHA256SUMS. The same commit gives the same names and, with
# the same tools, the same bytes.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
work=$root/build/dist-work
dist=$root/build/dist
say() { echo "dist: $*"; }
fail() { echo "dist: $*" >&2; exit 1; }

version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
for file in package.xml ros2/package.xml; do
    grep -q "<version>$version</version>" $file || fail "$file has not the version $version of Cargo.toml"
done
# All files have the time of the commit, and no file has a path of this machine.
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH TZ=UTC LC_ALL=C
umask 022
export CARGO_TARGET_DIR=$work/cargo
# Where the toolchain has the source of the standard library, messages name its files.
RUSTFLAGS="--remap-path-prefix=$root=hangpose --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo"
RUSTFLAGS+=" --remap-path-prefix=$(rustc --print sysroot)=rust"
export RUSTFLAGS
rm -rf "$dist"
mkdir -p "$dist" "$work"
# Only what cargo built is kept from an earlier run.
find "$work" -mindepth 1 -maxdepth 1 ! -name cargo -exec rm -rf {} +

# ---- crates, each built from its package
scripts/packages.sh --verify
cp "$CARGO_TARGET_DIR"/package/*-"$version".crate "$dist/"

# ---- the command
cargo build --locked --release -p hangpose
command=$CARGO_TARGET_DIR/release/hangpose

# ---- archives
# Installs the project, configured with these arguments, and packs it under this name.
pack() {
    local name=hangpose-$version-linux-$1 crate=$2 target=$3
    shift 3
    cmake -S . -B "$work/$name" -DCMAKE_INSTALL_LIBDIR=lib -DHANGPOSE_CARGO_DIR="$CARGO_TARGET_DIR/link" \
        "$@" >"$work/$name.log"
    cmake --build "$work/$name"
    [ "$crate" != hangpose ] || cmake --build "$work/$name" --target hangpose_command
    cmake --install "$work/$name" --prefix "$work/stage/$name" >>"$work/$name.log"
    cp LICENSE-MIT LICENSE-APACHE README.md CHANGELOG.md "$work/stage/$name/"
    scripts/licences.py "$crate" "$target" >"$work/stage/$name/LICENCES-OF-CRATES"
    tar -C "$work/stage" --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner \
        --format=gnu -cf - "$name" | gzip --best --no-name >"$dist/$name.tar.gz"
}
pack x86_64 hangpose x86_64-unknown-linux-gnu -DHANGPOSE_COMMAND="$command"
rust=aarch64-unknown-linux-gnu
cross="-DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc"
if command -v rustup >/dev/null && rustup target list --installed | grep -qx $rust; then
    pack aarch64 hangpose-ffi $rust -DHANGPOSE_CARGO_TARGET=$rust $cross
elif [ -e /usr/lib/rustlib/src/rust/library/core ]; then
    # Debian ships the source of `core`, which is all that the library needs, but no build for this target.
    RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 CARGO_UNSTABLE_BUILD_STD=core \
        pack aarch64 hangpose-ffi $rust -DHANGPOSE_CARGO_TARGET=$rust $cross -DCARGO=/usr/bin/cargo
else
    fail "no Rust compiler for $rust: run scripts/setup.sh dist"
fi

# ---- the archives give the same result on both processors
for arch in x86_64 aarch64; do
    mkdir "$work/$arch"
    tar -C "$work/$arch" --strip-components=1 -xzf "$dist/hangpose-$version-linux-$arch.tar.gz"
    $arch-linux-gnu-gcc -O2 -static -I"$work/$arch/include" examples-c/01_static_memory.c \
        "$work/$arch/lib/libhangpose.a" -lm -o "$work/$arch/01"
done
"$work/x86_64/01" >"$work/x86_64/result"
qemu-aarch64 "$work/aarch64/01" >"$work/aarch64/result"
cmp "$work/x86_64/result" "$work/aarch64/result" || fail "the processors give different results, see above"
say "x86-64 and, under qemu, aarch64: $(cat "$work/aarch64/result")"
# What the archive for x86-64 contains is linked and run through its own files of CMake.
cmake -S examples-c -B "$work/examples" -DCMAKE_PREFIX_PATH="$work/x86_64" >"$work/examples.log"
cmake --build "$work/examples" --target 02_mesh_file >>"$work/examples.log"
"$work/examples/02_mesh_file" samples/mug.obj samples/hook.obj >>"$work/examples.log"
"$work/x86_64/bin/hangpose" predict --object samples/mug.obj --supporter samples/hook.ply --top 1

# ---- Debian packages
cmake -S . -B "$work/deb" -DCMAKE_INSTALL_PREFIX=/usr -DHANGPOSE_CARGO_DIR="$CARGO_TARGET_DIR/link" \
    -DHANGPOSE_COMMAND="$command" >"$work/deb.log"
cmake --build "$work/deb" --target all hangpose_command
(cd "$work/deb" && cpack -B "$dist" >>"$work/deb.log" && rm -rf "$dist/_CPack_Packages")

# ---- the wheel
if [ -x scripts/wheel.sh ]; then
    scripts/wheel.sh "$dist"
fi

# ---- no path of this machine, and the sums
for path in "$HOME/" "$root"; do
    found=$(grep -rlF "$path" "$work/stage" || true)
    [ -z "$found" ] || fail "a path of this machine is in:" $found
done
(cd "$dist" && sha256sum -- * >SHA256SUMS && cat SHA256SUMS)
