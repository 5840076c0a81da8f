#!/usr/bin/env bash
# Installs the missing tools of `make test` and `make demo`, and with the argument `dist`, `bench`, `profile`, `fuzz` or `trust` those
# of that target of make, too. Quick if nothing is missing.
set -euo pipefail

as_root() {
    if [ "$(id -u)" = 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        return 1
    fi
}

apt() {
    if ! command -v apt-get >/dev/null || ! as_root true 2>/dev/null; then
        echo "setup: cannot install packages here; please install: $*" >&2
        echo "setup: on Debian: apt-get update && apt-get install --no-install-recommends $*" >&2
        exit 1
    fi
    as_root apt-get update -qq
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

missing=()
# The linker for the host, and readelf and size for the archive.
command -v cc >/dev/null || missing+=(gcc libc6-dev)
command -v readelf >/dev/null || missing+=(binutils)
# The physics engines that test the poses, and the tools that find and compile them.
command -v c++ >/dev/null || missing+=(g++)
command -v pkg-config >/dev/null || missing+=(pkg-config)
pkg-config --exists bullet 2>/dev/null || missing+=(libbullet-dev)
pkg-config --exists ode 2>/dev/null || missing+=(libode-dev)
# The planner that ours is compared with.
pkg-config --exists ompl 2>/dev/null || missing+=(libompl-dev)
# The tools that build and package the C library, and the compilers and checkers of its tests.
command -v cmake >/dev/null || missing+=(cmake)
command -v make >/dev/null || missing+=(make)
command -v clang++ >/dev/null || missing+=(clang)
command -v valgrind >/dev/null || missing+=(valgrind libc6-dbg)
command -v dpkg-shlibdeps >/dev/null || missing+=(dpkg-dev)
command -v file >/dev/null || missing+=(file)
pkg-config --exists eigen3 2>/dev/null || missing+=(libeigen3-dev)
# The comparison of the binary interface with the stored one.
command -v abidiff >/dev/null || missing+=(abigail-tools)
# The tools that build and test the page of viewer/, from Node.js 18 on.
command -v node >/dev/null || missing+=(nodejs)
command -v npm >/dev/null || missing+=(npm)
command -v chromium >/dev/null || command -v chromium-browser >/dev/null || command -v google-chrome >/dev/null ||
    missing+=(chromium)
# The terminal of the tests of the command, and the queue of scripts/slurm_test.sh, whose daemons users have not in their PATH.
command -v script >/dev/null || missing+=(bsdutils)
has_daemon() { command -v "$1" >/dev/null || [ -x "/usr/sbin/$1" ]; }
{ has_daemon slurmctld && has_daemon slurmd && command -v sbatch >/dev/null; } || missing+=(slurm-wlm)
has_daemon munged || missing+=(munge)

# The Python module with its tests, the tools of the book, colcon and the comparisons.
command -v python3 >/dev/null || missing+=(python3)
python3 -c 'import ensurepip, venv' 2>/dev/null || missing+=(python3-venv)

if command -v rustup >/dev/null; then
    have=$(rustup component list --installed)
    for component in rustfmt clippy; do
        case $have in *"$component"*) ;; *) rustup component add "$component" ;; esac
    done
fi
if ! command -v cargo >/dev/null; then
    echo "setup: cargo was not found: install Rust 1.89 or later with rustfmt and clippy (rustup.rs)" >&2
    exit 1
fi

# The C compilers and the emulators for a Cortex-M and for aarch64.
targets=(thumbv7em-none-eabihf aarch64-unknown-linux-gnu)
command -v arm-none-eabi-gcc >/dev/null || missing+=(gcc-arm-none-eabi libnewlib-arm-none-eabi)
command -v qemu-system-arm >/dev/null || missing+=(qemu-system-arm)
command -v aarch64-linux-gnu-gcc >/dev/null || missing+=(gcc-aarch64-linux-gnu libc6-dev-arm64-cross)
command -v qemu-aarch64 >/dev/null || missing+=(qemu-user)
# The stack that each function takes.
command -v llvm-readelf >/dev/null || missing+=(llvm)

# The peer for nearest neighbours.
if [ "${1:-}" = bench ]; then
    pkg-config --exists nanoflann 2>/dev/null || missing+=(libnanoflann-dev)
    command -v taskset >/dev/null || missing+=(util-linux)
fi
if [ "${1:-}" = profile ]; then
    command -v perf >/dev/null || missing+=(linux-perf)
fi

# Bare metal and aarch64: rustup's targets if they are available, else Debian's compiler with the source of `core`.
# Debian's compiler is in /usr/bin; rustup's comes first in the PATH.
for target in "${targets[@]}"; do
    if ! { command -v rustup >/dev/null && rustup target list --installed | grep -qx "$target"; } &&
        ! { command -v rustup >/dev/null && rustup target add "$target" >/dev/null 2>&1; } &&
        ! [ -e /usr/lib/rustlib/src/rust/library/core -a -x /usr/bin/rustc -a -x /usr/bin/cargo ]; then
        missing+=(rustc-web cargo-web rust-web-src)
    fi
done

# The source of Rust's core, which the sanitizers instrument with the library.
if [ "${1:-}" = trust ] && ! [ -e "$(rustc --print sysroot)/lib/rustlib/src/rust/library/core" ] &&
    ! { command -v rustup >/dev/null && rustup component add rust-src >/dev/null 2>&1; } &&
    ! [ -e /usr/lib/rustlib/src/rust/library/core ]; then
    missing+=(rustc-web cargo-web rust-web-src)
fi

[ ${#missing[@]} = 0 ] || apt "${missing[@]}"

# The drawing of flame graphs, into the folder of build products.
inferno=0.12.8
tools=$(cd "$(dirname "$0")/.." && pwd)/build/tools
if [ "${1:-}" = profile ] && ! grep -qF "\"inferno $inferno " "$tools/.crates.toml" 2>/dev/null; then
    cargo install --quiet --locked --version "$inferno" --root "$tools" inferno
fi

# What runs the fuzz targets.
cargo_fuzz=0.13.2
if [ "${1:-}" = fuzz ] && ! grep -qF "\"cargo-fuzz $cargo_fuzz " "$tools/.crates.toml" 2>/dev/null; then
    cargo install --quiet --locked --version "$cargo_fuzz" --root "$tools" cargo-fuzz
fi

# What checks the dependencies and lists them, and the oldest Rust that is promised.
cargo_deny=0.20.2 cargo_cyclonedx=0.5.9
if [ "${1:-}" = trust ]; then
    for tool in "cargo-deny $cargo_deny" "cargo-cyclonedx $cargo_cyclonedx"; do
        grep -qF "\"$tool " "$tools/.crates.toml" 2>/dev/null ||
            cargo install --quiet --locked --version "${tool#* }" --root "$tools" "${tool% *}"
    done
    oldest=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' "$tools/../../Cargo.toml")
    ! command -v rustup >/dev/null || rustup toolchain install "$oldest" --profile minimal >/dev/null 2>&1 || true
    # Miri, which only nightly compilers have: scripts/sanitize.sh says so if it cannot be had.
    ! command -v rustup >/dev/null || cargo +nightly miri --version >/dev/null 2>&1 ||
        rustup toolchain install nightly --profile minimal --component miri,rust-src >/dev/null 2>&1 || true
fi
