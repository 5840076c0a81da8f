#!/usr/bin/env bash
# Builds bare-metal/ for a Cortex-M and proves that the archive neither contains nor references an allocator or an
# unwinder, and that it needs nothing from outside.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
target=thumbv7em-none-eabihf
out=${CARGO_TARGET_DIR:-$root/target}/bare-metal

cd "$root/bare-metal"
if command -v rustup >/dev/null && rustup target list --installed | grep -qx "$target"; then
    cargo build --locked --release --target "$target" --target-dir "$out"
elif [ -e /usr/lib/rustlib/src/rust/library/core ]; then
    # Debian ships the source of `core`, not the build of it for this target.
    RUSTC=/usr/bin/rustc RUSTC_BOOTSTRAP=1 /usr/bin/cargo build --locked --release --target "$target" \
        --target-dir "$out" -Zbuild-std=core -Zbuild-std-features=compiler-builtins-mem
else
    echo "bare-metal: no compiler for $target; run scripts/setup.sh" >&2
    exit 1
fi

archive=$out/$target/release/libhangpose_bare_metal.a
# readelf and not nm: where nm has a plugin for LLVM's bitcode, it overlooks objects that carry some.
table=$(readelf --syms --wide "$archive" | awk '$5 ~ /GLOBAL|WEAK|LOCAL/ && $8 != "" { print $7, $8 }')
symbols=$(cut -d ' ' -f 2 <<<"$table" | sort -u)
undefined=$(comm -23 \
    <(awk '$1 == "UND" { print $2 }' <<<"$table" | sort -u) \
    <(awk '$1 != "UND" { print $2 }' <<<"$table" | sort -u))

grep -qx hangpose_demo <<<"$symbols" || { echo "bare-metal: hangpose_demo is not in $archive" >&2; exit 1; }

forbidden=(
    # Rust's allocator: what code calls, what stands behind it, and the crate itself under either mangling.
    '__rust_(alloc|dealloc|realloc|alloc_zeroed|no_alloc_shim.*|alloc_error_handler.*)' '__rg_.*' '__rdl_.*'
    '_ZN5alloc.*' '_R.*_5alloc.*'
    # C's and C++'s.
    '(m|c|re|vm|aligned_|posix_mem)?alloc' 'valloc' 'memalign' 'posix_memalign' 'free' '_?sbrk' '_Zn[wa].*' '_Zd[la].*'
    # Unwinding.
    '_Unwind_.*' 'rust_eh_personality' '__gxx_personality.*' '__aeabi_unwind_cpp_pr.*' '__cxa_.*'
)
bad=0
for pattern in "${forbidden[@]}"; do
    if found=$(grep -Ex "$pattern" <<<"$symbols"); then
        echo "bare-metal: forbidden symbol:" $found >&2
        bad=1
    fi
done
if [ -n "$undefined" ]; then
    echo "bare-metal: needed from outside:" $undefined >&2
    bad=1
fi
[ "$bad" = 0 ] || exit 1

echo "bare-metal: $target, $(wc -l <<<"$symbols") symbols, none of:"
printf '    %s\n' "${forbidden[@]}"
echo "bare-metal: nothing is needed from outside; code and static data in bytes:"
size "$archive" | awk 'NR == 1 || $6 ~ /^hangpose/ { print "    " $1 "\t" $2 "\t" $3 }'
