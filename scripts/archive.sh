# What scripts look for in an archive: sourced by bare-metal.sh and link.sh.

forbidden=(
    # Rust's allocator: what code calls, what stands behind it, and the crate itself under either mangling.
    '__rust_(alloc|dealloc|realloc|alloc_zeroed|no_alloc_shim.*|alloc_error_handler.*)' '__rg_.*' '__rdl_.*'
    '_ZN5alloc.*' '_R.*_5alloc.*'
    # C's and C++'s.
    '(m|c|re|vm|aligned_|posix_mem)?alloc' 'valloc' 'memalign' 'posix_memalign' 'free' '_?sbrk' '_Zn[wa].*' '_Zd[la].*'
    # Unwinding.
    '_Unwind_.*' 'rust_eh_personality' '__gxx_personality.*' '__aeabi_unwind_cpp_pr.*' '__cxa_.*'
)

# Section index and name of every symbol. readelf and not nm: where nm has a plugin for LLVM's bitcode, it overlooks
# objects that carry some.
symbol_table() {
    readelf --syms --wide "$1" | awk '$5 ~ /GLOBAL|WEAK|LOCAL/ && $8 != "" { print $7, $8 }'
}

# What a symbol table needs from outside.
undefined_symbols() {
    comm -23 <(awk '$1 == "UND" { print $2 }' <<<"$1" | sort -u) <(awk '$1 != "UND" { print $2 }' <<<"$1" | sort -u)
}

# Fails, and says what it found, if a symbol is forbidden.
check_forbidden() {
    local label=$1 symbols=$2 bad=0 pattern found
    for pattern in "${forbidden[@]}"; do
        if found=$(grep -Ex "$pattern" <<<"$symbols"); then
            echo "$label: forbidden symbol:" $found >&2
            bad=1
        fi
    done
    return $bad
}
