#!/usr/bin/env bash
# Builds bare-metal/ for a Cortex-M and checks that the archive neither contains nor references an allocator or an
# unwinder, and that it has no undefined symbols.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
source "$root/scripts/archive.sh"
target=thumbv7em-none-eabihf
out=${CARGO_TARGET_DIR:-$root/target}/bare-metal

cd "$root/bare-metal"
if command -v rustup >/dev/null && rustup target list --installed | grep -qx "$target"; then
    cargo build --locked --release --target "$target" --target-dir "$out"
elif [ -e /usr/lib/rustlib/src/rust/library/core ]; then
    # Debian ships the source of `core`, but no build for this target.
    RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 /usr/bin/cargo build --locked --release --target "$target" \
        --target-dir "$out" -Zbuild-std=core -Zbuild-std-features=compiler-builtins-mem
else
    echo "bare-metal: no Rust compiler for $target: run scripts/setup.sh" >&2
    exit 1
fi

archive=$out/$target/release/libhangpose_bare_metal.a
table=$(symbol_table "$archive")
symbols=$(cut -d ' ' -f 2 <<<"$table" | sort -u)
undefined=$(undefined_symbols "$table")

grep -qx hangpose_demo <<<"$symbols" || { echo "bare-metal: hangpose_demo is not in $archive" >&2; exit 1; }

bad=0
check_forbidden bare-metal "$symbols" || bad=1
if [ -n "$undefined" ]; then
    echo "bare-metal: undefined symbols:" $undefined >&2
    bad=1
fi
[ "$bad" = 0 ] || exit 1

echo "bare-metal: $target, $(wc -l <<<"$symbols") symbols, none of:"
printf '    %s\n' "${forbidden[@]}"
echo "bare-metal: no undefined symbols; code and static data in bytes:"
size "$archive" | awk 'NR == 1 || $6 ~ /^hangpose/ { print "    " $1 "\t" $2 "\t" $3 }'
